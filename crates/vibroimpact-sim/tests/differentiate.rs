//! Derivatives of impacts against differences of solutions at a tolerance of 1e-13.

mod common;

use common::random::{config, decades, ordinary_law, ordinary_structure, ordinary_striker};
use common::{ball, hertz, pinned, pinned_with_remainder, settings};
use contact_models::{After, Boundary, Branch, ContactLaw, Force, Law, Memory};
use proptest::prelude::*;
use vibroimpact_sim::modal::{Differentiated, Mode, Outcome, Parameter, Posing, Solution, Solver, Start, Striker, Structure};

/// A law whose force is so many times that of another.
#[derive(Clone)]
struct Times(f64, Law);

impl ContactLaw for Times {
    fn touch(&self, memory: &Memory, approach_speed_m_s: f64) -> Branch {
        self.1.touch(memory, approach_speed_m_s)
    }

    fn force(&self, branch: &Branch, compression_m: f64, rate_m_s: f64) -> Force {
        let Force { force_n, per_compression_n_m, per_rate_n_s_m } = self.1.force(branch, compression_m, rate_m_s);
        Force {
            force_n: self.0 * force_n,
            per_compression_n_m: self.0 * per_compression_n_m,
            per_rate_n_s_m: self.0 * per_rate_n_s_m,
        }
    }

    fn stored_energy_j(&self, branch: &Branch, compression_m: f64) -> f64 {
        self.0 * self.1.stored_energy_j(branch, compression_m)
    }

    fn boundaries(&self, branch: &Branch) -> [Boundary; 2] {
        self.1.boundaries(branch)
    }

    fn cross(&self, branch: &Branch, which: usize, compression_m: f64, rate_m_s: f64) -> After {
        self.1.cross(branch, which, compression_m, rate_m_s)
    }

    fn depends_on_rate(&self) -> bool {
        self.1.depends_on_rate()
    }
}

/// An impact with all that poses it.
#[derive(Clone)]
struct Posed {
    structure: Structure,
    striker: Striker,
    law: Times,
    start: Start,
}

/// What can be changed of it, by a part of its size.
const PARAMETERS: [&str; 7] = ["mass", "speed", "frequencies", "damping", "shapes", "stiffness", "gap"];

impl Posed {
    fn new(structure: &Structure, striker: Striker, law: Law) -> Posed {
        let start = Start::at_rest(structure.modes.len());
        Posed { structure: structure.clone(), striker, law: Times(1.0, law), start }
    }

    fn with(&self, which: usize, by: f64) -> Posed {
        let mut posed = self.clone();
        let each = |change: &dyn Fn(usize, &mut Mode)| {
            let mut structure = self.structure.clone();
            structure.modes.iter_mut().enumerate().for_each(|(k, mode)| change(k, mode));
            structure
        };
        match which {
            0 => posed.striker.mass_kg *= 1.0 + by,
            1 => posed.striker.speed_m_s *= 1.0 + by,
            2 => posed.structure = each(&|_, mode| mode.omega_rad_s *= 1.0 + by),
            3 => posed.structure = each(&|_, mode| mode.damping_ratio += 0.05 * by),
            4 => posed.structure = each(&|k, mode| mode.shape += by * (0.3 * (k + 1) as f64).cos()),
            5 => posed.law.0 *= 1.0 + by,
            _ => posed.start.gap_m += 1e-4 * by,
        }
        posed
    }

    fn posing(&self) -> Posing<'_> {
        Posing { structure: &self.structure, striker: &self.striker, law: &self.law, start: &self.start }
    }

    fn solve(&self, tolerance: f64) -> Solution {
        let mut solver = Solver::new(&self.structure).unwrap();
        let settings = vibroimpact_sim::modal::Settings { estimate_uncertainty: false, ..settings(tolerance) };
        solver.solve(&self.striker, &self.law, Some(&self.start), &settings).unwrap()
    }

    fn differentiate(&self, which: &[usize], tolerance: f64) -> Differentiated {
        let step = 1e-5;
        let near: Vec<[Posed; 4]> =
            which.iter().map(|which| [-2.0, -1.0, 1.0, 2.0].map(|place| self.with(*which, place * step))).collect();
        let parameters: Vec<Parameter> = near
            .iter()
            .zip(which)
            .map(|(near, which)| Parameter { step, neighbours: near.each_ref().map(Posed::posing), changes_law: *which == 5 })
            .collect();
        let mut solver = Solver::new(&self.structure).unwrap();
        solver.differentiate(&self.striker, &self.law, Some(&self.start), &settings(tolerance), &parameters).unwrap()
    }

    /// Central differences of fourth order of an output, and how well they are known.
    fn differences(&self, which: usize, of: impl Fn(&Solution) -> f64) -> (f64, f64) {
        let by = |step: f64| {
            let [a, b, c, d] = [-2.0, -1.0, 1.0, 2.0].map(|place| of(&self.with(which, place * step).solve(1e-13)));
            (8.0 * (c - b) - (d - a)) / (12.0 * step)
        };
        let (fine, coarse) = (by(2e-5), by(8e-5));
        (fine, (fine - coarse).abs())
    }
}

#[test]
fn explore() {
    for (name, structure) in
        [("1", pinned(1, 0.02, 0.3)), ("10", pinned(10, 0.02, 0.3)), ("40", pinned(40, 0.02, 0.618)), ("r", pinned_with_remainder(20, 0.01, 0.41))]
    {
        let posed = Posed::new(&structure, ball(), hertz());
        let found = posed.differentiate(&[0, 1, 2, 3, 4, 5], 1e-9);
        println!("{name} {:?} {} graze {:.2e}", found.solution.restitution, found.solution.sub_impacts.len(), found.nearest_graze);
        let Some(derivatives) = found.derivatives else { println!("none"); continue };
        for which in 0..6 {
            let d = &derivatives[which];
            let (reference, known) = posed.differences(which, |s| s.restitution.unwrap());
            println!("  {:12} {:+.12e} ± {:.1e} ref {:+.12e} ± {:.1e} rel {:.1e}", PARAMETERS[which], d.restitution.value, d.restitution.uncertainty.unwrap_or(f64::NAN), reference, known, (d.restitution.value - reference).abs()/reference.abs());
            let i = d.sub_impacts.len() - 1;
            for (what, value, of) in [
                ("end", d.sub_impacts[i].end_s.value, (|s: &Solution, i| s.sub_impacts[i].end_s) as fn(&Solution, usize) -> f64),
                ("start", d.sub_impacts[i].start_s.value, |s, i| s.sub_impacts[i].start_s),
                ("impulse", d.sub_impacts[i].impulse_n_s.value, |s, i| s.sub_impacts[i].impulse_n_s),
                ("peak", d.sub_impacts[i].peak_force_n.value, |s, i| s.sub_impacts[i].peak_force_n),
                ("peakx", d.sub_impacts[i].peak_compression_m.value, |s, i| s.sub_impacts[i].peak_compression_m),
            ] {
                let (reference, known) = posed.differences(which, |s| of(s, i));
                println!("       {what:8} {value:+.9e} {reference:+.9e} {:.1e} {:.1e}", known/reference.abs(), (value - reference).abs()/reference.abs());
            }
        }
    }
}
