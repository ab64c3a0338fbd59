//! One impact by a general solver, phase by phase.

use super::definition::{Impact, Outcome};
use super::flight::fly;
use super::system::{Equations, Phase, Tables};
use contact_models::{After, ContactLaw, Memory};
use std::time::Instant;

/// The method of free flight.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Flight {
    /// The general solver, as for contacts.
    Integrated,
    /// Exact propagation of the modes and a certified search for the next contact.
    Exact,
}

/// A general solver with its own location of events.
pub trait Integrator {
    /// Integrates from `t_s` until an event function becomes negative or `end_s` is reached. Updates time and state, and
    /// returns the number of the event function.
    ///
    /// # Errors
    /// The reason why it could not continue.
    fn advance(
        &mut self,
        equations: &Equations<'_>,
        t_s: &mut f64,
        y: &mut [f64],
        end_s: f64,
        deadline: Instant,
    ) -> Result<Option<usize>, String>;
}

/// Largest number of changes of phase; the library's impacts need up to a hundred or two.
const MOST_PHASES: usize = 2000;

/// Computes an impact until `end_s`, which the caller knows from the reference: a general solver cannot know that no further
/// contact follows. Returns the result and the number of evaluations of the right-hand side.
///
/// # Errors
/// The reason why the solver could not continue, or that it met far too many events.
pub fn follow(
    impact: &Impact,
    integrator: &mut impl Integrator,
    flight: Flight,
    end_s: f64,
    deadline: Instant,
) -> Result<(Outcome, u64), String> {
    let tables = Tables::new(impact);
    let n = impact.structure.modes.len();
    let mut y = vec![0.0; 2 * n + 2];
    y[1] = -impact.striker.speed_m_s;
    let mut t = 0.0;
    let mut memory = Memory::default();
    let mut phase = Phase::Contact(impact.law.touch(&memory, impact.striker.speed_m_s));
    let mut contact_times_s = vec![0.0];
    let mut impulses_n_s = Vec::new();
    let mut speed_at_touch = y[1];
    for _ in 0..MOST_PHASES {
        let equations = Equations::new(impact, &tables, phase, &y);
        let met = match (phase, flight) {
            (Phase::Flight, Flight::Exact) => fly(&impact.structure.modes, &mut t, &mut y, end_s),
            _ => integrator.advance(&equations, &mut t, &mut y, end_s, deadline)?,
        };
        let Some(which) = met else {
            if matches!(phase, Phase::Contact(_)) {
                impulses_n_s.push(impact.striker.mass_kg * (y[1] - speed_at_touch));
            }
            let restitution = y[1] / impact.striker.speed_m_s;
            return Ok((Outcome { restitution, contact_times_s, impulses_n_s }, tables.evaluations.get()));
        };
        let (xi, rate) = equations.compression(&y);
        phase = match phase {
            Phase::Flight => {
                contact_times_s.push(t);
                speed_at_touch = y[1];
                Phase::Contact(impact.law.touch(&memory, rate.max(0.0)))
            }
            Phase::Contact(branch) => match impact.law.cross(&branch, which, xi, rate) {
                After::Continue(branch) => Phase::Contact(branch),
                After::Release(left) => {
                    memory = left;
                    contact_times_s.push(t);
                    impulses_n_s.push(impact.striker.mass_kg * (y[1] - speed_at_touch));
                    Phase::Flight
                }
            },
        };
    }
    Err(format!("more than {MOST_PHASES} events"))
}
