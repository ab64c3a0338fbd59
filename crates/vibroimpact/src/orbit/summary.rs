//! Results of periodic motions and their branches.

use serde::Serialize;
use vibroimpact_sim::assembly;

use crate::assembly::AssemblyScene;
use crate::export::Failure;

/// A periodic motion as it is printed and written.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct OrbitSummary {
    /// Period of the motion (s).
    pub period_s: f64,
    /// Periods of the load in it; of several loads the common period.
    pub forcing_periods: u32,
    /// The moment of the loads' period at which `floquet_multipliers` compare states (s).
    pub phase_s: f64,
    /// Distance of the motion from its repetition after a period, relative to its size.
    pub closure: f64,
    /// Floquet multipliers, real and imaginary part, the largest first.
    pub floquet_multipliers: Vec<[f64; 2]>,
    /// Whether none of them lies outside the unit circle.
    pub stable: bool,
    /// Intervals of contact within a period, of all contacts together.
    pub intervals_per_period: u64,
    /// The motion of both sides of every contact.
    pub points: Vec<PointMotion>,
}

/// One side of a contact on a periodic motion.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PointMotion {
    /// Name of the contact.
    pub contact: String,
    /// 0 for the first of the two that the contact is between, 1 for the second.
    pub side: usize,
    /// Intervals of this contact within a period.
    pub intervals_per_period: u64,
    /// Amplitude of the displacement at the loads' lowest frequency (m).
    pub displacement_first_harmonic_m: f64,
    /// Largest displacement (m).
    pub displacement_max_m: f64,
    /// Least displacement (m).
    pub displacement_min_m: f64,
    /// Displacement at `phase_s` of each period of the loads (m), one value after the other.
    pub displacement_section_m: Vec<f64>,
}

/// The result of the search for a periodic motion.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Found {
    /// `found`, `not found`, `interrupted` or `stopped`.
    pub outcome: &'static str,
    /// The reason why a run over one period stopped.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reason: Option<&'static str>,
    /// The motion, if it was found.
    #[serde(flatten)]
    pub orbit: Option<OrbitSummary>,
    /// Smallest distance from a periodic motion if it was not found, relative to the size of the motion.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub nearest_closure: Option<f64>,
    /// How nearly the motion from the start repeats itself, if it was followed in search of a periodic motion.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub recurrence: Option<Recurrence>,
    /// The contact that keeps something from earlier periods, if a motion was found that would repeat itself only without that.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub remembering_contact: Option<String>,
}

/// How nearly the motion from the start repeats itself.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Recurrence {
    /// Periods of the loads after which it is nearest to an earlier state, up to 16.
    pub forcing_periods: u32,
    /// The distance from that state, relative to the size of the motion.
    pub distance: f64,
    /// Whether it repeats itself after so many periods from then on.
    pub has_converged: bool,
    /// Factor by which nearby motions separate in a period of the loads.
    pub separation_per_period: f64,
}

impl Recurrence {
    pub(super) fn new(found: &assembly::Recurrence) -> Recurrence {
        let assembly::Recurrence { forcing_periods, distance, has_converged, separation_per_period } = *found;
        Recurrence { forcing_periods, distance, has_converged, separation_per_period }
    }
}

/// The outcome of an interrupted search.
pub(super) const INTERRUPTED: &str = "interrupted";

/// An orbit of a branch.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BranchOrbit {
    /// The field's value.
    pub value: f64,
    /// The motion there.
    #[serde(flatten)]
    pub orbit: OrbitSummary,
}

/// A point at which stability or the pattern of contacts changes.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SpecialPoint {
    /// `fold`, `pitchfork`, `period doubling`, `Neimark-Sacker` or `grazing`.
    pub kind: &'static str,
    /// The field's value.
    pub value: f64,
    /// Its uncertainty.
    pub uncertainty: f64,
    /// Number, from 0, of the orbit that follows it.
    pub before_orbit: usize,
    /// A motion within the uncertainty.
    #[serde(flatten)]
    pub orbit: OrbitSummary,
}

/// One branch of periodic motions.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BranchPart {
    /// Whether the branch was followed to an end of the range, or back to the branch at which it begins.
    pub complete: bool,
    /// Whether it was interrupted.
    pub interrupted: bool,
    /// The contact that keeps something from earlier periods, if there is no first orbit for this reason.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub remembering_contact: Option<String>,
    /// The orbits in order.
    pub orbits: Vec<BranchOrbit>,
    /// Special points between them.
    pub special_points: Vec<SpecialPoint>,
}

/// A branch that begins at another one: of twice its period, or of the same period and with less symmetry.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SideBranch {
    /// The other one: 0 for that of the motion at the first value, or from 1 on its place in [`BranchSummary::branches`].
    pub parent: usize,
    /// `period doubling` or `pitchfork`.
    pub begins_with: &'static str,
    /// The field's value there.
    pub begins_at: f64,
    /// The field's value at another such point, at which it comes back; `None` if it does not.
    pub ends_at: Option<f64>,
    /// The branch.
    #[serde(flatten)]
    pub branch: BranchPart,
}

/// A branch of periodic motions over a field, and those that begin at its period doublings and pitchforks.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BranchSummary {
    /// The field that is followed.
    pub field: String,
    /// The branch of the motion at the first value.
    #[serde(flatten)]
    pub main: BranchPart,
    /// Branches that begin at it, then those that begin at these, as often as requested.
    pub branches: Vec<SideBranch>,
}

impl OrbitSummary {
    /// Size of the largest multiplier.
    pub(super) fn largest_multiplier(&self) -> f64 {
        self.floquet_multipliers.first().map_or(0.0, |m| m[0].hypot(m[1]))
    }
}

impl Found {
    /// The text of `orbit --json`: the result with its scene.
    ///
    /// # Errors
    /// Errors of the writer, which a motion cannot cause.
    pub fn json(&self, scene: &AssemblyScene) -> Result<String, Failure> {
        scene.with_result(self)
    }
}

impl BranchSummary {
    /// As [`Found::json`].
    ///
    /// # Errors
    /// As [`Found::json`].
    pub fn json(&self, scene: &AssemblyScene) -> Result<String, Failure> {
        scene.with_result(self)
    }
}

/// The field over which a branch is followed.
#[derive(Debug, Clone, PartialEq)]
pub struct Over<'a> {
    /// The field's path, as in a sweep.
    pub field: &'a str,
    /// First value; that of the scene when left out.
    pub from: Option<f64>,
    /// The value towards which the branch is followed.
    pub to: f64,
    /// First step, as a part of the range. The longest is 0.05, or this if it is larger.
    pub step: f64,
    /// How often the branches that begin at period doublings and pitchforks are followed: 1 for those of the branch itself, 2 also for
    /// theirs, ...
    pub branches: u32,
}
