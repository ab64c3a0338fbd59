//! Motion and force of single impacts: Figs. 3.3, 3.12 and A.2.

use super::Case;
use crate::chapters::figures::Course;
use crate::chapters::impact::Setup;
use crate::chapters::statement::Statement;
use crate::chapters::study::Study;
use tasks::Failure;
use vibroimpact::plot::{Axis, Colour, Figure, Panel, Series};

pub(super) fn run(study: &mut Study, case: &Case) -> Result<(), Failure> {
    one_impact(study, case)?;
    damped_and_undamped(study, case)
}

/// Acceleration of free fall (m/s²).
const GRAVITY: f64 = 9.81;

/// Fig. 3.3: 25 modes, b = 0.4.
fn one_impact(study: &mut Study, case: &Case) -> Result<(), Failure> {
    study.section("One impact in detail (Fig. 3.3)");
    let setup = case.setup(case.parameters.locations_m[0], 25);
    let (solution, history) = setup.record()?;
    let end = 1.04 * solution.end_s;
    let course = Course::new(&history, (0.0, end), 6000);
    study.csv("fig-3-03.csv", &course.rows())?;
    let early = solution.sub_impacts.get(1).map_or(end, |second| 1.4 * second.end_s).min(end);
    let closer = Course::new(&history, (0.0, early), 2500).force().title("(d) the first contacts, magnified");
    let figure = Figure::new("Fig. 3.3  Hertzian contact, N = 25, b = 0.4 m")
        .row([course.displacements().title("(a) displacements").height(210.0)])
        .row([course.velocities().title("(b) velocities").height(170.0)])
        .row([course.force().title("(c) contact force")])
        .row([closer]);
    let e = solution.restitution.unwrap_or(f64::NAN);
    let caption = format!(
        "There are {} sub-impacts, of which the last one ends after {:.2} ms. The restitution is {e:.3}.",
        solution.sub_impacts.len(),
        1e3 * solution.end_s
    );
    study.figure("fig-3-03", &figure, &caption)?;

    let mut peaks: Vec<f64> = solution.sub_impacts.iter().map(|s| s.peak_force_n).collect();
    peaks.sort_by(f64::total_cmp);
    let (median, largest) = (peaks.get(peaks.len() / 2), peaks.last());
    let few_hundred = |name: &str, peak: Option<&f64>| {
        let peak = peak.copied().unwrap_or(f64::NAN);
        Statement::loose(
            format!("{name} peak of the contact force, N = 25, b = 0.4 (N)"),
            "3.3.2, Fig. 3.3",
            "of the order of a few hundred",
            (550.0, 450.0),
            "from one hundred to ten",
            peak,
        )
    };
    study.state(few_hundred("median", median));
    study.state(
        few_hundred("largest", largest)
            .note("The first contact is the hardest; the wording of the thesis fits the others."),
    );
    study.state(Statement::trend(
        "sub-impacts, N = 25, b = 0.4",
        "3.3.2",
        "several",
        (3.0, f64::INFINITY),
        "more than a couple",
        solution.sub_impacts.len() as f64,
    ));
    // deflection of the longest flight by gravity, relative to the height of the figure of displacements
    let flights = solution.sub_impacts.windows(2).map(|pair| pair[1].start_s - pair[0].end_s);
    let longest_s = flights.fold(0.0, f64::max);
    let bend_mm = 1e3 * GRAVITY / 8.0 * longest_s.powi(2);
    let drawn = || course.structure_mm.iter().chain(&course.striker_mm).copied();
    let height_mm = drawn().fold(f64::NEG_INFINITY, f64::max) - drawn().fold(f64::INFINITY, f64::min);
    let statement = Statement::trend(
        "bend of the longest flight by gravity, over the height of the figure, N = 25, b = 0.4",
        "3.3.2, Fig. 3.3",
        "gravity would merely make the straight line portions very slightly curved",
        (0.0, 0.02),
        "a line's width, a fiftieth of a figure's height; a tenth is more than very slight",
        bend_mm / height_mm,
    );
    study.state(statement.open((0.0, 0.1)).note(format!(
        "The longest flight lasts {:.1} ms. Over the whole interaction gravity would change the ball's velocity, {:.2} \
         m/s at the end, by {:.2} m/s, if the ball falls on the beam. A horizontal flight against an upright beam, \
         which the text mentions next, is not affected.",
        1e3 * longest_s,
        solution.striker_velocity_m_s,
        GRAVITY * solution.end_s
    )));
    // the beam is vertical and the ball moves horizontally: displacement due to gravity
    let travel_mm = 1e3 * 0.5 * GRAVITY * solution.end_s.powi(2);
    study.state(Statement::loose(
        "fall of the ball by its weight in the net time (mm)",
        "3.3.2",
        "about 3",
        (3.0, 0.5),
        "half a unit of the only digit",
        travel_mm,
    ));
    Ok(())
}

