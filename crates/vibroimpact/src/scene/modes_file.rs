//! Modes from a table in the folder of the scene.

use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::path::{Component, Path};

use invalid_input::{InvalidInput, Step};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::error::SceneError;
use super::extreme::such_that;
use super::fields;
use super::modal::{Modal, Point};
use crate::input::{Table, read_bytes};

/// A structure given by its modes in a table of comma-separated values. The columns, in any order:
///
/// | column | meaning |
/// |---|---|
/// | `omega_rad_s` or `frequency_hz` | frequency of the mode, in one of two units; 0 for a rigid-body mode |
/// | `damping_ratio` | may be left out: 0 |
/// | `modal_mass_kg` | may be left out: shapes are mass-normalised |
/// | any other name | shapes at the point of that name (kg^-1/2, or normalised to `modal_mass_kg`) |
///
/// [`Scene::read`](crate::Scene::read) replaces it by a [`Modal`], so that the scene then needs no further file.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ModesFile {
    /// Path of the table, relative to the scene file; the table is in the same folder or below it.
    pub file: String,
    /// Static compliances (m/N) of the whole elastic structure at points of the table, by their names; needed for
    /// `"residual_compliance": true` only.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub static_compliances_m_n: BTreeMap<String, f64>,
}

const NEEDED: &str = "a table of comma-separated values whose line of names contains omega_rad_s or frequency_hz, \
                      optionally damping_ratio and modal_mass_kg, and the name of each point";

impl ModesFile {
    /// Reads the table, for a scene in `folder`.
    pub(crate) fn load(&self, folder: &Path) -> Result<Modal, SceneError> {
        let path = table_path(["structure", "file"], &self.file)?;
        let mut modal = parse(&read_bytes(&folder.join(path))?).map_err(|fault| fault.in_place(self.file.as_str()))?;
        for (name, compliance) in &self.static_compliances_m_n {
            let Some(point) = modal.points.get_mut(name) else {
                let field = ["structure", "static_compliances_m_n", name.as_str()];
                return Err(InvalidInput::new(
                    field,
                    super::json::number(*compliance),
                    "left out, because the table has no point of this name",
                )
                .into());
            };
            point.static_compliance_m_n = Some(*compliance);
        }
        Ok(modal)
    }
}

/// The path of a table that a scene names, in the folder of the scene or below.
pub(crate) fn table_path(field: impl Into<invalid_input::Path>, file: &str) -> Result<&Path, InvalidInput> {
    let path = Path::new(file);
    let below = path.components().all(|part| matches!(part, Component::Normal(_) | Component::CurDir));
    if file.is_empty() || !below {
        let allowed = fields::allowed("file").unwrap_or_default();
        return Err(InvalidInput::new(field, format!("{file:?}"), allowed));
    }
    Ok(path)
}

fn parse(bytes: &[u8]) -> Result<Modal, InvalidInput> {
    let table = Table::parse(bytes, NEEDED)?;
    let column = |name: &str| table.column(name);
    let (frequency, name, to_omega) = match (column("omega_rad_s")?, column("frequency_hz")?) {
        (Some(place), None) => (place, "omega_rad_s", 1.0),
        (None, Some(place)) => (place, "frequency_hz", TAU),
        (None, None) => {
            return Err(InvalidInput::missing("column omega_rad_s", format!("in {NEEDED}")));
        }
        (Some(_), Some(_)) => {
            return Err(InvalidInput::new(
                "column frequency_hz",
                "1 column",
                "left out in the presence of omega_rad_s",
            ));
        }
    };
    let (damping, mass) = (column("damping_ratio")?, column("modal_mass_kg")?);
    if table.rows.is_empty() {
        return Err(InvalidInput::new(
            "number of modes",
            "0",
            "at least 1; the table has one line for each mode below the line of names",
        ));
    }
    let list = |place: Option<usize>, name: &str| match place {
        None => Ok(Vec::new()),
        Some(place) => table.rows.iter().map(|row| row.number(place, name)).collect(),
    };
    let omega: Vec<f64> = list(Some(frequency), name)?;
    let mut modal = Modal {
        omega_rad_s: omega.iter().map(|value| to_omega * value).collect(),
        damping_ratios: list(damping, "damping_ratio")?,
        modal_mass_kg: list(mass, "modal_mass_kg")?,
        ..Modal::default()
    };
    let taken = [Some(frequency), damping, mass];
    for (place, name) in table.header.iter().enumerate().filter(|(place, _)| !taken.contains(&Some(*place))) {
        column(name)?;
        if name.is_empty() {
            return Err(InvalidInput::missing(
                format!("the name of column {}", place + 1),
                "in the first line of the table",
            ));
        }
        let shape = list(Some(place), name)?;
        modal.points.insert(name.to_owned(), Point { shape, ..Point::default() });
    }
    if modal.points.is_empty() {
        return Err(InvalidInput::missing("a column with the shapes at a point", format!("in {NEEDED}")));
    }
    for point in modal.points.keys() {
        modal.modes(Some(point)).map_err(|fault| in_table(&table, name, fault))?;
    }
    Ok(modal)
}

/// An error in the lists of modes as one in the table from which they were read: the line of the mode, and the column of the list.
fn in_table(table: &Table, frequency: &str, fault: InvalidInput) -> InvalidInput {
    let (column, line) = match fault.field.steps() {
        [.., Step::Field(point), Step::Field(list), Step::Index(k)] if list == "shape" => (point.as_str(), *k),
        [.., Step::Field(list), Step::Index(k)] => match list.as_str() {
            "omega_rad_s" => (frequency, *k),
            "damping_ratios" => ("damping_ratio", *k),
            same => (same, *k),
        },
        _ => return fault,
    };
    let (Some(row), Some(place)) = (table.rows.get(line), table.header.iter().position(|name| name == column)) else {
        return fault;
    };
    let allowed = match column {
        "frequency_hz" => such_that("the angular frequency in rad/s", &fault),
        _ => fault.allowed,
    };
    let value = row.number(place, column).map_or_else(|_| row.text(place).to_owned(), super::json::number);
    row.fault(InvalidInput::new(column, value, allowed))
}
