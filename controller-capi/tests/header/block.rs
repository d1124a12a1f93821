//! `ctl_fb.h`: every function, constant and field, and the table of offsets in `tests/c/layout_fb.c`.

use crate::{Spelled, code, constants, prototypes, prototypes_of, text, words};
use controller_capi::plc::vars::{Choice, Choices, Setting, Settings};
use controller_capi::plc::{Kind, Number, Vars, status};
use controller_capi::*;
use std::collections::BTreeMap;
use std::ffi::{c_char, c_void};

const HEADER: &str = include_str!("../../include/ctl_fb.h");
const LAYOUT: &str = include_str!("../../../tests/c/layout_fb.c");

macro_rules! variant {
    ($real:ty: $size:ident $without:ident $align:ident) => {
        prototypes! {
            fn $size(delay: u32) -> usize;
            fn $without() -> usize;
            fn $align() -> usize;
        }
    };
}

macro_rules! calls {
    ($real:ty: $initial:ident $fb:ident) => {
        (
            prototypes! { fn $initial(vars: *mut Vars<$real>, vars_size: usize) -> i32; },
            prototypes! { fn $fb(state: *mut c_void, size: usize, vars: *mut Vars<$real>) -> i32; },
        )
    };
}

#[test]
fn every_function() {
    let mut ours = prototypes! { fn ctl_fb_param_name(param: i32) -> *const c_char; };
    ours.extend(variant! { f32: ctl_f32_fb_size ctl_f32_fb_size_without_compensator ctl_f32_fb_align });
    ours.extend(variant! { f64: ctl_f64_fb_size ctl_f64_fb_size_without_compensator ctl_f64_fb_align });
    let (initial, fb) = calls! { f32: ctl_f32_fb_initial ctl_f32_fb };
    let (initial_too, fb_too) = calls! { f64: ctl_f64_fb_initial ctl_f64_fb };
    for more in [initial, initial_too, fb, fb_too] {
        ours.extend(more);
    }
    assert_eq!(prototypes_of(HEADER), ours);
    // Every exported function is one of these: `exports.rs` has no other.
    let exports = include_str!("../../src/plc/exports.rs");
    assert_eq!(exports.matches("no_mangle").count(), 1 + 5);
    assert!(ours.iter().all(|p| !p.contains("_setup(") && !p.contains("_loop(")));
}

#[test]
fn every_constant() {
    let ours = [
        ("STATUS_PERIOD_OFF", status::PERIOD_OFF.into()),
        ("STATUS_COMPENSATOR_OUT", status::COMPENSATOR_OUT.into()),
        ("STATUS_REFUSED", status::REFUSED.into()),
        ("STATUS_STATE_LOST", status::STATE_LOST.into()),
        ("STATUS_NOT_RUNNING", status::NOT_RUNNING.into()),
        // What the tests of the block give PV_SRC and PV_QUALITY (`tests/function_block/spans.rs`, `behaviour.rs`).
        ("PV_ENGINEERING", 0),
        ("PV_COUNTS", 1),
        ("PV_PERCENT", 2),
        ("QUALITY_BAD", 0),
        ("QUALITY_UNCERTAIN", 1),
        ("QUALITY_GOOD", 2),
    ];
    let ours = ours.iter().map(|&(name, value)| (format!("CTL_FB_{name}"), value));
    let aligns = [("F32", ctl_f32_fb_align()), ("F64", ctl_f64_fb_align())];
    let aligns = aligns.map(|(variant, align)| (format!("CTL_{variant}_FB_ALIGN"), align as i64));
    let ours: BTreeMap<String, i64> = ours.chain(aligns).collect();
    assert_eq!(constants(HEADER), ours);
    // No bit has two meanings.
    let bits: Vec<u32> = controller_core::Status::NAMES.iter().map(|(bit, _)| bit.bits()).collect();
    let own = ours.iter().filter(|(name, _)| name.contains("STATUS")).map(|(_, &bit)| bit as u32);
    let all = bits.into_iter().chain(own).fold(0_u32, |all, bit| {
        assert!(bit.is_power_of_two() && all & bit == 0, "{bit:x}");
        all | bit
    });
    assert_eq!(all.count_ones(), 25);
}

