//! A sweep: the scene of a point from its number.

use invalid_input::Path;
use serde_json::Value;
use sha2::{Digest, Sha256};

use super::error::SweepError;
use super::evaluate;
use super::file::{self, Contents, canonical_text};
use super::part::Part;
use super::results::Results;
use super::uncertain::Uncertain;
use super::values::{Axis, AxisValues, MAX_POINTS, Random, json_number};
use crate::assembly::AnyScene;
use crate::scene::FieldPath;
use crate::scene::json::{self, quote};
use crate::scene::{InvalidInput, toml};

/// Must be changed whenever the same sweep gives other rows or other columns.
const FORMAT: u32 = 4;
/// Number of points, spread over the sweep, that are checked to find out whether the scene can be solved at all.
const PROBES: u64 = 5;
/// Chunks into which a sweep is divided, unless it is so large that they would hold too many points.
const CHUNKS: u64 = 512;
/// Largest number of points of a chunk, which a thread computes at a time and may have to compute again after an interruption.
const LARGEST_CHUNK: u64 = 128;

/// Many scenes that differ in some fields.
///
/// The points are numbered from 0. The axes of `vary` form a grid, whose last axis runs fastest. With `random`, every point of the
/// grid is combined with all draws, which are the same at each: draw `d` of grid point `g` has the number `g * draws + d`. A
/// point depends only on the sweep and its number.
#[derive(Debug, Clone, PartialEq)]
pub struct Sweep {
    /// A text for the reader.
    pub description: Option<String>,
    /// The axes of the grid.
    pub axes: Vec<Axis>,
    /// Random draws.
    pub random: Option<Random>,
    /// Fields that are given as distributions.
    pub uncertain: Option<Uncertain>,
    scene: Value,
    canonical: Value,
    points: u64,
    results: Results,
}

impl Sweep {
    /// Reads a sweep file, and the scene file that it names: TOML if the name ends in `.toml`, JSON otherwise.
    ///
    /// # Errors
    /// A file that cannot be read, an error in the sweep or in its base scene, or too many points.
    pub fn read(path: &std::path::Path) -> Result<Sweep, SweepError> {
        Ok(Sweep::new(file::read(path)?)?)
    }

    /// Reads a sweep with the scene in it from JSON text.
    ///
    /// # Errors
    /// As [`Sweep::read`], except for the files.
    pub fn from_json(text: &str) -> Result<Sweep, SweepError> {
        Ok(Sweep::from_value(&json::parse(text, file::A_SWEEP)?)?)
    }

    /// Reads a sweep with the scene in it from TOML text.
    ///
    /// # Errors
    /// As [`Sweep::read`], except for the files.
    pub fn from_toml(text: &str) -> Result<Sweep, SweepError> {
        Ok(Sweep::from_value(&toml::parse(text)?)?)
    }

    /// Reads a sweep from a JSON tree with the scene in it.
    ///
    /// # Errors
    /// As [`Sweep::read`], except for the files.
    pub fn from_value(value: &Value) -> Result<Sweep, InvalidInput> {
        Sweep::new(file::from_tree(value.clone())?)
    }

    fn new(contents: Contents) -> Result<Sweep, InvalidInput> {
        let Contents { description, scene, axes, random, uncertain, told, reliability, canonical } = contents;
        let drawn = uncertain.as_ref().map(|uncertain| uncertain.draws().count());
        let sizes = axes.iter().map(Axis::count).chain(random.iter().map(|random| random.draws)).chain(drawn);
        let points = sizes.clone().try_fold(1u64, u64::checked_mul).filter(|points| *points <= MAX_POINTS);
        let points = points.ok_or_else(|| {
            let product = sizes.map(|size| size.to_string()).collect::<Vec<_>>().join(" x ");
            InvalidInput::new("number of points", product, "at most 1e12")
        })?;
        let results = Results::Impact;
        let mut sweep = Sweep { description, axes, random, uncertain, scene, canonical, points, results };
        sweep.check_overlap()?;
        sweep.results = sweep.results_of(&sweep.check_values()?, reliability)?;
        if let Some(uncertain) = &mut sweep.uncertain {
            uncertain.tell(told, &sweep.results).map_err(|found| found.within("sampling"))?;
        }
        sweep.check_scene()?;
        Ok(sweep)
    }

    /// Number of points.
    pub fn points(&self) -> u64 {
        self.points
    }

