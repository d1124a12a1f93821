//! A relay or a solid-state switch as a proportional output.

use crate::actuate::{Actuate, ActuateError, OutputConfig, OutputSpan};
use crate::faults::Faults;
use crate::number::Number;
use controller_core::{ConfigErrors, Param, Reason};
use embedded_hal::digital::OutputPin;

/// Longest window in ticks: its duty in units of 2^-16 ticks fits into a word.
const WINDOW_LIMIT: u16 = 1 << 14;
/// Parts of a tick.
const PARTS: u32 = 16;

/// What a person writes for a [`TimeProportioned`] output.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct TimeProportionedConfig {
    /// Range: always off at `lo`, always on at `hi`.
    pub output: OutputConfig,
    /// Ticks of a window, 2 to 16384. The plant should be slow against it: a tenth of its filter or lag.
    pub window: u16,
    /// Shortest time on, in ticks; 0 and 1 mean one tick.
    pub minimum_on: u16,
    /// Shortest time off, in ticks; with `minimum_on` at most `window`.
    pub minimum_off: u16,
}

/// A switch that is on for a part of every window of `n` ticks: what a relay, a contactor or a zero-crossing switch makes
/// of a heater.
///
/// Law, once a window: `w = n*(u - lo)/(hi - lo) + carry` ticks are due; on for the permitted number of ticks next to `w`,
/// which is 0, `minimum_on..=n - minimum_off`, or `n`; `carry` is the rest. So the mean over windows is that of `u` exactly
/// (counted in 2^-16 ticks, with `f32` and more than 256 ticks in 2^-24 of the window): what was due and what was done in
/// all windows together differ by `carry`, at most half of the longer minimum time or half a tick. A duty too small for the minimum time comes as a minimum pulse in every so many windows.
/// The switch closes at most once a window; at the ends of the range it does not move.
///
/// [`tick`](Self::tick) belongs into a timer interrupt, mostly every 10 ms or a half wave of the mains; `apply` into the
/// control task. A new output counts from the next window on: on the average half a window of delay, which belongs into
/// `latency`. Cost of a tick: a few compares, an addition; once a window about 15 integer instructions more.
///
/// ```
/// use controller_hal::{Actuate, OutputConfig, TimeProportioned, TimeProportionedConfig};
/// # struct Pin(bool);
/// # impl embedded_hal::digital::ErrorType for Pin { type Error = core::convert::Infallible; }
/// # impl embedded_hal::digital::OutputPin for Pin {
/// #     fn set_low(&mut self) -> Result<(), Self::Error> { self.0 = false; Ok(()) }
/// #     fn set_high(&mut self) -> Result<(), Self::Error> { self.0 = true; Ok(()) }
/// # }
/// # let relay = Pin(false);
/// let config = TimeProportionedConfig {
///     output: OutputConfig { lo: 0.0, hi: 100.0, ..OutputConfig::default() },
///     window: 10,
///     minimum_on: 2,
///     minimum_off: 2,
/// };
/// let mut heater = TimeProportioned::<_, f32>::new(relay, &config).unwrap();
/// heater.apply(35.0).unwrap();
/// let on = (0..20).filter(|_| heater.tick().unwrap()).count();
/// assert_eq!(on, 7); // 4 and 3
/// heater.apply(5.0).unwrap(); // half a tick a window: below the shortest pulse
/// let on: Vec<usize> = (0..8).map(|_| (0..10).filter(|_| heater.tick().unwrap()).count()).collect();
/// assert_eq!(on, [0, 0, 2, 0, 0, 0, 2, 0]);
/// ```
#[derive(Debug)]
pub struct TimeProportioned<P, T> {
    pin: P,
    span: OutputSpan<T>,
    window: u16,
    least_on: u16,
    most_on: u16,
    /// `n` in parts.
    scale: T,
    /// Due in a window, in parts.
    due: i32,
    carry: i32,
    at: u16,
    on: u16,
    applied: Option<T>,
    /// The pin's level; not known before it was set and after it failed.
    driven: Option<bool>,
    /// The pin was not set when it last should have been.
    failed: bool,
}

