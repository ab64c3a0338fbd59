//! Modes of uniform beams in closed form, compared with those of the search.

use crate::common::{ENDS, segment};
use beam_modes::{Attachment, Beam, BeamSystem, End, Modes, ShearSection};
use proptest::prelude::*;

/// The same beam with a mass that is too small to matter: it is searched for modes, in two spans.
fn searched(system: &BeamSystem) -> BeamSystem {
    let mass = Attachment { location_m: 0.41 * system.beam.length_m(), mass_kg: 1e-200, ..Attachment::default() };
    BeamSystem { attachments: vec![mass], ..system.clone() }
}

/// Largest difference of frequencies, and of shapes and rotations, relative to the largest of each mode and multiplied by the
/// distance to the next frequency relative to this one: the rounding of a frequency mixes two modes in inverse proportion to it.
fn differences(ours: &Modes, theirs: &Modes) -> [f64; 3] {
    let mut worst = [0.0f64; 3];
    let length_m = ours.length_m();
    for k in 0..ours.len() {
        let (omega, other) = (ours.omega_rad_s()[k], theirs.omega_rad_s()[k]);
        worst[0] = worst[0].max((omega - other).abs() / other.max(1e-300));
        if k + 1 == ours.len() {
            // the next frequency is not known
            continue;
        }
        let to = |l: usize| (theirs.omega_rad_s()[l] - other).abs() / other;
        let distance = if k > 0 { to(k - 1).min(to(k + 1)) } else { to(k + 1) }.min(1.0);
        if distance < 1e-4 {
            // any combination of two modes of one frequency is a mode
            continue;
        }
        for (place, quantity) in [(1, Modes::shape as fn(&Modes, usize, f64) -> _), (2, Modes::rotation)] {
            let at = |modes: &Modes, x: f64| quantity(modes, k, x * length_m).unwrap();
            let points = [0.0, 0.013, 0.21, 0.37, 0.5, 0.77, 1.0];
            let least = length_m.powf(0.5 - place as f64);
            let scale = points.map(|x| at(theirs, x).abs()).into_iter().fold(least, f64::max);
            for x in points {
                worst[place] = worst[place].max(distance * (at(ours, x) - at(theirs, x)).abs() / scale);
            }
        }
    }
    worst
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn closed_forms_are_the_modes_of_the_search(
        left in 0..4usize, right in 0..4usize,
        length_m in 0.1..10.0f64, slenderness in -2.9..3.4f64, kind in 0..4usize,
    ) {
        let beam = Beam { segments: vec![segment(length_m, 1.0, 1.0)], ends: [ENDS[left], ENDS[right]] };
        // the flexibility in shear and the rotary inertia relative to those in bending
        let thick = 10f64.powf(-2.0 * slenderness);
        let section = ShearSection {
            shear_rigidity_n: 1.0 / (thick * length_m * length_m),
            rotary_inertia_kg_m: 0.3 * thick * length_m * length_m,
        };
        let buckling = (std::f64::consts::PI / length_m).powi(2);
        let system = match kind {
            0 => BeamSystem { shear: Some(vec![section]), ..beam.clone().into() },
            1 => BeamSystem { axial_force_n: 30.0 * buckling, ..beam.clone().into() },
            2 => BeamSystem { axial_force_n: -0.2 * buckling, ..beam.clone().into() },
            _ => BeamSystem { foundation_n_m2: 1e3 * buckling * buckling, ..beam.clone().into() },
        };
        let count = 60;
        match (system.modes(count), searched(&system).modes(count)) {
            (Ok(ours), Ok(theirs)) => {
                let [omega, shapes, rotations] = differences(&ours, &theirs);
                prop_assert!(omega < 1e-13 && shapes < 1e-13 && rotations < 1e-13, "{omega:e} {shapes:e} {rotations:e}");
            }
            // free ends buckle at a lower compression
            (ours, theirs) => prop_assert!(ours.is_err() && theirs.is_err() && kind == 2),
        }
    }
}

/// Sections that rotate alike have no displacement, and move nothing.
#[test]
fn pure_shear_moves_nothing() {
    let section = ShearSection { shear_rigidity_n: 40.0, rotary_inertia_kg_m: 1e-2 };
    let beam = Beam { segments: vec![segment(1.0, 1.0, 1.0)], ends: [End::Pinned; 2] };
    let system = BeamSystem { shear: Some(vec![section]), ..beam.into() };
    let modes = system.modes(20).unwrap();
    let pure = modes.omega_rad_s().iter().position(|omega| (omega / 4000f64.sqrt() - 1.0).abs() < 1e-15).unwrap();
    assert_eq!(modes.shape(pure, 0.3).unwrap(), 0.0);
    assert_eq!(modes.slope(pure, 0.3).unwrap(), 0.0);
    assert!((modes.rotation(pure, 0.3).unwrap() - 10.0).abs() < 1e-13);
    assert_eq!(modes.participation_kg0_5()[pure], 0.0);
    let moved: f64 = modes.participation_kg0_5().iter().map(|p| p * p).sum();
    assert!((0.9..1.0).contains(&moved), "{moved}");
}
