//! Restitution against the number of modes: Figs. 3.4, 3.7, 3.10, 3.11, 3.13 and 3.14; and
//! against the location: Fig. 3.15.

use super::Case;
use crate::chapters::Failure;
use crate::chapters::figures::{Column, Curve, restitution, restitution_and_sub_impacts};
use crate::chapters::impact::{Ball, Row, Setup};
use crate::chapters::study::{Study, slug};
use vibroimpact::plot::Axis;
use vibroimpact::report::Comparison;

pub(super) fn run(study: &mut Study, case: &Case) -> Result<(), Failure> {
    let damped = case.parameters.damping_ratio;
    study.section("Pure Hertzian contact (Fig. 3.4)");
    let hertz = at_both_locations(study, case, |s| s)?;
    pair(study, case, "3.4", "Hertzian contact, no dissipation", [("Hertz", &hertz), ("", &none())])?;
    hertz_statements(study, &hertz);

    study.section("Viscous contact dissipation (Fig. 3.7)");
    let law = case.viscous()?;
    let viscous = at_both_locations(study, case, |s| Setup { law, ..s })?;
    pair(
        study,
        case,
        "3.7",
        "With and without viscous contact dissipation",
        [("Hertz", &hertz), ("viscous", &viscous)],
    )?;
    scatter_remains(study, "viscous", "3.3.3", &hertz, &viscous);

    study.section("Hysteretic contact dissipation (Fig. 3.10)");
    let law = case.hysteretic()?;
    let hysteretic = at_both_locations(study, case, |s| Setup { law, ..s })?;
    pair(
        study,
        case,
        "3.10",
        "With and without hysteretic contact dissipation",
        [("Hertz", &hertz), ("hysteretic", &hysteretic)],
    )?;
    scatter_remains(study, "hysteretic", "3.3.4", &hertz, &hysteretic);

    study.section("Modal damping (Fig. 3.11)");
    let modal = at_both_locations(study, case, |s| Setup { damping_ratio: damped, ..s })?;
    pair(study, case, "3.11", "With and without modal damping", [("ζ = 0", &hertz), ("ζ = 0.02", &modal)])?;
    for (place, k) in [("b = 0.4", 0), ("b = 0.618", 1)] {
        let ratio = scatter(&modal[k], 25) / scatter(&hertz[k], 25);
        study.state(Comparison::range(
            format!("scatter of e for N ≥ 25, damped over undamped, {place}"),
            "3.3.5",
            "a significant reduction in variability",
            (0.0, 0.5),
            ratio,
        ));
        study.state(Comparison::range(
            format!("scatter of e for N ≥ 25, damped, {place}"),
            "3.5",
            "within several percent",
            (0.0, 0.1),
            scatter(&modal[k], 25),
        ));
    }

    speeds(study, case)?;
    balls(study, case)?;
    scan(study, case)
}

type AtBoth = [Vec<Row>; 2];

fn none() -> AtBoth {
    [Vec::new(), Vec::new()]
}

/// The numbers of modes of the studies, all or few.
fn mode_counts(study: &Study, case: &Case) -> Vec<usize> {
    let all: Vec<usize> = (1..=case.parameters.our_choice.most_modes).collect();
    study.thin(&all, 13)
}

/// A curve against the number of modes.
fn curve(study: &mut Study, case: &Case, setup: Setup) -> Result<Vec<Row>, Failure> {
    let setups: Vec<Setup> = mode_counts(study, case).into_iter().map(|modes| Setup { modes, ..setup }).collect();
    study.sweep(&setups, 1, Setup::solve)
}

fn at_both_locations<'a>(
    study: &mut Study,
    case: &'a Case,
    change: impl Fn(Setup<'a>) -> Setup<'a>,
) -> Result<AtBoth, Failure> {
    let [first, second] = case.parameters.locations_m;
    Ok([curve(study, case, change(case.setup(first, 0)))?, curve(study, case, change(case.setup(second, 0)))?])
}

fn modes_axis() -> Axis {
    Axis::new("number of modes N").integers()
}

/// A figure in the arrangement of Fig. 3.4: two locations side by side.
fn pair(
    study: &mut Study,
    case: &Case,
    figure: &str,
    title: &str,
    curves: [(&str, &AtBoth); 2],
) -> Result<(), Failure> {
    let columns: Vec<Column> = (0..2)
        .map(|k| {
            let [(first, blue), (second, red)] = curves;
            let mut drawn = vec![Curve::reference(first, blue[k].clone())];
            if !red[k].is_empty() {
                drawn.push(Curve::other(second, red[k].clone()));
            }
            (format!("b = {:.4} m", case.parameters.locations_m[k]), drawn)
        })
        .collect();
    publish(
        study,
        figure,
        title,
        &columns,
        "Above: net restitution; below: number of sub-impacts; both against the number of modes kept.",
    )
}

