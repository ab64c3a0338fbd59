//! The infinite beam, for contacts that end before a wave returns from an end.
//!
//! *Damping.* Modes of one damping ratio `zeta` make, on a beam without ends, the impulse response
//!
//! ```text
//! (1/(pi m')) int_0^oo exp(-zeta w t) sin(w sqrt(1-zeta^2) t) / (w sqrt(1-zeta^2)) dk = C sqrt(t) / sqrt(1 + zeta),
//! w = sqrt(EI/m') k^2,
//! ```
//!
//! that of an undamped beam (thesis Eq. 2.1) with another constant. An infinite beam can therefore represent damping exactly.
//!
//! *Ends.* A wave of frequency `w` travels at `c_g = 2 sqrt(w) (EI/m')^(1/4)` and returns from an end at distance `d` after
//! `2 d/c_g`. Within a contact of duration `tau`, waves with frequencies below `z/tau` do not return, with
//!
//! ```text
//! z = d^2 / (sqrt(EI/m') tau).
//! ```
//!
//! In Euler-Bernoulli's theory wave speeds have no upper bound, so the returning waves are small but not zero. The waves relevant
//! to a tolerance are those up to the frequency `z/tau` for which the bound below equals the tolerance. The problem depends only
//! on `z`, the damping and the number `S` of thesis Eq. 2.8; [`reflection_bound`] holds for every `S`.
//!
//! *Later contacts.* The striker leaves at `e v`. Until `z` at the elapsed time has decreased to 2 the location moves away from it
//! as on the infinite beam. Afterwards it never moves further than `W = sum phi_k^2 P/omega_k` beyond its start, where `P` is the
//! impulse. If the striker is then out of reach, it stays so.

use contact_models::Law;
use vibroimpact_sim::infinite::{self, BeamSection, Outcome};
use vibroimpact_sim::modal::Mode;

use super::choice::{Choice, Tried};
use super::pose::{Pose, Source};
use super::uncertainty::Known;
use super::{Answer, Cost, Model};
use crate::scene::{End, InvalidInput, Scene, rigid_mobility};
use crate::text::small;

/// Times and distances from which [`reflection_bound`] holds.
const LEAST_Z: f64 = 2.0;
/// Effect of returning waves at `z = 1`; see [`reflection_bound`].
const WAVES: f64 = 10.0;
/// Above this `S` the striker does not leave an infinite beam after one contact (thesis 2.2.6: 1.559).
const CRITICAL_S: f64 = 1.560;
/// Error of the solution for the infinite beam, as a share of the change of speed.
const SOLVER: f64 = 1e-7;
/// Modes summed one by one for the reach of the location.
const SUMMED: usize = 24;

/// Reflection of waves by an end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reflection {
    /// As one image of the source: a pinned or guided end.
    Image,
    /// With a near field: a clamped or free end.
    NearField,
}

impl From<End> for Reflection {
    fn from(end: End) -> Reflection {
        match end {
            End::Pinned | End::Guided => Reflection::Image,
            End::Clamped | End::Free => Reflection::NearField,
        }
    }
}

/// Largest change of the restitution of one contact by an end, for `z` of at least 2; infinite below.
///
/// The powers follow from the smoothness of the force; with modal damping a clamped or free end also has a slow and distant
/// response. The factors are twice the largest in resolved impacts on beams with all four ends, `S` from 1e-5 to 1.2, damping
/// ratios up to 0.1 and `z` up to 32 (`tests/model.rs` computes them again).
pub fn reflection_bound(end: Reflection, z: f64, damping_ratio: f64) -> f64 {
    if !(z >= LEAST_Z && damping_ratio <= 0.1) {
        return f64::INFINITY;
    }
    let waves = WAVES / z.powi(4);
    match end {
        Reflection::Image => waves,
        Reflection::NearField => waves + 0.8 * damping_ratio / z.powf(1.5),
    }
}

/// A uniform beam with the location of impact.
struct Uniform {
    section: BeamSection,
    distances: [f64; 2],
    ends: [End; 2],
    damping_ratio: f64,
}

