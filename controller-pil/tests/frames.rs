//! What goes into a frame comes out of it, and no frame upsets the peer.
#![cfg(feature = "laws")]

mod support;

use controller_core::{Controller, ControllerInput, Mode};
use controller_pil::frame::{Code, FRAME, HEADER, Header, Kind, Reader, VERSION, Writer, write};
use controller_pil::parameters::{Parameters, Precision};
use controller_pil::peer::{Peer, words_for};
use controller_pil::sample::{OUTPUT, difference, read_input, read_output, write_input, write_output};
use proptest::prelude::*;
use support::{configs, inputs, outputs, parameters};

const CELLS: usize = 32;
type Small = Peer<CELLS, { words_for(CELLS) }>;

/// A request as bytes.
fn request(kind: Kind, body: impl FnOnce(&mut Writer<'_>)) -> Vec<u8> {
    let mut buffer = [0; FRAME];
    write(&mut buffer, kind as u8, 0, 1, body).expect("fits").to_vec()
}

/// The code and the body of the answer.
fn ask(peer: &mut Small, request: &[u8]) -> (Option<Code>, Vec<u8>) {
    let mut buffer = [0; FRAME];
    let answer = peer.answer(request, &mut buffer);
    let header = Header::read(answer).expect("an answer has a header");
    assert_eq!(header.frame(), answer.len());
    (Code::from_number(header.code), answer[HEADER..].to_vec())
}

fn done(peer: &mut Small, request: &[u8]) -> Vec<u8> {
    let (code, body) = ask(peer, request);
    assert_eq!(code, Some(Code::Done));
    body
}

/// All bytes of what `write` writes.
fn bytes(write: impl FnOnce(&mut Writer<'_>)) -> Vec<u8> {
    let mut buffer = [0; FRAME];
    let mut writer = Writer::new(&mut buffer);
    write(&mut writer);
    let length = writer.length().expect("fits");
    buffer[..length].to_vec()
}

fn settle(r0: f64, y0: f64, u0: f64) -> Vec<u8> {
    request(Kind::Settle, |to| [r0, y0, u0].into_iter().for_each(|x| to.f64(x)))
}

#[test]
fn a_peer_says_who_it_is() {
    let mut peer = Small::new("a board");
    let body = done(&mut peer, &request(Kind::Hello, |to| to.u16(VERSION)));
    assert_eq!(body, [&[1, 0, 32, 0, 0, 0][..], b"a board\0\0\0\0\0\0\0\0\0"].concat());
    let other = ask(&mut peer, &request(Kind::Hello, |to| to.u16(VERSION + 1)));
    assert_eq!(other.0, Some(Code::Version));
}

#[test]
fn a_refused_configuration_names_its_first_fault_and_leaves_the_controller() {
    let mut peer = Small::new("");
    let mut parameters = support::plain();
    done(&mut peer, &request(Kind::Build, |to| parameters.write(to)));
    let step = request(Kind::Step, |to| write_input(&ControllerInput { r: 1.0, ..Default::default() }, to));
    let first = done(&mut peer.clone(), &step);
    (parameters.config.pid.kp, parameters.config.pid.tf) = (f64::INFINITY, -1.0);
    for kind in [Kind::Build, Kind::Adopt] {
        let (code, body) = ask(&mut peer, &request(kind, |to| parameters.write(to)));
        assert_eq!(code, Some(Code::Refused));
        // Two faults; the first is of kp (2): not finite (1).
        assert_eq!(
            (&body[..4], f64::from_le_bytes(body[4..].try_into().unwrap())),
            (&[2, 0, 2, 1][..], f64::INFINITY)
        );
    }
    assert_eq!(done(&mut peer, &step), first);
}

#[test]
fn memory_precision_and_kind_are_checked() {
    let mut peer = Small::new("");
    let observed = support::observed(CELLS as u32 + 1);
    assert_eq!(ask(&mut peer, &request(Kind::Build, |to| observed.write(to))).0, Some(Code::Memory));
    done(&mut peer, &request(Kind::Build, |to| support::observed(8).write(to)));
    let longer = Parameters { kind: support::observed_kind(0.2), ..support::observed(CELLS as u32) };
    assert_eq!(ask(&mut peer, &request(Kind::Adopt, |to| longer.write(to))).0, Some(Code::Mismatch));
    let single = Parameters { precision: Precision::Single, ..support::observed(8) };
    assert_eq!(ask(&mut peer, &request(Kind::Adopt, |to| single.write(to))).0, Some(Code::Mismatch));
    assert_eq!(
        ask(&mut peer, &request(Kind::Adopt, |to| support::plain().write(to))).0,
        Some(Code::Mismatch)
    );
    let step = request(Kind::Step, |to| write_input(&ControllerInput::<f32>::default(), to));
    assert_ne!(ask(&mut peer, &step).0, Some(Code::Done), "the controller runs in f64");
}

#[test]
fn a_state_is_saved_fetched_stored_and_restored() {
    let mut peer = Small::new("");
    done(&mut peer, &request(Kind::Build, |to| support::observed(20).write(to)));
    done(&mut peer, &settle(0.0, 0.0, 0.0));
    let step = |r: f64| {
        request(Kind::Step, |to| write_input(&ControllerInput { r, y: 0.3, ..Default::default() }, to))
    };
    let restore = request(Kind::Restore, |_| ());
    assert_eq!(ask(&mut peer, &restore).0, Some(Code::Snapshot));
    for _ in 0..50 {
        done(&mut peer, &step(1.0));
    }
    let saved = done(&mut peer, &request(Kind::Save, |_| ()));
    let count = u32::from_le_bytes(saved[..4].try_into().unwrap());
    let mut words = Vec::new();
    while words.len() < count as usize * 4 {
        words.extend(done(&mut peer, &request(Kind::Fetch, |to| to.u32(words.len() as u32 / 4))));
    }
    assert_eq!((words.len(), &words[words.len() - 4..]), (count as usize * 4, &saved[4..]));
    let next = done(&mut peer, &step(2.0));
    done(&mut peer, &restore);
    assert_eq!(done(&mut peer, &step(2.0)), next);
    // Into another peer, in two parts.
    let mut other = Small::new("");
    done(&mut other, &request(Kind::Build, |to| support::observed(20).write(to)));
    for (begin, part) in [(0, &words[..40]), (10, &words[40..])] {
        done(
            &mut other,
            &request(Kind::Store, |to| {
                to.u32(begin);
                to.put(part)
            }),
        );
    }
    done(&mut other, &restore);
    assert_eq!(done(&mut other, &step(2.0)), next);
    // A damaged word is refused.
    done(
        &mut other,
        &request(Kind::Store, |to| {
            to.u32(5);
            to.u32(7)
        }),
    );
    done(
        &mut other,
        &request(Kind::Store, |to| {
            to.u32(count - 1);
            to.put(&words[words.len() - 4..])
        }),
    );
    assert_eq!(ask(&mut other, &restore).0, Some(Code::Snapshot));
    let beyond = request(Kind::Store, |to| {
        to.u32(u32::MAX);
        to.u32(7)
    });
    assert_eq!(ask(&mut other, &beyond).0, Some(Code::Snapshot));
}

#[test]
fn the_largest_state_can_be_saved() {
    let mut peer = Small::new("");
    done(&mut peer, &request(Kind::Build, |to| support::largest(CELLS as u32).write(to)));
    let saved = done(&mut peer, &request(Kind::Save, |_| ()));
    assert!(u32::from_le_bytes(saved[..4].try_into().unwrap()) as usize <= words_for(CELLS));
}

#[test]
fn the_first_difference_is_named_with_its_bits() {
    let output = bytes(|to| write_output(&controller_core::ControllerOutput::<f64>::default(), to));
    assert_eq!((output.len(), difference(&output, &output, 8)), (OUTPUT, None));
    let mut other = output.clone();
    other[OUTPUT - 1] = 1;
    assert_eq!(difference(&output, &other, 8), Some(("status", 0, 1 << 24)));
    other[56] = 2;
    assert_eq!(difference(&output, &other, 8), Some(("blocked", 0, 2)));
    other[15] = 0x80;
    assert_eq!(difference(&output, &other, 8), Some(("v", 0, 1 << 63)));
}

proptest! {
    #[test]
    fn parameters_come_back(parameters in parameters()) {
        let first = bytes(|to| parameters.write(to));
        let mut reader = Reader::new(&first);
        let read = Parameters::read(&mut reader).expect("what was written is read");
        prop_assert_eq!(reader.end(), Some(()));
        // Bits, not values: every number, also one that is none, comes back.
        prop_assert_eq!(bytes(|to| read.write(to)), first);
        prop_assert_eq!(format!("{parameters:?}"), format!("{read:?}"));
    }

    #[test]
    fn a_cut_configuration_is_not_read(parameters in parameters(), at in any::<prop::sample::Index>()) {
        let whole = bytes(|to| parameters.write(to));
        prop_assert_eq!(Parameters::read(&mut Reader::new(&whole[..at.index(whole.len())])), None);
    }

    #[test]
    fn samples_come_back(input in inputs(), output in outputs()) {
        let first = bytes(|to| write_input(&input, to));
        let read = read_input::<f64>(&mut Reader::new(&first)).expect("what was written is read");
        prop_assert_eq!(format!("{input:?}"), format!("{read:?}"));
        prop_assert_eq!(bytes(|to| write_input(&read, to)), first);
        let first = bytes(|to| write_output(&output, to));
        let read = read_output::<f64>(&mut Reader::new(&first)).expect("what was written is read");
        prop_assert_eq!(format!("{output:?}"), format!("{read:?}"));
        prop_assert_eq!(bytes(|to| write_output(&read, to)), first);
    }

    #[test]
    fn a_peer_steps_like_the_controller_itself(
        config in configs(), list in prop::collection::vec((inputs(), 0_u32..40, any::<bool>()), 1..40)
    ) {
        let Ok(law) = Controller::<f64>::new(&config, 0.01) else { return Ok(()) };
        let mut state = law.zeroed();
        let mut peer = Small::new("");
        let parameters = Parameters { config, ..support::plain() };
        done(&mut peer, &request(Kind::Build, |to| parameters.write(to)));
        for (input, n, settled) in list {
            if settled {
                law.settle(&mut state, input.r, input.y, input.offset);
                done(&mut peer, &settle(input.r, input.y, input.offset));
            } else if n < 3 {
                law.advance(&mut state, n);
                done(&mut peer, &request(Kind::Advance, |to| to.u32(n)));
            } else {
                let ours = law.step(&mut state, &input);
                let theirs = done(&mut peer, &request(Kind::Step, |to| write_input(&input, to)));
                prop_assert_eq!(difference(&bytes(|to| write_output(&ours, to)), &theirs, 8), None);
            }
        }
    }

    #[test]
    fn any_bytes_are_answered(list in prop::collection::vec(prop::collection::vec(any::<u8>(), 0..80), 1..20)) {
        let mut peer = Small::new("");
        list.iter().for_each(|bytes| { let _ = ask(&mut peer, bytes); });
    }

    #[test]
    fn damaged_frames_are_answered_and_the_peer_still_works(
        parameters in parameters(),
        damage in prop::collection::vec((0..11_usize, any::<prop::sample::Index>(), any::<u8>(), any::<bool>()), 1..40),
        input in inputs()
    ) {
        let mut peer = Small::new("");
        let frames: Vec<Vec<u8>> = Kind::ALL.iter().map(|&kind| request(kind, |to| match kind {
            Kind::Hello => to.u16(VERSION),
            Kind::Build | Kind::Adopt => parameters.write(to),
            Kind::Settle => [1.0, 2.0, 3.0].into_iter().for_each(|x| to.f64(x)),
            Kind::Step => write_input(&input, to),
            Kind::Advance | Kind::Fetch => to.u32(3),
            Kind::Store => { to.u32(1); to.u32(2) }
            Kind::Save | Kind::Restore | Kind::End => {}
        })).collect();
        for (which, place, byte, cut) in damage {
            let mut frame = frames[which].clone();
            let place = place.index(frame.len());
            frame[place] = byte;
            if cut {
                frame.truncate(place);
            }
            let _ = ask(&mut peer, &frame);
        }
        done(&mut peer, &request(Kind::Build, |to| support::plain().write(to)));
        let sample = ControllerInput { mode: Mode::Auto, y: 1.0, ..ControllerInput::<f64>::default() };
        done(&mut peer, &request(Kind::Step, |to| write_input(&sample, to)));
    }
}
