//! What each function does, for both number types. Errors leave everything as it was, but for a step that finds damage in the
//! state.

use crate::block::{self, Block, Cells, Delayed, Either, Loop, Memory, Number, check_pointer};
use crate::block::{MAX_DELAY, cells_in, without_address};
use crate::config::{Config, STRUCT_SIZE};
use crate::fault::{Error, Fault, Faults, number};
use crate::header::{Header, Kind};
use crate::io::{Input, Output, mode};
use controller_core::{
    Compensate, Controller, ControllerConfig, ControllerState, Mode, NoCompensator, Param, Real, Reason,
    Status,
};
use core::ffi::c_void;

type Done = Result<(), Error>;

/// The code of the interface for what a call has come to.
pub(crate) fn code(done: Done) -> i32 {
    match done {
        Ok(()) => 0,
        Err(error) => error as i32,
    }
}

/// Hands the faults out, when there is somebody to hand them to.
///
/// # Safety
/// `faults` is null or points to memory of the caller's to write.
unsafe fn report(to: *mut Faults, faults: &Faults) -> Done {
    if !to.is_null() {
        check_pointer(to, align_of::<Faults>())?;
        // SAFETY: not null, aligned, the caller's.
        unsafe { to.write(*faults) };
    }
    Ok(())
}

/// The caller's structure of parameters.
///
/// # Safety
/// `config` is null or points to a structure that begins with its size.
unsafe fn read_config<'a>(config: *const Config) -> Result<&'a Config, Error> {
    check_pointer(config, align_of::<Config>())?;
    // SAFETY: not null, aligned; whatever the size is, it stands at the beginning.
    if unsafe { config.cast::<u32>().read() } != STRUCT_SIZE {
        return Err(Error::StructSize);
    }
    // SAFETY: a structure of this size; any bits are numbers. Nobody writes it during the call.
    Ok(unsafe { &*config })
}

/// A law that is built but has no state yet.
type NewLaw<T> = Either<Controller<T, NoCompensator>, Controller<T, Delayed<T>>>;

/// Builds the law for `config`, and says how many cells of delay memory it needs; or finds all faults.
///
/// Its parts are functions of their own: lists of faults and laws are large, and a small target has the stack for one at
/// a time.
#[inline(never)]
fn build<T: Number>(config: &Config, faults: &mut Faults) -> Option<(NewLaw<T>, u32)> {
    let ts = T::from_f64(config.ts).to_f64();
    let controller = controller_config::<T>(config, faults);
    match compensator_law::<T>(config, ts, faults) {
        None => {
            // All faults at once, those of the other parts, too.
            let _ = plain_law::<T>(&controller, ts, faults);
            None
        }
        Some(None) => plain_law(&controller, ts, faults).map(|law| (Either::Plain(law), 0)),
        Some(Some((law, cells))) => {
            let law = compensated_law(&controller, law, ts, faults)?;
            Some((Either::Compensated(law), cells))
        }
    }
}

#[inline(never)]
fn controller_config<T: Number>(config: &Config, faults: &mut Faults) -> ControllerConfig {
    config.controller(faults).rounded::<T>()
}

/// The compensator, if there is one, and the cells it needs; nothing when something is wrong with it.
#[inline(never)]
fn compensator_law<T: Number>(
    config: &Config,
    ts: f64,
    faults: &mut Faults,
) -> Option<Option<(Delayed<T>, u32)>> {
    let Some(compensator) = config.compensator(faults) else {
        return Some(None);
    };
    let compensator = compensator.rounded::<T>();
    let law = found(Delayed::new(&compensator, ts, MAX_DELAY as usize + 1), faults)?;
    let cells = Delayed::<T>::needed_capacity(&compensator, ts);
    Some(Some((law, u32::try_from(cells).unwrap_or(u32::MAX))))
}

#[inline(never)]
fn plain_law<T: Number>(
    config: &ControllerConfig,
    ts: f64,
    faults: &mut Faults,
) -> Option<Controller<T, NoCompensator>> {
    let law = found(Controller::new(config, ts), faults);
    law.filter(|_| faults.is_empty())
}

