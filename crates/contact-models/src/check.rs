//! Tests of the properties of a law on which an integrator relies, along motions.
//!
//! | promise | why an integrator needs it |
//! |---|---|
//! | numbers are finite everywhere | an iteration may step beyond a branch |
//! | no tension within a branch | surfaces separate where the law says so, and nowhere else |
//! | the derivatives are those of the force | Newton's method and derivatives of impacts rest on them |
//! | the force depends on the rate on all of a branch, as stated by `per_rate_n_s_m`, or nowhere | the rate is computed only where it matters |
//! | the boundaries of a branch are finite in number | all of them are watched |
//! | the force is continuous from branch to branch, and zero at a release | events have no impulse |
//! | a branch is valid where it begins, and few follow each other between two instants | time advances |
//! | a complete contact returns no more work than it received | energy is not created |

use crate::trace::{MOST_EVENTS, State, first_met, trace};
use crate::{Boundary, Branch, ContactLaw, Force, MOST_BOUNDARIES, Memory, boundaries};

/// A property that a law does not have, and where.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{promise}, at a compression of {compression_m:e} m and a rate of {rate_m_s:e} m/s on {branch:?}")]
pub struct Breach {
    /// The property.
    pub promise: Promise,
    /// The branch; `None` between contacts.
    pub branch: Option<Branch>,
    /// Compression (m).
    pub compression_m: f64,
    /// Its rate (m/s).
    pub rate_m_s: f64,
}

/// A property that a law does not have.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Promise {
    /// Force, derivatives and stored energy are finite numbers everywhere.
    #[error("the law gives a number that is not finite")]
    Finite,
    /// There is no tension within a branch.
    #[error("the force pulls: {force_n:e} N")]
    Push {
        /// The force (N).
        force_n: f64,
    },
    /// The derivatives are those of the force.
    #[error("a derivative is stated as {stated:e} where the force changes by {found:e}")]
    Derivative {
        /// The derivative from differences of the force.
        stated: f64,
        /// The one that differences of its force show.
        found: f64,
    },
    /// The derivative of a force that depends on the rate shows this from the beginning of the branch on.
    #[error(
        "the force depends on the rate, although the derivative that the law states here or earlier on the branch is zero"
    )]
    Rate,
    /// The number of boundaries of a branch is finite.
    #[error("a branch has more than {MOST_BOUNDARIES} boundaries")]
    Boundaries,
    /// The force is continuous from one branch to the next, and zero where surfaces separate.
    #[error("the force jumps from {before_n:e} N to {after_n:e} N where a branch ends")]
    Continuous {
        /// Force before (N).
        before_n: f64,
        /// Force after (N).
        after_n: f64,
    },
    /// A branch is valid where it begins.
    #[error("a branch begins beyond its own boundary")]
    Begins,
    /// Branches end: few follow each other between two instants.
    #[error("branches follow each other while time does not advance")]
    Settles,
    /// Energy is stored or dissipated, never created.
    #[error("a complete contact returns {made_j:e} J more than it received")]
    Energy {
        /// The energy created (J).
        made_j: f64,
    },
}

/// Relative step of differences, their allowed error, and the allowed rounding of a force.
const STEP: f64 = 1e-5;
const DIFFERENCE: f64 = 1e-6;
const ROUNDING: f64 = 1e-12;
/// Allowed error of the quadrature of the work.
const WORK: f64 = 1e-7;
/// Range of the sizes of motions, well within the range of the laws.
const LEAST: f64 = 1e-20;
const MOST: f64 = 1e20;
/// Number of motions, and of instants between two changes of their acceleration.
const MOTIONS: u64 = 40;
const INSTANTS: u32 = 40;

