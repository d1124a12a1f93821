//! The board's side of processor-in-the-loop runs; on a laptop an empty program.
//!
//! `controller-sim run SCENARIO.toml --pil` starts it in the emulator and talks to it through two named pipes, which it
//! opens by semihosting: the words of its command line are the names of the pipe it reads requests from and of the one
//! it writes answers to. It ends when it is told to, and when nobody is left at the other end.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(not(target_os = "none"))]
fn main() {
    println!("pil: runs on a microcontroller; started by: controller-sim run SCENARIO.toml --pil");
}

#[cfg(target_os = "none")]
mod target {
    use controller_firmware::image::{exit, println};
    use controller_pil::frame::{FRAME, Header};
    use controller_pil::peer::{Peer, words_for};
    use semihosting::experimental::env;
    use semihosting::fs::File;
    use semihosting::io::{self, Read as _, Write as _};

    /// Samples of delay memory: as many as leave room for the stack on the smallest board.
    const CELLS: usize = if cfg!(small_flash) { 64 } else { 4096 };

    /// Exit code when the pipes cannot be opened or break.
    const NO_PIPE: i32 = 2;
    /// Most bytes of the command line.
    const LINE: usize = 256;

    #[cortex_m_rt::entry]
    fn main() -> ! {
        static mut PEER: Peer<CELLS, { words_for(CELLS) }> = Peer::new(controller_firmware::BOARD);
        static mut REQUEST: [u8; FRAME] = [0; FRAME];
        static mut ANSWER: [u8; FRAME] = [0; FRAME];
        match serve(PEER, REQUEST, ANSWER) {
            Ok(()) => exit(0),
            Err(error) => {
                println!("pil: {error}");
                exit(NO_PIPE)
            }
        }
    }

    fn serve<const C: usize, const W: usize>(
        peer: &mut Peer<C, W>,
        request: &mut [u8; FRAME],
        answer: &mut [u8; FRAME],
    ) -> io::Result<()> {
        let arguments = env::args::<LINE>()?;
        let mut names = (&arguments).into_iter().skip(1).filter_map(Result::ok);
        // In this order: the host opens them in the same one, and each waits for the other.
        let mut requests = open(names.next(), |name| File::open(name))?;
        let mut answers = open(names.next(), |name| File::create(name))?;
        let mut filled = 0;
        while !peer.has_ended() {
            let frame = loop {
                let header = Header::read(request.get(..filled).unwrap_or_default());
                // One that cannot fit is answered with what there is of it.
                let length = header.map_or(FRAME, |header| header.frame().min(FRAME));
                if header.is_some() && filled >= length {
                    break length;
                }
                match requests.read(request.get_mut(filled..).unwrap_or_default())? {
                    0 => return Err(io::ErrorKind::UnexpectedEof.into()),
                    more => filled += more,
                }
            };
            answers.write_all(peer.answer(request.get(..frame).unwrap_or_default(), answer))?;
            request.copy_within(frame..filled, 0);
            filled -= frame;
        }
        Ok(())
    }

    /// A file whose name came on the command line.
    fn open(name: Option<&str>, how: fn(&core::ffi::CStr) -> io::Result<File>) -> io::Result<File> {
        let name = name.map_or(&[][..], str::as_bytes);
        let mut bytes = [0; LINE];
        let place = bytes.get_mut(..name.len()).ok_or(io::ErrorKind::InvalidInput)?;
        place.copy_from_slice(name);
        how(core::ffi::CStr::from_bytes_until_nul(&bytes).map_err(|_| io::ErrorKind::InvalidInput)?)
    }
}
