//! Rows as a Parquet file.

use crate::batch::layout::{Cells, Kind, Layout};
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

/// Writes rows as they come: texts as texts, numbers as doubles that may be null, counts as 64-bit
/// integers.
/// The same rows give the same bytes.
pub(super) struct ColumnWriter<W: Write + Send> {
    file: SerializedFileWriter<W>,
    layout: Layout,
    rows: Vec<Cells>,
}

impl<W: Write + Send> ColumnWriter<W> {
    pub(super) fn new(to: W, layout: &Layout) -> Result<Self> {
        let properties = WriterProperties::builder()
            // The library's own name would change the bytes with each of its versions.
            .set_created_by(concat!("controller-sim ", env!("CARGO_PKG_VERSION")).to_owned())
            .set_compression(Compression::SNAPPY)
            .set_statistics_enabled(EnabledStatistics::Chunk)
            .set_offset_index_disabled(true);
        let file = SerializedFileWriter::new(to, Arc::new(schema(layout)?), Arc::new(properties.build()))?;
        Ok(Self { file, layout: layout.clone(), rows: Vec::new() })
    }

    pub(super) fn write(&mut self, row: &Cells) -> Result<()> {
        self.rows.push(row.clone());
        if self.rows.len() == ROWS { self.write_group() } else { Ok(()) }
    }

    fn write_group(&mut self) -> Result<()> {
        let mut group = self.file.next_row_group()?;
        for (i, column) in self.layout.columns().iter().enumerate() {
            let cells = || self.rows.iter().map(|row| &*row.all()[i]);
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

fn schema(layout: &Layout) -> Result<Type> {
    let fields = layout.columns().iter().map(|column| {
        let (physical, repetition) = match column.kind {
            Kind::Text => (Physical::BYTE_ARRAY, Repetition::REQUIRED),
            Kind::Number => (Physical::DOUBLE, Repetition::OPTIONAL),
            Kind::Count => (Physical::INT64, Repetition::REQUIRED),
        };
        let logical = (physical == Physical::BYTE_ARRAY).then_some(LogicalType::String);
        let field = Type::primitive_type_builder(&column.name, physical).with_repetition(repetition);
        field.with_logical_type(logical).build().map(Arc::new)
    });
    Type::group_type_builder("rows").with_fields(fields.collect::<Result<_>>()?).build()
}
