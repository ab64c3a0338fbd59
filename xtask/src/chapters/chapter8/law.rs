//! The algebraic law for dropped rods: effective mass and shapes of section 8.1, one set of parameters for all rods.

use super::Parameters;
use super::drops::DropRow;
use crate::chapters::statement::{FALLS, Statement};
use crate::chapters::study::Study;
use emoc::{Impact, Site};
use fitting::Fit;
use serde::Serialize;
use std::f64::consts::SQRT_2;
use tasks::Failure;
use vibroimpact::net::Observations;
use vibroimpact::net::law;
use vibroimpact::plot::{Axis, Colour, Figure, Marker, Panel, Series};
use vibroimpact::report::significant;
use vibroimpact_sim::dropped_rod::DroppedRod;

/// A restitution to which the law is fitted.
#[derive(Debug, Clone, Copy)]
pub(in crate::chapters) struct Point {
    pub length_m: f64,
    pub angle_deg: f64,
    pub restitution: f64,
}

/// Input of the law for a rod: all bending modes below the first axial one, and a number of axial modes.
pub(super) fn impact(
    parameters: &Parameters,
    length_m: f64,
    angle_deg: f64,
    axial_modes: usize,
) -> Result<Impact, Failure> {
    let rod = parameters.rod(length_m, angle_deg);
    let (sin, cos) = rod.inclination_rad.sin_cos();
    let root = rod.mass_kg().sqrt();
    // for an upright rod the rounding of cos(90°) would count as a mode shape
    let cos = if angle_deg == 90.0 { 0.0 } else { cos };
    let bending = vec![2.0 * cos / root; rod.bending_modes_below_first_axial()?];
    let axial = vec![SQRT_2 * sin / root; axial_modes];
    Ok(Impact::new(rod.rigid_body_mass_kg(), &Site::new(&[bending, axial].concat())?)?)
}

pub(super) fn observations(
    parameters: &Parameters,
    points: &[Point],
    axial_modes: usize,
) -> Result<Observations, Failure> {
    Ok(Observations {
        impacts: points
            .iter()
            .map(|point| impact(parameters, point.length_m, point.angle_deg, axial_modes))
            .collect::<Result<_, Failure>>()?,
        restitution: points.iter().map(|point| point.restitution).collect(),
    })
}

/// Largest number of axial modes in the law.
const MORE_AXIAL: usize = 4;

/// A parameter above this value counts as infinite.
const RUN_OFF: f64 = 1e9;

