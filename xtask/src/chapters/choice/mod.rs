//! Test of the automatic choice of the model: random scenes compared with a much more accurate reference.

mod net;
mod report;
mod row;
mod scenes;

use row::Row;
use std::fs::OpenOptions;
use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use tasks::{Failure, Study};

/// Number of scenes of a full and of a quick run.
const SCENES: [u64; 2] = [1000, 16];
/// Number of scenes that are solved in parallel before their rows are written.
const BATCH: usize = 32;
/// The rows so far, one per line.
const ROWS: &str = "rows.jsonl";

const INTRODUCTION: &str = "The automatic choice of the model, put to the test on random scenes: beams by both theories \
of bending, strings, plates, lists of modes, beams that move before the impact or run into a stop; every pair of ends, \
places near supports and tips; strikers from a millionth to three times the mass of the structure, 0.05 to 5 m/s, every \
law of contact, damping ratios from 0.001 to 0.1 and none; each at tolerances from 1e-2 to 1e-6. The reference has twice \
the modes of the finest answer or more, of a list the beam that it was taken from, remainder modes for all others and \
a tolerance of 1e-10; the same with fewer modes tells how well it is known itself. Where it is not known three times \
better than the tolerance, the scene is listed and not counted.";

/// Options of the study of the choice.
#[derive(clap::Args)]
pub struct RandomScenes {
    /// Fewer scenes through the same code
    #[arg(long)]
    pub quick: bool,
    /// Number of the first scene; another number selects another sample
    #[arg(long, value_name = "NUMBER", default_value_t = 0)]
    pub first: u64,
    /// Number of scenes [default: 1000, or 16 with --quick]
    #[arg(long, value_name = "COUNT")]
    pub scenes: Option<u64>,
    /// Resume from the rows that an earlier run of the same scenes has written
    #[arg(long)]
    pub resume: bool,
    /// The folder to write to
    #[arg(long, value_name = "DIR", default_value = "out/study-auto")]
    pub out: PathBuf,
}

pub fn run(study: &mut Study, wanted: &RandomScenes) -> Result<&'static str, Failure> {
    study.section("Random scenes");
    let count = wanted.scenes.unwrap_or(SCENES[usize::from(wanted.quick)]);
    let numbers: Vec<u64> = (0..count).map(|i| wanted.first.saturating_add(i)).collect();
    let rows = rows(study, &wanted.out.join(ROWS), &numbers, wanted.resume)?;
    study.csv("scenes.csv", &rows)?;
    report::write(study, &rows)?;
    net::run(study)?;
    Ok(INTRODUCTION)
}

/// Computes the rows of these scenes. Every batch is written, so that an interrupted run can be resumed.
fn rows(study: &mut Study, path: &Path, numbers: &[u64], resume: bool) -> Result<Vec<Row>, Failure> {
    let mut rows: Vec<Row> = Vec::new();
    if resume && path.exists() {
        for line in BufReader::new(std::fs::File::open(path)?).lines() {
            rows.push(serde_json::from_str(&line?)?);
        }
        rows.retain(|row| numbers.contains(&row.scene));
    }
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder)?;
    }
    let mut file = OpenOptions::new().create(true).write(true).append(resume).truncate(!resume).open(path)?;
    let missing: Vec<u64> = numbers.iter().copied().filter(|n| rows.iter().all(|row| row.scene != *n)).collect();
    for batch in missing.chunks(BATCH) {
        let found = study.sweep(batch, row::TOLERANCES.len(), |&number| Row::of_scene(number))?;
        let found: Vec<Row> = found.into_iter().flatten().collect();
        let lines: Result<Vec<String>, _> = found.iter().map(serde_json::to_string).collect();
        writeln!(file, "{}", lines?.join("\n"))?;
        rows.extend(found);
    }
    rows.sort_by_key(|row| row.scene);
    Ok(rows)
}
