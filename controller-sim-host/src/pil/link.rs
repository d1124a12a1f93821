//! Requests and answers, whatever carries them.

use controller_pil::frame::{Code, FRAME, HEADER, Header, Kind, VERSION, Writer, write};
use std::fmt::Debug;

/// Why the board could not be asked, as a sentence.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LinkError(pub String);

impl std::fmt::Display for LinkError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for LinkError {}

/// Carries one frame there and one back; every wait has a time limit.
pub(crate) trait Link: Debug + Send {
    /// The length of the answer to `request`, which is in `answer` then.
    fn exchange(&mut self, request: &[u8], answer: &mut [u8; FRAME]) -> Result<usize, LinkError>;
}

/// Numbers the requests and checks that answers belong to them.
#[derive(Debug)]
pub(crate) struct Line {
    link: Box<dyn Link>,
    number: u32,
    request: [u8; FRAME],
    answer: [u8; FRAME],
}

impl Line {
    pub(crate) fn new(link: Box<dyn Link>) -> Self {
        Self { link, number: 0, request: [0; FRAME], answer: [0; FRAME] }
    }

    /// What became of a request, and what the answer says.
    pub(crate) fn ask(
        &mut self,
        kind: Kind,
        body: impl FnOnce(&mut Writer<'_>),
    ) -> Result<(Code, &[u8]), LinkError> {
        self.number = self.number.wrapping_add(1);
        let wrong = |what: &str| LinkError(format!("the board answered request {} {what}", self.number));
        let request = write(&mut self.request, kind as u8, 0, self.number, body)
            .ok_or_else(|| LinkError("the request is too long for a frame".to_owned()))?;
        let length = self.link.exchange(request, &mut self.answer)?;
        let answer = self.answer.get(..length).unwrap_or_default();
        let header = Header::read(answer).ok_or_else(|| wrong("by too few bytes"))?;
        if header.frame() != length {
            return Err(wrong("by a frame of another length"));
        }
        if (header.kind, header.number) != (kind as u8, self.number) {
            return Err(wrong("as if it were another one"));
        }
        let code = Code::from_number(header.code).ok_or_else(|| wrong("by an unknown code"))?;
        Ok((code, answer.get(HEADER..).unwrap_or_default()))
    }

    /// What the answer says; an error unless the request is done.
    pub(crate) fn done(
        &mut self,
        kind: Kind,
        body: impl FnOnce(&mut Writer<'_>),
    ) -> Result<&[u8], LinkError> {
        match self.ask(kind, body)? {
            (Code::Done, answer) => Ok(answer),
            (code, _) => Err(LinkError(format!("the board says that a request {}", code.text()))),
        }
    }

    /// How many samples of delay memory the board has, once it is the right one.
    pub(crate) fn hello(&mut self, board: &str) -> Result<u32, LinkError> {
        let (code, answer) = self.ask(Kind::Hello, |to| to.u16(VERSION))?;
        let [a, b, c, d, e, f, name @ ..] = answer else {
            return Err(LinkError("the board does not say who it is".to_owned()));
        };
        if code != Code::Done {
            let theirs = u16::from_le_bytes([*a, *b]);
            return Err(LinkError(format!(
                "the image speaks version {theirs} of the frames, this program version {VERSION}: build it again"
            )));
        }
        let name = String::from_utf8_lossy(name);
        let name = name.trim_end_matches('\0');
        if name != board {
            return Err(LinkError(format!("the image was built for {name}, not for {board}")));
        }
        Ok(u32::from_le_bytes([*c, *d, *e, *f]))
    }
}
