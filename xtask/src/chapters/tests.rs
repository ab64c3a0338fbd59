use super::figures::slug;
use super::statement::{Statement, Verdict};
use super::*;
use std::collections::BTreeMap;
use std::fs;
use std::path::PathBuf;
use std::sync::LazyLock;

/// Every file under a folder but those of timings, by its path there, with its bytes.
fn contents(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut found = BTreeMap::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = PathBuf::from(path.file_name().unwrap());
        if path.is_dir() {
            found.extend(contents(&path).into_iter().map(|(inner, bytes)| (name.join(inner), bytes)));
        } else if !name.to_string_lossy().starts_with("timings") {
            found.insert(name, fs::read(&path).unwrap());
        }
    }
    found
}

/// The whole thesis in its quick form, reproduced on several threads.
static THESIS: LazyLock<BTreeMap<PathBuf, Vec<u8>>> = LazyLock::new(|| {
    let folder = tempfile::tempdir().unwrap();
    on_threads(3, || run_all(folder.path(), true, None).map(drop)).unwrap();
    contents(folder.path())
});

fn on_threads<T: Send>(count: usize, work: impl FnOnce() -> T + Send) -> T {
    rayon::ThreadPoolBuilder::new().num_threads(count).build().unwrap().install(work)
}

/// Every statement can be contradicted by some number.
fn every_statement_that_counts_can_be_turned(statements: &[Statement]) {
    assert!(!statements.is_empty());
    for statement in statements {
        // what the text does not say would decide nothing either way; the number beside it must all the same
        let with = |ours: f64| {
            let mut other = statement.clone();
            other.ours = ours;
            other.missing.clear();
            other.verdict()
        };
        assert!([-1e12, 1e12].into_iter().any(|ours| with(ours) == Verdict::Differs), "{statement:?}");
        assert_eq!(with(f64::NAN), Verdict::Differs, "{statement:?}");
        assert!(!statement.reason.is_empty() && statement.ours.is_finite(), "{statement:?}");
    }
}

/// Runs a part on one thread, and checks its statements and files. Returns the statements.
fn check_chapter(part: Part, figures: &[&str], tables: &[&str]) -> Vec<Statement> {
    let folder = tempfile::tempdir().unwrap();
    let finished = on_threads(1, || run(part, folder.path(), true, None)).unwrap();
    every_statement_that_counts_can_be_turned(&finished.study.stated);
    let summary = finished.study.summary;
    assert!(summary.contains("agree") && summary.contains("impacts in"), "{summary}");
    let files = contents(folder.path());
    let text = |name: &str| String::from_utf8(files[Path::new(name)].clone()).unwrap();
    let manifest = text("manifest.json");
    for name in figures {
        let svg = text(&format!("figures/{name}.svg"));
        assert!(svg.contains("</svg>") && !svg.contains("no data"), "{name}");
        assert!(manifest.contains(&format!("figures/{name}.svg")));
    }
    for name in tables {
        assert!(text(name).lines().count() > 2 && manifest.contains(name), "{name}");
    }
    let html = text("report.html");
    assert_eq!(html.matches("<svg").count(), files.keys().filter(|path| path.starts_with("figures")).count());
    assert!(html.contains("✓ agrees"));

    let on_other_threads =
        THESIS.iter().filter_map(|(path, bytes)| Some((path.strip_prefix(part.folder()).ok()?, bytes)));
    assert!(files.iter().map(|(path, bytes)| (path.as_path(), bytes)).eq(on_other_threads), "{}", part.folder());
    finished.study.stated
}

#[test]
fn a_second_run_over_the_files_of_the_first_gives_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let files = || {
        run(Part::Chapter(6), folder.path(), true, None).unwrap();
        contents(folder.path())
    };
    assert_eq!(files(), files());
}

