//! Restitution against the speed (Fig. 4.3) and against the number of modes (Fig. 4.4).

use super::Case;
use crate::chapters::figures::{Column, Curve, restitution_and_sub_impacts};
use crate::chapters::impact::{Row, Setup};
use crate::chapters::study::Study;
use tasks::Failure;
use vibroimpact::plot::{Axis, Colour, Marker};
use vibroimpact::report::significant;

pub(super) fn run(study: &mut Study, case: &Case) -> Result<(), Failure> {
    speeds(study, case)?;
    modes(study, case)
}

const MARKERS: [Marker; 4] = [Marker::Circle, Marker::Cross, Marker::Square, Marker::Triangle];

fn speeds(study: &mut Study, case: &Case) -> Result<(), Failure> {
    study.section("Restitution against the speed (Fig. 4.3)");
    let p = &case.parameters.our_choice.speed_study;
    let (beam, ball) = (case.beam(&p.beam)?, case.ball(p.diameter_m)?);
    let steps = p.speeds.max(3) - 1;
    let exponents: Vec<f64> = (0..=steps).map(|i| 2.0 * i as f64 / steps as f64 - 1.0).collect();
    let speeds: Vec<f64> =
        study.thin(&exponents, 7).iter().map(|x| case.parameters.speed_m_s * p.factor.powf(*x)).collect();
    let found = study.sweep(&p.locations_m, speeds.len(), |&location_m| {
        let setup = case.setup(beam, ball, location_m);
        let solver = setup.solver()?;
        speeds
            .iter()
            .map(|&speed_m_s| Setup { speed_m_s, ..setup }.solve_with(&solver))
            .collect::<Result<Vec<Row>, Failure>>()
    })?;
    let curve = |(k, rows): (usize, &Vec<Row>)| {
        let label = format!("b = {} m", p.locations_m[k]);
        Curve::new(label, MARKERS[k % MARKERS.len()], Colour::of_series(k), rows.clone())
    };
    let columns = [(String::new(), found.iter().enumerate().map(curve).collect())];
    let axis = Axis::new("speed of the ball").unit("m/s").log();
    let title = format!("Fig. 4.3  {}, m = {:.3} kg, N = 40", beam.title, ball.mass_kg);
    let figure = restitution_and_sub_impacts(&title, &axis, |r| r.speed_m_s, &columns);
    let caption = "Restitution (top) and number of sub-impacts (bottom) against the speed of the ball. The step and \
                   the locations are our choice, so the small effect of the speed can only be compared qualitatively.";
    study.figure("fig-4-03", &figure.width(620.0), caption)?;
    study.csv("fig-4-03.csv", &found.concat())?;
    let mut lines = Vec::new();
    for (rows, location) in found.iter().zip(&p.locations_m) {
        // the text describes a change of the speed from 1 m/s, up or down
        let own = rows.iter().find(|r| (r.speed_m_s / case.parameters.speed_m_s - 1.0).abs() < 1e-9);
        let own = own.map_or(f64::NAN, Row::e);
        let change = rows.iter().map(|row| (row.e() - own).abs()).fold(0.0, f64::max);
        lines.push(vec![format!("{location} m"), significant(own, 3), significant(change, 2)]);
    }
    study.text(
        "The footnote of 4.1 states that changing the speed up or down by a factor of 15 has only a small effect. The \
         table has this change for our step and locations; the ensemble counts in how many choices the statement \
         holds.",
    );
    study.table(&["location", "e at 1 m/s", "largest change of it, 1/15 to 15 m/s"], &lines);
    Ok(())
}

fn modes(study: &mut Study, case: &Case) -> Result<(), Failure> {
    study.section("Restitution against the number of modes (Fig. 4.4)");
    let p = &case.parameters.our_choice.convergence_study;
    let (beam, ball) = (case.beam(&p.beam)?, case.ball(p.diameter_m)?);
    let all: Vec<usize> = (1..=p.most_modes).collect();
    let counts = study.thin(&all, 9);
    let mut columns: Vec<Column> = Vec::new();
    for &location_m in &p.locations_m {
        let damped = case.setup(beam, ball, location_m);
        let mut curves = Vec::new();
        for setup in [Setup { damping_ratio: 0.0, ..damped }, damped] {
            let setups: Vec<Setup> = counts.iter().map(|&modes| Setup { modes, ..setup }).collect();
            let rows = study.sweep(&setups, 1, Setup::solve)?;
            curves.push(match setup.damping_ratio {
                0.0 => Curve::reference("ζ = 0", rows),
                zeta => Curve::new(format!("ζ = {zeta}"), Marker::Plus, Colour::Vermilion, rows),
            });
        }
        columns.push((format!("b = {location_m} m"), curves));
    }
    let axis = Axis::new("number of modes N").integers();
    let title = format!("Fig. 4.4  {}, m = {:.3} kg", beam.title, ball.mass_kg);
    let figure = restitution_and_sub_impacts(&title, &axis, |r| r.modes as f64, &columns);
    study.figure(
        "fig-4-04",
        &figure.width(960.0),
        "Restitution (top) and number of sub-impacts (bottom) against the number of modes, without and with damping.",
    )?;
    let rows: Vec<Row> = columns.iter().flat_map(|c| &c.1).flat_map(|c| &c.rows).cloned().collect();
    study.csv("fig-4-04.csv", &rows)
}
