//! Derivatives of impacts compared with differences of solutions in 32 digits, and of solutions at a tolerance of 1e-13.

mod double;
mod taylor;

use crate::common::random::{cases, config, decades, ordinary_law, ordinary_striker, ordinary_structure};
use crate::common::{ball, hertz, pinned, pinned_with_remainder, settings};
use contact_models::{After, Boundary, Branch, ContactLaw, Force, KelvinVoigt, Law, Memory};
use double::Double;
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::TestRunner;
use vibroimpact_sim::modal::{
    Derivative, Derivatives, Differentiated, Mode, NoDerivative, Outcome, Parameter, Posing, Settings, Solution,
    Solver, Start, Striker, Structure, SubImpact,
};

/// A law whose force is a multiple of that of another.
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

    fn boundary(&self, branch: &Branch, which: usize) -> Option<Boundary> {
        self.1.boundary(branch, which)
    }

    fn cross(&self, branch: &Branch, which: usize, compression_m: f64, rate_m_s: f64) -> After {
        self.1.cross(branch, which, compression_m, rate_m_s)
    }
}

/// An impact with its complete definition.
#[derive(Clone)]
struct Posed {
    structure: Structure,
    striker: Striker,
    law: Times,
    start: Start,
}

/// The derivatives with respect to all parameters.
fn all(derivatives: Vec<Result<Derivatives, NoDerivative>>) -> Vec<Derivatives> {
    derivatives.into_iter().collect::<Result<_, _>>().unwrap()
}

/// The numbers of it that can be changed, by a fraction of their size.
const PARAMETERS: [&str; 7] = ["mass", "speed", "frequencies", "damping", "shapes", "stiffness", "gap"];

