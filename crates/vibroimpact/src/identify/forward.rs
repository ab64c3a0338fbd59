//! From parameters to predictions: the impact of each row, resolved with one number of modes.

use std::num::NonZero;
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use contact_models::Law;
use serde_json::{Value, json};
use vibroimpact_sim::modal::{History, Settings, Solution};

use super::data::{Data, Row};
use super::free::Free;
use super::gauge::{FORCE_FILE, Signal};
use super::quantity::Quantity;
use crate::impact::Impact;
use crate::in_scene::in_scene;
use crate::model::{Kept, chooses_modes, more};
use crate::scene::FieldPath;
use crate::scene::json::{number, quote};
use crate::scene::told::did_you_mean_one_of;
use crate::scene::{InvalidInput, Scene};

/// Tolerance of the solver: differences of impacts are to be smooth.
const TOLERANCE: f64 = 1e-10;
/// Largest cost of an impact; the search avoids parameters with more expensive impacts, which were not measured.
const MOST_SUB_IMPACTS: usize = 1000;
const MOST_STEPS: u64 = 20_000;
/// Rows, spread over the table, for which the number of modes is chosen.
const PROBES: usize = 12;
/// Measured quantities are to be independent of the number of modes within this share of the stated noise, and the restitution within these
/// limits.
pub(super) const SHARE_OF_NOISE: f64 = 0.2;
const TIGHTEST: f64 = 1e-6;
const LOOSEST: f64 = 1e-2;

/// For other quantities the number of modes is raised step by step, until it exceeds a limit. All further modes are assumed to change a
/// quantity by so many times the change from two such steps.
const MOST_MODES: usize = 500;
const FURTHER: f64 = 3.0;

/// The impacts of a table as functions of the free fields.
pub(super) struct Model<'a> {
    pub data: &'a Data,
    pub free: &'a [Free],
    tree: Value,
    modes: Option<usize>,
    /// Largest change of a measured quantity by further modes, in standard deviations of its noise, where it was estimated.
    left_out_sd: Option<f64>,
    /// Memory that is reused from impact to impact, for each thread.
    kept: Vec<Mutex<Kept>>,
}

/// Rows that together take less than this are solved on one thread, since starting another costs as much.
const WORTH_A_THREAD: Duration = Duration::from_millis(4);

/// A resolved impact of a row.
pub(super) struct Course {
    pub solution: Solution,
    /// The output of the force gauge, if one was recorded.
    pub signal: Option<Signal>,
}

