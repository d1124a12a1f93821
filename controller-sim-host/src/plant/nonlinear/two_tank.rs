//! Two tanks in a circle: a pump lifts water from the feed tank into the upper one, which drains back through a valve.

use super::CONDITIONS;
use controller_design::model::{TransferFunction, parse};

/// Below this head, as a share of the tank's height, the outflow is laminar and goes to zero along a parabola instead of
/// the root, whose slope at zero is infinite.
const LAMINAR: f64 = 1e-6;

pub(super) const CONDITION_TEXTS: [&str; CONDITIONS] = [
    "the upper tank was empty",
    "the upper tank ran over its rim",
    "the feed tank was empty",
    "the pump was told a duty outside 0 to 100 %",
    "the valve was told an opening outside 0 to 100 %",
];

/// Where the disturbance of a [`TwoTank`] acts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum TankLoad {
    /// It adds to the opening of the drain valve \[%\], without dead time.
    #[default]
    Valve,
    /// It adds to the pump's duty \[%\], before the dead time.
    Input,
}

/// The rig of section 7 of Tena, Peñarrocha-Alós and Sanchis (2022), in the paper's units: cm, s, V, %.
///
/// The input `u` is the duty of the pump's supply, its voltage `V = supply*u/100`. With the level `h` of the upper tank:
///
/// ```text
/// area*h' = q_in - q_out
/// q_in    = pump*max(V - pump_start, 0)
/// q_out   = drain*valve/100*sqrt(h + drop)
/// ```
///
/// `u` and `valve` are moved into 0 to 100 %. What spills over the rim runs back into the feed tank, and the pump lifts no
/// more than there is: the level stays between 0 and [`top`](Self::top). Below a head of a millionth of `height` the
/// outflow is laminar.
///
/// The paper prints the linear model, the supply of 15 V and the ranges of duty and level, no dimensions. The defaults of
/// the others are chosen, so that at 25 cm, a duty of 50 % and a valve half open the linear model is the one printed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TwoTank {
    /// Cross-section of the upper tank \[cm^2\].
    pub area: f64,
    /// Its height \[cm\].
    pub height: f64,
    /// From its bottom down to the end of the drain \[cm\].
    pub drop: f64,
    /// Outflow through the open valve per root of the head \[cm^2.5/s\].
    pub drain: f64,
    /// Opening of the valve without a disturbance \[%\].
    pub valve: f64,
    /// Supply voltage of the pump \[V\].
    pub supply: f64,
    /// Flow of the pump per volt \[cm^3/(s V)\].
    pub pump: f64,
    /// Voltage from which on it lifts water at all \[V\].
    pub pump_start: f64,
    /// Cross-section of the feed tank \[cm^2\].
    pub feed_area: f64,
    /// Its level while the upper tank is empty \[cm\].
    pub feed_level: f64,
    /// From the pump to the upper tank \[s\].
    pub dead_time: f64,
    /// Where the disturbance acts.
    pub load: TankLoad,
}

impl Default for TwoTank {
    fn default() -> Self {
        Self {
            area: 80.3,
            height: 50.0,
            drop: 24.5,
            // 4*sqrt(49.5): 99 cm^3/s at 25 cm with the valve half open.
            drain: 28.142_494_558_940_577,
            valve: 50.0,
            supply: 15.0,
            pump: 13.2,
            pump_start: 0.0,
            feed_area: 200.0,
            feed_level: 40.0,
            dead_time: 3.2,
            load: TankLoad::Valve,
        }
    }
}

impl TwoTank {
    /// The highest level: the rim, or where all the water is in the upper tank \[cm\].
    #[must_use]
    pub fn top(&self) -> f64 {
        self.height.min(self.all_water())
    }

    /// The level that all the water would have in the upper tank \[cm\].
    fn all_water(&self) -> f64 {
        self.feed_level * self.feed_area / self.area
    }

    /// Flow of the pump at the duty `u` \[cm^3/s\].
    #[must_use]
    pub fn inflow(&self, u: f64) -> f64 {
        let volts = self.supply * u.clamp(0.0, 100.0) / 100.0;
        self.pump * (volts - self.pump_start).max(0.0)
    }

    /// Flow through the drain at the level `h`, with the valve opened by `d` more \[cm^3/s\].
    #[must_use]
    pub fn outflow(&self, h: f64, d: f64) -> f64 {
        self.conductance(d) * self.root(h + self.drop)
    }

    /// Outflow per root of the head \[cm^2.5/s\].
    fn conductance(&self, d: f64) -> f64 {
        self.drain * (self.opening(d) / 100.0)
    }

    /// Opening of the valve \[%\].
    fn opening(&self, d: f64) -> f64 {
        if self.load == TankLoad::Valve { (self.valve + d).clamp(0.0, 100.0) } else { self.valve }
    }