impl<P: OutputPin, T: Number> TimeProportioned<P, T> {
    /// Drives `pin`, on being high; off from the first tick on until an output is applied.
    ///
    /// # Errors
    /// As [`OutputSpan::new`]; a window outside 2..=16384 ticks; minimum times that do not fit into it.
    pub fn new(pin: P, config: &TimeProportionedConfig) -> Result<Self, ConfigErrors> {
        let mut faults = Faults::default();
        let window = config.window;
        faults.range(Param::Window, f64::from(window), 2.0, f64::from(WINDOW_LIMIT));
        let (least_on, least_off) = (config.minimum_on.max(1), config.minimum_off.max(1));
        let room = f64::from(window) - 1.0;
        let on_fits = faults.range(Param::MinimumOn, f64::from(least_on), 0.0, room);
        if on_fits && u32::from(least_on) + u32::from(least_off) > u32::from(window) {
            let most = f64::from(window) - f64::from(least_on);
            faults.fault(Param::MinimumOff, Reason::TooLarge, f64::from(least_off), 0.0, most);
        }
        let span = OutputSpan::new(&config.output);
        let faults = faults.finish(());
        let span = match (faults, span) {
            (Ok(()), Ok(span)) => span,
            (Err(faults), Ok(_)) | (Ok(()), Err(faults)) => return Err(faults),
            (Err(faults), Err(more)) => return Err(faults.and(&more)),
        };
        Ok(Self {
            pin,
            span,
            window,
            least_on,
            most_on: window.saturating_sub(least_off),
            scale: T::from_counts(parts(window)),
            due: 0,
            carry: 0,
            at: 0,
            on: 0,
            applied: None,
            driven: None,
            failed: false,
        })
    }

    /// One tick: sets the pin if it has to change; gives its level.
    ///
    /// # Errors
    /// When the pin fails; it is set again in the next tick.
    pub fn tick(&mut self) -> Result<bool, P::Error> {
        if self.at == 0 {
            let total = self.due + self.carry;
            self.on = self.permitted(total);
            self.carry = total - parts(self.on);
        }
        let level = self.at < self.on;
        self.at = if self.at + 1 >= self.window { 0 } else { self.at + 1 };
        self.set(level)?;
        Ok(level)
    }

    /// Switches off at once, whatever the minimum times, and forgets what is due; the next tick begins a window.
    ///
    /// # Errors
    /// When the pin fails.
    pub fn switch_off(&mut self) -> Result<(), P::Error> {
        (self.due, self.carry, self.at, self.on) = (0, 0, 0, 0);
        self.applied = Some(self.span.range().0);
        self.driven = None;
        self.set(false)
    }

    /// The output that the windows have on the average \[u\]; `None`: none was applied, or the pin failed and has not been
    /// set since.
    #[must_use]
    pub fn applied(&self) -> Option<T> {
        if self.failed { None } else { self.applied }
    }

    /// Gives the pin back.
    pub fn release(self) -> P {
        self.pin
    }

    /// The permitted number of ticks next to `total` parts.
    fn permitted(&self, total: i32) -> u16 {
        let half = |ticks: u32| i32::try_from(ticks << (PARTS - 1)).unwrap_or(i32::MAX);
        let (least, most, window) =
            (u32::from(self.least_on), u32::from(self.most_on), u32::from(self.window));
        // In the middle between two permitted numbers the one at the end of the range wins: nothing due, no pulse.
        if total <= half(least) {
            0
        } else if total >= half(most + window) {
            self.window
        } else {
            let nearest = u16::try_from((total + (1 << (PARTS - 1))) >> PARTS).unwrap_or(0);
            if nearest < self.least_on {
                self.least_on
            } else if nearest > self.most_on {
                self.most_on
            } else {
                nearest
            }
        }
    }

    fn set(&mut self, level: bool) -> Result<(), P::Error> {
        if self.driven != Some(level) {
            (self.driven, self.failed) = (None, true);
            self.pin.set_state(level.into())?;
            (self.driven, self.failed) = (Some(level), false);
        }
        Ok(())
    }
}

impl<P: OutputPin, T: Number> Actuate<T> for TimeProportioned<P, T> {
    type Error = P::Error;

    fn apply(&mut self, u: T) -> Result<T, ActuateError<P::Error>> {
        let asked = if u.is_finite_number() { Some(u) } else { None };
        let Some(output) = asked.or(self.span.safe()) else {
            return Err(ActuateError::NotFinite);
        };
        let fraction = self.span.fraction(output);
        self.due = (fraction * self.scale + T::from_f64(0.5)).to_counts();
        let (lo, hi) = self.span.range();
        let mean = if fraction >= T::ONE { hi } else { (lo + (hi - lo) * fraction).clamp_to(lo, hi) };
        self.applied = Some(mean);
        if asked.is_some() { Ok(mean) } else { Err(ActuateError::NotFinite) }
    }
}

/// Ticks in parts.
fn parts(ticks: u16) -> i32 {
    i32::from(ticks) << PARTS
}
