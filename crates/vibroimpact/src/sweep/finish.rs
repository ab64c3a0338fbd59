//! The files that are made from the complete rows: Parquet, summary, figures, report.

use std::fs::File;
use std::io::BufReader;

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
        close(folder, &tally)?;
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
    let figures = match (distributions, &sweep.uncertain) {
        (Some(distributions), Some(uncertain)) => {
            let found = distributions.finish();
            tally.add_distributions(uncertain, !sweep.axes.is_empty(), &found);
            write_durably(&path.join(DISTRIBUTION), &uncertain::table(sweep, &found))?;
            uncertain::figures(sweep, &found)
        }
        _ => pictures.figures().into_iter().map(|(name, figure, caption)| (name.to_owned(), figure, caption)).collect(),
    };
    report::report(sweep, &tally, figures).and_then(|report| report.write(path)).map_err(SweepError::io(path))?;
    close(folder, &tally)?;
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

/// The summary of a finished folder. If it cannot be read, or another file that is made from the rows is missing, they are made again.
pub(super) fn summary(sweep: &Sweep, part: Part, folder: &mut Folder) -> Result<Tally, SweepError> {
    let path = folder.path();
    let made = [TABLE, "report.html", "report.md"].into_iter().chain(sweep.uncertain.as_ref().map(|_| DISTRIBUTION));
    let is_whole = part != Part::WHOLE || made.into_iter().all(|name| path.join(name).is_file());
    match read_json(&path.join(SUMMARY)) {
        Ok(Some(tally)) if is_whole => Ok(tally),
        _ => finish(sweep, part, folder),
    }
}

fn close(folder: &mut Folder, tally: &Tally) -> Result<(), SweepError> {
    write_durably(&folder.path().join(SUMMARY), &json(tally)?)?;
    folder.finish()
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
