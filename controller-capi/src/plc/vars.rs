//! The variables of the function block, as C sees them: numbers first, then counts, then BOOLs, so that there is no gap
//! between two of them.

use super::Kind;
use controller_core::Real;

/// Declares a part of [`Vars`]: fields of one type.
macro_rules! part {
    ($(#[$about:meta])* $part:ident $(<$real:ident>)? of $type:ty { $($(#[$doc:meta])* $field:ident,)* }) => {
        $(#[$about])*
        #[repr(C)]
        #[derive(Debug, Clone, Copy, PartialEq, Default)]
        pub struct $part $(<$real>)? { $($(#[$doc])* pub $field: $type,)* }

        impl $(<$real>)? $part $(<$real>)? {
            /// The names, in order.
            pub const NAMES: &'static [&'static str] = &[$(stringify!($field)),*];
        }

        impl $(<$real: Copy>)? $part $(<$real>)? {
            /// The values, in order.
            pub fn list(&self) -> impl Iterator<Item = $type> {
                self.as_slice().iter().copied()
            }

            pub(crate) fn as_slice(&self) -> &[$type] {
                // SAFETY: fields of one type in the order of C stand like those of an array.
                unsafe { core::slice::from_raw_parts((&raw const *self).cast(), Self::NAMES.len()) }
            }
        }
    };
}

/// The same for parameters, which have numbers and names for reports.
macro_rules! parameters {
    ($(#[$about:meta])* $part:ident $(<$real:ident>)? of $type:ty, $number:ident after $start:literal
        { $($(#[$doc:meta])* $field:ident,)* }) => {
        part! { $(#[$about])* $part $(<$real>)? of $type { $($(#[$doc])* $field,)* } }

        /// The numbers of these parameters in ERROR_PARAM.
        #[allow(non_camel_case_types, missing_docs, clippy::upper_case_acronyms)]
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        #[repr(i32)]
        pub enum $number { none = $start, $($field),* }

        impl $number {
            /// The name of the parameter with this number.
            pub(crate) fn name(number: i32) -> Option<&'static core::ffi::CStr> {
                $(if number == Self::$field as i32 {
                    let name = concat!(stringify!($field), "\0").as_bytes();
                    return core::ffi::CStr::from_bytes_with_nul(name).ok();
                })*
                None
            }
        }
    };
}

part! {
    /// What the block reads in each scan: numbers.
    Signals<T> of T {
        /// Local set-point \[PV unit\]; moved into its limits.
        sp,
        /// Set-point with CAS \[PV unit\]; moved into the limits.
        sp_remote,
        /// Measurement \[PV unit, or % of the span\], see PV_SRC; outside the span and its margins: bad.
        pv,
        /// Output with MAN \[OP unit\]; moved into the limits.
        op_man,
        /// What the actuator, or the inner loop, really took \[OP unit\]; counts with RB_USE.
        op_readback,
        /// Output with TRK \[OP unit\]; moved into the limits.
        trk_value,
        /// Feed-forward, added inside the limits \[OP unit\]; up to the width of the span, up or down.
        ff,
        /// Measured time since the last call \[s\], above 0; 0: not measured.
        tcyc,
    }
}

parameters! {
    /// Parameters: numbers.
    Settings<T> of T, Setting after 0 {
        /// Period of the law \[s\], above 0: SCAN_DIV periods of the task.
        ts,
        /// Gain; only its size counts, DIRECT gives the direction [OP unit / PV unit], with KP_PERCENT [%/%].
        kp,
        /// Reset time \[s\], above 0; 0: no integral action.
        tn,
        /// Rate time \[s\], above 0, needs TF; 0: no derivative action.
        tv,
        /// Filter time over all terms \[s\], at least TS/2; 0: no filter.
        tf,
        /// Set-point weight of the proportional term, 0 to 2.
        b,
        /// Set-point weight of the derivative term, 0 to 2.
        c,
        /// Tracking time of the anti-windup \[s\], above 0; 0: the largest of TN, TF, TS.
        tt,
        /// Half width of the error deadband \[PV unit\], 0 or more.
        deadband,
        /// Measurement at PV_RAW_LO and at 0 % \[PV unit\]; not PV_HI.
        pv_lo,
        /// Measurement at PV_RAW_HI and at 100 % \[PV unit\]; may be below PV_LO.
        pv_hi,
        /// How far beyond PV_LO a measurement is still valid \[% of the span\], 0 to 1000.
        pv_under,
        /// How far beyond PV_HI a measurement is still valid \[% of the span\], 0 to 1000.
        pv_over,
        /// Lowest set-point \[PV unit\], below SP_LIM_HI; both 0: the span of PV.
        sp_lim_lo,
        /// Highest set-point \[PV unit\]; both 0: the span of PV.
        sp_lim_hi,
        /// Fastest rise of the set-point [PV unit/s], above 0; 0: any.
        sp_rate_up,
        /// Fastest fall of the set-point [PV unit/s], above 0; 0: any.
        sp_rate_dn,
        /// Output at OP_RAW_LO and at 0 % \[OP unit\]; not OP_HI.
        op_lo,
        /// Output at OP_RAW_HI and at 100 % \[OP unit\]; may be below OP_LO.
        op_hi,
        /// Lowest output \[OP unit\], inside the span, below OP_LIM_HI; both 0: the span.
        op_lim_lo,
        /// Highest output \[OP unit\], inside the span; both 0: the span.
        op_lim_hi,
        /// Fastest rise of the output [OP unit/s], above 0; 0: any.
        op_rate_up,
        /// Fastest fall of the output [OP unit/s], above 0; 0: any.
        op_rate_dn,
        /// Output before the first good measurement \[OP unit\], moved into the limits.
        op_init,
        /// Output with OFF \[OP unit\], within the limits; counts without OFF_HOLD.
        off_op,
        /// Output while the measurement is bad \[OP unit\], within the limits; counts with FAIL_ACT 1, 2.
        fail_op,
        /// Rate towards FAIL_OP [OP unit/s], above 0; counts with FAIL_ACT 2.
        fail_rate,
        /// Alarm level, measurement very high \[PV unit\], above the next one; counts with HH_EN.
        hh_lim,
        /// Alarm level, measurement high \[PV unit\], above the next one; counts with H_EN.
        h_lim,
        /// Alarm level, measurement low \[PV unit\], above the next one; counts with L_EN.
        l_lim,
        /// Alarm level, measurement very low \[PV unit\]; counts with LL_EN.
        ll_lim,
        /// Alarm level, size of the deviation \[PV unit\], above 0; 0: no such alarm.
        dev_lim,
        /// How far a signal must come back before its alarm goes \[PV unit\], 0 or more.
        alm_hyst,
        /// Time from reading PV to acting OP \[s\], 0 or more.
        latency,
        /// Gain of the disturbance estimator, above 0, up to 1; counts with COMP 1.
        kfd,
        /// Filter time of the disturbance estimator \[s\], above 0; counts with COMP 1.
        tfd,
        /// Filter time of the disturbance observer \[s\], above 0; counts with COMP 2.
        alpha,
        /// Gain of the model, with its sign, not 0 [PV unit / OP unit, / s for each integrator].
        m_gain,
        /// Dead time of the model \[s\], 0 or more.
        m_dead,
        /// Time constant of the model \[s\], above 0; 0: none.
        m_t1,
        /// A second time constant \[s\], above 0; 0: none.
        m_t2,
        /// A third time constant \[s\], above 0; 0: none.
        m_t3,
        /// A fourth time constant \[s\], above 0; 0: none.
        m_t4,
        /// Factor 1 + M_A1*s + M_A2*s^2 of the model's denominator \[s\], above 0; both 0: none.
        m_a1,
        /// The coefficient of s^2 in that factor [s^2], 0 or more.
        m_a2,
        /// Numerator 1 + M_TZ*s of the model \[s\], any sign; 0: none.
        m_tz,
    }
}

part! {
    /// What the block gives: numbers. All of them are finite.
    Results<T> of T {
        /// Output \[OP unit\], within its limits.
        op,
        /// Output \[% of the span\].
        op_percent,
        /// The measurement that was used \[PV unit\]; while there is none, the last finite one.
        pv_eng,
        /// Working set-point \[PV unit\].
        sp_working,
        /// SP_WORKING - PV_ENG \[PV unit\].
        dev,
        /// Integral term \[OP unit\].
        i_term,
        /// Proportional and derivative terms, filtered \[OP unit\].
        pd_term,
        /// Output of the compensator, used or not \[OP unit\].
        uf,
        /// Estimated disturbance at the plant's input, relative to the start \[OP unit\].
        d_hat,
        /// For a primary loop: its OP_READBACK and its TRK_VALUE \[PV unit\].
        bkcal_out,
        /// Measured period of the law \[s\]; 0: not measured.
        period,
    }
}

part! {
    /// What the block reads in each scan: whole numbers.
    Codes of i32 {
        /// Measurement in counts, any; used with PV_SRC 1.
        pv_raw,
        /// 2 good, 1 uncertain (used, and shown), any other: bad.
        pv_quality,
    }
}

parameters! {
    /// Parameters: whole numbers.
    Choices of i32, Choice after 100 {
        /// The law runs in every n-th call, 0 to 65535; 0 and 1: in every call.
        scan_div,
        /// The measurement is: 0 PV, engineering unit; 1 PV_RAW, counts; 2 PV, per cent of the span.
        pv_src,
        /// Counts at PV_LO; not PV_RAW_HI.
        pv_raw_lo,
        /// Counts at PV_HI; may be below PV_RAW_LO.
        pv_raw_hi,
        /// Counts at OP_LO; not OP_RAW_HI.
        op_raw_lo,
        /// Counts at OP_HI; may be below OP_RAW_LO.
        op_raw_hi,
        /// Anti-windup: 0 back-calculation, 1 conditional integration, 2 none.
        aw,
        /// When the measurement stays bad: 0 hold the output, 1 go to FAIL_OP, 2 ramp to FAIL_OP.
        fail_act,
        /// Bad samples in a row that are held before FAIL_ACT, 0 to 65535.
        fail_hold,
        /// Compensator: 0 none, 1 disturbance estimator, 2 disturbance observer.
        comp,
        /// Order of the observer's filter, up to 8; 0: the smallest possible.
        filter_order,
        /// Integrators of the model, 0 to 8.
        m_integ,
    }
}

/// What the block gives: whole numbers.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Reports {
    /// Output in counts, rounded, within its span.
    pub op_raw: i32,
    /// Mode in force: the numbers of [`mode`](crate::io::mode), of Fallback 7.
    pub mode: i32,
    /// Error code of the interface; 0: none.
    pub error: i32,
    /// The parameter that was refused: number of a [`Setting`] or of a [`Choice`].
    pub error_param: i32,
    /// Why: number of a [`Reason`](controller_core::Reason).
    pub error_reason: i32,
    /// Bits of [`Status`](controller_core::Status) and of [`status`](super::status).
    pub status: u32,
}

impl Reports {
    /// The names, in order.
    pub const NAMES: &'static [&'static str] =
        &["op_raw", "mode", "error", "error_param", "error_reason", "status"];
}

part! {
    /// What the block reads in each scan: BOOL, 0 FALSE, any other number TRUE.
    Commands of u8 {
        /// Out of service: OP goes to OFF_OP, or stays.
        off,
        /// OP follows TRK_VALUE.
        trk,
        /// Manual: OP is OP_MAN.
        man,
        /// OP stays.
        hold,
        /// Closed loop on SP_REMOTE.
        cas,
        /// AUTO (`auto` is a word of C): closed loop on SP. None of the six: as with HOLD.
        auto_,
        /// OP_READBACK is valid.
        rb_use,
        /// The integral term must not drive the output up.
        inhibit_up,
        /// The integral term must not drive the output down.
        inhibit_dn,
        /// Lets a latched fallback end; clears the bit that says that the state was lost.
        ack,
        /// Use the compensator.
        compensate,
        /// The plant has gone on without this block: begin anew at PV and OP. TRUE for one scan.
        restart,
    }
}

part! {
    /// Parameters: BOOL.
    Switches of u8 {
        /// FALSE: PV rises, OP falls (reverse); TRUE: PV rises, OP rises (direct).
        direct,
        /// KP is in per cent of the span of OP per per cent of the span of PV.
        kp_percent,
        /// Integral by the trapezoidal rule.
        trapezoid,
        /// With OFF, MAN, TRK the working set-point follows the measurement.
        sp_track,
        /// With OFF the output stays.
        off_hold,
        /// After a fallback wait for ACK.
        fail_ack,
        /// HH_LIM counts.
        hh_en,
        /// H_LIM counts.
        h_en,
        /// L_LIM counts.
        l_en,
        /// LL_LIM counts.
        ll_en,
    }
}

part! {
    /// What the block gives: BOOL, 0 or 1.
    Flags of u8 {
        /// The loop is closed: Auto or Cascade.
        in_auto,
        /// The loop is closed on SP_REMOTE.
        in_cas,
        /// A higher set-point cannot act: INHIBIT_UP of a primary loop.
        blocked_up,
        /// A lower set-point cannot act: INHIBIT_DN of a primary loop.
        blocked_dn,
        /// Alarm: measurement very high.
        hh_alm,
        /// Alarm: measurement high.
        h_alm,
        /// Alarm: measurement low.
        l_alm,
        /// Alarm: measurement very low.
        ll_alm,
        /// Alarm: deviation.
        dev_alm,
        /// ERROR is not 0.
        fault,
    }
}

impl Reports {
    /// The values, in order.
    pub fn list(&self) -> impl Iterator<Item = u32> {
        let Self { op_raw, mode, error, error_param, error_reason, status } = *self;
        [op_raw, mode, error, error_param, error_reason, status.cast_signed()]
            .map(i32::cast_unsigned)
            .into_iter()
    }
}

/// `ctl_f32_fb_vars`, `ctl_f64_fb_vars`: the variables of the function block. In C the fields of all parts stand in one
/// structure, in this order.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Vars<T> {
    /// Inputs.
    pub signals: Signals<T>,
    /// Parameters.
    pub settings: Settings<T>,
    /// Outputs.
    pub results: Results<T>,
    /// Inputs.
    pub codes: Codes,
    /// Parameters.
    pub choices: Choices,
    /// Outputs.
    pub reports: Reports,
    /// Inputs.
    pub commands: Commands,
    /// Parameters.
    pub switches: Switches,
    /// Outputs.
    pub flags: Flags,
}

/// What is adopted as a whole.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Parameters<T> {
    pub(crate) settings: Settings<T>,
    pub(crate) choices: Choices,
    pub(crate) switches: Switches,
}

impl<T: Real> Vars<T> {
    pub(crate) fn parameters(&self) -> Parameters<T> {
        Parameters { settings: self.settings, choices: self.choices, switches: self.switches }
    }

    /// The values that the variables begin with, where a runtime can give them any: the same as in the ST file.
    #[must_use]
    pub fn initial() -> Self {
        let number = T::from_f64;
        Self {
            signals: Signals::default(),
            settings: Settings {
                ts: number(0.1),
                kp: number(1.0),
                tn: number(10.0),
                b: number(1.0),
                pv_hi: number(100.0),
                pv_under: number(2.0),
                pv_over: number(5.0),
                op_hi: number(100.0),
                ..Settings::default()
            },
            results: Results::default(),
            codes: Codes { pv_quality: 2, ..Codes::default() },
            choices: Choices {
                scan_div: 1,
                pv_raw_hi: 27648,
                op_raw_hi: 27648,
                fail_hold: 25,
                ..Choices::default()
            },
            reports: Reports::default(),
            commands: Commands { auto_: 1, compensate: 1, ..Commands::default() },
            switches: Switches::default(),
            flags: Flags::default(),
        }
    }

    /// Every variable in the order of the structure: name, kind, offset in bytes.
    pub fn fields() -> impl Iterator<Item = (&'static str, Kind, usize)> {
        use core::mem::offset_of;
        let part = |names: &'static [&'static str], kind: Kind, start: usize, size: usize| {
            names.iter().enumerate().map(move |(i, &name)| (name, kind, start + i * size))
        };
        let real = size_of::<T>();
        part(Signals::<T>::NAMES, Kind::Real, offset_of!(Self, signals), real)
            .chain(part(Settings::<T>::NAMES, Kind::Real, offset_of!(Self, settings), real))
            .chain(part(Results::<T>::NAMES, Kind::Real, offset_of!(Self, results), real))
            .chain(part(Codes::NAMES, Kind::Whole, offset_of!(Self, codes), 4))
            .chain(part(Choices::NAMES, Kind::Whole, offset_of!(Self, choices), 4))
            .chain(part(Reports::NAMES, Kind::Whole, offset_of!(Self, reports), 4))
            .chain(part(Commands::NAMES, Kind::Flag, offset_of!(Self, commands), 1))
            .chain(part(Switches::NAMES, Kind::Flag, offset_of!(Self, switches), 1))
            .chain(part(Flags::NAMES, Kind::Flag, offset_of!(Self, flags), 1))
            .map(|(name, kind, at)| (name, if name == "status" { Kind::Bits } else { kind }, at))
    }
}

// On this side the layout is asserted for every target that is built; the C side asserts each field (`tests/c/layout_fb.c`).
const _: () = {
    use core::mem::offset_of;
    assert!(size_of::<Vars<f32>>() == 372 && size_of::<Vars<f64>>() == 632);
    assert!(offset_of!(Vars<f32>, codes) == 4 * 65 && offset_of!(Vars<f64>, codes) == 8 * 65);
    assert!(offset_of!(Vars<f32>, commands) == 4 * 85 && offset_of!(Vars<f64>, commands) == 8 * 65 + 80);
};
