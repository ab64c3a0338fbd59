//! Solves an impact from first touch until it is certain that the bodies never meet again.

use super::history::{History, Recorded, all_modes};
use super::posed;
use super::problem::{Mode, Settings, Start, Striker, Structure};
use super::solution::{Counts, Outcome, Solution, SubImpact};
use super::time_unit;
use crate::StopReason;
use crate::assembly::dense::Stretch;
use crate::assembly::responses::Responses;
use crate::assembly::solve::follow;
use crate::assembly::system::System;
use crate::assembly::tables::Tables;
use crate::assembly::{self, Assembly, Interval, Ledger, Observer};
use contact_models::ContactLaw;
use invalid_input::InvalidInput;
use std::fmt;
use std::sync::OnceLock;

/// Loosest tolerance of a solution. At looser tolerances the steps, and thus the costs, hardly differ any more, and their errors
/// would not be noticed.
pub(crate) const LOOSEST: f64 = 1e-4;
/// Factors of the tolerance for the coarser solutions that give the uncertainty: in the same unit of time, in
/// another one, and a third where these differ by more than the tolerance.
const COARSER: f64 = 32.0;
const OTHERWISE: f64 = 8.0;
const THIRD: f64 = 8.0;
/// Factors from the difference to the uncertainty, without and with the third solution, and the share of the tolerance that is
/// always added.
const ORDINARY: f64 = 2.5;
const AMPLIFIED: f64 = 5.0;
const LEAST: f64 = 3e-3;

/// Solves impacts on one structure. Tables of the structure are built as they are needed and kept, so that further
/// strikers, speeds and laws cost less. Threads may share one solver: each finds, to the last bit, what it would find alone.
///
/// ```
/// use vibroimpact_sim::modal::{Mode, Outcome, Settings, Solver, Start, Striker, Structure};
/// use contact_models::Hertz;
///
/// // one mode at 50 Hz of a 1 kg beam, hit at its middle by a ball of 0.1 kg
/// let mode = Mode { omega_rad_s: 314.0, damping_ratio: 0.02, shape: 2f64.sqrt() };
/// let structure = Structure { modes: vec![mode] };
/// let solver = Solver::new(&structure)?;
/// let ball = Striker { mass_kg: 0.1, speed_m_s: 1.0 };
/// let law = Hertz::new(1.8e10).unwrap();
/// let solution = solver.solve(&ball, &law, None, &Settings::default())?;
/// assert_eq!(solution.outcome, Outcome::Rebound);
/// // as two rigid bodies of 0.1 kg and 0.5 kg: (1 - 0.2) / (1 + 0.2)
/// assert!((solution.restitution.unwrap() - 2.0 / 3.0).abs() < 1e-3);
/// # Ok::<(), vibroimpact_sim::InvalidInput>(())
/// ```
pub struct Solver {
    modes: Vec<Mode>,
    /// Those that move the contact.
    moved: Vec<usize>,
    /// Tables of the structure with a striker, and with a stop at rest, which adds no mode.
    tables: [OnceLock<Tables>; 2],
    /// The same structure in another unit of time, once it was needed.
    otherwise: OnceLock<Box<Solver>>,
}

/// An impact to be solved.
#[derive(Clone, Copy)]
pub(crate) struct Impact<'a> {
    pub striker: &'a Striker,
    pub law: &'a dyn ContactLaw,
    pub start: &'a Start,
    pub settings: &'a Settings,
}

/// An impact as an assembly, for all runs of it.
struct Lowered {
    assembly: Assembly<()>,
    system: System,
    responses: Responses,
}

/// What is kept of a run beside its result.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Keep {
    Result,
    /// The whole motion.
    Motion,
    /// The same, with the energy ledger.
    Record,
}

/// One run at one tolerance.
pub(crate) struct Run {
    pub outcome: Outcome,
    end_s: f64,
    sub_impacts: Vec<SubImpact>,
    striker_velocity_m_s: f64,
    amplitude: Vec<f64>,
    rate: Vec<f64>,
    counts: Counts,
    contact_work_j: f64,
    energy: Option<Ledger>,
    pub stretches: Vec<Stretch>,
}

