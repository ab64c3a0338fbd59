//! The effect of truncated modes that respond to the contact as a spring, from two impacts with far fewer modes.
//!
//! If `N` stated modes are several times as many as the restitution needs, the truncated modes are so fast that they respond
//! quasi-statically: without them the structure lacks their static compliance `c_N` and nothing else. An impact with the `n` modes
//! that the restitution needs and remainder modes for all others lacks the same compliance if that is taken from its fastest
//! remainder modes, so that
//!
//! ```text
//! e_N - e = (e_n without c_N) - e_n,
//! ```
//!
//! up to the relative error of the right-hand side as a derivative. The impacts take nearly the same steps, so that their errors
//! cancel in the difference. `|e_N - e_n|` is an independent estimate of the same effect, and
//!
//! ```text
//! u = 5/4 max( |(e_n without c_N) - e_n|, |e_N - e_n| ).
//! ```
//!
//! Where the two estimates do not agree, the first one includes the flights between contacts (`left_out.rs`). If the second is much
//! larger than the first, `n` modes are too few, and the impact is compared with more modes. So are impacts by a force that jumps at
//! first touch, to which no mode responds as a spring, and impacts on strings, whose frequencies grow as `N` only.

use vibroimpact_sim::modal::{Settings, Solution, Structure};

use super::left_out::jumps;
use super::other_modes::{moves_before, needed, solve, with_modes};
use super::quantity::Quantity;
use super::{Cost, Kept};
use crate::impact::Impact;
use crate::scene::{self, InvalidInput, Scene, compliance};

/// Tolerance of the expected number of modes.
const EXPECTED: f64 = 1e-5;
/// Factor of the expected number, and least share of the stated number.
const RICHER: usize = 2;
const LEAST: usize = 5;
/// Least ratio of the stated number to that of the impacts with few modes.
const FAR: usize = 2;
/// Tolerance of the solver, and differences that its errors explain.
const SOLVER: f64 = 1e-8;
const NOISE: f64 = 1e-7;
/// Factor of the larger estimate.
const CAUTION: f64 = 1.25;
/// Largest ratio of two estimates that agree, and that of the second to the first from which on the modes are too few.
const AGREE: f64 = 1.5;
const ASTRAY: f64 = 3.0;

/// The impact with few modes, and with the same ones without the compliance of the truncated modes.
pub(super) struct StaticTail {
    whole: Solution,
    without: Solution,
}

impl StaticTail {
    /// For an impact with stated modes, of which a loose tolerance needs this many; `None` if the truncated modes may respond
    /// otherwise than as a spring.
    pub fn of(
        scene: &Scene,
        impact: &Impact,
        least: usize,
        kept: &mut Kept,
        cost: &mut Cost,
    ) -> Result<Option<StaticTail>, InvalidInput> {
        let of_beam = matches!(scene.structure, scene::Structure::Beam(_));
        if !of_beam || moves_before(scene) || impact.remainder_modes > 0 || jumps(&impact.law) {
            return Ok(None);
        }
        let count = impact.kept_modes();
        let is_far = |modes: usize| FAR * RICHER * modes <= count;
        if !is_far(least) {
            return Ok(None);
        }
        let Some(expected) = needed(scene, EXPECTED, kept, cost)?.filter(|modes| is_far(*modes)) else {
            return Ok(None);
        };
        let modes = (RICHER * expected).max(count.div_ceil(LEAST));
        let settings = Settings { tolerance: SOLVER, estimate_uncertainty: false, ..impact.settings };
        let few = Impact { settings, ..with_modes(scene, count, modes, kept)? };
        let truncated_m_n = scene.structure.static_compliance_m_n(scene.place())? - compliance(&impact.structure.modes);
        let structure = without_tail(&few.structure, few.remainder_modes, truncated_m_n);
        let whole = solve(&few, kept, cost)?;
        let without = solve(&Impact { structure, ..few }, kept, cost)?;
        let stopped = [&whole, &without].iter().any(|solution| solution.outcome.stopped_by().is_some());
        Ok((!stopped).then_some(StaticTail { whole, without }))
    }

