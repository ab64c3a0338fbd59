//! Upright rods against the exact wave solution.

use super::Parameters;
use crate::chapters::statement::Statement;
use crate::chapters::study::Study;
use contact_models::LinearSpring;
use serde::Serialize;
use tasks::Failure;
use vibroimpact::report::significant;
use vibroimpact_sim::dropped_rod::DroppedRod;
use vibroimpact_sim::modal::{Settings, Solver};

/// An upright rod on a contact of some stiffness.
#[derive(Serialize)]
struct UprightRow {
    length_m: f64,
    contact_over_rod_stiffness: f64,
    restitution: Option<f64>,
    contact_over_wave_time: f64,
}

/// Contact stiffness as a multiple of the axial stiffness `E A / L` of the rod: from a rod that is nearly rigid compared with
/// a soft spring to a rod on a hard spring.
const STIFFNESS_RATIOS: [f64; 5] = [1e-3, 1e-1, 1e1, 1e2, 1e3];
const AXIAL_MODES: usize = 200;

fn solve(parameters: &Parameters, length_m: f64, ratio: f64) -> Result<UprightRow, Failure> {
    let rod = DroppedRod { axial_modes: AXIAL_MODES, damping_ratio: 0.0, ..parameters.rod(length_m, 90.0) };
    let drop = rod.drop(parameters.our_choice.speed_m_s)?;
    let area = 0.25 * std::f64::consts::PI * rod.diameter_m.powi(2);
    let spring = LinearSpring::new(ratio * rod.youngs_modulus_pa * area / length_m)?;
    let settings = Settings { tolerance: 1e-7, estimate_uncertainty: false, ..Settings::default() };
    let solution = Solver::new(&drop.structure)?.solve(&drop.surface, &spring, Some(&drop.start), &settings)?;
    let wave_s = 2.0 * length_m * (rod.density_kg_m3 / rod.youngs_modulus_pa).sqrt();
    Ok(UprightRow {
        length_m,
        contact_over_rod_stiffness: ratio,
        restitution: solution.restitution,
        contact_over_wave_time: solution.end_s / wave_s,
    })
}

pub(super) fn run(study: &mut Study, parameters: &Parameters) -> Result<(), Failure> {
    study.section("Upright rods against the exact wave solution");
    // in these units all rods have the same solution
    let length = parameters.lengths_m[0];
    let rows = study.sweep(&STIFFNESS_RATIOS, 1, |&ratio| solve(parameters, length, ratio))?;
    study.csv("upright.csv", &rows)?;
    let line = |row: &UprightRow| {
        vec![
            significant(row.length_m, 3),
            significant(row.contact_over_rod_stiffness, 3),
            significant(row.restitution.unwrap_or(f64::NAN), 5),
            significant(row.contact_over_wave_time, 5),
        ]
    };
    study.table(
        &["length (m)", "contact stiffness over EA/L", "restitution", "last separation over 2L/c"],
        &rows.iter().map(line).collect::<Vec<_>>(),
    );
    study.text(
        "A rod that meets a rigid surface end on leaves it after 2L/c at full speed and without vibration. A soft \
         spring returns it at full speed too, as a rigid body. With a spring of intermediate stiffness, a part of the \
         energy remains in the rod as vibration. The rod has 200 axial modes, remainder modes for all others, and no \
         damping. The contact is a linear spring.",
    );
    for row in &rows {
        if row.contact_over_rod_stiffness == 1e3 {
            let quantity = format!(
                "restitution, upright on a contact 1000 times stiffer than the rod, {:.0} mm",
                1e3 * row.length_m
            );
            let reason = "a contact of finite stiffness";
            study.state(Statement::identity(
                quantity,
                ["8.2.1", "perfect, e = 1", reason],
                (0.99, 1.0),
                row.restitution.unwrap_or(f64::NAN),
            ));
            study.state(Statement::self_check(
                format!(
                    "duration of the contact of the upright rod of {:.0} mm over 2L/c, contact 1000 times stiffer",
                    1e3 * row.length_m
                ),
                ["the exact wave solution", "1", reason],
                (0.98, 1.02),
                row.contact_over_wave_time,
            ));
        }
    }
    Ok(())
}
