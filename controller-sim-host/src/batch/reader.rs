//! Rows from files.

use super::layout::{Cells, Layout, show};
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::Field;
use parquet::record::reader::RowIter;
use std::fs::File;
use std::io::{BufRead, BufReader, Read, Seek};
use std::path::Path;

/// Longest line of a table: no row is as long.
const LONGEST: u64 = 1 << 20;

/// What a Parquet file begins with.
const MAGIC: &[u8; 4] = b"PAR1";

/// Reads the rows of a file, one after the other; memory does not grow with the file.
pub struct RowReader {
    layout: Option<Layout>,
    from: Source,
}

enum Source {
    /// A table.
    Csv {
        /// The rest of it.
        from: BufReader<File>,
        /// Bytes of the lines read so far, all of them complete.
        complete: u64,
    },
    /// A Parquet file.
    Parquet(RowIter<'static>),
}

impl std::fmt::Debug for RowReader {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("RowReader").field("layout", &self.layout).finish_non_exhaustive()
    }
}

/// What is not as it must be, without the name of the file.
type Wrong = String;

impl RowReader {
    /// Begins to read: a Parquet file by its first bytes, else a table, whose first line must name the columns of a study. A
    /// file without a complete first line has no rows.
    ///
    /// # Errors
    /// What the system reports; a file that is none of a study.
    pub fn open(path: &Path) -> Result<Self, Wrong> {
        let mut file = File::open(path).map_err(|error| error.to_string())?;
        let mut first = Vec::new();
        file.by_ref().take(4).read_to_end(&mut first).map_err(|error| error.to_string())?;
        file.rewind().map_err(|error| error.to_string())?;
        if first == MAGIC {
            let reader = SerializedFileReader::new(file).map_err(|error| error.to_string())?;
            let schema = reader.metadata().file_metadata().schema_descr();
            let names: Vec<String> = schema.columns().iter().map(|column| column.name().to_owned()).collect();
            let layout = Layout::named(&names).ok_or("it has not the columns of a study")?;
            let rows = RowIter::from_file_into(Box::new(reader));
            return Ok(Self { layout: Some(layout), from: Source::Parquet(rows) });
        }
        let from = Source::Csv { from: BufReader::new(file), complete: 0 };
        let mut reader = Self { layout: None, from };
        if let Some(line) = reader.line()? {
            let names: Vec<String> = line.split(',').map(str::to_owned).collect();
            let layout = Layout::named(&names);
            reader.layout = Some(layout.ok_or("its first line does not name the columns of a study")?);
        }
        Ok(reader)
    }

    /// The columns; `None`: the first line is not complete.
    #[must_use]
    pub fn layout(&self) -> Option<&Layout> {
        self.layout.as_ref()
    }

    /// Bytes of a table up to the end of its last complete row.
    #[must_use]
    pub fn complete(&self) -> u64 {
        match &self.from {
            Source::Csv { complete, .. } => *complete,
            Source::Parquet(_) => 0,
        }
    }

    /// The next complete line; a last one without its end is none.
    fn line(&mut self) -> Result<Option<String>, Wrong> {
        let Source::Csv { from, complete } = &mut self.from else { return Ok(None) };
        let mut bytes = Vec::new();
        from.take(LONGEST).read_until(b'\n', &mut bytes).map_err(|error| error.to_string())?;
        if bytes.last() != Some(&b'\n') {
            return if (bytes.len() as u64) < LONGEST {
                Ok(None)
            } else {
                Err("it has lines that are no rows".to_owned())
            };
        }
        *complete += bytes.len() as u64;
        bytes.pop();
        String::from_utf8(bytes).map(Some).map_err(|_| "it is not UTF-8 text".to_owned())
    }

    /// The next row; `None` at the end. A last line that was cut off is none.
    ///
    /// # Errors
    /// What the system reports; a line that is no row.
    pub fn next_row(&mut self) -> Result<Option<Cells>, Wrong> {
        if let Source::Parquet(rows) = &mut self.from {
            return match rows.next() {
                None => Ok(None),
                Some(Err(error)) => Err(error.to_string()),
                Some(Ok(row)) => {
                    let cells = row.get_column_iter().map(|(_, field)| cell(field)).collect();
                    let row = self.layout.as_ref().and_then(|layout| layout.read(cells));
                    row.map(Some).ok_or_else(|| "it has rows of another kind".to_owned())
                }
            };
        }
        let Some(line) = self.line()? else { return Ok(None) };
        let mut parser =
            csv::ReaderBuilder::new().has_headers(false).flexible(true).from_reader(line.as_bytes());
        let record = parser.records().next().and_then(Result::ok);
        let cells = record.map(|record| record.iter().map(str::to_owned).collect());
        let row = self.layout.as_ref().zip(cells).and_then(|(layout, cells)| layout.read(cells));
        row.map(Some).ok_or_else(|| {
            let start: String = line.chars().take(40).collect();
            format!("a line of it is no row: {start}")
        })
    }
}

fn cell(field: &Field) -> String {
    match field {
        Field::Str(text) => text.clone(),
        Field::Double(x) => show(*x),
        Field::Long(n) => n.to_string(),
        _ => String::new(),
    }
}