/// Figs. 3.12 and A.2: 40 modes, without and with damping.
fn damped_and_undamped(study: &mut Study, case: &Case) -> Result<(), Failure> {
    study.section("Damped and undamped, N = 40 (Figs. 3.12 and A.2)");
    let undamped = case.setup(case.golden_m(), 40);
    let damped = Setup { damping_ratio: case.parameters.damping_ratio, ..undamped };
    let found = study.sweep(&[undamped, damped], 1, Setup::record)?;
    let end = 1.04 * found.iter().map(|(solution, _)| solution.end_s).fold(0.0, f64::max);
    let courses: Vec<Course> = found.iter().map(|(_, history)| Course::new(history, (0.0, end), 5000)).collect();
    for (course, name) in courses.iter().zip(["undamped", "damped"]) {
        study.csv(&format!("fig-3-12-{name}.csv"), &course.rows())?;
    }
    let labels = ["ζ = 0", "ζ = 0.02"];
    let colours = [Colour::Blue, Colour::Vermilion];
    let time = Axis::new("time").unit("ms");
    let panel = |title: &str, y: Axis, value: &dyn Fn(&Course) -> &Vec<f64>, width_px: f64| {
        let mut panel = Panel::new(time.clone(), y).title(title).height(150.0);
        for ((course, label), colour) in courses.iter().zip(labels).zip(colours) {
            let line = Series::line(&course.time_ms, value(course)).line_width(width_px);
            panel = panel.with(line.label(label).colour(colour));
        }
        panel
    };
    let mut displacement = panel(
        "(a) displacement: beam (solid) and ball (dashed)",
        Axis::new("y, z").unit("mm"),
        &|c| &c.structure_mm,
        1.2,
    );
    for (course, colour) in courses.iter().zip(colours) {
        displacement = displacement.with(Series::line(&course.time_ms, &course.striker_mm).colour(colour).dashed());
    }
    let figure = Figure::new("Fig. 3.12  Ball and beam with N = 40 at b = 0.618 m, without and with modal damping")
        .row([displacement])
        .row([panel(
            "(b) velocity of the beam at the contact",
            Axis::new("dy/dt").unit("m/s"),
            &|c| &c.structure_m_s,
            0.6,
        )])
        .row([panel("(c) velocity of the ball", Axis::new("dz/dt").unit("m/s"), &|c| &c.striker_m_s, 1.4)])
        .row([panel("(d) contact force", Axis::new("F").unit("N"), &|c| &c.force_n, 1.0)]);
    let e: Vec<f64> = found.iter().map(|(solution, _)| solution.restitution.unwrap_or(f64::NAN)).collect();
    let caption = format!(
        "The restitution is {:.3} without and {:.3} with damping. The fast vibration of the damped beam decays between \
         sub-impacts. That of the undamped beam continues, and the next contact depends on its phase.",
        e[0], e[1]
    );
    study.figure("fig-3-12", &figure, &caption)?;
    study.state(Statement::trend(
        "difference of the restitutions without and with damping, N = 40, b = 0.618",
        "Fig. 3.12",
        "significantly different",
        (0.1, 1.0),
        "a tenth of the range from 0 to 1",
        (e[0] - e[1]).abs(),
    ));

    let modes = &case.parameters.our_choice.energy_modes;
    let count = if study.quick { 300 } else { 1200 };
    let times: Vec<f64> = (1..=count).map(|i| end * f64::from(i) / f64::from(count)).collect();
    let ms: Vec<f64> = times.iter().map(|t| 1e3 * t).collect();
    let mut panels = Vec::new();
    let mut at_end = Vec::new();
    for ((_, history), title) in found.iter().zip(["(a) ζ = 0", "(b) ζ = 0.02"]) {
        let energies: Vec<Vec<f64>> = times.iter().map(|&t| history.modal_energies_j(t)).collect();
        let axis = Axis::new("energy of the mode").unit("J").log().limits(1e-10, 1e-1);
        let mut panel = Panel::new(time.clone(), axis).title(title).height(300.0);
        for &n in modes {
            let energy: Vec<f64> = energies.iter().map(|e| e.get(n - 1).copied().unwrap_or(f64::NAN)).collect();
            panel = panel.with(Series::line(&ms, &energy).line_width(1.0).label(format!("mode {n}")));
        }
        panels.push(panel);
        at_end.push(energies.last().and_then(|e| e.last().copied()).unwrap_or(f64::NAN));
    }
    study.figure(
        "fig-a-02",
        &Figure::new("Fig. A.2  Energy of single modes, N = 40, b = 0.618 m").row(panels),
        "The energy jumps at each contact. Damping removes the energy of the high modes between contacts.",
    )?;
    study.state(Statement::identity(
        "energy of mode 40 at the end, damped over undamped",
        [
            "A.3",
            "the higher modes damp out more quickly",
            "one damping ratio for all: the rate goes with the frequency",
        ],
        (0.0, 0.01),
        at_end[1] / at_end[0],
    ));
    Ok(())
}
