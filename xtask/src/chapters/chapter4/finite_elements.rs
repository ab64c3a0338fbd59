//! Fig. A.3: modal analysis against finite elements on the uniform cantilever.

use super::Case;
use crate::chapters::statement::Statement;
use crate::chapters::study::Study;
use beam_modes::fem::Model;
use serde::Serialize;
use tasks::Failure;
use vibroimpact::plot::{Axis, Colour, Figure, Marker, Panel, Series};
use vibroimpact::report::significant;
use vibroimpact_sim::modal::{Solver, Structure};

#[derive(Serialize)]
struct BothRow {
    diameter_m: f64,
    location_m: f64,
    restitution_modal: Option<f64>,
    restitution_finite_elements: Option<f64>,
    sub_impacts_modal: usize,
    sub_impacts_finite_elements: usize,
}

pub(super) fn run(study: &mut Study, case: &Case) -> Result<(), Failure> {
    study.section("Modal analysis against finite elements (Fig. A.3)");
    let p = &case.parameters.our_choice.finite_element_study;
    let beam = case.beam(&p.beam)?;
    let balls = [p.diameter_m]
        .iter()
        .chain(&p.other_diameters_m)
        .map(|&d| case.ball(d))
        .collect::<Result<Vec<_>, Failure>>()?;
    let elements = case.parameters.finite_elements;
    let discrete = Model::new(&beam.model.beam, elements)?.modes()?;
    let nodes: Vec<f64> = (1..=elements).map(|i| beam.model.beam.length_m() * i as f64 / elements as f64).collect();
    let nodes = study.thin(&nodes, 5);
    let cases: Vec<_> = balls.iter().flat_map(|ball| nodes.iter().map(move |&node| (*ball, node))).collect();
    let all = study.sweep(&cases, 2, |&(ball, location_m)| {
        let setup = case.setup(beam, ball, location_m);
        let solver = Solver::new(&Structure::from_modes(discrete.seen_from(location_m)?, setup.damping_ratio))?;
        Ok((setup.solve()?, setup.solve_with(&solver)?))
    })?;
    let rows: Vec<BothRow> = all
        .iter()
        .map(|(modal, elements)| BothRow {
            diameter_m: modal.diameter_m,
            location_m: modal.location_m,
            restitution_modal: modal.restitution,
            restitution_finite_elements: elements.restitution,
            sub_impacts_modal: modal.sub_impacts,
            sub_impacts_finite_elements: elements.sub_impacts,
        })
        .collect();
    study.csv("fig-a-03.csv", &rows)?;

    let (found, ball) = (&all[..nodes.len()], balls[0]);
    let x: Vec<f64> = found.iter().map(|f| f.0.location_m).collect();
    let modal: Vec<f64> = found.iter().map(|f| f.0.e()).collect();
    let elements_e: Vec<f64> = found.iter().map(|f| f.1.e()).collect();
    let panel = Panel::new(Axis::new("location b").unit("m"), Axis::new("restitution e"))
        .height(240.0)
        .with(Series::points(&x, &modal, Marker::Circle).colour(Colour::Blue).label("modal, N = 40"))
        .with(Series::points(&x, &elements_e, Marker::Cross).colour(Colour::Vermilion).label("20 finite elements"));
    let title = format!("Fig. A.3  {}, m = {:.3} kg", beam.title, ball.mass_kg);
    let differences: Vec<f64> = modal.iter().zip(&elements_e).map(|(a, b)| (a - b).abs()).collect();
    let largest = differences.iter().copied().fold(0.0, f64::max);
    let mut sorted = differences;
    sorted.sort_by(f64::total_cmp);
    let median = sorted.get(sorted.len() / 2).copied().unwrap_or(f64::NAN);
    let caption = format!(
        "Restitution at the nodes of the finite elements, except for the clamped node, where the ball meets a rigid \
         wall. The largest difference is {}, the median {}. The upper half of the frequencies of the finite elements \
         is too high, as is usual.",
        significant(largest, 2),
        significant(median, 2)
    );
    study.figure("fig-a-03", &Figure::new(title).row([panel]).width(620.0), &caption)?;
    let source = "A.4, Fig. A.3";
    study.state(Statement::trend(
        "median difference of e, modal and finite elements",
        source,
        "a very good match",
        (0.0, 0.02),
        "a line's width, a fiftieth of a figure's height",
        median,
    ));
    study.state(Statement::trend(
        "largest difference of e, modal and finite elements",
        source,
        "a good match",
        (0.0, 0.1),
        "a tenth of the range from 0 to 1",
        largest,
    ));
    // weak rebounds and all others, for all balls
    let mean = |weak: bool| {
        let chosen = all.iter().filter(|(modal, _)| (modal.e() <= WEAK) == weak);
        let gaps: Vec<f64> = chosen.map(|(modal, elements)| (modal.e() - elements.e()).abs()).collect();
        let n = gaps.len() as f64;
        let mean = gaps.iter().sum::<f64>() / n;
        let variance = gaps.iter().map(|gap| (gap - mean).powi(2)).sum::<f64>() / (n - 1.0);
        (mean, (variance / n).sqrt() / mean)
    };
    let (weak, elsewhere) = (mean(true), mean(false));
    let ratio = weak.0 / elsewhere.0;
    let statement = Statement::trend(
        "mean difference where e is 0.15 or less, over that elsewhere, three balls",
        "A.4",
        "when the rebound was much smaller, e.g. 0.1, the mismatch was a bit larger",
        (1.0, f64::INFINITY),
        "any amount beyond the standard error of the two means",
        ratio,
    )
    .uncertain(ratio * weak.1.hypot(elsewhere.1));
    study.state(statement.note(format!(
        "In {} of {} impacts e is so small. The balls are the three whose masses chapter 4 states.",
        all.iter().filter(|(modal, _)| modal.e() <= WEAK).count(),
        all.len()
    )));
    Ok(())
}

/// A restitution of "e.g. 0.1".
const WEAK: f64 = 0.15;
