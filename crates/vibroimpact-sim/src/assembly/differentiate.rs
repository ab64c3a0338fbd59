//! Derivatives of a run of an assembly with respect to the numbers that define it.

use super::change::Change;
use super::load::HarmonicLoad;
use super::miss::NearMiss;
use super::no_derivative::NoDerivative;
use super::problem::{Assembly, Load, Point, Posed, Settings};
use super::responses::Responses;
use super::solution::{Interval, Observer, Outcome, Run};
use super::solve::{Keep, Solver, follow};
use super::stencil::Stencil;
use super::system::System;
use super::tables::Tables;
use super::tangent::{Expansions, IntervalChange, ROUNDED, Tangent, tangents};
use contact_models::ContactLaw;
use invalid_input::InvalidInput;
use std::array;

/// Derivatives of the modal state at the end with respect to that at the start: `[at the start][at the end]`.
type Monodromy = Vec<Vec<f64>>;

/// A parameter, described by the assembly at four neighbouring values. They must be so close that all numbers which define the
/// assembly are smooth between them. Number and order of bodies, modes, contacts and loads must be the same.
#[derive(Debug, Clone)]
pub struct Parameter<'a, L> {
    /// Differences of the neighbouring values from the value (unit of the parameter): four different numbers, best
    /// `-2, -1, 1, 2` steps, or `1, 2, 3, 4` at a bound.
    pub offsets: [f64; 4],
    /// The assembly at these values, with the same numbers of bodies, modes and contacts, and harmonic loads on the same bodies.
    pub neighbours: [&'a Assembly<L>; 4],
    /// The end of the run at these values (s).
    pub end_s: [f64; 4],
    /// Whether a contact law depends on the parameter.
    pub changes_laws: bool,
}

/// A derivative, per unit of the parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Derivative {
    /// The derivative.
    pub value: f64,
    /// Its uncertainty, from the derivative along a coarser solution with rounding errors of the laws added. `None` if that solution
    /// has another sequence of contacts (for an interval of contact: no such interval), so that no digit of the derivative is certain.
    pub uncertainty: Option<f64>,
}

/// Derivatives of one interval of contact, per unit of the parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct IntervalDerivatives {
    /// Time of first touch (s).
    pub start_s: Derivative,
    /// Time of the release (s); `None` for a contact under way at the end.
    pub end_s: Option<Derivative>,
    /// Impulse (N s).
    pub impulse_n_s: Derivative,
    /// Largest force (N).
    pub peak_force_n: Derivative,
    /// Largest compression (m).
    pub peak_compression_m: Derivative,
    /// Rate of compression at first touch (m/s).
    pub approach_speed_m_s: Derivative,
    /// Rate of opening at the release (m/s).
    pub separation_speed_m_s: Option<Derivative>,
}

/// Derivatives of a contact, per unit of the parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct ContactDerivatives {
    /// Its intervals.
    pub intervals: Vec<IntervalDerivatives>,
    /// Displacement of either side at the end (m).
    pub displacement_m: [Derivative; 2],
    /// Velocity of either side at the end (m/s).
    pub velocity_m_s: [Derivative; 2],
}

/// Derivatives of a run with respect to one parameter, per unit of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Derivatives {
    /// End of the run (s): the derivative of the requested time, or zero if the run ended at rest.
    pub end_s: f64,
    /// Each contact.
    pub contacts: Vec<ContactDerivatives>,
}

/// A run with its derivatives.
#[derive(Debug, Clone, PartialEq)]
pub struct Differentiated {
    /// The run.
    pub run: Run,
    /// Its intervals, contact by contact.
    pub intervals: Vec<Vec<Interval>>,
    /// For each parameter, in the given order: its derivatives, or the reason why there are none.
    pub derivatives: Vec<Result<Derivatives, NoDerivative>>,
    /// Speed of the slowest touch, or of the nearest miss, divided by that of the fastest touch. As it tends to zero, the
    /// derivatives may change abruptly or grow without bound.
    pub nearest_graze: f64,
    /// The nearest graze, if it is a miss.
    pub nearest_miss: Option<NearMiss>,
}

