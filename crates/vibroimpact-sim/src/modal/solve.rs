//! Solves an impact from first touch until it is certain that the bodies never meet again.

use super::fall::{Fall, check_gravity};
use super::history::{History, all_modes};
use super::posed;
use super::problem::{Mode, SPEED_MIN, Settings, Start, Striker, Structure, approach, mobility, moved, rigid_motion};
use super::recording::{Recording, work_and_damping_j};
use super::restitutions::{Restitutions, judge_peaks, uncertainty};
use super::solution::{Counts, Outcome, Solution, SubImpact};
use crate::StopReason;
use crate::assembly::load::Loads;
use crate::assembly::responses::Responses;
use crate::assembly::solve::{Keep, follow};
use crate::assembly::system::System;
use crate::assembly::tables::Tables;
use crate::assembly::{self, Assembly, Interval, Observer};
use crate::concurrent::both;
use crate::panel::dyadic::Steps;
use contact_models::ContactLaw;
use invalid_input::InvalidInput;
use std::fmt;
use std::sync::{Arc, OnceLock};

/// Loosest tolerance of a solution. At looser tolerances the steps, and thus the costs, hardly differ any more, and their errors
/// would not be noticed.
pub(crate) const LOOSEST: f64 = 1e-4;
/// Steps of the solutions, the first of which is the answer, and factors of their tolerances. The coarser ones give the uncertainty.
/// No two share a step.
pub(crate) const SOLUTIONS: [(Steps, f64); 3] =
    [(Steps::OF_SECOND, 1.0), (Steps::HALFWAY, 16.0), (Steps::QUARTER_WAY, 8.0)];
/// The answer, and the coarser solution along which derivatives are computed as well.
pub(crate) const ANSWER: usize = 0;
pub(crate) const BESIDE: usize = 1;
/// Factor of the tolerance of a further solution in the steps of the answer, where these differ by more than the tolerance or in the
/// number of their contacts.
const FURTHER: f64 = 8.0;
/// Factor of the difference from the further solution.
const TWICE: f64 = 2.0;
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
    gravity_m_s2: f64,
    /// Indices of the modes that are solved for: those that the contact excites. The others move freely.
    moved: Vec<usize>,
    /// Tables for each of the solutions, with a striker and with a stop at rest, which adds no mode.
    tables: [[OnceLock<Arc<Tables>>; 2]; SOLUTIONS.len()],
    /// The same structure with every mode that moves the contact at all, for motion before the impact.
    whole: OnceLock<Box<Solver>>,
}

/// An impact to be solved.
#[derive(Clone, Copy)]
pub(crate) struct Impact<'a> {
    pub striker: &'a Striker,
    pub law: &'a dyn ContactLaw,
    pub start: &'a Start,
    pub settings: &'a Settings,
    pub fall: Option<Fall>,
}

/// An impact as an assembly, for all runs of it.
pub(crate) struct Lowered {
    pub assembly: Assembly<()>,
    pub system: System,
}

impl Lowered {
    fn loads(&self) -> Loads {
        Loads::new(&self.assembly.loads, &self.system)
    }
}

/// One run at one tolerance.
pub(crate) struct Run {
    pub outcome: Outcome,
    end_s: f64,
    sub_impacts: Vec<SubImpact>,
    striker_displacement_m: f64,
    striker_velocity_m_s: f64,
    amplitude: Vec<f64>,
    rate: Vec<f64>,
    counts: Counts,
    pub record: assembly::solve::Record,
}

/// A solved impact.
pub(crate) struct Solved {
    pub solution: Solution,
    pub run: Run,
    /// The first of the coarser solutions, with its motion if the nearest miss is kept; `None` if no uncertainty was requested.
    pub coarser: Option<Run>,
    lowered: Lowered,
    fall: Option<Fall>,
    /// Work of the contact and loss by damping in the run, if computed while coarser problems were solved in another thread (J).
    work_and_damping_j: Option<[f64; 2]>,
}

/// Collects the intervals of contact.
struct Watch(Vec<Interval>);