    /// Effect of the truncated modes on a quantity of the solution of the impact, and whether the few modes are enough for it. If they
    /// are too few, the effect includes that of the modes that they lack.
    pub fn left_out(&self, of: &Quantity, solution: &Solution) -> (f64, bool) {
        let change = of.change(&self.whole, &self.without);
        let distance = of.change(&self.whole, solution).itself;
        let agree = change.itself.max(distance) <= AGREE * change.itself.min(distance);
        let effect = if agree { change.itself } else { change.size() };
        (CAUTION * effect.max(distance), distance <= NOISE + ASTRAY * effect)
    }
}

/// The structure without this part of the static compliance of its remainder modes, which is taken from the fastest ones (m/N).
fn without_tail(structure: &Structure, remainder: usize, mut part_m_n: f64) -> Structure {
    let mut modes = structure.modes.clone();
    let from = modes.len() - remainder;
    for mode in modes[from..].iter_mut().rev().filter(|mode| mode.shape != 0.0) {
        let own_m_n = (mode.shape / mode.omega_rad_s).powi(2);
        let taken_m_n = part_m_n.clamp(0.0, own_m_n);
        mode.shape *= (1.0 - taken_m_n / own_m_n).sqrt();
        part_m_n -= taken_m_n;
    }
    Structure { modes }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::{Value, json};

    fn tail(changes: &[(&str, Value)]) -> (Impact, Option<StaticTail>) {
        let mut scene = json!({
            "structure": { "kind": "beam", "theory": "euler-bernoulli", "ends": ["pinned", "pinned"], "damping_ratio": 0.01, "segments": [
                { "length_m": 1, "width_m": 0.012, "thickness_m": 0.012, "material": "steel" }
            ] },
            "striker": { "material": "steel", "radius_m": 0.02, "speed_m_s": 1 },
            "contact": { "law": "hertz", "stiffness_n_m1_5": 1e9 }, "location_m": 0.3, "modes": 200
        });
        for (field, value) in changes {
            scene[*field] = value.clone();
        }
        let scene = Scene::from_value(&scene).unwrap();
        let impact = scene.impact().unwrap();
        let tail = StaticTail::of(&scene, &impact, 10, &mut Kept::default(), &mut Cost::default()).unwrap();
        (impact, tail)
    }

    #[test]
    fn only_modes_that_respond_as_a_spring_are_a_static_tail() {
        let start = json!({ "moving_modes": [{ "mode": 1, "velocity_m_s": 0.1, "location_m": 0.5 }] });
        for change in [
            ("modes", json!(20)),
            ("residual_compliance", json!(true)),
            ("start", start),
            ("contact", json!({ "law": "kelvin-voigt", "stiffness_n_m": 1e6, "restitution": 0.5 })),
        ] {
            assert!(tail(std::slice::from_ref(&change)).1.is_none(), "{change:?}");
        }
    }

    #[test]
    fn few_modes_that_are_too_few_are_not_used() {
        let (impact, tail) = tail(&[]);
        let (tail, solution) = (tail.unwrap(), impact.solve().unwrap());
        let of = Quantity::restitution(&impact);
        let (left_out, enough) = tail.left_out(&of, &solution);
        assert!(left_out > 0.0 && left_out < 1e-4 && enough);
        let elsewhere = solution.restitution.map(|restitution| restitution + 0.02);
        let (left_out, enough) = tail.left_out(&of, &Solution { restitution: elsewhere, ..solution });
        assert!(left_out > 0.02 && !enough);
    }

    #[test]
    fn the_fastest_remainder_modes_lose_their_compliance_first() {
        let mode = |omega_rad_s: f64, compliance_m_n: f64| vibroimpact_sim::modal::Mode {
            omega_rad_s,
            damping_ratio: 0.01,
            shape: omega_rad_s * compliance_m_n.sqrt(),
        };
        let structure = Structure { modes: vec![mode(1.0, 8.0), mode(10.0, 4.0), mode(100.0, 1.0)] };
        let left = |part_m_n: f64| {
            let modes = without_tail(&structure, 2, part_m_n).modes;
            [0, 1, 2].map(|k| compliance(&modes[k..=k]))
        };
        for (part_m_n, wanted) in
            [(0.5, [8.0, 4.0, 0.5]), (2.0, [8.0, 3.0, 0.0]), (9.0, [8.0, 0.0, 0.0]), (-1.0, [8.0, 4.0, 1.0])]
        {
            let found = left(part_m_n);
            assert!(found.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 1e-12), "{part_m_n}: {found:?}");
        }
    }
}
