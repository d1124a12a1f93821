//! A heater that is not the same both ways.

use controller_design::model::{TransferFunction, parse};

/// A first-order lag whose gain depends on the sign of its input, and its time constant on the way it moves:
///
/// ```text
/// target = gain*u  for u >= 0,  gain_cool*u  for u < 0
/// x'     = (target - x)/tau_heat  while x rises,  (target - x)/tau_cool  while it falls
/// y      = ambient + x, behind a lag of sensor_lag
/// ```
///
/// An element heats by its power and cools by what is around it; where a valve or a second element cools, its gain is
/// another. The equations are continuous: at `u = 0` both gains give 0, at `x = target` both lags do.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Heater {
    /// Gain while heating \[y/u\], above 0.
    pub gain: f64,
    /// Gain while cooling \[y/u\], 0 or more; 0: it cannot be driven below `ambient`.
    pub gain_cool: f64,
    /// Time constant while `x` rises \[s\].
    pub tau_heat: f64,
    /// Time constant while `x` falls \[s\].
    pub tau_cool: f64,
    /// The measurement with `u = 0` \[y\].
    pub ambient: f64,
    /// Time constant of the sensor \[s\]; 0: it shows what there is.
    pub sensor_lag: f64,
    /// Dead time at the input \[s\].
    pub dead_time: f64,
}

impl Heater {
    fn target(&self, u: f64) -> f64 {
        if u >= 0.0 { self.gain * u } else { self.gain_cool * u }
    }

    /// `x` and what the sensor shows of it.
    pub(super) fn rates(&self, x: &[f64; 2], u: f64) -> [f64; 2] {
        let way = self.target(u) - x[0];
        let lag = if way >= 0.0 { self.tau_heat } else { self.tau_cool };
        let shown = if self.sensor_lag > 0.0 { (x[0] - x[1]) / self.sensor_lag } else { 0.0 };
        [way / lag, shown]
    }

    pub(super) fn output(&self, x: &[f64; 2]) -> f64 {
        self.ambient + if self.sensor_lag > 0.0 { x[1] } else { x[0] }
    }

    pub(super) fn parameters(&self) -> [(&'static str, f64, &'static str); 7] {
        [
            ("gain", self.gain, "y/u"),
            ("gain_cool", self.gain_cool, "y/u"),
            ("tau_heat", self.tau_heat, "s"),
            ("tau_cool", self.tau_cool, "s"),
            ("ambient", self.ambient, "y"),
            ("sensor_lag", self.sensor_lag, "s"),
            ("dead_time", self.dead_time, "s"),
        ]
    }

    pub(super) fn rest(&self, y0: f64, d0: f64) -> Option<([f64; 2], f64)> {
        let x = y0 - self.ambient;
        let gain = self.gain_at(x)?;
        Some(([x, x], x / gain - d0))
    }

    pub(super) fn range(&self) -> [f64; 2] {
        let lowest = if self.gain_cool > 0.0 { f64::NEG_INFINITY } else { self.ambient };
        [lowest, f64::INFINITY]
    }

    /// The gain that holds `x`; none when nothing does.
    fn gain_at(&self, x: f64) -> Option<f64> {
        let gain = if x >= 0.0 { self.gain } else { self.gain_cool };
        (gain > 0.0).then_some(gain)
    }

    /// With the shorter of the two lags, which gives the loop the higher gain at high frequencies.
    pub(super) fn linear_model(&self, y0: f64, _: f64) -> Option<TransferFunction> {
        let gain = self.gain_at(y0 - self.ambient)?;
        let lag = self.tau_heat.min(self.tau_cool);
        let sensor =
            if self.sensor_lag > 0.0 { format!("*(1+{:e}*s)", self.sensor_lag) } else { String::new() };
        parse(&format!("({gain:e})*exp(-{:e}*s)/((1+{lag:e}*s){sensor})", self.dead_time)).ok()
    }

    pub(super) fn shortest_lag(&self) -> f64 {
        let lag = self.tau_heat.min(self.tau_cool);
        if self.sensor_lag > 0.0 { lag.min(self.sensor_lag) } else { lag }
    }
}
