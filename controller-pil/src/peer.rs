//! The side on the board: answers requests, one by one.

use crate::frame::{Code, FRAME, HEADER, Header, Kind, Reader, VERSION, Writer, write};
use crate::law::{Law, Refused};
use crate::parameters::{Parameters, Precision};
use crate::sample::{read_input, read_numbers, write_output};
use controller_core::Real;

/// Bytes of a board's name in a frame.
pub const NAME: usize = 16;
/// Most saved words in one frame.
pub const WORDS_AT_ONCE: usize = 128;

/// Words of the largest state with `cells` samples of delay memory, in double precision: at most 35 numbers of the lags, 30
/// of the loop, 8 words around.
#[must_use]
pub const fn words_for(cells: usize) -> usize {
    2 * (cells + 35 + 30) + 8
}

/// A controller that answers frames, whatever they hold: no frame makes it panic, and a request that is refused changes
/// nothing.
///
/// Delay memory for `CELLS` samples, room for a saved state of `WORDS` words (see [`words_for`]).
///
/// ```
/// use controller_pil::frame::{Code, FRAME, Header, Kind, write};
/// use controller_pil::peer::{Peer, words_for};
/// let mut peer = Peer::<16, { words_for(16) }>::new("none");
/// let (mut request, mut answer) = ([0; FRAME], [0; FRAME]);
/// let early = write(&mut request, Kind::Advance as u8, 0, 5, |to| to.u32(1)).unwrap();
/// let answer = peer.answer(early, &mut answer);
/// let wanted = Header { kind: Kind::Advance as u8, code: Code::Empty as u8, length: 0, number: 5 };
/// assert_eq!(Header::read(answer), Some(wanted));
/// ```
#[derive(Debug, Clone)]
pub struct Peer<const CELLS: usize, const WORDS: usize> {
    board: &'static str,
    slot: Slot<CELLS>,
    words: [u32; WORDS],
    saved: usize,
    ended: bool,
}

#[derive(Debug, Clone)]
#[expect(clippy::large_enum_variant, reason = "there is one of them, and no heap to box it on")]
enum Slot<const CELLS: usize> {
    Empty,
    Single(Law<f32, CELLS>),
    Double(Law<f64, CELLS>),
}

/// The same words in either number type; without a controller, that there is none.
macro_rules! with_law {
    ($slot:expr, $law:ident => $body:expr) => {
        match $slot {
            Slot::Empty => return Err(Code::Empty.into()),
            Slot::Single($law) => $body,
            Slot::Double($law) => $body,
        }
    };
}

/// Why a request is not done, and the first fault of a configuration with how many there are.
struct No {
    code: Code,
    fault: Option<(u16, u8, u8, f64)>,
}

impl From<Code> for No {
    fn from(code: Code) -> Self {
        Self { code, fault: None }
    }
}

impl From<Refused> for No {
    fn from(refused: Refused) -> Self {
        match refused {
            Refused::Memory => Code::Memory.into(),
            Refused::Mismatch => Code::Mismatch.into(),
            Refused::Faults(count, one) => {
                let count = u16::try_from(count).unwrap_or(u16::MAX);
                let first = (count, one.param as u8, one.reason as u8, one.value);
                Self { code: Code::Refused, fault: Some(first) }
            }
        }
    }
}

impl<const CELLS: usize, const WORDS: usize> Peer<CELLS, WORDS> {
    /// Without a controller yet.
    #[must_use]
    pub const fn new(board: &'static str) -> Self {
        Self { board, slot: Slot::Empty, words: [0; WORDS], saved: 0, ended: false }
    }

    /// Whether the host has said that no more requests come.
    #[must_use]
    pub const fn has_ended(&self) -> bool {
        self.ended
    }

