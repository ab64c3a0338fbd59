//! The semi-analytical solution of the first contact: Figs. 2.5 and 2.6.

use super::{Parameters, in_ratio, solved};
use crate::chapters::statement::Statement;
use crate::chapters::study::Study;
use serde::Serialize;
use tasks::Failure;
use vibroimpact::plot::{Axis, Colour, Figure, Marker, Panel, Series};
use vibroimpact::report::significant;
use vibroimpact_sim::infinite::FirstContact;

/// The thesis's number of functions.
const THESIS: usize = 6;
/// Line width in a printed figure, as a share of the height of the figure.
const VISIBLE: f64 = 0.02;
const WHY_VISIBLE: &str = "a line's width, a fiftieth of a figure's height";

/// Just below the first turning point, above which there is no separation.
const LARGEST: f64 = 3.4e4;

/// `v_f / v` for one `S`. The semi-analytical value is missing beyond the end of the branch with a compressive force.
#[derive(Serialize)]
struct Row {
    s: f64,
    functions: usize,
    ratio: f64,
    ratio_semi_analytical: Option<f64>,
    error: Option<f64>,
}

/// The pairs of Fig. 2.6(a).
#[derive(Serialize)]
struct MassRow {
    speed: f64,
    mass: f64,
    s: f64,
}

/// A sample of Figs. 2.6(c) and (d).
#[derive(Serialize)]
struct ForceRow {
    speed: f64,
    time: f64,
    force: f64,
    force_semi_analytical: f64,
}

pub(super) fn run(study: &mut Study, parameters: &Parameters) -> Result<(), Failure> {
    study.section("Semi-analytical solution of the first contact (Figs. 2.5 and 2.6)");
    basis(study)?;
    let (masses, forces) = masses_and_forces(study, parameters)?;
    let ratios = ratios(study, parameters)?;
    let figure = Figure::new("Fig. 2.6  First contact: semi-analytical (N = 6) and full solution")
        .row([masses, ratios.0])
        .row(forces);
    study.figure("fig-2-06", &figure, "The semi-analytical solution is dashed, the full solution solid.")?;
    let figure = Figure::new("Error of the semi-analytical solution in v_f / v, for N functions").row([ratios.1]);
    study.figure(
        "semi-analytical-errors",
        &figure,
        "The force begins and ends as a power 3/2 of time, which the functions t²(1-t)²tᵏ cannot represent. The error \
         therefore decreases only algebraically with their number. A curve ends where no solution without a tensile \
         force is found.",
    )
}

/// Fig. 2.5.
fn basis(study: &mut Study) -> Result<(), Failure> {
    let time: Vec<f64> = (0..=200).map(|i| f64::from(i) / 200.0).collect();
    let mut panel = Panel::new(Axis::new("time / duration of contact"), Axis::new("φ"));
    for k in 0..THESIS {
        let coefficients = (0..THESIS).map(|j| f64::from(u8::from(j == k))).collect();
        let alone = FirstContact { speed: 1.0, mass: 1.0, s: 1.0, coefficients };
        let values: Vec<f64> = time.iter().map(|&t| alone.force(t)).collect();
        panel = panel.with(Series::line(&time, &values).label(format!("φ{}", k + 1)));
    }
    let figure = Figure::new("Fig. 2.5  The orthogonal basis functions").row([panel]);
    study.figure("fig-2-05", &figure, "The polynomials and their slopes vanish at both ends (Eqs. 2.15 to 2.20).")
}

/// Fig. 2.6(a), (c) and (d).
fn masses_and_forces(study: &mut Study, parameters: &Parameters) -> Result<(Panel, Vec<Panel>), Failure> {
    let speeds = study.thin(&in_ratio(1.0, 200.0, 60), 12);
    let found = study.sweep(&speeds, 1, |&speed| Ok(FirstContact::at_speed(speed, THESIS).ok()))?;
    let row = |contact: &FirstContact| MassRow { speed: contact.speed, mass: contact.mass, s: contact.s };
    let rows: Vec<MassRow> = found.iter().flatten().map(row).collect();
    study.csv("fig-2-06a.csv", &rows)?;
    let (v, m): (Vec<f64>, Vec<f64>) = rows.iter().map(|row| (row.speed, row.mass)).unzip();

    let mut marks = (Vec::new(), Vec::new());
    let mut forces = Vec::new();
    let mut samples = Vec::new();
    for (pair, letter) in parameters.first_contact.iter().zip(["c", "d"]) {
        let contact = FirstContact::at_speed(pair.speed, THESIS)?;
        let quantity = format!("m for v = {}, N = 6", pair.speed);
        study.state(Statement::printed(quantity, "Fig. 2.6", &pair.mass, contact.mass));
        marks.0.push(pair.speed);
        marks.1.push(contact.mass);
        let full = solved(contact.s, 0.0)?;
        let end = 1.05 * full.sub_impacts.first().and_then(|first| first.end).unwrap_or(contact.duration());
        let rows: Vec<ForceRow> = (0..=300)
            .map(|i| end * f64::from(i) / 300.0)
            .map(|time| ForceRow {
                speed: pair.speed,
                time,
                force: full.at(time).map_or(f64::NAN, |state| state.force),
                force_semi_analytical: contact.nondimensional_force(time),
            })
            .collect();
        let largest = rows.iter().map(|row| row.force).fold(0.0, f64::max);
        let worst = rows.iter().map(|row| (row.force - row.force_semi_analytical).abs()).fold(0.0, f64::max);
        study.state(Statement::trend(
            format!("largest difference of the forces for v = {}, over the largest force", pair.speed),
            "Fig. 2.6",
            "near-identical",
            (0.0, VISIBLE),
            WHY_VISIBLE,
            worst / largest,
        ));
        let column = |of: fn(&ForceRow) -> f64| rows.iter().map(of).collect::<Vec<f64>>();
        let (time, force, semi) = (column(|r| r.time), column(|r| r.force), column(|r| r.force_semi_analytical));
        let title =
            format!("({letter}) v = {}, m = {:.3}: S = {}", pair.speed, contact.mass, significant(contact.s, 4));
        forces.push(
            Panel::new(Axis::new("time").unit("T"), Axis::new("force").unit("F"))
                .title(title)
                .with(Series::line(&time, &force).colour(Colour::Blue).label("full"))
                .with(Series::line(&time, &semi).colour(Colour::Vermilion).dashed().label("N = 6")),
        );
        samples.extend(rows);
    }
    study.csv("fig-2-06cd.csv", &samples)?;
    let masses = Panel::new(Axis::new("speed v"), Axis::new("mass m"))
        .title("(a) C = k = 1, contact of unit duration")
        .with(Series::line(&v, &m).colour(Colour::Vermilion).dashed())
        .with(Series::points(&marks.0, &marks.1, Marker::Circle).colour(Colour::Black));
    Ok((masses, forces))
}