/// Factor of the tolerance of the coarser motion whose derivatives give the uncertainty.
const COARSER: f64 = 32.0;
/// Factor from the difference of these derivatives to the uncertainty.
const TIMES: f64 = 10.0;
/// Further relative error of a derivative, by the digits that differences of the neighbours lose.
const ROUNDING: f64 = 1e-10;

/// Checks the offsets of a parameter.
pub(crate) fn check_offsets(parameter: usize, offsets: &[f64; 4]) -> Result<(), InvalidInput> {
    let different = (0..4).all(|k| offsets[k].is_finite() && !offsets[..k].contains(&offsets[k]));
    InvalidInput::unless(
        different,
        ("parameters", parameter, "offsets"),
        format!("{offsets:?}"),
        "a list of four different finite numbers",
    )
}

/// Accuracy of the derivatives with respect to one parameter, apart from the comparison with the coarser motion.
#[derive(Clone, Copy)]
pub(crate) struct Known {
    /// Their errors relative to themselves and to the output.
    relative: f64,
    rounding: f64,
}

impl Known {
    /// For this tolerance of the coarser motion and these offsets of the neighbours, which magnify the rounding of the numbers that
    /// define it. Two motions can agree by chance, so the relative error is at least that tolerance.
    pub fn new(coarser: f64, offsets: &[f64; 4]) -> Known {
        let nearest = offsets.iter().map(|offset| offset.abs()).filter(|offset| *offset > 0.0).fold(f64::MAX, f64::min);
        Known { relative: coarser + ROUNDING, rounding: 4.0 * f64::EPSILON / nearest }
    }

    /// A derivative of this output, with that along the coarser motion.
    pub fn beside(self, value: f64, coarse: Option<f64>, output: f64) -> Derivative {
        self.differing(value, coarse.map(|coarse| (coarse - value).abs()), output)
    }

    /// A derivative of this output that differs from that along the coarser motion by this much.
    pub fn differing(self, value: f64, difference: Option<f64>, output: f64) -> Derivative {
        let floor = self.relative * value.abs() + self.rounding * output.abs();
        Derivative { value, uncertainty: difference.map(|difference| TIMES * difference + floor) }
    }
}

/// Derivatives along one run with respect to one parameter: for each contact those of its intervals, and of displacement and
/// velocity of both sides.
struct Changes {
    intervals: Vec<Vec<IntervalChange>>,
    sides: Vec<[[Changed; 2]; 2]>,
}

/// An output and its derivative.
#[derive(Clone, Copy, Default)]
struct Changed {
    value: f64,
    change: f64,
}

/// One run with its derivatives.
struct Differences {
    run: Run,
    intervals: Vec<Vec<Interval>>,
    /// For each parameter.
    changes: Vec<Result<Changes, NoDerivative>>,
    nearest_graze: f64,
    nearest_miss: Option<NearMiss>,
}

/// Collects the intervals.
struct Intervals(Vec<Vec<Interval>>);

impl Observer for Intervals {
    fn interval(&mut self, contact: usize, interval: &Interval) {
        self.0[contact].push(*interval);
    }
}