/// Collects the intervals of contact.
struct Watch {
    intervals: Vec<Interval>,
    records: bool,
}

impl Observer for Watch {
    fn interval(&mut self, _: usize, interval: &Interval) {
        self.intervals.push(*interval);
    }

    fn wants_energy(&self) -> bool {
        self.records
    }
}

impl fmt::Debug for Solver {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Solver").field("modes", &self.modes).finish_non_exhaustive()
    }
}

impl Solver {
    /// A solver for a structure; builds no table yet.
    ///
    /// # Errors
    /// Names the field, its value and what would be allowed.
    pub fn new(structure: &Structure) -> Result<Solver, InvalidInput> {
        structure.check()?;
        Ok(Solver::unchecked(structure.modes.clone()))
    }

    /// Turns to another location of the same structure, or to a structure of other modes. Tables that do not depend on the
    /// shapes are kept where frequencies and damping are the same; results are those of a new solver, to the last bit.
    ///
    /// # Errors
    /// As [`Solver::new`].
    pub fn turn_to(&mut self, structure: &Structure) -> Result<(), InvalidInput> {
        structure.check()?;
        self.turn_to_modes(structure.modes.clone());
        Ok(())
    }

    fn turn_to_modes(&mut self, modes: Vec<Mode>) {
        if let Some(otherwise) = self.otherwise.get_mut() {
            otherwise.turn_to_modes(time_unit::modes(&modes));
        }
        let moved = moved(&modes);
        let same = moved.len() == self.moved.len()
            && moved.iter().zip(&self.moved).all(|(new, old)| modes[*new].of_body() == self.modes[*old].of_body());
        if same {
            self.tables.iter_mut().filter_map(OnceLock::get_mut).for_each(Tables::change_weights);
        } else {
            self.tables = Default::default();
        }
        (self.modes, self.moved) = (modes, moved);
    }

    fn unchecked(modes: Vec<Mode>) -> Solver {
        Solver { moved: moved(&modes), modes, tables: Default::default(), otherwise: OnceLock::new() }
    }

    /// Solves one impact. `start` is the structure's motion at the start; `None` means at rest and touching.
    ///
    /// # Errors
    /// Names the field, its value and what would be allowed, for input that poses no impact problem.
    pub fn solve(
        &self,
        striker: &Striker,
        law: &dyn ContactLaw,
        start: Option<&Start>,
        settings: &Settings,
    ) -> Result<Solution, InvalidInput> {
        Ok(self.solve_into(striker, law, start, settings, Keep::Result)?.0)
    }

    /// Solves one impact and keeps its whole history.
    ///
    /// # Errors
    /// As [`Solver::solve`].
    pub fn record<L: ContactLaw + Clone>(
        &self,
        striker: &Striker,
        law: &L,
        start: Option<&Start>,
        settings: &Settings,
    ) -> Result<(Solution, History<L>), InvalidInput> {
        let (solution, run) = self.solve_into(striker, law, start, settings, Keep::Record)?;
        let start = start.cloned().unwrap_or_else(|| Start::at_rest(self.modes.len()));
        let recorded = Recorded {
            modes: self.modes.clone(),
            moved: self.moved.clone(),
            striker: *striker,
            contact_work_j: run.contact_work_j,
            damping_j: run.energy.map_or(0.0, |ledger| ledger.modal_damping_j),
            law: law.clone(),
            system: System::new(&posed::assembly(&self.modes, &self.moved, striker, &start).with_laws(Vec::new())),
            start,
            stretches: run.stretches,
        };
        let history = History::new(recorded, &solution);
        Ok((solution, history))
    }

