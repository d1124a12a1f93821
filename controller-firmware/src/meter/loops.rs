//! Whole loops: every mode and every change of it, good and bad samples, limits.

use super::blocks::Form;
use super::clock::Clock;
use super::range::Range;
use super::report::Report;
use super::signals::Chance;
use controller_core::controller::ControllerState;
use controller_core::{
    Compensate, Controller, ControllerInput, ControllerOutput, Mode, Quality, Real, Regulator,
};

/// What the samples of a class have in common.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Class {
    Nominal,
    Options,
    High,
    Low,
    Off,
    Manual,
    Auto,
    Cascade,
    Track,
    Hold,
    Bad,
    Fallback,
    Return,
    Start,
    Random,
}

const CLASSES: [(Class, &str); 15] = [
    (Class::Nominal, "nominal"),
    (Class::Options, "options"),
    (Class::High, "high"),
    (Class::Low, "low"),
    (Class::Off, "off"),
    (Class::Manual, "manual"),
    (Class::Auto, "auto"),
    (Class::Cascade, "cascade"),
    (Class::Track, "track"),
    (Class::Hold, "hold"),
    (Class::Bad, "bad"),
    (Class::Fallback, "fallback"),
    (Class::Return, "return"),
    (Class::Start, "start"),
    (Class::Random, "random"),
];

/// The class of the samples in which a mode is asked for.
const fn of_mode(mode: Mode) -> Class {
    match mode {
        Mode::Off => Class::Off,
        Mode::Manual => Class::Manual,
        Mode::Auto => Class::Auto,
        Mode::Cascade => Class::Cascade,
        Mode::Track => Class::Track,
        Mode::Hold | Mode::Fallback => Class::Hold,
    }
}

/// Samples of a class without modes.
const SAMPLES: u32 = 150;
/// Random samples for one law.
const RANDOM: u32 = 1000;
/// More than may be held.
const LONG: u32 = 30;

/// Builds a loop around a compensator.
type New<T, C, L> = fn(&(Form, C), &mut Option<Controller<T, C, L>>);

/// What has been counted for a loop.
struct Counts<'a> {
    report: &'a Report<'a>,
    classes: [Range; CLASSES.len()],
    adopt: Range,
}

/// One law with its state and a plant.
struct Run<'a, T: Real, C: Compensate<T>, L: Regulator<T>> {
    law: &'a Controller<T, C, L>,
    state: ControllerState<T, C::State, L::State>,
    y: T,
}

/// A swap, with the state in the place where all functions have it here.
fn adopt<T: Real, C: Compensate<T>, L: Regulator<T>>(
    law: &Controller<T, C, L>,
    state: &mut ControllerState<T, C::State, L::State>,
    old: &Controller<T, C, L>,
) {
    law.adopt(old, state);
}

/// Measures a loop in all its forms.
#[inline(never)]
pub(super) fn measure<T: Real, C: Compensate<T> + Copy, L: Regulator<T>>(
    clock: &Clock,
    name: &'static str,
    new: New<T, C, L>,
    compensator: Option<C>,
) -> Option<()>
where
    C::State: Default,
{
    let Some(report) = Report::new::<T>(clock, name) else { return Some(()) };
    report.bytes::<Controller<T, C, L>, ControllerState<T, C::State, L::State>>();
    report.code("step", Controller::<T, C, L>::step as *const () as usize);
    report.code("adopt", adopt::<T, C, L> as *const () as usize);
    report.code("new", new as usize);
    let mut counts = Counts { report: &report, classes: [Range::NONE; CLASSES.len()], adopt: Range::NONE };
    let mut building = Range::NONE;
    let compensator = compensator?;
    for form in [Form::Plain, Form::Full, Form::Conditional] {
        let law = build(&report, &mut building, new, (form, compensator))?;
        let other = match form {
            Form::Plain => Form::Full,
            Form::Full | Form::Conditional => Form::Plain,
        };
        let other = build(&report, &mut building, new, (other, compensator))?;
        counts.closed(&law, &other);
        counts.modes(&law);
        counts.without_measurement(&law);
        counts.random(&law);
    }
    for ((_, class), range) in CLASSES.iter().zip(counts.classes) {
        report.count("step", class, range);
    }
    report.count("adopt", "all", counts.adopt);
    report.count("new", "all", building);
    Some(())
}