impl Solver<'_> {
    /// Solves the assembly as [`Solver::run`] does, and differentiates the run with respect to some parameters. The tangent of the
    /// motion is computed; motions are not differenced. The whole run is held in memory.
    ///
    /// ```
    /// use contact_models::Hertz;
    /// use vibroimpact_sim::assembly::{Assembly, Body, Contact, Parameter, Point, Settings, Solver};
    ///
    /// // a ball flies towards the ground, 1 cm away
    /// let posed = |speed: f64| {
    ///     let side = Point::OfBody { body: 0, shape: vec![0.1f64.sqrt().recip()] };
    ///     let contact = Contact { sides: [side, Point::Ground], gap_m: 0.0, law: Hertz::new(1e9).unwrap() };
    ///     Assembly { bodies: vec![Body::mass(0.1, 0.01, -speed)], contacts: vec![contact], loads: Vec::new() }
    /// };
    /// let offsets = [-2e-5, -1e-5, 1e-5, 2e-5];
    /// let around = offsets.map(|more| posed(1.0 + more));
    /// let speed =
    ///     Parameter { offsets, neighbours: around.each_ref(), end_s: [0.02; 4], changes_laws: false };
    /// let assembly = posed(1.0);
    /// let found = Solver::new(&assembly)?.differentiate(&Settings::until(0.02), &[speed])?;
    /// let contact = &found.derivatives[0].as_ref().unwrap().contacts[0];
    /// // it arrives at 0.01 m/v, and its impulse is 2 m v
    /// assert!((contact.intervals[0].start_s.value + 0.01).abs() < 1e-9);
    /// assert!((contact.intervals[0].impulse_n_s.value - 0.2).abs() < 1e-8);
    /// # Ok::<(), vibroimpact_sim::InvalidInput>(())
    /// ```
    ///
    /// # Errors
    /// As [`Solver::run`], and if the neighbours differ in the number of bodies, modes or contacts.
    pub fn differentiate<L: ContactLaw>(
        &self,
        settings: &Settings,
        parameters: &[Parameter<L>],
    ) -> Result<Differentiated, InvalidInput> {
        settings.check()?;
        let around: Vec<[Posed; 4]> = parameters
            .iter()
            .enumerate()
            .map(|(i, parameter)| self.neighbours(i, parameter))
            .collect::<Result<_, _>>()?;
        let changes: Vec<Change> = around
            .iter()
            .zip(parameters)
            .map(|(posed, by)| {
                let laws = |c| posed.each_ref().map(|posed| posed.laws[c]);
                let laws = by.changes_laws.then(|| (0..self.system.links.len()).map(laws).collect());
                Change::new(&self.system, posed.each_ref(), laws, Stencil::new(by.offsets))
            })
            .collect();
        let asked: Vec<f64> = parameters.iter().map(|by| Stencil::new(by.offsets).slope(by.end_s)).collect();
        let fine = self.along(&self.tables, settings, (&around, &changes, &asked), 0.0);
        let Differences { run, intervals, changes: fine, nearest_graze, nearest_miss } = fine;
        // the coarser run ends at the same time as this one, which is fixed unless it is the requested end
        let (end_s, ends) = match run.outcome {
            Outcome::End => (settings.end_s, asked),
            Outcome::Rest => (run.end_s, vec![0.0; parameters.len()]),
            _ => (settings.end_s, vec![0.0; parameters.len()]),
        };
        let tolerance = (COARSER * settings.tolerance).min(0.1);
        let coarser = Settings { tolerance, end_s, stop_at_rest: false, ..*settings };
        let coarse = match fine.iter().any(Result::is_ok) {
            true => self.along(self.beside(), &coarser, (&around, &changes, &ends), ROUNDED).changes,
            false => Vec::new(),
        };
        let derivatives = fine.into_iter().zip(ends).enumerate().map(|(i, (changes, end_s))| {
            let coarse = coarse.get(i).and_then(|coarse| coarse.as_ref().ok());
            let known = Known::new(COARSER * settings.tolerance, &parameters[i].offsets);
            Ok(Derivatives { end_s, contacts: changes?.beside(&intervals, coarse, known) })
        });
        let derivatives = derivatives.collect();
        Ok(Differentiated { run, intervals, derivatives, nearest_graze, nearest_miss })
    }

    /// Derivatives of all modes at the end, amplitudes before rates, with respect to those at the start, body by body:
    /// `[at the start][at the end]`, with the end of the run. `None` if there is no derivative.
    pub(crate) fn monodromy(
        &self,
        settings: &Settings,
    ) -> Result<(Outcome, Result<Monodromy, NoDerivative>), InvalidInput> {
        settings.check()?;
        let Solver { posed, system, tables, .. } = self;
        let (run, record) = follow(posed, (system, tables, &mut Responses::default()), settings, &mut (), Keep::Motion);
        if run.outcome != Outcome::End {
            return Ok((run.outcome, Err(NoDerivative::Outcome)));
        }
        let places = || system.place.iter().flatten().copied();
        let of = |of_rate: bool| places().map(move |place| (place, of_rate));
        let changes: Vec<Change> =
            of(false).chain(of(true)).map(|(place, of_rate)| Change::of_start(system, place, of_rate)).collect();
        let fixed = vec![0.0; changes.len()];
        let found = tangents(
            posed,
            system,
            &record.stretches,
            (&changes, Some(&fixed)),
            &mut Expansions::new(tables.steps),
            0.0,
        );
        let column = |tangent: Result<Tangent, NoDerivative>| {
            let tangent = tangent?;
            let of = |values: &[f64]| places().map(|place| values[place]).collect::<Vec<f64>>();
            Ok([of(&tangent.amplitude), of(&tangent.rate)].concat())
        };
        Ok((run.outcome, found.and_then(|found| found.tangents.into_iter().map(column).collect())))
    }

    /// The assemblies at the neighbouring values of a parameter, after checks.
    fn neighbours<'n, L: ContactLaw>(
        &self,
        i: usize,
        parameter: &Parameter<'n, L>,
    ) -> Result<[Posed<'n>; 4], InvalidInput> {
        check_offsets(i, &parameter.offsets)?;
        let ends = &parameter.end_s;
        InvalidInput::unless(
            ends.iter().all(|end| *end > 0.0),
            ("parameters", i, "end_s"),
            format!("{ends:?}"),
            "a list of four positive times",
        )?;
        for (k, neighbour) in parameter.neighbours.iter().enumerate() {
            neighbour.check()?;
            let own = &self.posed;
            let bodies = neighbour.bodies.len() == own.bodies.len()
                && neighbour.bodies.iter().zip(own.bodies).all(|(one, other)| one.modes.len() == other.modes.len());
            let body_of = |point: &Point| match point {
                Point::Ground => None,
                Point::OfBody { body, .. } => Some(*body),
            };
            let sides =
                |one: &[Point; 2], other: &[Point; 2]| one.each_ref().map(body_of) == other.each_ref().map(body_of);
            let contacts = neighbour.contacts.len() == own.sides.len()
                && neighbour.contacts.iter().zip(&own.sides).all(|(one, other)| sides(&one.sides, other));
            let driven =
                |loads: &[Load]| loads.iter().filter_map(HarmonicLoad::of).map(|load| load.body).collect::<Vec<_>>();
            let loads = driven(&neighbour.loads) == driven(own.loads);
            let allowed = "an assembly with the same numbers of bodies, modes and contacts, and with harmonic loads on the same bodies";
            InvalidInput::unless(
                bodies && contacts && loads,
                ("parameters", i, ("neighbours", k)),
                "another assembly",
                allowed,
            )?;
        }
        Ok(parameter.neighbours.map(Assembly::posed))
    }

    /// One run in the steps of these tables, with its derivatives; `end_s` has those of the requested time, and `rounded` is an error
    /// of the laws' numbers (see [`tangents`]).
    fn along(
        &self,
        tables: &Tables,
        settings: &Settings,
        (around, changes, end_s): (&[[Posed; 4]], &[Change], &[f64]),
        rounded: f64,
    ) -> Differences {
        let Solver { posed, system, .. } = self;
        let mut watch = Intervals(vec![Vec::new(); posed.sides.len()]);
        let (run, record) =
            follow(posed, (system, tables, &mut Responses::default()), settings, &mut watch, Keep::NearestMiss);
        let zeros = vec![0.0; changes.len()];
        let fixed = match run.outcome {
            Outcome::Parted => None,
            Outcome::End => Some(end_s),
            _ => Some(zeros.as_slice()),
        };
        let stopped = matches!(run.outcome, Outcome::Stopped(_));
        let found = match stopped {
            true => Err(NoDerivative::Outcome),
            false => {
                let expansions = &mut Expansions::new(tables.steps);
                tangents(posed, system, &record.stretches, (changes, fixed), expansions, rounded)
            }
        };
        let (intervals, nearest_miss) = (watch.0, record.nearest_miss);
        let found = match found {
            Ok(found) => found,
            Err(why) => {
                let changes = changes.iter().map(|_| Err(why)).collect();
                return Differences { run, intervals, changes, nearest_graze: 1.0, nearest_miss: None };
            }
        };
        let state = [found.amplitude.as_slice(), &found.rate];
        let of = |((tangent, posed), change): ((Result<Tangent, NoDerivative>, &[Posed; 4]), &Change)| {
            let tangent = tangent?;
            let sides = (0..system.links.len()).map(|c| sides(system, c, state, &tangent, posed, change));
            let sides = sides.collect();
            let mut intervals = vec![Vec::new(); system.links.len()];
            tangent.intervals.into_iter().for_each(|interval| intervals[interval.contact].push(interval));
            Ok(Changes { intervals, sides })
        };
        let changes = found.tangents.into_iter().zip(around).zip(changes).map(of).collect();
        let (nearest_graze, nearest_miss) = nearest_graze(found.closing_speeds_m_s, nearest_miss);
        Differences { run, intervals, changes, nearest_graze, nearest_miss }
    }
}