#[inline(never)]
fn compensated_law<T: Number>(
    config: &ControllerConfig,
    compensator: Delayed<T>,
    ts: f64,
    faults: &mut Faults,
) -> Option<Controller<T, Delayed<T>>> {
    let law = found(Controller::with_compensator(config, compensator, ts), faults);
    law.filter(|_| faults.is_empty())
}

fn found<V>(built: Result<V, controller_core::ConfigErrors>, faults: &mut Faults) -> Option<V> {
    built.map_err(|errors| faults.add_all(&errors)).ok()
}

/// Builds the law for a block of `size` bytes; reports the faults.
///
/// # Safety
/// As for [`read_config`] and [`report`].
unsafe fn build_for<T: Number>(
    config: *const Config,
    size: usize,
    to: *mut Faults,
) -> Result<NewLaw<T>, Error> {
    let mut faults = Faults::default();
    // SAFETY: by the caller.
    let config = unsafe { read_config(config) }?;
    let built = build::<T>(config, &mut faults);
    let fitting = match built {
        None => Err(Error::Config),
        Some((Either::Plain(law), _)) => {
            let fits = size >= T::SIZE_WITHOUT_COMPENSATOR;
            fits.then_some(Either::Plain(law)).ok_or(Error::Size)
        }
        Some((Either::Compensated(law), cells)) => {
            let room = cells_in::<T>(size);
            if cells > room {
                let reason = number(Reason::TooLarge);
                let (value, max) = (f64::from(cells) - 1.0, f64::from(room) - 1.0);
                faults.add(Fault { param: Param::Capacity as i32, reason, value, min: 0.0, max });
            }
            (cells <= room).then_some(Either::Compensated(law)).ok_or(Error::Size)
        }
    };
    // SAFETY: by the caller.
    unsafe { report(to, &faults) }?;
    fitting
}

/// # Safety
/// As for [`build_for`].
pub(crate) unsafe fn check<T: Number>(config: *const Config, faults: *mut Faults) -> Done {
    // SAFETY: by the caller.
    unsafe { build_for::<T>(config, block::size::<T>(MAX_DELAY), faults) }.map(|_| ())
}

/// # Safety
/// `config` as for [`build_for`]; `samples` is null or the caller's to write.
pub(crate) unsafe fn delay_samples<T: Number>(config: *const Config, samples: *mut u32) -> Done {
    check_pointer(samples, align_of::<u32>())?;
    // SAFETY: by the caller.
    let config = unsafe { read_config(config) }?;
    let (_, cells) = build::<T>(config, &mut Faults::default()).ok_or(Error::Config)?;
    // SAFETY: not null, aligned, the caller's.
    unsafe { samples.write(cells.saturating_sub(1)) };
    Ok(())
}

/// A zeroed state of a law over cleared delay memory that is elsewhere meanwhile.
fn compensated<T: Number>(
    law: Controller<T, Delayed<T>>,
    cells: Cells<T>,
) -> Result<Loop<T, Delayed<T>>, Error> {
    let state = law.compensator().state(cells).map_err(|_| Error::Size)?;
    Ok(Loop { law, state: ControllerState::over(state) })
}

/// # Safety
/// As for [`build_for`]; `size` bytes at `state` are the caller's to write and are not used by anybody else meanwhile.
pub(crate) unsafe fn init<T: Number>(
    state: *mut c_void,
    size: usize,
    config: *const Config,
    faults: *mut Faults,
) -> Done {
    let memory = Memory::new(state)?;
    if size < T::SIZE_WITHOUT_COMPENSATOR {
        return Err(Error::Size);
    }
    // SAFETY: by the caller.
    let law = unsafe { build_for::<T>(config, size, faults) }?;
    let cells = cells_in::<T>(size);
    let last = Output::at_rest(T::ZERO, Mode::Hold, false);
    let auto = mode::number(Mode::Auto);
    match law {
        Either::Plain(law) => {
            let state = law.zeroed();
            let header = Header::new(Block::<T>::MARKS, Kind::Plain, cells, auto);
            // SAFETY: the caller's memory; `build_for` has checked that it is large enough.
            unsafe { memory.write(header, last, Loop { law, state }) };
        }
        Either::Compensated(law) => {
            // SAFETY: the caller's memory, which holds so many cells; they are forgotten before it is written.
            let cleared = unsafe { memory.clear_cells::<T>(cells) };
            let mut looped = compensated(law, cleared)?;
            without_address(&mut looped);
            let header = Header::new(Block::<T>::MARKS, Kind::Compensated, cells, auto);
            // SAFETY: as above.
            unsafe { memory.write(header, last, looped) };
        }
    }
    Ok(())
}

