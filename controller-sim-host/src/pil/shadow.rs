//! The controller on the board beside the one here.

use super::Target;
use super::link::{Line, LinkError};
use crate::scenario::ControllerSpec;
use crate::simulate::RunResult;
use controller_core::{ControllerInput, ControllerOutput, Real};
use controller_pil::board::Board;
use controller_pil::frame::{Code, Kind, Writer};
use controller_pil::parameters::{Kind as Regulator, Parameters, Precision};
use controller_pil::sample::{OUTPUT, difference, write_input, write_number, write_output};

/// How a controller on the board and the same one here compare.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Compared {
    /// The board.
    pub on: &'static Board,
    /// Samples that both have computed.
    pub samples: u64,
    /// Those of them in which a bit differs.
    pub differing: u64,
    /// The first difference.
    pub first: Option<Difference>,
    /// FNV-1a over all bits of all outputs, computed here.
    pub host_hash: u64,
    /// The same, computed on the board.
    pub board_hash: u64,
}

/// One part of one output, or the state at the end, that is not the same here and on the board.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Difference {
    /// Which sample, from 0.
    pub k: u64,
    /// The output's part, or `state`: nothing differed until the end but the checksum of the state.
    pub field: &'static str,
    /// Its bits here.
    pub host: u64,
    /// Its bits on the board.
    pub board: u64,
}

impl Compared {
    const fn on(board: &'static Board) -> Self {
        let hash = FNV_BASIS;
        Self { on: board, samples: 0, differing: 0, first: None, host_hash: hash, board_hash: hash }
    }

    /// Two controllers as one, in the order that is given; the first difference is the first one's, if it has any.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        Self {
            on: self.on,
            samples: self.samples + other.samples,
            differing: self.differing + other.differing,
            first: self.first.or(other.first),
            host_hash: fnv(self.host_hash, &other.host_hash.to_le_bytes()),
            board_hash: fnv(self.board_hash, &other.board_hash.to_le_bytes()),
        }
    }

    /// Of all controllers of a run, with the name of the one that the first difference is in; `None`: there was no board.
    #[must_use]
    pub fn all(result: &RunResult) -> Option<(Self, Option<&str>)> {
        let all = || result.controllers.iter().filter_map(|one| one.pil.map(|pil| (pil, &*one.name)));
        let whole = all().map(|(pil, _)| pil).reduce(Self::and)?;
        Some((whole, all().find(|(pil, _)| pil.first.is_some()).map(|(_, name)| name)))
    }
}

/// Basis and prime of the 64-bit hash by Fowler, Noll and Vo.
const FNV_BASIS: u64 = 0xCBF2_9CE4_8422_2325;
const FNV_PRIME: u64 = 0x100_0000_01B3;

fn fnv(hash: u64, bytes: &[u8]) -> u64 {
    bytes.iter().fold(hash, |hash, &byte| (hash ^ u64::from(byte)).wrapping_mul(FNV_PRIME))
}

/// Bytes of a number of type `T`.
const fn size<T: Real>() -> usize {
    4 * T::WORDS
}

/// A controller on the board that gets every call of the one here. The first failure of the link ends it; it is told by
/// [`failure`](Self::failure).
#[derive(Debug)]
pub(crate) struct Shadow {
    line: Line,
    timing: Timing,
    compared: Compared,
    k: u64,
    failure: Option<LinkError>,
}

/// What a law is built with, besides its own parameters.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Timing {
    pub(crate) ts: f64,
    pub(crate) latency: f64,
    pub(crate) capacity: usize,
}

impl Shadow {
    /// Starts the board and builds the controller there.
    pub(crate) fn start<T: Real>(
        target: &Target,
        spec: &ControllerSpec,
        timing: Timing,
    ) -> Result<Self, LinkError> {
        let mut line = Line::new(target.start()?);
        let memory = line.hello(target.board.name)?;
        Self::build::<T>(line, target.board, spec, timing).map_err(|error| match error {
            BuildError::Link(error) => error,
            BuildError::Memory => LinkError(format!(
                "the dead time takes {} samples of memory; the image for {} has {memory}",
                timing.capacity, target.board.name
            )),
        })
    }

    fn build<T: Real>(
        mut line: Line,
        board: &'static Board,
        spec: &ControllerSpec,
        timing: Timing,
    ) -> Result<Self, BuildError> {
        let parameters = parameters::<T>(spec, timing);
        match line.ask(Kind::Build, |to| parameters.write(to))? {
            (Code::Done, _) => {}
            (Code::Memory, _) => return Err(BuildError::Memory),
            (code, _) => return Err(unlike(code).into()),
        }
        Ok(Self { line, timing, compared: Compared::on(board), k: 0, failure: None })
    }

    /// What ended the comparison early.
    pub(crate) fn failure(&self) -> Option<&LinkError> {
        self.failure.as_ref()
    }

