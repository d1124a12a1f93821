//! Processor in the loop: the same bits on every emulated board, and how many round trips a second.

use std::path::Path;
use std::time::Instant;

use crate::emulator;
use crate::ladder::Done;
use crate::program;
use crate::rungs::TempFolder;
use crate::setup::{self, Part};
use crate::shell::{Cmd, Outcome, target_dir};

/// The emulator's program.
const QEMU: &str = "qemu-system-arm";
/// Where controllers run beside the host: board, its target, number type. The first is the reference.
const RUNS: [Run; 7] = [
    ("mps2-an386", "thumbv7em-none-eabihf", "f32"),
    ("mps2-an386", "thumbv7em-none-eabihf", "f64"),
    ("mps2-an500", "thumbv7em-none-eabihf", "f32"),
    ("mps2-an500", "thumbv7em-none-eabihf", "f64"),
    ("microbit", "thumbv6m-none-eabi", "f32"),
    ("mps2-an385", "thumbv7m-none-eabi", "f32"),
    ("mps2-an505", "thumbv8m.main-none-eabihf", "f32"),
];
/// Samples of each of the four controllers, in the ladder and in the soak.
const SAMPLES: u64 = 25_000;
/// As many again on the reference board, in single precision.
const REFERENCE_SAMPLES: u64 = 100_000;
/// What the traces of [`SAMPLES`] must hash to, on every machine: a change that is meant changes these, too.
const HASHES: [(&str, &str); 2] = [("f32", "f2aa8140436140cd"), ("f64", "78f1c8e91a4d7cae")];
const SOAK_SAMPLES: u64 = 10 * SAMPLES;
/// Samples of the short and of the long run of the benchmark: what the emulator takes to start is in both.
const BENCH: [u64; 2] = [20_000, 120_000];
/// Fewest round trips a second.
const LEAST_RATE: f64 = 10_000.0;

/// The rung: four controllers with modes, saturation, bad and lost samples and new parameters, on every board.
pub(crate) fn rung(root: &Path) -> Outcome<Done> {
    if let Some(end) = emulator::lacking(root)? {
        return Ok(end);
    }
    let (remark, traces) = compare(root, &RUNS, SAMPLES)?;
    for (precision, trace) in &traces {
        let known = HASHES.iter().find(|(own, _)| own == precision).map_or("", |(_, hash)| hash);
        if trace.host != known {
            return Err(format!(
                "the {precision} trace is {}, was {known}: see HASHES in xtask/src/pil.rs",
                trace.host
            ));
        }
    }
    compare(root, &RUNS[..1], REFERENCE_SAMPLES)?;
    Ok(Done::Passed(format!("{remark}; {REFERENCE_SAMPLES} of each controller on {}", RUNS[0].0)))
}

/// The same with ten times as many samples.
pub(crate) fn soak(root: &Path) -> Outcome {
    match lacking(root)? {
        Some(message) => Err(message),
        None => {
            let (remark, _) = compare(root, &RUNS, SOAK_SAMPLES)?;
            println!("{remark}");
            let (remark, _) = compare(root, &RUNS[..1], 10 * REFERENCE_SAMPLES)?;
            println!("{remark}");
            Ok(())
        }
    }
}

/// Round trips a second, of one controller with an estimator on the reference board; an error when they are too few.
pub(crate) fn bench(root: &Path) -> Outcome {
    if let Some(message) = lacking(root)? {
        println!("no processor in the loop: {message}");
        return Ok(());
    }
    let program = program::shipped(root)?;
    let folder = TempFolder::new("pil-bench")?;
    let (board, _, precision) = RUNS[0];
    let mut seconds = [0.0; 2];
    // The first run builds the image.
    for (samples, time) in [BENCH[0], BENCH[0], BENCH[1]].into_iter().zip([0, 0, 1]) {
        let file = folder.0.join(format!("{samples}.toml"));
        std::fs::write(&file, scenario(samples, &CONTROLLERS[1..2]))
            .map_err(|e| format!("cannot write {}: {e}", file.display()))?;
        let begin = Instant::now();
        run(root, &program, &file, board, precision)?;
        seconds[time] = begin.elapsed().as_secs_f64();
    }
    #[allow(clippy::cast_precision_loss)] // far below 2^52
    let rate = (BENCH[1] - BENCH[0]) as f64 / (seconds[1] - seconds[0]);
    println!(
        "\nprocessor in the loop on {board}, {precision}, PID with an estimator: {rate:.0} round trips a second"
    );
    if rate >= LEAST_RATE { Ok(()) } else { Err(format!("fewer than {LEAST_RATE} round trips a second")) }
}

fn lacking(root: &Path) -> Outcome<Option<String>> {
    let targets = RUNS.map(|(_, target, _)| target.to_string());
    if let Some(message) = setup::lacking(root, Part::Target, &targets)? {
        return Ok(Some(message));
    }
    let there = Cmd::new(QEMU, root).arg("--version").probe().is_some();
    Ok((!there).then(|| format!("{QEMU} is not installed: cargo xtask setup installs it or says how")))
}