#[test]
fn chapter_2_is_complete_and_the_same_on_any_number_of_threads() {
    let figures = [
        "fig-2-03",
        "fig-2-04",
        "fig-2-05",
        "fig-2-06",
        "fig-2-07",
        "fig-2-08",
        "fig-a-01",
        "asymptotic-errors",
        "methods",
        "semi-analytical-errors",
    ];
    let tables =
        ["fig-2-03-s-1.5e1.csv", "fig-2-06b.csv", "fig-2-08.csv", "fig-a-01.csv", "turning-points.csv", "methods.csv"];
    check_chapter(Part::Chapter(2), &figures, &tables);
}

#[test]
fn chapter_3_is_complete_and_the_same_on_any_number_of_threads() {
    let figures = [
        "fig-3-02",
        "fig-3-03",
        "fig-3-04",
        "fig-3-05",
        "fig-3-06",
        "fig-3-07",
        "fig-3-08",
        "fig-3-09",
        "fig-3-10",
        "fig-3-11",
        "fig-3-12",
        "fig-3-13",
        "fig-3-14",
        "fig-3-15",
        "fig-a-02",
        "residual-compliance-damped",
        "residual-compliance-undamped",
    ];
    check_chapter(Part::Chapter(3), &figures, &["fig-3-04.csv", "fig-3-15.csv", "residual-compliance-damped.csv"]);
}

#[test]
fn chapter_4_is_complete_and_the_same_on_any_number_of_threads() {
    let figures = [
        "fig-4-03", "fig-4-04", "fig-4-05", "fig-4-06", "fig-4-07", "fig-4-08", "fig-4-09", "fig-4-10", "fig-4-11",
        "fig-a-03", "settled",
    ];
    let tables = [
        "restitution-pinned-pinned.csv",
        "restitution-cantilever.csv",
        "restitution-stepped-cantilever.csv",
        "restitution-stepped-clamped-pinned.csv",
        "settled-cantilever.csv",
    ];
    check_chapter(Part::Chapter(4), &figures, &tables);
}

#[test]
fn the_ensemble_is_complete_and_the_same_on_any_number_of_threads() {
    let figures = ["choices-stepped-cantilever", "choices-stepped-clamped-pinned"];
    check_chapter(Part::Ensemble, &figures, &["trends.csv", "speeds.csv"]);
}

#[test]
fn the_theories_are_complete_and_find_what_others_found() {
    let figures = ["phase-speeds", "modes-0-4", "modes-golden", "predictable", "by-mass", "maps"];
    let tables = ["phase-speeds-printed.csv", "limits.csv", "coefficients.csv", "predictable-by-contacts.csv"];
    let tables = [&tables[..], &["tables.csv", "law.csv", "law-compared.csv"]].concat();
    // a quick run computes the limits and the errors of the phase speeds in the same way
    let statements = check_chapter(Part::Theories, &figures, &tables);
    assert!(statements.len() >= 8 && statements.iter().all(|one| one.verdict() == Verdict::Agrees), "{statements:?}");
}

#[test]
fn five_lists_of_twelve_balls_hold_the_masses_that_chapter_4_names() {
    let case = chapter4::Case::load().unwrap();
    let lists = case.parameters.our_choice.ensemble.ball_lists();
    assert_eq!(lists.iter().map(|list| list[0]).collect::<Vec<_>>(), [9, 13, 17, 21, 25]);
    assert!(lists.iter().all(|list| list.len() == 12 && list.windows(2).all(|pair| pair[1] - pair[0] == 4)));
}

#[test]
fn chapter_5_is_complete_and_the_same_on_any_number_of_threads() {
    check_chapter(Part::Chapter(5), &["laws", "fig-5-01"], &["laws.csv", "predictions.csv", "fig-5-01.csv"]);
}

#[test]
fn chapter_6_is_complete_and_the_same_on_any_number_of_threads() {
    check_chapter(Part::Chapter(6), &["agreement", "energy", "closed-form"], &["agreement.csv"]);
}