impl Uniform {
    /// The beam of a scene with Hertz contact, or the reason why there is none.
    fn new(pose: &Pose) -> Result<Result<Uniform, String>, InvalidInput> {
        let Source::Beam { beam, location_m, .. } = &pose.source else {
            return Ok(Err("the structure is not a beam of segments".to_owned()));
        };
        if !matches!(pose.law, Law::Hertz(_)) {
            return Ok(Err("the infinite beam is solved for hertz contact".to_owned()));
        }
        if let Some(more) = beam.beyond_slender().map_err(|fault| fault.within("structure"))? {
            return Ok(Err(format!("the beam has {more}, unlike the infinite beam")));
        }
        let built = beam.to_beam().map_err(|fault| fault.within("structure"))?;
        let mut sections = built.segments.iter().map(|segment| BeamSection::from(*segment));
        let Some(section) = sections.next() else { return Ok(Err("there is no beam".to_owned())) };
        if sections.any(|other| other != section) {
            return Ok(Err("the beam is not uniform".to_owned()));
        }
        Ok(Ok(Uniform {
            section,
            distances: [*location_m, built.length_m() - location_m],
            ends: beam.ends,
            damping_ratio: beam.damping_ratio,
        }))
    }

    /// `sqrt(EI/m')` (m^2/s).
    fn spread(&self) -> f64 {
        (self.section.flexural_rigidity_n_m2 / self.section.mass_per_length_kg_m).sqrt()
    }

    fn impact(&self, pose: &Pose) -> Result<infinite::Impact, InvalidInput> {
        let stiffness = match &pose.law {
            Law::Hertz(law) => law.stiffness_n_m1_5,
            _ => f64::NAN,
        };
        let undamped = infinite::Impact::on_beam(self.section, pose.striker, stiffness)?;
        Ok(infinite::Impact {
            impulse_response: undamped.impulse_response / (1.0 + self.damping_ratio).sqrt(),
            ..undamped
        })
    }

    /// Bound on the effect of both ends in a contact of this duration, and the smaller `z`.
    fn reflections(&self, duration_s: f64) -> (f64, f64) {
        let z = self.distances.map(|d| d * d / (self.spread() * duration_s));
        let bound = |i: usize| reflection_bound(self.ends[i].into(), z[i], self.damping_ratio);
        (bound(0) + bound(1), z[0].min(z[1]))
    }

    /// The fastest relevant waves for a contact of this duration, and the time at which they return from the nearer end.
    fn first_return(&self, duration_s: f64, tolerance: f64) -> FirstReturn {
        let omega_rad_s = (WAVES / tolerance).powf(0.25).max(LEAST_Z) / duration_s;
        let group_velocity_m_s = 2.0 * (omega_rad_s * self.spread()).sqrt();
        let distance_m = self.distances[0].min(self.distances[1]);
        FirstReturn { omega_rad_s, group_velocity_m_s, after_s: 2.0 * distance_m / group_velocity_m_s }
    }

    /// Time during which the location moves as that of an infinite beam (s).
    fn undisturbed_s(&self) -> f64 {
        self.distances[0].min(self.distances[1]).powi(2) / (LEAST_Z * self.spread())
    }
}

/// The fastest waves that are relevant at a tolerance.
struct FirstReturn {
    omega_rad_s: f64,
    group_velocity_m_s: f64,
    after_s: f64,
}

impl FirstReturn {
    fn text(&self, duration_s: f64) -> String {
        format!(
            "relevant waves, up to {} rad/s, travel at {} m/s at most and return from an end after {} s; the last contact \
            ends after {} s",
            small(self.omega_rad_s),
            small(self.group_velocity_m_s),
            small(self.after_s),
            small(duration_s)
        )
    }
}

/// Largest displacement of the location of impact towards the striker after an impulse (m).
fn reach(modes: &[Mode], impulse: f64, beam_mass: f64) -> f64 {
    let elastic = || modes.iter().filter(|mode| mode.omega_rad_s > 0.0);
    let summed: f64 = elastic().map(|mode| mode.shape.powi(2) * impulse / mode.omega_rad_s).sum();
    // beyond: no shape of a uniform beam is larger than 2/sqrt(M), and frequencies grow like squares
    let beyond = elastic()
        .next_back()
        .map_or(f64::INFINITY, |mode| 1.2 * elastic().count() as f64 * 4.0 / beam_mass * impulse / mode.omega_rad_s);
    summed + beyond
}

