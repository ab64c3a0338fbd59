//! The table of measurements.

use std::path::{Path, PathBuf};

use serde_json::Value;

use super::gauge::{FORCE, FORCE_FILE, ForceRecord, SD};
use super::quantity::Quantity;
use crate::input::{Row as Cells, Table, read_bytes, table_name};
use crate::scene::FieldPath;
use crate::scene::json::number;
use crate::scene::require_positive;
use crate::scene::told::{did_you_mean, did_you_mean_one_of};
use crate::scene::{InvalidInput, SceneError, table_path};

/// Most rows of a table.
const MOST_ROWS: usize = 10_000;

const NEEDED: &str = "a table of comma-separated values whose line of names contains fields of the scene and what was \
                      measured: quantities, their standard deviations (restitution_sd and so on), or force_file";

/// Measured impacts, one per row.
#[derive(Debug, Clone, PartialEq)]
pub struct Data {
    /// Name of the table in messages; `None` for a text that has none.
    pub name: Option<String>,
    /// Fields of the scene whose values the rows state.
    pub fields: Vec<FieldPath>,
    /// The rows.
    pub rows: Vec<Row>,
    /// Whether standard deviations are stated.
    pub stated: bool,
}

/// One impact.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Line of the file, from 1, for messages.
    pub line: u64,
    /// The values of the fields.
    pub values: Vec<Value>,
    /// The measured values, with their standard deviations if they are stated.
    pub measured: Vec<(Quantity, f64, Option<f64>)>,
    /// The force over time, with the standard deviation of its noise (N) if it is stated.
    pub force: Option<(ForceRecord, Option<f64>)>,
}

impl Data {
    /// Reads a table of measurements, and the force histories that it names, from its folder or below.
    ///
    /// # Errors
    /// A file that cannot be read; a column or a cell that cannot be used, by file, line and name.
    pub fn read(path: &Path) -> Result<Data, SceneError> {
        named(path, Data::from_table(&read_bytes(path)?, folder_of(path)))
    }

    /// The files of a table that was read from `path`: this one, and the force histories that it names.
    pub fn files(&self, path: &Path) -> Vec<PathBuf> {
        let histories = self.rows.iter().filter_map(|row| row.force.as_ref());
        let named = histories.map(|(record, _)| folder_of(path).join(&record.file));
        std::iter::once(path.to_owned()).chain(named).collect()
    }

    /// Reads the table from the bytes of a file, and the force histories that it names from `folder` or below.
    ///
    /// # Errors
    /// As [`Data::read`].
    pub fn from_table(bytes: &[u8], folder: &Path) -> Result<Data, SceneError> {
        Data::parse(bytes, &|name| read_bytes(&folder.join(name)))
    }

    /// Reads the table from the bytes of a file; `open` gives those of a force history.
    ///
    /// # Errors
    /// As [`Data::read`].
    ///
    /// ```
    /// use std::io::{Error, ErrorKind};
    /// use vibroimpact::identify::{Data, Quantity};
    /// let table = b"location_m,restitution,restitution_sd\n0.4,0.31,0.01\n";
    /// let none = |_: &std::path::Path| unreachable!("the table names no file");
    /// let data = Data::parse(table, &none)?;
    /// assert_eq!(data.rows[0].measured, [(Quantity::Restitution, 0.31, Some(0.01))]);
    /// # Ok::<(), vibroimpact::SceneError>(())
    /// ```
    pub fn parse(bytes: &[u8], open: &dyn Fn(&Path) -> Result<Vec<u8>, SceneError>) -> Result<Data, SceneError> {
        let table = Table::parse(bytes, NEEDED)?;
        let columns = Columns::of(&table)?;
        if columns.measured.is_empty() && columns.force.is_none() {
            let allowed = format!("in at least one column, whose name is one of {}, {FORCE_FILE}", Quantity::names());
            return Err(InvalidInput::missing("a measured quantity", allowed).into());
        }
        let sds = columns.measured.iter().map(|(_, _, sd)| *sd).chain(columns.force.map(|(_, sd)| sd));
        let stated = sds.clone().all(|sd| sd.is_some());
        if !stated && sds.clone().any(|sd| sd.is_some()) {
            let names = columns.measured.iter().map(|(quantity, _, sd)| (quantity.name(), *sd));
            let lacks = names.chain(columns.force.map(|(_, sd)| (FORCE, sd))).find(|(_, sd)| sd.is_none());
            let name = lacks.map_or("", |(name, _)| name);
            let allowed = "in the table, because there is a column of standard deviations for another quantity; without any \
                           such column they are estimated";
            return Err(InvalidInput::missing(format!("column {name}{SD}"), allowed).into());
        }
        let rows = columns.rows(&table, open)?;
        let values = rows.iter().map(|row| row.measured.len() + usize::from(row.force.is_some())).sum::<usize>();
        if values == 0 {
            return Err(InvalidInput::new("measured values", "0", "at least 1").into());
        }
        Ok(Data { name: None, fields: columns.fields(), rows, stated })
    }