impl Posed {
    fn new(structure: &Structure, striker: Striker, law: Law) -> Posed {
        let mut start = Start::at_rest(structure.modes.len());
        start.gap_m = 1e-4;
        start.rate[0] = 0.01;
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

    /// The same in 32 digits.
    fn in_digits(&self, which: usize, by: f64) -> taylor::Impact {
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

    fn posing(&self) -> Posing<'_> {
        Posing { structure: &self.structure, striker: &self.striker, law: &self.law, start: &self.start }
    }

    fn solve(&self, tolerance: f64) -> Solution {
        let solver = Solver::new(&self.structure).unwrap();
        let settings = Settings { estimate_uncertainty: false, ..settings(tolerance) };
        solver.solve(&self.striker, &self.law, Some(&self.start), &settings).unwrap()
    }

    fn differentiate(&self, tolerance: f64) -> Differentiated {
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

    /// Central differences of fourth order of an output, and their accuracy.
    fn differences(&self, which: usize, of: impl Fn(&Solution) -> f64) -> (f64, f64) {
        let by = |step: f64| {
            let [a, b, c, d] = [-2.0, -1.0, 1.0, 2.0].map(|place| of(&self.with(which, place * step).solve(1e-13)));
            (8.0 * (c - b) - (d - a)) / (12.0 * step)
        };
        let (fine, coarse) = (by(2e-5), by(8e-5));
        (fine, (fine - coarse).abs())
    }
}

/// Number of derivatives that were compared, and number of those that pass.
#[derive(Debug, Default)]
struct Tally {
    compared: usize,
    covered: usize,
    /// Not accurate to a millionth, with a stated uncertainty that does not cover the error: nothing warns the user.
    silent: usize,
    /// For impacts with at most [`FEW`] contacts: compared, and accurate to a millionth. Every further contact magnifies the
    /// error of the motion, and after dozens of them no solution at this tolerance gives a derivative with this accuracy.
    few: [usize; 2],
}

/// Largest number of contacts of an impact whose derivatives have to be accurate to a millionth.
const FEW: usize = 15;

/// Names of the tallies.
const OUTPUTS: [&str; 3] = ["velocity", "times", "impulses"];

impl Tally {
    /// Compares a derivative of an impact with this number of contacts with one of this accuracy; errors below a millionth of
    /// `least` do not count.
    fn compare(&mut self, derivative: Derivative, [reference, known]: [f64; 2], least: f64, contacts: usize) {
        let error = (derivative.value - reference).abs();
        let near = error <= 1e-6 * reference.abs().max(least) + known;
        let covered = derivative.uncertainty.is_some_and(|uncertainty| error <= uncertainty + known);
        self.compared += 1;
        self.covered += usize::from(covered);
        self.silent += usize::from(!near && !covered && derivative.uncertainty.is_some());
        if contacts <= FEW {
            self.few[0] += 1;
            self.few[1] += usize::from(near);
        }
    }

    fn check(&self, name: &str) {
        let Tally { compared, covered, silent, few: [few, near] } = *self;
        println!(
            "{name}: {compared} compared, {covered} within what is stated, {silent} neither so nor within a millionth; \
             {near} of {few} within a millionth in impacts of at most {FEW} contacts"
        );
        assert!(compared >= 20 && few > 0);
        assert!(covered as f64 >= 0.99 * compared as f64, "{name}: {covered} of {compared} covered");
        assert!(silent as f64 <= 1e-3 * compared as f64, "{name}: {silent} of {compared} wrong and not said so");
        // One of a few hundred.
        assert!(near as f64 >= 0.995 * few as f64 - 1.0, "{name}: {near} of {few} within a millionth");
    }
}

/// Random impacts, which are the same in every run.
fn random_impacts(count: u32) -> impl Iterator<Item = Posed> {
    let strategy = (ordinary_structure(decades(-3.0, -0.5)), ordinary_striker(), ordinary_law());
    let mut runner = TestRunner::new(config(1));
    (0..cases(count)).map(move |_| {
        let (structure, striker, law) = strategy.new_tree(&mut runner).unwrap().current();
        Posed::new(&structure, striker, law)
    })
}

/// The unit of a change is a fraction of the changed number, so that outputs of equal size have derivatives of equal size.
#[test]
fn derivatives_of_random_impacts_agree_with_differences_in_32_digits() {
    const STEP: f64 = 1e-9;
    let mut tallies: [Tally; 3] = Default::default();
    let (mut impacts, mut lost, mut unknown) = (0, 0, 0);
    for posed in random_impacts(4) {
        let found = posed.differentiate(1e-9);
        if found.solution.outcome != Outcome::Rebound {
            continue;
        }
        let (derivatives, end_s) = (all(found.derivatives), found.solution.end_s);
        let finer = all(posed.differentiate(1e-13).derivatives);
        impacts += 1;
        let count = found.solution.sub_impacts.len();
        let Striker { mass_kg, speed_m_s: speed } = posed.striker;
        for (which, derivatives) in derivatives.iter().enumerate() {
            let follow = |step: f64| posed.in_digits(which, step).follow(count, 1.01 * end_s);
            let by = |step: f64| {
                let (after, before) = (follow(step)?, follow(-step)?);
                let slope = |after: Double, before: Double| ((after - before) / Double::from(2.0 * step)).near;
                let intervals = after.intervals.iter().zip(&before.intervals);
                let intervals = intervals.map(|(after, before)| [0, 1, 2].map(|i| slope(after[i], before[i])));
                Some((slope(after.velocity, before.velocity), intervals.collect::<Vec<_>>()))
            };
            // The number of contacts is different nearby.
            let (Some(fine), Some(coarse)) = (by(STEP), by(4.0 * STEP)) else {
                lost += 1;
                continue;
            };
            let pair = |fine: f64, coarse: f64| [fine, (fine - coarse).abs()];
            let velocity = pair(fine.0, coarse.0);
            if velocity[1] > 1e-6 * velocity[0].abs().max(1e-3 * speed) {
                unknown += 1;
                continue;
            }
            tallies[0].compare(derivatives.striker_velocity_m_s, velocity, 1e-3 * speed, count);
            let (finer, size) = (finer[which].striker_velocity_m_s, velocity[0].abs().max(1e-3 * speed));
            if finer.uncertainty.is_some_and(|uncertainty| uncertainty <= 1e-6 * size) {
                // A tenth of the limit of the test below.
                let error = (finer.value - velocity[0]).abs();
                assert!(
                    error <= 1e-7 * size + velocity[1],
                    "along the finer motion {finer:?}, in 32 digits {velocity:?}"
                );
            }
            for (own, (fine, coarse)) in derivatives.sub_impacts.iter().zip(fine.1.iter().zip(&coarse.1)) {
                let of = |i: usize| pair(fine[i], coarse[i]);
                tallies[1].compare(own.start_s, of(0), 1e-3 * end_s, count);
                tallies[1].compare(own.end_s, of(1), 1e-3 * end_s, count);
                tallies[2].compare(own.impulse_n_s, of(2), 1e-3 * mass_kg * speed, count);
            }
        }
    }
    println!(
        "{impacts} impacts, {lost} with another number of contacts in 32 digits, {unknown} that these do not know"
    );
    OUTPUTS.iter().zip(&tallies).for_each(|(name, tally)| tally.check(name));
}

/// Derivatives along a motion solved with a tolerance ten thousand times smaller agree with those in 32 digits (above) and take
/// milliseconds, so that many more impacts are compared.
#[test]
fn derivatives_of_random_impacts_agree_with_those_along_a_finer_motion() {
    let mut tallies: [Tally; 3] = Default::default();
    for posed in random_impacts(100) {
        let [own, fine] = [1e-9, 1e-13].map(|tolerance| posed.differentiate(tolerance));
        if own.solution.outcome != Outcome::Rebound {
            continue;
        }
        let (end_s, count) = (own.solution.end_s, own.solution.sub_impacts.len());
        let Striker { mass_kg, speed_m_s: speed } = posed.striker;
        assert_eq!(fine.solution.sub_impacts.len(), count);
        for (own, fine) in all(own.derivatives).iter().zip(&all(fine.derivatives)) {
            // Derivatives whose own accuracy is worse than a millionth are not compared.
            let velocity = fine.striker_velocity_m_s;
            let least = 1e-3 * speed;
            if velocity.uncertainty.is_none_or(|uncertainty| uncertainty > 1e-6 * velocity.value.abs().max(least)) {
                continue;
            }
            let of = |derivative: Derivative| [derivative.value, 1e-10 * derivative.value.abs()];
            tallies[0].compare(own.striker_velocity_m_s, of(velocity), least, count);
            for (own, fine) in own.sub_impacts.iter().zip(&fine.sub_impacts) {
                tallies[1].compare(own.start_s, of(fine.start_s), 1e-3 * end_s, count);
                tallies[1].compare(own.end_s, of(fine.end_s), 1e-3 * end_s, count);
                tallies[2].compare(own.impulse_n_s, of(fine.impulse_n_s), 1e-3 * mass_kg * speed, count);
            }
        }
    }
    OUTPUTS.iter().zip(&tallies).for_each(|(name, tally)| tally.check(name));
}

#[test]
fn all_outputs_of_several_contacts_have_derivatives() {
    for structure in [pinned(10, 0.02, 0.3), pinned_with_remainder(20, 0.01, 0.41)] {
        let posed = Posed::new(&structure, ball(), hertz());
        let found = posed.differentiate(1e-10);
        let derivatives = all(found.derivatives);
        for which in [0, 3, 5] {
            let derivatives = &derivatives[which];
            assert!(derivatives.sub_impacts.len() > 1);
            for (i, by) in derivatives.sub_impacts.iter().enumerate() {
                type Output = fn(&SubImpact) -> f64;
                let outputs: [(&str, Derivative, Output); 5] = [
                    ("start", by.start_s, |sub| sub.start_s),
                    ("end", by.end_s, |sub| sub.end_s),
                    ("impulse", by.impulse_n_s, |sub| sub.impulse_n_s),
                    ("peak force", by.peak_force_n, |sub| sub.peak_force_n),
                    ("peak compression", by.peak_compression_m, |sub| sub.peak_compression_m),
                ];
                for (name, Derivative { value, .. }, output) in outputs {
                    let (reference, known) = posed.differences(which, |solution| output(&solution.sub_impacts[i]));
                    // The solver's peaks are accurate to nine digits, and differences magnify the error.
                    let part = if name.starts_with("peak") { 1e-4 } else { 1e-6 };
                    let allowed = part * reference.abs() + 3.0 * known;
                    assert!((value - reference).abs() <= allowed, "{name} {i}: {value} {reference} {known}");
                }
            }
            let last = |of: fn(&Solution) -> f64| posed.differences(which, of).0;
            let end = last(|solution| solution.end_s);
            assert!((derivatives.end_s.value - end).abs() <= 1e-5 * end.abs());
            let velocity = last(|solution| solution.striker_velocity_m_s);
            assert!((derivatives.striker_velocity_m_s.value - velocity).abs() <= 1e-5 * velocity.abs());
            let scale = derivatives.amplitude.iter().fold(0.0f64, |most, value| most.max(value.abs()));
            let first = last(|solution| solution.amplitude[1]);
            assert!((derivatives.amplitude[1] - first).abs() <= 1e-5 * scale);
        }
    }
}

/// At a rigid wall only the law remains: the derivative with respect to the law is known in closed form.
#[test]
fn a_rebound_from_a_wall_changes_with_the_law_alone() {
    let striker = ball();
    let wall = Structure { modes: Vec::new() };
    let dashpot = |damping: f64| KelvinVoigt::new(1e6, damping).unwrap();
    let start = Start::at_rest(0);
    let offsets = [-2e-3, -1e-3, 1e-3, 2e-3];
    let near = offsets.map(|more| dashpot(20.0 + more));
    let posing = |law| Posing { structure: &wall, striker: &striker, law, start: &start };
    let parameter = Parameter { offsets, neighbours: near.each_ref().map(|law| posing(law)), changes_law: true };
    let found =
        Solver::new(&wall).unwrap().differentiate(&striker, &dashpot(20.0), None, &settings(1e-11), &[parameter]);
    let derivative = all(found.unwrap().derivatives)[0].restitution;
    // A spring and dashpot without adhesion separate where the force decreases to zero.
    let restitution = |damping: f64| {
        let zeta = damping / (2.0 * (1e6 * striker.mass_kg).sqrt());
        let root = (1.0 - zeta * zeta).sqrt();
        let turned = std::f64::consts::PI - (2.0 * zeta * root).atan2(1.0 - 2.0 * zeta * zeta);
        (-zeta / root * turned).exp()
    };
    let exact = (restitution(20.0 + 1e-3) - restitution(20.0 - 1e-3)) / 2e-3;
    assert!((derivative.value - exact).abs() < 1e-8 * exact.abs(), "{} {exact}", derivative.value);
}

#[test]
fn bad_parameters_are_named() {
    let posed = Posed::new(&pinned(3, 0.02, 0.3), ball(), hertz());
    let other = Posed::new(&pinned(2, 0.02, 0.3), ball(), hertz());
    let field = |offsets: [f64; 4], of: &Posed| {
        let parameter = Parameter { offsets, neighbours: [of.posing(); 4], changes_law: false };
        let solver = Solver::new(&posed.structure).unwrap();
        solver.differentiate(&ball(), &hertz(), None, &settings(1e-9), &[parameter]).unwrap_err().field
    };
    assert_eq!(field([1.0, 1.0, 2.0, 3.0], &posed), "parameters[0].offsets");
    assert_eq!(field([1.0, f64::NAN, 2.0, 3.0], &posed), "parameters[0].offsets");
    assert_eq!(field([1.0, 2.0, 3.0, 4.0], &other), "parameters[0].neighbours[0].structure.modes");
}

/// At the point where the two roots of a mode coincide, next to it, and where its closed form is replaced by that of other
/// modes.
#[test]
fn modes_about_critical_damping_have_derivatives() {
    const STEP: f64 = 1e-9;
    for modes in [1, 4] {
        for damping_ratio in [0.7, 0.94, 0.95, 0.999, 1.0 - 1e-12, 1.0, 1.0 + 1e-7, 1.04, 1.06, 1.3] {
            let mut structure = pinned(modes, 0.02, 0.3);
            structure.modes[modes / 2].damping_ratio = damping_ratio;
            let mut posed = Posed::new(&structure, ball(), hertz());
            posed.start.rate[modes / 2] = 0.2;
            let found = posed.differentiate(1e-12);
            let (end_s, count) = (found.solution.end_s, found.solution.sub_impacts.len());
            for (which, derivatives) in all(found.derivatives).iter().enumerate() {
                let follow = |step: f64| posed.in_digits(which, step).follow(count, 1.01 * end_s).unwrap();
                let (after, before) = (follow(STEP), follow(-STEP));
                let slope = |after: Double, before: Double| ((after - before) / Double::from(2.0 * STEP)).near;
                let meets = |derivative: Derivative, reference: f64, least: f64| {
                    let error = (derivative.value - reference).abs();
                    let name = PARAMETERS[which];
                    assert!(
                        error <= 1e-7 * reference.abs().max(least),
                        "{damping_ratio} {name} {derivative:?} {reference}"
                    );
                };
                meets(derivatives.striker_velocity_m_s, slope(after.velocity, before.velocity), 1e-3);
                let intervals = after.intervals.iter().zip(&before.intervals);
                for (own, (after, before)) in derivatives.sub_impacts.iter().zip(intervals) {
                    meets(own.end_s, slope(after[1], before[1]), 1e-3 * end_s);
                    meets(own.impulse_n_s, slope(after[2], before[2]), 1e-3 * posed.striker.mass_kg);
                }
            }
        }
    }
}

/// The one of the random impacts for which differences of the law about its anchor crossed the corner of the force there, which
/// no tolerance showed: elastic-plastic, with thirteen contacts.
#[test]
fn a_corner_of_the_law_does_not_disturb_derivatives() {
    const STEP: f64 = 1e-9;
    let posed = random_impacts(298).nth(297).unwrap();
    let found = posed.differentiate(1e-9);
    let end_s = found.solution.end_s;
    let derivatives = all(found.derivatives);
    for which in [2, 5] {
        let intervals = &derivatives[which].sub_impacts;
        let follow = |step: f64| posed.in_digits(which, step).follow(intervals.len(), 1.01 * end_s).unwrap();
        let (after, before) = (follow(STEP), follow(-STEP));
        for (own, (after, before)) in intervals.iter().zip(after.intervals.iter().zip(&before.intervals)) {
            let reference = ((after[2] - before[2]) / Double::from(2.0 * STEP)).near;
            let error = (own.impulse_n_s.value - reference).abs();
            assert!(error <= 1e-6 * reference.abs(), "{} {:?} {reference}", PARAMETERS[which], own.impulse_n_s);
        }
    }
}

/// Where the number of contacts changes, one of them grazes. Just before and just after that the nearest graze is near, whether the
/// contact exists or is missed.
#[test]
fn the_nearest_graze_is_small_on_both_sides_of_a_graze() {
    let at = |mass_kg: f64| {
        let posed = Posed::new(&pinned(10, 0.02, 0.3), Striker { mass_kg, ..ball() }, hertz());
        posed.differentiate(1e-11)
    };
    let count = |mass_kg: f64| at(mass_kg).solution.sub_impacts.len();
    let masses: Vec<f64> = (0..12).map(|i| 0.05 + 0.02 * f64::from(i)).collect();
    let counts: Vec<usize> = masses.iter().map(|mass| count(*mass)).collect();
    let mut grazes = 0;
    for i in (1..masses.len()).filter(|i| counts[*i] != counts[*i - 1]) {
        let (mut before, mut after) = (masses[i - 1], masses[i]);
        for _ in 0..25 {
            let middle = 0.5 * (before + after);
            *(if count(middle) == counts[i - 1] { &mut before } else { &mut after }) = middle;
        }
        let sides = [before, after].map(at);
        for found in &sides {
            assert!(found.nearest_graze < 1e-2, "{before}: {} {:?}", found.nearest_graze, found.nearest_miss);
        }
        assert!(sides.iter().any(|found| found.nearest_miss.is_some()), "{before}");
        grazes += 1;
    }
    assert!(grazes >= 5, "{grazes}");
}
