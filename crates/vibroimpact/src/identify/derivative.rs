//! Predictions of the impact of a row, and their derivatives with respect to the free fields.

use fitting::Parameter;
use vibroimpact_sim::modal::{self as solver, Start};

use super::data::Row;
use super::forward::{Course, Model};
use super::quantity::Quantity;
use crate::impact::Impact;
use crate::model::Kept;

/// Step of the differences in the transformed coordinate. With impacts resolved to 1e-10 and differences of the fourth order,
/// rounding leaves about 1e-6 of the derivative, and truncation less.
const STEP: f64 = 1e-4;

/// Predictions for a row.
pub(super) struct Prediction {
    /// The measured quantities in their order, then the samples of the gauge at the offset.
    pub values: Vec<f64>,
    /// Offset of the clock of the gauge (s), if there is one.
    pub offset_s: Option<f64>,
    /// Number of contacts of the impact.
    pub sub_impacts: usize,
}

/// The predictions of a row, with the gauge at the offset `offset_s`, or at the best offset.
pub(super) fn predict(
    model: &Model,
    row: &Row,
    parameters: &[f64],
    offset_s: Option<f64>,
    kept: &mut Kept,
) -> Option<Prediction> {
    let course = model.course(row, parameters, kept)?;
    Some(seen(row, &course, offset_s))
}

fn seen(row: &Row, course: &Course, offset_s: Option<f64>) -> Prediction {
    let mut values: Vec<f64> = row.measured.iter().map(|(quantity, ..)| quantity.of(&course.solution)).collect();
    let gauge = row.force.as_ref().zip(course.signal.as_ref());
    let offset_s = gauge.map(|((record, _), signal)| offset_s.unwrap_or_else(|| record.offset_s(signal)));
    if let Some((((record, _), signal), offset_s)) = gauge.zip(offset_s) {
        values.extend(record.time_s.iter().map(|t| signal.at(t - offset_s)));
    }
    Prediction { values, offset_s, sub_impacts: course.solution.sub_impacts.len() }
}

/// Derivatives of the predictions of a row.
pub(super) struct Derivatives {
    /// With respect to the coordinates of the parameters: prediction `i` and coordinate `j` at `i * n + j`.
    pub rows: Vec<f64>,
    /// Derivatives of the samples of the gauge with respect to the offset of its clock (N/s); empty without a gauge.
    pub in_offset: Vec<f64>,
    /// Whether the number of contacts changes within the steps. The impact is then near grazing, and the derivative may not exist.
    pub grazes: bool,
}

/// Derivatives of the predictions of a row in the transformed coordinates: those of the motion's tangent, and differences for a
/// force history and where the tangent does not exist. `None` where an impact cannot be resolved.
pub(super) fn derivatives(
    model: &Model,
    row: &Row,
    coordinates: &[Parameter],
    parameters: &[f64],
    kept: &mut Kept,
) -> Option<Derivatives> {
    if row.force.is_none()
        && let Some(rows) = tangent(model, row, coordinates, parameters, kept)
    {
        return Some(Derivatives { rows, in_offset: Vec::new(), grazes: false });
    }
    differences(model, row, coordinates, parameters, kept)
}

/// The four neighbouring points, in steps, for the solver's derivatives and for differences.
const STEPS: [f64; 4] = [-2.0, -1.0, 1.0, 2.0];

fn shifted(coordinates: &[Parameter], parameters: &[f64], j: usize, steps: f64) -> Vec<f64> {
    let mut shifted = parameters.to_vec();
    shifted[j] = coordinates[j].outward(coordinates[j].inward(parameters[j]) + steps * STEP);
    shifted
}

