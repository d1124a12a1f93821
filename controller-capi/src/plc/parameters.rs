//! From the parameters of the function block to the configuration of a loop, and from a fault of that back.

use super::span::Span;
use super::vars::{Choice, Parameters, Setting, Settings};
use crate::config::Config;
use crate::fault::{Fault, Faults, choice, number};
use controller_core::{Param, Real, Reason};
use core::ffi::CStr;

/// A parameter that was refused, and why.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Refusal {
    pub(crate) param: i32,
    pub(crate) reason: i32,
}

/// Longest SCAN_DIV.
const MAX_DIVIDER: i32 = 65535;
/// Most that PV_UNDER and PV_OVER may be \[%\].
const MAX_BEYOND: f64 = 1000.0;

impl Refusal {
    fn of(param: i32, reason: Reason) -> Self {
        Self { param, reason: number(reason) }
    }
}

fn unless(good: bool, param: i32, reason: Reason) -> Result<(), Refusal> {
    if good { Ok(()) } else { Err(Refusal::of(param, reason)) }
}

impl<T: Real> Parameters<T> {
    pub(crate) fn pv_span(&self) -> Span {
        Span { lo: self.settings.pv_lo.to_f64(), hi: self.settings.pv_hi.to_f64() }
    }

    pub(crate) fn op_span(&self) -> Span {
        Span { lo: self.settings.op_lo.to_f64(), hi: self.settings.op_hi.to_f64() }
    }

    pub(crate) fn pv_counts(&self) -> Span {
        Span::of_counts(self.choices.pv_raw_lo, self.choices.pv_raw_hi)
    }

    pub(crate) fn op_counts(&self) -> Span {
        Span::of_counts(self.choices.op_raw_lo, self.choices.op_raw_hi)
    }

    /// Calls from one sample to the next.
    pub(crate) fn divider(&self) -> u32 {
        u32::try_from(self.choices.scan_div).unwrap_or(1).max(1)
    }

    /// Stands for all of them; never 0. FNV-1a, 64 bits.
    pub(crate) fn digest(&self) -> u64 {
        let numbers = self.settings.list().flat_map(T::to_words);
        let choices = self.choices.list().map(i32::cast_unsigned);
        let switches = self.switches.list().map(u32::from);
        let words = numbers.chain(choices).chain(switches);
        let digest = words.fold(0xCBF2_9CE4_8422_2325, |sum: u64, word| {
            word.to_le_bytes()
                .iter()
                .fold(sum, |sum, &byte| (sum ^ u64::from(byte)).wrapping_mul(0x0100_0000_01B3))
        });
        digest.max(1)
    }

    /// The first fault of their configuration, under the name that the block's user knows.
    pub(crate) fn blame(&self, faults: &Faults) -> Refusal {
        let [Fault { param, reason, .. }, ..] = faults.list;
        let param = origin(param);
        // The factors of the model have one name in a configuration.
        let Settings { m_a1, m_a2, .. } = self.settings;
        let lag = param == Setting::m_a1 as i32 && m_a1 == T::ZERO && m_a2 == T::ZERO;
        Refusal { param: if lag { Setting::m_t1 as i32 } else { param }, reason }
    }

    /// Faults that the configuration of a loop cannot have.
    fn check(&self) -> Result<(), Refusal> {
        let (s, c) = (&self.settings, &self.choices);
        for (param, x) in (1..).zip(s.list()) {
            unless(x.is_finite_number(), param, Reason::NotFinite)?;
        }
        let within = |x: T, lo: f64, hi: f64, param: Setting| {
            let x = x.to_f64();
            unless(x >= lo && x <= hi, param as i32, Reason::OutOfRange)
        };
        let any = f64::INFINITY;
        within(s.tn, 0.0, any, Setting::tn)?;
        within(s.tv, 0.0, any, Setting::tv)?;
        within(s.tt, 0.0, any, Setting::tt)?;
        within(s.pv_under, 0.0, MAX_BEYOND, Setting::pv_under)?;
        within(s.pv_over, 0.0, MAX_BEYOND, Setting::pv_over)?;
        let times = [
            (s.m_t1, Setting::m_t1),
            (s.m_t2, Setting::m_t2),
            (s.m_t3, Setting::m_t3),
            (s.m_t4, Setting::m_t4),
        ];
        for (time, param) in times {
            within(time, 0.0, any, param)?;
        }
        let inverted = Reason::Inverted;
        unless(s.pv_lo != s.pv_hi, Setting::pv_hi as i32, inverted)?;
        unless(s.op_lo != s.op_hi, Setting::op_hi as i32, inverted)?;
        unless(c.pv_raw_lo != c.pv_raw_hi, Choice::pv_raw_hi as i32, inverted)?;
        unless(c.op_raw_lo != c.op_raw_hi, Choice::op_raw_hi as i32, inverted)?;
        let span = self.op_span().sorted();
        within(s.op_lim_lo, span.lo, span.hi, Setting::op_lim_lo)
            .or_else(|fault| self.given_limits(fault))?;
        within(s.op_lim_hi, span.lo, span.hi, Setting::op_lim_hi)
            .or_else(|fault| self.given_limits(fault))?;
        let out_of_range = Reason::OutOfRange;
        unless((0..=MAX_DIVIDER).contains(&c.scan_div), Choice::scan_div as i32, out_of_range)?;
        unless((0..=2).contains(&c.pv_src), Choice::pv_src as i32, out_of_range)
    }

