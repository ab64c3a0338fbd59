//! Fig. A.3: modal analysis against finite elements on the uniform cantilever.

use super::Case;
use crate::chapters::Failure;
use crate::chapters::impact::Row;
use crate::chapters::study::Study;
use beam_modes::fem::Model;
use serde::Serialize;
use vibroimpact::plot::{Axis, Colour, Figure, Marker, Panel, Series};
use vibroimpact::report::{Comparison, significant};
use vibroimpact_sim::modal::{Mode, Solver, Structure};

#[derive(Serialize)]
struct BothRow {
    location_m: f64,
    restitution_modal: Option<f64>,
    restitution_finite_elements: Option<f64>,
    sub_impacts_modal: usize,
    sub_impacts_finite_elements: usize,
}

pub(super) fn run(study: &mut Study, case: &Case) -> Result<(), Failure> {
    study.section("Modal analysis against finite elements (Fig. A.3)");
    let p = &case.parameters.our_choice.finite_element_study;
    let (beam, ball) = (case.beam(&p.beam)?, case.ball(p.diameter_m)?);
    let elements = case.parameters.finite_elements;
    let discrete = Model::new(&beam.model, elements)?.modes()?;
    let nodes: Vec<f64> = (1..=elements).map(|i| beam.model.length_m() * i as f64 / elements as f64).collect();
    let found = study.sweep(&study.thin(&nodes, 5), 2, |&location_m| {
        let setup = case.setup(beam, ball, location_m);
        let shapes = discrete.shapes_at(location_m)?;
        let damping_ratio = setup.damping_ratio;
        let pairs = discrete.omega_rad_s().iter().zip(shapes);
        let modes = pairs.map(|(&omega_rad_s, shape)| Mode { omega_rad_s, damping_ratio, shape }).collect();
        let mut solver = Solver::new(&Structure { modes, residual_compliance_m_n: 0.0 })?;
        Ok((setup.solve()?, setup.solve_with(&mut solver)?))
    })?;
    let rows: Vec<BothRow> = found
        .iter()
        .map(|(modal, elements)| BothRow {
            location_m: modal.location_m,
            restitution_modal: modal.restitution,
            restitution_finite_elements: elements.restitution,
            sub_impacts_modal: modal.sub_impacts,
            sub_impacts_finite_elements: elements.sub_impacts,
        })
        .collect();
    study.csv("fig-a-03.csv", &rows)?;

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
        "At the nodes of the finite elements; the clamped node, where the ball meets a rigid wall, is left out. Largest \
         difference {}, median {}. The upper half of the frequencies of the finite elements is too high, as always.",
        significant(largest, 2),
        significant(median, 2)
    );
    study.figure("fig-a-03", &Figure::new(title).row([panel]).width(620.0), &caption)?;
    let source = "A.4, Fig. A.3";
    study.state(Comparison::range(
        "median difference of e, modal and finite elements",
        source,
        "a very good match",
        (0.0, 0.02),
        median,
    ));
    study.state(Comparison::range(
        "largest difference of e, modal and finite elements",
        source,
        "a good match",
        (0.0, 0.1),
        largest,
    ));
    let e_of = |rows: &dyn Fn(&(Row, Row)) -> f64| found.iter().map(rows).fold(f64::INFINITY, f64::min);
    study.state(Comparison::range(
        "smallest e of the comparison",
        source,
        "mismatch is larger where e is 0.1 or less",
        (0.1, 1.0),
        e_of(&|f| f.0.e()),
    ));
    Ok(())
}
