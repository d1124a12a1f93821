//! What the component refuses, and how it says so.

use crate::session::Session;

/// Runs commands with one loop in a thread, then prints what it says of its parameters.
fn said(session: &Session, commands: &str) -> String {
    let begin = "loadrt threads name1=t period1=1000000 fp1=1\nloadrt ctl_loop\naddf ctl-loop.0 t\n";
    let pins =
        ["ready", "refused", "fault-code", "fault-field", "fault-reason", "fault-value", "adopted", "output"];
    let ask: String = pins.iter().map(|pin| format!("getp ctl-loop.0.{pin}\n")).collect();
    // Some hundred samples; on a busy machine fewer.
    session.run(&format!("{begin}{commands}\nstart\nloadusr -w sleep 0.3\n{ask}"))
}

/// The lines of an answer that are values of pins.
fn values(said: &str) -> Vec<&str> {
    let value = |line: &&str| *line == "TRUE" || *line == "FALSE" || line.parse::<f64>().is_ok();
    said.lines().map(str::trim).filter(value).collect()
}

#[test]
fn bad_first_parameters_leave_the_output_alone_and_are_named() {
    let Some(session) = Session::open("bad-first") else { return };
    let said = said(&session, "setp ctl-loop.0.kd 1\nsetp ctl-loop.0.enable 1\nsetp ctl-loop.0.setpoint 5");
    // CTL_ERROR_CONFIG, CTL_PARAM_KD, CTL_REASON_NEEDS_FILTER.
    assert_eq!(values(&said), ["FALSE", "TRUE", "7", "4", "5", "1", "0", "0"], "{said}");
    assert!(
        said.contains("ctl-loop.0: parameters refused") && said.contains("ctl-loop.0: kd = 1 "),
        "{said}"
    );
    assert_eq!(said.matches("parameters refused").count(), 1, "said once, not in every sample");
}

#[test]
fn a_choice_that_is_none_and_a_dead_time_that_does_not_fit_are_refused() {
    let Some(session) = Session::open("misfits") else { return };
    let said_of_choice = said(&session, "setp ctl-loop.0.anti-windup 3");
    assert_eq!(values(&said_of_choice)[..6], ["FALSE", "TRUE", "7", "130", "2", "3"], "{said_of_choice}");
    let model = "setp ctl-loop.0.compensator 2\nsetp ctl-loop.0.alpha 0.1\nsetp ctl-loop.0.model-gain 1\n\
                 setp ctl-loop.0.model-pole-a1-0 0.1\nsetp ctl-loop.0.model-dead-time";
    // CTL_ERROR_SIZE, CTL_PARAM_CAPACITY: 2000 samples do not fit into 1000.
    let said_of_delay = said(&session, &format!("{model} 2.0005"));
    assert_eq!(values(&said_of_delay)[..4], ["FALSE", "TRUE", "2", "42"], "{said_of_delay}");
    let fits = said(&session, &format!("{model} 1.0005"));
    assert_eq!(values(&fits)[..3], ["TRUE", "FALSE", "0"], "{fits}");
}

#[test]
fn changes_by_hand_while_it_runs_are_adopted_or_refused_without_a_bump() {
    let Some(session) = Session::open("by-hand") else { return };
    let commands = "
loadrt threads name1=t period1=1000000 fp1=1
loadrt ctl_loop
loadrt lowpass
loadrt sampler depth=20000 cfg=ffu
net u ctl-loop.0.output => lowpass.0.in sampler.0.pin.0
net y lowpass.0.out => ctl-loop.0.feedback sampler.0.pin.1
net adopted ctl-loop.0.adopted => sampler.0.pin.2
setp lowpass.0.gain 0.01
setp ctl-loop.0.kp 2
setp ctl-loop.0.ki 20
setp ctl-loop.0.setpoint 1
setp ctl-loop.0.enable 1
addf ctl-loop.0 t
addf sampler.0 t
addf lowpass.0 t
start
loadusr -w sleep 1
setp ctl-loop.0.kp 5
loadusr -w sleep 0.2
setp ctl-loop.0.ki 3
loadusr -w sleep 0.2
setp ctl-loop.0.alpha 0.02
setp ctl-loop.0.model-gain 1
setp ctl-loop.0.model-pole-a1-0 0.1
setp ctl-loop.0.compensator 2
loadusr -w sleep 0.2
setp ctl-loop.0.output-hi -7e6
loadusr -w sleep 0.2
getp ctl-loop.0.refused
setp ctl-loop.0.output-hi 9
loadusr -w sleep 0.2
getp ctl-loop.0.refused
getp ctl-loop.0.compensating
setp ctl-loop.0.compensator 0
setp ctl-loop.0.param-hold 1
setp ctl-loop.0.kp 77
loadusr -w sleep 0.2
getp ctl-loop.0.adopted
getp ctl-loop.0.ts
loadusr -w halsampler -n 4000 rows.txt
";
    let said = session.run(commands);
    // First, kp, ki, compensator, output-hi; and compensator 0, unless param-hold came before its sample. Parameters of a
    // model that is not in use change nothing.
    let answers = values(&said);
    assert_eq!(answers[..3], ["TRUE", "FALSE", "TRUE"], "{said}");
    assert!(["5", "6"].contains(&answers[3]) && answers[4] == "0.001", "{said}");
    let rows = session.rows("rows.txt");
    let number = |row: &[String], column: usize| row[column].parse::<f64>().expect("a number");
    // After a second, ten closed-loop time constants, the loop rests: no change of parameters may move it.
    for row in &rows[950..] {
        assert!((number(row, 0) - 1.0).abs() < 2e-3 && (number(row, 1) - 1.0).abs() < 2e-3, "{row:?}");
    }
    assert!(
        number(&rows[3999], 2) > number(&rows[950], 2),
        "parameters are adopted within the rows looked at"
    );
}

#[test]
fn a_number_of_samples_that_hal_has_no_memory_for_is_refused_when_loading() {
    let Some(session) = Session::open("memory") else { return };
    for (delay, why) in [("-1", "max_delay=-1 is not in 0.."), ("10000000", "a smaller max_delay helps")] {
        let (succeeded, said) = session.attempt_commands(&format!("loadrt ctl_loop max_delay={delay}\n"));
        assert!(!succeeded && said.contains(why), "{said}");
    }
}