    /// Limits of OP that are both 0 are not given.
    fn given_limits(&self, fault: Refusal) -> Result<(), Refusal> {
        let Settings { op_lim_lo, op_lim_hi, .. } = self.settings;
        if op_lim_lo == T::ZERO && op_lim_hi == T::ZERO { Ok(()) } else { Err(fault) }
    }

    /// The configuration of the loop.
    ///
    /// # Errors
    /// What the loop itself would not find, or would find under another name.
    pub(crate) fn config(&self) -> Result<Config, Refusal> {
        self.check()?;
        let s = &self.settings;
        let n = T::to_f64;
        let c = &self.choices;
        let w = &self.switches;
        let size = |x: f64| if x < 0.0 { -x } else { x };
        let (pv, op) = (self.pv_span(), self.op_span());
        let kp = if w.kp_percent == 0 { size(n(s.kp)) } else { size(n(s.kp)) * op.width() / pv.width() };
        let given = |x: f64| if x == 0.0 { f64::NAN } else { x };
        let enabled = |flag: u8, x: f64| if flag == 0 { f64::NAN } else { x };
        let limits = |lo: f64, hi: f64, span: Span| {
            if lo == 0.0 && hi == 0.0 { span.sorted() } else { Span { lo, hi } }
        };
        let valid =
            Span { lo: pv.at(-n(s.pv_under) / 100.0), hi: pv.at(1.0 + n(s.pv_over) / 100.0) }.sorted();
        let (sp_limits, op_limits) =
            (limits(n(s.sp_lim_lo), n(s.sp_lim_hi), pv), limits(n(s.op_lim_lo), n(s.op_lim_hi), op));
        let mut config = Config {
            action: i32::from(w.direct != 0),
            integral_rule: i32::from(w.trapezoid != 0),
            anti_windup: c.aw,
            setpoint_track: i32::from(w.sp_track != 0),
            fallback_action: c.fail_act,
            fallback_return: i32::from(w.fail_ack != 0),
            hold_samples: c.fail_hold,
            compensator: c.comp,
            filter_order: c.filter_order,
            model_integrators: c.m_integ,
            ts: n(s.ts),
            kp,
            ki: if n(s.tn) == 0.0 { 0.0 } else { kp / n(s.tn) },
            kd: kp * n(s.tv),
            tf: n(s.tf),
            b: n(s.b),
            c: n(s.c),
            output_lo: op_limits.lo,
            output_hi: op_limits.hi,
            output_rate_up: given(n(s.op_rate_up)),
            output_rate_down: given(n(s.op_rate_dn)),
            setpoint_lo: sp_limits.lo,
            setpoint_hi: sp_limits.hi,
            setpoint_rate_up: given(n(s.sp_rate_up)),
            setpoint_rate_down: given(n(s.sp_rate_dn)),
            tt: given(n(s.tt)),
            deadband: n(s.deadband),
            measurement_lo: valid.lo,
            measurement_hi: valid.hi,
            offset_lo: -op.width(),
            offset_hi: op.width(),
            fallback_output: if c.fail_act == 0 { f64::NAN } else { n(s.fail_op) },
            fallback_rate: n(s.fail_rate),
            alarm_hi_hi: enabled(w.hh_en, n(s.hh_lim)),
            alarm_hi: enabled(w.h_en, n(s.h_lim)),
            alarm_lo: enabled(w.l_en, n(s.l_lim)),
            alarm_lo_lo: enabled(w.ll_en, n(s.ll_lim)),
            alarm_deviation: given(n(s.dev_lim)),
            alarm_hysteresis: n(s.alm_hyst),
            off_output: if w.off_hold == 0 { n(s.off_op) } else { f64::NAN },
            initial_output: n(s.op_init),
            latency: n(s.latency),
            kfd: given(n(s.kfd)),
            tfd: n(s.tfd),
            alpha: n(s.alpha),
            model_gain: n(s.m_gain),
            model_dead_time: n(s.m_dead),
            ..Config::default()
        };
        let factors =
            [(s.m_t1, T::ZERO), (s.m_t2, T::ZERO), (s.m_t3, T::ZERO), (s.m_t4, T::ZERO), (s.m_a1, s.m_a2)];
        config.set_model(factors.map(|(a1, a2)| (n(a1), n(a2))), n(s.m_tz));
        Ok(config)
    }
}