impl<'a> Model<'a> {
    /// The impacts of `data` on the scene in `tree`; chooses the number of modes with the free fields at `start`.
    pub fn new(tree: &Value, data: &'a Data, free: &'a [Free], start: &[f64]) -> Result<Model<'a>, InvalidInput> {
        let threads = thread::available_parallelism().map_or(1, NonZero::get).min(data.rows.len());
        let kept = (0..threads).map(|_| Mutex::default()).collect();
        let mut model = Model { data, free, tree: tree.clone(), modes: None, left_out_sd: None, kept };
        model.require_limits(start)?;
        let mut kept = Kept::default();
        let (mut most, mut probes) = (None, Vec::new());
        let stride = data.rows.len().div_ceil(PROBES);
        for (i, row) in data.rows.iter().enumerate() {
            let scene = model.scene(row, start)?;
            if scene.is_infinite() {
                let allowed =
                    "that of a structure with modes: a beam, string or plate with ends, a rod, or a list of modes";
                return Err(InvalidInput::new(["structure", "kind"], scene.structure.kind(), allowed));
            }
            let in_line = |fault| model.in_line(row, fault);
            scene.check().map_err(in_line)?;
            let count = if !chooses_modes(&scene) {
                scene.modes.count()
            } else if i % stride == 0 {
                let tolerance = Some(tolerance(&scene, row));
                let scene = Scene { model: crate::model::Model::Modal, tolerance, ..scene };
                let answer = scene.answer_with(&mut kept).map_err(in_line)?;
                // the theory of bending is chosen together with the modes and then fixed
                if let (None, Some(beam)) = (most, model.tree.get_mut("structure")) {
                    let answered = scene.as_answered(Some(&answer)).tree();
                    if let Some(theory) = answered.get("structure").and_then(|structure| structure.get("theory")) {
                        beam["theory"] = theory.clone();
                    }
                }
                if of_other_quantities(row).next().is_some() {
                    probes.push(row);
                }
                Some(answer.modes)
            } else {
                None
            };
            most = most.max(count);
        }
        model.modes = most;
        // an impact that cannot be resolved is reported before the search begins
        model.require_impacts(start, &mut kept)?;
        model.resolve_quantities(&probes, start, &mut kept);
        let begun = Instant::now();
        data.rows.iter().for_each(|row| drop(model.course(row, start, &mut kept)));
        if begun.elapsed() < WORTH_A_THREAD {
            model.kept.truncate(1);
        }
        Ok(model)
    }

    /// Checks that free fields may have the stated limits of their search, in the scene of the first row.
    fn require_limits(&self, start: &[f64]) -> Result<(), InvalidInput> {
        let Some(row) = self.data.rows.first() else { return Ok(()) };
        for (j, free) in self.free.iter().enumerate().filter(|(_, free)| !free.is_of_gauge()) {
            let (Some((low, high)), Some(path)) = (free.search, FieldPath::parse(&free.field)) else { continue };
            for limit in [low, high] {
                let mut parameters = start.to_vec();
                parameters[j] = limit;
                let checked = self.scene(row, &parameters).and_then(|scene| scene.check());
                // an error in another field may come from the row, or from both fields; the search avoids such values
                if let Err(fault) = checked
                    && fault.field.steps().ends_with(path.path().steps())
                {
                    let name = format!("--free {}", free.field);
                    let allowed = format!("low..high with two values that the field can have, each {}", fault.allowed);
                    return Err(InvalidInput::new(name, format!("{}..{}", number(low), number(high)), allowed));
                }
            }
        }
        Ok(())
    }

    /// Checks that every row is an impact on the structure.
    fn require_impacts(&self, parameters: &[f64], kept: &mut Kept) -> Result<(), InvalidInput> {
        let valid = |row: &Row| {
            let checked = self.scene(row, parameters)?.check().and_then(|()| self.impact(row, parameters, kept));
            checked.map(drop).map_err(|fault| self.in_line(row, fault))
        };
        self.data.rows.iter().try_for_each(valid)
    }

    /// Checks a table of candidates: its fields are those of the scene that are not free, and every row is an impact.
    pub fn require_candidates(&self, candidates: &Data, parameters: &[f64]) -> Result<(), InvalidInput> {
        let is_free = |field: &&FieldPath| self.free.iter().any(|free| free.field == field.to_string());
        if let Some(field) = candidates.fields.iter().find(is_free) {
            let allowed = "left out of a table of candidates, because the field is free";
            return Err(InvalidInput::new(format!("column {field}"), "1 column", allowed));
        }
        let checked = self.for_table(candidates).require_impacts(parameters, &mut Kept::default());
        checked.map_err(|fault| if candidates.name.is_some() { fault } else { fault.in_place("the candidates") })
    }

    /// The same impacts for another table, with the number of modes that was chosen.
    pub fn for_table<'b>(&'b self, data: &'b Data) -> Model<'b> {
        let kept = self.kept.iter().map(|_| Mutex::default()).collect();
        Model { data, free: self.free, tree: self.tree.clone(), modes: self.modes, left_out_sd: self.left_out_sd, kept }
    }

    /// The number of modes that was chosen or stated; `None` for all that are listed.
    pub fn modes(&self) -> Option<usize> {
        self.modes
    }

    /// Largest change of a measured quantity other than the restitution by further modes, in standard deviations of its noise, where it
    /// was estimated.
    pub fn left_out_sd(&self) -> Option<f64> {
        self.left_out_sd
    }

    /// Raises the number of modes until further ones change no measured quantity of these rows by more than a share of its noise. Modes that
    /// hardly change the restitution may change a peak force. It ends earlier where the impacts with more modes cannot be resolved.
    fn resolve_quantities(&mut self, rows: &[&Row], parameters: &[f64], kept: &mut Kept) {
        let Some(count) = self.modes.filter(|_| !rows.is_empty()) else { return };
        let mut in_noise = |count| {
            self.modes = Some(count);
            let of_row = |row: &&Row| self.in_noise(row, parameters, kept);
            (count, rows.iter().map(of_row).collect::<Option<Vec<_>>>().map(|rows| rows.concat()))
        };
        let mut tried: Vec<_> = [count, more(count), more(more(count))].map(&mut in_noise).into();
        let mut left_out_sd = None;
        while let [(_, Some(here)), (next, Some(more_modes)), (last, Some(most_modes))] = &tried[..] {
            let change = largest_change(here, more_modes).max(largest_change(here, most_modes));
            left_out_sd = Some(FURTHER * change);
            if FURTHER * change <= SHARE_OF_NOISE || *next > MOST_MODES {
                break;
            }
            let following = in_noise(more(*last));
            tried.remove(0);
            tried.push(following);
        }
        self.modes = tried.first().map(|(count, _)| *count);
        self.left_out_sd = left_out_sd;
    }

    /// The other measured quantities of a row, in standard deviations; `None` if its impact cannot be resolved.
    fn in_noise(&self, row: &Row, parameters: &[f64], kept: &mut Kept) -> Option<Vec<f64>> {
        let Course { solution, .. } = self.course(row, parameters, kept)?;
        Some(of_other_quantities(row).map(|(quantity, sd)| quantity.of(&solution) / sd).collect())
    }

    /// The scene of a row.
    fn scene(&self, row: &Row, parameters: &[f64]) -> Result<Scene, InvalidInput> {
        let mut tree = self.tree.clone();
        let mut faults = Ok(());
        let mut set = |path: &FieldPath, value: Value| {
            let told = quote(&value);
            if let Err(reason) = path.set(&mut tree, value) {
                faults =
                    Err(InvalidInput::new(path.path().clone(), told, format!("a field of the scene, but {reason}")));
            }
        };
        for (field, value) in self.data.fields.iter().zip(&row.values) {
            set(field, value.clone());
        }
        for (free, value) in self.free.iter().zip(parameters) {
            if let Some(path) = FieldPath::parse(&free.field).filter(|_| !free.is_of_gauge()) {
                set(&path, json!(value));
            }
        }
        faults.and_then(|()| Scene::from_value(&tree)).map_err(|fault| self.in_line(row, self.or_quantity(fault)))
    }

    /// An error in the scene of a row, with its line and the name of the table.
    fn in_line(&self, row: &Row, fault: InvalidInput) -> InvalidInput {
        let fault = fault.in_line(row.line);
        match &self.data.name {
            Some(name) => fault.in_place(name.clone()),
            None => fault,
        }
    }

    /// A column that is no field of the scene may be a measured quantity with a slip in its name.
    fn or_quantity(&self, fault: InvalidInput) -> InvalidInput {
        let column = self.data.fields.iter().find(|field| *field.path() == fault.field);
        let (Some(column), true, true) = (column, fault.is_unknown, self.data.measures()) else { return fault };
        let told = fault.allowed.to_string();
        let fields = told.split(';').next().unwrap_or_default();
        let allowed = format!("{fields}, {}, {FORCE_FILE}", Quantity::names());
        let meant = did_you_mean_one_of(&column.to_string(), &allowed);
        InvalidInput { allowed: allowed + &meant, ..fault }
    }

    /// The impact of a row.
    pub fn impact(&self, row: &Row, parameters: &[f64], kept: &mut Kept) -> Result<Impact, InvalidInput> {
        let scene = self.scene(row, parameters)?;
        let scene = match (chooses_modes(&scene), scene.residual_compliance) {
            (true, None) => Scene { residual_compliance: Some(true), ..scene },
            _ => scene,
        };
        let impact = scene.impact_of(self.modes, kept)?;
        let settings = Settings {
            tolerance: TOLERANCE,
            estimate_uncertainty: false,
            max_sub_impacts: MOST_SUB_IMPACTS,
            max_steps: MOST_STEPS,
            ..impact.settings
        };
        Ok(Impact { settings, ..impact })
    }

    /// Resolves the impact of a row; `None` if it cannot be resolved, or takes too long.
    pub fn course(&self, row: &Row, parameters: &[f64], kept: &mut Kept) -> Option<Course> {
        let course = self.resolve(row, parameters, kept).ok()?;
        course.solution.outcome.stopped_by().is_none().then_some(course)
    }

    fn resolve(&self, row: &Row, parameters: &[f64], kept: &mut Kept) -> Result<Course, InvalidInput> {
        let impact = self.impact(row, parameters, kept)?;
        let solver = impact.solver_with(kept)?;
        let Impact { striker, law, start, settings, .. } = &impact;
        if row.force.is_none() {
            let solution = solver.solve(striker, law, start.as_ref(), settings).map_err(in_scene)?;
            return Ok(Course { solution, signal: None });
        }
        let (solution, history): (Solution, History<Law>) =
            solver.record(striker, law, start.as_ref(), settings).map_err(in_scene)?;
        let constant = self.free.iter().position(Free::is_of_gauge).and_then(|place| parameters.get(place));
        let signal = Some(Signal::new(&history, constant.copied().unwrap_or(0.0)));
        Ok(Course { solution, signal })
    }

    /// Calls `work` for every row, on all threads; the results are in the order of the rows.
    pub fn for_rows<T: Send>(&self, work: impl Fn(usize, &Row, &mut Kept) -> T + Sync) -> Vec<T> {
        let size = self.data.rows.len().div_ceil(self.kept.len().max(1)).max(1);
        let chunks = self.data.rows.chunks(size).zip(&self.kept).enumerate();
        let of_chunk = |(chunk, (rows, kept)): (usize, (&[Row], &Mutex<Kept>))| -> Vec<T> {
            let mut kept = kept.lock().unwrap_or_else(PoisonError::into_inner);
            rows.iter().enumerate().map(|(i, row)| work(chunk * size + i, row, &mut kept)).collect()
        };
        if self.kept.len() == 1 {
            return chunks.flat_map(of_chunk).collect();
        }
        thread::scope(|scope| {
            let of_chunk = &of_chunk;
            let threads: Vec<_> = chunks.map(|chunk| scope.spawn(move || of_chunk(chunk))).collect();
            let joined = threads.into_iter().map(|thread| thread.join());
            joined.flat_map(|rows| rows.unwrap_or_else(|panic| std::panic::resume_unwind(panic))).collect()
        })
    }
}

