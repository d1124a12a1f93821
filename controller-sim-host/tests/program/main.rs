//! The program as it is called: exit codes, streams, JSON, files.

mod analyze;
mod assess;
mod batch;
mod card;
mod design;
mod export;
mod faults;
mod features;
mod figures;
mod files;
mod folder;
mod gallery;
mod identify;
#[cfg(unix)]
mod interrupt;
mod map;
mod page_words;
mod pages;
mod parquet;
mod pil;
mod reproduced;
mod runs;
mod same_bytes;
mod sample;
mod schema;
mod several;
mod studies;
mod tune;