    /// Whether it contains measurements, and not only fields of the scene.
    pub(super) fn measures(&self) -> bool {
        self.rows.iter().any(|row| !row.measured.is_empty() || row.force.is_some())
    }

    /// Reads a table of candidate experiments, which contains only fields of the scene.
    ///
    /// # Errors
    /// A file that cannot be read; a column of measured values, or a cell that cannot be used.
    pub fn read_candidates(path: &Path) -> Result<Data, SceneError> {
        named(path, Data::parse_candidates(&read_bytes(path)?))
    }

    /// Reads such a table from the bytes of a file.
    ///
    /// # Errors
    /// As [`Data::read_candidates`], except for the file.
    pub fn parse_candidates(bytes: &[u8]) -> Result<Data, SceneError> {
        let table = Table::parse(bytes, NEEDED)?;
        let columns = Columns::of(&table)?;
        let too_much = columns.measured.first().map(|(quantity, ..)| quantity.name());
        if let Some(name) = too_much.or(columns.force.map(|_| FORCE_FILE)) {
            let allowed = "left out of a table of candidates, which contains fields of the scene only";
            return Err(InvalidInput::new(format!("column {name}"), "1 column", allowed).into());
        }
        let rows = columns.rows(&table, &|_| Ok(Vec::new()))?;
        Ok(Data { name: None, fields: columns.fields(), rows, stated: false })
    }
}

/// The content of each column, by its position.
struct Columns {
    fields: Vec<(FieldPath, usize)>,
    measured: Vec<(Quantity, usize, Option<usize>)>,
    force: Option<(usize, Option<usize>)>,
}

impl Columns {
    fn of(table: &Table) -> Result<Columns, InvalidInput> {
        let column = |name: &str| table.column(name);
        let sd_of = |name: &str| column(&format!("{name}{SD}"));
        let mut columns = Columns { fields: Vec::new(), measured: Vec::new(), force: None };
        for (place, name) in table.header.iter().enumerate() {
            column(name)?;
            if let Some(quantity) = Quantity::named(name) {
                columns.measured.push((quantity, place, sd_of(name)?));
            } else if name == FORCE_FILE {
                columns.force = Some((place, sd_of(FORCE)?));
            } else if let Some(quantity) = name.strip_suffix(SD) {
                let fault = |allowed: String| Err(InvalidInput::new(format!("column {name}"), "1 column", allowed));
                if Quantity::named(quantity).is_none() && quantity != FORCE {
                    let allowed = format!(
                        "beside the column of the quantity whose standard deviation it is, one of {}, {FORCE}",
                        Quantity::names()
                    );
                    let meant = did_you_mean_one_of(quantity, &allowed);
                    return fault(allowed + &meant);
                }
                let beside = if quantity == FORCE { FORCE_FILE } else { quantity };
                if column(beside)?.is_none() {
                    let slip = table
                        .header
                        .iter()
                        .find(|other| Quantity::named(other).is_none() && !did_you_mean(other, [beside]).is_empty());
                    let slip = slip.map_or_else(String::new, |slip| format!("; is the column {slip} misspelt?"));
                    return fault(format!("beside the column {beside}, whose standard deviation it is{slip}"));
                }
            } else {
                let path = FieldPath::parse(name).ok_or_else(|| {
                    let allowed =
                        format!("the path of a field of the scene, or one of {}, {FORCE_FILE}", Quantity::names());
                    InvalidInput::new(format!("the name of column {}", place + 1), format!("\"{name}\""), allowed)
                })?;
                columns.fields.push((path, place));
            }
        }
        Ok(columns)
    }