/// Root of the mean square of the residuals of some points.
fn rms(residuals: &[f64], chosen: impl Fn(usize) -> bool) -> f64 {
    let squares: Vec<f64> = (0..residuals.len()).filter(|&i| chosen(i)).map(|i| residuals[i].powi(2)).collect();
    (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
}

#[derive(Serialize)]
struct LawRow {
    length_m: f64,
    angle_deg: f64,
    restitution: f64,
    restitution_of_the_law: f64,
    restitution_with_one_axial_mode: f64,
    rigid_body_mass_kg: f64,
    z: f64,
}

pub(super) fn run(study: &mut Study, parameters: &Parameters, drops: &[DropRow]) -> Result<(), Failure> {
    study.section("The algebraic law, one set of parameters for all rods (Figs. 8.2 and 8.3)");
    bending_modes(study, parameters)?;
    let point = |row: &DropRow| {
        let &DropRow { length_m, angle_deg, restitution, .. } = row;
        restitution.map(|restitution| Point { length_m, angle_deg, restitution })
    };
    let points: Vec<Point> = drops.iter().filter_map(point).collect();
    let found = observations(parameters, &points, 0)?.fit()?;
    let with_axial = observations(parameters, &points, 1)?;
    let mut residuals_axial = vec![0.0; points.len()];
    with_axial.residuals(&found.parameters, &mut residuals_axial);
    let refitted = with_axial.fit()?;

    study.main_figure(
        "fig-8-02",
        &by_rod("Fig. 8.2  Law and drops, one set of parameters:", RESOLVED, parameters, &points, &found)?,
        "Red: the drop resolved in time (not the experiment). Blue: the law, one set of parameters for all rods.",
    )?;
    let longest = parameters.lengths_m[0];
    let of_longest = |i: usize| points[i].length_m == longest;
    study.main_figure(
        "fig-8-03",
        &axial_figure(parameters, &points, &found, longest)?,
        "The figure shows the longest rod. One axial mode in the law, with the parameters of Fig. 8.2, lowers the \
         restitution of steep rods.",
    )?;

    let steep = |i: usize| points[i].angle_deg > 70.0;
    let line = |name: &str, fit: &[f64], residuals: &[f64]| {
        let numbers = parameters.lengths_m.iter().map(|l| rms(residuals, |i| points[i].length_m == *l));
        let p: Vec<String> = fit.iter().map(|p| if *p > RUN_OFF { "∞".into() } else { significant(*p, 3) }).collect();
        let all = [rms(residuals, |_| true), rms(residuals, steep)];
        [name.to_string(), p.join(", ")]
            .into_iter()
            .chain(numbers.chain(all).map(|v| significant(v, 3)))
            .collect::<Vec<String>>()
    };
    let names: Vec<String> = parameters.lengths_m.iter().map(|l| format!("{:.0} mm", 1e3 * l)).collect();
    let headers: Vec<&str> =
        ["law", "μ₀, α₀, α₁"].into_iter().chain(names.iter().map(String::as_str)).chain(["all", "above 70°"]).collect();
    study.table(
        &headers,
        &[
            line("bending modes only", &found.parameters, &found.residuals),
            line("with one axial mode, same parameters", &found.parameters, &residuals_axial),
            line("with one axial mode, fitted anew", &refitted.parameters, &refitted.residuals),
        ],
    );
    study.text(&format!(
        "The table has the rms difference of law and resolved drop. The largest difference is {}, over all {} drops. A \
         parameter stated as ∞ has grown beyond all limits: with an axial mode the law cannot rise to 1 towards 90° \
         for any parameters.",
        significant(found.report.max_abs, 3),
        found.report.count
    ));
    study.state(Statement::trend(
        "rms error with one axial mode over that without, 600 mm, above 70°",
        "8.2.2, Fig. 8.3",
        "the fit worsens when an axial mode is included and the rod is near vertical",
        (1.0, f64::INFINITY),
        "any amount",
        rms(&residuals_axial, |i| of_longest(i) && steep(i)) / rms(&found.residuals, |i| of_longest(i) && steep(i)),
    ));
    let fall = |i: usize| residuals_axial[i] - found.residuals[i];
    let falls: Vec<f64> = (0..points.len()).filter(|&i| of_longest(i) && steep(i)).map(fall).collect();
    let mut worse = Vec::new();
    for axial_modes in 0..=MORE_AXIAL {
        let law = observations(parameters, &points, axial_modes)?;
        let mut residuals = vec![0.0; points.len()];
        law.residuals(&found.parameters, &mut residuals);
        worse.push(rms(&residuals, |i| of_longest(i) && steep(i)));
    }
    study.state(
        Statement::trend(
            "least rms error with two to four axial modes over that with one, 600 mm, above 70°",
            "8.2.2",
            "the fit worsens upon retaining more axial modes",
            (1.0, f64::INFINITY),
            "any amount",
            worse.iter().skip(2).copied().fold(f64::INFINITY, f64::min) / worse.get(1).copied().unwrap_or(f64::NAN),
        )
        .note(format!(
            "Errors with 0 to {MORE_AXIAL} axial modes: {}.",
            worse.iter().map(|rms| significant(*rms, 3)).collect::<Vec<_>>().join(", ")
        )),
    );
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    study.state(Statement::trend(
        "mean change of e by one axial mode, 600 mm, above 70°",
        "Fig. 8.3",
        "lowers the predicted restitution value",
        FALLS,
        "any amount",
        mean(&falls),
    ));
    let under: Vec<f64> = (0..points.len()).filter(|&i| steep(i)).map(|i| residuals_axial[i]).collect();
    study.state(Statement::trend(
        "mean difference of the law with one axial mode and the drops, five rods, above 70°",
        "8.2.1",
        "if we retain axial modes then the EMOC model underpredicts the restitution",
        FALLS,
        "any amount",
        mean(&under),
    ));
    study.state(
        Statement::trend(
            "rms difference of law and drops, five rods, one set of parameters",
            "8.2.2, 9",
            "a good match is obtained",
            (0.0, 0.1),
            "chapter 9: within ±0.1 in a range from 0 to 1 there is no comparable effort",
            found.report.rms,
        )
        .missing("the measured points; ours are resolved drops"),
    );
    let rows: Vec<LawRow> = (0..points.len())
        .map(|i| {
            let Point { length_m, angle_deg, restitution } = points[i];
            let rod = parameters.rod(length_m, angle_deg);
            Ok(LawRow {
                length_m,
                angle_deg,
                restitution,
                restitution_of_the_law: restitution + found.residuals[i],
                restitution_with_one_axial_mode: restitution + residuals_axial[i],
                rigid_body_mass_kg: rod.rigid_body_mass_kg(),
                z: impact(parameters, length_m, angle_deg, 0)?.z,
            })
        })
        .collect::<Result<_, Failure>>()?;
    study.csv("fig-8-02.csv", &rows)
}

/// The numbers of modes of section 8.2.2. Two of them determine the diameter, which the text does not print.
fn bending_modes(study: &mut Study, parameters: &Parameters) -> Result<(), Failure> {
    let lengths = || parameters.lengths_m.iter().zip(&parameters.bending_modes_of_the_law);
    let count = |length_m: f64, diameter_m: f64| {
        DroppedRod { diameter_m, ..parameters.rod(length_m, 45.0) }.bending_modes_below_first_axial()
    };
    let mut fitting = Vec::new();
    for diameter_m in (400..=1000).map(|k| 2e-5 * f64::from(k)) {
        let mut given = Vec::new();
        for (&length, &stated) in lengths() {
            given.push(count(length, diameter_m)? == stated);
        }
        fitting.push((diameter_m, given));
    }
    // smallest and largest diameter with this number of modes
    let span = |chosen: &dyn Fn(&[bool]) -> bool| {
        let of = fitting.iter().filter(|(_, given)| chosen(given)).map(|(diameter, _)| 1e3 * diameter);
        of.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high): (f64, f64), d| (low.min(d), high.max(d)))
    };
    let spans: Vec<(f64, f64)> = (0..parameters.lengths_m.len()).map(|k| span(&|given| given[k])).collect();
    let all = span(&|given| given.iter().all(|given| *given));
    let (low, high) = (significant(all.0, 4), significant(all.1, 4));
    for ((&length, &stated), own) in lengths().zip(&spans) {
        let found = count(length, parameters.our_choice.diameter_m)? as f64;
        let quantity = format!("bending modes below the first axial one, {:.0} mm", 1e3 * length);
        if own.0 == all.0 || own.1 == all.1 {
            let reason = "the diameter is ours, found from this number and one other";
            let (words, exactly) = (stated.to_string(), (stated as f64, stated as f64));
            study.state(Statement::self_check(quantity, ["8.2.2", &words, reason], exactly, found));
        } else {
            let note = format!(
                "This holds for every diameter from {low} to {high} mm, the range that the other two numbers allow."
            );
            study.state(Statement::printed(quantity, "8.2.2", &stated.to_string(), found).note(note));
        }
    }
    Ok(())
}