fn publish(study: &mut Study, figure: &str, title: &str, columns: &[Column], caption: &str) -> Result<(), Failure> {
    let name = format!("fig-{}", slug(figure));
    let drawn =
        restitution_and_sub_impacts(&format!("Fig. {figure}  {title}"), &modes_axis(), |r| r.modes as f64, columns);
    study.figure(&name, &drawn, caption)?;
    study.csv(&format!("{name}.csv"), &rows_of(columns))
}

fn rows_of(columns: &[Column]) -> Vec<Row> {
    columns.iter().flat_map(|c| &c.1).flat_map(|c| &c.rows).cloned().collect()
}

/// Restitutions of the rows with at least so many modes.
fn from(rows: &[Row], least: usize) -> impl Iterator<Item = f64> + '_ {
    rows.iter().filter(move |r| r.modes >= least).map(Row::e)
}

/// Standard deviation of the restitution from so many modes on.
fn scatter(rows: &[Row], least: usize) -> f64 {
    let centre = mean(from(rows, least));
    mean(from(rows, least).map(|e| (e - centre).powi(2))).sqrt()
}

fn extremes(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), e| (low.min(e), high.max(e)))
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), e| (sum + e, count + 1.0));
    sum / count
}

fn hertz_statements(study: &mut Study, hertz: &AtBoth) {
    let find = |n: usize| hertz[0].iter().find(|r| r.modes == n).map(Row::e);
    let pairs = (1..=13).filter_map(|k| find(5 * k - 1).zip(find(5 * k)));
    let unequal = pairs.map(|(a, b)| (a - b).abs()).fold(f64::NAN, f64::max);
    if unequal.is_finite() {
        study.state(Comparison::range(
            "largest |e(N) − e(N+1)| for N = 4, 9, 14, …, b = 0.4",
            "3.3.2",
            "identical",
            (0.0, 1e-9),
            unequal,
        ));
    }
    let few = hertz[0].iter().zip(&hertz[1]).filter(|(a, _)| a.modes < 8).map(|(a, b)| (a.e() - b.e()).abs());
    study.state(Comparison::range(
        "largest difference of e between the locations for N < 8",
        "3.3.2",
        "similar",
        (0.0, 0.15),
        few.fold(0.0, f64::max),
    ));
    let many = hertz[0].iter().zip(&hertz[1]).filter(|(a, _)| a.modes >= 20).map(|(a, b)| (a.e() - b.e()).abs());
    study.state(Comparison::range(
        "largest difference of e between the locations for N ≥ 20",
        "3.3.2",
        "differ significantly",
        (0.15, 1.0),
        many.fold(0.0, f64::max),
    ));

    let window = || hertz[1].iter().filter(|r| (30..=40).contains(&r.modes)).map(Row::e);
    let (low, high) = extremes(window());
    let chaotic = "These impacts amplify every disturbance; the extremes of eleven of them are a matter of luck.";
    study.state(Comparison::about("smallest e for N from 30 to 40, b = 0.618", "3.5", "about 0.1", 0.1, 0.05, low));
    study.state(
        Comparison::about("largest e for N from 30 to 40, b = 0.618", "3.5", "about 0.6", 0.6, 0.05, high)
            .note(chaotic),
    );
    study.state(Comparison::about(
        "largest e over smallest e, N from 30 to 40, b = 0.618",
        "3.5",
        "a factor of 6",
        6.0,
        2.0,
        high / low,
    ));
    for (rows, place) in hertz.iter().zip(["b = 0.4", "b = 0.618"]) {
        let third = rows.len() / 3;
        let fall = mean(rows[..third].iter().map(Row::e)) - mean(rows[rows.len() - third..].iter().map(Row::e));
        study.state(Comparison::range(
            format!("mean of e over the first third of N less that over the last, {place}"),
            "3.1",
            "on average a decreasing trend",
            (0.0, 1.0),
            fall,
        ));
    }
}

/// Dissipation in the contact leaves the scatter: the ratio of scatters with and without.
fn scatter_remains(study: &mut Study, name: &str, source: &str, hertz: &AtBoth, with: &AtBoth) {
    for (k, place) in ["b = 0.4", "b = 0.618"].into_iter().enumerate() {
        let ratio = scatter(&with[k], 25) / scatter(&hertz[k], 25);
        study.state(Comparison::range(
            format!("scatter of e for N ≥ 25, {name} over Hertz, {place}"),
            source,
            "convergence is not improved",
            (0.5, f64::INFINITY),
            ratio,
        ));
    }
    if name == "viscous" {
        let lower = mean(with.iter().flatten().map(Row::e)) - mean(hertz.iter().flatten().map(Row::e));
        study.state(Comparison::range(
            "mean of e with viscous dissipation less mean without",
            source,
            "on average some indication of lower rebound",
            (-1.0, 0.0),
            lower,
        ));
    }
}

/// The curves of one setup without and with modal damping.
fn undamped_and_damped(study: &mut Study, case: &Case, setup: Setup) -> Result<Vec<Curve>, Failure> {
    let damping_ratio = case.parameters.damping_ratio;
    let undamped = curve(study, case, setup)?;
    let damped = curve(study, case, Setup { damping_ratio, ..setup })?;
    Ok(vec![Curve::reference("ζ = 0", undamped), Curve::other("ζ = 0.02", damped)])
}