/// A board, its target, a number type.
type Run = (&'static str, &'static str, &'static str);

/// Runs every controller in each of `runs`; a remark and the traces when nothing differs.
fn compare(root: &Path, runs: &[Run], samples: u64) -> Outcome<(String, Vec<(&'static str, Trace)>)> {
    let program = program::checked(root)?;
    let folder = target_dir(root).join("pil");
    std::fs::create_dir_all(&folder).map_err(|e| format!("cannot create {}: {e}", folder.display()))?;
    let file = folder.join(format!("{samples}.toml"));
    std::fs::write(&file, scenario(samples, &CONTROLLERS))
        .map_err(|e| format!("cannot write {}: {e}", file.display()))?;
    let mut traces: Vec<(&'static str, Trace)> = Vec::new();
    let mut total = 0;
    for &(board, _, precision) in runs {
        let begin = Instant::now();
        let trace = run(root, &program, &file, board, precision)?;
        println!("  {board} {precision}: {trace:?} in {:.1} s", begin.elapsed().as_secs_f64());
        trace.judge().map_err(|why| format!("{board}, {precision}: {why}"))?;
        // One hash for every machine.
        if let Some((_, other)) = traces.iter().find(|(other, _)| *other == precision)
            && *other != trace
        {
            return Err(format!("{board}, {precision}: another trace than on the board before"));
        }
        total += trace.samples;
        traces.push((precision, trace));
    }
    let hash = |precision: &str| {
        let found = traces.iter().find(|(own, _)| *own == precision);
        found.map_or(String::new(), |(_, trace)| format!("{precision} {}", trace.host))
    };
    let runs = runs.len();
    let remark = format!(
        "{total} samples on {runs} boards and number types, no bit differs; {}, {}",
        hash("f32"),
        hash("f64")
    );
    Ok((remark, traces))
}

fn run(root: &Path, program: &Path, file: &Path, board: &str, precision: &str) -> Outcome<Trace> {
    let json = Cmd::new(program, root)
        .args(["run", "--json", "--quiet", "--precision", precision, &format!("--pil={board}")])
        .arg(file)
        .capture()?;
    Trace::of(&json)
}

/// What the program says of a run on a board.
#[derive(Debug, PartialEq, Eq)]
struct Trace {
    samples: u64,
    differing: u64,
    host: String,
    board: String,
}

impl Trace {
    fn of(json: &str) -> Outcome<Self> {
        let compact: String = json.chars().filter(|c| !c.is_whitespace()).collect();
        let pil = compact.split_once("\"pil\":{").ok_or("no pil in the program's JSON")?.1;
        let text = |key: &str| {
            let value = pil.split_once(&format!("\"{key}\":")).map(|(_, rest)| rest);
            let value = value.and_then(|rest| rest.split([',', '}']).next());
            value
                .map(|word| word.trim_matches('"').to_string())
                .ok_or_else(|| format!("no {key} in the program's JSON"))
        };
        let number = |key: &str| text(key)?.parse().map_err(|_| format!("{key} is no number"));
        Ok(Self {
            samples: number("samples")?,
            differing: number("differing_samples")?,
            host: text("host_hash")?,
            board: text("board_hash")?,
        })
    }

    fn judge(&self) -> Outcome {
        if self.samples == 0 {
            return Err("nothing was compared".into());
        }
        if self.differing > 0 || self.host != self.board {
            return Err(format!("{} of {} samples differ", self.differing, self.samples));
        }
        Ok(())
    }
}

/// Name and keys of each controller: every kind of law and of compensator, every anti-windup rule and fallback.
const CONTROLLERS: [(&str, &str); 4] = [
    (
        "PID",
        "pid = { kp = 2.0, ki = 1.6, kd = 0.4, tf = 0.1, b = 0.7, c = 0.2 }\n\
         limits = { lo = -2.0, hi = 2.0, rate = 30.0 }\nsetpoint = { rate = 2.0, track = true }\n\
         anti_windup = { rule = \"conditional\" }\nalarms = { hi = 1.1, lo = -0.4, deviation = 0.5, hysteresis = 0.1 }\n\
         fallback = { hold_samples = 5, action = \"ramp\", output = 0.1, rate = 0.5, return = \"acknowledged\" }\n",
    ),
    (
        "PID + DE",
        "pid = { kp = 2.354490875, ki = 1.879564327, kd = 0.4753148656, tf = 0.1187005288, b = 1.0, c = 1.0, integral_rule = \"trapezoid\" }\n\
         estimator = { gain = 1.0, a1 = 1.2, a2 = 0.2, dead_time = 0.2, kfd = 0.688669975, tfd = 0.05996942655 }\n\
         limits = { lo = -2.0, hi = 2.0 }\nfallback = { hold_samples = 5 }\n",
    ),
    (
        "PI + DOB",
        "pid = { kp = 0.8, ki = 0.7 }\nobserver = { model = \"exp(-0.2*s)/((1+0.2*s)*(1+s))\", alpha = 0.1 }\n\
         limits = { lo = -2.0, hi = 2.0, rate_up = 5.0 }\nanti_windup = { tt = 0.3 }\ndeadband = 0.01\n\
         fallback = { hold_samples = 9, action = \"substitute\", output = -0.2 }\n",
    ),
    (
        "ADRC",
        "adrc = { b0 = 5.0, omega_c = 2.0, omega_o = 8.0 }\nlimits = { lo = -2.0, hi = 2.0 }\n\
         fallback = { hold_samples = 5 }\n",
    ),
];

/// What happens, again and again; the word before the colon is the controller it is about.
const EVENTS: [&str; 34] = [
    "setpoint = 1.0",
    "disturbance = 0.8",
    "setpoint = 5.0",
    "setpoint = 0.5",
    "bad_samples = 3",
    "bad_samples = 40",
    "acknowledge = true",
    "mode = \"manual\"\nmanual = 0.7",
    "setpoint = 0.9",
    "mode = \"auto\"",
    "lost_samples = 2",
    "lost_samples = 30",
    "mode = \"track\"\ntrack = -0.4",
    "mode = \"hold\"",
    "mode = \"cascade\"\nremote_setpoint = 1.2",
    "PID: pid = { kp = 1.2, ki = 0.9, tf = 0.2 }\nlimits = { hi = 1.4 }",
    "PID + DE: pid = { kp = 1.5, kd = 0.2 }\nestimator = { dead_time = 0.13, kfd = 0.4 }",
    "PI + DOB: pid = { kp = 0.5 }\nobserver = { alpha = 0.3 }\nlimits = { lo = -1.0 }",
    "ADRC: adrc = { omega_c = 1.5, omega_o = 6.0 }",
    "mode = \"off\"",
    "mode = \"auto\"",
    "offset = 0.2",
    "PID + DE: compensator = false",
    "disturbance = -0.5",
    "PID + DE: compensator = true",
    "PI + DOB: compensator = false",
    "PID: pid = { kp = 2.0, ki = 1.6, tf = 0.1 }\nlimits = { hi = 2.0 }",
    "PI + DOB: compensator = true",
    "PID + DE: pid = { kp = 2.354490875, kd = 0.4753148656 }\nestimator = { dead_time = 0.2, kfd = 0.7 }",
    "PI + DOB: pid = { kp = 0.8 }\nobserver = { alpha = 0.1 }\nlimits = { lo = -2.0 }",
    "ADRC: adrc = { omega_c = 2.0, omega_o = 8.0 }",
    "offset = 0.0",
    "acknowledge = true",
    "setpoint = -0.6",
];

/// Samples in a second: the sampling period is 0.01 s.
const RATE: u64 = 100;

/// The scenario: a noisy loop with an actuator that clips more than the controllers do and says so.
fn scenario(samples: u64, controllers: &[(&str, &str)]) -> String {
    let seconds = |sample: u64| format!("{}.{:02}", sample / RATE, sample % RATE);
    let mut text = format!(
        "version = 1\nts = 0.01\nduration = {}\nsubsteps = 1\n[plant]\ntf = \"exp(-0.2*s)/((1+0.2*s)*(1+s))\"\n\
         [noise]\nstd = 0.02\nseed = 5\n[actuator]\nlo = -1.8\nhi = 1.7\nread_back = true\n",
        seconds(samples)
    );
    for (name, keys) in controllers {
        text.push_str(&format!("[[controller]]\nname = \"{name}\"\n{keys}"));
    }
    // At most some thousand events, none of them in the middle of what the one before began.
    let every = (samples / 5000).max(100);
    for (at, event) in (0..samples).step_by(every as usize).zip(EVENTS.iter().cycle()) {
        let (who, what) = match event.split_once(": ") {
            Some((who, what)) if controllers.iter().any(|(name, _)| *name == who) => {
                (format!("controller = \"{who}\"\n"), what)
            }
            Some(_) => continue,
            None => (String::new(), *event),
        };
        text.push_str(&format!("[[event]]\nat = {}\n{who}{what}\n", seconds(at)));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn events_are_about_controllers_that_are_there() {
        let all = scenario(SAMPLES, &CONTROLLERS);
        assert_eq!(all.matches("[[event]]").count(), 250);
        for (name, _) in CONTROLLERS {
            assert!(all.contains(&format!("controller = \"{name}\"\n")), "no event is about {name}");
        }
        let one = scenario(3400, &CONTROLLERS[1..2]);
        assert!(!one.contains("ADRC") && !one.contains("at = 15.00") && one.contains("at = 16.00"));
    }

    #[test]
    fn what_the_program_says_is_read_and_judged() {
        let json = |differing: u32, board: &str| {
            format!(
                "{{\"pil\": {{\n\"board\": \"b\", \"samples\": 12, \"differing_samples\": {differing}, \
                 \"first_difference\": null, \"host_hash\": \"0a\", \"board_hash\": \"{board}\"\n}}, \"warnings\": []}}"
            )
        };
        let good = Trace::of(&json(0, "0a")).unwrap();
        assert_eq!((good.samples, good.host.as_str()), (12, "0a"));
        assert!(good.judge().is_ok());
        assert!(Trace::of(&json(1, "0b")).unwrap().judge().unwrap_err().contains("1 of 12"));
        assert!(Trace::of("{}").is_err());
    }
}
