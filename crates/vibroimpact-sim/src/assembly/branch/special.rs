//! A branch with its special points, and which of them lie between two neighbours.

use crate::assembly::orbit::Orbit;
#[cfg(doc)]
use crate::assembly::orbit::OrbitOutcome;

/// Kind of a special point of a branch.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Special {
    /// The branch turns back in the parameter.
    Fold,
    /// A multiplier passes +1 although the parameter does not turn. A symmetric motion loses its symmetry there, and two motions begin
    /// that are mirror images of each other. In rare cases another branch crosses instead, also among motions without symmetry.
    Pitchfork,
    /// A multiplier passes -1.
    PeriodDoubling,
    /// A pair of complex multipliers passes the unit circle.
    NeimarkSacker,
    /// An interval of contact appears or disappears.
    Grazing,
}

invalid_input::names!(Special, "special", {
    Fold: "fold",
    Pitchfork: "pitchfork",
    PeriodDoubling: "period doubling",
    NeimarkSacker: "Neimark-Sacker",
    Grazing: "grazing",
});

impl Special {
    /// Whether another branch begins at such a point.
    pub fn begins_a_branch(self) -> bool {
        matches!(self, Special::PeriodDoubling | Special::Pitchfork)
    }
}

/// An orbit of a branch.
#[derive(Debug, Clone, PartialEq)]
pub struct BranchPoint {
    /// The parameter.
    pub parameter: f64,
    /// The periodic motion there.
    pub orbit: Orbit,
}

/// A special point of a branch.
#[derive(Debug, Clone, PartialEq)]
pub struct SpecialPoint {
    /// Its kind.
    pub kind: Special,
    /// The parameter.
    pub parameter: f64,
    /// Uncertainty of the parameter: half the distance of the two orbits on either side; at a fold, the distance of a third one that
    /// is farther away; at a pitchfork, the last step of Newton's method.
    pub uncertainty: f64,
    /// Index of the first orbit of the branch after the point.
    pub before_orbit: usize,
    /// An orbit within the uncertainty.
    pub orbit: Orbit,
}

/// A branch of periodic motions.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Branch {
    /// The orbits in the order in which they were found.
    pub points: Vec<BranchPoint>,
    /// Points at which the stability or the pattern of contacts changes.
    pub special: Vec<SpecialPoint>,
    /// Whether the branch was followed to an end of the range, or back to that at which it begins. If not, no orbit was found beyond
    /// the last one.
    pub complete: bool,
    /// The index of the special point of that one at which it comes back. The same branch, or its mirror image, begins there.
    pub returns_to: Option<usize>,
    /// Whether it was interrupted.
    pub interrupted: bool,
    /// The contact that keeps something from earlier periods, if there is no first orbit for this reason
    /// ([`OrbitOutcome::Remembers`]).
    pub remembers: Option<usize>,
}

/// The special points between two neighbours on a branch. A multiplier that passes +1 counts as a pitchfork, which may be a fold.
pub(super) fn differences(one: &Orbit, other: &Orbit) -> Vec<Special> {
    let mut found = Vec::new();
    let change = |beyond: fn(&[f64; 2]) -> bool| {
        let count = |orbit: &Orbit| orbit.floquet_multipliers.iter().filter(|m| beyond(m)).count();
        count(one).abs_diff(count(other))
    };
    // two real multipliers beyond the same end of the circle may become a pair there, which passes nothing
    let flips = change(|m| m[1] == 0.0 && m[0] < -1.0) % 2;
    let turns = change(|m| m[1] == 0.0 && m[0] > 1.0) % 2;
    if turns == 1 {
        found.push(Special::Pitchfork);
    }
    if flips == 1 {
        found.push(Special::PeriodDoubling);
    }
    if change(|m| m[0].hypot(m[1]) > 1.0) >= flips + turns + 2 {
        found.push(Special::NeimarkSacker);
    }
    if one.intervals_per_period != other.intervals_per_period {
        found.push(Special::Grazing);
    }
    found
}

/// The multiplier nearest to +1.
pub(super) fn nearest_to_one(orbit: &Orbit) -> f64 {
    let distance = |m: &&[f64; 2]| (m[0] - 1.0).hypot(m[1]);
    let nearest = orbit.floquet_multipliers.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
    nearest.map_or(0.0, |m| m[0])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn between(one: &[[f64; 2]], other: &[[f64; 2]]) -> Vec<Special> {
        let orbit = |multipliers: &[[f64; 2]]| Orbit {
            period_s: 1.0,
            forcing_periods: 1,
            phase_s: 0.0,
            state: Vec::new(),
            closure: 0.0,
            floquet_multipliers: multipliers.to_vec(),
            stable: false,
            intervals_per_period: vec![1],
            sides: Vec::new(),
            section_m: Vec::new(),
            iterations: 0,
        };
        differences(&orbit(one), &orbit(other))
    }

    /// Multipliers that meet beyond the unit circle, or leave the real axis there, pass nothing.
    #[test]
    fn only_multipliers_that_pass_the_unit_circle_make_a_special_point() {
        const INSIDE: [f64; 2] = [0.2, 0.0];
        let pair = |re: f64, im: f64| vec![[re, im], [re, -im], INSIDE];
        let real = |one: f64, other: f64| vec![[one, 0.0], [other, 0.0], INSIDE];
        let cases = [
            (pair(-1.551, 0.394), real(-1.605, -1.539), vec![]),
            (pair(1.5, 0.1), real(1.6, 1.4), vec![]),
            (pair(-0.9, 0.1), real(-0.9, -0.8), vec![]),
            (real(-0.9, -0.8), real(-1.1, -0.8), vec![Special::PeriodDoubling]),
            // a pair becomes two beyond -1, one of which then enters the circle
            (pair(-1.19, 0.28), real(-2.05, -0.88), vec![Special::PeriodDoubling]),
            (pair(-0.6, 0.7), pair(-0.6, 0.9), vec![Special::NeimarkSacker]),
            // a pair leaves the circle and becomes two real ones
            (pair(-0.9, 0.1), real(-1.2, -1.1), vec![Special::NeimarkSacker]),
            (real(1.1, 0.5), real(0.9, 0.5), vec![Special::Pitchfork]),
        ];
        for (one, other, expected) in cases {
            assert_eq!(between(&one, &other), expected, "{one:?} {other:?}");
            assert_eq!(between(&other, &one), expected, "{other:?} {one:?}");
        }
    }
}
