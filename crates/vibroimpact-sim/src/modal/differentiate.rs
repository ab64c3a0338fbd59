//! Derivatives of an impact with respect to the numbers that define it.

use super::fall::{Fall, check_gravity};
use super::posed;
use super::problem::{Mode, Settings, Start, Striker, Structure, approach, mobility, moved, rigid_motion};
use super::solution::{Outcome, Solution};
use super::solve::{ANSWER, BESIDE, Impact, Lowered, Run, SOLUTIONS, Solved, Solver};
use crate::assembly::Assembly;
use crate::assembly::change::Change;
use crate::assembly::differentiate::{Known, check_offsets, nearest_graze};
use crate::assembly::problem::Posed;
use crate::assembly::solve::Keep;
use crate::assembly::tangent::{Expansions, IntervalChange, ROUNDED, Tangent, tangents};
use crate::concurrent::both;
use contact_models::ContactLaw;
use invalid_input::InvalidInput;
use std::array;
use std::fmt;

pub use crate::assembly::{Derivative, NearMiss, NoDerivative, Stencil};

/// All input of an impact.
#[derive(Clone, Copy)]
pub struct Posing<'a> {
    /// The structure, as seen from the contact.
    pub structure: &'a Structure,
    /// The compact body.
    pub striker: &'a Striker,
    /// The contact law.
    pub law: &'a dyn ContactLaw,
    /// Motion of the structure at the start.
    pub start: &'a Start,
    /// Acceleration of gravity, if the striker falls; otherwise 0 (m/s^2).
    pub gravity_m_s2: f64,
}

impl Posing<'_> {
    /// Checks the input as [`Solver::solve`] does, apart from the law.
    ///
    /// # Errors
    /// Names the field, its value and the allowed values.
    pub fn check(&self) -> Result<(), InvalidInput> {
        self.structure.check()?;
        self.striker.check()?;
        check_gravity(self.gravity_m_s2)?;
        self.start.check(self.structure.modes.len())
    }
}

impl fmt::Debug for Posing<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Posing")
            .field("structure", self.structure)
            .field("striker", self.striker)
            .field("start", self.start)
            .field("gravity_m_s2", &self.gravity_m_s2)
            .finish_non_exhaustive()
    }
}

/// A parameter, described by the impact at four neighbouring values. They must be so close that all numbers which define the
/// impact are smooth between them. Number and order of the modes must be the same.
#[derive(Debug, Clone, Copy)]
pub struct Parameter<'a> {
    /// Differences of the neighbouring values from the value (unit of the parameter): four different numbers, best
    /// `-2, -1, 1, 2` steps, or `1, 2, 3, 4` at a bound.
    pub offsets: [f64; 4],
    /// The impact at these values.
    pub neighbours: [Posing<'a>; 4],
    /// Whether the contact law depends on the parameter.
    pub changes_law: bool,
}

/// Derivatives of one interval of contact, per unit of the parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SubImpactDerivatives {
    /// Time of first touch (s).
    pub start_s: Derivative,
    /// Time of separation (s).
    pub end_s: Derivative,
    /// Impulse (N s).
    pub impulse_n_s: Derivative,
    /// Largest force (N).
    pub peak_force_n: Derivative,
    /// Largest compression (m).
    pub peak_compression_m: Derivative,
}

/// Derivatives of an impact with respect to one parameter, per unit of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Derivatives {
    /// Net restitution.
    pub restitution: Derivative,
    /// Time of the last separation (s).
    pub end_s: Derivative,
    /// Velocity of the striker then (m/s).
    pub striker_velocity_m_s: Derivative,
    /// Each interval of contact.
    pub sub_impacts: Vec<SubImpactDerivatives>,
    /// Modal amplitudes at the last separation (m kg^1/2), whose time changes as well.
    pub amplitude: Vec<f64>,
    /// Their rates (m kg^1/2 / s).
    pub rate: Vec<f64>,
}

