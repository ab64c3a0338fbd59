//! Derivatives of a scene of bodies with respect to its numbers.

use contact_models::Law;
use serde::Serialize;
use serde_json::Value;
use vibroimpact_sim::assembly::{
    Assembly, Body, BodyMode, Contact, ContactDerivatives, Derivative, Derivatives, Differentiated, Load, NoDerivative,
    Outcome, Parameter, Point, Settings, Solver,
};

use super::neighbours::{MODES, Neighbours, around};
use super::refusal::refusal;
use super::table::Table;
use crate::assembly::{AssemblyScene, Posed};
use crate::same_modes::{Seen, matched};
use crate::scene::{InvalidInput, versioned_tree};

/// A run is held in memory while it is differentiated; a run with more panels is rejected.
const MOST_PANELS: u64 = 100_000;

/// A run of a scene of bodies, with the derivatives of its outputs with respect to fields of the scene.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BodiesSensitivity {
    /// `end` or `rest`.
    pub outcome: &'static str,
    /// The time at which the run ended (s).
    pub end_s: f64,
    /// Number of intervals of contact.
    pub interval_count: usize,
    /// Speed of the slowest touch divided by that of the fastest. If it is nearly zero, a contact is near grazing, and the
    /// derivatives are very large.
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
    /// Differentiates the run with respect to these fields, each the path of a number that the scene states, or to all numbers if
    /// none is named.
    ///
    /// # Errors
    /// As [`AssemblyScene::pose`]; a field that is not a number, that the scene does not state, or that cannot vary continuously; a
    /// run that is too long, or that has no derivative because a contact grazes or contacts whose force jumps begin at the same
    /// time.
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
        let name = |contact: usize| format!("contact {:?}", base.contacts[contact]);
        let refused = |why: &NoDerivative| refusal(*why, found.run.outcome.as_str(), name);
        let derivatives = found.derivatives.as_ref().map_err(refused)?;
        let outputs = |derivatives| outputs(&base, derivatives);
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
    /// The default output of table and figure: the first impulse of the first contact that closes, otherwise the final displacement
    /// of the first point.
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
    let solver = Solver::new(&base.assembly).map_err(in_scene)?;
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
fn outputs(posed: &Posed, derivatives: &Derivatives) -> Vec<(String, Derivative)> {
    let mut outputs = Vec::new();
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

/// The shapes of a body's modes: at its contacts, and then under its loads.
fn shapes<'a>(
    contacts: &'a mut [Contact<Law>],
    loads: &'a mut [Load],
    body: usize,
) -> impl Iterator<Item = &'a mut Vec<f64>> {
    let of_contacts = contacts.iter_mut().flat_map(|contact| &mut contact.sides).filter_map(move |point| match point {
        Point::OfBody { body: of, shape } if *of == body => Some(shape),
        _ => None,
    });
    of_contacts.chain(loads.iter_mut().filter(move |load| load.body == body).map(|load| &mut load.shape))
}

/// Gives the modes the signs and the order of those of a neighbouring assembly. `false` if they are not the same modes.
fn take_modes_of(near: &mut Assembly<Law>, base: &Assembly<Law>) -> bool {
    if near.contacts.len() != base.contacts.len() || near.bodies.len() != base.bodies.len() {
        return false;
    }
    let mut base = base.clone();
    let seen = |Assembly { bodies, contacts, loads }: &mut Assembly<Law>, body: usize| -> Vec<Seen> {
        let lists: Vec<&mut Vec<f64>> = shapes(contacts, loads, body).collect();
        let of = |(k, mode): (usize, &BodyMode)| Seen {
            omega_rad_s: mode.omega_rad_s,
            shapes: lists.iter().map(|list| list[k]).collect(),
        };
        bodies[body].modes.iter().enumerate().map(of).collect()
    };
    for body in 0..base.bodies.len() {
        let Some(steps) = matched(&seen(&mut base, body), seen(near, body)) else { return false };
        for (k, (i, sign)) in steps.into_iter().enumerate() {
            let Assembly { bodies, contacts, loads } = &mut *near;
            let Body { modes, amplitude, rate } = &mut bodies[body];
            modes.swap(k, i);
            for values in [amplitude, rate].into_iter().chain(shapes(contacts, loads, body)) {
                values.swap(k, i);
                values[k] *= sign;
            }
        }
    }
    true
}

/// The same with errors in the modes that vibrate.
fn with_errors(base: &Posed, error: &mut dyn FnMut() -> f64) -> Posed {
    let mut posed = base.clone();
    let Assembly { bodies, contacts, loads } = &mut posed.assembly;
    for (body, Body { modes, .. }) in bodies.iter_mut().enumerate() {
        for (k, mode) in modes.iter_mut().enumerate().filter(|(_, mode)| mode.omega_rad_s > 0.0) {
            mode.omega_rad_s *= error();
            let by = error();
            shapes(contacts, loads, body).for_each(|list| list[k] *= by);
        }
    }
    posed
}
