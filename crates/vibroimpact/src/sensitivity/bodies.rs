//! Derivatives of a scene of bodies with respect to its numbers.

use contact_models::Law;
use serde::Serialize;
use serde_json::Value;
use vibroimpact_sim::assembly::{
    Assembly, Body, BodyMode, Contact, ContactDerivatives, Derivatives, Differentiated, Load, NearMiss, Outcome,
    Parameter, Point, Settings, Solver,
};

use super::collect::collect;
use super::modes::{MODES, Modes};
use super::neighbours::{Neighbours, Posing, around};
use super::refusal::Refusal;
use super::sides::of_tree_of_bodies;
use super::table::{Miss, Output, Table};
use crate::assembly::{AssemblyScene, Posed};
use crate::same_modes::{Match, Seen, matched};
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
    /// Speed of the slowest touch, or of the nearest miss, divided by that of the fastest touch. If it is nearly zero, a contact
    /// is near grazing, and the derivatives hold only for small changes.
    pub nearest_graze: f64,
    /// The nearest graze, if it is a miss.
    pub nearest_miss: Option<Miss>,
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
    /// As [`AssemblyScene::pose`]; a scene without contacts; a field that is not a number, that the scene does not state, or that
    /// cannot vary continuously; a run that is too long, or that has no derivative because a contact grazes or contacts whose force jumps begin at the same
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
        let allowed = "a list with at least one contact, because the outputs to differentiate are those of contacts";
        InvalidInput::unless(!self.contacts.is_empty(), "contacts", "[]", allowed)?;
        let pose = |tree: &Value| AssemblyScene::from_value(tree)?.pose();
        let sort = |near: &mut Posed| take_modes_of(&mut near.assembly, &base.assembly);
        let around = around((&tree, fields), &Posing { pose: &pose, sort: &sort, sides: &of_tree_of_bodies })?;
        let seen = |posed: &Posed| seen(&posed.assembly);
        let modes = Modes::new(seen(&base), around.near.iter().map(|near| near.map(seen)).collect());
        let draws = modes.draws(|errors| with_errors(&base, errors));
        let parameters: Vec<&Neighbours<Posed>> = around.near.iter().chain(&draws).collect();
        let found = differentiate(&base, &parameters)?;
        let name = |contact: usize| format!("contact {:?}", base.contacts[contact]);
        let refusal = |why| Refusal::new(why, found.run.outcome.as_str(), name);
        let outputs = |derivatives: &Derivatives| outputs(&base, &found, derivatives);
        let of_modes = |field: usize| of_modes(&base, &modes, field);
        let table = collect(&around, &modes, &found.derivatives, outputs, of_modes, refusal)?;
        let miss = |miss: NearMiss| Miss::new(miss, Some(base.contacts[miss.contact].clone()));
        Ok(BodiesSensitivity {
            outcome: found.run.outcome.as_str(),
            end_s: found.run.end_s,
            interval_count: found.intervals.iter().map(Vec::len).sum(),
            nearest_graze: found.nearest_graze,
            nearest_miss: found.nearest_miss.map(miss),
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

fn differentiate(base: &Posed, around: &[&Neighbours<Posed>]) -> Result<Differentiated, InvalidInput> {
    let mut parameters = Vec::with_capacity(around.len());
    for Neighbours { offsets, at, .. } in around {
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
    let settings = Settings { max_steps: MOST_PANELS, statistics_from_s: 0.0, ..base.settings };
    let found = solver.differentiate(&settings, &parameters).map_err(in_scene)?;
    if found.run.outcome == Outcome::Stopped(vibroimpact_sim::assembly::Reason::Steps) {
        let allowed = format!("a time that a run reaches within {MOST_PANELS} panels, because the whole run is stored");
        let value = format!("{} of which {:.6e} s were reached", base.settings.end_s, found.run.end_s);
        return Err(InvalidInput::new("end_s", value, allowed));
    }
    Ok(found)
}

fn laws(posed: &Posed) -> impl Iterator<Item = Law> + '_ {
    posed.assembly.contacts.iter().map(|contact| contact.law)
}

/// The outputs of a run by their names in a result.
fn outputs(posed: &Posed, found: &Differentiated, derivatives: &Derivatives) -> Vec<Output> {
    let mut outputs = Vec::new();
    for (c, (name, ContactDerivatives { intervals, .. })) in
        posed.contacts.iter().zip(&derivatives.contacts).enumerate()
    {
        for (i, (own, by)) in found.intervals[c].iter().zip(intervals).enumerate() {
            for (quantity, value, derivative) in [
                ("start_s", Some(own.start_s), Some(by.start_s)),
                ("end_s", own.end_s, by.end_s),
                ("impulse_n_s", Some(own.impulse_n_s), Some(by.impulse_n_s)),
                ("peak_force_n", Some(own.peak_force_n), Some(by.peak_force_n)),
                ("peak_compression_m", Some(own.peak_compression_m), Some(by.peak_compression_m)),
                ("approach_speed_m_s", Some(own.approach_speed_m_s), Some(by.approach_speed_m_s)),
                ("separation_speed_m_s", own.separation_speed_m_s, by.separation_speed_m_s),
            ] {
                let output = |(value, by)| Output::new(format!("contacts.{name}.intervals[{i}].{quantity}"), value, by);
                outputs.extend(value.zip(derivative).map(output));
            }
        }
    }
    for (c, (end, by)) in found.run.contacts.iter().zip(&derivatives.contacts).enumerate() {
        for side in 0..2 {
            let name = |quantity: &str| format!("points[{}].{quantity}", 2 * c + side);
            outputs.push(Output::new(name("displacement_m"), end.displacement_m[side], by.displacement_m[side]));
            outputs.push(Output::new(name("velocity_m_s"), end.velocity_m_s[side], by.velocity_m_s[side]));
        }
    }
    outputs
}

/// Frequencies of the lowest modes that vibrate.
fn of_modes(base: &Posed, modes: &Modes, field: usize) -> Vec<Output> {
    let mut found = Vec::new();
    for (b, (name, body)) in base.bodies.iter().zip(&base.assembly.bodies).enumerate() {
        let vibrating = (0..body.modes.len()).filter(|&k| body.modes[k].omega_rad_s > 0.0);
        for (i, k) in vibrating.take(MODES).enumerate() {
            let name = format!("bodies.{name}.omega_rad_s[{i}]");
            found.push(Output::new(name, body.modes[k].omega_rad_s, modes.omega_rad_s(field, b, k)));
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

/// The modes of each body as they are compared: with their shapes at its contacts, and then under its loads.
fn seen(assembly: &Assembly<Law>) -> Vec<Vec<Seen>> {
    let of_body = |(body, Body { modes, .. }): (usize, &Body)| {
        let of_contacts = assembly.contacts.iter().flat_map(|contact| &contact.sides).filter_map(|point| match point {
            Point::OfBody { body: of, shape } if *of == body => Some(shape),
            _ => None,
        });
        let of_loads = assembly.loads.iter().filter(|load| load.body == body).map(|load| &load.shape);
        let shapes: Vec<&Vec<f64>> = of_contacts.chain(of_loads).collect();
        let of_mode = |(k, mode): (usize, &BodyMode)| Seen {
            omega_rad_s: mode.omega_rad_s,
            shapes: shapes.iter().map(|shape| shape[k]).collect(),
        };
        modes.iter().enumerate().map(of_mode).collect()
    };
    assembly.bodies.iter().enumerate().map(of_body).collect()
}

/// Gives the modes the signs and the order of those of a neighbouring assembly.
fn take_modes_of(near: &mut Assembly<Law>, base: &Assembly<Law>) -> Result<(), &'static str> {
    for (body, (own, found)) in seen(base).into_iter().zip(seen(near)).enumerate() {
        let steps = matched(&own, found)?;
        let Assembly { bodies, contacts, loads } = &mut *near;
        let Body { modes, amplitude, rate } = &mut bodies[body];
        modes.truncate(steps.len());
        for values in [amplitude, rate].into_iter().chain(shapes(contacts, loads, body)) {
            values.truncate(steps.len());
            for (k, Match { from, sign }) in steps.iter().enumerate() {
                values.swap(k, *from);
                values[k] *= sign;
            }
        }
        steps.iter().enumerate().for_each(|(k, step)| modes.swap(k, step.from));
    }
    Ok(())
}

/// The same with errors in the modes that vibrate.
fn with_errors(base: &Posed, errors: &[Vec<Seen>]) -> Posed {
    let mut posed = base.clone();
    let Assembly { bodies, contacts, loads } = &mut posed.assembly;
    for (body, (Body { modes, .. }, errors)) in bodies.iter_mut().zip(errors).enumerate() {
        for (k, (mode, error)) in
            modes.iter_mut().zip(errors).enumerate().filter(|(_, (mode, _))| mode.omega_rad_s > 0.0)
        {
            mode.omega_rad_s += error.omega_rad_s;
            shapes(contacts, loads, body).zip(&error.shapes).for_each(|(list, error)| list[k] += error);
        }
    }
    posed
}
