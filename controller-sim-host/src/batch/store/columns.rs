//! Rows as a Parquet file.

use crate::batch::row::{COLUMNS, Kind, Row};
use parquet::basic::{Compression, LogicalType, Repetition, Type as Physical};
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType, Int64Type};
use parquet::errors::Result;
use parquet::file::properties::{EnabledStatistics, WriterProperties};
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::Type;
use std::io::Write;
use std::sync::Arc;

/// Rows of a group: so many are held in memory.
const ROWS: usize = 1 << 13;

/// Writes rows as they come: texts as texts, numbers as doubles that may be null, the number of the row as a 64-bit integer.
/// The same rows give the same bytes.
pub(super) struct ColumnWriter<W: Write + Send> {
    file: SerializedFileWriter<W>,
    rows: Vec<Row>,
}

impl<W: Write + Send> ColumnWriter<W> {
    pub(super) fn new(to: W) -> Result<Self> {
        let properties = WriterProperties::builder()
            // The library's own name would change the bytes with each of its versions.
            .set_created_by(concat!("controller-sim ", env!("CARGO_PKG_VERSION")).to_owned())
            .set_compression(Compression::SNAPPY)
            .set_statistics_enabled(EnabledStatistics::Chunk)
            .set_offset_index_disabled(true);
        let file = SerializedFileWriter::new(to, Arc::new(schema()?), Arc::new(properties.build()))?;
        Ok(Self { file, rows: Vec::new() })
    }

    pub(super) fn write(&mut self, row: &Row) -> Result<()> {
        self.rows.push(row.clone());
        if self.rows.len() == ROWS { self.write_group() } else { Ok(()) }
    }

    fn write_group(&mut self) -> Result<()> {
        let mut group = self.file.next_row_group()?;
        for (i, column) in COLUMNS.iter().enumerate() {
            let cells = || self.rows.iter().map(|row| &*row.cells()[i]);
            let Some(mut next) = group.next_column()? else { break };
            match column.kind {
                Kind::Text => {
                    let texts: Vec<ByteArray> = cells().map(ByteArray::from).collect();
                    next.typed::<ByteArrayType>().write_batch(&texts, None, None)?;
                }
                Kind::Count => {
                    let numbers: Vec<i64> = cells().map(|cell| cell.parse().unwrap_or(0)).collect();
                    next.typed::<Int64Type>().write_batch(&numbers, None, None)?;
                }
                Kind::Number => {
                    let numbers: Vec<f64> = cells().filter_map(|cell| cell.parse().ok()).collect();
                    let present: Vec<i16> = cells().map(|cell| i16::from(!cell.is_empty())).collect();
                    next.typed::<DoubleType>().write_batch(&numbers, Some(&present), None)?;
                }
            }
            next.close()?;
        }
        self.rows.clear();
        group.close().map(drop)
    }

    pub(super) fn finish(mut self) -> Result<W> {
        if !self.rows.is_empty() {
            self.write_group()?;
        }
        self.file.into_inner()
    }
}

fn schema() -> Result<Type> {
    let fields = COLUMNS.iter().map(|column| {
        let (physical, repetition) = match column.kind {
            Kind::Text => (Physical::BYTE_ARRAY, Repetition::REQUIRED),
            Kind::Number => (Physical::DOUBLE, Repetition::OPTIONAL),
            Kind::Count => (Physical::INT64, Repetition::REQUIRED),
        };
        let logical = (physical == Physical::BYTE_ARRAY).then_some(LogicalType::String);
        let field = Type::primitive_type_builder(column.name, physical).with_repetition(repetition);
        field.with_logical_type(logical).build().map(Arc::new)
    });
    Type::group_type_builder("rows").with_fields(fields.collect::<Result<_>>()?).build()
}