/// The infinite beam, if the ends cannot change the restitution by more than the tolerance.
pub(super) fn certified(pose: &mut Pose, cost: &mut Cost) -> Tried {
    let beam = match Uniform::new(pose)? {
        Ok(beam) => beam,
        Err(reason) => return Ok(Err(reason)),
    };
    if !pose.approaches() {
        return Ok(Err("the striker does not approach".to_owned()));
    }
    // a first contact on an infinite beam lasts 0.9 to 1 times one at a wall
    let (hopeful, z) = beam.reflections(0.8 * pose.wall.duration_s);
    if hopeful > pose.tolerance {
        return Ok(Err(format!("waves return from an end within the contact (z = {})", small(z))));
    }
    match solve(pose, &beam, cost)? {
        Ok((choice, Some(_))) if choice.answer.settled => Ok(Ok(choice)),
        Ok((_, Some(uncertainty))) => {
            Ok(Err(format!("waves from the ends may change the restitution by {}", small(uncertainty))))
        }
        Ok((_, None)) => Ok(Err("the beam may spring back and meet the striker again".to_owned())),
        Err(reason) => Ok(Err(reason)),
    }
}

/// The infinite beam, because it was requested.
pub(super) fn forced(pose: &mut Pose, cost: &mut Cost) -> Tried {
    let beam = match Uniform::new(pose)? {
        Ok(beam) => beam,
        Err(reason) => return Ok(Err(reason)),
    };
    if !pose.approaches() {
        return Ok(Err("the striker does not approach".to_owned()));
    }
    Ok(solve(pose, &beam, cost)?.map(|(choice, _)| choice))
}

/// The choice, with an uncertainty if one can be given.
type Solved = Result<(Choice, Option<f64>), String>;

fn solve(pose: &mut Pose, beam: &Uniform, cost: &mut Cost) -> Result<Solved, InvalidInput> {
    let groups = match beam.impact(pose).and_then(|impact| impact.groups()) {
        Ok(groups) => groups,
        Err(fault) => return Ok(Err(format!("an infinite beam cannot be solved: {fault}"))),
    };
    let once = pose.scene.model == Model::Auto;
    if once && groups.s > CRITICAL_S {
        return Ok(Err(format!("the striker would not leave an infinite beam at once (S = {})", small(groups.s))));
    }
    let settings = infinite::Settings { tolerance: 1e-8, nodes: 12, estimate_uncertainty: false, ..Default::default() };
    let solution = match infinite::solve(infinite::Structure::Beam, groups.s, &settings) {
        Ok(solution) => solution,
        Err(fault) => {
            return Ok(Err(format!("S = {} cannot be solved; it must be {}", small(groups.s), fault.allowed)));
        }
    };
    cost.solves += 1;
    cost.panels += solution.panels_tried as u64;
    let ended = solution.sub_impacts.last().and_then(|contact| contact.end);
    let duration_s = ended.unwrap_or(f64::INFINITY) * groups.time_s;
    let (bound, z) = beam.reflections(duration_s);

    let (mass, speed) = (pose.striker.mass_kg, pose.striker.speed_m_s);
    let modes = pose.first(SUMMED, cost)?;
    let rigid = rigid_mobility(modes);
    let ratio = solution.rebound_ratio();
    let impulse = mass * speed * (1.0 + ratio.unwrap_or(0.0));
    let beam_mass = beam.section.mass_per_length_kg_m * (beam.distances[0] + beam.distances[1]);
    let reach = reach(modes, impulse, beam_mass);
    let departs = ratio.unwrap_or(0.0) * speed * (beam.undisturbed_s() - duration_s);
    // twice: from the location at separation to the start, and beyond it
    let free = solution.sub_impacts.len() == 1 && departs > 2.0 * reach;

    // relative to the rigid-body motion of the beam, as elsewhere
    let relative = 1.0 + mass * rigid;
    let restitution = ratio.map(|ratio| (1.0 + ratio) * relative - 1.0);
    let known = match restitution.filter(|_| free && bound.is_finite()) {
        Some(_) => Known::new(pose.scene, Ok(relative * SOLVER), Ok(relative * bound)),
        None => Known::nothing("no part: the effect of waves from the ends of the beam is not bounded"),
    };
    let uncertainty = known.uncertainty.whole();
    let evidence = format!(
        "one contact, S = {}; {}; faster waves return from an end within it (z = {}), which changes the restitution by \
         {} at most",
        small(groups.s),
        beam.first_return(duration_s, pose.tolerance).text(duration_s),
        small(z),
        small(bound)
    );
    let reason = match (ended, free) {
        (None, _) => format!(
            "infinite-beam: the striker would stay on an infinite beam (S = {}); on this one waves return from the ends",
            small(groups.s)
        ),
        (_, true) if bound.is_finite() => {
            format!("infinite-beam: {evidence}; the beam cannot reach the striker afterwards")
        }
        (_, true) => format!(
            "infinite-beam: {}: waves have returned from an end (z = {})",
            beam.first_return(duration_s, pose.tolerance).text(duration_s),
            small(z)
        ),
        (_, false) => format!(
            "infinite-beam: {} (z = {}), and it is not certain that the ends of the beam cause no further contact",
            beam.first_return(duration_s, pose.tolerance).text(duration_s),
            small(z)
        ),
    };
    let answer = Answer {
        outcome: solution.outcome.as_str(),
        stopped_by: solution.outcome.stopped_by(),
        restitution,
        sub_impact_count: Some(solution.sub_impacts.len()),
        ..Answer::new(Model::InfiniteBeam, pose.tolerance, known, reason)
    };
    Ok(Ok((Choice::from(answer), uncertainty)))
}

