//! Frequencies of a stepped cantilever: exact modes and Hermite finite elements, both compared with 20-digit frequencies
//! (`crates/beam-modes/tests/data`).

use crate::measure::{Effort, Found, Origin, Row, Solver, sweep};
use beam_modes::{Beam, End, Segment, fem};

const FREQUENCIES: &str = include_str!("../../../crates/beam-modes/tests/data/stepped_beam_reference.csv");

/// The beam called `halves` in the table.
fn beam() -> Beam {
    let segment =
        |rigidity, mass| Segment { length_m: 0.5, flexural_rigidity_n_m2: rigidity, mass_per_length_kg_m: mass };
    Beam { segments: vec![segment(1.0, 1.0), segment(0.2, 0.5)], ends: [End::Clamped, End::Free] }
}

fn frequencies() -> Vec<f64> {
    let rows = FREQUENCIES.lines().filter_map(|line| line.strip_prefix("halves,"));
    rows.filter_map(|row| row.split(',').nth(1)?.parse().ok()).collect()
}

fn judge(found: &[f64], reference: &[f64], cost: usize) -> Result<Found, String> {
    if found.len() < reference.len() {
        return Err(format!("only {} modes", found.len()));
    }
    let error = found.iter().zip(reference).map(|(a, b)| (a / b - 1.0).abs()).fold(0.0, f64::max);
    Ok(Found { cost: cost as u64, errors: vec![("frequencies", error)] })
}

/// The first 10, 40 and 200 frequencies.
///
/// # Errors
/// If the reference is too short.
pub fn rows(effort: &Effort) -> Result<Vec<Row>, String> {
    let reference = frequencies();
    let mut rows = Vec::new();
    let numbers: &[usize] = if effort.quick { &[10] } else { &[10, 40, 200] };
    for &n in numbers {
        let name = format!("stepped-modes-N{n}");
        let reference = reference.get(..n).ok_or("too few frequencies in the reference")?;
        let own = Solver { name: "beam-modes", origin: Origin::Own, cost_unit: "modes" };
        rows.extend(sweep(&name, own, &[n as f64], effort, |_| {
            let modes = beam().modes(n).map_err(|error| error.to_string())?;
            judge(modes.omega_rad_s(), reference, n)
        }));
        let elements: &[f64] = if effort.quick { &[8.0, 16.0] } else { &[8.0, 16.0, 32.0, 64.0, 128.0] };
        let peer = Solver { name: "Hermite finite elements", origin: Origin::Peer, cost_unit: "degrees of freedom" };
        rows.extend(sweep(&name, peer, elements, effort, |elements| {
            let model = fem::Model::new(&beam(), elements as usize).map_err(|error| error.to_string())?;
            let modes = model.modes().map_err(|error| error.to_string())?;
            judge(modes.omega_rad_s(), reference, model.dofs.len())
        }));
    }
    Ok(rows)
}