    pub(crate) fn settle<T: Real>(&mut self, r0: T, y0: T, u0: T) {
        let asked = |line: &mut Line| {
            let body = |to: &mut Writer<'_>| [r0, y0, u0].into_iter().for_each(|x| write_number(x, to));
            line.done(Kind::Settle, body).map(|_| ())
        };
        self.tell(asked);
    }

    /// A sample before the first one.
    pub(crate) fn rest<T: Real>(&mut self, input: &ControllerInput<T>) {
        self.tell(|line| line.done(Kind::Step, |to| write_input(input, to)).map(|_| ()));
    }

    /// The same sample there; `ours` is what came out here.
    pub(crate) fn step<T: Real>(&mut self, input: &ControllerInput<T>, ours: &ControllerOutput<T>) {
        if self.failure.is_some() {
            return;
        }
        let mut bytes = [0; OUTPUT];
        let mut writer = Writer::new(&mut bytes);
        write_output(ours, &mut writer);
        let length = writer.length().unwrap_or(0);
        let ours = bytes.get(..length).unwrap_or_default();
        let theirs = match self.line.done(Kind::Step, |to| write_input(input, to)) {
            Ok(theirs) if theirs.len() == length => theirs,
            Ok(_) => {
                self.failure = Some(LinkError("the board gives an output of another size".to_owned()));
                return;
            }
            Err(error) => {
                self.failure = Some(error);
                return;
            }
        };
        let compared = &mut self.compared;
        compared.samples += 1;
        compared.host_hash = fnv(compared.host_hash, ours);
        compared.board_hash = fnv(compared.board_hash, theirs);
        if ours != theirs {
            compared.differing += 1;
            let k = self.k;
            compared.first = compared.first.or_else(|| {
                let (field, host, board) = difference(ours, theirs, size::<T>())?;
                Some(Difference { k, field, host, board })
            });
        }
        self.k += 1;
    }

    pub(crate) fn advance(&mut self, n: u32) {
        self.tell(|line| line.done(Kind::Advance, |to| to.u32(n)).map(|_| ()));
        self.k += u64::from(n);
    }

    /// The law here went over to `spec`.
    pub(crate) fn adopt<T: Real>(&mut self, spec: &ControllerSpec) {
        let parameters = parameters::<T>(spec, self.timing);
        self.tell(|line| match line.ask(Kind::Adopt, |to| parameters.write(to))? {
            (Code::Done, _) => Ok(()),
            (code, _) => Err(unlike(code)),
        });
    }

    /// How both compare, once the states at the end have been compared too; `ours` is the saved state of the law here.
    pub(crate) fn finish(mut self, ours: &[u32]) -> Result<Compared, LinkError> {
        if let Some(failure) = self.failure.take() {
            return Err(failure);
        }
        let answer = self.line.done(Kind::Save, |_| ())?;
        let theirs = answer.iter().rev().fold(0_u64, |bits, &byte| bits << 8 | u64::from(byte));
        // Number of words and checksum.
        let count = u32::try_from(ours.len()).unwrap_or(u32::MAX);
        let ours = u64::from(ours.last().copied().unwrap_or(0)) << 32 | u64::from(count);
        if ours != theirs && self.compared.first.is_none() {
            let k = self.k.saturating_sub(1);
            self.compared.first = Some(Difference { k, field: "state", host: ours, board: theirs });
        }
        self.line.done(Kind::End, |_| ())?;
        Ok(self.compared)
    }

    fn tell(&mut self, ask: impl FnOnce(&mut Line) -> Result<(), LinkError>) {
        if self.failure.is_none() {
            self.failure = ask(&mut self.line).err();
        }
    }
}

enum BuildError {
    Link(LinkError),
    Memory,
}

impl From<LinkError> for BuildError {
    fn from(error: LinkError) -> Self {
        Self::Link(error)
    }
}

/// The board refuses what was accepted here.
fn unlike(code: Code) -> LinkError {
    LinkError(format!("this program accepts the controller, but the board says that it {}", code.text()))
}

