//! Restitution against the number of modes: Figs. 3.4, 3.7, 3.10, 3.11, 3.13 and 3.14; and
//! against the location: Fig. 3.15.

use super::Case;
use super::scatter::{self, AtBoth, MANY, extremes, off_the_mean, reduction, scatter};
use crate::chapters::figures::{Column, Curve, restitution, restitution_and_sub_impacts, slug};
use crate::chapters::impact::{Ball, Row, Setup};
use crate::chapters::statement::{RISES, Statement};
use crate::chapters::study::Study;
use tasks::Failure;
use vibroimpact::plot::Axis;

pub(super) fn run(study: &mut Study, case: &Case) -> Result<(), Failure> {
    let damped = case.parameters.damping_ratio;
    study.section("Pure Hertzian contact (Fig. 3.4)");
    let hertz = at_both_locations(study, case, |s| s)?;
    pair(study, case, "3.4", "Hertzian contact, no dissipation", [("Hertz", &hertz), ("", &none())])?;
    scatter::without_dissipation(study, &hertz);

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
    scatter::remains(study, "viscous", "3.3.3", &hertz, &viscous);
    scatter::lower(study, &hertz, &viscous);

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
    scatter::remains(study, "hysteretic", "3.3.4", &hertz, &hysteretic);

    study.section("Modal damping (Fig. 3.11)");
    let modal = at_both_locations(study, case, |s| Setup { damping_ratio: damped, ..s })?;
    pair(study, case, "3.11", "With and without modal damping", [("ζ = 0", &hertz), ("ζ = 0.02", &modal)])?;
    scatter::damped(study, &hertz, &modal);

    speeds(study, case)?;
    balls(study, case, scatter(&modal[1], MANY))?;
    scan(study, case)
}

fn none() -> AtBoth {
    [Vec::new(), Vec::new()]
}

/// The numbers of modes of the studies: all of them, or a few in a quick run.
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
        "Net restitution (top) and number of sub-impacts (bottom) against the number of retained modes.",
    )
}

fn publish(study: &mut Study, figure: &str, title: &str, columns: &[Column], caption: &str) -> Result<(), Failure> {
    let name = format!("fig-{}", slug(figure));
    let drawn =
        restitution_and_sub_impacts(&format!("Fig. {figure}  {title}"), &modes_axis(), |r| r.modes as f64, columns);
    study.main_figure(&name, &drawn, caption)?;
    study.csv(&format!("{name}.csv"), &rows_of(columns))
}

fn rows_of(columns: &[Column]) -> Vec<Row> {
    columns.iter().flat_map(|c| &c.1).flat_map(|c| &c.rows).cloned().collect()
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
    let (mut columns, mut ratios) = (Vec::new(), Vec::new());
    for &speed_m_s in &case.parameters.other_speeds_m_s {
        let setup = Setup { speed_m_s, ..case.setup(case.golden_m(), 0) };
        let curves = undamped_and_damped(study, case, setup)?;
        let quantity = format!("scatter of e for N ≥ 25, damped over undamped, {speed_m_s} m/s");
        let ratio = reduction(study, quantity, "3.4.2, Fig. 3.13", "distinctly less variation", &curves);
        ratios.push((speed_m_s, ratio));
        columns.push((format!("{speed_m_s} m/s"), curves));
    }
    let figure = restitution(
        "Fig. 3.13  Restitution for slower balls, b = 0.618 m",
        &modes_axis(),
        |r| r.modes as f64,
        &columns,
    );
    let of = |chosen: &dyn Fn(f64) -> bool| {
        ratios.iter().filter(|(speed, _)| chosen(*speed)).map(|(_, ratio)| *ratio).fold(0.0, f64::max)
    };
    study.state(Statement::trend(
        "scatter of e, damped over undamped, at 0.25 m/s minus the larger of those at 0.5 and 0.1 m/s",
        "3.4.2, Fig. 3.13",
        "for the 0.25 m/s case the convergence appears relatively a little slower",
        RISES,
        "any amount",
        of(&|speed| speed == 0.25) - of(&|speed| speed != 0.25),
    ));
    study.figure("fig-3-13", &figure.width(960.0), "The ball of 3 cm at three speeds.")?;
    study.csv("fig-3-13.csv", &rows_of(&columns))
}