/// Tests a law along motions of about this compression (m) and speed (m/s), which load and unload it in many orders. Your own
/// law should pass before it is used in a solver. Both sizes are limited to 1e-20 to 1e20; a NaN counts as 1.
///
/// # Errors
/// The first property that the law does not have.
///
/// ```
/// use contact_models::{After, Boundary, Branch, ContactLaw, Force, Internal, Memory, Promise, Stage, check_contract};
///
/// /// A spring whose stated stiffness is wrong.
/// struct Wrong;
///
/// impl ContactLaw for Wrong {
///     fn touch(&self, _: &Memory, _: f64) -> Branch {
///         Branch { stage: Stage::Single, anchor_m: 0.0, internal: Internal::NONE }
///     }
///     fn force(&self, _: &Branch, xi: f64, _: f64) -> Force {
///         Force { force_n: 1e6 * xi.clamp(0.0, 1.0), per_compression_n_m: 2e6, per_rate_n_s_m: 0.0 }
///     }
///     fn stored_energy_j(&self, _: &Branch, xi: f64) -> f64 {
///         5e5 * xi.clamp(0.0, 1.0).powi(2)
///     }
///     fn boundary(&self, _: &Branch, which: usize) -> Option<Boundary> {
///         (which == 0).then_some(Boundary::compression_falls_to(0.0))
///     }
///     fn cross(&self, _: &Branch, _: usize, _: f64, _: f64) -> After {
///         After::Release(Memory::default())
///     }
/// }
///
/// let breach = check_contract(&Wrong, 1e-5, 1.0).unwrap_err();
/// assert!(matches!(breach.promise, Promise::Derivative { .. }));
/// ```
pub fn check_contract(law: &dyn ContactLaw, compression_m: f64, speed_m_s: f64) -> Result<(), Breach> {
    let [compression_m, speed_m_s] =
        [compression_m, speed_m_s].map(|size| if size.is_nan() { 1.0 } else { size.clamp(LEAST, MOST) });
    (0..MOTIONS).try_for_each(|seed| {
        let motion = Motion::new(seed, compression_m, speed_m_s);
        check_contract_along(law, &motion.times(), |time| motion.at(time))
    })
}

/// Tests a law along one motion, which gives compression (m) and rate (m/s) at a time (s), from a fresh surface. `times_s`
/// increase, and resolve the oscillations of the motion.
///
/// # Errors
/// As [`check_contract`].
pub fn check_contract_along(
    law: &dyn ContactLaw,
    times_s: &[f64],
    motion: impl Fn(f64) -> (f64, f64),
) -> Result<(), Breach> {
    let mut state = State::Apart(Memory::default());
    let largest = |sizes: (f64, f64), &time: &f64| {
        let (xi, rate) = motion(time);
        (sizes.0.max(xi.abs()), sizes.1.max(rate.abs()))
    };
    let sizes = times_s.iter().fold((0.0, 0.0), largest);
    // Whether the force on the branch depends on the rate, once there is a force.
    let mut by_rate: Option<bool> = None;
    for pair in times_s.windows(2) {
        let (mut from, to) = (pair[0], pair[1]);
        let mut events = 0;
        while let Some((time, which)) = first_met(&state.boundaries(&law), from, to, &motion) {
            let at = Place { law, branch: state.branch(), motion: motion(time), sizes };
            events += 1;
            at.require(events <= MOST_EVENTS, || Promise::Settles)?;
            let next = state.next(&law, which, at.motion);
            if at.branch.is_some() {
                at.crosses_to(&next)?;
            }
            (state, from, by_rate) = (next, time, None);
        }
        Place { law, branch: state.branch(), motion: motion(to), sizes }.holds(&mut by_rate)?;
    }
    // The energy of a contact is limited only when it is over.
    let Ok(path) = trace(&law, times_s, &motion) else { return Ok(()) };
    let largest = path.iter().map(|point| point.work_j.abs()).fold(f64::MIN_POSITIVE, f64::max);
    let mut dissipated = 0.0;
    for point in path.iter().filter(|point| point.stored_energy_j == 0.0 && point.force_n == 0.0) {
        let made_j = dissipated - point.work_j;
        let at = Place { law, branch: None, motion: (point.compression_m, point.rate_m_s), sizes };
        at.require(made_j <= WORK * largest, || Promise::Energy { made_j })?;
        dissipated = point.work_j;
    }
    Ok(())
}