    pub(crate) fn solve_into(
        &self,
        striker: &Striker,
        law: &dyn ContactLaw,
        start: Option<&Start>,
        settings: &Settings,
        keep: Keep,
    ) -> Result<(Solution, Run), InvalidInput> {
        striker.check()?;
        settings.check()?;
        let at_rest;
        let start = match start {
            Some(start) => start,
            None => {
                at_rest = Start::at_rest(self.modes.len());
                &at_rest
            }
        };
        start.check(self.modes.len())?;
        InvalidInput::unless(
            striker.mass_kg.is_finite() || !self.moved.is_empty(),
            "mass_kg",
            striker.mass_kg,
            "a finite mass, where no mode of the structure moves at the contact",
        )?;

        let impact = Impact { striker, law, start, settings };
        let mut lowered = self.lower(&impact);
        let mut run = self.run_lowered(&impact, &mut lowered, settings.tolerance.min(LOOSEST), keep);
        let mut counts = run.counts;
        let restitution = self.restitution(&run, striker, start);
        let restitution_uncertainty = restitution
            .filter(|_| settings.estimate_uncertainty)
            .map(|value| self.uncertainty(value, &impact, &mut lowered, &mut counts));
        let solution = Solution {
            outcome: run.outcome,
            restitution,
            restitution_uncertainty,
            sub_impacts: std::mem::take(&mut run.sub_impacts),
            counts,
            end_s: run.end_s,
            striker_velocity_m_s: run.striker_velocity_m_s,
            amplitude: std::mem::take(&mut run.amplitude),
            rate: std::mem::take(&mut run.rate),
        };
        Ok((solution, run))
    }

    /// How far off the restitution may be, from solutions of the same impact. One that ends otherwise says that nothing is
    /// certain.
    fn uncertainty(&self, value: f64, impact: &Impact, lowered: &mut Lowered, counts: &mut Counts) -> f64 {
        let settings = impact.settings;
        let coarser = |factor: f64| factor * settings.tolerance.min(LOOSEST);
        let same = self.again(impact, lowered, coarser(COARSER), counts);
        let other = {
            let modes = &self.modes;
            let solver = self.otherwise.get_or_init(|| Box::new(Solver::unchecked(time_unit::modes(modes))));
            let (striker, start) = (time_unit::striker(impact.striker), time_unit::start(impact.start));
            let law = time_unit::Law(impact.law);
            let impact = Impact { striker: &striker, law: &law, start: &start, settings };
            solver.again(&impact, &mut solver.lower(&impact), coarser(OTHERWISE), counts)
        };
        let (Some(same), Some(other)) = (same, other) else { return 1.0 };
        let mut spread = (same - value).abs().max((other - value).abs());
        let mut times = ORDINARY;
        if spread > settings.tolerance {
            let Some(third) = self.again(impact, lowered, coarser(THIRD), counts) else { return 1.0 };
            (spread, times) = (spread.max((third - value).abs()), AMPLIFIED);
        }
        (LEAST * settings.tolerance + times * spread).min(f64::MAX)
    }

    /// The restitution of the same impact at another tolerance.
    fn again(&self, impact: &Impact, lowered: &mut Lowered, tolerance: f64, counts: &mut Counts) -> Option<f64> {
        let run = self.run_lowered(impact, lowered, tolerance, Keep::Result);
        *counts += run.counts;
        self.restitution(&run, impact.striker, impact.start)
    }

    pub(crate) fn modes(&self) -> &[Mode] {
        &self.modes
    }

    /// The same structure, in which these modes are moved by the contact.
    pub(crate) fn moving(&self, moved: Vec<usize>) -> Solver {
        Solver { moved, ..Solver::unchecked(self.modes.clone()) }
    }

    pub(crate) fn moved(&self) -> &[usize] {
        &self.moved
    }

    pub(crate) fn run(&self, impact: &Impact, tolerance: f64, keep: Keep) -> Run {
        self.run_lowered(impact, &mut self.lower(impact), tolerance, keep)
    }

    fn lower(&self, impact: &Impact) -> Lowered {
        let assembly = posed::assembly(&self.modes, &self.moved, impact.striker, impact.start);
        let system = System::new(&assembly.with_laws(Vec::new()));
        Lowered { assembly, system, responses: Responses::default() }
    }

