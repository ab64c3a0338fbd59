//! The files that are made from the complete rows: Parquet, summary, figures, report.

use std::fs::File;
use std::io::BufReader;
use std::path::PathBuf;

use super::definition::Sweep;
use super::error::SweepError;
use super::folder::{DISTRIBUTION, Folder, RESULTS, SUMMARY, TABLE, json, read_json, settle, write_durably};
use super::part::Part;
use super::pictures::Pictures;
use super::report;
use super::row::{Row, columns};
use super::table::Table;
use super::tally::Tally;
use super::uncertain::{self, Collector, Uncertain};

/// Writes the remaining files of a folder whose rows are complete. A part has only a summary: the other files are written when the
/// parts are merged.
pub(super) fn finish(sweep: &Sweep, part: Part, folder: &mut Folder) -> Result<Tally, SweepError> {
    if part != Part::WHOLE {
        let tally = each_row(sweep, part, folder, |_, _| Ok(()))?;
        close(folder, &tally, Vec::new())?;
        return Ok(tally);
    }
    let file = folder.path().join(TABLE);
    let unfinished = file.with_extension("part");
    let mut table = Table::create(&unfinished, "results", columns(sweep))?;
    let mut pictures = Pictures::new(sweep);
    let mut distributions = Collector::new(sweep);
    let mut tally = each_row(sweep, part, folder, |point, row| {
        match &mut distributions {
            Some(distributions) => distributions.add(row),
            None => pictures.add(point, row),
        }
        table.add(row.cells(), &unfinished)
    })?;
    table.close(&unfinished)?;
    settle(&unfinished, &file).map_err(SweepError::io(&file))?;
    let path = folder.path();
    let mut made = vec![file];
    let figures = match (distributions, &sweep.uncertain) {
        (Some(distributions), Some(uncertain)) => {
            let found = distributions.finish();
            tally.add_distributions(uncertain, !sweep.axes.is_empty(), &found);
            made.push(path.join(DISTRIBUTION));
            write_durably(&path.join(DISTRIBUTION), &uncertain::table(sweep, &found))?;
            uncertain::figures(sweep, &found)
        }
        _ => pictures.figures().into_iter().map(|(name, figure, caption)| (name.to_owned(), figure, caption)).collect(),
    };
    let report = report::report(sweep, &tally, figures).and_then(|report| report.write(path));
    made.extend(report.map_err(SweepError::io(path))?);
    close(folder, &tally, made)?;
    Ok(tally)
}

/// Whether the draws so far have the requested sampling error.
pub(super) fn is_enough(sweep: &Sweep, part: Part, folder: &Folder) -> Result<bool, SweepError> {
    let adaptive = sweep.uncertain.as_ref().is_some_and(Uncertain::is_adaptive);
    let Some(mut draws) = Collector::new(sweep).filter(|_| adaptive) else { return Ok(false) };
    each_row(sweep, part, folder, |_, row| {
        draws.add(row);
        Ok(())
    })?;
    Ok(draws.enough())
}

/// The summary of a finished folder. If a file that was made from the rows is missing or was changed, all of them are made again.
pub(super) fn summary(sweep: &Sweep, part: Part, folder: &mut Folder) -> Result<Tally, SweepError> {
    match read_json(&folder.path().join(SUMMARY)) {
        Ok(Some(tally)) if folder.is_intact() => Ok(tally),
        _ => finish(sweep, part, folder),
    }
}

fn close(folder: &mut Folder, tally: &Tally, mut made: Vec<PathBuf>) -> Result<(), SweepError> {
    made.push(folder.path().join(SUMMARY));
    write_durably(&folder.path().join(SUMMARY), &json(tally)?)?;
    folder.finish(&made)
}

/// Reads the rows in order.
fn each_row(
    sweep: &Sweep,
    part: Part,
    folder: &Folder,
    mut each: impl FnMut(u64, &Row) -> Result<(), SweepError>,
) -> Result<Tally, SweepError> {
    let path = folder.path().join(RESULTS);
    let blame = |fault: csv::Error| SweepError::Refused(format!("{} cannot be read: {fault}", path.display()));
    let file = File::open(&path).map_err(SweepError::io(&path))?;
    let mut table = csv::Reader::from_reader(BufReader::with_capacity(1 << 20, file));
    let mut cells = csv::StringRecord::new();
    let mut tally = Tally::default();
    let first = part.chunks(sweep.chunks()).start;
    let there = sweep.first_of_chunk(first)..sweep.first_of_chunk(first + folder.progress().chunks);
    for point in there {
        // nothing is read after the last row, and an empty row is rejected
        table.read_record(&mut cells).map_err(blame)?;
        let row = Row::new(sweep, point, &cells)?;
        tally.add(point, &row);
        each(point, &row)?;
    }
    Ok(tally)
}