/// A law at a point of a motion.
struct Place<'a> {
    law: &'a dyn ContactLaw,
    branch: Option<Branch>,
    motion: (f64, f64),
    /// Largest compression and rate of the motion.
    sizes: (f64, f64),
}

impl Place<'_> {
    fn require(&self, holds: bool, promise: impl FnOnce() -> Promise) -> Result<(), Breach> {
        let (compression_m, rate_m_s) = self.motion;
        if holds { Ok(()) } else { Err(Breach { promise: promise(), branch: self.branch, compression_m, rate_m_s }) }
    }

    fn finite(&self, force: &Force) -> Result<(), Breach> {
        let sum = force.force_n + force.per_compression_n_m + force.per_rate_n_s_m;
        self.require(sum.is_finite(), || Promise::Finite)
    }

    /// Allowed error of the force due to the rounding of compression and rate.
    fn rounding(&self, force: &Force) -> f64 {
        let (xi, rate) = self.sizes;
        ROUNDING * (force.force_n.abs() + force.per_compression_n_m.abs() * xi + force.per_rate_n_s_m.abs() * rate)
    }

    /// Tests at a point within a branch, on which the force depends on the rate or not.
    fn holds(&self, by_rate: &mut Option<bool>) -> Result<(), Breach> {
        let (Some(branch), (xi, rate)) = (self.branch, self.motion) else { return Ok(()) };
        let law = self.law;
        self.require(law.boundary(&branch, MOST_BOUNDARIES).is_none(), || Promise::Boundaries)?;
        let force = law.force(&branch, xi, rate);
        self.finite(&force)?;
        for far in [1e3, 1e30] {
            for (by_xi, by_rate) in [(-1.0, 1.0), (-1.0, -1.0), (1.0, 1.0), (1.0, -1.0)] {
                self.finite(&law.force(&branch, by_xi * far * (1.0 + xi.abs()), by_rate * far * (1.0 + rate.abs())))?;
            }
        }
        let stored = law.stored_energy_j(&branch, xi);
        self.require(stored.is_finite() && stored >= 0.0, || Promise::Finite)?;
        let force_n = force.force_n;
        self.require(force_n >= -self.rounding(&force), || Promise::Push { force_n })?;
        let here = force.per_rate_n_s_m != 0.0;
        self.require(here || law.force(&branch, xi, 0.5 * rate).force_n == force_n, || Promise::Rate)?;
        if force_n != 0.0 {
            self.require(*by_rate.get_or_insert(here) || !here, || Promise::Rate)?;
        }
        self.derivatives_are_those_of(&branch, &force)
    }

    fn derivatives_are_those_of(&self, branch: &Branch, force: &Force) -> Result<(), Breach> {
        let (law, (xi, rate)) = (self.law, self.motion);
        // Away from the ends of the branch and from its beginning, where powers may have their origin.
        let ends: Vec<Boundary> = boundaries(law, branch).collect();
        let end = ends.iter().filter(|end| end.per_rate == 0.0 && end.per_compression > 0.0);
        let end = end.map(|end| end.level / end.per_compression).fold(0.0, f64::max);
        let depth = (xi - end).min((xi - branch.anchor_m).abs());
        let (by_xi, by_rate) = (STEP * depth, STEP * rate.abs());
        let room = |end: &Boundary| {
            end.margin(xi, rate) > 3.0 * (end.per_compression.abs() * by_xi + end.per_rate.abs() * by_rate)
        };
        // Nearer to its end the force is too small for differences.
        let within = depth > 1e-3 * xi.abs() && by_rate > 0.0 && ends.iter().all(room);
        if !within {
            return Ok(());
        }
        let at = |xi: f64, rate: f64| law.force(branch, xi, rate).force_n;
        // of fourth order, which follows powers of the compression up to some thousand
        let slope = |near: f64, far: f64, step: f64| (8.0 * near - far) / (12.0 * step);
        let change_xi = |by: f64| at(xi + by, rate) - at(xi - by, rate);
        let change_rate = |by: f64| at(xi, rate + by) - at(xi, rate - by);
        let pairs = [
            (force.per_compression_n_m, slope(change_xi(by_xi), change_xi(2.0 * by_xi), by_xi), by_xi),
            (force.per_rate_n_s_m, slope(change_rate(by_rate), change_rate(2.0 * by_rate), by_rate), by_rate),
        ];
        for (stated, found, step) in pairs {
            let allowed =
                DIFFERENCE * (stated.abs() + found.abs()) + (1e-14 * force.force_n.abs() + f64::MIN_POSITIVE) / step;
            self.require((stated - found).abs() <= allowed, || Promise::Derivative { stated, found })?;
        }
        Ok(())
    }

    /// Tests of a transition from this branch to the next.
    fn crosses_to(&self, next: &State) -> Result<(), Breach> {
        let (law, (xi, rate)) = (self.law, self.motion);
        let force = |branch: Option<Branch>| branch.map_or(Force::ZERO, |branch| law.force(&branch, xi, rate));
        let (before, after) = (force(self.branch), force(next.branch()));
        self.finite(&after)?;
        let allowed = self.rounding(&before) + self.rounding(&after);
        let (before_n, after_n) = (before.force_n, after.force_n);
        self.require((before_n - after_n).abs() <= allowed, || Promise::Continuous { before_n, after_n })?;
        let Some(branch) = next.branch() else { return Ok(()) };
        let inside = boundaries(law, &branch).all(|end| {
            let size = end.per_compression.abs() * self.sizes.0 + end.per_rate.abs() * self.sizes.1;
            end.margin(xi, rate) >= -ROUNDING * (size + end.level.abs())
        });
        self.require(inside, || Promise::Begins)
    }
}

