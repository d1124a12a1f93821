//! The headers and the library say the same: every function, constant, structure and field, and the tables of offsets that C
//! compilers assert (`tests/c/layout.c`, `tests/c/layout_fb.c`). What is written here for C is made from the Rust types.

#![allow(clippy::expect_used, clippy::string_slice, clippy::unwrap_used, clippy::indexing_slicing)]

mod block;
mod ctl;

use controller_capi::plc::Vars;
use controller_capi::{Config, Faults, Input, Output};
use std::collections::BTreeMap;
use std::ffi::{c_char, c_void};

/// A header without comments, its lines joined where they go on.
fn code(header: &str) -> String {
    let mut text = header.replace("\\\n", " ");
    while let Some((before, rest)) = text.split_once("/*") {
        let (_, after) = rest.split_once("*/").expect("a comment ends");
        text = format!("{before}{after}");
    }
    text
}

fn words(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// The prototypes of a header.
fn prototypes_of(header: &str) -> Vec<String> {
    code(header)
        .split(';')
        .filter_map(|statement| statement.trim().lines().last())
        .filter(|line| line.contains(" ctl_") || line.contains("*ctl_"))
        .filter(|line| line.ends_with(')'))
        .map(words)
        .collect()
}

/// Every `#define CTL_... number` of a header whose value is a number.
fn constants(header: &str) -> BTreeMap<String, i64> {
    let code = code(header);
    let defines = code.lines().filter_map(|line| line.strip_prefix("#define "));
    let pairs = defines.filter_map(|line| line.split_once(' '));
    let pairs = pairs.filter(|(name, value)| !name.contains('(') && !value.trim().starts_with('('));
    let number = |text: &str| {
        let digits = text.trim().trim_end_matches('u');
        digits.strip_prefix("0x").map_or_else(|| digits.parse(), |hex| i64::from_str_radix(hex, 16))
    };
    pairs.map(|(name, text)| (name.to_string(), number(text).expect(text))).collect()
}

fn text(pointer: *const c_char) -> String {
    // SAFETY: the functions give text that lives as long as the program.
    unsafe { std::ffi::CStr::from_ptr(pointer) }.to_str().unwrap().to_string()
}

fn size_of_field<S, F>(_: impl Fn(&S) -> &F) -> usize {
    size_of::<F>()
}

/// A Rust type as C writes it, up to the name that follows.
pub(crate) trait Spelled {
    const C: &'static str;
}

macro_rules! spelled {
    ($($rust:ty => $c:literal;)*) => { $(impl Spelled for $rust { const C: &'static str = $c; })* };
}

spelled! {
    u32 => "uint32_t ";
    i32 => "int32_t ";
    usize => "size_t ";
    f32 => "float ";
    f64 => "double ";
    *const c_char => "const char *";
    *mut c_void => "void *";
    *const c_void => "const void *";
    *mut u32 => "uint32_t *";
    *const u32 => "const uint32_t *";
    *mut usize => "size_t *";
    *mut Config => "ctl_config *";
    *const Config => "const ctl_config *";
    *mut Faults => "ctl_faults *";
    *mut Vars<f32> => "ctl_f32_fb_vars *";
    *mut Vars<f64> => "ctl_f64_fb_vars *";
    *const Input<f32> => "const ctl_f32_input *";
    *mut Output<f32> => "ctl_f32_output *";
    *const Input<f64> => "const ctl_f64_input *";
    *mut Output<f64> => "ctl_f64_output *";
}

/// Prototypes, each of which the compiler compares with the function.
macro_rules! prototypes {
    ($(fn $name:ident($($arg:ident: $type:ty),*) -> $result:ty;)*) => {
        vec![$({
            let _: unsafe extern "C" fn($($type),*) -> $result = $name;
            let args: &[String] = &[$(format!("{}{}", <$type>::C, stringify!($arg))),*];
            let args = if args.is_empty() { "void".to_string() } else { args.join(", ") };
            format!("{}{}({args})", <$result>::C, stringify!($name))
        }),*]
    };
}
pub(crate) use prototypes;
