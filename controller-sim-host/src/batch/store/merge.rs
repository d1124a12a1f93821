//! The shards of a study as one file.

use super::columns::ColumnWriter;
use super::table::push_line;
use super::{Format, RowReader};
use crate::batch::layout::{Cells, Layout};
use crate::output::{FileTarget, Problem, is_same_file, publish};
use std::io::Write;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// One of the files: the study of its rows, and which ones they are, from 1.
struct Part {
    path: PathBuf,
    study: String,
    layout: Layout,
    rows: Range<usize>,
}

/// Joins the shards of a study, tables or Parquet files in any order, to the file that the whole study gives; gives the name
/// of the study and its number of rows, all of which `see` was shown in their order.
///
/// # Errors
/// All reasons why the files are not one study: rows that are missing or there twice, rows of different studies, files that
/// have no rows of a study; a file that exists and may not be replaced.
pub fn merge(
    parts: &[PathBuf],
    out: &Path,
    force: bool,
    mut see: impl FnMut(&Layout, &Cells),
) -> Result<(String, usize), Vec<Problem>> {
    let one = |problem: Problem| vec![problem];
    let format = Format::of(out).map_err(one)?;
    let target = FileTarget::new(out, force).map_err(one)?;
    let mut problems = Vec::new();
    if let Some(same) = parts.iter().find(|part| is_same_file(part, out)) {
        let message =
            format!("`{}` is one of the files that are joined and is not overwritten", same.display());
        return Err(one(Problem::new("file", message).help("give the file of `--out` another name")));
    }
    let mut found = Vec::new();
    for path in parts {
        match scan(path) {
            Ok(part) => found.push(part),
            Err(why) => {
                problems
                    .push(Problem::new("file", format!("`{}` is no part of a study: {why}", path.display())));
            }
        }
    }
    found.sort_by_key(|part| (part.rows.start, part.rows.end));
    problems.extend(faults(&found));
    if !problems.is_empty() {
        return Err(problems);
    }
    let Some(layout) = found.first().map(|part| part.layout.clone()) else {
        return Err(one(Problem::new("usage", "there are no files to join")));
    };
    let mut draft = target.create().map_err(one)?;
    let failed = |error: &dyn std::fmt::Display| vec![target.failed(error)];
    let mut rows = 0;
    let mut each = |take: &mut dyn FnMut(&Cells) -> Result<(), Vec<Problem>>| -> Result<(), Vec<Problem>> {
        for part in &found {
            let mut reader = RowReader::open(&part.path).map_err(|why| failed(&why))?;
            while let Some(row) = reader.next_row().map_err(|why| failed(&why))? {
                see(&layout, &row);
                rows += 1;
                take(&row)?;
            }
        }
        Ok(())
    };
    let draft = match format {
        Format::Csv => {
            let mut line = layout.head() + "\n";
            each(&mut |row| {
                push_line(&mut line, row);
                let written = draft.write_all(line.as_bytes());
                line.clear();
                written.map_err(|error| failed(&error))
            })?;
            draft
        }
        Format::Parquet => {
            let mut writer = ColumnWriter::new(draft, &layout).map_err(|error| failed(&error))?;
            each(&mut |row| writer.write(row).map_err(|error| failed(&error)))?;
            writer.finish().map_err(|error| failed(&error))?
        }
    };
    publish(vec![draft.complete().map_err(one)?]).map_err(one)?;
    let study = found.into_iter().next().map(|part| part.study).unwrap_or_default();
    Ok((study, rows))
}

/// Looks at every row of a file.
fn scan(path: &Path) -> Result<Part, String> {
    let mut reader = RowReader::open(path)?;
    let first = reader.next_row()?.ok_or("it has no rows")?;
    let (study, start) = (first.study().to_owned(), first.number());
    let layout = reader.layout().cloned().ok_or("it has no rows")?;
    let mut next = start + 1;
    while let Some(row) = reader.next_row()? {
        if row.study() != study {
            return Err(format!("row {next} is of another study than the one before"));
        }
        if row.number() != next {
            return Err(format!("row {} follows row {}", row.number(), next - 1));
        }
        next += 1;
    }
    Ok(Part { path: path.to_owned(), study, layout, rows: start..next })
}

/// Why the parts, in the order of their rows, are not a whole.
fn faults(parts: &[Part]) -> Vec<Problem> {
    let mut problems = Vec::new();
    let Some(first) = parts.first() else { return problems };
    for part in parts.iter().filter(|part| part.study != first.study || part.layout != first.layout) {
        let message =
            format!("`{}` and `{}` are of different studies", first.path.display(), part.path.display());
        let help = "shards of one study have the same plants, methods, options and version of the program";
        problems.push(Problem::new("study", message).help(help));
    }
    if !problems.is_empty() {
        return problems;
    }
    let total = first.study.rsplit_once('/').and_then(|(_, total)| total.parse().ok()).unwrap_or(0);
    let missing = |range: Range<usize>| {
        let (rows, are) = words(&range);
        let message = format!("{rows} of {total} {are} in none of the files");
        Problem::new("study", message).help("an interrupted shard goes on with `--resume`")
    };
    let mut next = 1;
    let mut before: Option<&Part> = None;
    for part in parts {
        if part.rows.start > next {
            problems.push(missing(next..part.rows.start));
        }
        if let Some(before) = before.filter(|_| part.rows.start < next) {
            let twice = part.rows.start..part.rows.end.min(next);
            let files = (before.path.display(), part.path.display());
            let (rows, are) = words(&twice);
            let message = format!("{rows} {are} in `{}` and in `{}`", files.0, files.1);
            problems.push(Problem::new("study", message).help("give each shard once"));
        }
        if part.rows.end > next {
            next = part.rows.end;
            before = Some(part);
        }
    }
    if next <= total {
        problems.push(missing(next..total + 1));
    }
    if next > total + 1 {
        problems.push(Problem::new("study", format!("there are rows beyond the last one, {total}")));
    }
    problems
}

fn words(range: &Range<usize>) -> (String, &'static str) {
    if range.len() == 1 {
        (format!("row {}", range.start), "is")
    } else {
        (format!("rows {} to {}", range.start, range.end - 1), "are")
    }
}