/// Builds a loop.
#[inline(never)]
fn build<T: Real, C: Compensate<T>, L: Regulator<T>>(
    report: &Report<'_>,
    range: &mut Range,
    new: New<T, C, L>,
    parts: (Form, C),
) -> Option<Controller<T, C, L>> {
    let mut law = None;
    let build =
        |new: &New<T, C, L>, law: &mut Option<Controller<T, C, L>>, parts: &(Form, C)| new(parts, law);
    let ((), count) = report.clock.count(build, &new, &mut law, &parts);
    range.note(count);
    law
}

impl<'a, T: Real, C: Compensate<T>, L: Regulator<T>> Run<'a, T, C, L>
where
    C::State: Default,
{
    /// A loop at rest.
    #[inline(never)]
    fn new(law: &'a Controller<T, C, L>) -> Self {
        let mut run = Self { law, state: law.zeroed(), y: T::ZERO };
        law.settle(&mut run.state, T::ZERO, T::ZERO, T::ZERO);
        run
    }

    /// One sample, which counts for `class`; the plant follows the output.
    #[inline(never)]
    fn sample(&mut self, counts: &mut Counts<'_>, class: Class, input: &ControllerInput<T>) {
        let out = self.one(counts, class, input);
        self.y = self.y + T::from_f64(0.05) * (out.u - self.y);
    }

    /// One sample, which counts for `class`.
    #[inline(never)]
    fn one(
        &mut self,
        counts: &mut Counts<'_>,
        class: Class,
        input: &ControllerInput<T>,
    ) -> ControllerOutput<T> {
        let step = Controller::<T, C, L>::step;
        let (out, count) = counts.report.clock.count(step, self.law, &mut self.state, input);
        for ((known, _), range) in CLASSES.iter().zip(&mut counts.classes) {
            if *known == class {
                range.note(count);
            }
        }
        out
    }

    /// An input in automatic mode.
    #[inline(never)]
    fn input(&self, r: f64) -> ControllerInput<T> {
        ControllerInput { r: T::from_f64(r), y: self.y, ..ControllerInput::default() }
    }
}

