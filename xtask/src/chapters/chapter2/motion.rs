//! Motion and force of three impacts: Fig. 2.3.

use super::{Course, Motion, Parameters, solved};
use crate::chapters::statement::Statement;
use crate::chapters::study::Study;
use tasks::Failure;
use vibroimpact::infinite::samples;
use vibroimpact::plot::{Axis, Colour, Figure, Panel, Series};
use vibroimpact::report::significant;
use vibroimpact_sim::infinite::Solution;

pub(super) fn run(study: &mut Study, parameters: &Parameters) -> Result<(), Failure> {
    study.section("Three regimes (Fig. 2.3)");
    let solutions = study.sweep(&parameters.motion, 1, |motion| solved(motion.s, motion.until))?;
    let mut figure = Figure::new("Fig. 2.3  Motion and contact force for low, moderate and high S");
    for (Motion { s, separations, until }, solution) in parameters.motion.iter().zip(&solutions) {
        let course = Course::new(*s, &samples(solution, *until, if study.quick { 200 } else { 800 }));
        study.csv(&format!("fig-2-03-s-{s:e}.csv"), &course.rows())?;
        let time = Axis::new("time").unit("T").limits(0.0, *until);
        let several = solution.sub_impacts.len() > 1;
        let force =
            if several { Axis::new("force").unit("F").log().limits(1e-5, 3.0) } else { Axis::new("force").unit("F") };
        let motion = Panel::new(time.clone(), Axis::new("displacement").unit("D"))
            .title(format!("S = {}, separations: {}", significant(*s, 3), solution.separations()))
            .height(150.0)
            .with(Series::line(&course.time, &course.beam).colour(Colour::Vermilion).label("y, beam"))
            .with(Series::line(&course.time, &course.body).colour(Colour::Blue).label("z, body"));
        // a force of zero has no logarithm, so the line leaves the figure at its lower edge
        let drawn: Vec<f64> = course.force.iter().map(|f| if several { f.max(1e-9) } else { *f }).collect();
        let force =
            Panel::new(time, force).height(150.0).with(Series::line(&course.time, &drawn).colour(Colour::Black));
        figure = figure.row([motion, force]);
        study.state(Statement::printed(
            format!("separations at S = {}", significant(*s, 3)),
            "2.2.5, Fig. 2.3",
            &separations.to_string(),
            solution.separations() as f64,
        ));
    }
    oscillations(study)?;
    study.figure(
        "fig-2-03",
        &figure,
        "The force at S = 15 has a logarithmic axis, because each contact is weaker than the one before by an order of \
         magnitude. With S = 4×10⁵ the force does not vanish again.",
    )
}

/// Section 2.2.5: in sustained contact the force oscillates and the oscillations decay.
fn oscillations(study: &mut Study) -> Result<(), Failure> {
    const PLACES: [f64; 4] = [5.0, 15.0, 50.0, 500.0];
    let found = study.sweep(&PLACES, 1, |s| growth_of_swings(*s))?;
    let told: Vec<String> = found.iter().map(|ratio| significant(*ratio, 2)).collect();
    study.state(
        Statement::trend(
            "largest ratio of successive amplitudes of the compression, each about the mean of its neighbours; four S",
            "2.2.5, Fig. 2.3",
            "during final sustained contact, the contact force shows decaying oscillations",
            (0.0, 1.0),
            "each amplitude is smaller than the one before",
            found.iter().copied().fold(0.0, f64::max),
        )
        .note(format!("At S = {}: {}.", PLACES.map(|s| significant(s, 3)).join(", "), told.join(", "))),
    );
    Ok(())
}

/// The largest such ratio in the contact that lasts.
fn growth_of_swings(s: f64) -> Result<f64, Failure> {
    let start = |solution: &Solution| solution.sub_impacts.last().map_or(0.0, |last| last.start);
    let solution = solved(s, 3.0 * start(&solved(s, 0.0)?))?;
    let last = solution.sub_impacts.len().saturating_sub(1);
    let turns = solution.extrema.iter().filter(|turn| turn.contact == last);
    let turns: Vec<f64> = turns.map(|turn| turn.compression).collect();
    // the mean of the force decreases while it oscillates
    let swings: Vec<f64> = turns.windows(3).map(|three| (three[1] - 0.5 * (three[0] + three[2])).abs()).collect();
    Ok(swings.windows(2).map(|pair| pair[1] / pair[0]).reduce(f64::max).ok_or("too few oscillations")?)
}
