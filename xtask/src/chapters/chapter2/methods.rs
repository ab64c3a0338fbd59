//! Cost against accuracy of every method of `fracdiff` and of the specialised solver, for the problem of the chapter.

use crate::chapters::statement::Statement;
use crate::chapters::study::Study;
use fracdiff::{Collocation, Convolution, GalerkinStates, Method, SumOfExponentials, test_problems};
use serde::Serialize;
use std::time::Instant;
use tasks::Failure;
use vibroimpact::plot::{Axis, Colour, Figure, Marker, Panel, Series};
use vibroimpact_sim::infinite::{Settings, Solution, Structure, solve};

/// `S` and the final time of two impacts: one contact with a rebound, and four separations before sustained contact.
const PROBLEMS: [(f64, f64); 2] = [(1.0, 5.0), (15.0, 120.0)];
/// Times at which solutions are compared.
const TIMES: usize = 400;
/// Number of timings of each run, of which the shortest is reported.
const REPEATS: usize = 2;
const SPECIALISED: &str = "specialised";

/// One run; `evaluations` of the force are not counted by the specialised solver.
#[derive(Serialize)]
struct Row {
    s: f64,
    method: &'static str,
    setting: f64,
    evaluations: Option<u64>,
    error: f64,
}

/// What the clock said.
#[derive(Serialize)]
struct TimingRow {
    s: f64,
    method: &'static str,
    setting: f64,
    error: f64,
    time_s: f64,
}

/// A method and its resolution parameter.
fn methods(quick: bool) -> Vec<(f64, Method)> {
    let steps: &[usize] = if quick { &[250, 1000] } else { &[125, 250, 500, 1000, 2000, 4000, 8000] };
    let digits: &[i32] = if quick { &[5, 9] } else { &[3, 5, 7, 9, 11, 13] };
    let mut methods = Vec::new();
    for &steps in steps {
        let n = steps as f64;
        methods.push((n, Method::GrunwaldLetnikov(Convolution { steps })));
        methods.push((n, Method::L1(Convolution { steps })));
        methods.push((n, Method::Trapezoidal(Convolution { steps })));
        methods.push((n, Method::SumOfExponentials(SumOfExponentials { steps, ..Default::default() })));
        methods.push((n, Method::GalerkinStates(GalerkinStates { steps, ..Default::default() })));
    }
    for &digits in digits {
        let tolerance = 10f64.powi(-digits);
        methods.push((tolerance, Method::Collocation(Collocation { tolerance, ..Default::default() })));
    }
    methods
}

/// The shortest time of a few runs, and the result.
fn timed<R>(run: impl Fn() -> Result<R, Failure>) -> Result<(f64, R), Failure> {
    let mut shortest = f64::INFINITY;
    let mut result = None;
    for _ in 0..REPEATS {
        let start = Instant::now();
        result = Some(run()?);
        shortest = shortest.min(start.elapsed().as_secs_f64());
    }
    Ok((shortest, result.ok_or("no run")?))
}

