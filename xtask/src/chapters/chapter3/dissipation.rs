//! Dissipative contact laws: Figs. 3.2, 3.5, 3.6, 3.8 and 3.9.

use super::Case;
use crate::chapters::figures::{Course, slug};
use crate::chapters::impact::Setup;
use crate::chapters::statement::Statement;
use crate::chapters::study::Study;
use contact_models::{Hysteretic, Law, trace};
use serde::Serialize;
use std::f64::consts::PI;
use tasks::Failure;
use vibroimpact::plot::{Axis, Figure, Panel, Series};

pub(super) fn run(study: &mut Study, case: &Case) -> Result<(), Failure> {
    prescribed(study, case)?;
    wall(study, case, "3.5", "viscous", case.viscous()?)?;
    many_modes(study, case, "3.6", "viscous", case.viscous()?)?;
    wall(study, case, "3.8", "hysteretic", case.hysteretic()?)?;
    many_modes(study, case, "3.9", "hysteretic", case.hysteretic()?)
}

/// "About 0.95".
const NEAR_95: (f64, f64) = (0.95, 0.005);
const LAST_DIGIT: &str = "half a unit of the last digit";

#[derive(Serialize)]
struct LoopRow {
    time_s: f64,
    compression_m: f64,
    force_n: f64,
}

/// Fig. 3.2: the hysteretic law under a prescribed motion.
fn prescribed(study: &mut Study, case: &Case) -> Result<(), Failure> {
    study.section("Hysteresis loops under a prescribed motion (Fig. 3.2)");
    let p = &case.parameters.prescribed_loop;
    let law = Hysteretic {
        stiffness_n_m1_5: p.stiffness_n_m1_5.unwrap_or(1.0),
        theta_m: p.theta_m,
        beta: p.beta,
        k_bar: p.k_bar,
        epsilon_m: p.epsilon_m,
    }
    .validated()?;
    let motion = |t: f64| {
        let (slow, fast) = (2.0 * PI * t, 8.0 * PI * t);
        (slow.sin() + 0.5 * fast.sin(), 2.0 * PI * (slow.cos() + 2.0 * fast.cos()))
    };
    let times: Vec<f64> = (0..=2000).map(|i| f64::from(i) / 1000.0).collect();
    let path = trace(&law, &times, motion)?;
    let rows: Vec<LoopRow> =
        path.iter().map(|p| LoopRow { time_s: p.time_s, compression_m: p.compression_m, force_n: p.force_n }).collect();
    study.csv("fig-3-02.csv", &rows)?;

    let [xi, force] =
        [|r: &LoopRow| r.compression_m, |r: &LoopRow| r.force_n].map(|f| rows.iter().map(f).collect::<Vec<_>>());
    let t: Vec<f64> = rows.iter().map(|r| r.time_s).collect();
    let loops = Panel::new(Axis::new("compression ξ"), Axis::new("force F")).with(Series::line(&xi, &force));
    let input = Panel::new(Axis::new("time t"), Axis::new("compression ξ")).with(Series::line(&t, &xi));
    let figure = Figure::new("Fig. 3.2  Hysteretic contact force under a prescribed compression")
        .row([input.title("(a) the motion").height(260.0), loops.title("(b) force against compression").height(260.0)]);
    study.figure(
        "fig-3-02",
        &figure,
        "The compression is ξ = sin 2πt + 0.5 sin 8πt, with k_H = 1, K = 4, θ_m = 1.6, β = 1.4 and ε = 10⁻⁴. Eq. 3.17 \
         is read as the documentation of the contact law explains. The force vanishes only where ξ ≤ 0, and minor \
         loops close inside the large ones.",
    )?;

    let silent = |r: &&LoopRow| r.force_n == 0.0;
    let deepest = rows.iter().filter(silent).map(|r| r.compression_m).fold(f64::NEG_INFINITY, f64::max);
    let reason = "a smaller one gives a force below the smallest number";
    study.state(Statement::identity(
        "largest compression without force, hysteretic law (Fig. 3.2)",
        ["3.2.1", "F = 0 only when ξ ≤ 0", reason],
        (f64::NEG_INFINITY, 1e-200),
        deepest,
    ));
    // only where the compression exceeds rounding
    let pressed = rows.iter().filter(|r| r.compression_m > 1e-6);
    let theta = pressed.map(|r| r.force_n / (p.stiffness_n_m1_5.unwrap_or(1.0) * r.compression_m.powf(1.5)) - 1.0);
    let beyond = theta.map(|theta| (theta - p.theta_m).abs() - p.beta).fold(f64::NEG_INFINITY, f64::max);
    study.state(Statement::identity(
        "largest distance of θ from the range θ_m ± β, hysteretic law (Fig. 3.2)",
        ["3.2.1", "θ varies between θ_m ± β", "rounding"],
        (f64::NEG_INFINITY, 1e-9),
        beyond,
    ));
    Ok(())
}

