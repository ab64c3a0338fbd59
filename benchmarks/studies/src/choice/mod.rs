//! Test of the automatic choice of the model: random scenes compared with a much more accurate reference.

mod net;
mod report;
mod row;
mod scenes;

use row::Row;
use std::path::PathBuf;
use tasks::{Failure, Journal, Study, targets};

/// Number of scenes of a full and of a quick run.
const SCENES: [u64; 2] = [1000, 16];
/// Number of scenes that are solved in parallel before their rows are written.
const BATCH: usize = 32;
/// The rows so far, those of a scene on one line.
const ROWS: &str = "rows.jsonl";

const INTRODUCTION: &str = "This report tests the automatic choice of the model on random scenes. Structures are \
beams by both theories of bending, strings, plates, lists of modes, and beams that move before the impact or run into \
a stop, with every pair of ends and locations near supports and tips. Strikers have from a millionth to three times \
the mass of the structure and speeds from 0.05 to 5 m/s. The scenes have every law of contact and damping ratios of \
zero or from 0.001 to 0.1. Each scene is answered at tolerances from 1e-2 to 1e-6. The reference has at least twice \
the modes of the finest answer (for a list: the beam that it was taken from), remainder modes for all others, and a \
tolerance of 1e-10, or of 1e-12 after several contacts. Its own error is the larger of its change from fewer modes \
and of the solver's uncertainty. If that error is more than a third of the tolerance, the scene is listed but not \
counted.";

/// Options of the study of the choice.
#[derive(clap::Args)]
pub struct Wanted {
    /// Fewer scenes through the same code
    #[arg(long)]
    quick: bool,
    /// Number of the first scene; another number selects another sample
    #[arg(long, value_name = "NUMBER", default_value_t = 0)]
    first: u64,
    /// Number of scenes [default: 1000, or 16 with --quick]
    #[arg(long, value_name = "COUNT")]
    scenes: Option<u64>,
    /// Resume from the rows that an earlier run of the same scenes has written
    #[arg(long)]
    resume: bool,
    /// The folder to write to
    #[arg(long, value_name = "DIR", default_value = "out/study-auto")]
    out: PathBuf,
}

/// Runs the study, writes its folder, and returns its summary.
///
/// # Errors
/// If a scene cannot be drawn, or a file cannot be read or written.
pub fn run(wanted: &Wanted) -> Result<String, Failure> {
    let mut study = Study::new(&wanted.out, wanted.quick)?;
    study.section("Random scenes");
    let rows = rows(&mut study, wanted)?;
    study.csv("scenes.csv", &rows)?;
    report::write(&mut study, &rows)?;
    net::run(&mut study)?;
    Ok(study.finish("The automatic choice of the model", INTRODUCTION, targets)?.summary)
}

/// Computes the rows of all scenes. Every batch is written, so that an interrupted run can be resumed.
fn rows(study: &mut Study, wanted: &Wanted) -> Result<Vec<Row>, Failure> {
    let count = wanted.scenes.unwrap_or(SCENES[usize::from(wanted.quick)]);
    let numbers: Vec<u64> = (0..count).map(|i| wanted.first.saturating_add(i)).collect();
    let mut journal: Journal<Vec<Row>> = Journal::open(&wanted.out.join(ROWS), wanted.resume)?;
    let is_of = |rows: &[Row], number: u64| rows.iter().any(|row| row.scene == number);
    let missing: Vec<u64> =
        numbers.iter().copied().filter(|&number| !journal.rows().iter().any(|rows| is_of(rows, number))).collect();
    let quick = study.quick;
    let impacts = row::TOLERANCES.len();
    let of_scene = |&number: &u64| Row::of_scene(number, quick);
    study.sweep_in_batches(&missing, (BATCH, impacts), of_scene, |rows| journal.extend(rows))?;
    let mut rows: Vec<Row> = journal.into_rows().into_iter().flatten().collect();
    rows.retain(|row| numbers.contains(&row.scene));
    rows.sort_by_key(|row| row.scene);
    Ok(rows)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn the_choice_of_the_model_keeps_its_word_on_random_scenes() {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().to_path_buf();
        run(&Wanted { quick: true, first: 0, scenes: None, resume: false, out }).unwrap();
        let report = fs::read_to_string(folder.path().join("report.md")).unwrap();
        let headings = ["but are beyond the tolerance:", "Answers beyond the stated uncertainty:", "Not converged:"];
        for pair in headings.windows(2) {
            let (_, after) = report.split_once(pair[0]).unwrap();
            let (section, _) = after.split_once(pair[1]).unwrap();
            // rows begin with the number of a scene
            let is_row =
                |line: &&str| line.strip_prefix("| ").is_some_and(|row| row.starts_with(|c: char| c.is_ascii_digit()));
            let rows: Vec<&str> = section.lines().filter(is_row).collect();
            assert!(rows.is_empty(), "{}{rows:?}", pair[0]);
        }
    }
}
