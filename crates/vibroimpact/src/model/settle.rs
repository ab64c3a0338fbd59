//! Modes, as many as the restitution needs to settle.
//!
//! With the static compliance of all other modes in series with the contact, the restitution converges in the number
//! `N` of modes, fast once mode `N` is fast against the contact: with `k` the contact's stiffness and `c_N` the
//! compliance left out, once
//!
//! ```text
//! R(N) = omega_N^2 / ( k (1/m + 3 c_N omega_N^2) )
//! ```
//!
//! is large (`3 c_N omega_N^2` is what the modes up to `N` of a beam add to the inverse mass at the place). The first
//! guess is the `N` at which `R` is a power of the tolerance; see `cargo xtask study-auto` for how well it does.
//! Then `N` is raised by steps of a factor of about 1.4. Restitutions alone may agree by accident while the courses
//! of two impacts do not, and then differ again at the next `N`; so the striker's speed in every flight between two
//! contacts is compared as well, and after more than one contact a third number of modes is asked.
//!
//! Every contact amplifies what came before it, the solver's error too, and a solver too coarse for an impact may find the
//! same wrong course at every `N`. So from the third number of modes on, the solver is asked for an accuracy that rises
//! from one to the next: its errors are part of the differences, and restitutions agree when both have become small.

use vibroimpact_sim::modal::{Outcome, Settings, Solution, Structure};

use super::choose::Choice;
use super::pose::{Pose, Source, chooses_modes};
use super::text::small;
use super::{Answer, Cost, DEFAULT_TOLERANCE, Kept, Model, Modes};
use crate::impact::{Impact, compliance, in_scene};
use crate::scene::{InvalidInput, Scene};

/// More modes than this are not tried.
pub(super) const MOST_MODES: usize = 400;
/// `R` at the first guess: `FIRST / tolerance^ORDER`.
const FIRST: f64 = 0.4;
const ORDER: f64 = 0.47;
/// From one number of modes to the next.
const RAISE: f64 = std::f64::consts::SQRT_2;
/// The last number of modes that a list allows counts if it is this many times the one before; what a smaller step
/// changes says little about the rest.
const LEAST_RAISE: f64 = 1.25;
/// Fewest modes to begin with, besides rigid-body motions.
const FEWEST: usize = 4;
/// The uncertainty: this many times the largest of three differences, weighted below.
const CAUTION: f64 = 2.0;
/// Weight of the largest difference between the speeds of flight of two impacts.
const FLIGHTS: f64 = 0.5;
/// Weight of the difference before the last.
const EARLIER: f64 = 0.1;
/// The same from the third number of modes on: of many pairs one may agree by accident.
const EARLIER_LATE: f64 = 0.5;
/// Tolerance of the solver with the first two numbers of modes, as a share of the tolerance wanted; and its range. Below
/// it, rounding is all that steps can show.
const SOLVER_SHARE: f64 = 0.1;
const SOLVER_RANGE: (f64, f64) = (1e-11, 1e-3);
/// From the third on: as a share of the tolerance with the number before.
const TIGHTER: f64 = 1.0 / 30.0;
/// How many of the last results make up the spread where they do not settle.
const SPREAD: usize = 4;

/// The solver's settings for a tolerance wanted, after so many numbers of modes.
fn settings(tolerance: f64, rungs: usize) -> Settings {
    let tightened = (1..rungs).fold(SOLVER_SHARE * tolerance, |share, _| TIGHTER * share);
    Settings {
        tolerance: tightened.clamp(SOLVER_RANGE.0, SOLVER_RANGE.1),
        estimate_uncertainty: false,
        ..Settings::default()
    }
}

/// One number of modes and what came of it.
struct Rung {
    /// From the lowest; those not excited among them.
    count: usize,
    structure: Structure,
    settings: Settings,
    solution: Solution,
}

impl Rung {
    fn new(pose: &mut Pose, count: usize, settings: Settings, cost: &mut Cost) -> Result<Rung, InvalidInput> {
        let structure = pose.structure(count, cost)?;
        let solver = pose.kept.solver(&structure)?;
        let solution = solver.solve(&pose.striker, &pose.law, None, &settings).map_err(in_scene)?;
        cost.add(&solution.counts, structure.modes.len());
        Ok(Rung { count, structure, settings, solution })
    }

    /// Impulse up to each separation, over the striker's momentum.
    fn flights(&self, momentum: f64) -> Vec<f64> {
        let mut sum = 0.0;
        let separations = self.solution.sub_impacts.iter();
        separations
            .map(|contact| {
                sum += contact.impulse_n_s;
                sum / momentum
            })
            .collect()
    }
}

/// How far the flights of one impact are from the nearest of another, at most.
fn distance(a: &[f64], b: &[f64]) -> f64 {
    let nearest = |x: &f64, of: &[f64]| of.iter().map(|y| (x - y).abs()).fold(f64::INFINITY, f64::min);
    let directed = |of: &[f64], to: &[f64]| of.iter().map(|x| nearest(x, to)).fold(0.0, f64::max);
    if a.is_empty() && b.is_empty() { 0.0 } else { directed(a, b).max(directed(b, a)) }
}

