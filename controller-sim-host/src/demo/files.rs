//! The files below `scenarios/`, in the order in which they are listed.

/// Paths and texts.
macro_rules! texts {
    ($($path:literal),* $(,)?) => {
        &[$(($path, include_str!(concat!("../../scenarios/", $path)))),*]
    };
}

pub(super) const ALL: &[(&str, &str)] =
    texts!["demo.toml", "first.toml", "sensor_failure.toml", "windup.toml",];