/// As the board gets them: nothing rounded, it does that itself.
fn parameters<T: Real>(spec: &ControllerSpec, timing: Timing) -> Parameters {
    let Timing { ts, latency, capacity } = timing;
    Parameters {
        precision: if T::WORDS == 1 { Precision::Single } else { Precision::Double },
        kind: match (&spec.adrc, spec.compensator_config(latency)) {
            (Some(adrc), _) => Regulator::Adrc(*adrc),
            (None, Some(compensator)) => Regulator::Compensated(compensator),
            (None, None) => Regulator::Pid,
        },
        config: spec.config,
        ts,
        capacity: u32::try_from(capacity).unwrap_or(u32::MAX),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::demo;
    use crate::pil::link::Link;
    use crate::scenario::{Scenario, read};
    use crate::simulate::{AnyLaw, Precision as Number};
    use controller_core::Mode;
    use controller_pil::board::BOARDS;
    use controller_pil::frame::{FRAME, HEADER};
    use controller_pil::peer::{Peer, words_for};

    /// The peer without a board, which spoils one byte of the answer to one request.
    #[derive(Debug)]
    struct Loopback {
        peer: Peer<64, { words_for(64) }>,
        request: u32,
        spoiled: Option<(u32, usize)>,
    }

    impl Link for Loopback {
        fn exchange(&mut self, request: &[u8], answer: &mut [u8; FRAME]) -> Result<usize, LinkError> {
            let length = self.peer.answer(request, answer).len();
            self.request += 1;
            if let Some((when, at)) = self.spoiled
                && when == self.request
            {
                answer[at] ^= 1;
            }
            Ok(length)
        }
    }

    fn line(spoiled: Option<(u32, usize)>) -> Line {
        Line::new(Box::new(Loopback { peer: Peer::new(BOARDS[0].name), request: 0, spoiled }))
    }

    fn demo() -> Scenario {
        read(demo::SCENARIO, Number::F32).expect("the demo is valid").scenario
    }

    /// 100 samples of a controller of the demo and its shadow, with lost samples and a change of parameters.
    fn run<T: Real>(index: usize, spoiled: Option<(u32, usize)>) -> Result<Compared, LinkError> {
        let scenario = demo();
        let (spec, other) = (&scenario.controllers[index], &{
            let mut other = scenario.controllers[index].clone();
            other.config.pid.kp *= 0.5;
            other
        });
        let capacity = spec.needed_capacity(scenario.ts, 0.0);
        let timing = Timing { ts: scenario.ts, latency: 0.0, capacity };
        let mut law = AnyLaw::<T>::new(spec, scenario.ts, 0.0, capacity).expect("a valid law");
        let Ok(mut shadow) = Shadow::build::<T>(line(spoiled), &BOARDS[0], spec, timing) else {
            panic!("it is built");
        };
        law.settle(Mode::Auto, 0.0, 0.0, 0.0);
        shadow.settle(T::ZERO, T::ZERO, T::ZERO);
        for k in 0..100_u32 {
            match k {
                20 => {
                    law.advance(1);
                    shadow.advance(1);
                    continue;
                }
                50 => {
                    law.adopt(other).expect("a valid law");
                    shadow.adopt::<T>(other);
                }
                _ => {}
            }
            let y = T::from_f64(f64::from(k % 7) * 0.1);
            let input = ControllerInput { r: T::ONE, y, ..ControllerInput::default() };
            let output = law.step(&input);
            shadow.step(&input, &output);
        }
        shadow.finish(&law.save())
    }

    #[test]
    fn a_shadow_has_the_same_bits() {
        for index in 0..demo().controllers.len() {
            for compared in [run::<f32>(index, None), run::<f64>(index, None)] {
                let compared = compared.expect("the link works");
                assert_eq!((compared.samples, compared.differing, compared.first), (99, 0, None));
                assert_eq!(compared.host_hash, compared.board_hash);
            }
        }
    }

    #[test]
    fn one_wrong_bit_is_found_and_named() {
        // Requests 1 and 2 build and settle; request 3 is sample 0. The second number is `v`.
        let compared = run::<f32>(0, Some((10, HEADER + 4))).expect("the link works");
        let first = compared.first.expect("a difference");
        assert_eq!((first.k, first.field, first.host ^ first.board), (7, "v", 1));
        assert_eq!((compared.samples, compared.differing), (99, 1));
        assert_ne!(compared.host_hash, compared.board_hash);
        // Request 23 tells of the lost sample 20, so that 24 is sample 21.
        let late = run::<f32>(0, Some((24, HEADER))).expect("the link works").first.expect("a difference");
        assert_eq!((late.k, late.field), (21, "u"));
        // The last but one is about the state; there are 99 samples and four other requests before it.
        let state = run::<f64>(0, Some((104, HEADER + 4))).expect("the link works");
        assert_eq!((state.differing, state.first.map(|first| first.field)), (0, Some("state")));
    }

    #[test]
    fn a_link_that_breaks_is_told() {
        for (place, what) in [(0, "as if it were another"), (1, "is of no known kind"), (2, "another length")]
        {
            let error = run::<f32>(0, Some((9, place))).expect_err("a broken link").0;
            assert!(error.contains(what), "{error}");
        }
    }

    #[test]
    fn the_board_says_who_it_is() {
        assert_eq!(line(None).hello(BOARDS[0].name), Ok(64));
        let other = line(None).hello("microbit").expect_err("another board").0;
        assert!(other.contains("built for mps2-an386, not for microbit"), "{other}");
    }
}
