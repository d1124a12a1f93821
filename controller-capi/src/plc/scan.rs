//! What a call of the function block does.

use super::instance::{Contents, Given, Instance, Place, Refused};
use super::parameters::Refusal;
use super::period::Timing;
use super::span::round;
use super::vars::{Commands, Flags, Parameters, Reports, Results, Vars};
use super::{Number, status};
use crate::block::{Block, check_pointer};
use crate::calls;
use crate::config::Config;
use crate::fault::{Error, Faults};
use crate::io::{Input, Output, mode};
use controller_core::{Mode, Status};
use core::ffi::c_void;

/// What stops a call: the error, and the parameter if it is about one.
type Stop = (Error, Refusal);

/// One scan. The error that it gives is in the variables, too, as far as there are any.
///
/// # Safety
/// `vars` is null or the caller's to read and write; `state` as for [`Place::find`].
pub(crate) unsafe fn scan<T: Number>(
    state: *mut c_void,
    size: usize,
    vars: *mut Vars<T>,
) -> Result<(), Error> {
    check_pointer(vars, align_of::<Vars<T>>())?;
    // SAFETY: not null, aligned, the caller's; any bits are variables.
    let mut all = unsafe { vars.read() };
    // SAFETY: by the caller.
    let result = unsafe { run(state, size, &mut all) };
    if let Err((error, Refusal { param, reason })) = result {
        let reports = &mut all.reports;
        (reports.error, reports.error_param, reports.error_reason) = (error as i32, param, reason);
        reports.status = status::NOT_RUNNING;
        // Nobody controls: a loop above must not believe that its set-point acts.
        reports.mode = 0;
        (all.flags.in_auto, all.flags.in_cas) = (0, 0);
        (all.flags.blocked_up, all.flags.blocked_dn) = (1, 1);
        all.flags.fault = 1;
    }
    // SAFETY: as above.
    unsafe { vars.write(all) };
    match (result, all.reports.error) {
        (Err((error, _)), _) => Err(error),
        (Ok(()), 0) => Ok(()),
        (Ok(()), code) if code == Error::Size as i32 => Err(Error::Size),
        (Ok(()), _) => Err(Error::Config),
    }
}

/// # Safety
/// As for [`scan`].
unsafe fn run<T: Number>(state: *mut c_void, size: usize, vars: &mut Vars<T>) -> Result<(), Stop> {
    let unnamed = |error| (error, Refusal::default());
    // SAFETY: by the caller.
    let (place, contents) = unsafe { Place::find::<T>(state, size) }.map_err(unnamed)?;
    let looped = Looped { memory: place.loop_memory::<T>(), size: place.loop_size };
    let parameters = vars.parameters();
    if !matches!(contents, Contents::Running) {
        let mut first = parameters;
        if let (Contents::Unknown, Some(op)) = (&contents, last_output(vars)) {
            // A loop whose memory was lost begins where the actuator is.
            first.settings.op_init = op;
        }
        // SAFETY: the block of the loop is inside the caller's memory, and so is the instance.
        unsafe {
            apply(&first, |config, faults| calls::init::<T>(looped.memory, looped.size, config, faults))?;
            place.write(Instance::new(parameters, matches!(contents, Contents::Unknown)));
        }
    }
    // SAFETY: an instance was found or written.
    let instance = unsafe { place.instance::<T>() };
    instance.notice(vars);
    // A new divider counts at once: the old one may be a slip that would take hours to come round.
    if !instance.is_due() && parameters.divider() != instance.parameters.divider() {
        // SAFETY: the loop has been found or initialised.
        if unsafe { instance.adopt(looped, parameters) } {
            instance.ran = 0;
        }
    }
    if instance.is_due() {
        // SAFETY: the loop has been found or initialised.
        unsafe { instance.sample(looped, vars, parameters) }.map_err(unnamed)?;
    }
    (vars.results, vars.reports, vars.flags) =
        (instance.given.results, instance.given.reports, instance.given.flags);
    // SAFETY: the loop has been found or initialised.
    instance.close(unsafe { looped.block::<T>() }.map_err(unnamed)?.sums());
    Ok(())
}