#[test]
fn chapter_7_is_complete_and_the_same_on_any_number_of_threads() {
    let figures = [
        "fig-7-03",
        "fig-7-04",
        "fig-7-05",
        "fig-7-06",
        "fig-7-07",
        "where-it-fails",
        "attached-modes-cantilever",
        "attached-modes-pinned-pinned",
    ];
    check_chapter(
        Part::Chapter(7),
        &figures,
        &["fits.csv", "fig-7-03.csv", "fig-7-07.csv", "laws.csv", "attached-modes.csv"],
    );
}

#[test]
fn chapter_8_is_complete_and_the_same_on_any_number_of_threads() {
    check_chapter(Part::Chapter(8), &["drops", "fig-8-02", "fig-8-03"], &["drops.csv", "upright.csv", "fig-8-02.csv"]);
}

#[test]
fn chapter_8_fits_a_persons_points_and_refuses_bad_ones() {
    let folder = tempfile::tempdir().unwrap();
    let (points, out) = (folder.path().join("points.csv"), folder.path().join("out"));
    let header = "rod,restitution,angle_deg,length_m\n";
    fs::write(&points, format!("{header}a,0.7,10,0.6\na,0.6,50,0.6\nb,0.9,85,0.3\nb,0.7,0,0.3\n")).unwrap();
    run(Part::Chapter(8), &out, true, Some(&points)).unwrap();
    let table = fs::read_to_string(out.join("measured.csv")).unwrap();
    assert_eq!(table.lines().count(), 5);
    assert!(fs::read_to_string(out.join("figures/measured.svg")).unwrap().contains("300 mm"));

    let refused = folder.path().join("refused");
    for (text, part) in [
        ("length_m,angle_deg\n0.6,10\n".to_string(), "missing field `restitution`"),
        (format!("{header}a,high,10,0.6\n"), "line: 2"),
        (format!("{header}a,NaN,10,0.6\n"), "restitution = NaN is not allowed"),
        (format!("{header}a,0.5,95,0.6\n"), "angle_deg = 95 is not allowed"),
        (format!("{header}a,0.5,15,0\n"), "length_m = 0 is not allowed"),
        (header.to_string(), "0 points are not allowed"),
    ] {
        fs::write(&points, text).unwrap();
        let message = run(Part::Chapter(8), &refused, true, Some(&points)).unwrap_err().to_string();
        assert!(message.contains(part), "{part}: {message}");
        assert!(!refused.exists());
    }
    assert!(run(Part::Chapter(7), &refused, true, Some(&points)).unwrap_err().to_string().contains("--data"));
}

/// The points belong to one of the last chapters, but their file is read first.
#[test]
fn all_chapters_wait_for_a_readable_file() {
    let folder = tempfile::tempdir().unwrap();
    let (points, out) = (folder.path().join("points.csv"), folder.path().join("out"));
    let message = run_all(&out, true, Some(&points)).unwrap_err().to_string();
    assert!(message.starts_with("cannot read ") && message.contains("points.csv"), "{message}");
    assert!(!out.exists());
}

#[test]
fn other_chapters_and_unwritable_folders_are_errors() {
    let folder = tempfile::tempdir().unwrap();
    assert!("9".parse::<Part>().unwrap_err().to_string().contains("2, 3, 4, 5, 6, 7, 8, ensemble, theories, all"));
    assert!(run(Part::Chapter(9), folder.path(), true, None).is_err());
    assert!(
        Part::ALL.iter().all(|part| part.folder().trim_start_matches("chapter-").parse::<Part>().unwrap() == *part)
    );
    let file = folder.path().join("file");
    fs::write(&file, "").unwrap();
    let below = file.join("below");
    let message = run(Part::Chapter(3), &below, true, None).unwrap_err().to_string();
    assert!(message.contains(&below.display().to_string()), "{message}");
}

#[test]
fn file_names_sort_like_figures() {
    assert_eq!((slug("3.5"), slug("3.15"), slug("A.2")), ("3-05".into(), "3-15".into(), "a-02".into()));
}
