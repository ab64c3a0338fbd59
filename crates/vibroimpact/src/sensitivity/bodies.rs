//! How a scene of bodies changes with its numbers.

use contact_models::Law;
use serde::Serialize;
use serde_json::Value;
use vibroimpact_sim::assembly::{
    Assembly, Body, BodyMode, ContactDerivatives, Derivative, Derivatives, Differentiated, Outcome, Parameter, Point,
    Settings, Solver,
};

use super::MODES;
use super::neighbours::{Neighbours, around};
use super::table::Table;
use crate::assembly::{AssemblyScene, Posed};
use crate::scene::{InvalidInput, versioned_tree};

/// A run is kept whole while it is differentiated; one of more panels is refused.
const MOST_PANELS: u64 = 100_000;
/// Modes that change by more than this part from a scene to a neighbour of it are not the same ones.
const SAME: f64 = 1e-2;

/// A run of a scene of bodies, with the derivatives of its outputs by fields of the scene.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BodiesSensitivity {
    /// `end` or `rest`.
    pub outcome: &'static str,
    /// When the run ended (s).
    pub end_s: f64,
    /// Number of intervals of contact.
    pub interval_count: usize,
    /// Speed of the slowest touch in parts of the fastest. Where it comes near zero a contact only grazes, and the
    /// derivatives grow beyond all bounds.
    pub nearest_graze: f64,
    /// The fields and the derivatives: outputs are `contacts.NAME.intervals[0].impulse_n_s` and the like,
    /// `points[0].displacement_m` and `points[0].velocity_m_s` of either side of each contact at the end, and
    /// `bodies.NAME.omega_rad_s[0]` and so on for the lowest modes that vibrate.
    #[serde(flatten)]
    pub table: Table,
    /// The scene.
    pub scene: Value,
    /// Version of the program.
    pub version: &'static str,
}

impl AssemblyScene {
    /// Differentiates the run by these fields, each the path of a number that the scene states; by all of them if none is
    /// named.
    ///
    /// # Errors
    /// As [`AssemblyScene::pose`]; a field that is no number, that the scene does not state, or that cannot change by a
    /// little; a run that is too long to be kept, and one that has no derivative: where a contact grazes, and where contacts
    /// whose force jumps touch at the same time.
    ///
    /// ```
    /// use vibroimpact::assembly::AssemblyScene;
    ///
    /// let scene = AssemblyScene::from_json(r#"{
    ///     "bodies": { "ball": { "kind": "mass", "mass_kg": 0.1, "position_m": 0.01 } },
    ///     "contacts": [{ "name": "floor", "between": [{ "body": "ball" }, "ground"],
    ///                    "law": "hertz", "stiffness_n_m1_5": 1e9 }],
    ///     "gravity_m_s2": 9.81, "end_s": 0.08
    /// }"#)?;
    /// let found = scene.sensitivity(&["gravity_m_s2".to_owned()])?;
    /// // it falls for sqrt(2 h / g)
    /// let by_gravity = found.table.of("contacts.floor.intervals[0].start_s", "gravity_m_s2").unwrap();
    /// assert!((by_gravity.value + 0.5 * (2.0 * 0.01f64 / 9.81f64.powi(3)).sqrt()).abs() < 1e-10);
    /// # Ok::<(), vibroimpact::SceneError>(())
    /// ```
    pub fn sensitivity(&self, fields: &[String]) -> Result<BodiesSensitivity, InvalidInput> {
        let tree = versioned_tree(self);
        let base = self.pose()?;
        let (around, left_out) =
            around((&tree, fields), &|tree| AssemblyScene::from_value(tree)?.pose(), &|near: &mut Posed| {
                take_modes_of(&mut near.assembly, &base.assembly)
            })?;
        let found = differentiate(&base, &around)?;
        let Some(derivatives) = &found.derivatives else {
            let allowed = "a run that ends, and in which no contact grazes, no contacts whose forces jump touch at the \
                           same time, and no mode whose damping changes is critically damped: elsewhere there is no \
                           derivative";
            return Err(InvalidInput::new(
                "scene",
                format!("a run that came to {}", found.run.outcome.as_str()),
                allowed,
            ));
        };
        let outputs = |derivatives| outputs(&base, &found, derivatives);
        let by_errors = derivatives.last().map(outputs).unwrap_or_default();
        let mut table = Table::new(&around, left_out);
        for (near, derivatives) in around.iter().zip(derivatives) {
            for ((output, derivative), (_, by_errors)) in outputs(derivatives).into_iter().zip(&by_errors) {
                table.insert(&output, &near.field, near.widened(derivative, *by_errors));
            }
            for (output, derivative) in of_modes(near, &base) {
                table.insert(&output, &near.field, derivative);
            }
        }
        Ok(BodiesSensitivity {
            outcome: found.run.outcome.as_str(),
            end_s: found.run.end_s,
            interval_count: found.intervals.iter().map(Vec::len).sum(),
            nearest_graze: found.nearest_graze,
            table,
            scene: tree,
            version: env!("CARGO_PKG_VERSION"),
        })
    }
}