/// The output that the variables still hold, if anybody has ever written them: a call before, which left a mode, or an error
/// and [`NOT_RUNNING`](status::NOT_RUNNING); or a program that hands over its own copy of OP alone.
fn last_output<T: Number>(vars: &Vars<T>) -> Option<T> {
    let (op, reports) = (vars.results.op, &vars.reports);
    let written = op != T::ZERO || reports.mode != 0 || reports.status & status::NOT_RUNNING != 0;
    (written && op >= T::from_f64(-1e12) && op <= T::from_f64(1e12)).then_some(op)
}

/// Hands the configuration of these parameters to `take`.
fn apply<T: Number>(
    parameters: &Parameters<T>,
    take: impl FnOnce(*const Config, *mut Faults) -> Result<(), Error>,
) -> Result<(), Stop> {
    let config = parameters.config().map_err(|refusal| (Error::Config, refusal))?;
    let mut faults = Faults::default();
    take(&config, &mut faults).map_err(|error| (error, parameters.blame(&faults)))
}

/// The block of the loop.
#[derive(Clone, Copy)]
struct Looped {
    memory: *mut c_void,
    size: usize,
}

impl Looped {
    /// The block, whose law has been looked at in this call.
    ///
    /// # Safety
    /// As for [`Block::find`].
    unsafe fn block<T: Number>(self) -> Result<Block<T>, Error> {
        // SAFETY: by the caller.
        unsafe { Block::find(self.memory, self.size) }
    }
}

impl<T: Number> Instance<T> {
    /// What a call brings, whether the law runs in it or not.
    fn notice(&mut self, vars: &Vars<T>) {
        self.since = self.since.saturating_add(1);
        self.watch.call(vars.signals.tcyc.to_f64());
        self.ack |= vars.commands.ack;
        self.restart |= vars.commands.restart;
    }

    fn is_due(&self) -> bool {
        self.ran == 0 || self.since >= self.parameters.divider()
    }

    /// A sample of the loop.
    ///
    /// # Safety
    /// The loop's block is initialised, and the caller's.
    unsafe fn sample(
        &mut self,
        looped: Looped,
        vars: &Vars<T>,
        parameters: Parameters<T>,
    ) -> Result<(), Error> {
        // SAFETY: by the caller.
        let changed = unsafe { self.adopt(looped, parameters) };
        let first = self.ran == 0 || self.restart != 0 || changed;
        let timing = self.watch.judge(self.parameters.settings.ts.to_f64(), first);
        let lost = if self.restart != 0 { u32::MAX } else { timing.lost };
        let y = self.measurement(vars);
        let input = self.input(vars, y, timing.compensator_out);
        // SAFETY: by the caller.
        let mut block = unsafe { looped.block::<T>() }?;
        if lost > 0 {
            block.advance(lost);
        }
        let output = block.step(&input)?;
        if self.ack != 0 {
            self.lost = 0;
        }
        self.given = Given {
            results: self.results(&output, y, timing),
            reports: self.reports(&output, timing),
            flags: self.flags(&output),
        };
        (self.since, self.ran, self.ack, self.restart) = (0, 1, 0, 0);
        Ok(())
    }

    /// Puts other parameters in force, all of them, or refuses them. Whether what was measured is void.
    ///
    /// # Safety
    /// As for [`sample`](Self::sample).
    unsafe fn adopt(&mut self, looped: Looped, parameters: Parameters<T>) -> bool {
        if parameters == self.parameters {
            self.refused = Refused::default();
            return false;
        }
        let digest = parameters.digest();
        if digest == self.refused.digest {
            return false;
        }
        let adopted = apply(&parameters, |config, faults| {
            // SAFETY: by the caller.
            unsafe { calls::replace(&mut looped.block::<T>()?, config, faults) }
        });
        if let Err((error, refusal)) = adopted {
            self.refused = Refused { digest, error: error as i32, refusal };
            return false;
        }
        let period = |of: &Parameters<T>| (of.settings.ts, of.divider());
        let void = period(&parameters) != period(&self.parameters);
        if void {
            self.watch.forget();
        }
        (self.parameters, self.refused) = (parameters, Refused::default());
        void
    }