/// An infinite structure.
pub(super) fn of_infinite_structure(scene: &Scene) -> Result<Choice, InvalidInput> {
    scene.require_infinite_model()?;
    let (_, solution) = scene.solve_infinite()?;
    Ok(scene.infinite_answer(&solution).into())
}

impl Scene {
    /// Rejects models that do not apply to infinite structures.
    pub(crate) fn require_infinite_model(&self) -> Result<(), InvalidInput> {
        if matches!(self.model, Model::Auto | Model::InfiniteBeam) {
            return Ok(());
        }
        let value = format!("\"{}\"", self.model.as_str());
        Err(InvalidInput::new("model", value, "auto or infinite-beam, because the structure has no ends"))
    }

    /// The solution for an infinite structure as an answer.
    pub(crate) fn infinite_answer(&self, solution: &infinite::Solution) -> Answer {
        let sustained = solution.outcome == Outcome::Sustained;
        let restitution = if sustained { Some(0.0) } else { solution.rebound_ratio() };
        // relative to the change of speed
        let uncertainty = restitution
            .zip(solution.relative_uncertainty)
            .map(|(e, error)| error * (1.0 + e))
            .filter(|u| u.is_finite());
        let settled = uncertainty.is_some_and(|u| u <= super::DEFAULT_TOLERANCE);
        let kind = self.structure.kind().replace('-', " ");
        let told =
            solution.s.map_or_else(|| format!("{} contact", self.contact.law_name()), |s| format!("S = {}", small(s)));
        let reason = format!("the structure is an {kind}: {told}");
        // there are no truncated modes
        let solver = uncertainty.ok_or("the same impact with more nodes has other contacts, or ends otherwise");
        let known = Known::new(self, solver, Ok(0.0)).of(restitution);
        Answer {
            outcome: solution.outcome.as_str(),
            stopped_by: solution.outcome.stopped_by(),
            restitution,
            sub_impact_count: Some(solution.sub_impacts.len()),
            settled: settled || sustained,
            cost: Cost { solves: 2, panels: solution.panels_tried as u64, ..Cost::default() },
            ..Answer::new(Model::InfiniteBeam, super::DEFAULT_TOLERANCE, known, reason)
        }
    }
}
