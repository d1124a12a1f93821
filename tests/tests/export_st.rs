//! Exported function blocks: their statements, printed as C by a generator of these tests, step with the bits of the core;
//! so does their text, printed as C from the tree of a foreign parser; independent front ends of Structured Text accept it;
//! what it prints is what is meant.
//!
//! To renew the committed block: `RENEW_EXPORTS=1 cargo test -p controller-tests --test export_st`.

#[path = "export_st/anew.rs"]
mod anew;
#[path = "capi/archive.rs"]
mod archive;
#[path = "export_st/bits.rs"]
mod bits;
#[path = "export_st/compiled.rs"]
mod compiled;
#[path = "export_st/damaged.rs"]
mod damaged;
#[path = "export_st/drive.rs"]
mod drive;
#[path = "export_st/fixtures.rs"]
mod fixtures;
#[path = "export_st/header.rs"]
mod header;
#[path = "export_st/linked.rs"]
mod linked;
#[path = "export_st/loops.rs"]
mod loops;
#[path = "export_st/mutations.rs"]
mod mutations;
#[path = "export_st/parsers.rs"]
mod parsers;
#[path = "export_st/print_c.rs"]
mod print_c;
#[path = "export_st/program_text.rs"]
mod program_text;
#[path = "export_st/recorded.rs"]
mod recorded;
#[path = "export_st/text.rs"]
mod text;
#[path = "export_st/text_bits.rs"]
mod text_bits;
#[path = "export_st/trace.rs"]
mod trace;
#[path = "export_st/translate/mod.rs"]
mod translate;
#[path = "export_st/vocabulary.rs"]
mod vocabulary;
