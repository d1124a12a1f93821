//! The files below `scenarios/`, in the order in which they are listed.

/// Paths and texts.
macro_rules! texts {
    ($($path:literal),* $(,)?) => {
        &[$(($path, include_str!(concat!("../../scenarios/", $path)))),*]
    };
}

pub(super) const ALL: &[(&str, &str)] = texts![
    "demo.toml",
    "first.toml",
    "chapter-gp1.toml",
    "chapter-gp2.toml",
    "chapter-gp3.toml",
    "chapter-gp4.toml",
    "chapter-gp5.toml",
    "chapter-gp6.toml",
    "step-test.toml",
    "windup.toml",
    "sensor.toml",
    "cascade.toml",
    "dob-against-ramps.toml",
    "observer-filter.toml",
    "latency.toml",
    "single-precision.toml",
    "level.toml",
    "load-experiment.toml",
    "actuator.toml",
    "sine-disturbance.toml",
    "random-walk.toml",
    "recorded-load.toml",
    "recorded-load.csv",
    "two-tank.toml",
    "sticky-valve.toml",
    "heater.toml",
    "figures/de-fig-06.toml",
    "figures/de-fig-07.toml",
    "figures/de-fig-11.toml",
    "figures/de-fig-12.toml",
    "figures/de-fig-14.toml",
    "figures/de-fig-15.toml",
    "figures/dob-fig-04-05-plant-1-ms-1.2.toml",
    "figures/dob-fig-04-05-plant-1-ms-2.0.toml",
    "figures/dob-fig-04-05-plant-2-ms-1.2.toml",
    "figures/dob-fig-04-05-plant-2-ms-2.0.toml",
    "figures/dob-fig-04-05-plant-3-ms-1.2.toml",
    "figures/dob-fig-04-05-plant-3-ms-2.0.toml",
    "figures/dob-table-7.toml",
    "figures/dob-fig-14-15-c1.toml",
    "figures/dob-fig-14-15-c2.toml",
];