/// The lowest speed at which a contact closed or the speed of the nearest miss, divided by the highest speed, and the miss if it is
/// nearer; 1 if no contact closed.
pub(crate) fn nearest_graze([lowest, highest]: [f64; 2], miss: Option<NearMiss>) -> (f64, Option<NearMiss>) {
    let miss = miss.filter(|miss| miss.speed_m_s < lowest);
    let lowest = miss.map_or(lowest, |miss| miss.speed_m_s);
    (if highest > 0.0 && lowest.is_finite() { lowest / highest } else { 1.0 }, miss)
}

/// Derivatives of displacement and velocity of both sides of a contact at the end.
fn sides(
    system: &System,
    c: usize,
    state: [&[f64]; 2],
    tangent: &Tangent,
    posed: &[Posed; 4],
    change: &Change,
) -> [[Changed; 2]; 2] {
    array::from_fn(|i| {
        let Some(side) = &system.links[c].sides[i] else { return [Changed::default(); 2] };
        let spans = posed.each_ref().map(|posed| match &posed.sides[c][i] {
            Point::Ground => None,
            Point::OfBody { body, shape } => Some(system.span(*body, shape)),
        });
        let by_shape = |values: &[f64]| {
            change.stencil.slope(spans.each_ref().map(|span| span.as_ref().map_or(0.0, |span| span.sum(values))))
        };
        let changes = [&tangent.amplitude, &tangent.rate];
        array::from_fn(|order| Changed {
            value: side.sum(state[order]),
            change: by_shape(state[order]) + side.sum(changes[order]),
        })
    })
}