/// The accuracy for which modes are chosen: a share of the stated noise, or the scene's own where none is stated.
fn tolerance(scene: &Scene, row: &Row) -> f64 {
    let noise = row.measured.iter().filter_map(|(quantity, value, sd)| match quantity {
        Quantity::Restitution => *sd,
        _ => sd.map(|sd| sd / value.abs().max(sd)),
    });
    let least = noise.fold(f64::INFINITY, f64::min);
    let stated = scene.tolerance.unwrap_or(crate::model::DEFAULT_TOLERANCE);
    if least.is_finite() { (SHARE_OF_NOISE * least).clamp(TIGHTEST, LOOSEST) } else { stated }
}

/// The measured quantities of a row whose noise is stated, except the restitution, with their standard deviations.
fn of_other_quantities(row: &Row) -> impl Iterator<Item = (Quantity, f64)> {
    let stated = row.measured.iter().filter_map(|(quantity, _, sd)| sd.map(|sd| (*quantity, sd)));
    stated.filter(|(quantity, _)| *quantity != Quantity::Restitution)
}

/// Largest difference of two lists; a quantity that only one of them has differs by any amount.
fn largest_change(one: &[f64], other: &[f64]) -> f64 {
    let change = |(a, b): (&f64, &f64)| match (a.is_nan(), b.is_nan()) {
        (false, false) => (a - b).abs(),
        (true, true) => 0.0,
        _ => f64::MAX,
    };
    one.iter().zip(other).map(change).fold(0.0, f64::max)
}
