//! All contacts as functions of `S`: Fig. 2.8 with its turning points, and the regimes of Fig. 2.4.

use super::{Parameters, in_ratio, solved};
use crate::chapters::statement::Statement;
use crate::chapters::study::Study;
use serde::Serialize;
use std::time::Instant;
use tasks::Failure;
use vibroimpact::plot::{Axis, Colour, Figure, Marker, Panel, Series};
use vibroimpact::report::significant;
use vibroimpact_sim::infinite::{CriticalS, Outcome, SubImpact, TurningPoint, critical_s, turning_points};

/// Distance from a turning point up to which its curves are drawn, as a share of its distance from the critical `S`.
const CLOSE: f64 = 1e-6;
/// Longest time that Fig. 2.8 shows (units of `T`).
const LATEST: f64 = 1e6;

/// One value of `S`.
struct Point {
    s: f64,
    outcome: Outcome,
    separations: usize,
    contacts: Vec<SubImpact>,
}

/// One contact of one value of `S`; times in units of `T`.
#[derive(Serialize)]
struct Row {
    s: f64,
    contact: usize,
    start: f64,
    end: Option<f64>,
}

#[derive(Serialize)]
struct TurningRow {
    n: usize,
    s: f64,
    uncertainty: f64,
    s_thesis: Option<String>,
}

pub(super) fn run(study: &mut Study, parameters: &Parameters) -> Result<(), Failure> {
    study.section("Map of separations and turning points (Figs. 2.4 and 2.8)");
    let choice = &parameters.our_choice;
    let critical = critical_s();
    // only a fifth of the values lie below the critical S, where the curves vary little
    let below = choice.map_values / 5;
    let mut values = in_ratio(choice.map_from, 0.999 * critical.s, below);
    let above = in_ratio(choice.map_closest, choice.map_to - critical.s, choice.map_values - below);
    values.extend(above.iter().map(|distance| critical.s + distance));
    let values = study.thin(&values, 100);
    let count = if study.quick { 12 } else { choice.turning_points };

    let point = |&s: &f64| {
        let solution = solved(s, 0.0)?;
        let separations = solution.separations();
        Ok(Point { s, outcome: solution.outcome, separations, contacts: solution.sub_impacts })
    };
    let start = Instant::now();
    let (points, turnings) = rayon::join(|| study.sweep(&values, 1, point), || turning_points(count));
    let seconds = start.elapsed().as_secs_f64();
    let (mut points, turnings) = (points?, turnings?);
    study.remark(format!("The map of {} values of S and {count} turning points took {seconds:.2} s.", values.len()));
    let row = |point: &Point| {
        let s = point.s;
        let one = move |(i, c): (usize, &SubImpact)| Row { s, contact: i + 1, start: c.start, end: c.end };
        point.contacts.iter().enumerate().map(one).collect::<Vec<_>>()
    };
    study.csv("fig-2-08.csv", &points.iter().flat_map(row).collect::<Vec<_>>())?;
    turning_table(study, parameters, critical, &turnings)?;
    inset(study)?;
    regimes(study, &points, critical, &turnings)?;

    let first = points.iter().filter_map(|point| point.contacts.first()?.end.filter(|_| point.s > critical.s));
    let shortest = first.fold(f64::INFINITY, f64::min);
    let statement = Statement::loose(
        "shortest time of a separation above the critical S (T)",
        "2.5",
        "durations range from about 0.5",
        (0.5, 0.05),
        "half a unit of the only digit",
        shortest,
    );
    study.state(statement.note("The shortest first contact ends a little below the first turning point."));

    // the curves of start and end of a contact meet at its turning point
    let ends: Vec<f64> = turnings.iter().map(|t| critical.s + (t.s - critical.s) * (1.0 - CLOSE)).collect();
    points.extend(study.sweep(&ends, 1, point)?);
    points.sort_by(|a, b| a.s.total_cmp(&b.s));
    contact_map(study, &points, critical)
}