impl Observer for Watch {
    fn interval(&mut self, _: usize, interval: &Interval) {
        self.0.push(*interval);
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
        Ok(Solver::of(structure.modes.clone(), moved(&structure.modes, None)))
    }

    /// The same for strikers that fall on the structure, in the direction of their speed. Each impact ends with the first flight that
    /// rises above the undeflected structure by more than a hundredth of the height of the fall. The restitution is that of a drop test:
    /// the speed that belongs to the height of this rebound, over the speed of impact. It is 0, and the contact sustained, if there is no
    /// such flight for the time of four rebounds without losses and of four of the slowest vibrations, nor for four times the duration of
    /// the first contact. 0 leaves gravity out, as by default.
    ///
    /// # Errors
    /// If the acceleration of gravity (m/s^2) is neither 0 nor from 1e-30 to 1e30. An impact under gravity is refused if the striker is
    /// an immovable stop or does not fall, or if the structure has a rigid-body mode and would fall as well.
    ///
    /// ```
    /// use contact_models::Hertz;
    /// use vibroimpact_sim::modal::{Mode, Settings, Solver, Striker, Structure};
    ///
    /// // a ball of 0.1 kg on a soft beam, which throws it up slowly
    /// let structure = Structure { modes: vec![Mode { omega_rad_s: 20.0, damping_ratio: 0.02, shape: 3.0 }] };
    /// let (ball, law) = (Striker { mass_kg: 0.1, speed_m_s: 1.0 }, Hertz::new(1e9).unwrap());
    /// let restitution = |gravity_m_s2| {
    ///     let solver = Solver::new(&structure)?.under_gravity(gravity_m_s2)?;
    ///     Ok::<_, vibroimpact_sim::InvalidInput>(solver.solve(&ball, &law, None, &Settings::default())?.restitution)
    /// };
    /// assert!(restitution(0.0)?.unwrap() != restitution(9.81)?.unwrap());
    /// # Ok::<(), vibroimpact_sim::InvalidInput>(())
    /// ```
    pub fn under_gravity(self, gravity_m_s2: f64) -> Result<Solver, InvalidInput> {
        check_gravity(gravity_m_s2)?;
        Ok(if gravity_m_s2 == self.gravity_m_s2 {
            self
        } else {
            Solver { gravity_m_s2, whole: OnceLock::new(), ..self }
        })
    }

    /// Turns to another location of the same structure, or to a structure of other modes. Tables that do not depend on the
    /// shapes are kept where frequencies and damping are the same; results are those of a new solver, to the last bit.
    ///
    /// # Errors
    /// As [`Solver::new`].
    pub fn turn_to(&mut self, structure: &Structure) -> Result<(), InvalidInput> {
        structure.check()?;
        self.turn_to_modes(structure.modes.clone(), moved(&structure.modes, None));
        Ok(())
    }

    fn turn_to_modes(&mut self, modes: Vec<Mode>, moved: Vec<usize>) {
        let same = moved.len() == self.moved.len()
            && moved.iter().zip(&self.moved).all(|(new, old)| modes[*new].of_body() == self.modes[*old].of_body());
        if same {
            for kept in self.tables.iter_mut().flatten() {
                match kept.get_mut().map(Arc::get_mut) {
                    Some(Some(tables)) => tables.change_weights(),
                    // a recording has them, too
                    _ => *kept = OnceLock::new(),
                }
            }
        } else {
            self.tables = Default::default();
        }
        (self.modes, self.moved, self.whole) = (modes, moved, OnceLock::new());
    }

    fn of(modes: Vec<Mode>, moved: Vec<usize>) -> Solver {
        Solver { moved, modes, gravity_m_s2: 0.0, tables: Default::default(), whole: OnceLock::new() }
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
        Ok(self.starting(start).solve_into(striker, law, start, settings, Keep::Result)?.solution)
    }