impl Config {
    /// The factors of the model, in the order of the variables; those that are 0 are none.
    fn set_model(&mut self, factors: [(f64, f64); 5], zero: f64) {
        let places = self.model_pole_a1.iter_mut().zip(self.model_pole_a2.iter_mut());
        let factors = factors.into_iter().filter(|&factor| factor != (0.0, 0.0));
        for ((a1, a2), factor) in places.zip(factors) {
            (*a1, *a2) = factor;
            self.model_pole_count += 1;
        }
        if zero != 0.0 {
            self.model_zero_a1 = [zero, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
            self.model_zero_count = 1;
        }
    }
}

/// The number that ERROR_PARAM has for the delay memory, which is no parameter.
pub(crate) const STATE: i32 = 201;

/// The parameters of the block that fields of the configuration come from. A product of two is charged to the one that
/// nothing else needs.
const ORIGINS: &[(Param, Setting)] = &[
    (Param::Ts, Setting::ts),
    (Param::Kp, Setting::kp),
    (Param::Overflow, Setting::kp),
    (Param::Ki, Setting::tn),
    (Param::Kd, Setting::tv),
    (Param::Tf, Setting::tf),
    (Param::B, Setting::b),
    (Param::C, Setting::c),
    (Param::Tt, Setting::tt),
    (Param::OutputLo, Setting::op_lim_lo),
    (Param::OutputHi, Setting::op_lim_hi),
    (Param::OutputRateUp, Setting::op_rate_up),
    (Param::OutputRateDown, Setting::op_rate_dn),
    (Param::SetpointLo, Setting::sp_lim_lo),
    (Param::SetpointHi, Setting::sp_lim_hi),
    (Param::SetpointRateUp, Setting::sp_rate_up),
    (Param::SetpointRateDown, Setting::sp_rate_dn),
    (Param::Deadband, Setting::deadband),
    (Param::MeasurementLo, Setting::pv_lo),
    (Param::MeasurementHi, Setting::pv_hi),
    (Param::OffsetLo, Setting::op_lo),
    (Param::OffsetHi, Setting::op_hi),
    (Param::FallbackOutput, Setting::fail_op),
    (Param::FallbackRate, Setting::fail_rate),
    (Param::OffOutput, Setting::off_op),
    (Param::InitialOutput, Setting::op_init),
    (Param::AlarmHiHi, Setting::hh_lim),
    (Param::AlarmHi, Setting::h_lim),
    (Param::AlarmLo, Setting::l_lim),
    (Param::AlarmLoLo, Setting::ll_lim),
    (Param::AlarmDeviation, Setting::dev_lim),
    (Param::AlarmHysteresis, Setting::alm_hyst),
    (Param::ModelGain, Setting::m_gain),
    (Param::ModelPoles, Setting::m_a1),
    (Param::ModelZeros, Setting::m_tz),
    (Param::ModelOrder, Setting::m_t1),
    (Param::DeadTime, Setting::m_dead),
    (Param::Latency, Setting::latency),
    (Param::Kfd, Setting::kfd),
    (Param::Tfd, Setting::tfd),
    (Param::Alpha, Setting::alpha),
];

fn origin(field: i32) -> i32 {
    match field {
        choice::ANTI_WINDUP => Choice::aw as i32,
        choice::FALLBACK_ACTION => Choice::fail_act as i32,
        choice::HOLD_SAMPLES => Choice::fail_hold as i32,
        choice::COMPENSATOR => Choice::comp as i32,
        choice::MODEL_INTEGRATORS => Choice::m_integ as i32,
        _ if field == Param::FilterOrder as i32 => Choice::filter_order as i32,
        _ if field == Param::Capacity as i32 => STATE,
        _ => ORIGINS.iter().find(|(from, _)| *from as i32 == field).map_or(0, |(_, to)| *to as i32),
    }
}

/// The name of what ERROR_PARAM says; of 0, which says nothing, and of numbers that it never has, as well.
pub(crate) fn param_name(number: i32) -> &'static CStr {
    match number {
        0 => c"no parameter",
        STATE => c"state",
        _ => Setting::name(number).or_else(|| Choice::name(number)).unwrap_or(c"unknown parameter"),
    }
}