    /// The varied fields, those of the grid first: the columns of the results.
    pub fn fields(&self) -> impl Iterator<Item = &FieldPath> {
        let random = self.random.iter().flat_map(|random| &random.fields).map(|(field, _)| field);
        let uncertain = self.uncertain.iter().flat_map(|uncertain| &uncertain.fields).map(|(field, _)| field);
        self.axes.iter().map(|axis| &axis.field).chain(random).chain(uncertain)
    }

    /// Their columns. A field that is uncertain about the values of an axis has two.
    pub(super) fn names(&self) -> impl Iterator<Item = String> {
        self.fields().enumerate().map(|(number, field)| {
            if self.axis_before(number).is_some() { format!("drawn.{field}") } else { field.to_string() }
        })
    }

    /// The axis of the field with this number in [`Sweep::fields`], if the field is also uncertain.
    fn axis_before(&self, number: usize) -> Option<usize> {
        let drawn = number.checked_sub(self.axes.len())?;
        let (field, _) = self.uncertain.as_ref()?.fields.get(drawn)?;
        self.axes.iter().position(|axis| axis.field == *field)
    }

    /// Draws at each point of the grid; 1 if nothing is drawn.
    pub(super) fn draws(&self) -> u64 {
        let uncertain = self.uncertain.as_ref().map(|uncertain| uncertain.draws().count());
        self.random.as_ref().map(|random| random.draws).or(uncertain).unwrap_or(1)
    }

    /// The results of the points of a sweep with this scene.
    fn results_of(&self, scene: &AnyScene, reliability: bool) -> Result<Results, InvalidInput> {
        match (scene, &self.uncertain) {
            (AnyScene::Impact(_), _) if reliability => {
                let allowed = "false or left out, because only scenes of bodies have reliable_until_s";
                Err(InvalidInput::new("reliability", "true", allowed))
            }
            (AnyScene::Impact(_), Some(_)) => Ok(Results::Draw),
            _ => Ok(Results::of(scene, reliability)),
        }
    }

    /// The numbers of chunks of a part after which it is decided whether more are needed; the last is the total number.
    pub(super) fn stages(&self, part: Part) -> Vec<u64> {
        let chunks = part.chunks(self.chunks());
        match &self.uncertain {
            // without a grid
            Some(uncertain) if self.is_adaptive() => {
                uncertain.stages().map(|draws| draws.div_ceil(self.points_per_chunk())).collect()
            }
            _ => vec![chunks.end - chunks.start],
        }
    }

    fn is_adaptive(&self) -> bool {
        self.uncertain.as_ref().is_some_and(Uncertain::is_adaptive)
    }

    /// The error for parts of a sweep whose number of draws depends on its sampling error.
    pub(super) fn check_part(&self, part: Part) -> Result<(), InvalidInput> {
        if part == Part::WHOLE { Ok(()) } else { self.check_undivided() }
    }

    /// Whether the points may be computed on several machines.
    pub(super) fn check_undivided(&self) -> Result<(), InvalidInput> {
        match self.canonical.pointer("/sampling/sampling_error") {
            Some(error) if self.is_adaptive() => {
                let allowed =
                    "left out, because a sweep that is computed in parts or over MPI has a fixed number of draws";
                Err(InvalidInput::new(["sampling", "sampling_error"], quote(error), allowed))
            }
            _ => Ok(()),
        }
    }

    /// For each axis the number of its value at a point.
    pub(super) fn places(&self, point: u64) -> Vec<u64> {
        let mut rest = point / self.draws();
        let mut places: Vec<u64> = Vec::with_capacity(self.axes.len());
        for axis in self.axes.iter().rev() {
            places.push(rest % axis.count());
            rest /= axis.count();
        }
        places.reverse();
        places
    }

    /// The results of each point.
    pub(super) fn results(&self) -> &Results {
        &self.results
    }

    /// The values of the varied fields at a point, in the order of [`Sweep::fields`].
    pub fn values(&self, point: u64) -> Vec<Value> {
        let grid = self.axes.iter().zip(self.places(point)).map(|(axis, place)| axis.value(place));
        let random = self.random.iter().flat_map(|random| random.draw(point % random.draws));
        let mut values: Vec<Value> = grid.chain(random).collect();
        let Some(uncertain) = &self.uncertain else { return values };
        let drawn = uncertain.draw(point % self.draws());
        for (drawn, (_, distribution)) in drawn.into_iter().zip(&uncertain.fields) {
            let beside = self.axis_before(values.len()).and_then(|axis| values[axis].as_f64());
            values.push(json_number(beside.map_or(drawn, |value| distribution.about(value, drawn))));
        }
        values
    }

