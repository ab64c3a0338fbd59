//! Tables of measured or computed restitutions.

use std::path::Path;

use super::fit::Observations;
use super::{impact_on, require_vibration};
use crate::input::{Row, Table, read_bytes, table_name};
use crate::scene::json::number;
use crate::scene::{InvalidInput, Scene, SceneError, Structure};

const COLUMNS: [&str; 3] = ["mass_kg", "location_m", "restitution"];
const NEEDED: &str = "a table of comma-separated values whose line of names contains mass_kg, location_m and \
                      restitution, each once";

/// One impact of a table.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Datum {
    /// Line of the file, from 1, for messages.
    pub line: u64,
    /// Mass of the striker (kg).
    pub mass_kg: f64,
    /// Location on the beam, from its left end (m).
    pub location_m: f64,
    /// Net restitution.
    pub restitution: f64,
}

/// Reads a CSV file with the columns `mass_kg`, `location_m` and `restitution`, in any order and among others.
///
/// # Errors
/// A file that cannot be read, a column that is missing, or a cell that is not a finite number (with file and line).
pub fn read(path: &Path) -> Result<Vec<Datum>, SceneError> {
    Ok(parse(&read_bytes(path)?).map_err(|fault| in_table(path, fault))?)
}

/// An error in the table at `path`, as those of [`Scene::observations`] that name a line.
pub fn in_table(path: &Path, fault: InvalidInput) -> InvalidInput {
    fault.in_place(table_name(path))
}

/// Reads the same table from the bytes of a file.
///
/// # Errors
/// As [`read`], except for the file.
///
/// ```
/// let table = vibroimpact::net::parse(b"restitution,mass_kg,location_m\n0.5,0.1,0.3\n")?;
/// assert_eq!((table[0].line, table[0].mass_kg), (2, 0.1));
/// # Ok::<(), vibroimpact::InvalidInput>(())
/// ```
pub fn parse(bytes: &[u8]) -> Result<Vec<Datum>, InvalidInput> {
    let table = Table::parse(bytes, NEEDED)?;
    let mut places = [0; 3];
    for (place, name) in places.iter_mut().zip(COLUMNS) {
        *place = table.needed_column(name, NEEDED)?;
    }
    let row = |row: &Row| {
        let mut values = [0.0; 3];
        for ((value, place), name) in values.iter_mut().zip(places).zip(COLUMNS) {
            *value = row.number(place, name)?;
        }
        let [mass_kg, location_m, restitution] = values;
        Ok(Datum { line: row.line, mass_kg, location_m, restitution })
    };
    table.rows.iter().map(row).collect()
}

impl Scene {
    /// Input of the law for the impacts of a table on the scene's beam. Striker, location and modes of the scene
    /// itself are not used: the table's masses and locations and `modes` take their place.
    ///
    /// # Errors
    /// A structure that is no beam, or a value out of range, with its line.
    ///
    /// ```
    /// use vibroimpact::{Scene, net::Datum};
    ///
    /// let scene = Scene::from_json(r#"{
    ///     "structure": { "kind": "beam", "ends": ["clamped", "free"],
    ///                    "segments": [{ "length_m": 1, "flexural_rigidity_n_m2": 274, "mass_per_length_kg_m": 1 }] },
    ///     "striker": { "mass_kg": 0.1, "speed_m_s": 1 },
    ///     "contact": { "law": "hertz", "stiffness_n_m1_5": 1.8e10 }
    /// }"#)?;
    /// let table = [(0.01, 0.3), (0.1, 0.6), (0.1, 1.0), (0.5, 0.8)].map(|(mass_kg, location_m)| {
    ///     Datum { line: 1, mass_kg, location_m, restitution: 0.4 }
    /// });
    /// let fit = scene.observations(&table, 50)?.fit().unwrap();
    /// assert!(fit.report.rms < 0.4);
    /// # Ok::<(), vibroimpact::SceneError>(())
    /// ```
    pub fn observations(&self, table: &[Datum], modes: usize) -> Result<Observations, InvalidInput> {
        let Structure::Beam(beam) = &self.structure else {
            let allowed = "beam, because the table has locations along a beam";
            return Err(InvalidInput::new(["structure", "kind"], self.structure.kind(), allowed));
        };
        let modes = beam.modes(modes)?;
        let mut observations = Observations::default();
        for datum in table {
            let at = |fault: InvalidInput| fault.in_line(datum.line);
            if !(0.0..=1.0).contains(&datum.restitution) {
                let allowed = "a coefficient of restitution from 0 to 1";
                return Err(at(InvalidInput::new("restitution", number(datum.restitution), allowed)));
            }
            let seen = modes.seen_from(datum.location_m).map_err(at)?;
            require_vibration(&seen)?;
            observations.impacts.push(impact_on(&seen, datum.mass_kg).map_err(at)?);
            observations.restitution.push(datum.restitution);
        }
        Ok(observations)
    }
}