/// Figs. 3.5 and 3.8: the beam held still, three speeds.
fn wall(study: &mut Study, case: &Case, figure: &str, name: &str, law: Law) -> Result<(), Failure> {
    study.section(&format!("The {name} law against an immovable beam (Fig. {figure})"));
    let setups: Vec<Setup> = case
        .parameters
        .wall_speeds_m_s
        .iter()
        .map(|&speed_m_s| Setup { law, speed_m_s, ..case.setup(case.golden_m(), 0) })
        .collect();
    let found = study.sweep(&setups, 1, |setup| {
        let (solution, history) = setup.record()?;
        Ok((setup.solve()?, Course::new(&history, (0.0, solution.end_s), 400)))
    })?;
    let mut panel = Panel::new(Axis::new("compression ξ").unit("µm"), Axis::new("force F").unit("N")).height(260.0);
    for (row, course) in &found {
        let microns: Vec<f64> = course.compression_m.iter().map(|xi| 1e6 * xi).collect();
        panel = panel.with(Series::line(&microns, &course.force_n).label(format!(
            "{} m/s: e = {:.4}",
            row.speed_m_s,
            row.e()
        )));
    }
    let rows: Vec<_> = found.into_iter().map(|(row, _)| row).collect();
    study.csv(&format!("fig-{}.csv", slug(figure)), &rows)?;
    let title = format!("Fig. {figure}  Force against compression, N = 0, {name} law");
    study.figure(
        &format!("fig-{}", slug(figure)),
        &Figure::new(title).row([panel]).width(520.0),
        "Loading follows the upper branch and unloading the lower one. The area between them is the dissipated energy.",
    )?;

    let at_one = Setup { law, ..case.setup(case.golden_m(), 0) }.solve()?;
    study.state(Statement::loose(
        format!("restitution of the {name} law at 1 m/s, N = 0"),
        &format!("3.3, Fig. {figure}"),
        "about 0.95",
        NEAR_95,
        LAST_DIGIT,
        at_one.e(),
    ));
    let contacts = rows.iter().map(|r| r.sub_impacts).max().unwrap_or(0);
    study.state(Statement::identity(
        format!("contacts of the {name} law, N = 0"),
        [
            &format!("Fig. {figure}"),
            "a single contact in each case",
            "nothing brings the ball back to an immovable beam",
        ],
        (1.0, 1.0),
        contacts as f64,
    ));
    if let (true, [fast, .., slow]) = (name == "hysteretic", rows.as_slice()) {
        for row in &rows {
            study.state(Statement::loose(
                format!("restitution of the hysteretic law at {} m/s, N = 0", row.speed_m_s),
                "Fig. 3.8",
                "close to 0.95",
                NEAR_95,
                LAST_DIGIT,
                row.e(),
            ));
        }
        study.state(Statement::trend(
            "fall of the hysteretic law's restitution from 0.6 to 1.2 m/s",
            "Fig. 3.8",
            "decreasing very slightly",
            (1e-6, 0.005),
            "beyond the solver's error, and too little for the last digit of 0.95",
            slow.e() - fast.e(),
        ));
    }
    Ok(())
}

/// Figs. 3.6 and 3.9: 27 modes, force against time and against compression.
fn many_modes(study: &mut Study, case: &Case, figure: &str, name: &str, law: Law) -> Result<(), Failure> {
    study.section(&format!("The {name} law with 27 modes (Fig. {figure})"));
    let setup = Setup { law, ..case.setup(case.parameters.locations_m[0], 27) };
    let (solution, history) = setup.record()?;
    let course = Course::new(&history, (0.0, solution.end_s), 6000);
    study.csv(&format!("fig-{}.csv", slug(figure)), &course.rows())?;
    let whole = course.force().height(240.0).title("(a) force against time");
    let loops = course.loops().height(240.0).title("(b) force against compression");
    let title = format!("Fig. {figure}  Impact with 27 modes at b = 0.4 m, {name} law");
    let caption = format!(
        "{} sub-impacts; restitution {:.3}.",
        solution.sub_impacts.len(),
        solution.restitution.unwrap_or(f64::NAN)
    );
    study.figure(&format!("fig-{}", slug(figure)), &Figure::new(title).row([whole, loops]), &caption)?;

    let several = solution.sub_impacts.len() as f64;
    study.state(Statement::trend(
        format!("sub-impacts with the {name} law, N = 27, b = 0.4"),
        &format!("Fig. {figure}"),
        "multiple",
        (2.0, f64::INFINITY),
        "more than one",
        several,
    ));
    if let Law::Viscous(viscous) = law {
        let rates = course.structure_m_s.iter().zip(&course.striker_m_s).zip(&course.force_n);
        let in_contact = rates.filter(|(_, force)| **force > 0.0).map(|((beam, ball), _)| (beam - ball).abs());
        let largest = viscous.damping_s_m * in_contact.fold(0.0, f64::max);
        study.state(Statement::identity(
            "largest |c dξ/dt| in contact, N = 27",
            ["3.2.1", "below 1 at all times", "as stated; it would take twelve times the speed of approach"],
            (0.0, 1.0),
            largest,
        ));
    }
    Ok(())
}