    /// The scene with these values of the varied fields.
    pub(super) fn scene_with(&self, values: &[Value]) -> Result<AnyScene, InvalidInput> {
        self.scene_in(&mut self.scene.clone(), values)
    }

    /// The same in a copy of the scene's tree, which serves for many points.
    pub(super) fn scene_in(&self, tree: &mut Value, values: &[Value]) -> Result<AnyScene, InvalidInput> {
        for (field, value) in self.fields().zip(values) {
            let set = field.set(tree, value.clone());
            set.map_err(|reason| {
                InvalidInput::new(field.path().clone(), quote(value), format!("a field of the scene, but {reason}"))
            })?;
        }
        AnyScene::from_value(tree)
    }

    /// The scene as a tree, before fields are varied.
    pub(super) fn tree(&self) -> &Value {
        &self.scene
    }

    /// The scene of a point.
    ///
    /// # Errors
    /// Values that do not form a valid scene.
    pub fn scene(&self, point: u64) -> Result<AnyScene, InvalidInput> {
        self.scene_with(&self.values(point))
    }

    /// Points of a chunk, the unit of work; the last chunk may have fewer.
    pub(super) fn points_per_chunk(&self) -> u64 {
        let whole = self.uncertain.as_ref().map(|uncertain| uncertain.draws_per_chunk(LARGEST_CHUNK));
        whole.unwrap_or((self.points / CHUNKS).clamp(1, LARGEST_CHUNK))
    }

    pub(super) fn chunks(&self) -> u64 {
        self.points.div_ceil(self.points_per_chunk())
    }

    /// The first point of a chunk; for the chunk after the last, the number of points.
    pub(super) fn first_of_chunk(&self, chunk: u64) -> u64 {
        chunk.saturating_mul(self.points_per_chunk()).min(self.points)
    }

    /// The sweep as a JSON tree with its scene in it.
    pub(super) fn canonical(&self) -> &Value {
        &self.canonical
    }

    /// A fingerprint that differs for two sweeps whose rows may differ.
    pub fn fingerprint(&self) -> String {
        let version = env!("CARGO_PKG_VERSION");
        let text = format!("vibroimpact {version}, format {FORMAT}\n{}", canonical_text(&self.canonical));
        Sha256::digest(text).iter().map(|byte| format!("{byte:02x}")).collect()
    }

    /// The path in the sweep file of the field with this number in [`Sweep::fields`].
    fn entry(&self, number: usize) -> Path {
        match number.checked_sub(self.axes.len()) {
            None => ("vary", number).into(),
            Some(drawn) => match self.uncertain.as_ref().and_then(|uncertain| uncertain.fields.get(drawn)) {
                Some((field, _)) => Path::from(field.to_string()).within("uncertain"),
                None => Path::from(("fields", drawn)).within("random"),
            },
        }
    }

    /// The place in the sweep file where the path of that field is stated.
    fn entry_field(&self, number: usize) -> Path {
        let entry = self.entry(number);
        if self.uncertain.is_some() && number >= self.axes.len() { entry } else { Path::from("field").within(entry) }
    }

    /// Checks that no field overwrites an earlier one.
    fn check_overlap(&self) -> Result<(), InvalidInput> {
        let fields: Vec<&FieldPath> = self.fields().collect();
        for (i, field) in fields.iter().enumerate() {
            let beside = self.axis_before(i);
            if let Some(axis) = beside.filter(|axis| !self.axes[*axis].is_numeric()) {
                let allowed = format!("a list of numbers, because {} is uncertain about them", self.entry(i));
                return Err(InvalidInput::new(Path::from("values").within(self.entry(axis)), "[...]", allowed));
            }
            let mut others = fields[..i].iter().enumerate().filter(|(before, _)| beside != Some(*before));
            if let Some((before, _)) = others.find(|(_, before)| field.holds(before.path())) {
                let allowed = format!("a field that does not overwrite the field of {}", self.entry(before));
                return Err(InvalidInput::new(self.entry_field(i), format!("\"{field}\""), allowed));
            }
        }
        Ok(())
    }