/// Inclinations at which the law is drawn.
fn fine_angles() -> Vec<f64> {
    (0..=180).map(|i| 0.5 * f64::from(i)).collect()
}

fn law_curve(parameters: &Parameters, found: &Fit, length_m: f64, axial_modes: usize) -> Result<Vec<f64>, Failure> {
    let fitted = law(&found.parameters);
    fine_angles()
        .iter()
        .map(|&angle| Ok(fitted.rebound(&impact(parameters, length_m, angle, axial_modes)?)?.restitution))
        .collect()
}

/// The points of the chapter's own figures in a legend.
const RESOLVED: &str = "resolved in time";

fn panel(title: String, points: &[Point], length_m: f64, label: &str) -> Panel {
    let of_rod = points.iter().filter(|point| point.length_m == length_m);
    let (angle, e): (Vec<f64>, Vec<f64>) = of_rod.map(|point| (point.angle_deg, point.restitution)).unzip();
    let x = Axis::new("inclination θ").unit("°").limits(-2.0, 92.0);
    let y = Axis::new("restitution e").limits(-0.04, 1.04);
    Panel::new(x, y).title(title).with(Series::points(&angle, &e, Marker::Plus).colour(Colour::Vermilion).label(label))
}

/// Draws one panel per rod, as Fig. 8.2. `source` describes the points in the legend.
pub(super) fn by_rod(
    name: &str,
    source: &str,
    parameters: &Parameters,
    points: &[Point],
    found: &Fit,
) -> Result<Figure, Failure> {
    let mut lengths: Vec<f64> = points.iter().map(|point| point.length_m).collect();
    lengths.sort_by(|a, b| b.total_cmp(a));
    lengths.dedup();
    let fine = fine_angles();
    let panels = lengths
        .iter()
        .enumerate()
        .map(|(k, &length)| {
            let modes = parameters.rod(length, 45.0).bending_modes_below_first_axial()?;
            let title = format!("{:.0} mm, {modes} bending modes", 1e3 * length);
            let curve = law_curve(parameters, found, length, 0)?;
            let [of_points, of_law] = if k == 0 { [source, "algebraic law"] } else { [""; 2] };
            let line = Series::line(&fine, &curve).colour(Colour::Blue).label(of_law);
            Ok(panel(title, points, length, of_points).height(150.0).with(line))
        })
        .collect::<Result<Vec<Panel>, Failure>>()?;
    let p: Vec<String> = found.parameters.iter().map(|p| significant(*p, 3)).collect();
    let title = format!("{name} μ₀ = {}, α₀ = {}, α₁ = {}", p[0], p[1], p[2]);
    Ok(panels.chunks(3).fold(Figure::new(title).width(960.0), |figure, row| figure.row(row.to_vec())))
}

fn axial_figure(parameters: &Parameters, points: &[Point], found: &Fit, length_m: f64) -> Result<Figure, Failure> {
    let fine = fine_angles();
    let mut panel = panel(String::new(), points, length_m, RESOLVED).height(260.0);
    for (axial, colour, label) in [(0, Colour::Blue, "bending modes only"), (1, Colour::Green, "and one axial mode")] {
        let curve = law_curve(parameters, found, length_m, axial)?;
        panel = panel.with(Series::line(&fine, &curve).colour(colour).label(label));
    }
    Ok(Figure::new(format!("Fig. 8.3  Rod of {:.0} mm", 1e3 * length_m)).row([panel]))
}
