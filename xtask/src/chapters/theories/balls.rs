//! Chapter 3: restitution against the number of modes by both theories, and with different shear coefficients.

use super::{APART, Coefficient, coefficients, kaneko};
use crate::chapters::beam::Beam;
use crate::chapters::chapter3::Case;
use crate::chapters::chapter3::scatter::{MANY, deviation};
use crate::chapters::figures::{Column, Curve, restitution};
use crate::chapters::impact::{Ball, Row, Setup};
use crate::chapters::statement::Statement;
use crate::chapters::study::Study;
use tasks::Failure;
use vibroimpact::plot::{Axis, Colour, Marker};
use vibroimpact::report::significant;

/// Numbers of modes from which the limit and its uncertainty follow.
const SETTLED: [usize; 2] = [200, 400];
/// Uncertainty below which a limit counts as converged.
const KNOWN: f64 = 1e-5;
/// Plain truncation of the thesis.
const TRUNCATED: usize = 40;

/// The damped impact of every ball on one beam with this many modes.
fn impacts(
    case: &Case,
    beam: &Beam,
    location_m: f64,
    balls: &[Ball],
    modes: usize,
    residual: bool,
) -> Result<Vec<Row>, Failure> {
    let damping_ratio = case.parameters.damping_ratio;
    let at = |ball: &Ball| Setup {
        beam,
        ball: *ball,
        law: ball.hertz(),
        damping_ratio,
        residual,
        ..case.setup(location_m, modes)
    };
    let Some(first) = balls.first() else { return Ok(Vec::new()) };
    let solver = at(first).solver()?;
    balls.iter().map(|ball| at(ball).solve_with(&solver)).collect()
}

pub(super) fn run(study: &mut Study, case: &Case) -> Result<(), Failure> {
    let material = &case.parameters.material;
    let mut diameters = case.parameters.other_diameters_m.to_vec();
    diameters.push(case.parameters.ball_diameter_m);
    diameters.sort_by(f64::total_cmp);
    let balls = diameters.iter().map(|&d| Ball::new(material, d)).collect::<Result<Vec<Ball>, Failure>>()?;
    let thick = case.beam.timoshenko(material, kaneko(material))?;
    against_modes(study, case, &balls, &thick)?;
    limits(study, case, &balls, &thick)?;
    coefficients_in_use(study, case, &balls)
}

/// Restitution against the number of modes: a figure for each location, a column for each ball.
fn against_modes(study: &mut Study, case: &Case, balls: &[Ball], thick: &Beam) -> Result<(), Failure> {
    study.section("Restitution against the number of modes (chapter 3)");
    let counts = study.thin(&case.parameters.our_choice.residual_modes, 7);
    for (&location_m, place) in case.parameters.locations_m.iter().zip(["0-4", "golden"]) {
        let models = [
            ("Euler-Bernoulli, plain truncation", &case.beam, false, Marker::Plus, Colour::Grey),
            ("Euler-Bernoulli", &case.beam, true, Marker::Cross, Colour::Vermilion),
            ("Timoshenko", thick, true, Marker::Circle, Colour::Blue),
        ];
        let mut curves: Vec<Vec<Curve>> = balls.iter().map(|_| Vec::new()).collect();
        for (label, beam, residual, marker, colour) in models {
            let by_count =
                study.sweep(&counts, balls.len(), |&modes| impacts(case, beam, location_m, balls, modes, residual))?;
            for (j, of_ball) in curves.iter_mut().enumerate() {
                let rows = by_count.iter().map(|rows| rows[j].clone()).collect();
                of_ball.push(Curve::new(label, marker, colour, rows));
            }
        }
        let title = |ball: &Ball| format!("{} mm", significant(1e3 * ball.diameter_m, 3));
        let columns: Vec<Column> = balls.iter().map(title).zip(curves).collect();
        let rows: Vec<Row> = columns.iter().flat_map(|c| &c.1).flat_map(|c| &c.rows).cloned().collect();
        study.csv(&format!("modes-{place}.csv"), &rows)?;
        let figure = restitution(
            &format!("Restitution of three balls against the number of modes, b = {} m", significant(location_m, 3)),
            &Axis::new("number of modes N").log(),
            |row| row.modes as f64,
            &columns,
        );
        study.figure(
            &format!("modes-{place}"),
            &figure.width(960.0),
            "Grey: the retained modes alone, as in the thesis. Coloured: with remainder modes for all others.",
        )?;
    }
    Ok(())
}

fn restitutions(rows: &[Row]) -> Vec<f64> {
    rows.iter().map(Row::e).collect()
}