    /// Checks that every field exists in the scene, and that every value, with the others at their first, has a type that the field
    /// accepts. Returns the scene of the first point.
    fn check_values(&self) -> Result<AnyScene, InvalidInput> {
        let first = self.values(0);
        let mut tree = self.scene.clone();
        for (i, (field, value)) in self.fields().zip(&first).enumerate() {
            field.set(&mut tree, value.clone()).map_err(|reason| {
                let allowed = format!("the path of a field of the scene, but {reason}");
                InvalidInput::new(self.entry_field(i), format!("\"{field}\""), allowed)
            })?;
        }
        let scene = AnyScene::from_value(&tree).map_err(|fault| self.blame(fault))?;
        for (i, axis) in self.axes.iter().enumerate() {
            let numbers: Vec<u64> = match &axis.values {
                AxisValues::Range(_, count) => vec![1, count - 1],
                AxisValues::List(values) => (1..values.len() as u64).collect(),
            };
            for number in numbers {
                let mut values = first.clone();
                values[i] = axis.value(number);
                self.scene_with(&values).map_err(|fault| {
                    let AxisValues::List(_) = axis.values else { return self.unfit(i, &values[i], &fault) };
                    let name: Path = ("vary", i, ("values", number as usize)).into();
                    let allowed = format!("a value that the scene can have; with it, {fault}");
                    InvalidInput::new(name, quote(&values[i]), allowed)
                })?;
            }
        }
        Ok(scene)
    }

    /// An error of a value within the interval of the varied field with this number.
    fn unfit(&self, number: usize, value: &Value, fault: &InvalidInput) -> InvalidInput {
        let axis = self.axes.get(number).and_then(|axis| match &axis.values {
            AxisValues::Range(interval, _) => Some(interval),
            AxisValues::List(_) => None,
        });
        let drawn = || Some(&self.random.as_ref()?.fields.get(number.checked_sub(self.axes.len())?)?.1);
        let ends = axis.or_else(drawn).map_or_else(String::new, |all| format!("{} to {}", all.from, all.to));
        let allowed = format!(
            "an interval of values that the scene can have, where needed with \"whole_numbers\": true; with {}, {fault}",
            quote(value)
        );
        InvalidInput::new(self.entry(number), ends, allowed)
    }

    /// The number of the varied field with an error.
    fn varies(&self, fault: &InvalidInput) -> Option<usize> {
        self.fields().position(|field| field.holds(&fault.field))
    }

    /// An error at the first point, with the field that has to be changed in the sweep file.
    fn blame(&self, fault: InvalidInput) -> InvalidInput {
        match self.varies(&fault) {
            None => fault.within("scene"),
            Some(i) if fault.is_unknown => {
                InvalidInput::unknown(self.entry_field(i), format!("\"{}\"", fault.field), fault.allowed)
            }
            Some(i) if self.uncertain.is_some() && i >= self.axes.len() => fault.under(self.entry(i)),
            Some(i) => match self.axes.get(i).map(|axis| &axis.values) {
                Some(AxisValues::List(_)) => fault.under(Path::from(("values", 0)).within(self.entry(i))),
                Some(AxisValues::Range(..)) => fault.under(Path::from("from").within(self.entry(i))),
                None => self.unfit(i, &self.values(0)[i], &fault),
            },
        }
    }

    /// Rejects a scene that cannot be solved for a reason that does not depend on the varied fields.
    fn check_scene(&self) -> Result<(), InvalidInput> {
        let mut faults = Vec::new();
        let probes = PROBES.min(self.points);
        for probe in 0..probes {
            // there are at most 1e12 points, so that the product is exact
            let point = (self.points - 1) * probe / (probes - 1).max(1);
            match self.scene(point).and_then(|scene| evaluate::check(&scene)) {
                Ok(()) => return Ok(()),
                Err(fault) => faults.push(fault),
            }
        }
        // an error of a varied field may concern only some of its values; an error of a fixed field concerns all points
        let (varied, fast): (Vec<_>, Vec<_>) = faults.iter().partition(|fault| self.varies(fault).is_some());
        let judged = if fast.is_empty() { varied } else { fast };
        match judged.split_first() {
            Some((first, others)) if others.iter().all(|other| other == first) => Err(self.blame((*first).clone())),
            _ => Ok(()),
        }
    }
}
