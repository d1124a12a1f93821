//! The component `ctl_loop` in LinuxCNC's HAL itself, in a thread of 1 kHz.
//!
//! Run by `cargo xtask test --only hal`, which builds the archive and names it in `CTL_ARCHIVE`; without that variable these
//! tests say that they did not run.

#[path = "hal/record.rs"]
mod record;
#[path = "hal/reference.rs"]
mod reference;
#[path = "hal/refusals.rs"]
mod refusals;
#[path = "hal/session.rs"]
mod session;
#[path = "hal/trace.rs"]
mod trace;

use session::Session;

/// A PI and HAL's own `pid`, each on a first-order plant, follow the same square wave of 5 Hz.
///
/// `pid` adds `ki*ts*e` to a plain sum, the loop to a compensated one: they differ by the rounding of 1500 additions of
/// numbers of size 1, at most 1500 * 2^-53 < 2e-13, so that six decimals show no difference.
const BESIDE_PID: &str = "
loadrt threads name1=t period1=1000000 fp1=1
loadrt ctl_loop
loadrt pid num_chan=1
loadrt lowpass count=2
loadrt siggen num_chan=1
loadrt sampler depth=20000 cfg=fffff
setp ctl-loop.0.kp 1.7
setp ctl-loop.0.ki 12
setp ctl-loop.0.enable 1
setp pid.0.Pgain 1.7
setp pid.0.Igain 12
setp pid.0.enable 1
setp pid.0.error-previous-target 0
setp lowpass.0.gain 0.03
setp lowpass.1.gain 0.03
setp siggen.0.frequency 5
net wave siggen.0.square => ctl-loop.0.setpoint pid.0.command sampler.0.pin.0
net u ctl-loop.0.output => lowpass.0.in sampler.0.pin.1
net y lowpass.0.out => ctl-loop.0.feedback sampler.0.pin.2
net pid-u pid.0.output => lowpass.1.in sampler.0.pin.3
net pid-y lowpass.1.out => pid.0.feedback sampler.0.pin.4
addf ctl-loop.0 t
addf pid.0.do-pid-calcs t
addf sampler.0 t
addf lowpass.0 t
addf lowpass.1 t
addf siggen.0.update t
start
loadusr -w halsampler -n 1500 rows.txt
";

#[test]
fn a_pi_agrees_with_hals_own_pid_on_a_square_wave() {
    let Some(session) = Session::open("beside-pid") else { return };
    session.run(BESIDE_PID);
    let rows = session.rows("rows.txt");
    assert_eq!(rows.len(), 1500);
    let (mut edges, mut largest) = (0, 0.0_f64);
    for (k, pair) in rows.windows(2).enumerate() {
        edges += usize::from(pair[0][0] != pair[1][0]);
        largest = largest.max(pair[1][1].parse::<f64>().expect("a number").abs());
        assert_eq!(pair[1][1], pair[1][3], "output of sample {}", k + 1);
        assert_eq!(pair[1][2], pair[1][4], "measurement of sample {}", k + 1);
    }
    // The first change is from the 0 before the wave's first period.
    assert_eq!(edges, 15, "half periods of 100 samples");
    assert!(largest > 2.0, "the outputs hardly moved: {largest}");
}

#[test]
fn the_example_runs_and_its_observer_removes_the_load_faster() {
    let Some(session) = Session::open("example") else { return };
    let folder = session::component();
    let printed = session.run_file(&folder.join("loop.hal"));
    let rows: Vec<Vec<f64>> = printed
        .lines()
        .filter_map(|line| {
            line.split_whitespace().map(|word| word.parse().ok()).collect::<Option<Vec<f64>>>()
        })
        .filter(|row| row.len() == 6)
        .collect();
    assert_eq!(rows.len(), 60, "{printed}");
    // From the load's first change on: the sum of |1 - y| of each loop.
    let after = rows.iter().skip_while(|row| row[1] < 0.0).take(25);
    let [plain, observed] =
        after.fold([0.0; 2], |[a, b], row| [a + (1.0 - row[2]).abs(), b + (1.0 - row[4]).abs()]);
    assert!(observed < 0.5 * plain, "with observer {observed}, without {plain}");
}
