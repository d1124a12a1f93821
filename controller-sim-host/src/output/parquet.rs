//! Every sample of every controller as a Parquet file.

use super::samples::{Columns, INNER, NUMBERS};
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

/// Writes samples as rows as they come, with the [columns](Columns) of the CSV file: names, cases and modes as texts, the
/// signals as doubles, `status` as a 64-bit integer; what a row has not, a case or a loop inside, is null.
/// Holds 131072 rows at a time; the same samples give the same bytes.
pub struct ParquetWriter<W: Write + Send> {
    file: SerializedFileWriter<W>,
    columns: Columns,
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
    inner: [Vec<f64>; INNER.len()],
    /// 1 where there is a loop inside, 0 where it is null.
    has_inner: Vec<i16>,
    mode: Vec<ByteArray>,
    status: Vec<i64>,
}

impl<W: Write + Send> std::fmt::Debug for ParquetWriter<W> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("ParquetWriter").field("columns", &self.columns).finish_non_exhaustive()
    }
}

impl<W: Write + Send> ParquetWriter<W> {
    /// Begins a file.
    ///
    /// # Errors
    /// Whatever the writer cannot do.
    pub fn new(to: W, columns: Columns) -> Result<Self> {
        let mut properties = WriterProperties::builder()
            // The library's own name would change the bytes with each of its versions.
            .set_created_by(concat!("controller-sim ", env!("CARGO_PKG_VERSION")).to_owned())
            .set_compression(Compression::SNAPPY)
            .set_statistics_enabled(EnabledStatistics::Chunk)
            .set_offset_index_disabled(true);
        for name in NUMBERS.into_iter().chain(INNER) {
            // No two samples need have a number in common; the bytes of like numbers compress better side by side.
            properties = properties
                .set_column_dictionary_enabled(name.into(), false)
                .set_column_encoding(name.into(), Encoding::BYTE_STREAM_SPLIT);
        }
        let file = SerializedFileWriter::new(to, Arc::new(schema(columns)?), Arc::new(properties.build()))?;
        let none = ByteArray::from("");
        let (scenario, controller) = (none.clone(), none);
        Ok(Self { file, columns, scenario, case: None, controller, rows: Rows::default() })
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
        if self.columns.chapters {
            rows.scenario.push(self.scenario.clone());
            rows.has_case.push(i16::from(self.case.is_some()));
            rows.case.extend(self.case.clone());
        }
        rows.controller.push(self.controller.clone());
        let (numbers, inner) = super::samples::numbers(s);
        for (column, x) in rows.numbers.iter_mut().zip(numbers) {
            column.push(x);
        }
        if self.columns.inner {
            rows.has_inner.push(i16::from(inner.is_some()));
            for (column, x) in rows.inner.iter_mut().zip(inner.into_iter().flatten()) {
                column.push(x);
            }
        }
        rows.mode.push(ByteArray::from(s.mode.name()));
        rows.status.push(i64::from(s.status.bits()));
        if rows.status.len() == ROWS { self.write_rows() } else { Ok(()) }
    }

    fn write_rows(&mut self) -> Result<()> {
        let mut group = self.file.next_row_group()?;
        let rows = &mut self.rows;
        if self.columns.chapters {
            texts(&mut group, &mut rows.scenario, None)?;
            texts(&mut group, &mut rows.case, Some(&mut rows.has_case))?;
        }
        texts(&mut group, &mut rows.controller, None)?;
        for numbers in &mut rows.numbers {
            column(&mut group, |to| to.typed::<DoubleType>().write_batch(numbers, None, None))?;
            numbers.clear();
        }
        if self.columns.inner {
            for numbers in &mut rows.inner {
                let present = Some(&*rows.has_inner);
                column(&mut group, |to| to.typed::<DoubleType>().write_batch(numbers, present, None))?;
                numbers.clear();
            }
            rows.has_inner.clear();
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

fn schema(columns: Columns) -> Result<Type> {
    let field = |name: &'static str| {
        let physical = match name {
            "scenario" | "case" | "controller" | "mode" => Physical::BYTE_ARRAY,
            "status" => Physical::INT64,
            _ => Physical::DOUBLE,
        };
        let may_be_null = name == "case" || INNER.contains(&name);
        let repetition = if may_be_null { Repetition::OPTIONAL } else { Repetition::REQUIRED };
        let logical = (physical == Physical::BYTE_ARRAY).then_some(LogicalType::String);
        let field = Type::primitive_type_builder(name, physical).with_repetition(repetition);
        field.with_logical_type(logical).build().map(Arc::new)
    };
    let fields = columns.names().map(field).collect::<Result<_>>()?;
    Type::group_type_builder("samples").with_fields(fields).build()
}