/// Fig. 2.6(b), and the errors against `S`.
fn ratios(study: &mut Study, parameters: &Parameters) -> Result<(Panel, Panel), Failure> {
    let choice = &parameters.our_choice;
    let values = study.thin(&in_ratio(choice.map_from, LARGEST, 49), 9);
    let cases: Vec<(usize, f64)> = choice.functions.iter().flat_map(|&n| values.iter().map(move |&s| (n, s))).collect();
    let rows = study.sweep(&cases, 1, |&(functions, s)| {
        let ratio = solved(s, 0.0)?.first_rebound_ratio().ok_or("no separation")?;
        let semi = FirstContact::at_s(s, functions).ok().map(|contact| contact.rebound_ratio());
        let error = semi.map(|semi| (semi - ratio).abs());
        Ok(Row { s, functions, ratio, ratio_semi_analytical: semi, error })
    })?;
    study.csv("fig-2-06b.csv", &rows)?;
    let of = |functions: usize| rows.iter().filter(move |row| row.functions == functions);
    let (s, full): (Vec<f64>, Vec<f64>) = of(THESIS).map(|row| (row.s, row.ratio)).unzip();
    let semi: Vec<f64> = of(THESIS).map(|row| row.ratio_semi_analytical.unwrap_or(f64::NAN)).collect();
    let ratio = Panel::new(Axis::new("S").log(), Axis::new("v_f / v"))
        .title("(b) velocity at separation")
        .with(Series::horizontal_rule(0.0))
        .with(Series::line(&s, &full).colour(Colour::Blue).label("full"))
        .with(Series::line(&s, &semi).colour(Colour::Vermilion).dashed().label("N = 6"));
    let mut errors = Panel::new(Axis::new("S").log(), Axis::new("error of v_f / v").log()).height(260.0);
    let mut table = Vec::new();
    for &n in &choice.functions {
        let (s, error): (Vec<f64>, Vec<f64>) = of(n).map(|row| (row.s, row.error.unwrap_or(f64::NAN))).unzip();
        errors = errors.with(Series::line_points(&s, &error, Marker::Dot).label(format!("N = {n}")));
        let within = |from: f64, to: f64| {
            let errors = of(n).filter(|row| row.s > from && row.s <= to).map(|row| row.error);
            let worst = errors.map(|error| error.unwrap_or(f64::INFINITY)).fold(0.0, f64::max);
            if worst.is_finite() { significant(worst, 2) } else { "no solution".into() }
        };
        let edges = [0.0, 1.0, 1e2, parameters.semi_analytical_until, f64::INFINITY];
        let cells = edges.windows(2).map(|edge| within(edge[0], edge[1]));
        table.push(std::iter::once(n.to_string()).chain(cells).collect());
    }
    study.text(
        "Largest error of v_f / v over ranges of S (the last one ends at 3.4×10⁴, before the first turning point):",
    );
    study.table(&["N", "S ≤ 1", "1 to 100", "100 to 1.2×10⁴", "above"], &table);
    let good = of(THESIS).filter(|row| row.s <= parameters.semi_analytical_until).map(|row| row.error.unwrap_or(1.0));
    study.state(Statement::trend(
        "largest error of v_f / v for S ≤ 1.2×10⁴, N = 6",
        "2.3",
        "good for S ≲ 1.2×10⁴",
        (0.0, VISIBLE),
        WHY_VISIBLE,
        good.fold(0.0, f64::max),
    ));
    let fine = in_ratio(1e3, LARGEST, 50);
    let reached = study.sweep(&fine, 1, |&s| Ok(FirstContact::at_s(s, THESIS).is_ok()))?;
    let reach = fine.iter().zip(reached).filter(|(_, reached)| *reached).map(|(s, _)| *s).fold(0.0, f64::max);
    study.state(
        Statement::trend(
            "largest S to which the solution with N = 6 can be followed without a tensile force",
            "2.3",
            "good for S ≲ 1.2×10⁴, for even larger S eventually deteriorates",
            (parameters.semi_analytical_until, LARGEST),
            "from the printed limit to the last S with a separation",
            reach,
        )
        .note("A tensile force of up to 3 % of the largest force is neglected."),
    );
    Ok((ratio, errors))
}