    /// The answer to the frame `request`.
    pub fn answer<'a>(&mut self, request: &[u8], answer: &'a mut [u8; FRAME]) -> &'a [u8] {
        let Some(header) = Header::read(request) else {
            return plain(answer, 0, Code::Length, 0);
        };
        let body = request.get(HEADER..).unwrap_or_default();
        let Some(kind) = Kind::from_number(header.kind) else {
            return plain(answer, header.kind, Code::Unknown, header.number);
        };
        if header.frame() != request.len() {
            return plain(answer, header.kind, Code::Length, header.number);
        }
        let Some((head, rest)) = answer.split_at_mut_checked(HEADER) else { return &[] };
        let mut writer = Writer::new(rest);
        let outcome = self.serve(kind, &mut Reader::new(body), &mut writer);
        let length = writer.length().and_then(|length| u16::try_from(length).ok());
        match (outcome, length) {
            (Ok(()), Some(length)) => {
                let header = Header { length, ..header };
                head.copy_from_slice(&header.bytes());
                answer.get(..header.frame()).unwrap_or_default()
            }
            (Ok(()), None) => plain(answer, header.kind, Code::Length, header.number),
            (Err(No { code, fault: None }), _) => plain(answer, header.kind, code, header.number),
            (Err(No { code, fault: Some((count, param, reason, value)) }), _) => {
                write(answer, header.kind, code as u8, header.number, |to| {
                    to.u16(count);
                    to.u8(param);
                    to.u8(reason);
                    to.f64(value);
                })
                .unwrap_or_default()
            }
        }
    }

    fn serve(&mut self, kind: Kind, from: &mut Reader<'_>, to: &mut Writer<'_>) -> Result<(), No> {
        match kind {
            Kind::Hello => self.hello(from, to),
            Kind::Build => self.build(from),
            Kind::Settle => with_law!(&mut self.slot, law => settle(law, from)),
            Kind::Step => with_law!(&mut self.slot, law => step(law, from, to)),
            Kind::Adopt => self.adopt(from),
            Kind::Advance => {
                let n = whole(from, Reader::u32)?;
                with_law!(&mut self.slot, law => law.advance(n));
                Ok(())
            }
            Kind::Save => self.save(from, to),
            Kind::Fetch => self.fetch(from, to),
            Kind::Store => self.store(from),
            Kind::Restore => {
                ended(from)?;
                let words = self.words.get(..self.saved).unwrap_or_default();
                with_law!(&mut self.slot, law => law.restore(words)).map_err(|_| Code::Snapshot.into())
            }
            Kind::End => {
                ended(from)?;
                self.ended = true;
                Ok(())
            }
        }
    }

    fn hello(&self, from: &mut Reader<'_>, to: &mut Writer<'_>) -> Result<(), No> {
        let theirs = whole(from, Reader::u16)?;
        // Either side may be the older one: this answer has the same bytes in every version.
        to.u16(VERSION);
        to.u32(u32::try_from(CELLS).unwrap_or(u32::MAX));
        let name = self.board.as_bytes();
        let byte = |i| name.get(i).copied().unwrap_or(0);
        to.put(&core::array::from_fn::<u8, NAME, _>(byte));
        if theirs == VERSION { Ok(()) } else { Err(Code::Version.into()) }
    }

    #[inline(never)]
    fn build(&mut self, from: &mut Reader<'_>) -> Result<(), No> {
        let parameters = whole(from, Parameters::read)?;
        match parameters.precision {
            Precision::Single => self.build_single(&parameters),
            Precision::Double => self.build_double(&parameters),
        }
    }

    // A function of its own for each, for the sake of the stack.

    #[inline(never)]
    fn build_single(&mut self, parameters: &Parameters) -> Result<(), No> {
        self.slot = Slot::Single(Law::new(parameters)?);
        Ok(())
    }

    #[inline(never)]
    fn build_double(&mut self, parameters: &Parameters) -> Result<(), No> {
        self.slot = Slot::Double(Law::new(parameters)?);
        Ok(())
    }

    #[inline(never)]
    fn adopt(&mut self, from: &mut Reader<'_>) -> Result<(), No> {
        let parameters = whole(from, Parameters::read)?;
        match (&mut self.slot, parameters.precision) {
            (Slot::Empty, _) => return Err(Code::Empty.into()),
            (Slot::Single(law), Precision::Single) => law.adopt(&parameters)?,
            (Slot::Double(law), Precision::Double) => law.adopt(&parameters)?,
            _ => return Err(Code::Mismatch.into()),
        }
        Ok(())
    }

    fn save(&mut self, from: &mut Reader<'_>, to: &mut Writer<'_>) -> Result<(), No> {
        ended(from)?;
        let saved = with_law!(&self.slot, law => law.save(&mut self.words)).map_err(|_| Code::Snapshot)?;
        self.saved = saved;
        to.u32(u32::try_from(saved).unwrap_or(u32::MAX));
        // The last word is the checksum over the others.
        to.u32(saved.checked_sub(1).and_then(|last| self.words.get(last)).copied().unwrap_or(0));
        Ok(())
    }

    fn fetch(&self, from: &mut Reader<'_>, to: &mut Writer<'_>) -> Result<(), No> {
        let begin = index(whole(from, Reader::u32)?);
        let words = self.words.get(begin..self.saved).unwrap_or_default();
        words.iter().take(WORDS_AT_ONCE).for_each(|&word| to.u32(word));
        Ok(())
    }

    fn store(&mut self, from: &mut Reader<'_>) -> Result<(), No> {
        let begin = index(from.u32().ok_or(Code::Length)?);
        // Nothing is stored unless all of it can be.
        let (mut count, mut ahead) = (0, from.clone());
        while ahead.u32().is_some() {
            count += 1;
        }
        ended(&ahead)?;
        let end = begin.checked_add(count).ok_or(Code::Snapshot)?;
        let place = self.words.get_mut(begin..end).ok_or(Code::Snapshot)?;
        for word in place {
            *word = from.u32().ok_or(Code::Length)?;
        }
        self.saved = end;
        Ok(())
    }
}

fn plain(answer: &mut [u8; FRAME], kind: u8, code: Code, number: u32) -> &[u8] {
    write(answer, kind, code as u8, number, |_| ()).unwrap_or_default()
}

fn index(word: u32) -> usize {
    usize::try_from(word).unwrap_or(usize::MAX)
}

/// All of a body, as one thing.
fn whole<'a, V>(from: &mut Reader<'a>, read: impl FnOnce(&mut Reader<'a>) -> Option<V>) -> Result<V, No> {
    let value = read(from).ok_or(Code::Value)?;
    ended(from)?;
    Ok(value)
}

fn ended(from: &Reader<'_>) -> Result<(), No> {
    from.end().ok_or(Code::Length.into())
}

fn settle<T: Real, const N: usize>(law: &mut Law<T, N>, from: &mut Reader<'_>) -> Result<(), No> {
    let [r0, y0, u0] = whole(from, read_numbers)?;
    law.settle(r0, y0, u0);
    Ok(())
}

fn step<T: Real, const N: usize>(
    law: &mut Law<T, N>,
    from: &mut Reader<'_>,
    to: &mut Writer<'_>,
) -> Result<(), No> {
    let input = whole(from, read_input)?;
    write_output(&law.step(&input), to);
    Ok(())
}