impl Counts<'_> {
    /// A closed loop: a set-point that moves, noise, an offset; then with read-back, inhibition, uncertain measurements and
    /// a compensator that is switched; swaps of the law; limits on both sides.
    #[inline(never)]
    fn closed<T: Real, C: Compensate<T>, L: Regulator<T>>(
        &mut self,
        law: &Controller<T, C, L>,
        other: &Controller<T, C, L>,
    ) where
        C::State: Default,
    {
        let mut chance = Chance::new(2);
        let mut run = Run::new(law);
        for class in [Class::Nominal, Class::Options] {
            for k in 0..SAMPLES {
                let mut input = run.input(if (k / 50) % 2 == 0 { 1.0 } else { -1.0 });
                input.y = input.y + chance.number(0.02);
                input.offset = chance.number(0.1);
                if class == Class::Options {
                    input.u_applied = chance.once_in(4).then(|| chance.number(2.0));
                    (input.inhibit_up, input.inhibit_down) = (chance.once_in(5), chance.once_in(5));
                    input.compensate = !chance.once_in(5);
                    input.quality = if chance.once_in(5) { Quality::Uncertain } else { Quality::Good };
                }
                run.sample(self, class, &input);
                let mut state = run.state.clone();
                let adopt = adopt::<T, C, L>;
                self.adopt.note(self.report.clock.count(adopt, other, &mut state, law).1);
            }
        }
        for (class, r) in [(Class::High, 1e3), (Class::Low, -1e3)] {
            for _ in 0..SAMPLES {
                let mut input = run.input(r);
                input.u_applied = chance.once_in(4).then(|| chance.number(2.0));
                input.inhibit_up = chance.once_in(5);
                run.sample(self, class, &input);
            }
        }
    }

    /// Every change of mode and what follows it.
    #[inline(never)]
    fn modes<T: Real, C: Compensate<T>, L: Regulator<T>>(&mut self, law: &Controller<T, C, L>)
    where
        C::State: Default,
    {
        let mut chance = Chance::new(3);
        for was in Mode::REQUESTS {
            for mode in Mode::REQUESTS {
                let mut run = Run::new(law);
                for k in 0..8 {
                    let mut input = run.input(1.0);
                    input.r_remote = chance.number(2.0);
                    input.mode = if k < 3 { was } else { mode };
                    input.manual = chance.once_in(2).then(|| chance.number(15.0));
                    input.track = chance.number(15.0);
                    input.offset = chance.number(0.1);
                    input.compensate = !chance.once_in(4);
                    run.sample(self, of_mode(input.mode), &input);
                }
            }
        }
    }

    /// Bad samples, in every mode, and what comes after them; the first sample of all.
    #[inline(never)]
    fn without_measurement<T: Real, C: Compensate<T>, L: Regulator<T>>(&mut self, law: &Controller<T, C, L>)
    where
        C::State: Default,
    {
        let mut chance = Chance::new(4);
        for was in Mode::REQUESTS {
            for mode in Mode::REQUESTS {
                let mut run = Run::new(law);
                let mut input = run.input(1.0);
                input.mode = was;
                run.sample(self, of_mode(was), &input);
                for k in 0..LONG {
                    input = run.input(1.0);
                    input.mode = mode;
                    input.manual = chance.once_in(2).then(|| chance.number(15.0));
                    match k % 3 {
                        0 => input.y = T::from_f64(f64::NAN),
                        1 => input.y = T::from_f64(1e9),
                        _ => input.quality = Quality::Bad,
                    }
                    run.sample(self, if k < 3 { Class::Bad } else { Class::Fallback }, &input);
                }
                for k in 0..3 {
                    let mut input = run.input(1.0);
                    input.mode = mode;
                    input.acknowledge = k > 0;
                    run.sample(self, Class::Return, &input);
                }
                let mut run = Run { law, state: law.zeroed(), y: T::ZERO };
                for k in 0..3 {
                    let mut input = run.input(1.0);
                    input.mode = mode;
                    input.u_applied = chance.once_in(2).then(|| chance.number(2.0));
                    input.quality = if k == 1 || was == mode { Quality::Good } else { Quality::Bad };
                    run.sample(self, Class::Start, &input);
                }
            }
        }
    }

    /// Any bits in every number, any choice in every other input.
    #[inline(never)]
    fn random<T: Real, C: Compensate<T>, L: Regulator<T>>(&mut self, law: &Controller<T, C, L>)
    where
        C::State: Default,
    {
        let mut chance = Chance::new(5);
        let mut run = Run::new(law);
        for _ in 0..RANDOM {
            if chance.once_in(50) {
                run.state = law.zeroed();
            }
            let any = chance.below(7) as u8;
            let input = ControllerInput {
                r: chance.anything(),
                r_remote: chance.anything(),
                y: if chance.once_in(2) { chance.number(20.0) } else { chance.anything() },
                quality: match chance.below(6) {
                    0 => Quality::Bad,
                    1 => Quality::Uncertain,
                    _ => Quality::Good,
                },
                mode: if chance.once_in(3) { Mode::from_number(any).unwrap_or_default() } else { Mode::Auto },
                manual: chance.once_in(2).then(|| chance.anything()),
                track: chance.anything(),
                offset: chance.anything(),
                u_applied: chance.once_in(2).then(|| chance.anything()),
                compensate: !chance.once_in(3),
                inhibit_up: chance.once_in(3),
                inhibit_down: chance.once_in(3),
                acknowledge: chance.once_in(3),
            };
            let _ = run.one(self, Class::Random, &input);
        }
    }
}