/// An impact with its derivatives.
#[derive(Debug, Clone, PartialEq)]
pub struct Differentiated {
    /// The impact.
    pub solution: Solution,
    /// For each parameter, in the given order: its derivatives, or the reason why there are none.
    pub derivatives: Vec<Result<Derivatives, NoDerivative>>,
    /// Speed of the slowest touch, or of the nearest miss, divided by that of the fastest touch. As it tends to zero, the
    /// derivatives may change abruptly or grow without bound.
    pub nearest_graze: f64,
    /// The nearest graze, if it is a miss.
    pub nearest_miss: Option<NearMiss>,
}

/// Derivatives for each parameter, and the lowest and the highest speed at which a contact closed.
type AllChanges = (Vec<Result<Changes, NoDerivative>>, [f64; 2]);

/// Derivatives along one run with respect to one parameter.
#[derive(Clone)]
struct Changes {
    numbers: [f64; 3],
    intervals: Vec<IntervalChange>,
    amplitude: Vec<f64>,
    rate: Vec<f64>,
}

impl Solver {
    /// Solves one impact and differentiates it with respect to some parameters. The tangent of the motion is computed; motions are
    /// not differenced. Each parameter costs less than an impact.
    ///
    /// ```
    /// use contact_models::Hertz;
    /// use vibroimpact_sim::modal::{Mode, Parameter, Posing, Settings, Solver, Start, Striker, Structure};
    ///
    /// let mode = Mode { omega_rad_s: 314.0, damping_ratio: 0.02, shape: 2f64.sqrt() };
    /// let structure = Structure { modes: vec![mode] };
    /// let (law, start) = (Hertz::new(1.8e10).unwrap(), Start::at_rest(1));
    /// // by the mass of the ball
    /// let offsets = [-2e-5, -1e-5, 1e-5, 2e-5];
    /// let balls = offsets.map(|more| Striker { mass_kg: 0.1 + more, speed_m_s: 1.0 });
    /// let posing =
    ///     |striker| Posing { structure: &structure, striker, law: &law, start: &start, gravity_m_s2: 0.0 };
    /// let mass = Parameter { offsets, neighbours: balls.each_ref().map(posing), changes_law: false };
    /// let ball = Striker { mass_kg: 0.1, speed_m_s: 1.0 };
    /// let solved = Solver::new(&structure)?.differentiate(&ball, &law, None, &Settings::default(), &[mass])?;
    /// // two rigid bodies of m and M: (1 - m/M)/(1 + m/M)
    /// let derivative = solved.derivatives[0].as_ref().unwrap().restitution;
    /// assert!((derivative.value + 2.0 / 0.5 / 1.2f64.powi(2)).abs() < 1e-2);
    /// # Ok::<(), vibroimpact_sim::InvalidInput>(())
    /// ```
    ///
    /// # Errors
    /// As [`Solver::solve`], also for the neighbours, and if some of them have another number of modes or have gravity alone.
    pub fn differentiate(
        &self,
        striker: &Striker,
        law: &dyn ContactLaw,
        start: Option<&Start>,
        settings: &Settings,
        parameters: &[Parameter],
    ) -> Result<Differentiated, InvalidInput> {
        let (count, gravity_m_s2) = (self.modes().len(), self.gravity_m_s2());
        for (i, parameter) in parameters.iter().enumerate() {
            check_offsets(i, &parameter.offsets)?;
            for (place, neighbour) in parameter.neighbours.iter().enumerate() {
                let found = neighbour.structure.modes.len();
                let field = ("parameters", i, ("neighbours", place, ["structure", "modes"]));
                InvalidInput::unless(
                    found == count,
                    field,
                    format!("{found} modes"),
                    "a list with as many modes as the structure has",
                )?;
                neighbour.check()?;
                InvalidInput::unless(
                    (neighbour.gravity_m_s2 == 0.0) == (gravity_m_s2 == 0.0),
                    ("parameters", i, ("neighbours", place, "gravity_m_s2")),
                    neighbour.gravity_m_s2,
                    "0 at all neighbours or at none, as for the impact itself",
                )?;
            }
        }
        let moved = self.moved_by(parameters, start);
        let other = (moved != self.moved()).then(|| self.moving(moved));
        let at_rest = Start::at_rest(count);
        let start = start.unwrap_or(&at_rest);
        let fall = Fall::new(gravity_m_s2, self.modes(), striker, start)?;
        let impact = Impact { striker, law, start, settings, fall };
        other.as_ref().unwrap_or(self).along_all(&impact, parameters)
    }