fn turning_table(
    study: &mut Study,
    parameters: &Parameters,
    critical: CriticalS,
    turnings: &[TurningPoint],
) -> Result<(), Failure> {
    let printed = |n: usize| parameters.turning_points.get(n - 1).cloned();
    let rows: Vec<TurningRow> = turnings
        .iter()
        .map(|t| TurningRow { n: t.n, s: t.s, uncertainty: t.uncertainty, s_thesis: printed(t.n) })
        .collect();
    study.csv("turning-points.csv", &rows)?;
    for row in &rows {
        let Some(thesis) = &row.s_thesis else { continue };
        let quantity = format!("turning point {}", row.n);
        study.state(Statement::printed(quantity, "2.5", thesis, row.s).uncertain(row.uncertainty));
    }
    for (row, rounded) in rows.iter().zip(["3.53e4", "5.22e2"]) {
        let quantity = format!("turning point {}, to three digits", row.n);
        study.state(Statement::printed(quantity, "2.5", rounded, row.s).uncertain(row.uncertainty));
    }
    for (source, thesis) in [("2.5, last of the list", parameters.critical_s.as_str()), ("2.3, 2.5, 9", "1.56")] {
        let statement =
            Statement::printed("S at which the first rebound velocity vanishes", source, thesis, critical.s);
        let note = format!("Ours: {:.13} ± {:.0e}.", critical.s, critical.uncertainty);
        study.state(statement.uncertain(critical.uncertainty).note(note));
    }
    study.text(&format!(
        "The critical value of S is {:.14} ± {:.0e}. The n-th separation exists for S below the n-th turning point. \
         There are infinitely many turning points, which tend to the critical value.",
        critical.s, critical.uncertainty
    ));
    let thesis = |row: &TurningRow| row.s_thesis.as_ref()?.parse::<f64>().ok();
    let cells = |row: &TurningRow| {
        vec![
            row.n.to_string(),
            format!("{:.13e}", row.s),
            format!("{:.0e}", row.uncertainty),
            row.s_thesis.clone().unwrap_or_default(),
            thesis(row).map_or_else(String::new, |thesis| format!("{:+.3} %", 100.0 * (thesis / row.s - 1.0))),
        ]
    };
    study.table(&["n", "turning point", "±", "thesis", "thesis − ours"], &rows.iter().map(cells).collect::<Vec<_>>());
    Ok(())
}

/// Fig. 2.4: the regimes along the axis of `S`.
fn regimes(study: &mut Study, points: &[Point], critical: CriticalS, turnings: &[TurningPoint]) -> Result<(), Failure> {
    let wrong = points.iter().filter(|point| {
        let beyond = turnings.iter().filter(|t| t.s > point.s).count();
        let expected = if point.s < critical.s { Outcome::Rebound } else { Outcome::Sustained };
        let counted = point.s < critical.s || beyond == turnings.len() || point.separations == beyond;
        point.outcome != expected || (point.s < critical.s && point.separations != 1) || !counted
    });
    study.state(Statement::self_check(
        "values of S at which outcome or separations contradict critical S and turning points",
        [
            "Fig. 2.4",
            "rebound after one contact; separations, then sustained contact; sustained contact at once",
            "our map against our own turning points",
        ],
        (0.0, 0.0),
        wrong.count() as f64,
    ));
    let of = |outcome: Outcome| -> (Vec<f64>, Vec<f64>) {
        points.iter().filter(|p| p.outcome == outcome).map(|p| (p.s, p.separations as f64)).unzip()
    };
    let (rebound, sustained) = (of(Outcome::Rebound), of(Outcome::Sustained));
    let mut panel = Panel::new(Axis::new("S").log().limits(1e-2, 1e6), Axis::new("separations").integers())
        .height(220.0)
        .with(Series::vertical_rule(critical.s).label(format!("critical S = {:.4}", critical.s)));
    if let Some(last) = turnings.first() {
        let label = format!("last turning point, S = {:.0}", last.s);
        panel = panel.with(Series::vertical_rule(last.s).dashed().label(label));
    }
    let panel = panel
        .with(
            Series::line_points(&rebound.0, &rebound.1, Marker::Dot).colour(Colour::Blue).label("one contact, rebound"),
        )
        .with(
            Series::step(&sustained.0, &sustained.1)
                .colour(Colour::Vermilion)
                .label("separations (if any), then sustained contact"),
        );
    study.figure(
        "fig-2-04",
        &Figure::new("Fig. 2.4  Possible behaviours").row([panel]),
        "Left of the first vertical line the body leaves after one contact, and right of the second it never \
         separates. As S decreases towards the first line, the number of separations grows without bound.",
    )
}

/// The region of the inset of Fig. 2.8: late contacts at S = 1.72.
fn inset(study: &mut Study) -> Result<(), Failure> {
    let solution = solved(1.72, 0.0)?;
    let ends: Vec<f64> = solution.sub_impacts.iter().take(TRACKED).filter_map(|contact| contact.end).collect();
    let last = ends.iter().copied().fold(0.0, f64::max);
    let statement = Statement::loose(
        format!("end of contact {TRACKED} at S = 1.72 (10⁵ T)"),
        "2.5, Fig. 2.8",
        "inset at t_nd ≈ 3 and S ≈ 1.72",
        (3.0, 0.5),
        "half a unit of the only digit",
        1e-5 * last,
    );
    let middle = ends.get(TRACKED / 2).map_or(f64::NAN, |end| 1e-5 * end);
    study.state(statement.note(format!(
        "The text does not state the factor of the axis, but the axis is linear and its times reach 5×10⁵. Between \
         contact {} at {} and contact {TRACKED} at {} the curves are close together there.",
        TRACKED / 2 + 1,
        significant(middle, 3),
        significant(1e-5 * last, 3)
    )));
    Ok(())
}

/// Number of contacts that are labelled where the curves are dense. It equals the number of printed turning points.
const NUMBERED: usize = 12;

/// Number of separations that the thesis computed.
const TRACKED: usize = 18;

