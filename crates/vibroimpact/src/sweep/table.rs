//! A table as a Parquet file: the columns of a CSV file, typed, in groups of rows.

use std::fs::File;
use std::io;
use std::path::Path;
use std::sync::Arc;

use parquet::basic::{Compression, LogicalType, Repetition, Type as Physical};
use parquet::data_type::{BoolType, ByteArray, ByteArrayType, DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::Type;

use super::error::SweepError;

/// Number of rows in memory that become one group of the file.
const GROUP: usize = 1 << 18;

/// The type of a column.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    /// A whole number, or nothing.
    Whole,
    /// A number, or nothing.
    Number,
    /// `true` or `false`, or nothing.
    Truth,
    /// A text.
    Text,
}

/// A column of the group that is being filled. A definition level of 0 means that there is no value.
enum Column {
    Whole(Vec<i64>, Vec<i16>),
    Number(Vec<f64>, Vec<i16>),
    Truth(Vec<bool>, Vec<i16>),
    Text(Vec<ByteArray>),
}

impl Column {
    fn new(kind: Kind) -> Column {
        match kind {
            Kind::Whole => Column::Whole(Vec::new(), Vec::new()),
            Kind::Number => Column::Number(Vec::new(), Vec::new()),
            Kind::Truth => Column::Truth(Vec::new(), Vec::new()),
            Kind::Text => Column::Text(Vec::new()),
        }
    }

    /// Adds a cell; a value of another type becomes a cell without value.
    fn push(&mut self, cell: &str) {
        fn optional<T: std::str::FromStr>(cell: &str, values: &mut Vec<T>, levels: &mut Vec<i16>) {
            let value = cell.parse().ok();
            levels.push(i16::from(value.is_some()));
            values.extend(value);
        }
        match self {
            Column::Whole(values, levels) => optional(cell, values, levels),
            Column::Number(values, levels) => optional(cell, values, levels),
            Column::Truth(values, levels) => optional(cell, values, levels),
            Column::Text(values) => values.push(ByteArray::from(cell)),
        }
    }

    fn field(name: &str, kind: Kind) -> Result<Arc<Type>, ParquetError> {
        let (physical, repetition, logical) = match kind {
            Kind::Whole => (Physical::INT64, Repetition::OPTIONAL, None),
            Kind::Number => (Physical::DOUBLE, Repetition::OPTIONAL, None),
            Kind::Truth => (Physical::BOOLEAN, Repetition::OPTIONAL, None),
            Kind::Text => (Physical::BYTE_ARRAY, Repetition::REQUIRED, Some(LogicalType::String)),
        };
        let field = Type::primitive_type_builder(name, physical).with_repetition(repetition);
        Ok(Arc::new(field.with_logical_type(logical).build()?))
    }
}

/// A Parquet file that is being written.
pub(crate) struct Table {
    writer: SerializedFileWriter<File>,
    columns: Vec<(Kind, Column)>,
    rows: usize,
}

impl Table {
    /// Begins a table of this name with these columns.
    pub(crate) fn create(path: &Path, name: &str, columns: Vec<(String, Kind)>) -> Result<Table, SweepError> {
        let make = || {
            let fields = columns.iter().map(|(name, kind)| Column::field(name, *kind)).collect::<Result<_, _>>()?;
            let schema = Arc::new(Type::group_type_builder(name).with_fields(fields).build()?);
            // the bytes depend on the rows alone
            let properties = WriterProperties::builder()
                .set_created_by(concat!("vibroimpact version ", env!("CARGO_PKG_VERSION")).to_owned())
                .set_compression(Compression::SNAPPY)
                .build();
            let writer = SerializedFileWriter::new(File::create(path)?, schema, Arc::new(properties))?;
            let columns = columns.into_iter().map(|(_, kind)| (kind, Column::new(kind))).collect();
            Ok(Table { writer, columns, rows: 0 })
        };
        make().map_err(blame(path))
    }

    /// Adds a row of cells in the order of the columns.
    pub(crate) fn add<'c>(&mut self, cells: impl Iterator<Item = &'c str>, path: &Path) -> Result<(), SweepError> {
        for ((_, column), cell) in self.columns.iter_mut().zip(cells) {
            column.push(cell);
        }
        self.rows += 1;
        if self.rows == GROUP { self.write_group().map_err(blame(path)) } else { Ok(()) }
    }

    fn write_group(&mut self) -> Result<(), ParquetError> {
        let mut group = self.writer.next_row_group()?;
        for (kind, column) in &mut self.columns {
            let Some(mut writer) = group.next_column()? else { break };
            match std::mem::replace(column, Column::new(*kind)) {
                Column::Whole(values, levels) => {
                    writer.typed::<Int64Type>().write_batch(&values, Some(&levels), None)?
                }
                Column::Number(values, levels) => {
                    writer.typed::<DoubleType>().write_batch(&values, Some(&levels), None)?
                }
                Column::Truth(values, levels) => {
                    writer.typed::<BoolType>().write_batch(&values, Some(&levels), None)?
                }
                Column::Text(values) => writer.typed::<ByteArrayType>().write_batch(&values, None, None)?,
            };
            writer.close()?;
        }
        group.close()?;
        self.rows = 0;
        Ok(())
    }

    /// Writes the last group and the index of the file, and waits until all is on the disk.
    pub(crate) fn close(mut self, path: &Path) -> Result<(), SweepError> {
        let mut close = || {
            if self.rows > 0 {
                self.write_group()?;
            }
            self.writer.finish()?;
            Ok(self.writer.inner().sync_all()?)
        };
        close().map_err(blame(path))
    }
}

fn blame(path: &Path) -> impl FnOnce(ParquetError) -> SweepError + '_ {
    move |fault| SweepError::Io { path: path.to_owned(), source: io::Error::other(fault) }
}