    /// The impact at its tolerance and in other steps at a coarser one, differentiated along both.
    fn along_all(&self, impact: &Impact, parameters: &[Parameter]) -> Result<Differentiated, InvalidInput> {
        let Impact { striker, law, start, settings, .. } = *impact;
        let Solved { solution, run: fine, coarser, .. } =
            self.solve_into(striker, law, Some(start), settings, Keep::NearestMiss)?;
        let none = |solution, why| {
            let derivatives = parameters.iter().map(|_| Err(why)).collect();
            Differentiated { solution, derivatives, nearest_graze: 1.0, nearest_miss: None }
        };
        if solution.outcome != Outcome::Rebound || solution.restitution.is_none() {
            return Ok(none(solution, NoDerivative::Outcome));
        }
        let lowered = self.lower(impact);
        let coarser = coarser.unwrap_or_else(|| self.beside(impact, &lowered));
        let around = Around::new(self, &lowered, parameters)?;
        let (coarse, found) = both(
            settings.concurrent,
            || self.along(BESIDE, impact, &around, &lowered, &coarser),
            || self.along(ANSWER, impact, &around, &lowered, &fine),
        );
        let (changes, closing_speeds_m_s) = match found {
            Ok(found) => found,
            Err(why) => return Ok(none(solution, why)),
        };
        let coarse = coarse.map_or(Vec::new(), |(changes, _)| changes);
        let by_impulse = [mobility(self.modes(), striker) / self.approach_m_s(impact), striker.mass_kg.recip()];
        let of = |(i, fine): (usize, Result<Changes, NoDerivative>)| {
            let fine = fine?;
            let coarse = coarse.get(i).and_then(|coarse| coarse.as_ref().ok());
            let coarse = coarse.filter(|coarse| coarse.intervals.len() == fine.intervals.len());
            let known = Known::new(SOLUTIONS[BESIDE].1 * settings.tolerance, &parameters[i].offsets);
            Ok(fine.beside(coarse, &solution, known, by_impulse))
        };
        let derivatives = changes.into_iter().enumerate().map(of).collect();
        let (nearest_graze, nearest_miss) = nearest_graze(closing_speeds_m_s, fine.record.nearest_miss);
        Ok(Differentiated { solution, derivatives, nearest_graze, nearest_miss })
    }

