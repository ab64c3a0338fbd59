//! Impacts for which the law of the thesis is inaccurate, and the reasons.

use super::Dataset;
use super::fits::BeamFit;
use crate::chapters::study::Study;
use emoc::Branch;
use tasks::Failure;
use vibroimpact::net;
use vibroimpact::plot::{Axis, Figure};
use vibroimpact::report::significant;

pub(super) fn run(study: &mut Study, data: &[Dataset], fits: &[BeamFit]) -> Result<(), Failure> {
    study.section("Where the law fails, and why");
    let (mut panels, mut rows) = (Vec::new(), Vec::new());
    for (data, found) in data.iter().zip(fits) {
        // results without restitution are grey in the map
        let difference = |mass_kg: f64, location_m: f64| {
            let place = data.rows.iter().position(|r| r.mass_kg == mass_kg && r.location_m == location_m);
            place.map_or(f64::NAN, |i| found.fit.residuals[i])
        };
        let map = data.table.by_ball(|r| difference(r.mass_kg, r.location_m));
        let value = Axis::new("law less table").limits(-0.3, 0.3);
        panels.push(data.table.map(map, value).title(data.beam.title.clone()));
        rows.push(summary(data, found));
    }
    let figure = panels
        .chunks(2)
        .fold(Figure::new("Restitution of the law minus that of the table").width(960.0), |f, row| f.row(row.to_vec()));
    study.figure("where-it-fails", &figure, "Blue: the restitution of the law is too small. Red: it is too large.")?;
    study.table(
        &["beam", "rms", "balls to 0.05 kg", "balls above 0.2 kg", "basic branch", "share of it", "irregularity"],
        &rows,
    );
    study.text(
        "The table has the rms difference, over all and over parts of each table. The irregularity is the rms \
         difference between a value of the table and the mean of its four neighbours (next locations, next balls), \
         divided by √1.25. No law that varies smoothly with location and mass can represent it.\n\nThe closed form e = \
         ē max(1/(1+Z), (β₀+β₁)/(1+β₀)) shows what the law can express:\n\n- **Light balls.** They touch once and \
         leave before the fast modes have responded. The rebound depends on how many modes are slow compared with the \
         contact. Z weights all N modes alike for every ball, so that the same N has to suit contacts of 20 µs and of \
         200 µs. Z is large almost everywhere and the first term of the maximum is small. The whole decrease of e with \
         the mass must therefore come from β₀, which saturates and whose shape is fixed.\n- **Heavy balls.** They \
         finally move with the beam and are thrown back by its slow motion. The law represents this motion by φ₁ \
         alone. Near a held end, or near a node of the first mode, φ₁ vanishes, while the ball still moves with a \
         stiffer mode and rebounds with 0.3 to 0.6. There the law is lower than the table.\n- **Steps.** The mode that \
         throws the ball back changes with the location, while the outward inequality contains only the first mode.\n- \
         **ē** has the same value for t and 1/t, and is at least 2/3. It can serve as a factor for light balls or for \
         heavy ones, so that the sum of squares has two minima.",
    );
    Ok(())
}

fn summary(data: &Dataset, found: &BeamFit) -> Vec<String> {
    let rms = |chosen: &dyn Fn(usize) -> bool| {
        let squares: Vec<f64> =
            (0..data.rows.len()).filter(|&i| chosen(i)).map(|i| found.fit.residuals[i].powi(2)).collect();
        if squares.is_empty() {
            return "none".to_string();
        }
        significant((squares.iter().sum::<f64>() / squares.len() as f64).sqrt(), 3)
    };
    let law = net::law(&found.fit.parameters);
    let basic: Vec<bool> = found
        .observations
        .impacts
        .iter()
        .map(|impact| law.rebound(impact).is_ok_and(|rebound| rebound.branch == Branch::Basic))
        .collect();
    let share = basic.iter().filter(|b| **b).count() as f64 / basic.len() as f64;
    vec![
        data.beam.title.clone(),
        rms(&|_| true),
        rms(&|i| data.rows[i].mass_kg <= 0.05),
        rms(&|i| data.rows[i].mass_kg > 0.2),
        rms(&|i| basic[i]),
        format!("{:.0} %", 100.0 * share),
        significant(irregularity(data), 3),
    ]
}

/// Rms difference of a value and the mean of its four neighbours, scaled to the error of a single value.
pub(in crate::chapters) fn irregularity(data: &Dataset) -> f64 {
    let rows = &data.table.rows;
    let e = |i: usize, j: usize| rows[i][j].e();
    let mut squares = Vec::new();
    for i in 1..rows.len().saturating_sub(1) {
        for j in 1..rows[i].len().saturating_sub(1) {
            let around = 0.25 * (e(i - 1, j) + e(i + 1, j) + e(i, j - 1) + e(i, j + 1));
            squares.push((e(i, j) - around).powi(2));
        }
    }
    squares.retain(|square| square.is_finite());
    (squares.iter().sum::<f64>() / (1.25 * squares.len() as f64)).sqrt()
}
