//! Scenarios of any length, for the checks of memory, size and speed.

/// The loop of the scenario `demo`, controller DE-MOMI, for many samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct LongRun {
    /// Length of the run.
    pub(crate) samples: u64,
    /// Samples between two events: set-point to 1, disturbance to 1, set-point to 0, disturbance to 0, and again.
    pub(crate) every: u64,
    /// Whether the measurement is noisy.
    pub(crate) noise: bool,
}

/// Samples in a second: the sampling period is 0.01 s.
const RATE: u64 = 100;

impl LongRun {
    /// The text of the scenario.
    pub(crate) fn text(&self) -> String {
        let mut text = format!("version = 1\nts = 0.01\nduration = {}\n", seconds(self.samples));
        text.push_str("[plant]\ntf = \"exp(-0.2*s)/((1+0.2*s)*(1+s))\"\n");
        if self.noise {
            text.push_str("[noise]\nstd = 0.01\nseed = 1\n");
        }
        text.push_str(CONTROLLER);
        let kinds = ["setpoint = 1.0", "disturbance = 1.0", "setpoint = 0.0", "disturbance = 0.0"];
        for (at, kind) in (0..self.samples).step_by(self.every.max(1) as usize).zip(kinds.iter().cycle()) {
            text.push_str(&format!("[[event]]\nat = {}\n{kind}\n", seconds(at)));
        }
        text
    }
}

/// As in `scenarios/demo.toml`.
const CONTROLLER: &str = r#"[[controller]]
name = "DE-MOMI"
pid = { kp = 2.354490875, ki = 1.879564327, kd = 0.4753148656, tf = 0.1187005288, b = 1.0, c = 1.0, integral_rule = "trapezoid" }
estimator = { gain = 1.0, a1 = 1.2, a2 = 0.2, dead_time = 0.2, kfd = 0.688669975, tfd = 0.05996942655 }
limits = { lo = -100.0, hi = 100.0 }
"#;

/// The time of a sample as TOML writes it \[s\].
fn seconds(sample: u64) -> String {
    format!("{}.{:02}", sample / RATE, sample % RATE)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn events_follow_each_other_to_the_end() {
        let text = LongRun { samples: 4500, every: 1000, noise: false }.text();
        assert!(text.contains("duration = 45.00\n") && !text.contains("[noise]"));
        assert_eq!(text.matches("[[event]]").count(), 5);
        assert!(text.ends_with("at = 30.00\ndisturbance = 0.0\n[[event]]\nat = 40.00\nsetpoint = 1.0\n"));
    }

    #[test]
    fn the_controller_is_that_of_the_demo_and_of_the_loop_in_python() {
        let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
        let read = |name: &str| std::fs::read_to_string(root.join(name)).unwrap();
        let demo = read("controller-sim-host/scenarios/demo.toml");
        for line in CONTROLLER.lines().filter(|line| line.starts_with("pid") || line.starts_with("estimator"))
        {
            assert!(demo.contains(line), "the demo has no controller with {line}");
        }
        let python = read("tests/bench/numpy_loop.py");
        let numbers = "KP, KI, KD, TF = 2.354490875, 1.879564327, 0.4753148656, 0.1187005288\n\
                       KFD, TFD = 0.688669975, 0.05996942655\n";
        assert!(python.contains(numbers), "the loop in Python has other parameters");
    }
}