    fn fields(&self) -> Vec<FieldPath> {
        self.fields.iter().map(|(field, _)| field.clone()).collect()
    }

    fn rows(&self, table: &Table, open: &dyn Fn(&Path) -> Result<Vec<u8>, SceneError>) -> Result<Vec<Row>, SceneError> {
        if table.rows.is_empty() || table.rows.len() > MOST_ROWS {
            let allowed = format!("from 1 to {MOST_ROWS}, without the line of names");
            return Err(InvalidInput::new("number of rows", table.rows.len().to_string(), allowed).into());
        }
        table.rows.iter().map(|cells| self.row(cells, open)).collect()
    }

    fn row(&self, cells: &Cells, open: &dyn Fn(&Path) -> Result<Vec<u8>, SceneError>) -> Result<Row, SceneError> {
        let line = cells.line;
        let mut row = Row { line, values: Vec::new(), measured: Vec::new(), force: None };
        for (field, place) in &self.fields {
            let text = cells.text(*place);
            if text.is_empty() {
                let allowed = "a value that the field can have; rows that vary other fields belong in another table";
                return Err(cells.fault(InvalidInput::missing(field.path().clone(), allowed)).into());
            }
            let value = text.parse().ok().filter(|value: &f64| value.is_finite());
            row.values.push(value.map_or_else(|| Value::from(text), Value::from));
        }
        // an empty cell is a quantity that was not measured in this impact
        for &(quantity, place, sd) in self.measured.iter().filter(|(_, place, _)| !cells.text(*place).is_empty()) {
            let value = cells.number(place, quantity.name())?;
            quantity
                .allows(value)
                .map_err(|allowed| cells.fault(InvalidInput::new(quantity.name(), number(value), allowed)))?;
            row.measured.push((quantity, value, deviation(cells, sd, quantity.name())?));
        }
        if let Some((place, sd)) = self.force
            && !cells.text(place).is_empty()
        {
            let name = cells.text(place);
            let beside = |fault| {
                let allowed = "the path of a table in the folder of this one or below, without ..".to_owned();
                cells.fault(InvalidInput { allowed, ..fault })
            };
            let path: PathBuf = table_path(FORCE_FILE, name).map_err(beside)?.to_owned();
            let record = ForceRecord::parse(name, &open(&path)?).map_err(|fault| cells.fault(fault))?;
            row.force = Some((record, deviation(cells, sd, FORCE)?));
        }
        Ok(row)
    }
}

/// A table as that of the file at `path`, which errors in it name.
fn named(path: &Path, table: Result<Data, SceneError>) -> Result<Data, SceneError> {
    let name = table_name(path);
    match table {
        Ok(data) => Ok(Data { name: Some(name), ..data }),
        Err(SceneError::Invalid(fault)) => Err(fault.in_place(name).into()),
        Err(other) => Err(other),
    }
}

/// The folder of the force histories that the table at `path` names.
fn folder_of(path: &Path) -> &Path {
    path.parent().unwrap_or(Path::new(""))
}

fn deviation(cells: &Cells, place: Option<usize>, name: &str) -> Result<Option<f64>, InvalidInput> {
    let Some(place) = place else { return Ok(None) };
    let name = format!("{name}{SD}");
    let value = cells.number(place, &name)?;
    require_positive(name, value).map_err(|fault| cells.fault(fault))?;
    Ok(Some(value))
}