/// A motion of piecewise constant acceleration that begins at first touch and ends with separate bodies.
struct Motion {
    /// Rates at integer multiples of `unit_s`, and the compressions there.
    rates: Vec<f64>,
    compressions: Vec<f64>,
    unit_s: f64,
}

impl Motion {
    fn new(seed: u64, compression_m: f64, speed_m_s: f64) -> Motion {
        // A linear congruential generator is random enough to load and unload in any order.
        let mut random = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15).wrapping_add(1);
        let mut part = || {
            random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (random >> 11) as f64 / (1u64 << 53) as f64
        };
        let unit_s = compression_m / speed_m_s;
        let mut rates = vec![(0.1 + 0.9 * part()) * speed_m_s];
        for _ in 0..2 + seed % 7 {
            rates.push((2.0 * part() - 1.0) * speed_m_s);
        }
        let mut compressions = vec![0.0];
        for i in 0.. {
            if i + 1 == rates.len() {
                if compressions[i] < -0.2 * compression_m {
                    break;
                }
                rates.push(-speed_m_s);
            }
            compressions.push(compressions[i] + 0.5 * unit_s * (rates[i] + rates[i + 1]));
        }
        Motion { rates, compressions, unit_s }
    }

    fn times(&self) -> Vec<f64> {
        let count = INSTANTS * (self.rates.len() as u32 - 1);
        (0..=count).map(|i| self.unit_s * f64::from(i) / f64::from(INSTANTS)).collect()
    }

    fn at(&self, time_s: f64) -> (f64, f64) {
        let unit = time_s / self.unit_s;
        let i = (unit as usize).min(self.rates.len() - 2);
        let (part, from, change) = (unit - i as f64, self.rates[i], self.rates[i + 1] - self.rates[i]);
        (self.compressions[i] + self.unit_s * part * (from + 0.5 * part * change), from + part * change)
    }
}