    /// Derivatives along one of the solutions.
    fn along(
        &self,
        which: usize,
        impact: &Impact,
        around: &Around,
        Lowered { assembly, system }: &Lowered,
        run: &Run,
    ) -> Result<AllChanges, NoDerivative> {
        if run.outcome != Outcome::Rebound {
            return Err(NoDerivative::Outcome);
        }
        let posed = assembly.with_laws(vec![impact.law]);
        let stretches = &run.record.stretches;
        let expansions = &mut Expansions::new(SOLUTIONS[which].0);
        let rounded = if which == ANSWER { 0.0 } else { ROUNDED };
        let found = tangents(&posed, system, stretches, (&around.changes, None), expansions, rounded)?;
        let pick = |values: &[f64]| {
            let mut all = vec![0.0; self.modes().len()];
            let places = &system.place[posed::STRUCTURE];
            self.moved().iter().zip(places).for_each(|(k, place)| all[*k] = values[*place]);
            all
        };
        let ends = [&found.amplitude, &found.rate];
        let (ended, striker) = (pick(ends[1]), &system.links[0].sides[0]);
        // displacement and velocity of the striker
        let motion = ends.map(|values| striker.as_ref().map_or(0.0, |side| side.sum(values)));
        let of = |(tangent, d): (Result<Tangent, NoDerivative>, usize)| {
            let tangent = tangent?;
            let [dx, dv] = [(ends[0], &tangent.amplitude), (ends[1], &tangent.rate)].map(|(end, change)| {
                striker.as_ref().map_or(0.0, |side| side.sum(change) + around.weight[d] * end[side.modes.start])
            });
            let (amplitude, rate) = (pick(&tangent.amplitude), pick(&tangent.rate));
            let by = &around.parameters[d];
            let restitution = match &impact.fall {
                Some(fall) => change_after_fall(fall, &around.falls[d], Stencil::new(by.offsets), motion, [dx, dv]),
                None => restitution_change(self.modes(), impact, by, [motion[1], dv], [&ended, &rate]),
            };
            Ok(Changes { numbers: [restitution, tangent.time_s, dv], intervals: tangent.intervals, amplitude, rate })
        };
        Ok((found.tangents.into_iter().zip(0..).map(of).collect(), found.closing_speeds_m_s))
    }

    /// The modes that the contact excites, or that move it before the impact, at the value itself or at a neighbour.
    fn moved_by(&self, parameters: &[Parameter], start: Option<&Start>) -> Vec<usize> {
        let neighbours = parameters.iter().flat_map(|parameter| &parameter.neighbours);
        let mut all = moved(self.modes(), start);
        for Posing { structure, start, .. } in neighbours {
            all.extend(moved(&structure.modes, Some(start)));
        }
        all.sort_unstable();
        all.dedup();
        all
    }
}

/// How the numbers that define an impact change with each parameter.
struct Around<'a> {
    parameters: &'a [Parameter<'a>],
    changes: Vec<Change<'a>>,
    /// Change of the weight of the striker's own mode in its motion.
    weight: Vec<f64>,
    /// The falls of the striker at the four neighbours; none without gravity.
    falls: Vec<Vec<Fall>>,
}

impl<'a> Around<'a> {
    fn new(solver: &Solver, lowered: &Lowered, parameters: &'a [Parameter<'a>]) -> Result<Around<'a>, InvalidInput> {
        let mut around = Around { parameters, changes: Vec::new(), weight: Vec::new(), falls: Vec::new() };
        for by in parameters {
            let fall = |at: &Posing| Fall::new(at.gravity_m_s2, &at.structure.modes, at.striker, at.start).transpose();
            let falls = by.neighbours.iter().filter_map(fall).collect::<Result<Vec<Fall>, _>>()?;
            let near: [Assembly<()>; 4] = array::from_fn(|i| {
                let Posing { structure, striker, start, .. } = by.neighbours[i];
                let weight = falls.get(i).map(Fall::weight);
                posed::assembly((&structure.modes, solver.moved()), striker, start, weight)
            });
            let posed: [Posed; 4] = array::from_fn(|i| near[i].with_laws(vec![by.neighbours[i].law]));
            let stencil = Stencil::new(by.offsets);
            let weight = |at: &Posing| posed::weight(at.striker, &at.structure.modes);
            let laws = by.changes_law.then(|| vec![by.neighbours.each_ref().map(|at| at.law)]);
            around.changes.push(Change::new(&lowered.system, posed.each_ref(), laws, stencil));
            around.weight.push(stencil.slope(by.neighbours.each_ref().map(weight)));
            around.falls.push(falls);
        }
        Ok(around)
    }
}

/// Change of the restitution after a fall, whose striker has this displacement and velocity at the end, and these changes of both.
fn change_after_fall(
    fall: &Fall,
    near: &[Fall],
    stencil: Stencil<4>,
    [displacement_m, velocity_m_s]: [f64; 2],
    changes: [f64; 2],
) -> f64 {
    let of_same_motion = stencil.slope(array::from_fn(|i| near[i].restitution(displacement_m, velocity_m_s)));
    let by = fall.restitution_by(displacement_m, velocity_m_s);
    of_same_motion + by[0] * changes[0] + by[1] * changes[1]
}