impl BodiesSensitivity {
    /// What the table and the picture are of where nothing is said: the first impulse of the first contact that closes,
    /// otherwise where the first point is at the end.
    pub fn first_output(&self) -> &str {
        let outputs = || self.table.derivatives.keys();
        let impulse = outputs().find(|output| output.ends_with("intervals[0].impulse_n_s"));
        impulse.or_else(|| outputs().find(|output| output.starts_with("points"))).map_or("", String::as_str)
    }
}

fn differentiate(base: &Posed, around: &[Neighbours<Posed>]) -> Result<Differentiated, InvalidInput> {
    let with_errors = Neighbours::with_errors(|error| with_errors(base, error));
    let mut parameters = Vec::with_capacity(around.len() + 1);
    for Neighbours { offsets, at, .. } in around.iter().chain([&with_errors]) {
        let changed = |near: &Posed| laws(near).ne(laws(base));
        parameters.push(Parameter {
            offsets: *offsets,
            neighbours: at.each_ref().map(|near| &near.assembly),
            end_s: at.each_ref().map(|near| near.settings.end_s),
            changes_laws: at.iter().any(changed),
        });
    }
    let in_scene = |fault| base.in_scene(fault);
    let mut solver = Solver::new(&base.assembly).map_err(in_scene)?;
    let settings = Settings { max_steps: MOST_PANELS, ..base.settings };
    let found = solver.differentiate(&settings, &parameters).map_err(in_scene)?;
    if found.run.outcome == Outcome::Stopped(vibroimpact_sim::assembly::Reason::Steps) {
        let allowed = format!("a time that a run of {MOST_PANELS} panels reaches: it is kept whole. Shorten end_s");
        let value = format!("{} of which {:.6e} s were reached", base.settings.end_s, found.run.end_s);
        return Err(InvalidInput::new("end_s", value, allowed));
    }
    Ok(found)
}

fn laws(posed: &Posed) -> impl Iterator<Item = Law> + '_ {
    posed.assembly.contacts.iter().map(|contact| contact.law)
}

/// The outputs of a run by their names in a result.
fn outputs(posed: &Posed, found: &Differentiated, derivatives: &Derivatives) -> Vec<(String, Derivative)> {
    let mut outputs = Vec::new();
    debug_assert_eq!(found.intervals.len(), derivatives.contacts.len());
    for (name, ContactDerivatives { intervals, .. }) in posed.contacts.iter().zip(&derivatives.contacts) {
        for (i, interval) in intervals.iter().enumerate() {
            for (quantity, derivative) in [
                ("start_s", Some(interval.start_s)),
                ("end_s", interval.end_s),
                ("impulse_n_s", Some(interval.impulse_n_s)),
                ("peak_force_n", Some(interval.peak_force_n)),
                ("peak_compression_m", Some(interval.peak_compression_m)),
                ("approach_speed_m_s", Some(interval.approach_speed_m_s)),
                ("separation_speed_m_s", interval.separation_speed_m_s),
            ] {
                outputs.extend(derivative.map(|by| (format!("contacts.{name}.intervals[{i}].{quantity}"), by)));
            }
        }
    }
    for (c, contact) in derivatives.contacts.iter().enumerate() {
        for side in 0..2 {
            let point = 2 * c + side;
            outputs.push((format!("points[{point}].displacement_m"), contact.displacement_m[side]));
            outputs.push((format!("points[{point}].velocity_m_s"), contact.velocity_m_s[side]));
        }
    }
    outputs
}

/// Frequencies of the lowest modes that vibrate.
fn of_modes(near: &Neighbours<Posed>, base: &Posed) -> Vec<(String, Derivative)> {
    let mut found = Vec::new();
    for (b, (name, body)) in base.bodies.iter().zip(&base.assembly.bodies).enumerate() {
        let vibrating = (0..body.modes.len()).filter(|&k| body.modes[k].omega_rad_s > 0.0);
        for (i, k) in vibrating.take(MODES).enumerate() {
            let omega = |posed: &Posed| posed.assembly.bodies[b].modes[k].omega_rad_s;
            found.push((format!("bodies.{name}.omega_rad_s[{i}]"), near.derivative(omega(base), omega)));
        }
    }
    found
}

