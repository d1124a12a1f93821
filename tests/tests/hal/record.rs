//! What the loops of the trace are fed with: changes of everything, at random.

/// Everything that is streamed into HAL in one sample, in the order of the columns.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Row {
    pub(crate) setpoint: f64,
    pub(crate) setpoint_remote: f64,
    /// Added to the outputs on their way to the plants.
    pub(crate) load: f64,
    pub(crate) kp: f64,
    pub(crate) ki: f64,
    pub(crate) feed_forward: f64,
    /// Of manual and of track.
    pub(crate) value: f64,
    pub(crate) output_hi: f64,
    pub(crate) quality: i32,
    pub(crate) enable: bool,
    pub(crate) manual: bool,
    pub(crate) track: bool,
    pub(crate) hold: bool,
    pub(crate) cascade: bool,
    pub(crate) compensate: bool,
    pub(crate) inhibit_up: bool,
    pub(crate) inhibit_down: bool,
    pub(crate) acknowledge: bool,
    pub(crate) param_hold: bool,
}

/// The types of the columns, as the streamer has them.
pub(crate) const TYPES: &str = "ffffffffsbbbbbbbbbb";

/// Samples of a run.
pub(crate) const SAMPLES: usize = 4000;

/// A multiplicative generator (Lehmer, modulus 2^31 - 1, factor 48271).
struct Dice(u64);

impl Dice {
    fn throw(&mut self, sides: u64) -> u64 {
        self.0 = self.0 * 48271 % 0x7FFF_FFFF;
        self.0 * sides / 0x7FFF_FFFF
    }

    /// Whether an event that comes about once in `samples` comes now.
    fn comes(&mut self, samples: u64) -> bool {
        self.throw(samples) == 0
    }

    /// A number of three decimals.
    fn number(&mut self, lo: f64, hi: f64) -> f64 {
        let x = lo + (hi - lo) * self.throw(1_000_000) as f64 / 1e6;
        (x * 1e3).round() / 1e3
    }
}

/// The record. It begins at rest with everything in service.
pub(crate) fn record() -> Vec<Row> {
    let mut dice = Dice(20_261);
    let mut row = Row {
        setpoint: 0.0,
        setpoint_remote: 0.0,
        load: 0.0,
        kp: 1.5,
        ki: 15.0,
        feed_forward: 0.0,
        value: 0.2,
        output_hi: 2.0,
        quality: 0,
        enable: true,
        manual: false,
        track: false,
        hold: false,
        cascade: false,
        compensate: true,
        inhibit_up: false,
        inhibit_down: false,
        acknowledge: false,
        param_hold: false,
    };
    let mut rows = vec![row];
    while rows.len() < SAMPLES {
        let mut change = |once: u64, at: &mut f64, lo: f64, hi: f64, unusable: &[f64]| {
            if dice.comes(once) {
                let pick = dice.throw(8) as usize;
                let drawn = dice.number(lo, hi);
                *at = unusable.get(pick).copied().unwrap_or(drawn);
            }
        };
        change(120, &mut row.setpoint, -1.0, 1.0, &[f64::NAN, 1e9]);
        change(200, &mut row.setpoint_remote, -1.0, 1.0, &[f64::INFINITY]);
        change(150, &mut row.load, -0.5, 0.5, &[]);
        change(90, &mut row.kp, 0.5, 3.0, &[f64::NAN, -2e15]);
        change(90, &mut row.ki, 2.0, 30.0, &[0.0]);
        change(300, &mut row.feed_forward, -0.3, 0.3, &[f64::NAN]);
        change(100, &mut row.value, -0.5, 0.5, &[f64::NAN]);
        change(250, &mut row.output_hi, 0.4, 2.0, &[-5.0]);
        // Switches are mostly back in their place: rarely thrown, soon returned.
        let mut switch = |on: u64, off: u64, at: &mut bool, rest: bool| {
            if dice.comes(if *at == rest { on } else { off }) {
                *at = !*at;
            }
        };
        switch(500, 30, &mut row.enable, true);
        switch(300, 40, &mut row.manual, false);
        switch(400, 30, &mut row.track, false);
        switch(300, 30, &mut row.hold, false);
        switch(400, 100, &mut row.cascade, false);
        switch(300, 50, &mut row.compensate, true);
        switch(300, 20, &mut row.inhibit_up, false);
        switch(300, 20, &mut row.inhibit_down, false);
        switch(20, 3, &mut row.acknowledge, false);
        switch(300, 60, &mut row.param_hold, false);
        if dice.comes(if row.quality == 0 { 150 } else { 12 }) {
            row.quality = if row.quality == 0 { 1 + dice.throw(3) as i32 } else { 0 };
        }
        rows.push(row);
    }
    rows
}

/// The record as the streamer reads it.
pub(crate) fn text(rows: &[Row]) -> String {
    let bit = u8::from;
    let mut text = String::new();
    for r in rows {
        text += &format!(
            "{} {} {} {} {} {} {} {} {} ",
            r.setpoint,
            r.setpoint_remote,
            r.load,
            r.kp,
            r.ki,
            r.feed_forward,
            r.value,
            r.output_hi,
            r.quality
        );
        let switches = [r.enable, r.manual, r.track, r.hold, r.cascade, r.compensate];
        let rest = [r.inhibit_up, r.inhibit_down, r.acknowledge, r.param_hold];
        let bits: Vec<String> = switches.iter().chain(&rest).map(|&b| bit(b).to_string()).collect();
        text += &bits.join(" ");
        text.push('\n');
    }
    text
}