    /// The root of a head; a parabola with the same value and slope below that of laminar flow.
    fn root(&self, head: f64) -> f64 {
        let laminar = LAMINAR * self.height;
        if head >= laminar {
            return libm::sqrt(head);
        }
        let x = (head / laminar).max(0.0);
        libm::sqrt(laminar) * x * (1.5 - 0.5 * x)
    }

    /// The head that has this root.
    fn head(&self, root: f64) -> f64 {
        let laminar = LAMINAR * self.height;
        if root * root >= laminar {
            return root * root;
        }
        // x*(1.5 - 0.5*x) = r, the smaller solution, without cancellation.
        let r = root / libm::sqrt(laminar);
        laminar * 2.0 * r / (1.5 + libm::sqrt(2.25 - 2.0 * r))
    }

    /// Slope of the root of a head.
    fn root_slope(&self, head: f64) -> f64 {
        let laminar = LAMINAR * self.height;
        if head >= laminar {
            return 0.5 / libm::sqrt(head);
        }
        (1.5 - (head / laminar).max(0.0)) / libm::sqrt(laminar)
    }

    /// Speed of the level \[cm/s\].
    pub(super) fn rise(&self, h: f64, u: f64, d: f64) -> f64 {
        let net = self.inflow(u) - self.outflow(h, d);
        let at_end = (h <= 0.0 && net < 0.0) || (h >= self.top() && net > 0.0);
        if at_end { 0.0 } else { net / self.area }
    }

    pub(super) fn parameters(&self) -> [(&'static str, f64, &'static str); 11] {
        [
            ("area", self.area, "cm^2"),
            ("height", self.height, "cm"),
            ("drop", self.drop, "cm"),
            ("drain", self.drain, "cm^2.5/s"),
            ("valve", self.valve, "%"),
            ("supply", self.supply, "V"),
            ("pump", self.pump, "cm^3/(s V)"),
            ("pump_start", self.pump_start, "V"),
            ("feed_area", self.feed_area, "cm^2"),
            ("feed_level", self.feed_level, "cm"),
            ("dead_time", self.dead_time, "s"),
        ]
    }

    pub(super) fn rest(&self, h: f64, d: f64) -> Option<([f64; 2], f64)> {
        let needed = self.outflow(h, d);
        let volts = needed / self.pump + if needed > 0.0 { self.pump_start } else { 0.0 };
        let u = 100.0 * volts / self.supply;
        let is_possible = h >= 0.0 && h <= self.top() && u <= 100.0;
        let own = if self.load == TankLoad::Input { d } else { 0.0 };
        is_possible.then_some(([h, 0.0], u - own))
    }

    /// Where the pump can hold the level, without the ends, at which the tank runs empty or over.
    pub(super) fn range(&self, d: f64) -> Option<[f64; 2]> {
        // Behind a closed valve the level stays anywhere, and an input only integrates.
        let conductance = Some(self.conductance(d)).filter(|conductance| *conductance > 0.0)?;
        let most = (self.head(self.inflow(100.0) / conductance) - self.drop).min(self.top());
        (most > 0.0).then_some([0.0, most])
    }

    pub(super) fn linear_model(&self, h: f64, d: f64) -> Option<TransferFunction> {
        let (_, u) = self.rest(h, d)?;
        let u = u + if self.load == TankLoad::Input { d } else { 0.0 };
        // Linear only where water flows and less than all of the pump is in use.
        if !(h > 0.0 && h < self.top() && u < 100.0 && self.conductance(d) > 0.0) {
            return None;
        }
        let slope = self.conductance(d) * self.root_slope(h + self.drop);
        let gain = self.pump * self.supply / 100.0 / slope;
        let lag = self.area / slope;
        parse(&format!("({gain:e})*exp(-{:e}*s)/(1+{lag:e}*s)", self.dead_time)).ok()
    }

    pub(super) fn shortest_lag(&self) -> f64 {
        let open = match self.load {
            TankLoad::Valve => self.drain,
            TankLoad::Input => self.conductance(0.0),
        };
        let steepest = open * self.root_slope(self.drop);
        if steepest > 0.0 { self.area / steepest } else { f64::INFINITY }
    }

    pub(super) fn conditions(&self, h: f64, u: f64, d: f64) -> [bool; CONDITIONS] {
        let net = self.inflow(u) - self.outflow(h, d);
        let is_dry = self.all_water() < self.height;
        let (is_full, is_empty) = (h >= self.top() && net > 0.0, h <= 0.0 && net < 0.0);
        let beyond = |percent: f64| !(-1e-9..=100.0 + 1e-9).contains(&percent);
        let valve = self.load == TankLoad::Valve && beyond(self.valve + d);
        [is_empty, is_full && !is_dry, is_full && is_dry, beyond(u), valve]
    }
}