/// Fig. 3.14: a larger and a smaller ball. `usual` is the scatter of the damped impacts of the chapter's ball.
fn balls(study: &mut Study, case: &Case, usual: f64) -> Result<(), Failure> {
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
        "Balls of 4 cm (left) and 2 cm (right). The small ball leaves before the beam springs back, so that there is \
         one contact, with and without damping.",
    )?;

    let [large, small] = [&columns[0].1, &columns[1].1];
    let words = "for the ball diameter of 4 cm, the behavior is qualitatively similar";
    let quantity = "scatter of e for N ≥ 25, damped over undamped, 4 cm ball".to_owned();
    reduction(study, quantity, "3.4.2, Fig. 3.14", words, large);
    study.state(Statement::trend(
        "larger scatter of e for N ≥ 25 of the 2 cm ball, with and without damping",
        "3.4.2, Fig. 3.14",
        "results are regular in both cases",
        (0.0, 0.02),
        "a line's width, a fiftieth of a figure's height",
        small.iter().map(|curve| scatter(&curve.rows, MANY)).fold(0.0, f64::max),
    ));
    let contacts = small.iter().flat_map(|c| &c.rows).map(|r| r.sub_impacts).max().unwrap_or(0);
    study.state(Statement::printed(
        "most contacts of the 2 cm ball, any N, with and without damping",
        "3.4.2",
        "1",
        contacts as f64,
    ));
    let apart = small[0].rows.iter().zip(&small[1].rows).map(|(a, b)| (a.e() - b.e()).abs()).fold(0.0, f64::max);
    study.state(Statement::trend(
        "largest change of the 2 cm ball's e by damping",
        "3.4.2",
        "damping plays essentially no role",
        (0.0, 0.02),
        "a line's width, a fiftieth of a figure's height",
        apart,
    ));
    study.state(Statement::trend(
        "scatter of e for N ≥ 25, damped: 4 cm ball over 3 cm ball",
        "3.4.2, Fig. 3.14",
        "for the ball diameter of 4 cm the convergence is more convincing",
        (0.0, 1.0),
        "any amount",
        scatter(&large[1].rows, MANY) / usual,
    ));
    heavy(study, case, &large[0].rows)
}

/// A ball so heavy that the beam acts as a spring, compared with the undamped results of the 4 cm ball.
fn heavy(study: &mut Study, case: &Case, of_4_cm: &[Row]) -> Result<(), Failure> {
    const OFF: f64 = 0.01;
    let ball = Ball::new(&case.parameters.material, case.parameters.our_choice.heavy_diameter_m)?;
    let rows = curve(study, case, Setup { ball, law: ball.hertz(), ..case.setup(case.golden_m(), 0) })?;
    study.csv("heavy-ball.csv", &rows)?;
    let many = rows.iter().filter(|row| row.modes >= MANY).count();
    // each of these restitutions follows from hundreds of sub-impacts and has few reliable digits, so only outliers are counted
    let statement = Statement::trend(
        format!(
            "modes from 25 on, of {many}, at which e of the undamped 20 cm ball is off its mean by more than {OFF}"
        ),
        "3.4.2",
        "for extremely massive balls the behavior would be regular again",
        (0.0, 0.1 * many as f64),
        "one in ten",
        off_the_mean(&rows, OFF) as f64,
    );
    study.state(statement.note(format!(
        "For the 4 cm ball {} are. The 20 cm ball has {:.1} kg and the beam 1 kg; its restitution is {:.3} with {} \
         modes, after hundreds of sub-impacts.",
        off_the_mean(of_4_cm, OFF),
        ball.mass_kg,
        rows.last().map_or(f64::NAN, Row::e),
        rows.last().map_or(0, |row| row.modes)
    )));
    Ok(())
}

/// Fig. 3.15: small variations of the location.
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
    study.figure(
        "fig-3-15",
        &figure.width(560.0),
        "Restitution (top) and number of sub-impacts (bottom) against the location.",
    )?;
    study.state(Statement::trend(
        "change of e for b from 0.60 to 0.62 m, 4 cm ball",
        "3.4.2, Fig. 3.15",
        "visibly (though not dramatically)",
        (0.02, 0.2),
        "from a line's width to a fifth of the range from 0 to 1",
        high - low,
    ));
    Ok(())
}