/// Change of `(velocity - rigid(end)) / (speed + rigid(start))`, `rigid` the motion of the structure's rigid-body modes.
fn restitution_change(
    modes: &[Mode],
    impact: &Impact,
    by: &Parameter,
    [velocity, velocity_change]: [f64; 2],
    [end, end_change]: [&[f64]; 2],
) -> f64 {
    let stencil = Stencil::new(by.offsets);
    let by_shape = stencil.slope(by.neighbours.each_ref().map(|at| rigid_motion(&at.structure.modes, end)));
    let parting = velocity - rigid_motion(modes, end);
    let parting_change = velocity_change - by_shape - rigid_motion(modes, end_change);
    let before = approach(modes, impact.striker, impact.start);
    let before_of = |at: &Posing| approach(&at.structure.modes, at.striker, at.start);
    let before_change = stencil.slope(by.neighbours.each_ref().map(before_of));
    (parting_change - parting / before * before_change) / before
}

impl Changes {
    /// Derivatives with their uncertainty from the coarser motion; `by_impulse` are restitution and final velocity per impulse.
    ///
    /// Two motions agree in some numbers by accident. As the error of a motion persists, a difference counts for all later outputs of
    /// the same kind as well. The largest difference of an impulse counts for restitution and velocity.
    fn beside(&self, coarse: Option<&Changes>, solution: &Solution, known: Known, by_impulse: [f64; 2]) -> Derivatives {
        // the largest difference so far
        let mut largest = Largest::default();
        let differ = |of: &dyn Fn(&Changes) -> f64| coarse.map(|coarse| (of(coarse) - of(self)).abs());
        let mut sub_impacts = Vec::with_capacity(self.intervals.len());
        for (i, sub) in solution.sub_impacts.iter().take(self.intervals.len()).enumerate() {
            let with = |largest: &mut f64, get: fn(&IntervalChange) -> f64, output: f64| {
                let difference = differ(&|changes| get(&changes.intervals[i])).map(|difference| {
                    *largest = largest.max(difference);
                    *largest
                });
                known.differing(get(&self.intervals[i]), difference, output)
            };
            sub_impacts.push(SubImpactDerivatives {
                start_s: with(&mut largest.time_s, |change| change.start_s, sub.start_s),
                end_s: with(&mut largest.time_s, |change| change.end_s, sub.end_s),
                impulse_n_s: with(&mut largest.impulse_n_s, |change| change.impulse_n_s, sub.impulse_n_s),
                peak_force_n: with(&mut largest.force_n, |change| change.peak_force_n, sub.peak_force_n),
                peak_compression_m: with(
                    &mut largest.compression_m,
                    |change| change.peak_compression_m,
                    sub.peak_compression_m,
                ),
            });
        }
        let number = |i: usize, least: f64, output: f64| {
            let difference = differ(&|changes| changes.numbers[i]).map(|difference| difference.max(least));
            known.differing(self.numbers[i], difference, output)
        };
        let [restitution, velocity_m_s] = by_impulse.map(|by_impulse| by_impulse * largest.impulse_n_s);
        Derivatives {
            restitution: number(0, restitution, solution.restitution.unwrap_or(0.0)),
            end_s: number(1, largest.time_s, solution.end_s),
            striker_velocity_m_s: number(2, velocity_m_s, solution.striker_velocity_m_s),
            sub_impacts,
            amplitude: self.amplitude.clone(),
            rate: self.rate.clone(),
        }
    }
}

/// The largest differences between two motions in derivatives of times, impulses, forces and compressions.
#[derive(Default)]
struct Largest {
    time_s: f64,
    impulse_n_s: f64,
    force_n: f64,
    compression_m: f64,
}