/// The macros that are sums: what the block adds to the block of its loop.
#[test]
fn the_macros_of_sizes_are_the_functions() {
    fn check<T: Number>(variant: &str, size: usize, without: usize) {
        let own = T::FB_FIXED + 8;
        let code = code(HEADER);
        let line = |start: &str| words(code.lines().find(|line| line.starts_with(start)).expect(start));
        let name = format!("#define CTL_{variant}_FB_SIZE(delay)");
        assert_eq!(line(&name), format!("{name} ({own} + CTL_{variant}_SIZE(delay))"));
        assert_eq!(size, own + if variant == "F32" { ctl_f32_size(7) } else { ctl_f64_size(7) });
        let name = format!("#define CTL_{variant}_FB_SIZE_WITHOUT_COMPENSATOR");
        assert_eq!(line(&name), format!("{name} ({own} + CTL_{variant}_SIZE_WITHOUT_COMPENSATOR)"));
        assert_eq!(without, own + T::SIZE_WITHOUT_COMPENSATOR);
        let name = format!("#define CTL_{variant}_FB_WORDS(delay)");
        assert_eq!(line(&name), format!("{name} (CTL_{variant}_FB_SIZE(delay) / 8)"));
    }
    check::<f32>("F32", ctl_f32_fb_size(7), ctl_f32_fb_size_without_compensator());
    check::<f64>("F64", ctl_f64_fb_size(7), ctl_f64_fb_size_without_compensator());
}

fn size<T>(kind: Kind) -> usize {
    match kind {
        Kind::Real => size_of::<T>(),
        Kind::Whole | Kind::Bits => 4,
        Kind::Flag => 1,
    }
}

/// The table of the variables, as `layout_fb.c` has it.
fn layout<T: Number>(c: &str) -> String {
    let mut lines = format!("ALL({c}, {}, {});\n", size_of::<Vars<T>>(), align_of::<Vars<T>>());
    let mut end = 0;
    for (field, kind, offset) in Vars::<T>::fields() {
        assert_eq!(offset, end, "no gap before {field}");
        end += size::<T>(kind);
        lines += &format!("AT({c}, {field}, {offset}, {});\n", size::<T>(kind));
    }
    assert_eq!(end.next_multiple_of(align_of::<Vars<T>>()), size_of::<Vars<T>>(), "no field is missing");
    lines
}

#[test]
fn every_field() {
    let expected = [layout::<f32>("ctl_f32_fb_vars"), layout::<f64>("ctl_f64_fb_vars")].join("\n");
    let table = LAYOUT.find("ALL(ctl_f32").map(|at| &LAYOUT[at..]).unwrap_or_default();
    assert_eq!(table.trim_end(), expected.trim_end(), "tests/c/layout_fb.c must end with this:\n{expected}");
    // Every field of the header, with its type, in this order.
    let code = code(HEADER);
    let (_, rest) = code.split_once("#define CTL_FB_FIELDS(real)").expect("the fields");
    let (body, _) = rest.split_once('\n').expect("their end");
    let of_the_header: Vec<String> = body.split(';').map(words).filter(|field| !field.is_empty()).collect();
    let ours = Vars::<f32>::fields().map(|(field, kind, _)| {
        let kind = match kind {
            Kind::Real => "real",
            Kind::Whole => "int32_t",
            Kind::Bits => "uint32_t",
            Kind::Flag => "uint8_t",
        };
        format!("{kind} {field}")
    });
    assert_eq!(of_the_header, ours.collect::<Vec<_>>());
}

#[test]
fn every_number_of_a_parameter_has_its_name_and_no_other_has_one() {
    let named = |number: i32| text(ctl_fb_param_name(number));
    let mut known = BTreeMap::from([(0, "no parameter".to_string()), (201, "state".to_string())]);
    for (first, names) in
        [(Setting::ts as i32, Settings::<f32>::NAMES), (Choice::scan_div as i32, Choices::NAMES)]
    {
        known.extend((first..).zip(names.iter().map(ToString::to_string)));
    }
    for number in (-300..300).chain([i32::MIN, i32::MAX, 0x1_0001, 1000]) {
        let expected = known.get(&number).map_or("unknown parameter", String::as_str);
        assert_eq!(named(number), expected, "{number}");
    }
}