    /// Solves one impact and keeps its motion.
    ///
    /// # Errors
    /// As [`Solver::solve`].
    pub fn solve_and_keep(
        &self,
        striker: &Striker,
        law: &dyn ContactLaw,
        start: Option<&Start>,
        settings: &Settings,
    ) -> Result<Recording, InvalidInput> {
        let solver = self.starting(start);
        let start = start.cloned().unwrap_or_else(|| Start::at_rest(self.modes.len()));
        let Solved { solution, run, lowered, fall, work_and_damping_j, .. } =
            solver.solve_into(striker, law, Some(&start), settings, Keep::Motion)?;
        Ok(Recording {
            solution,
            counts: run.counts,
            modes: solver.modes.clone(),
            moved: solver.moved.clone(),
            striker: *striker,
            start,
            record: run.record,
            tables: Arc::clone(solver.tables(&lowered.system, ANSWER)),
            work_and_damping_j,
            fall,
            loads: lowered.loads(),
            system: lowered.system,
        })
    }

    /// Solves one impact, with its whole history.
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
        Ok(self.solve_and_keep(striker, law, start, settings)?.history(law.clone()))
    }

    pub(crate) fn solve_into(
        &self,
        striker: &Striker,
        law: &dyn ContactLaw,
        start: Option<&Start>,
        settings: &Settings,
        keep: Keep,
    ) -> Result<Solved, InvalidInput> {
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
            "finite, because no mode of the structure moves at the contact",
        )?;

        let fall = Fall::new(self.gravity_m_s2, &self.modes, striker, start)?;
        let impact = Impact { striker, law, start, settings, fall };
        let (lowered, mut responses) = (self.lower(&impact), Responses::default());
        let Settings { estimate_uncertainty, concurrent, .. } = *settings;
        let mut solve = |factor: f64, keep| self.run(&impact, &lowered, (ANSWER, &mut responses), factor, keep);
        let (mut beside, mut run, work_and_damping_j) = if estimate_uncertainty && concurrent {
            let solve_and_book = || {
                let run = solve(1.0, keep);
                let system = &lowered.system;
                let book = || work_and_damping_j(system, &lowered.loads(), &run.record, self.tables(system, ANSWER));
                let booked = (keep == Keep::Motion).then(book);
                (run, booked)
            };
            let (coarser, (run, booked)) = both(true, || self.coarser(&impact, &lowered, keep), solve_and_book);
            (Some(coarser), run, booked)
        } else {
            (None, solve(1.0, keep), None)
        };
        let mut counts = run.counts;
        let restitution = self.restitution(&run, &impact);
        let known = if estimate_uncertainty { self.restitutions(&run, &impact) } else { None };
        let restitution_uncertainty = known.and_then(|known| {
            let coarser = beside.get_or_insert_with(|| self.coarser(&impact, &lowered, keep));
            let further = || solve(FURTHER, Keep::Result);
            self.uncertainty(&known, coarser, &impact, further, &mut run.sub_impacts, &mut counts)
        });
        let solution = Solution {
            outcome: run.outcome,
            restitution,
            restitution_uncertainty,
            sub_impacts: std::mem::take(&mut run.sub_impacts),
            counts,
            end_s: run.end_s,
            striker_displacement_m: run.striker_displacement_m,
            striker_velocity_m_s: run.striker_velocity_m_s,
            until_touch_s: run.record.until_touch_s,
            highest_flight: impact.fall.map_or(f64::NEG_INFINITY, |fall| fall.share(run.record.highest_m)),
            amplitude: std::mem::take(&mut run.amplitude),
            rate: std::mem::take(&mut run.rate),
        };
        let coarser = beside.into_iter().flatten().next().map(|(run, _)| run);
        Ok(Solved { solution, run, coarser, lowered, fall, work_and_damping_j })
    }

    /// Coarser solutions of the same impact in other steps, up to the first without a restitution. The motion of the first is kept
    /// for derivatives.
    fn coarser(&self, impact: &Impact, lowered: &Lowered, keep: Keep) -> Vec<(Run, Option<Restitutions>)> {
        let mut found = Vec::with_capacity(SOLUTIONS.len());
        for (which, (_, factor)) in SOLUTIONS.into_iter().enumerate().skip(BESIDE) {
            let keep = if which == BESIDE && keep == Keep::NearestMiss { Keep::Motion } else { Keep::Result };
            let run = self.run(impact, lowered, (which, &mut Responses::default()), factor, keep);
            let restitutions = self.restitutions(&run, impact);
            let ends = restitutions.is_none();
            found.push((run, restitutions));
            if ends {
                break;
            }
        }
        found
    }

    /// The coarser solution along which derivatives are computed.
    pub(crate) fn beside(&self, impact: &Impact, lowered: &Lowered) -> Run {
        self.run(impact, lowered, (BESIDE, &mut Responses::default()), SOLUTIONS[BESIDE].1, Keep::Motion)
    }

    /// Estimated error of the restitution, from coarser solutions of the same impact and, where it is needed, a further one: `None` if
    /// one of them stopped at a limit, and 1 if one ended without a restitution. If all have one, those of the largest forces follow
    /// from the same solutions.
    fn uncertainty(
        &self,
        known: &Restitutions,
        coarser: &[(Run, Option<Restitutions>)],
        impact: &Impact,
        further: impl FnOnce() -> Run,
        sub_impacts: &mut [SubImpact],
        counts: &mut Counts,
    ) -> Option<f64> {
        let without = |run: &Run| if run.outcome.stopped_by().is_some() { None } else { Some(1.0) };
        let tolerance = impact.settings.tolerance.min(LOOSEST);
        let (mut spread, mut same_contacts) = (0.0f64, true);
        for (run, coarser) in coarser {
            *counts += run.counts;
            let Some(coarser) = coarser else { return without(run) };
            spread = spread.max(known.difference(coarser));
            same_contacts &= known.contacts() == coarser.contacts();
        }
        let mut others: Vec<(&[SubImpact], f64)> = coarser.iter().map(|(run, _)| (&run.sub_impacts[..], 1.0)).collect();
        let run;
        if spread > tolerance || !same_contacts {
            run = further();
            *counts += run.counts;
            let Some(further) = self.restitutions(&run, impact) else { return without(&run) };
            spread = spread.max(TWICE * known.difference(&further));
            others.push((&run.sub_impacts, TWICE));
        }
        judge_peaks(sub_impacts, &others, tolerance);
        Some(uncertainty(spread, known.contacts(), tolerance))
    }

    /// The tables of a solution for a system of the structure, with or without a striker.
    fn tables(&self, system: &System, which: usize) -> &Arc<Tables> {
        self.tables[which][usize::from(system.bodies.len() == 1)]
            .get_or_init(|| Arc::new(Tables::new(system, SOLUTIONS[which].0)))
    }

    /// The solver for this motion before the impact: by it, modes can move the contact that the contact does not excite.
    fn starting(&self, start: Option<&Start>) -> &Solver {
        if start.is_none() || moved(&self.modes, start) == self.moved {
            return self;
        }
        let all = || (0..self.modes.len()).filter(|k| self.modes[*k].is_moved()).collect();
        self.whole.get_or_init(|| Box::new(self.moving(all())))
    }

    pub(crate) fn modes(&self) -> &[Mode] {
        &self.modes
    }

    pub(crate) fn gravity_m_s2(&self) -> f64 {
        self.gravity_m_s2
    }

    /// The same structure, in which these modes are moved by the contact.
    pub(crate) fn moving(&self, moved: Vec<usize>) -> Solver {
        Solver { gravity_m_s2: self.gravity_m_s2, ..Solver::of(self.modes.clone(), moved) }
    }

    pub(crate) fn moved(&self) -> &[usize] {
        &self.moved
    }

    pub(crate) fn lower(&self, impact: &Impact) -> Lowered {
        let weight = impact.fall.as_ref().map(Fall::weight);
        let assembly = posed::assembly((&self.modes, &self.moved), impact.striker, impact.start, weight);
        let system = System::new(&assembly.with_laws(Vec::new()));
        Lowered { assembly, system }
    }

    /// One run in the steps of one of the solutions, with so many times the tolerance.
    fn run(
        &self,
        impact: &Impact,
        lowered: &Lowered,
        (which, responses): (usize, &mut Responses),
        factor: f64,
        keep: Keep,
    ) -> Run {
        let Impact { law, start, settings, fall, .. } = *impact;
        let Lowered { assembly, system } = lowered;
        let posed = assembly.with_laws(vec![law]);
        let wanted = assembly::Settings {
            end_s: fall.map_or(f64::INFINITY, |fall| fall.end_s()),
            tolerance: (factor * settings.tolerance.min(LOOSEST)).min(0.1),
            max_steps: settings.max_steps,
            max_intervals: settings.max_sub_impacts as u64,
            stop_at_rest: true,
            stop_when_over: true,
            over_above_m: fall.map_or(f64::INFINITY, |fall| fall.rebound_above_m()),
            rest_from_s: if keep == Keep::Result { 0.0 } else { settings.until_s },
            statistics_from_s: 0.0,
        };
        let mut watch = Watch(Vec::new());
        let tables = self.tables(system, which);
        let (run, record) = follow(&posed, (system, tables, responses), &wanted, &mut watch, keep);
        let Watch(intervals) = watch;
        let closed = intervals.last().is_some_and(|last| last.end_s.is_none());
        let outcome = match run.outcome {
            assembly::Outcome::Parted if intervals.is_empty() => Outcome::NoContact,
            assembly::Outcome::Parted => Outcome::Rebound,
            assembly::Outcome::Rest | assembly::Outcome::End => Outcome::Sustained,
            assembly::Outcome::Stopped(reason) => Outcome::Stopped(stop_reason(reason, closed)),
        };
        let of = |interval: &Interval| SubImpact {
            start_s: interval.start_s,
            end_s: interval.end_s.unwrap_or(run.end_s),
            impulse_n_s: interval.impulse_n_s,
            peak_force_n: interval.peak_force_n,
            peak_force_uncertainty_n: None,
            peak_compression_m: interval.peak_compression_m,
        };
        let (amplitude, rate) =
            all_modes(&self.modes, &self.moved, start, run.end_s, (&run.amplitude[0], &run.rate[0]));
        Run {
            outcome,
            end_s: run.end_s,
            sub_impacts: intervals.iter().map(of).collect(),
            striker_displacement_m: run.contacts[0].displacement_m[0],
            striker_velocity_m_s: run.contacts[0].velocity_m_s[0],
            amplitude,
            rate,
            counts: run.counts,
            record,
        }
    }

    fn restitution(&self, run: &Run, impact: &Impact) -> Option<f64> {
        let Impact { striker, fall, .. } = *impact;
        let before = self.approach_m_s(impact);
        let free = striker.mass_kg.is_finite() || self.modes.iter().any(|mode| mode.is_rigid() && mode.is_moved());
        let known = before >= SPEED_MIN && free;
        match (run.outcome, fall) {
            // the bodies stay together, whatever is left of their motion
            (Outcome::Sustained, _) => known.then_some(0.0),
            (Outcome::Rebound, Some(fall)) => {
                Some(fall.restitution(run.striker_displacement_m, run.striker_velocity_m_s))
            }
            (Outcome::Rebound, None) => {
                let separation = run.striker_velocity_m_s - rigid_motion(&self.modes, &run.rate);
                known.then(|| separation / before)
            }
            _ => None,
        }
    }

    /// Speed with which the bodies meet.
    pub(crate) fn approach_m_s(&self, impact: &Impact) -> f64 {
        impact.fall.map_or_else(|| approach(&self.modes, impact.striker, impact.start), |fall| fall.arrives_m_s())
    }

    /// The restitution of a run, with those that an end after each contact would have had.
    fn restitutions(&self, run: &Run, impact: &Impact) -> Option<Restitutions> {
        let last = self.restitution(run, impact)?;
        let (mobility, approach) = (mobility(&self.modes, impact.striker), self.approach_m_s(impact));
        let by = |impulse_n_s: f64| mobility * impulse_n_s / approach - 1.0;
        let of_stay = impact.fall.filter(|_| run.outcome == Outcome::Sustained);
        let would_be = of_stay.map(|fall| fall.restitution(run.record.highest_m, 0.0));
        Some(Restitutions::new(&run.sub_impacts, by, last, would_be))
    }
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
