//! The tables of chapter 4 with the inputs of the laws.

use crate::chapters::beam::Beam;
use crate::chapters::chapter4::tables::Table;
use crate::chapters::impact::Row;
use emoc::{Impact, Site};
use tasks::Failure;
use vibroimpact::net::Observations;

/// Modes in the law (thesis 7.2).
pub const LAW_MODES: usize = 50;
/// Modes of the converged tables.
pub const SETTLED_MODES: usize = 100;

/// The table of one beam with the inputs of the laws for each impact.
pub struct Dataset<'a> {
    pub beam: &'a Beam,
    pub table: &'a Table<'a>,
    /// The results that have a restitution, location by location.
    pub rows: Vec<&'a Row>,
}

impl<'a> Dataset<'a> {
    pub fn new(table: &'a Table<'a>) -> Dataset<'a> {
        Dataset { beam: table.beam, table, rows: table.all().filter(|row| row.restitution.is_some()).collect() }
    }

    /// Inputs of the law for each impact, with this many modes.
    pub fn observations(&self, modes: usize) -> Result<Observations, Failure> {
        let mut observations = Observations::default();
        for row in &self.rows {
            let structure = self.beam.structure(row.location_m, modes, 0.0, false)?;
            let phi: Vec<f64> = structure.modes.iter().map(|mode| mode.shape).collect();
            observations.impacts.push(Impact::new(row.mass_kg, &Site::new(&phi)?)?);
            observations.restitution.push(row.e());
        }
        Ok(observations)
    }
}
