//! What the control interrupt says to the main context: it never logs, formats or waits itself.

use controller_core::{ControllerInput, ControllerOutput, Mode, Status, Trace, TraceSample};

/// Events on their way to the main context, which may be busy for a second or two.
pub(crate) static EVENTS: Trace<(Loop, Event), 64> = Trace::new();

/// Which loop.
#[derive(Debug, Clone, Copy, PartialEq, Eq, defmt::Format)]
pub(crate) enum Loop {
    Heater,
    Oven,
}

/// What happened to it.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Event {
    /// A sample: now and then, and when the mode or a watched status bit has changed.
    Sample(TraceSample<f32>),
    /// Parameters of this generation are in force from sample `k` on.
    Adopted { k: u32, generation: u32 },
    /// Before sample `k`, this many periods were lost.
    Lost { k: u32, periods: u32 },
    /// A device did not take its output in sample `k`.
    Refused { k: u32, device: Device },
}

/// What may refuse an output.
#[derive(Debug, Clone, Copy, PartialEq, Eq, defmt::Format)]
pub(crate) enum Device {
    Heater,
    Relay,
    Recorder,
}

/// The status bits that somebody must see. Others, such as limits, come and go with the noise.
pub(crate) const WATCHED: Status = Status::from_bits(
    Status::SETPOINT_LIMITED.bits()
        | Status::BAD_INPUT.bits()
        | Status::UNCERTAIN.bits()
        | Status::FALLBACK.bits()
        | Status::AWAITING_ACKNOWLEDGEMENT.bits()
        | Status::REJECTED.bits()
        | Status::OVERRUN.bits()
        | Status::ALARM_HI_HI.bits()
        | Status::ALARM_HI.bits()
        | Status::ALARM_LO.bits()
        | Status::ALARM_LO_LO.bits()
        | Status::ALARM_DEVIATION.bits(),
);

/// The bits of `status` that are among `others`.
pub(crate) const fn only(status: Status, others: Status) -> Status {
    Status::from_bits(status.bits() & others.bits())
}

/// Chooses the samples that are worth a record.
pub(crate) struct Reporter {
    which: Loop,
    every: u32,
    /// The last record: its sample, mode and status.
    last: Option<(u32, Mode, Status)>,
}

impl Reporter {
    /// Reports a sample of every `every` periods, at least 1, and those with news.
    pub(crate) const fn new(which: Loop, every: u32) -> Self {
        Self { which, every, last: None }
    }

    /// Something happened.
    pub(crate) fn tell(&self, event: Event) {
        // A queue that is full counts what it drops.
        EVENTS.push((self.which, event));
    }

    /// A sample was taken.
    pub(crate) fn sample(&mut self, k: u32, input: &ControllerInput<f32>, output: &ControllerOutput<f32>) {
        let now = (output.mode, only(output.status, WATCHED));
        let quiet = |(at, mode, status)| (mode, status) == now && k / self.every == at / self.every;
        if !self.last.is_some_and(quiet) {
            self.last = Some((k, now.0, now.1));
            self.tell(Event::Sample(TraceSample::new(k, input, output)));
        }
    }
}