/// `R(N)` where the modes up to `omega_N` add so much to the inverse mass of the striker. The stiffness is that at the
/// compression which the contact reaches on both together.
fn resolution(pose: &Pose, omega_rad_s: f64, added: f64) -> f64 {
    let (wall, striker) = (&pose.wall, &pose.striker);
    let square = omega_rad_s * omega_rad_s;
    let inverse_mass = 1.0 / striker.mass_kg + added;
    // k ~ xi^(n-1) and xi = v / sqrt(k inverse_mass): a power law, in closed form
    let alone = striker.speed_m_s / (wall.stiffness_n_m * inverse_mass).sqrt();
    let softer = (alone / wall.compression_m).powf(2.0 / (wall.exponent + 1.0)).min(1.0);
    square / (wall.stiffness_n_m * softer.powf(wall.exponent - 1.0) * inverse_mass)
}

/// The number of modes that is expected to do, before any is computed: on average over a beam's length, the modes up
/// to wave number `k` have the density `1/(pi m')` in `k`, and `omega_n = (n pi / sum l (m'/EI)^(1/4))^2`.
fn expected(pose: &Pose, target: f64) -> Result<usize, InvalidInput> {
    let Source::Beam { beam, location_m, .. } = &pose.source else { return Ok(pose.source.most()) };
    let segments = beam.to_beam().map_err(|fault| fault.within("structure"))?.segments;
    let slowness = |s: &beam_modes::Segment| (s.mass_per_length_kg_m / s.flexural_rigidity_n_m2).powf(0.25);
    let phase: f64 = segments.iter().map(|s| s.length_m * slowness(s)).sum();
    let mut ends_m = 0.0;
    let here = segments.iter().find(|s| {
        ends_m += s.length_m;
        ends_m >= *location_m
    });
    let Some(here) = here.or(segments.last()) else { return Ok(FEWEST) };
    let enough = (FEWEST + 1..MOST_MODES).find(|&n| {
        let root = n as f64 * std::f64::consts::PI / phase;
        let added = root * slowness(here) / (std::f64::consts::PI * here.mass_per_length_kg_m);
        resolution(pose, root * root, added) >= target
    });
    Ok(enough.unwrap_or(MOST_MODES))
}

/// The number of modes with which to begin, and the one that is expected to do.
pub(super) fn guess(pose: &mut Pose, cost: &mut Cost) -> Result<(usize, usize), InvalidInput> {
    let target = FIRST * pose.tolerance.powf(-ORDER);
    let most = pose.source.most();
    let mut computed = (expected(pose, target)? + 2).min(most);
    let found = loop {
        let whole = pose.source.whole_m_n().unwrap_or(f64::INFINITY);
        let modes = pose.first(computed, cost)?.to_vec();
        let rigid = modes.iter().filter(|mode| mode.omega_rad_s == 0.0).count();
        let enough = (rigid + FEWEST + 1..=modes.len()).find(|&count| {
            let rest = (whole - compliance(&modes[..count])).max(0.0);
            let omega = modes[count - 1].omega_rad_s;
            resolution(pose, omega, 3.0 * rest * omega * omega) >= target
        });
        match enough {
            Some(count) => break count,
            None if computed >= most => break most,
            None => computed = (computed + computed / 4 + 1).min(most),
        }
    };
    Ok((((found as f64 / RAISE).round() as usize).max(1).min(found), found))
}

/// Raises the number of modes until the restitution has settled, or there are no more.
pub(super) fn settle(pose: &mut Pose, cost: &mut Cost) -> Result<Choice, InvalidInput> {
    let momentum = pose.striker.mass_kg * pose.striker.speed_m_s;
    let most = pose.source.most();
    let (first, mut count) = guess(pose, cost)?;
    let mut rungs = vec![Rung::new(pose, first, settings(pose.tolerance, 0), cost)?];
    let mut before = 0.0;
    loop {
        let next = Rung::new(pose, count, settings(pose.tolerance, rungs.len()), cost)?;
        let last = &rungs[rungs.len() - 1];
        let pair = last.solution.restitution.zip(next.solution.restitution);
        let flights = distance(&last.flights(momentum), &next.flights(momentum));
        let step = pair.map_or(1.0, |(a, b)| (a - b).abs());
        let weight = if rungs.len() < 2 { EARLIER } else { EARLIER_LATE };
        let change = step.max(FLIGHTS * flights);
        let mut uncertainty = CAUTION * change.max(weight * before) + 0.5 * next.settings.tolerance;
        before = change;
        // after several contacts, two impacts may agree and lack the same further contact: ask a third
        let several = next.solution.sub_impacts.len() > 1 && rungs.len() < 2;
        let settled = uncertainty <= pose.tolerance && pair.is_some() && !several;
        let limit = next.solution.outcome == Outcome::LimitReached;
        let tolerance = next.settings.tolerance;
        rungs.push(next);
        let raised = ((count as f64 * RAISE).round() as usize).min(most);
        // with all modes of a list, the solver alone is in doubt
        let solver_left = matches!(pose.source, Source::Listed { .. }) && tolerance > SOLVER_RANGE.0;
        if !settled && !limit && (raised as f64 >= LEAST_RAISE * count as f64 || solver_left) {
            count = raised;
            continue;
        }
        let values: Vec<f64> = rungs.iter().rev().take(SPREAD).filter_map(|rung| rung.solution.restitution).collect();
        let (low, high) = values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), e| (l.min(*e), h.max(*e)));
        let spread = (!settled && values.len() > 1).then_some(high - low);
        let counts: Vec<String> = rungs.iter().map(|rung| rung.count.to_string()).collect();
        let counts = counts.join(", ");
        let (Some(last), size) = (rungs.pop(), values.len()) else { continue };
        let reason = match spread {
            _ if settled => format!(
                "modal: with {counts} modes the last change of the restitution is {} and no flight between contacts \
                 changes its speed by more than {} of the speed of impact",
                small(step),
                small(flights)
            ),
            Some(spread) => format!(
                "modal: the restitution does not settle within {} with {counts} modes{}; over the last {size} it \
                 spreads by {}",
                small(pose.tolerance),
                lightly_damped(pose),
                small(spread)
            ),
            None => format!("modal: the computation reached its limit of steps with {counts} modes"),
        };
        if let Some(spread) = spread {
            uncertainty = uncertainty.max(spread);
        }
        let impact = Impact {
            structure: last.structure,
            striker: pose.striker,
            law: pose.law,
            start: None,
            settings: last.settings,
        };
        let known = Known { uncertainty: Some(uncertainty.min(1.0)), settled, spread };
        return Ok(Choice::modal(pose.tolerance, impact, last.solution, known, reason));
    }
}