/// All shapes of a mode of a body: at its contacts, and then under its loads.
fn shapes(assembly: &mut Assembly<Law>, body: usize, k: usize) -> Vec<&mut f64> {
    let sides = assembly.contacts.iter_mut().flat_map(|contact| &mut contact.sides);
    let of_contacts = sides.filter_map(|point| match point {
        Point::OfBody { body: of, shape } if *of == body => Some(&mut shape[k]),
        _ => None,
    });
    let of_loads = assembly.loads.iter_mut().filter(|load| load.body == body).map(|load| &mut load.shape[k]);
    of_contacts.chain(of_loads).collect()
}

/// Gives the modes the signs and the order of those of an assembly nearby: they may come with another sign, and two of them
/// in another order where their frequencies cross. `false` if they are not the same modes.
fn take_modes_of(near: &mut Assembly<Law>, base: &Assembly<Law>) -> bool {
    let counts = |assembly: &Assembly<Law>| assembly.bodies.iter().map(|body| body.modes.len()).collect::<Vec<_>>();
    if near.contacts.len() != base.contacts.len() || counts(near) != counts(base) {
        return false;
    }
    let mut base = base.clone();
    for body in 0..base.bodies.len() {
        let count = base.bodies[body].modes.len();
        let values = |assembly: &mut Assembly<Law>, k: usize| -> Vec<f64> {
            shapes(assembly, body, k).into_iter().map(|shape| *shape).collect()
        };
        let own: Vec<Vec<f64>> = (0..count).map(|k| values(&mut base, k)).collect();
        let mut found: Vec<Vec<f64>> = (0..count).map(|k| values(near, k)).collect();
        let largest = own.iter().flatten().fold(f64::MIN_POSITIVE, |most, shape| most.max(shape.abs()));
        for k in 0..count {
            let omega = |body: &Body, k: usize| body.modes[k].omega_rad_s;
            let target = omega(&base.bodies[body], k);
            let sign = |there: &[f64]| {
                let product: f64 = own[k].iter().zip(there).map(|(one, other)| one * other).sum();
                if product < 0.0 { -1.0 } else { 1.0 }
            };
            let distance = |i: usize| {
                let there = &found[i];
                let apart = own[k].iter().zip(there).map(|(one, other)| (one - sign(there) * other).abs() / largest);
                let frequency = (target - omega(&near.bodies[body], i)).abs() / target.max(f64::MIN_POSITIVE);
                apart.fold(frequency, f64::max)
            };
            let later = (k + 1..count.min(k + 3)).filter(|i| distance(*i) < distance(k));
            let i = later.min_by(|i, j| distance(*i).total_cmp(&distance(*j))).unwrap_or(k);
            if distance(i) > SAME {
                return false;
            }
            let turned = sign(&found[i]);
            found.swap(k, i);
            let Body { modes, amplitude, rate } = &mut near.bodies[body];
            modes.swap(k, i);
            [amplitude, rate].into_iter().for_each(|values| {
                values.swap(k, i);
                values[k] *= turned;
            });
            if i != k {
                let other = values(near, k);
                let own = values(near, i);
                shapes(near, body, k).into_iter().zip(own).for_each(|(shape, value)| *shape = value);
                shapes(near, body, i).into_iter().zip(other).for_each(|(shape, value)| *shape = value);
            }
            shapes(near, body, k).into_iter().for_each(|shape| *shape *= turned);
        }
    }
    true
}

/// The same with errors in the modes that vibrate.
fn with_errors(base: &Posed, error: &mut dyn FnMut() -> f64) -> Posed {
    let mut posed = base.clone();
    for body in 0..posed.assembly.bodies.len() {
        let vibrates = |mode: &BodyMode| mode.omega_rad_s > 0.0;
        for k in 0..posed.assembly.bodies[body].modes.len() {
            if vibrates(&posed.assembly.bodies[body].modes[k]) {
                posed.assembly.bodies[body].modes[k].omega_rad_s *= error();
                let by = error();
                shapes(&mut posed.assembly, body, k).into_iter().for_each(|shape| *shape *= by);
            }
        }
    }
    posed
}
