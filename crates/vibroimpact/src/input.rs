//! Input files up to a size limit, and tables of comma-separated values whose errors name the line.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use csv::StringRecord;
use invalid_input::{InvalidInput, Step};

use crate::scene::SceneError;
use crate::scene::told::counted;

/// Largest size of an input file (bytes).
const MAX_FILE_BYTES: u64 = 64 << 20;

/// The bytes of a file.
pub(crate) fn read_bytes(path: &Path) -> Result<Vec<u8>, SceneError> {
    let file = File::open(path).map_err(|source| SceneError::Read { path: path.to_owned(), source })?;
    read_all(file, path)
}

/// All bytes of a source; messages refer to it as `path`.
pub(crate) fn read_all(source: impl Read, path: &Path) -> Result<Vec<u8>, SceneError> {
    let fault = |source| SceneError::Read { path: path.to_owned(), source };
    let mut bytes = Vec::new();
    source.take(MAX_FILE_BYTES + 1).read_to_end(&mut bytes).map_err(fault)?;
    if bytes.len() as u64 > MAX_FILE_BYTES {
        let told = format!("it is larger than {} MiB", MAX_FILE_BYTES >> 20);
        return Err(fault(std::io::Error::new(std::io::ErrorKind::FileTooLarge, told)));
    }
    Ok(bytes)
}

/// Name of a table in messages: that of its file without the folder, since a message shows only the beginning of a long path.
pub(crate) fn table_name(path: &Path) -> String {
    path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}

/// A table: a line of names, then rows of cells.
pub(crate) struct Table {
    /// The names of the columns.
    pub header: StringRecord,
    /// The rows.
    pub rows: Vec<Row>,
}

/// A row of a table.
pub(crate) struct Row {
    /// Line of the file, from 1.
    pub line: u64,
    cells: StringRecord,
}

impl Table {
    /// Splits the text of a table; `needed` describes the expected table in messages.
    pub fn parse(bytes: &[u8], needed: &str) -> Result<Table, InvalidInput> {
        let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
        let unreadable = |fault: csv::Error| {
            let line = |at: &csv::Position| Step::Line(1 + line_breaks(&bytes[..first_byte(bytes, at)]));
            let place = fault.position().map_or_else(|| Step::Place("the table".to_owned()), line);
            InvalidInput::new(place, "text that is not UTF-8", needed)
        };
        let mut table = csv::ReaderBuilder::new().flexible(true).trim(csv::Trim::All).from_reader(bytes);
        let header = table.headers().map_err(unreadable)?.clone();
        let (mut line, mut counted_to) = (1, 0);
        let row = |record: Result<StringRecord, csv::Error>| {
            let cells = record.map_err(unreadable)?;
            let begins = cells.position().map_or(counted_to, |start| first_byte(bytes, start));
            line += line_breaks(&bytes[counted_to..begins]);
            counted_to = begins;
            Ok(Row { line, cells })
        };
        let rows: Vec<Row> = table.records().map(row).collect::<Result<_, InvalidInput>>()?;
        if let Some(row) = rows.iter().find(|row| row.cells.len() != header.len()) {
            let allowed =
                format!("as long as the line of names, which has {}", counted(header.len() as u64, "cell", "cells"));
            return Err(InvalidInput::new(
                Step::Line(row.line),
                counted(row.cells.len() as u64, "cell", "cells"),
                allowed,
            ));
        }
        Ok(Table { header, rows })
    }

    /// The position of the column with this name, which may occur at most once.
    pub fn column(&self, name: &str) -> Result<Option<usize>, InvalidInput> {
        let found: Vec<usize> = (0..self.header.len()).filter(|&i| &self.header[i] == name).collect();
        match found.as_slice() {
            [] => Ok(None),
            [one] => Ok(Some(*one)),
            _ => {
                Err(InvalidInput::new(format!("column {name}"), format!("{} columns", found.len()), "a single column"))
            }
        }
    }

    /// As [`Table::column`], of a column that the table must have; `needed` describes the expected table in messages.
    pub fn needed_column(&self, name: &str, needed: &str) -> Result<usize, InvalidInput> {
        let missing = || InvalidInput::missing(format!("column {name}"), format!("in {needed}"));
        self.column(name)?.ok_or_else(missing)
    }
}

impl Row {
    /// The text in the column at `place`.
    pub fn text(&self, place: usize) -> &str {
        self.cells.get(place).unwrap_or_default()
    }

    /// The finite number in the column at `place`, whose name is for messages.
    pub fn number(&self, place: usize, name: &str) -> Result<f64, InvalidInput> {
        let text = self.cells.get(place).filter(|text| !text.is_empty());
        let text = text.ok_or_else(|| self.fault(InvalidInput::missing(name, "a finite number")))?;
        let number = text.parse().ok().filter(|number: &f64| number.is_finite());
        number.ok_or_else(|| self.fault(InvalidInput::new(name, text, "a finite number")))
    }

    /// An error in this row, with its line.
    pub fn fault(&self, fault: InvalidInput) -> InvalidInput {
        fault.in_line(self.line)
    }
}

/// Where a record begins. The reader's position is the end of the record before, before line breaks and empty lines.
fn first_byte(bytes: &[u8], start: &csv::Position) -> usize {
    let end = usize::try_from(start.byte()).map_or(bytes.len(), |place| place.min(bytes.len()));
    end + bytes[end..].iter().take_while(|byte| matches!(byte, b'\r' | b'\n')).count()
}

/// The number of line breaks, of which each is `\n`, `\r\n`, or `\r` alone. The reader counts only those with `\n`.
fn line_breaks(bytes: &[u8]) -> u64 {
    let ends = |i: &usize| bytes[*i] == b'\n' || (bytes[*i] == b'\r' && bytes.get(i + 1) != Some(&b'\n'));
    (0..bytes.len()).filter(ends).count() as u64
}