    /// The measurement in its engineering unit.
    fn measurement(&self, vars: &Vars<T>) -> T {
        let span = self.parameters.pv_span();
        let fraction = match self.parameters.choices.pv_src {
            1 => self.parameters.pv_counts().fraction(f64::from(vars.codes.pv_raw)),
            2 => vars.signals.pv.to_f64() / 100.0,
            _ => return vars.signals.pv,
        };
        T::from_f64(span.at(fraction))
    }

    fn input(&self, vars: &Vars<T>, y: T, compensator_out: bool) -> Input<T> {
        let (signals, commands) = (&vars.signals, &vars.commands);
        let flag = |x: u8| i32::from(x != 0);
        Input {
            r: signals.sp,
            r_remote: signals.sp_remote,
            y,
            u_applied: signals.op_readback,
            manual: signals.op_man,
            track: signals.trk_value,
            offset: signals.ff,
            mode: mode::number(commands.mode()),
            quality: match vars.codes.pv_quality {
                2 => 0,
                1 => 1,
                _ => 2,
            },
            has_u_applied: flag(commands.rb_use),
            has_manual: 1,
            compensator_off: i32::from(commands.compensate == 0 || compensator_out),
            inhibit_up: flag(commands.inhibit_up),
            inhibit_down: flag(commands.inhibit_dn),
            acknowledge: flag(self.ack),
        }
    }

    fn results(&self, out: &Output<T>, y: T, timing: Timing) -> Results<T> {
        let pv_eng = if y.is_finite_number() { y } else { self.given.results.pv_eng };
        let period = T::from_f64(timing.period);
        Results {
            op: out.u,
            op_percent: T::from_f64(100.0 * self.fraction(out.u)),
            pv_eng,
            sp_working: out.r,
            dev: out.r - pv_eng,
            i_term: out.i,
            pd_term: out.pd,
            uf: out.u_f,
            d_hat: out.d_hat,
            bkcal_out: out.r,
            period: if period.is_finite_number() { period } else { T::ZERO },
        }
    }

    /// Where the output is in its span.
    fn fraction(&self, u: T) -> f64 {
        self.parameters.op_span().fraction(u.to_f64())
    }

    fn reports(&self, out: &Output<T>, timing: Timing) -> Reports {
        let counts = self.parameters.op_counts();
        let Refused { digest, error, refusal } = self.refused;
        let bit = |set: bool, bit: u32| if set { bit } else { 0 };
        let compensator_out = timing.compensator_out && self.parameters.choices.comp != 0;
        Reports {
            op_raw: round(counts.clamp(counts.at(self.fraction(out.u)))),
            mode: out.mode,
            error,
            error_param: refusal.param,
            error_reason: refusal.reason,
            status: out.status
                | bit(timing.rejected, Status::REJECTED.bits())
                | bit(timing.off, status::PERIOD_OFF)
                | bit(compensator_out, status::COMPENSATOR_OUT)
                | bit(digest != 0, status::REFUSED)
                | bit(self.lost != 0, status::STATE_LOST),
        }
    }

    fn flags(&self, out: &Output<T>) -> Flags {
        let is = |set: bool| u8::from(set);
        let alarm = |bit: Status| is(Status::from_bits(out.status).has(bit));
        let cascade = out.mode == mode::number(Mode::Cascade);
        Flags {
            in_auto: is(cascade || out.mode == mode::number(Mode::Auto)),
            in_cas: is(cascade),
            blocked_up: is(out.blocked_up != 0),
            blocked_dn: is(out.blocked_down != 0),
            hh_alm: alarm(Status::ALARM_HI_HI),
            h_alm: alarm(Status::ALARM_HI),
            l_alm: alarm(Status::ALARM_LO),
            ll_alm: alarm(Status::ALARM_LO_LO),
            dev_alm: alarm(Status::ALARM_DEVIATION),
            fault: is(self.refused.digest != 0),
        }
    }
}

impl Commands {
    /// The mode that is asked for.
    fn mode(&self) -> Mode {
        let wishes = [
            (self.off, Mode::Off),
            (self.trk, Mode::Track),
            (self.man, Mode::Manual),
            (self.hold, Mode::Hold),
            (self.cas, Mode::Cascade),
            (self.auto_, Mode::Auto),
        ];
        wishes.iter().find(|(wish, _)| *wish != 0).map_or(Mode::Hold, |&(_, mode)| mode)
    }
}