/// # Safety
/// As for [`Block::open`].
pub(crate) unsafe fn settle<T: Number>(state: *mut c_void, size: usize, [r, y, u]: [T; 3]) -> Done {
    // SAFETY: by the caller.
    let mut block = unsafe { Block::<T>::open(state, size) }?;
    if ![r, y, u].iter().all(|x| x.is_finite_number()) {
        return Err(Error::Argument);
    }
    let last = block.with(|l| l.settle(r, y, u), |l| l.settle(r, y, u));
    block.set_last(last);
    Ok(())
}

impl<T: Real, C: Compensate<T>> Loop<T, C> {
    fn settle(&mut self, r: T, y: T, u: T) -> Output<T> {
        self.law.settle(&mut self.state, r, y, u);
        self.at_rest()
    }

    /// What there is to read until the next step.
    pub(crate) fn at_rest(&self) -> Output<T> {
        Output::at_rest(self.state.u(), self.state.mode(), self.state.is_started())
    }

    pub(crate) fn state_sum(&self) -> u32 {
        Controller::<T, C>::state_checksum(&self.state).value()
    }

    fn step(&mut self, input: &Input<T>, mode: Mode, status: Status) -> Output<T> {
        Output::of(&self.law.step(&mut self.state, &input.for_mode(mode)), status)
    }
}

/// # Safety
/// As for [`Block::open`].
pub(crate) unsafe fn set_mode<T: Number>(state: *mut c_void, size: usize, number: i32) -> Done {
    // SAFETY: by the caller.
    let mut block = unsafe { Block::<T>::open(state, size) }?;
    mode::requested(number).ok_or(Error::Argument)?;
    block.header().set = number;
    Ok(())
}

impl Header {
    /// The mode that `number` asks for. An unknown number leaves the loop in the mode that was asked for last: an actuator
    /// must not move because of a slip in a program.
    fn ask(&mut self, number: i32) -> (Mode, Status) {
        let wanted = if number == mode::AS_SET { self.set } else { number };
        match mode::requested(wanted) {
            Some(mode) => {
                self.asked = wanted;
                (mode, Status::NONE)
            }
            None => (mode::requested(self.asked).unwrap_or(Mode::Hold), Status::REJECTED),
        }
    }
}

/// # Safety
/// As for [`Block::open`]; `input` is null or points to an input, `output` is null or the caller's to write.
pub(crate) unsafe fn step<T: Number>(
    state: *mut c_void,
    size: usize,
    input: *const Input<T>,
    output: *mut Output<T>,
) -> Done {
    check_pointer(input, align_of::<Input<T>>())?;
    check_pointer(output, align_of::<Output<T>>())?;
    // SAFETY: by the caller.
    let mut block = unsafe { Block::<T>::open(state, size) }?;
    // SAFETY: not null, aligned; any bits are an input.
    let input = unsafe { input.read() };
    let out = block.step(&input)?;
    // SAFETY: not null, aligned, the caller's.
    unsafe { output.write(out) };
    Ok(())
}

/// By its bits: where the machine has no such arithmetic, a comparison is a long call.
fn not_finite<T: Number>(x: T) -> bool {
    let [low, high] = x.to_words();
    let last = if T::WORDS == 2 { high } else { low };
    last & T::EXPONENT == T::EXPONENT
}

impl<T: Number> Block<T> {
    pub(crate) fn step(&mut self, input: &Input<T>) -> Result<Output<T>, Error> {
        let (mode, status) = self.header().ask(input.mode);
        let out = self.with(|l| l.step(input, mode, status), |l| l.step(input, mode, status));
        // No undamaged state gives such numbers. Some of them go away, into a state that is no better: so the block stays damaged.
        if not_finite(out.v) | not_finite(out.pd) | not_finite(out.d_hat) {
            self.condemn();
            return Err(Error::Damaged);
        }
        self.set_last(out);
        Ok(out)
    }