pub(super) fn run(study: &mut Study) -> Result<(), Failure> {
    study.section("Accuracy against cost");
    let (mut rows, mut timings) = (Vec::new(), Vec::new());
    for (s, end) in PROBLEMS {
        let with = |nodes: usize, tolerance: f64| -> Result<Solution, Failure> {
            let settings =
                Settings { nodes, tolerance, horizon: end, estimate_uncertainty: false, ..Settings::default() };
            Ok(solve(Structure::Beam, s, &settings)?)
        };
        let reference = with(28, 1e-13)?;
        let times: Vec<f64> = (1..=TIMES).map(|i| end * i as f64 / TIMES as f64).collect();
        let exact: Vec<f64> = times.iter().map(|&t| compression(&reference, t)).collect();
        let largest = exact.iter().fold(0.0_f64, |largest, x| largest.max(x.abs()));
        let error = |value: &dyn Fn(f64) -> f64| {
            let worst = times.iter().zip(&exact).map(|(&t, x)| (value(t) - x).abs());
            worst.fold(0.0_f64, |worst, error| if error.is_nan() { error } else { worst.max(error) }) / largest
        };
        for (setting, method) in methods(study.quick) {
            let problem = test_problems::ball_on_beam(s);
            let (time_s, solution) = timed(|| Ok(problem.solve(&method, end)?))?;
            let error = error(&|t| solution.at(t).ok().and_then(|x| x.first().copied()).unwrap_or(f64::NAN));
            let method = method.name();
            rows.push(Row { s, method, setting, evaluations: Some(solution.counts.evaluations), error });
            timings.push(TimingRow { s, method, setting, error, time_s });
        }
        let settings = [(8, 1e-3), (10, 1e-4), (12, 1e-6), (14, 1e-8), (16, 1e-9), (20, 1e-10), (24, 1e-12)];
        for (nodes, tolerance) in settings {
            let (time_s, solution) = timed(|| with(nodes, tolerance))?;
            let error = error(&|t| compression(&solution, t));
            rows.push(Row { s, method: SPECIALISED, setting: tolerance, evaluations: None, error });
            timings.push(TimingRow { s, method: SPECIALISED, setting: tolerance, error, time_s });
        }
    }
    study.csv("methods.csv", &rows)?;
    study.csv("timings-methods.csv", &timings)?;

    let names: Vec<&str> = methods(true).iter().map(|(_, method)| method.name()).fold(Vec::new(), |mut names, name| {
        if !names.contains(&name) {
            names.push(name);
        }
        names
    });
    let mut figures = Vec::new();
    for (title, axis) in [
        ("Error against evaluations of the force", Axis::new("evaluations").log()),
        ("Error against time", Axis::new("time").unit("s").log()),
    ] {
        let by_time = axis.unit == "s";
        let panels = PROBLEMS.map(|(s, end)| {
            let mut panel =
                Panel::new(axis.clone(), Axis::new("largest error / largest |x|").log().limits(1e-15, 10.0))
                    .title(format!("S = {s}, to t = {end} T"))
                    .height(300.0);
            for (k, &name) in names.iter().chain(&[SPECIALISED]).enumerate() {
                let points = |row: &TimingRow| row.s == s && row.method == name;
                let chosen = timings.iter().zip(&rows).filter(|(timing, _)| points(timing));
                let (x, y): (Vec<f64>, Vec<f64>) = chosen
                    .filter_map(|(timing, row)| {
                        let cost = if by_time { Some(timing.time_s) } else { row.evaluations.map(|n| n as f64) };
                        // an error of exactly zero is drawn at the lower edge
                        cost.map(|cost| (cost, row.error.max(1e-15)))
                    })
                    .unzip();
                let colour = if name == SPECIALISED { Colour::Black } else { Colour::of_series(k) };
                let width = if name == SPECIALISED { 2.2 } else { 1.2 };
                if !x.is_empty() {
                    let line = Series::line_points(&x, &y, Marker::Dot).colour(colour).line_width(width);
                    panel = panel.with(line.label(name));
                }
            }
            panel
        });
        figures.push(Figure::new(title).row(panels));
    }
    study.figure(
        "methods",
        &figures[0],
        "Each point is one setting. The Galerkin states with N = 50, as in the thesis, have the error of their kernel \
         however short the steps are. The specialised solver does not count evaluations; `timings-methods.svg` \
         includes it and shows the error against the time.",
    )?;
    study.aside("timings-methods.svg", &figures[1])?;
    for (s, _) in PROBLEMS {
        let best = |name: &str| {
            let errors = rows.iter().filter(|row| row.s == s && row.method == name).map(|row| row.error);
            errors.fold(f64::INFINITY, f64::min)
        };
        study.state(Statement::self_check(
            format!("S = {s}: difference of general collocation and specialised solver, over the largest |x|"),
            ["A.1", "convergence was checked", "two methods of ours, each exact to ten digits"],
            (0.0, 1e-8),
            best("collocation"),
        ));
        study.state(Statement::trend(
            format!("S = {s}: error of the thesis's recipe with its N = 50, over the largest |x|"),
            "A.1",
            "significantly more accurate than plotting accuracy",
            (0.0, 2e-3),
            "a tenth of a line's width",
            best("Galerkin states"),
        ));
    }
    Ok(())
}

fn compression(solution: &Solution, t: f64) -> f64 {
    solution.at(t).map_or(f64::NAN, |state| state.compression)
}
