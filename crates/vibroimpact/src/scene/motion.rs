//! The motion at the start as input of the solver.

use invalid_input::InvalidInput;
use vibroimpact_sim::modal::{self, Mode};

use super::definition::Scene;
use super::start::{Start, by_frequency};

impl Scene {
    /// The start as input of the solver, for these modes with their shapes at the point of impact. The last `remainder` of them are
    /// remainder modes, which start at rest.
    pub(crate) fn start(&self, modes: &[Mode], remainder: usize) -> Result<Option<modal::Start>, InvalidInput> {
        let Some(start) = &self.start else { return Ok(None) };
        let mut posed = self.posed(start, &modes[..modes.len() - remainder])?;
        posed.amplitude.resize(modes.len(), 0.0);
        posed.rate.resize(modes.len(), 0.0);
        Ok(Some(posed))
    }

    fn posed(&self, start: &Start, modes: &[Mode]) -> Result<modal::Start, InvalidInput> {
        let ranks = self.structure.ranks();
        let of = |field: &str, first: &[f64]| {
            by_frequency(field, first, modes.len(), ranks.as_deref()).map_err(|fault| fault.within("start"))
        };
        let mut posed = modal::Start {
            amplitude: of("amplitude_m_kg0_5", &start.amplitude_m_kg0_5)?,
            rate: of("rate_m_kg0_5_s", &start.rate_m_kg0_5_s)?,
            gap_m: start.gap_m,
        };
        let here = self.place();
        for (i, moving) in start.moving_modes.iter().enumerate() {
            let within = |fault: InvalidInput| fault.within(("moving_modes", i)).within("start");
            let there = moving.place(here);
            let (k, shape) = if there == here {
                moving.shape(modes)
            } else {
                let seen = self.structure.modes(there, Some(modes.len())).map_err(|fault| {
                    // an error of the structure itself has its own path
                    if matches!(fault.field.first(), Some("location_m" | "location")) { within(fault) } else { fault }
                })?;
                moving.shape(&seen)
            }
            .map_err(within)?;
            posed.amplitude[k] += moving.displacement_m / shape;
            posed.rate[k] += moving.velocity_m_s / shape;
        }
        Ok(posed)
    }
}