fn lightly_damped(pose: &mut Pose) -> &'static str {
    let modes = match &pose.source {
        Source::Beam { modes, .. } | Source::Listed { modes, .. } => modes,
    };
    match modes.iter().map(|mode| mode.damping_ratio).fold(0.0, f64::max) {
        0.0 => " (nothing damps the structure)",
        damping if damping < 0.01 => " (the structure is lightly damped)",
        _ => "",
    }
}

/// The modes as they are stated, or all that a list has.
pub(super) fn stated(scene: &Scene, kept: &mut Kept, cost: &mut Cost) -> Result<Choice, InvalidInput> {
    let chosen = chooses_modes(scene);
    // without an approach the number of modes does not matter
    let impact = scene.impact_of(if chosen { Some(0) } else { scene.modes.count() }, kept)?;
    let solver = kept.solver(&impact.structure)?;
    let start = impact.start.as_ref();
    let solution = solver.solve(&impact.striker, &impact.law, start, &impact.settings).map_err(in_scene)?;
    let count = impact.structure.modes.len();
    cost.add(&solution.counts, count);
    let reason = match scene.modes {
        Modes::Count(_) => format!("modal: the {count} modes stated"),
        Modes::Auto if chosen => "modal: the striker does not approach".to_owned(),
        Modes::Auto if impact.structure.residual_compliance_m_n > 0.0 => {
            format!("modal: all {count} modes listed, and the static compliance of the others")
        }
        Modes::Auto => format!(
            "modal: all {count} modes listed; what further modes would change is not known without the \
             structure's static compliance"
        ),
    };
    let tolerance = impact.settings.tolerance;
    let uncertainty = solution.restitution_uncertainty;
    let wanted = scene.tolerance.map_or(DEFAULT_TOLERANCE, |tolerance| 10.0 * tolerance);
    let settled = uncertainty.is_some_and(|u| u <= wanted);
    let known = Known { uncertainty, settled, spread: uncertainty.filter(|_| !settled) };
    Ok(Choice::modal(tolerance, impact, solution, known, reason))
}

/// How well the restitution is known.
struct Known {
    uncertainty: Option<f64>,
    settled: bool,
    spread: Option<f64>,
}

impl Choice {
    fn modal(tolerance: f64, impact: Impact, solution: Solution, known: Known, reason: String) -> Choice {
        let answer = Answer {
            model: Model::Modal,
            outcome: solution.outcome.as_str(),
            restitution: solution.restitution,
            restitution_uncertainty: known.uncertainty.filter(|_| solution.restitution.is_some()),
            tolerance,
            sub_impact_count: Some(solution.sub_impacts.len()),
            modes: impact.structure.modes.len(),
            residual_compliance_m_n: impact.structure.residual_compliance_m_n,
            settled: known.settled,
            spread: known.spread,
            reason,
            cost: Cost::default(),
        };
        Choice { answer, impact: Some(impact) }
    }
}

#[cfg(test)]
mod tests {
    use super::distance;

    #[test]
    fn impacts_are_as_far_apart_as_their_flights() {
        assert_eq!(distance(&[], &[]), 0.0);
        assert_eq!(distance(&[1.0, 1.5], &[1.0, 1.5]), 0.0);
        // a third contact that changes nothing in the end
        assert_eq!(distance(&[1.0, 1.5], &[1.0, 1.25, 1.5]), 0.25);
        assert_eq!(distance(&[1.0], &[]), f64::INFINITY);
    }
}
