//! Random impacts, with derivatives by the solver and by differences in 32 digits.

use super::double::Double;
use super::taylor;
use crate::common::random::{config, decades, ordinary_law, ordinary_striker, ordinary_structure};
use crate::common::settings;
use contact_models::{After, Boundary, Branch, ContactLaw, Force, Law, Memory};
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::TestRunner;
use vibroimpact_sim::modal::{Differentiated, Mode, Parameter, Posing, Solver, Start, Striker, Structure};

/// A law whose force is a multiple of that of another.
#[derive(Clone)]
pub struct Times(pub f64, pub Law);

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

    fn boundary(&self, branch: &Branch, which: usize) -> Option<Boundary> {
        self.1.boundary(branch, which)
    }

    fn cross(&self, branch: &Branch, which: usize, compression_m: f64, rate_m_s: f64) -> After {
        self.1.cross(branch, which, compression_m, rate_m_s)
    }
}

/// An impact with its complete definition.
#[derive(Clone)]
pub struct Posed {
    pub structure: Structure,
    pub striker: Striker,
    pub law: Times,
    pub start: Start,
}

/// The numbers of it that can be changed, by a fraction of their size.
pub const PARAMETERS: [&str; 7] = ["mass", "speed", "frequencies", "damping", "shapes", "stiffness", "gap"];

impl Posed {
    pub fn new(structure: &Structure, striker: Striker, law: Law) -> Posed {
        let mut start = Start::at_rest(structure.modes.len());
        start.gap_m = 1e-4;
        start.rate[0] = 0.01;
        Posed { structure: structure.clone(), striker, law: Times(1.0, law), start }
    }

    pub fn with(&self, which: usize, by: f64) -> Posed {
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

    /// The same in 32 digits.
    pub fn in_digits(&self, which: usize, by: f64) -> taylor::Impact {
        let one = Double::from(1.0);
        let by = Double::from(by);
        let times = |at: usize| if which == at { one + by } else { one };
        let modes = &self.structure.modes;
        let all = |striker: Double, of: &dyn Fn(usize, &Mode) -> Double| {
            let modes = modes.iter().enumerate().map(|(k, mode)| of(k, mode));
            std::iter::once(striker).chain(modes).collect::<Vec<_>>()
        };
        let mass = Double::from(self.striker.mass_kg) * times(0);
        let speed = Double::from(self.striker.speed_m_s) * times(1);
        let damping = if which == 3 { Double::from(0.05) * by } else { Double::default() };
        let shape =
            |k: usize| if which == 4 { by * Double::from((0.3 * (k + 1) as f64).cos()) } else { Double::default() };
        let gap = if which == 6 { Double::from(1e-4) * by } else { Double::default() };
        taylor::Impact {
            omega: all(Double::default(), &|_, mode| Double::from(mode.omega_rad_s) * times(2)),
            damping_ratio: all(Double::default(), &|_, mode| Double::from(mode.damping_ratio) + damping),
            psi: all(-(one / mass.sqrt()), &|k, mode| Double::from(mode.shape) + shape(k)),
            amplitude: all(Double::default(), &|k, _| Double::from(self.start.amplitude[k])),
            rate: all(-(mass.sqrt() * speed), &|k, _| Double::from(self.start.rate[k])),
            gap: Double::from(self.start.gap_m) + gap,
            law: self.law.1,
            times: Double::from(self.law.0) * times(5),
        }
    }

    pub fn posing(&self) -> Posing<'_> {
        Posing {
            structure: &self.structure,
            striker: &self.striker,
            law: &self.law,
            start: &self.start,
            gravity_m_s2: 0.0,
        }
    }

    pub fn differentiate(&self, tolerance: f64) -> Differentiated {
        let offsets = [-2e-5, -1e-5, 1e-5, 2e-5];
        let near: Vec<[Posed; 4]> =
            (0..PARAMETERS.len()).map(|which| offsets.map(|offset| self.with(which, offset))).collect();
        let mut parameters = Vec::new();
        for (which, near) in near.iter().enumerate() {
            let neighbours = near.each_ref().map(Posed::posing);
            parameters.push(Parameter { offsets, neighbours, changes_law: which == 5 });
        }
        let solver = Solver::new(&self.structure).unwrap();
        solver.differentiate(&self.striker, &self.law, Some(&self.start), &settings(tolerance), &parameters).unwrap()
    }

    /// Derivatives with respect to all parameters by central differences in 32 digits, each with its accuracy: the difference
    /// between those of the two sides. `None` if the impact has fewer contacts nearby than
    /// this number, which end before `end_s`.
    pub fn in_32_digits(&self, count: usize, end_s: f64) -> Vec<Option<Slopes>> {
        const STEP: f64 = 1e-12;
        let follow = |which: usize, by: f64| self.in_digits(which, by).follow(count, 1.01 * end_s);
        let here = follow(0, 0.0);
        let by = |which: usize| {
            let (before, here, after) = (follow(which, -STEP)?, here.as_ref()?, follow(which, STEP)?);
            let slope = |before: Double, here: Double, after: Double| {
                let [left, right] = [here - before, after - here].map(|change| (change / Double::from(STEP)).near);
                [0.5 * (left + right), (right - left).abs()]
            };
            let intervals = before.intervals.iter().zip(here.intervals.iter().zip(&after.intervals));
            let of = |(before, (here, after)): (&[Double; 3], (&[Double; 3], &[Double; 3]))| {
                [0, 1, 2].map(|i| slope(before[i], here[i], after[i]))
            };
            Some(Slopes {
                velocity: slope(before.velocity, here.velocity, after.velocity),
                intervals: intervals.map(of).collect(),
            })
        };
        (0..PARAMETERS.len()).map(by).collect()
    }
}

/// Derivatives, each with its accuracy.
pub struct Slopes {
    /// Of the final velocity.
    pub velocity: [f64; 2],
    /// Of start, end and impulse of each contact.
    pub intervals: Vec<[[f64; 2]; 3]>,
}

/// Random impacts, which are the same in every run.
pub fn random_impacts() -> impl Iterator<Item = Posed> {
    let strategy = (ordinary_structure(decades(-3.0, -0.5)), ordinary_striker(), ordinary_law());
    let mut runner = TestRunner::new(config(1));
    std::iter::repeat_with(move || {
        let (structure, striker, law) = strategy.new_tree(&mut runner).unwrap().current();
        Posed::new(&structure, striker, law)
    })
}