impl Changes {
    /// Derivatives with their uncertainty from the coarser motion.
    fn beside(&self, intervals: &[Vec<Interval>], coarse: Option<&Changes>, known: Known) -> Vec<ContactDerivatives> {
        let same = coarse.filter(|coarse| {
            let counts = |changes: &Changes| changes.intervals.iter().map(Vec::len).collect::<Vec<_>>();
            counts(coarse) == counts(self)
        });
        let contact = |(c, own): (usize, &Vec<IntervalChange>)| {
            let interval = |(j, change): (usize, &IntervalChange)| {
                let found = intervals[c].get(j);
                let with = |get: fn(&IntervalChange) -> f64, output: fn(&Interval) -> Option<f64>| {
                    let there = coarse.and_then(|coarse| coarse.intervals[c].get(j)).map(get);
                    known.beside(get(change), there, found.and_then(output).unwrap_or(0.0))
                };
                let over = found.is_some_and(|interval| interval.end_s.is_some());
                IntervalDerivatives {
                    start_s: with(|change| change.start_s, |found| Some(found.start_s)),
                    end_s: over.then(|| with(|change| change.end_s, |found| found.end_s)),
                    impulse_n_s: with(|change| change.impulse_n_s, |found| Some(found.impulse_n_s)),
                    peak_force_n: with(|change| change.peak_force_n, |found| Some(found.peak_force_n)),
                    peak_compression_m: with(
                        |change| change.peak_compression_m,
                        |found| Some(found.peak_compression_m),
                    ),
                    approach_speed_m_s: with(
                        |change| change.approach_speed_m_s,
                        |found| Some(found.approach_speed_m_s),
                    ),
                    separation_speed_m_s: over
                        .then(|| with(|change| change.separation_speed_m_s, |found| found.separation_speed_m_s)),
                }
            };
            let side = |i: usize, order: usize| {
                let Changed { value, change } = self.sides[c][i][order];
                known.beside(change, same.map(|coarse| coarse.sides[c][i][order].change), value)
            };
            ContactDerivatives {
                intervals: own.iter().enumerate().map(interval).collect(),
                displacement_m: [side(0, 0), side(1, 0)],
                velocity_m_s: [side(0, 1), side(1, 1)],
            }
        };
        self.intervals.iter().enumerate().map(contact).collect()
    }
}
