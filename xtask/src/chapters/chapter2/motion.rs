//! The course of three impacts: Fig. 2.3.

use super::{Course, Motion, Parameters, solved};
use crate::chapters::Failure;
use crate::chapters::statement::Statement;
use crate::chapters::study::Study;
use vibroimpact::infinite::samples;
use vibroimpact::plot::{Axis, Colour, Figure, Panel, Series};
use vibroimpact::report::significant;

pub(super) fn run(study: &mut Study, parameters: &Parameters) -> Result<(), Failure> {
    study.section("Three regimes (Fig. 2.3)");
    let solutions = study.sweep(&parameters.motion, 1, |motion| solved(motion.s, motion.until))?;
    let mut figure = Figure::new("Fig. 2.3  Motion and contact force for low, moderate and high S");
    for (Motion { s, separations, until }, solution) in parameters.motion.iter().zip(&solutions) {
        let course = Course::new(*s, &samples(solution, *until, if study.quick { 200 } else { 800 }));
        study.csv(&format!("fig-2-03-s-{s:e}.csv"), &course.rows())?;
        let time = Axis::new("time").unit("T").limits(0.0, *until);
        let several = solution.contacts.len() > 1;
        let force =
            if several { Axis::new("force").unit("F").log().limits(1e-5, 3.0) } else { Axis::new("force").unit("F") };
        let motion = Panel::new(time.clone(), Axis::new("displacement").unit("D"))
            .title(format!("S = {}, separations: {}", significant(*s, 3), solution.separations()))
            .height(150.0)
            .with(Series::line(&course.time, &course.beam).colour(Colour::Vermilion).label("y, beam"))
            .with(Series::line(&course.time, &course.body).colour(Colour::Blue).label("z, body"));
        // without contact there is no logarithm: the line goes down past the axis
        let drawn: Vec<f64> = course.force.iter().map(|f| if several { f.max(1e-9) } else { *f }).collect();
        let force =
            Panel::new(time, force).height(150.0).with(Series::line(&course.time, &drawn).colour(Colour::Black));
        figure = figure.row([motion, force]);
        study.claim(Statement::printed(
            format!("separations at S = {}", significant(*s, 3)),
            "2.2.5, Fig. 2.3",
            &separations.to_string(),
            solution.separations() as f64,
        ));
    }
    study.figure(
        "fig-2-03",
        &figure,
        "The force at S = 15 is drawn on a logarithmic axis: each contact is an order of magnitude weaker than the one \
         before. With S = 4×10⁵ it never reaches zero again.",
    )
}
