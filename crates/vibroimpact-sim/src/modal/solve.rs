//! From first touch to the certainty that the bodies never meet again.

use super::contact::{Contact, ContactEnd, Setting};
use super::flight::{FlightEnd, fly};
use super::history::History;
use super::ladder::{Ladder, Vibration};
use super::motion::{Motion, Piece};
use super::oscillator::propagate;
use super::problem::{Mode, Settings, Start, Striker, Structure};
use super::solution::{Counts, Outcome, Solution, SubImpact};
use super::time_unit;
use crate::{InvalidInput, StopReason};
use contact_models::{ContactLaw, Memory};

/// Part of the stated tolerance that one step may use up, as a share of the striker's momentum.
const STEP_SHARE: f64 = 0.1;
/// Looser tolerances than this make steps that hardly differ any more, and cost as much: what these get wrong would go
/// unnoticed.
const LOOSEST: f64 = 1e-4;
/// How much more coarsely than the solution those are computed that tell its uncertainty: in the same unit of time, in
/// another one, and a third where these differ by more than the tolerance.
const COARSER: f64 = 32.0;
const OTHERWISE: f64 = 8.0;
const THIRD: f64 = 8.0;
/// The uncertainty in differences to them: without and with the third; and what is stated of the tolerance in any case.
const ORDINARY: f64 = 2.5;
const AMPLIFIED: f64 = 5.0;
const LEAST: f64 = 3e-3;
/// By so much is the tolerance tightened where steps get stuck behind a compliance, down to this one.
const TIGHTER: f64 = 1e-2;
const TIGHT: f64 = 1e-9;

/// Solves impacts on one structure. Tables of the structure are built as they are needed and kept, so that further
/// strikers, speeds and laws cost less.
///
/// ```
/// use vibroimpact_sim::modal::{Mode, Outcome, Settings, Solver, Start, Striker, Structure};
/// use contact_models::Hertz;
///
/// // one mode at 50 Hz of a 1 kg beam, hit at its middle by a ball of 0.1 kg
/// let mode = Mode { omega_rad_s: 314.0, damping_ratio: 0.02, shape: 2f64.sqrt() };
/// let structure = Structure { modes: vec![mode], residual_compliance_m_n: 0.0 };
/// let mut solver = Solver::new(&structure)?;
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
    residual_compliance_m_n: f64,
    ladder: Ladder,
    /// Where each of the structure's modes went: its place on the ladder, if it is elastic and excited.
    place: Vec<Option<usize>>,
    /// The same structure in another unit of time, once it was needed.
    otherwise: Option<Box<Solver>>,
}

/// One run at one tolerance.
struct Run {
    outcome: Outcome,
    motion: Motion,
    sub_impacts: Vec<SubImpact>,
    counts: Counts,
}

impl Solver {
    /// A solver for a structure; builds no table yet.
    pub fn new(structure: &Structure) -> Result<Solver, InvalidInput> {
        structure.check()?;
        Ok(Solver::unchecked(structure))
    }

    fn unchecked(structure: &Structure) -> Solver {
        let modes = structure.modes.clone();
        let mut order: Vec<usize> =
            (0..modes.len()).filter(|&k| !modes[k].is_rigid() && modes[k].is_excited()).collect();
        order.sort_by(|&a, &b| modes[a].omega_rad_s.total_cmp(&modes[b].omega_rad_s));
        let mut place = vec![None; modes.len()];
        for (i, &k) in order.iter().enumerate() {
            place[k] = Some(i);
        }
        let ladder = Ladder::new(order.iter().map(|&k| modes[k]).collect());
        let residual_compliance_m_n = structure.residual_compliance_m_n;
        Solver { modes, residual_compliance_m_n, ladder, place, otherwise: None }
    }

    /// Solves one impact. `start` is the structure's motion when the clock starts; `None` means at rest and touching.
    ///
    /// # Errors
    /// Names the field, its value and what would be allowed, for input that poses no impact problem.
    pub fn solve<L: ContactLaw>(
        &mut self,
        striker: &Striker,
        law: &L,
        start: Option<&Start>,
        settings: &Settings,
    ) -> Result<Solution, InvalidInput> {
        self.solve_into(striker, law, start, settings, &mut None)
    }

    /// Solves one impact and keeps its whole history.
    ///
    /// # Errors
    /// As [`Solver::solve`].
    pub fn record<L: ContactLaw + Clone>(
        &mut self,
        striker: &Striker,
        law: &L,
        start: Option<&Start>,
        settings: &Settings,
    ) -> Result<(Solution, History<L>), InvalidInput> {
        let mut record = Some(Vec::new());
        let solution = self.solve_into(striker, law, start, settings, &mut record)?;
        let at_rest = Start::at_rest(self.modes.len());
        let start = start.unwrap_or(&at_rest);
        let history = History::new(self, *striker, law.clone(), start.clone(), record.unwrap_or_default(), &solution);
        Ok((solution, history))
    }