/// Fig. 3.13: slower balls.
fn speeds(study: &mut Study, case: &Case) -> Result<(), Failure> {
    study.section("Other speeds (Fig. 3.13)");
    let mut columns = Vec::new();
    for &speed_m_s in &case.parameters.other_speeds_m_s {
        let setup = Setup { speed_m_s, ..case.setup(case.golden_m(), 0) };
        let curves = undamped_and_damped(study, case, setup)?;
        let ratio = scatter(&curves[1].rows, 25) / scatter(&curves[0].rows, 25);
        study.state(Comparison::range(
            format!("scatter of e for N ≥ 25, damped over undamped, {speed_m_s} m/s"),
            "3.4.2",
            "distinctly less variation",
            (0.0, 0.7),
            ratio,
        ));
        columns.push((format!("{speed_m_s} m/s"), curves));
    }
    let figure = restitution(
        "Fig. 3.13  Restitution for slower balls, b = 0.618 m",
        &modes_axis(),
        |r| r.modes as f64,
        &columns,
    );
    study.figure("fig-3-13", &figure.width(960.0), "A ball of 3 cm at three speeds.")?;
    study.csv("fig-3-13.csv", &rows_of(&columns))
}

/// Fig. 3.14: a larger and a smaller ball.
fn balls(study: &mut Study, case: &Case) -> Result<(), Failure> {
    study.section("Other balls (Fig. 3.14)");
    let mut columns = Vec::new();
    for &diameter_m in &case.parameters.other_diameters_m {
        let ball = Ball::new(&case.parameters.material, diameter_m)?;
        let setup = Setup { ball, law: ball.hertz(), ..case.setup(case.golden_m(), 0) };
        columns.push((format!("ball of {} cm", 100.0 * diameter_m), undamped_and_damped(study, case, setup)?));
    }
    publish(
        study,
        "3.14",
        "Other balls, b = 0.618 m",
        &columns,
        "Left: 4 cm; right: 2 cm. The small ball leaves before the beam comes back: one contact, with or without damping.",
    )?;

    let [large, small] = [&columns[0].1, &columns[1].1];
    let contacts = small.iter().flat_map(|c| &c.rows).map(|r| r.sub_impacts).max().unwrap_or(0);
    study.state(Comparison::range(
        "most contacts of the 2 cm ball, any N, with and without damping",
        "3.4.2",
        "just one single impact",
        (1.0, 1.0),
        contacts as f64,
    ));
    let apart = small[0].rows.iter().zip(&small[1].rows).map(|(a, b)| (a.e() - b.e()).abs()).fold(0.0, f64::max);
    study.state(Comparison::range(
        "largest change of the 2 cm ball's e by damping",
        "3.4.2",
        "damping plays essentially no role",
        (0.0, 0.02),
        apart,
    ));
    study.state(Comparison::range(
        "scatter of e for N ≥ 25, 4 cm ball, damped",
        "3.4.2",
        "convergence is more convincing",
        (0.0, 0.05),
        scatter(&large[1].rows, 25),
    ));
    Ok(())
}

/// Fig. 3.15: the location varied a little.
fn scan(study: &mut Study, case: &Case) -> Result<(), Failure> {
    study.section("Location between 0.60 and 0.62 m (Fig. 3.15)");
    let scan = &case.parameters.scan;
    let ball = Ball::new(&case.parameters.material, scan.diameter_m)?;
    let steps = case.parameters.our_choice.scan_places.max(2) - 1;
    let all: Vec<f64> =
        (0..=steps).map(|i| scan.from_m + (scan.to_m - scan.from_m) * i as f64 / steps as f64).collect();
    let damping_ratio = case.parameters.damping_ratio;
    let setups: Vec<Setup> = study
        .thin(&all, 11)
        .into_iter()
        .map(|location_m| Setup {
            location_m,
            ball,
            law: ball.hertz(),
            damping_ratio,
            ..case.setup(location_m, scan.modes)
        })
        .collect();
    let rows = study.sweep(&setups, 1, Setup::solve)?;
    let (low, high) = extremes(rows.iter().map(Row::e));
    study.csv("fig-3-15.csv", &rows)?;
    let columns = [(String::new(), vec![Curve::other("", rows)])];
    let axis = Axis::new("location b").unit("m").limits(scan.from_m - 4e-4, scan.to_m + 4e-4);
    let figure =
        restitution_and_sub_impacts("Fig. 3.15  A ball of 4 cm, N = 40, ζ = 0.02", &axis, |r| r.location_m, &columns);
    study.figure("fig-3-15", &figure.width(560.0), "Above: restitution; below: sub-impacts; against the location.")?;
    study.state(Comparison::range(
        "change of e for b from 0.60 to 0.62 m, 4 cm ball",
        "3.4.2",
        "visible, though not dramatic",
        (0.01, 0.2),
        high - low,
    ));
    Ok(())
}