    pub(crate) fn advance(&mut self, samples: u32) {
        self.with(|l| l.law.advance(&mut l.state, samples), |l| l.law.advance(&mut l.state, samples));
    }
}

/// # Safety
/// As for [`Block::open`]; `output` is null or the caller's to write.
pub(crate) unsafe fn read<T: Number>(state: *const c_void, size: usize, output: *mut Output<T>) -> Done {
    check_pointer(output, align_of::<Output<T>>())?;
    // SAFETY: by the caller; nothing is written.
    let block = unsafe { Block::<T>::open(state.cast_mut(), size) }?;
    // SAFETY: not null, aligned, the caller's.
    unsafe { output.write(block.last()) };
    Ok(())
}

/// # Safety
/// As for [`Block::open`].
pub(crate) unsafe fn advance<T: Number>(state: *mut c_void, size: usize, samples: u32) -> Done {
    // SAFETY: by the caller.
    unsafe { Block::<T>::open(state, size) }?.advance(samples);
    Ok(())
}

/// # Safety
/// As for [`Block::open`] and [`build_for`].
pub(crate) unsafe fn adopt<T: Number>(
    state: *mut c_void,
    size: usize,
    config: *const Config,
    faults: *mut Faults,
) -> Done {
    // SAFETY: by the caller.
    let mut block = unsafe { Block::<T>::open(state, size) }?;
    // SAFETY: by the caller.
    unsafe { replace(&mut block, config, faults) }
}

/// Puts another law into a block.
///
/// # Safety
/// As for [`build_for`].
pub(crate) unsafe fn replace<T: Number>(
    block: &mut Block<T>,
    config: *const Config,
    faults: *mut Faults,
) -> Done {
    let cells = block.cells();
    // What the block had room for at `init`.
    let room = match cells {
        0 => T::SIZE_WITHOUT_COMPENSATOR,
        _ => T::SIZE_WITH_COMPENSATOR + cells as usize * size_of::<T>(),
    };
    // SAFETY: by the caller.
    let law = unsafe { build_for::<T>(config, room, faults) }?;
    match (block.kind(), law) {
        (Kind::Plain, Either::Plain(law)) => {
            block.with(|l| l.replace(law), |_| ());
            block.seal();
        }
        (Kind::Compensated, Either::Compensated(law)) => {
            block.with(|_| (), |l| l.replace(law));
            block.seal();
        }
        (Kind::Compensated, Either::Plain(law)) => remove_compensator(block, law),
        (Kind::Plain, Either::Compensated(law)) => {
            // SAFETY: the block has so many cells, which are enough for the law: `build_for` has checked it.
            let cleared = unsafe { block.memory().clear_cells::<T>(cells) };
            let fresh = law.compensator().state(cleared).map_err(|_| Error::Size)?;
            add_compensator(block, law, fresh);
        }
    }
    Ok(())
}

#[inline(never)]
fn remove_compensator<T: Number>(block: &mut Block<T>, law: Controller<T, NoCompensator>) {
    let Either::Compensated(old) = block.take() else { return };
    let state = law.adopt_from(&old.law, old.state, ());
    let (last, header) = (block.last(), block.header().of_kind(Kind::Plain));
    // SAFETY: the block is larger than one without a compensator.
    unsafe { block.memory().write(header, last, Loop { law, state }) };
}

/// `fresh` has the block's cells, which are used until its loop is written, and then by nobody.
#[inline(never)]
fn add_compensator<T: Number>(
    block: &mut Block<T>,
    law: Controller<T, Delayed<T>>,
    fresh: <Delayed<T> as Compensate<T>>::State,
) {
    let Either::Plain(old) = block.take() else { return };
    let state = law.adopt_from(&old.law, old.state, fresh);
    let mut looped = Loop { law, state };
    without_address(&mut looped);
    let (last, header) = (block.last(), block.header().of_kind(Kind::Compensated));
    // SAFETY: a block with cells has the room in front of them.
    unsafe { block.memory().write(header, last, looped) };
}

impl<T: Real, C: Compensate<T>> Loop<T, C> {
    fn replace(&mut self, law: Controller<T, C>) {
        law.adopt(&self.law, &mut self.state);
        self.law = law;
    }
}