    fn solve_into<L: ContactLaw>(
        &mut self,
        striker: &Striker,
        law: &L,
        start: Option<&Start>,
        settings: &Settings,
        record: &mut Option<Vec<Piece>>,
    ) -> Result<Solution, InvalidInput> {
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
            self.inverse_mass(striker) > 0.0 || !self.ladder.modes.is_empty(),
            "mass_kg",
            striker.mass_kg,
            "a finite mass, where no mode of the structure moves at the contact",
        )?;

        let run = self.run(striker, law, start, settings, settings.tolerance.min(LOOSEST), record);
        let mut counts = run.counts;
        let restitution = self.restitution(&run, striker, start);
        let restitution_uncertainty = restitution
            .filter(|_| settings.estimate_uncertainty)
            .map(|value| self.uncertainty(value, striker, law, start, settings, &mut counts));
        let (amplitude, rate) = modal_state(&self.modes, &self.place, &run.motion, start);
        Ok(Solution {
            outcome: run.outcome,
            restitution,
            restitution_uncertainty,
            sub_impacts: run.sub_impacts,
            counts,
            end_s: run.motion.time,
            striker_velocity_m_s: -striker.speed_m_s + run.motion.impulse / striker.mass_kg,
            amplitude,
            rate,
        })
    }

    /// How far off the restitution may be, from solutions of the same impact. One that ends otherwise says that nothing is
    /// certain.
    fn uncertainty<L: ContactLaw>(
        &mut self,
        value: f64,
        striker: &Striker,
        law: &L,
        start: &Start,
        settings: &Settings,
        counts: &mut Counts,
    ) -> f64 {
        let coarser = |factor: f64| factor * settings.tolerance.min(LOOSEST);
        let same = self.again(striker, law, start, settings, coarser(COARSER), counts);
        let other = {
            let (modes, compliance) = (&self.modes, self.residual_compliance_m_n);
            let solver = self
                .otherwise
                .get_or_insert_with(|| Box::new(Solver::unchecked(&time_unit::structure(modes, compliance))));
            let (striker, start) = (time_unit::striker(striker), time_unit::start(start));
            solver.again(&striker, &time_unit::Law(law), &start, settings, coarser(OTHERWISE), counts)
        };
        let (Some(same), Some(other)) = (same, other) else { return 1.0 };
        let mut spread = (same - value).abs().max((other - value).abs());
        let mut times = ORDINARY;
        if spread > settings.tolerance {
            let Some(third) = self.again(striker, law, start, settings, coarser(THIRD), counts) else { return 1.0 };
            (spread, times) = (spread.max((third - value).abs()), AMPLIFIED);
        }
        (LEAST * settings.tolerance + times * spread).min(f64::MAX)
    }

    /// The restitution of the same impact at another tolerance.
    fn again<L: ContactLaw>(
        &mut self,
        striker: &Striker,
        law: &L,
        start: &Start,
        settings: &Settings,
        tolerance: f64,
        counts: &mut Counts,
    ) -> Option<f64> {
        let run = self.run(striker, law, start, settings, tolerance, &mut None);
        *counts += run.counts;
        self.restitution(&run, striker, start)
    }

    /// One run. Behind a residual compliance, with few modes, the steps of a loose tolerance may get stuck on their way,
    /// where those of a tighter one do not: then they take over.
    fn run<L: ContactLaw>(
        &mut self,
        striker: &Striker,
        law: &L,
        start: &Start,
        settings: &Settings,
        mut tolerance: f64,
        record: &mut Option<Vec<Piece>>,
    ) -> Run {
        let mut counts = Counts::default();
        loop {
            let mut run = self.march(striker, law, start, settings, tolerance, record);
            counts += run.counts;
            let stuck = matches!(run.outcome, Outcome::Stopped(StopReason::Steps | StopReason::FinestStep));
            if !stuck || self.residual_compliance_m_n == 0.0 || tolerance <= TIGHT {
                run.counts = counts;
                return run;
            }
            tolerance = (tolerance * TIGHTER).max(TIGHT);
            if let Some(pieces) = record.as_mut() {
                pieces.clear();
            }
        }
    }

    fn march<L: ContactLaw>(
        &mut self,
        striker: &Striker,
        law: &L,
        start: &Start,
        settings: &Settings,
        tolerance: f64,
        record: &mut Option<Vec<Piece>>,
    ) -> Run {
        let mut counts = Counts::default();
        let mut motion = self.initial(striker, start);
        let mu = self.inverse_mass(striker);
        // momentum and energy of the approach, or of the structure's motion where there is no approach
        let speed = motion.drift_rate.abs().max(motion.vibration.beta.iter().map(|b| b.abs()).sum());
        let inverse = if mu > 0.0 { mu } else { self.ladder.weight.iter().sum() };
        let momentum = speed / inverse;
        let setting = Setting {
            law,
            mu,
            residual_compliance: self.residual_compliance_m_n,
            impulse_tolerance: STEP_SHARE * tolerance * momentum,
            rest_energy: (0.1 * tolerance * speed).powi(2) / inverse,
            max_steps: settings.max_steps,
            until_s: if record.is_some() { settings.until_s } else { 0.0 },
        };
        let mut memory = Memory::default();
        let mut sub_impacts = Vec::new();
        let mut in_contact = start.gap_m == 0.0 && motion.gap_rate() > 0.0;
        let outcome = loop {
            if !in_contact {
                if let Some(pieces) = record.as_mut() {
                    pieces.push(Piece { start: motion.clone(), contact: None });
                }
                let departure = motion.clone();
                match fly(&mut self.ladder, &mut motion, memory.touch_m, settings.max_steps, &mut counts) {
                    FlightEnd::Contact => {}
                    end => {
                        // the search went on past the last event: report the state at that event
                        motion = departure;
                        break match end {
                            FlightEnd::Limit => Outcome::Stopped(StopReason::Flight),
                            _ if sub_impacts.is_empty() => Outcome::NoContact,
                            _ => Outcome::Rebound,
                        };
                    }
                }
            }
            let (found, end) = Contact::run(&setting, &mut self.ladder, &mut motion, &memory, &mut counts, record);
            sub_impacts.push(found);
            match end {
                ContactEnd::Released(kept) => memory = kept,
                ContactEnd::Lasts => break Outcome::Sustained,
                ContactEnd::Stopped(reason) => break Outcome::Stopped(reason),
            }
            if sub_impacts.len() >= settings.max_sub_impacts {
                break Outcome::Stopped(StopReason::SubImpacts);
            }
            in_contact = false;
        };
        Run { outcome, motion, sub_impacts, counts }
    }

    fn initial(&self, striker: &Striker, start: &Start) -> Motion {
        let n = self.ladder.modes.len();
        let mut vibration = Vibration { alpha: vec![0.0; n], beta: vec![0.0; n] };
        let mut drift_rate = striker.speed_m_s;
        let mut elastic = 0.0;
        for (k, mode) in self.modes.iter().enumerate() {
            match self.place[k] {
                Some(i) => {
                    vibration.alpha[i] = mode.shape * start.amplitude[k];
                    vibration.beta[i] = mode.shape * start.rate[k];
                    elastic += vibration.alpha[i];
                }
                None if mode.is_rigid() => drift_rate += mode.shape * start.rate[k],
                None => {}
            }
        }
        Motion { time: 0.0, vibration, drift: -start.gap_m - elastic, drift_rate, impulse: 0.0, impulse_integral: 0.0 }
    }

    /// Inverse mass of the striker and the rigid-body modes against each other at the contact (1/kg).
    pub(crate) fn inverse_mass(&self, striker: &Striker) -> f64 {
        let rigid: f64 = self.modes.iter().filter(|mode| mode.is_rigid()).map(|mode| mode.shape.powi(2)).sum();
        rigid + striker.mass_kg.recip()
    }

    fn restitution(&self, run: &Run, striker: &Striker, start: &Start) -> Option<f64> {
        let before = self.initial(striker, start).drift_rate;
        let ended = matches!(run.outcome, Outcome::Rebound | Outcome::Sustained);
        let ratio = -run.motion.drift_rate / before;
        // an approach of 1e-310 m/s on a structure that moves has no ratio to speak of
        (ended && before > 0.0 && self.inverse_mass(striker) > 0.0 && ratio.is_finite()).then_some(ratio)
    }

    pub(crate) fn modes(&self) -> &[Mode] {
        &self.modes
    }

    pub(crate) fn places(&self) -> &[Option<usize>] {
        &self.place
    }

    pub(crate) fn elastic(&self) -> &[Mode] {
        &self.ladder.modes
    }

    pub(crate) fn residual_compliance_m_n(&self) -> f64 {
        self.residual_compliance_m_n
    }
}

/// All modes of a structure, rigid and unexcited ones included, at a moment of the motion.
pub(crate) fn modal_state(
    modes: &[Mode],
    place: &[Option<usize>],
    motion: &Motion,
    start: &Start,
) -> (Vec<f64>, Vec<f64>) {
    let (mut amplitude, mut rate) = (start.amplitude.clone(), start.rate.clone());
    for (k, mode) in modes.iter().enumerate() {
        match place[k] {
            Some(i) => {
                amplitude[k] = motion.vibration.alpha[i] / mode.shape;
                rate[k] = motion.vibration.beta[i] / mode.shape;
            }
            None if mode.is_rigid() => {
                amplitude[k] += rate[k] * motion.time - mode.shape * motion.impulse_integral;
                rate[k] -= mode.shape * motion.impulse;
            }
            None => {
                let p = propagate(mode, motion.time);
                (amplitude[k], rate[k]) = p.apply(amplitude[k], rate[k]);
            }
        }
    }
    (amplitude, rate)
}