/// Limits of both theories, and the effects of truncation, theory and shear coefficient.
fn limits(study: &mut Study, case: &Case, balls: &[Ball], thick: &Beam) -> Result<(), Failure> {
    study.section("Truncation, theory and shear coefficient (chapter 3)");
    let material = &case.parameters.material;
    let [coarse, fine] = SETTLED;
    let around = [1.0 - APART, 1.0 + APART].map(|share| case.beam.timoshenko(material, share * kaneko(material)));
    let [soft, stiff] = around;
    let (soft, stiff) = (soft?, stiff?);
    let models = [
        (&case.beam, TRUNCATED, false),
        (&case.beam, coarse, true),
        (&case.beam, fine, true),
        (thick, coarse, true),
        (thick, fine, true),
        (&soft, fine, true),
        (&stiff, fine, true),
    ];
    let mut lines = Vec::new();
    for &location_m in &case.parameters.locations_m {
        let found = study.sweep(&models, balls.len(), |&(beam, modes, residual)| {
            impacts(case, beam, location_m, balls, modes, residual)
        })?;
        let counts = study.thin(&(MANY..=case.parameters.our_choice.most_modes).collect::<Vec<usize>>(), 9);
        let over_counts =
            study.sweep(&counts, balls.len(), |&modes| impacts(case, &case.beam, location_m, balls, modes, false))?;
        for (j, ball) in balls.iter().enumerate() {
            let scatter = deviation(&over_counts.iter().map(|rows| rows[j].e()).collect::<Vec<f64>>());
            let [truncated, slender_coarse, slender, thick_coarse, thick, soft, stiff] =
                [0, 1, 2, 3, 4, 5, 6].map(|model: usize| found[model][j].e());
            let of_coefficient = (soft - thick).abs().max((stiff - thick).abs());
            let settled = (slender - slender_coarse).abs().max((thick - thick_coarse).abs());
            let place = [significant(location_m, 3), significant(1e3 * ball.diameter_m, 3)];
            let numbers = [slender, thick].map(|e| format!("{e:.4}"));
            let changes = [scatter, (truncated - slender).abs(), (thick - slender).abs(), of_coefficient];
            let contacts = [2, 4].map(|model: usize| found[model][j].sub_impacts.to_string()).join(", ");
            let line = place.into_iter().chain(numbers).chain([contacts]);
            let settled = if settled < KNOWN { "below 10⁻⁵".to_owned() } else { significant(settled, 1) };
            lines.push(line.chain(changes.map(|change| significant(change, 2))).chain([settled]).collect());
        }
    }
    study.tabled(
        "limits",
        &[
            "b (m)",
            "ball (mm)",
            "Euler-Bernoulli",
            "Timoshenko",
            "contacts",
            "scatter",
            "truncation",
            "theory",
            "coefficient",
            "converged to",
        ],
        &lines,
    )?;
    study.text(&format!(
        "The restitutions are those with {fine} modes and remainder modes, and the contacts those by either theory. \
         The scatter is the standard deviation with plain truncation over {MANY} and more modes, by Euler-Bernoulli's \
         theory. The column \"converged to\" has the larger change from {coarse} to {fine} modes."
    ));
    Ok(())
}

/// Limits for the usual shear coefficients, compared with those of an independent method.
fn coefficients_in_use(study: &mut Study, case: &Case, balls: &[Ball]) -> Result<(), Failure> {
    study.section("The shear coefficients in use (chapter 3)");
    let material = &case.parameters.material;
    let location_m = case.golden_m();
    let each = coefficients(material);
    let found = study.sweep(&each, balls.len(), |Coefficient { value, .. }| {
        Ok(restitutions(&impacts(case, &case.beam.timoshenko(material, *value)?, location_m, balls, SETTLED[1], true)?))
    })?;
    let slender = restitutions(&impacts(case, &case.beam, location_m, balls, SETTLED[1], true)?);
    let cells = |name: &str, value: String, found: &[f64]| {
        [name.to_owned(), value].into_iter().chain(found.iter().map(|e| format!("{e:.4}"))).collect::<Vec<String>>()
    };
    let mut lines = vec![cells("Euler-Bernoulli", "∞".into(), &slender)];
    lines.extend(each.iter().zip(&found).map(|(c, found)| cells(c.name, significant(c.value, 4), found)));
    let headers = balls.iter().map(|ball| format!("{} mm ball", significant(1e3 * ball.diameter_m, 3)));
    let headers: Vec<String> = ["shear coefficient".into(), "κ".into()].into_iter().chain(headers).collect();
    study.tabled("coefficients", &headers.iter().map(String::as_str).collect::<Vec<_>>(), &lines)?;
    // 800,000 modes with the first moment of the tail exact, and its measure by Lanczos
    let claim = |quantity: &str, stated: &str, expected: f64, tolerance: f64, ours: f64| {
        let quantity = format!("restitution at the golden section, {quantity}");
        let how = ["an independent computation", stated, "how well that is known"];
        Statement::self_check(quantity, how, (expected - tolerance, expected + tolerance), ours)
    };
    study.state(claim("Cowper's coefficient, 20 mm ball", "0.21038", 0.21038, 2e-5, found[1][0]));
    study.state(claim("Cowper's coefficient, 30 mm ball", "0.25302", 0.25302, 1e-4, found[1][1]));
    study.state(claim("Euler-Bernoulli, 30 mm ball", "0.14255", 0.14255, 2e-5, slender[1]));
    Ok(())
}