/// Fig. 2.8.
fn contact_map(study: &mut Study, points: &[Point], critical: CriticalS) -> Result<(), Failure> {
    let s: Vec<f64> = points.iter().map(|point| point.s).collect();
    // the separations that the thesis computed, and the contact after them
    let most = points.iter().map(|point| point.contacts.len()).max().unwrap_or(0).min(TRACKED + 1);
    let distance: Vec<f64> = s.iter().map(|s| s - critical.s).collect();
    let second: Vec<f64> = points.iter().map(|p| p.contacts.get(1).map_or(f64::NAN, |contact| contact.start)).collect();
    let time = Axis::new("time").unit("T").log().limits(0.3, LATEST);
    let mut upper = Panel::new(Axis::new("S").log().limits(1e-10, 2e5), time).title("(a) all contacts").height(320.0);
    let x = Axis::new("S above its critical value").log().limits(0.02, 1e3);
    let mut lower = Panel::new(x, Axis::new("time / start of the second contact").log().limits(0.9, 20.0))
        .title("(b) the later contacts, magnified")
        .height(360.0);
    // values of S are sorted
    let near = s.partition_point(|s| *s < 1.58)..s.partition_point(|s| *s < 2.25);
    let time = Axis::new("time").unit("10⁵ T");
    let mut linear = Panel::new(Axis::new("S").limits(1.6, 2.2), time.clone().limits(0.0, 5.0))
        .title("(c) linear axes, as in the printed figure")
        .height(260.0);
    let mut inset =
        Panel::new(Axis::new("S").limits(1.71, 1.73), time.limits(2.3, 3.3)).title("(d) its inset").height(260.0);
    for k in 0..most {
        // the start and the end of a contact have the same colour
        let colour = if k == 0 { Colour::Purple } else { Colour::of_series(k - 1) };
        let value = |of: fn(&SubImpact) -> Option<f64>| -> Vec<f64> {
            points.iter().map(|point| point.contacts.get(k).and_then(of).unwrap_or(f64::NAN)).collect()
        };
        let (mut starts, ends) = (value(|contact| Some(contact.start)), value(|contact| contact.end));
        // only the solid line is drawn where both curves coincide
        for (start, end) in starts.iter_mut().zip(&ends) {
            if end - *start < 0.01 * *start {
                *start = f64::NAN;
            }
        }
        let width = if k == 0 { 2.4 } else { 1.0 };
        let start = |x: &[f64], y: &[f64]| Series::line(x, y).colour(colour).line_width(1.0).dashed();
        let end = |x: &[f64], y: &[f64]| Series::line(x, y).colour(colour).line_width(width);
        upper = upper.with(start(&s, &starts)).with(end(&s, &ends));
        let relative = |times: &[f64]| times.iter().zip(&second).map(|(t, second)| t / second).collect::<Vec<f64>>();
        let (relative_starts, relative_ends) = (relative(&starts), relative(&ends));
        // the number of a contact is written where its curve ends, at the turning point
        if let Some(last) = (0..s.len()).filter(|&i| ends[i].is_finite()).max_by(|&a, &b| s[a].total_cmp(&s[b])) {
            let number = |x: f64, y: f64| Series::labels(&[x], &[y], [(k + 1).to_string()]).colour(colour);
            // further numbers would overlap
            if k < NUMBERED {
                upper = upper.with(number(s[last], ends[last]));
            }
            lower = lower.with(number(distance[last], relative_ends[last]));
        }
        lower = lower.with(start(&distance, &relative_starts)).with(end(&distance, &relative_ends));
        // both axes of the printed figure are linear there
        let (x, ends) = (&s[near.clone()], near.clone().map(|i| 1e-5 * ends[i]).collect::<Vec<f64>>());
        // the point at which the curve crosses a height
        let number = |height: f64| {
            let passes = (1..x.len()).find(|&i| ends[i - 1] >= height && ends[i] < height);
            let place =
                passes.map_or(f64::NAN, |i| x[i] + (height - ends[i]) / (ends[i - 1] - ends[i]) * (x[i - 1] - x[i]));
            Series::labels(&[place], &[height], [(k + 1).to_string()]).colour(colour)
        };
        if (1..4).contains(&k) {
            linear = linear.with(number(4.5));
        }
        if (4..NUMBERED).contains(&k) {
            inset = inset.with(number(2.6));
        }
        linear = linear.with(end(x, &ends));
        inset = inset.with(end(x, &ends));
    }
    study.main_figure(
        "fig-2-08",
        &Figure::new("Fig. 2.8  Starts (dashed) and ends (solid) of contacts against S")
            .row([upper.with(Series::vertical_rule(critical.s))])
            .row([lower])
            .row([linear, inset]),
        "A curve of separation and the next curve of touch meet at a turning point, whose number is that of the \
         contact that ends there. In (c) and (d) the number is at the curve itself, and only the ends of contacts are \
         drawn, because their starts would coincide with them. Colours repeat. The figure shows 18 separations, as \
         many as the thesis. All curves approach the critical S, at which the time to the second contact is infinite.",
    )
}