    fn run_lowered(&self, impact: &Impact, lowered: &mut Lowered, tolerance: f64, keep: Keep) -> Run {
        let Impact { law, start, settings, .. } = *impact;
        let Lowered { assembly, system, responses } = lowered;
        let posed = assembly.with_laws(vec![law]);
        let wanted = assembly::Settings {
            end_s: f64::INFINITY,
            tolerance: tolerance.min(0.1),
            max_steps: settings.max_steps,
            max_intervals: settings.max_sub_impacts as u64,
            stop_at_rest: true,
            stop_when_over: true,
            rest_from_s: if keep == Keep::Record { settings.until_s } else { 0.0 },
        };
        let mut watch = Watch { intervals: Vec::new(), records: keep == Keep::Record };
        let tables = self.tables[usize::from(posed.bodies.len() == 1)].get_or_init(|| Tables::new(system));
        let (run, stretches) = follow(&posed, (system, tables, responses), &wanted, &mut watch, keep != Keep::Result);
        let closed = watch.intervals.last().is_some_and(|last| last.end_s.is_none());
        let outcome = match run.outcome {
            assembly::Outcome::Parted if watch.intervals.is_empty() => Outcome::NoContact,
            assembly::Outcome::Parted => Outcome::Rebound,
            assembly::Outcome::Rest | assembly::Outcome::End => Outcome::Sustained,
            assembly::Outcome::Stopped(reason) => Outcome::Stopped(stop_reason(reason, closed)),
        };
        let of = |interval: &Interval| SubImpact {
            start_s: interval.start_s,
            end_s: interval.end_s.unwrap_or(run.end_s),
            impulse_n_s: interval.impulse_n_s,
            peak_force_n: interval.peak_force_n,
            peak_compression_m: interval.peak_compression_m,
        };
        let (amplitude, rate) =
            all_modes(&self.modes, &self.moved, start, run.end_s, (&run.amplitude[0], &run.rate[0]));
        Run {
            outcome,
            end_s: run.end_s,
            sub_impacts: watch.intervals.iter().map(of).collect(),
            striker_velocity_m_s: run.contacts[0].velocity_m_s[0],
            amplitude,
            rate,
            counts: run.counts,
            contact_work_j: run.contacts[0].statistics.work_j,
            energy: run.energy,
            stretches,
        }
    }

    pub(crate) fn restitution(&self, run: &Run, striker: &Striker, start: &Start) -> Option<f64> {
        let rigid = |rate: &[f64]| {
            let rigid = self.modes.iter().zip(rate).filter(|(mode, _)| mode.is_rigid());
            rigid.map(|(mode, rate)| mode.shape * rate).sum::<f64>()
        };
        let before = striker.speed_m_s + rigid(&start.rate);
        let ended = matches!(run.outcome, Outcome::Rebound | Outcome::Sustained);
        let free = striker.mass_kg.is_finite() || self.modes.iter().any(|mode| mode.is_rigid() && mode.is_excited());
        let ratio = (run.striker_velocity_m_s - rigid(&run.rate)) / before;
        // an approach of 1e-310 m/s on a structure that moves has no ratio to speak of
        (ended && before > 0.0 && free && ratio.is_finite()).then_some(ratio)
    }
}

/// Those of the modes that move the contact.
fn moved(modes: &[Mode]) -> Vec<usize> {
    (0..modes.len()).filter(|&k| modes[k].is_excited()).collect()
}

fn stop_reason(reason: assembly::Reason, closed: bool) -> StopReason {
    match reason {
        assembly::Reason::Steps if closed => StopReason::Steps,
        assembly::Reason::Steps | assembly::Reason::Interrupted => StopReason::Flight,
        assembly::Reason::Intervals => StopReason::SubImpacts,
        assembly::Reason::FinestStep => StopReason::FinestStep,
        assembly::Reason::LawRange => StopReason::LawRange,
        assembly::Reason::Chatter => StopReason::DigitsExhausted,
        assembly::Reason::Law => StopReason::Law,
    }
}
