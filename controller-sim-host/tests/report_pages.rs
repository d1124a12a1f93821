//! Pages that are written for a person to look at: ordinary ones and those that are hard to draw.

mod report;

use controller_sim_host::scenario::{Change, ControllerSpec, Event, Noise, Signal, Units};
use controller_sim_host::simulate::View;
use report::{Ran, ran, ran_in, write};

const DEMO: &str = include_str!("data/report_demo.toml");
const SENSOR: &str = include_str!("data/report_sensor.toml");
const WINDUP: &str = include_str!("data/report_windup.toml");

fn event(at: f64, label: &str, changes: Vec<Change>) -> Event {
    Event { at, label: label.to_owned(), changes, controller: None }
}

#[test]
fn a_page_with_everything() {
    let run = ran("tank.toml", SENSOR, |s| {
        s.title = "Temperature loop whose sensor fails".to_owned();
        s.description =
            "A few bad samples are bridged, a long failure brings the heater down to a safe output.\n\n\
            The loop closes again only after someone has acknowledged it. Look at the modes below the curves."
                .to_owned();
        s.units = Units { y: "\u{b0}C".to_owned(), u: "%".to_owned() };
        s.noise = Some(Noise { std: 0.6, seed: 3 });
        s.sensor.resolution = 0.25;
        s.actuator.rate = 0.8;
        s.actuator.hi = 42.0;
        s.events[2].label = "Wire broken".to_owned();
    });
    write("everything", &[run]);
}

#[test]
fn many_events_and_controllers() {
    let run = ran("many.toml", DEMO, |s| {
        s.duration = 40.0;
        s.noise = Some(Noise { std: 0.01, seed: 3 });
        let first = s.controllers[0].clone();
        for n in s.controllers.len()..8 {
            let mut next = ControllerSpec {
                name: format!("a controller with quite a long name, no. {n}"),
                ..first.clone()
            };
            next.config.pid.kp *= 1.0 - 0.1 * n as f64;
            next.config.limits.lo = -1.0;
            next.config.limits.hi = 1.5 - 0.1 * n as f64;
            s.controllers.push(next);
        }
        for n in 0..60 {
            let at = 10.0 + 0.4 * f64::from(n) + if n % 3 == 0 { 0.0 } else { 0.05 };
            let d = Signal::Step(f64::from(n % 5) * 0.1);
            s.events.push(event(at, "", vec![Change::Disturbance(d)]));
        }
        for _ in 0..3 {
            s.events.push(event(
                39.0,
                "three at once, with a long label",
                vec![Change::Setpoint(Signal::Step(0.5))],
            ));
        }
        s.events.sort_by(|a, b| a.at.total_cmp(&b.at));
    });
    write("many", &[run]);
}

#[test]
fn a_million_samples_with_noise() {
    let run = ran("long.toml", DEMO, |s| {
        s.ts = 0.01;
        s.duration = 10_000.0;
        s.substeps = 1;
        s.noise = Some(Noise { std: 0.02, seed: 1 });
        s.events[1].at = 5_000.0;
    });
    write("million", &[run]);
}

#[test]
fn a_sweep() {
    let runs: Vec<Ran> = [0.0, 0.02, 0.05, 0.1, 0.15, 0.2]
        .into_iter()
        .map(|latency| {
            let mut run = ran("latency.toml", DEMO, |s| s.latency = latency);
            run.case = Some(format!("latency = {latency}"));
            run
        })
        .collect();
    write("sweep", &runs);
}

#[test]
fn small_and_odd_runs() {
    let one = ran("one sample", DEMO, |s| s.duration = s.ts);
    let few = ran("twelve samples", DEMO, |s| {
        s.ts = 0.2;
        s.duration = 2.4;
        s.events.truncate(1);
        s.controllers.truncate(2);
    });
    let still = ran("nothing happens", DEMO, |s| s.events.clear());
    let tiny = ran("tiny numbers", DEMO, |s| {
        for event in &mut s.events {
            for change in &mut event.changes {
                if let Change::Setpoint(Signal::Step(x)) | Change::Disturbance(Signal::Step(x)) = change {
                    *x *= 3.7e-7;
                }
            }
        }
    });
    let far = ran("far from zero", DEMO, |s| {
        s.initial.setpoint = 1e6;
        for controller in &mut s.controllers {
            controller.config.limits.hi = 1e7;
            controller.config.measurement_hi = 1e7;
            controller.config.setpoint.hi = 1e7;
        }
        s.events[0].changes = vec![Change::Setpoint(Signal::Step(1e6 + 0.01))];
        s.events.truncate(1);
    });
    let unstable = ran("unstable", DEMO, |s| {
        s.latency = 0.8;
        s.duration = 60.0;
        for controller in &mut s.controllers {
            controller.config.limits.lo = -1e12;
            controller.config.limits.hi = 1e12;
        }
    });
    let part = ran_in("a part of it", WINDUP, |_| {}, |_| View { from: 9.0, to: 14.0, columns: 1000 });
    write("odd", &[one, few, still, tiny, far, unstable, part]);
}
