//! What is made of the rows when all are there: Parquet, summary, pictures, report.

use std::fs::File;
use std::io::BufReader;

use super::definition::Sweep;
use super::error::SweepError;
use super::folder::{Folder, Part, RESULTS, json, read_json, settle, write_durably};
use super::pictures::Pictures;
use super::report;
use super::row::{Row, columns};
use super::table::Table;
use super::tally::Tally;

pub(super) const TABLE: &str = "results.parquet";
pub(super) const SUMMARY: &str = "summary.json";

/// Makes the rest of a folder's files, whose rows are complete. A part has a summary only: the rest is made when the
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
    let tally = each_row(sweep, part, folder, |point, row| {
        pictures.add(point, row);
        table.add(row.cells(), &unfinished)
    })?;
    table.close(&unfinished)?;
    settle(&unfinished, &file).map_err(SweepError::io(&file))?;
    let path = folder.path();
    report::report(sweep, &tally, pictures).and_then(|report| report.write(path)).map_err(SweepError::io(path))?;
    close(folder, &tally)?;
    Ok(tally)
}

/// The summary of a folder that is finished.
pub(super) fn summary(folder: &Folder) -> Result<Tally, SweepError> {
    let path = folder.path().join(SUMMARY);
    read_json(&path)?.ok_or_else(|| SweepError::Refused(format!("{} is missing", path.display())))
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
    for point in part.points(sweep) {
        // after the last row nothing is read, and an empty row is refused
        table.read_record(&mut cells).map_err(blame)?;
        let row = Row::new(sweep, point, &cells)?;
        tally.add(point, &row);
        each(point, &row)?;
    }
    Ok(tally)
}
