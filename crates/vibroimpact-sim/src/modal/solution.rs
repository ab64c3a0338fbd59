//! The result of an impact.

pub use crate::assembly::Counts;
pub use crate::outcome::Outcome;

/// One interval of contact.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SubImpact {
    /// First touch (s).
    pub start_s: f64,
    /// Separation (s), or the end of the computation if it came first.
    pub end_s: f64,
    /// Impulse of the contact force (N s).
    pub impulse_n_s: f64,
    /// Largest contact force (N).
    pub peak_force_n: f64,
    /// Estimated error of the largest contact force, from the same coarser solutions as that of the restitution (N); `None` if that
    /// is, if one of them has no [counterpart](SubImpact::counterpart) of this interval, and from the first interval on in which
    /// forces differ by more than a twentieth of the largest one.
    pub peak_force_uncertainty_n: Option<f64>,
    /// Largest compression (m).
    pub peak_compression_m: f64,
}

impl SubImpact {
    /// The interval of contact of another solution of the same impact that corresponds to number `i` of these: the two overlap, and
    /// neither overlaps another. `None` if there is none.
    pub fn counterpart<'a>(i: usize, these: &[SubImpact], others: &'a [SubImpact]) -> Option<&'a SubImpact> {
        let only = |one: &SubImpact, all: &[SubImpact]| {
            let from = all.partition_point(|other| other.end_s <= one.start_s);
            let to = all.partition_point(|other| other.start_s < one.end_s);
            (to == from + 1).then_some(from)
        };
        let other = only(these.get(i)?, others)?;
        (only(&others[other], these) == Some(i)).then(|| &others[other])
    }
}

/// The result of one impact.
#[derive(Debug, Clone, PartialEq)]
pub struct Solution {
    /// The outcome.
    pub outcome: Outcome,
    /// Net restitution: relative speed of separation over that of approach, both of the rigid-body motions
    /// (for a structure without rigid-body modes: of the striker alone). 0 in sustained contact. `None` unless the bodies approached
    /// each other, fast enough for the ratio to be a number, and the impact ended.
    pub restitution: Option<f64>,
    /// Estimated error of the restitution, from two or three coarser solutions; `None` if not requested, and if it is not
    /// known because one of them stopped at a limit before its end. It is 1 if the bodies do not meet in one of them.
    pub restitution_uncertainty: Option<f64>,
    /// Every interval of contact, in order of time.
    pub sub_impacts: Vec<SubImpact>,
    /// Costs, including those of the coarser solutions.
    pub counts: Counts,
    /// Time of the last separation, or at which the computation stopped (s).
    pub end_s: f64,
    /// Displacement of the striker at `end_s`, positive away from the structure (m).
    pub striker_displacement_m: f64,
    /// Its velocity then (m/s).
    pub striker_velocity_m_s: f64,
    /// Under gravity: estimated time from the highest point of the rebound to the next touch, as the gap closes there (s). If it is short, a
    /// small change brings the touch before that point, and the rebound is another. Infinite if the gap opens there, and otherwise.
    pub until_touch_s: f64,
    /// Under gravity: height above the undeflected structure to which the highest flight would rise if no touch ended it, as a share of
    /// the height of the fall, and thus the square of a restitution. Negative infinity without a flight that rises, and without gravity.
    pub highest_flight: f64,
    /// Modal amplitudes at `end_s` (m kg^1/2).
    pub amplitude: Vec<f64>,
    /// Their rates at `end_s` (m kg^1/2 / s).
    pub rate: Vec<f64>,
}

#[cfg(test)]
mod tests {
    use super::SubImpact;

    #[test]
    fn intervals_correspond_if_they_overlap_each_other_alone() {
        let all = |times: &[[f64; 2]]| -> Vec<SubImpact> {
            let of = |&[start_s, end_s]: &[f64; 2]| SubImpact { start_s, end_s, ..SubImpact::default() };
            times.iter().map(of).collect()
        };
        let these = all(&[[0.0, 1.0], [2.0, 4.0], [5.0, 6.0], [7.0, 8.0], [9.0, 10.0]]);
        // the second is two, the third and the fourth are one, and there is one more before the last
        let others = all(&[[0.0, 1.1], [2.1, 2.9], [3.0, 4.0], [5.0, 8.0], [8.1, 8.2], [9.1, 11.0]]);
        let found = |i| SubImpact::counterpart(i, &these, &others).map(|other| other.start_s);
        assert_eq!([0, 1, 2, 3, 4, 5].map(found), [Some(0.0), None, None, None, Some(9.1), None]);
        let back = |i| SubImpact::counterpart(i, &others, &these).map(|other| other.start_s);
        assert_eq!([0, 1, 2, 3, 4, 5].map(back), [Some(0.0), None, None, None, None, Some(9.0)]);
        assert_eq!(SubImpact::counterpart(0, &these, &[]), None);
    }
}
