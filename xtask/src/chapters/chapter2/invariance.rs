//! The number `S` does not depend on units: Tables 2.1 and A.1, Fig. A.1.

use super::{Parameters, Units, solved};
use crate::chapters::statement::Statement;
use crate::chapters::study::Study;
use fracdiff::{Collocation, Method, Volterra};
use serde::Serialize;
use tasks::Failure;
use vibroimpact::plot::{Axis, Colour, Figure, Panel, Series};
use vibroimpact_sim::infinite::{Groups, Impact, Material, Structure};

/// Samples of a curve.
const SAMPLES: usize = 400;

/// A sample of Fig. A.1, in the units of its parameter set and dimensionless.
#[derive(Serialize)]
struct Row {
    set: usize,
    time: f64,
    force: f64,
    time_nd: f64,
    force_nd: f64,
}

pub(super) fn run(study: &mut Study, parameters: &Parameters) -> Result<(), Failure> {
    study.section("The single parameter S (Table 2.1, Table A.1, Fig. A.1)");
    for row in &parameters.table_2_1 {
        let impact = Impact::sphere_on_beam(Material::STEEL, row.side_m, row.side_m, row.radius_m, row.speed_m_s)?;
        let quantity = format!("S for b = {} m, R = {} m, v = {} m/s", row.side_m, row.radius_m, row.speed_m_s);
        study.state(Statement::printed(quantity, "Table 2.1", &row.s, impact.groups()?.s));
    }
    let mut rows = Vec::new();
    let mut curves = Vec::new();
    let mut largest = 0.0_f64;
    for (set, units) in parameters.table_a_1.iter().enumerate().map(|(i, units)| (i + 1, units)) {
        let groups = groups(units)?;
        for (name, printed, ours) in [
            ("S", &parameters.table_a_1_s, groups.s),
            ("F", &units.force, groups.force_n),
            ("T", &units.time, groups.time_s),
        ] {
            let statement = Statement::printed(format!("{name} of parameter set {set}"), "Table A.1", printed, ours);
            // Eqs. 2.49 to 2.51 make the third set's units of time and force 1
            let reason = "exactly 1 by Eqs. 2.49 to 2.51, from inputs of four digits";
            study.state(if printed == "1" { statement.held_to(5e-4, reason) } else { statement });
        }
        let (curve, difference) = in_own_units(set, units, &groups)?;
        largest = largest.max(difference);
        rows.extend(curve.iter().map(|row| Row { ..*row }));
        curves.push(curve);
    }
    study.csv("fig-a-01.csv", &rows)?;
    study.state(
        Statement::identity(
            "largest difference of the nondimensional forces, over the largest force",
            ["Fig. A.1", "the same graph", "two methods, each exact to ten digits"],
            (0.0, 1e-6),
            largest,
        )
        .note(
            "Each set is solved in its own units by spectral collocation (`fracdiff`), and compared with the solution \
             for its S alone (`vibroimpact-sim`). The S of the printed sets differ in the fourth digit.",
        ),
    );
    let series = |set: usize, of: &dyn Fn(&Row) -> (f64, f64)| {
        let (x, y): (Vec<f64>, Vec<f64>) = curves[set].iter().map(of).unzip();
        Series::line(&x, &y)
    };
    let own = |set: usize, title: &str| {
        let line = series(set, &|row| (row.time, row.force)).colour(Colour::of_series(set));
        Panel::new(Axis::new("time, own units"), Axis::new("force, own units")).title(title).with(line)
    };
    let together = Panel::new(Axis::new("time").unit("T"), Axis::new("force").unit("F"))
        .title("(c) nondimensional")
        .with(series(0, &|row| (row.time_nd, row.force_nd)).colour(Colour::Blue).label("set 1").line_width(4.0))
        .with(series(1, &|row| (row.time_nd, row.force_nd)).colour(Colour::Vermilion).label("set 2").line_width(2.0))
        .with(series(2, &|row| (row.time_nd, row.force_nd)).colour(Colour::Black).label("set 3").dashed());
    let figure = Figure::new("Fig. A.1  Three sets of parameters, one S = 0.528")
        .row([own(0, "(a) set 1"), own(1, "(b) set 2")])
        .row([together]);
    study.figure("fig-a-01", &figure, "The nondimensional forces of the three sets coincide.")
}

fn groups(units: &Units) -> Result<Groups, Failure> {
    let impact = Impact {
        structure: Structure::Beam,
        impulse_response: units.impulse_response,
        stiffness_n_m1_5: units.stiffness,
        mass_kg: units.mass,
        speed_m_s: units.speed,
    };
    Ok(impact.groups()?)
}

/// The force in the units of the set, from Eqs. 2.7 as they stand, and its largest difference from the solution for `S`.
fn in_own_units(set: usize, units: &Units, groups: &Groups) -> Result<(Vec<Row>, f64), Failure> {
    let nondimensional = solved(groups.s, 0.0)?;
    let end = 1.3 * nondimensional.sub_impacts.first().and_then(|contact| contact.end).ok_or("no separation")?;
    let (v, k) = (units.speed, units.stiffness);
    let force = move |x: f64| k * x.max(0.0).powf(1.5);
    let equation =
        Volterra::scalar(|t| v * t, move |_, x| force(x), &[(2.0, -1.0 / units.mass), (1.5, -units.impulse_response)]);
    let dimensional = equation.solve(&Method::Collocation(Collocation::default()), end * groups.time_s)?;
    let mut rows = Vec::new();
    let (mut difference, mut largest) = (0.0_f64, 0.0_f64);
    for i in 0..=SAMPLES {
        let time_nd = end * i as f64 / SAMPLES as f64;
        let time = (time_nd * groups.time_s).min(dimensional.end_time());
        let force = force(dimensional.at(time)?.first().copied().unwrap_or(f64::NAN));
        let force_nd = force / groups.force_n;
        let ours = nondimensional.at(time_nd).map_or(f64::NAN, |state| state.force);
        difference = difference.max((force_nd - ours).abs());
        largest = largest.max(ours);
        rows.push(Row { set, time, force, time_nd, force_nd });
    }
    Ok((rows, difference / largest))
}
