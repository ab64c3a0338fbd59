//! The library at a small scale: references are reproduced, every solver gives valid rows, the page is complete.

use std::time::{Duration, Instant};
use vibroimpact_sim::modal::{Settings, Solver};
use work_precision::measure::{Effort, Origin, Row};
use work_precision::{figures, impact, report, run, table};

fn errors<'a>(rows: &'a [Row], solver: &'a str, norm: &'a str) -> Vec<(f64, f64)> {
    let rows = rows.iter().filter(|row| row.solver == solver && row.norm == norm);
    rows.filter_map(|row| Some((row.setting, row.error?))).collect()
}

#[test]
fn the_workspaces_solver_agrees_with_quadruple_precision() {
    for impact in impact::library().unwrap() {
        let reference = impact::reference(impact.name).unwrap();
        assert!(reference.restitution_error < 1e-12, "{}: {:e}", impact.name, reference.restitution_error);
        let settings = Settings { tolerance: 1e-12, estimate_uncertainty: false, ..Settings::default() };
        let solver = Solver::new(&impact.structure).unwrap();
        let solution = solver.solve(&impact.striker, &impact.law, None, &settings).unwrap();
        let error = (solution.restitution.unwrap() - reference.outcome.restitution).abs();
        // Without damping, rounding alone is amplified to 1e-6.
        let floor = if impact.name == "pinned-undamped" { 1e-5 } else { 1e-9 };
        assert!(error < floor, "{}: {error:e}", impact.name);
        assert_eq!(solution.sub_impacts.len(), reference.outcome.impulses_n_s.len(), "{}", impact.name);
    }
}

#[test]
fn every_law_is_exported_in_numbers_that_are_read_back() {
    let folder = tempfile::tempdir().unwrap();
    let library = impact::library().unwrap();
    work_precision::export::write(&library, folder.path()).unwrap();
    for impact in &library {
        let text = std::fs::read_to_string(folder.path().join(format!("impact-{}.txt", impact.name))).unwrap();
        let modes: Vec<f64> =
            text.lines().skip(5).flat_map(str::split_whitespace).map(|x| x.parse().unwrap()).collect();
        let wanted = impact.structure.modes.iter().flat_map(|m| [m.omega_rad_s, m.damping_ratio, m.shape]);
        assert_eq!(modes, wanted.collect::<Vec<f64>>());
        assert!(text.contains(&format!("mass_kg {:e}", impact.striker.mass_kg)));
    }
}

#[test]
fn a_quick_run_on_an_impact_gives_valid_rows_and_a_page() {
    let effort = Effort { cap: Duration::from_millis(200), ..Effort::QUICK };
    let start = Instant::now();
    let rows = run(Some("pinned-hertz"), &effort, |_| ()).unwrap();
    println!("{:?}", start.elapsed());
    assert!(rows.iter().all(|row| row.problem == "pinned-hertz"));
    // Our solver meets the requested tolerance, here with an amplification of errors of about 30.
    for (tolerance, error) in errors(&rows, "vibroimpact", "restitution") {
        assert!(error < 30.0 * tolerance.max(1e-12), "{tolerance:e}: {error:e}");
    }
    let cold = errors(&rows, "vibroimpact", "restitution");
    assert_eq!(cold, errors(&rows, "vibroimpact, tables kept", "restitution"));
    // The general solver converges to the same number
    let peer = errors(&rows, "DOP853 + exact flight", "restitution");
    let (first, last) = (peer.first().unwrap().1, peer.last().unwrap().1);
    assert!(last < 1e-6 && last < 1e-2 * first, "{peer:?}");
    // and finds the same contacts.
    let times = errors(&rows, "DOP853 + exact flight", "contact times");
    assert!(times.last().unwrap().1 < 1e-6, "{times:?}");
    for row in &rows {
        let complete = row.error.is_some() && row.time_s.is_some() && row.cost.is_some() && !row.norm.is_empty();
        assert_eq!(complete, row.status == "ok", "{row:?}");
    }
    // Slow solvers are shown.
    assert!(rows.iter().any(|row| row.origin == Origin::Peer && row.solver.starts_with("diffsol")));

    let text = table(&rows).unwrap();
    assert!(text.starts_with("problem,solver,origin,setting,norm,error,time_s,cost,cost_unit,status\n"));
    let back: Vec<Row> = csv::Reader::from_reader(text.as_bytes()).deserialize().map(Result::unwrap).collect();
    assert_eq!(back, rows);

    let page = report::report(&rows, "here and now", None).unwrap();
    let markdown = page.report.markdown();
    assert!(markdown.contains("| pinned-hertz |") && markdown.contains("figures/work-precision-pinned-hertz.svg"));
    let names: Vec<&str> = page.figures.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, ["figures/speed-and-error.svg", "figures/work-precision-pinned-hertz.svg"]);
}

/// The figure of the README shows the table of the book. `VIBROIMPACT_BLESS=1` draws it anew.
#[test]
fn the_overview_shows_the_table() {
    let docs = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs");
    let table = csv::Reader::from_path(docs.join("work-precision.csv")).unwrap().into_deserialize();
    let drawn = figures::overview(&table.map(Result::unwrap).collect::<Vec<Row>>()).svg().unwrap();
    let file = docs.join("figures/speed-and-error.svg");
    if std::env::var_os("VIBROIMPACT_BLESS").is_some() {
        std::fs::write(&file, &drawn).unwrap();
    }
    assert_eq!(std::fs::read_to_string(file).unwrap(), drawn);
}

#[test]
fn a_quick_run_on_the_rest_gives_valid_rows() {
    for only in ["beam-S15", "stepped-modes", "emoc", "fractional-abel"] {
        let rows = run(Some(only), &Effort::QUICK, |_| ()).unwrap();
        let own = rows.iter().filter(|row| row.origin == Origin::Own && row.solver != "semi-analytical");
        let best = own.filter_map(|row| row.error).fold(f64::INFINITY, f64::min);
        assert!(best < 1e-12, "{only}: {best:e}");
        assert!(rows.iter().any(|row| row.origin == Origin::Peer && row.error.is_some_and(|e| e > best)), "{only}");
    }
}