/// By the implicit function theorem along the motion, [`vibroimpact_sim::modal::Solver::differentiate`].
fn tangent(
    model: &Model,
    row: &Row,
    coordinates: &[Parameter],
    parameters: &[f64],
    kept: &mut Kept,
) -> Option<Vec<f64>> {
    let here = model.impact(row, parameters, kept).ok()?;
    let at_rest = Start::at_rest(here.structure.modes.len());
    let mut neighbours: Vec<Vec<Impact>> = Vec::with_capacity(coordinates.len());
    for j in 0..coordinates.len() {
        let near = |steps| model.impact(row, &shifted(coordinates, parameters, j, steps), kept).ok();
        neighbours.push(STEPS.into_iter().map(near).collect::<Option<_>>()?);
    }
    if !neighbours.iter_mut().flatten().all(|near| near.take_modes_of(&here).is_ok()) {
        return None;
    }
    let by: Vec<solver::Parameter> = neighbours
        .iter()
        .map(|near| solver::Parameter {
            offsets: STEPS.map(|steps| steps * STEP),
            neighbours: std::array::from_fn(|k| near[k].posing(&at_rest)),
            changes_law: near.iter().any(|impact| impact.law != here.law),
        })
        .collect();
    let Impact { striker, law, start, settings, .. } = &here;
    let solver = here.solver_with(kept).ok()?;
    let found = solver.differentiate(striker, law, start.as_ref(), settings, &by).ok()?;
    let changes: Vec<solver::Derivatives> = found.derivatives.into_iter().collect::<Result<_, _>>().ok()?;
    let columns = |(quantity, ..): &(Quantity, f64, Option<f64>)| {
        changes.iter().map(|change| quantity.change(&found.solution, change)).collect::<Option<Vec<f64>>>()
    };
    Some(row.measured.iter().map(columns).collect::<Option<Vec<_>>>()?.concat())
}

/// Central differences of the fourth order.
fn differences(
    model: &Model,
    row: &Row,
    coordinates: &[Parameter],
    parameters: &[f64],
    kept: &mut Kept,
) -> Option<Derivatives> {
    let n = coordinates.len();
    let course = model.course(row, parameters, kept)?;
    let here = seen(row, &course, None);
    let mut found = Derivatives { rows: vec![0.0; here.values.len() * n], in_offset: Vec::new(), grazes: false };
    if let Some((((record, _), signal), offset_s)) = row.force.as_ref().zip(course.signal.as_ref()).zip(here.offset_s) {
        found.in_offset = record.time_s.iter().map(|t| -signal.rate_at(t - offset_s)).collect();
    }
    for j in 0..n {
        for (steps, weight) in STEPS.into_iter().zip([1.0, -8.0, 8.0, -1.0]) {
            let there = shifted(coordinates, parameters, j, steps);
            let there = predict(model, row, &there, here.offset_s, kept)?;
            found.grazes |= there.sub_impacts != here.sub_impacts;
            for (entry, value) in found.rows.iter_mut().skip(j).step_by(n).zip(&there.values) {
                *entry += weight * value / (12.0 * STEP);
            }
        }
    }
    Some(found)
}

#[cfg(test)]
mod tests {
    use super::super::data::Data;
    use super::super::free::Free;
    use super::*;
    use crate::Scene;

    #[test]
    fn the_tangent_agrees_with_differences_for_every_quantity() {
        let scene = Scene::from_json(
            r#"{
            "structure": { "kind": "beam", "ends": ["clamped", "free"], "damping_ratio": 0.02,
                "segments": [{ "length_m": 1, "flexural_rigidity_n_m2": 274, "mass_per_length_kg_m": 1 }] },
            "striker": { "mass_kg": 0.1, "speed_m_s": 1 },
            "contact": { "law": "hertz", "stiffness_n_m1_5": 1e9 }, "location_m": 0.5, "modes": 12
        }"#,
        )
        .unwrap();
        let names = Quantity::ALL.map(Quantity::name).join(",");
        let table = format!("location_m,{names}\n0.45,1,1,1,1,1,1,1,1,1\n0.8,1,1,1,1,1,1,1,1,1\n");
        let data = Data::parse(table.as_bytes(), &|_| unreachable!()).unwrap();
        let free = ["contact.stiffness_n_m1_5", "structure.damping_ratio", "striker.mass_kg"];
        let free = free.map(|field| Free::parse(field).unwrap());
        let tree = scene.tree();
        let coordinates: Vec<Parameter> = free.iter().map(|free| free.parameter(&tree).unwrap()).collect();
        let start: Vec<f64> = coordinates.iter().map(|parameter| parameter.start).collect();
        let model = Model::new(&tree, &data, &free, &start).unwrap();
        let mut kept = Kept::default();
        for row in &data.rows {
            let exact = tangent(&model, row, &coordinates, &start, &mut kept).unwrap();
            let near = differences(&model, row, &coordinates, &start, &mut kept).unwrap();
            assert!(!near.grazes);
            let values = predict(&model, row, &start, None, &mut kept).unwrap().values;
            for (k, (exact, near)) in exact.iter().zip(&near.rows).enumerate() {
                let size = values[k / 3].abs().max(near.abs());
                assert!(
                    (exact - near).abs() < 2e-5 * size,
                    "{} by {}: {exact} {near}",
                    row.measured[k / 3].0.name(),
                    k % 3
                );
            }
        }
    }
}
