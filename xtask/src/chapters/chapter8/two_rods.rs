//! Two rods that collide along their axes: the restitution is the ratio of their lengths.

use super::Parameters;
use crate::chapters::statement::Statement;
use crate::chapters::study::Study;
use beam_modes::{MOST_REMAINDER_MODES, PointMode, remainder_modes};
use contact_models::LinearSpring;
use std::f64::consts::PI;
use tasks::Failure;
use vibroimpact::report::significant;
use vibroimpact_sim::modal::{Settings, Solver, Start, Striker, Structure};

const AXIAL_MODES: usize = 200;
/// Contact stiffness over that of the shorter rod, `E A / L`.
const HARD: f64 = 1e3;
/// Lengths (m); the first one moves.
const PAIRS: [[f64; 2]; 4] = [[0.1, 0.6], [0.1, 0.2], [0.2, 0.3], [0.4, 0.4]];

/// Restitution of the rods' centres of mass. For the contact, both rods together are one structure.
fn restitution(parameters: &Parameters, lengths_m: [f64; 2]) -> Result<f64, Failure> {
    let (modulus, density) = (parameters.youngs_modulus_pa, parameters.density_kg_m3);
    let area_m2 = 0.25 * PI * parameters.our_choice.diameter_m.powi(2);
    let speed_of_sound = (modulus / density).sqrt();
    let mut modes = Vec::new();
    let (mut tail, mut rest_m_n) = (Vec::new(), 0.0);
    for length_m in lengths_m {
        let mass_kg = density * area_m2 * length_m;
        modes.push(PointMode { omega_rad_s: 0.0, shape: 1.0 / mass_kg.sqrt() });
        // all axial modes together yield L / (3 E A) at the end
        rest_m_n += length_m / (3.0 * modulus * area_m2);
        for k in 1..=2 * AXIAL_MODES {
            let omega_rad_s = k as f64 * PI * speed_of_sound / length_m;
            let mode = PointMode { omega_rad_s, shape: (2.0 / mass_kg).sqrt() };
            rest_m_n -= (mode.shape / mode.omega_rad_s).powi(2);
            (if k <= AXIAL_MODES { &mut modes } else { &mut tail }).push(mode);
        }
    }
    modes.extend(remainder_modes(&tail, rest_m_n.max(0.0), MOST_REMAINDER_MODES)?);
    let rigid = [0, 1 + AXIAL_MODES].map(|place| (place, modes[place].shape));
    let mut start = Start::at_rest(modes.len());
    start.rate[0] = parameters.our_choice.speed_m_s / rigid[0].1;
    let law = LinearSpring::new(HARD * modulus * area_m2 / lengths_m[0])?;
    let wall = Striker { mass_kg: f64::INFINITY, speed_m_s: 0.0 };
    let settings = Settings { tolerance: 1e-7, estimate_uncertainty: false, ..Settings::default() };
    let solution = Solver::new(&Structure::from_modes(modes, 0.0))?.solve(&wall, &law, Some(&start), &settings)?;
    let closing: f64 = rigid.iter().map(|(place, shape)| solution.rate[*place] * shape).sum();
    Ok(-closing / parameters.our_choice.speed_m_s)
}

pub(super) fn run(study: &mut Study, parameters: &Parameters) -> Result<(), Failure> {
    study.section("Two rods end to end");
    let found = study.sweep(&PAIRS, 1, |pair| restitution(parameters, *pair))?;
    let lines = PAIRS
        .iter()
        .zip(&found)
        .map(|(pair, e)| [pair[0], pair[1], *e, pair[0] / pair[1]].map(|number| significant(number, 4)).to_vec());
    study.table(&["moving rod (m)", "other rod (m)", "restitution", "L₁/L₂"], &lines.collect::<Vec<_>>());
    let worst = PAIRS.iter().zip(&found).map(|(pair, e)| (e - pair[0] / pair[1]).abs()).fold(0.0, f64::max);
    study.state(Statement::identity(
        "largest |e − L₁/L₂| of four pairs of rods, contact 1000 times stiffer than the shorter one",
        [
            "8.2.1",
            "if two rods collide normally (along their axes), the restitution is e = L₁/L₂",
            "a contact of finite stiffness",
        ],
        (0.0, 0.02),
        worst,
    ));
    Ok(())
}
