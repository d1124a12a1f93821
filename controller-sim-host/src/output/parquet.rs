//! Every sample of every controller as a Parquet file.

use crate::simulate::Sample;
use parquet::basic::{Compression, Encoding, LogicalType, Repetition, Type as Physical};
use parquet::column::writer::ColumnWriterImpl;
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType, Int64Type};
use parquet::errors::Result;
use parquet::file::properties::{EnabledStatistics, WriterProperties};
use parquet::file::writer::{SerializedColumnWriter, SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::types::Type;
use std::io::Write;
use std::sync::Arc;

/// Rows that are held before they are written: 10 columns of them take 10 MB.
const ROWS: usize = 1 << 17;

/// Numbers of a row.
const NUMBERS: [&str; 8] = ["t", "r", "y", "u", "applied", "u_f", "d_hat", "d"];

/// Writes samples as rows as they come, with the columns of the CSV file: `scenario` and `case` (null when there is none)
/// only for several chapters, `controller` and `mode` as texts, the signals as doubles, `status` as a 64-bit integer.
/// Holds 131072 rows at a time; the same samples give the same bytes.
pub struct ParquetWriter<W: Write + Send> {
    file: SerializedFileWriter<W>,
    several: bool,
    scenario: ByteArray,
    case: Option<ByteArray>,
    controller: ByteArray,
    rows: Rows,
}

/// Rows not yet written, column by column.
#[derive(Default)]
struct Rows {
    scenario: Vec<ByteArray>,
    case: Vec<ByteArray>,
    /// 1 where there is a case, 0 where it is null.
    has_case: Vec<i16>,
    controller: Vec<ByteArray>,
    numbers: [Vec<f64>; NUMBERS.len()],
    mode: Vec<ByteArray>,
    status: Vec<i64>,
}

impl<W: Write + Send> std::fmt::Debug for ParquetWriter<W> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("ParquetWriter").field("several", &self.several).finish_non_exhaustive()
    }
}

impl<W: Write + Send> ParquetWriter<W> {
    /// Begins a file.
    ///
    /// # Errors
    /// Whatever the writer cannot do.
    pub fn new(to: W, several: bool) -> Result<Self> {
        let mut properties = WriterProperties::builder()
            // The library's own name would change the bytes with each of its versions.
            .set_created_by(concat!("controller-sim ", env!("CARGO_PKG_VERSION")).to_owned())
            .set_compression(Compression::SNAPPY)
            .set_statistics_enabled(EnabledStatistics::Chunk)
            .set_offset_index_disabled(true);
        for name in NUMBERS {
            // No two samples need have a number in common; the bytes of like numbers compress better side by side.
            properties = properties
                .set_column_dictionary_enabled(name.into(), false)
                .set_column_encoding(name.into(), Encoding::BYTE_STREAM_SPLIT);
        }
        let file = SerializedFileWriter::new(to, Arc::new(schema(several)?), Arc::new(properties.build()))?;
        let none = ByteArray::from("");
        let (scenario, controller) = (none.clone(), none);
        Ok(Self { file, several, scenario, case: None, controller, rows: Rows::default() })
    }

    /// The samples of this scenario and case follow.
    pub fn chapter(&mut self, scenario: &str, case: Option<&str>) {
        self.scenario = ByteArray::from(scenario);
        self.case = case.map(ByteArray::from);
    }

    /// The samples of this controller follow.
    pub fn controller(&mut self, name: &str) {
        self.controller = ByteArray::from(name);
    }

    /// Writes one sample.
    ///
    /// # Errors
    /// Whatever the writer cannot do.
    pub fn sample(&mut self, s: &Sample) -> Result<()> {
        let rows = &mut self.rows;
        if self.several {
            rows.scenario.push(self.scenario.clone());
            rows.has_case.push(i16::from(self.case.is_some()));
            rows.case.extend(self.case.clone());
        }
        rows.controller.push(self.controller.clone());
        let numbers = [s.t, s.r, s.y, s.u, s.applied, s.u_f, s.d_hat, s.d];
        for (column, x) in rows.numbers.iter_mut().zip(numbers) {
            column.push(x);
        }
        rows.mode.push(ByteArray::from(s.mode.name()));
        rows.status.push(i64::from(s.status.bits()));
        if rows.status.len() == ROWS { self.write_rows() } else { Ok(()) }
    }

    fn write_rows(&mut self) -> Result<()> {
        let mut group = self.file.next_row_group()?;
        let rows = &mut self.rows;
        if self.several {
            texts(&mut group, &mut rows.scenario, None)?;
            texts(&mut group, &mut rows.case, Some(&mut rows.has_case))?;
        }
        texts(&mut group, &mut rows.controller, None)?;
        for numbers in &mut rows.numbers {
            column(&mut group, |to| to.typed::<DoubleType>().write_batch(numbers, None, None))?;
            numbers.clear();
        }
        texts(&mut group, &mut rows.mode, None)?;
        column(&mut group, |to| to.typed::<Int64Type>().write_batch(&rows.status, None, None))?;
        rows.status.clear();
        group.close().map(drop)
    }

    /// Ends the file and gives the writer back.
    ///
    /// # Errors
    /// Whatever the writer cannot do.
    pub fn finish(mut self) -> Result<W> {
        if !self.rows.status.is_empty() {
            self.write_rows()?;
        }
        self.file.into_inner()
    }
}

/// Writes the next column of a row group.
fn column<W: Write + Send>(
    group: &mut SerializedRowGroupWriter<'_, W>,
    fill: impl FnOnce(&mut SerializedColumnWriter<'_>) -> Result<usize>,
) -> Result<()> {
    let Some(mut next) = group.next_column()? else { return Ok(()) };
    fill(&mut next)?;
    next.close()
}

/// Writes the next column, of texts, and empties the list.
fn texts<W: Write + Send>(
    group: &mut SerializedRowGroupWriter<'_, W>,
    list: &mut Vec<ByteArray>,
    present: Option<&mut Vec<i16>>,
) -> Result<()> {
    column(group, |to| {
        let to: &mut ColumnWriterImpl<'_, ByteArrayType> = to.typed();
        to.write_batch(list, present.as_ref().map(|levels| &***levels), None)
    })?;
    list.clear();
    if let Some(levels) = present {
        levels.clear();
    }
    Ok(())
}

fn schema(several: bool) -> Result<Type> {
    let primitive =
        |name, physical| Type::primitive_type_builder(name, physical).with_repetition(Repetition::REQUIRED);
    let text = |name| primitive(name, Physical::BYTE_ARRAY).with_logical_type(Some(LogicalType::String));
    let mut fields = Vec::new();
    if several {
        fields.push(text("scenario").build()?);
        fields.push(text("case").with_repetition(Repetition::OPTIONAL).build()?);
    }
    fields.push(text("controller").build()?);
    for name in NUMBERS {
        fields.push(primitive(name, Physical::DOUBLE).build()?);
    }
    fields.push(text("mode").build()?);
    fields.push(primitive("status", Physical::INT64).build()?);
    Type::group_type_builder("samples").with_fields(fields.into_iter().map(Arc::new).collect()).build()
}
