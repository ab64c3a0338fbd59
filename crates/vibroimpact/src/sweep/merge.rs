//! Merges the folders of all parts into the folder of the whole sweep.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};

use super::definition::Sweep;
use super::error::SweepError;
use super::finish;
use super::folder::{Finished, Folder, RESULTS, look_into};
use super::part::Part;
use super::row;
use super::status::Sink;
use super::tally::Tally;

/// Rows are copied in pieces of about this size.
const PIECE: usize = 4 << 20;

/// Makes the folder of a whole sweep from those of its parts, with the same bytes as [`run`](super::run) without parts. Every
/// point is checked, so that none is missing or duplicated.
///
/// # Errors
/// Folders that are not those of all parts of one sweep, each once, finished and undamaged; the text names those that
/// are missing. Nothing is then written, unless damage is found in the middle of a part; the folder is then unfinished.
pub fn merge(parts: &[PathBuf], out: &Path) -> Result<Tally, SweepError> {
    let refused = |text: String| Err(SweepError::Refused(text));
    let mut found: BTreeMap<u64, (&PathBuf, Finished)> = BTreeMap::new();
    for path in parts {
        let folder = look_into(path)?;
        if let Some((first, other)) = found.values().next() {
            if other.record.fingerprint != folder.record.fingerprint {
                return refused(format!("{} and {} hold parts of different sweeps", first.display(), path.display()));
            }
            let (a, b) = (other.record.part.of, folder.record.part.of);
            if a != b {
                let (first, path) = (first.display(), path.display());
                return refused(format!("{first} is one of {a} parts, {path} one of {b}"));
            }
        }
        let number = folder.record.part.number;
        if let Some((other, _)) = found.insert(number, (path, folder)) {
            return refused(format!("{} and {} hold the same part, {number}", other.display(), path.display()));
        }
    }
    let Some((first, Finished { record, .. })) = found.values().next() else {
        return refused("the folders of all parts must be given".to_owned());
    };
    let of = record.part.of;
    let missing: Vec<String> =
        (1..=of).filter(|number| !found.contains_key(number)).map(|number| format!("{number}/{of}")).collect();
    if !missing.is_empty() {
        return refused(format!("{} of {of} parts are missing: {}", missing.len(), missing.join(", ")));
    }
    let sweep = Sweep::from_value(&record.sweep)?;
    if sweep.fingerprint() != record.fingerprint {
        let text = format!("{} was made by {}; merge with the same version", first.display(), record.program);
        return refused(text);
    }

    let mut folder = Folder::open(out, &sweep, Part::WHOLE)?;
    if folder.progress().finished {
        return finish::summary(&sweep, Part::WHOLE, &mut folder);
    }
    for (number, (path, part)) in &found {
        let chunks = Part { number: *number, of }.chunks(sweep.chunks());
        // rows that an interrupted merge has already copied
        if folder.progress().chunks >= chunks.end {
            continue;
        }
        if part.progress.chunks != chunks.end - chunks.start {
            return refused(format!("{} is damaged: it has {} chunks", path.display(), part.progress.chunks));
        }
        copy(&sweep, &mut folder, path, part, chunks.start)?;
    }
    finish::finish(&sweep, Part::WHOLE, &mut folder)
}

/// Copies the missing rows of a part, chunk by chunk.
fn copy(sweep: &Sweep, folder: &mut Folder, path: &Path, part: &Finished, first: u64) -> Result<(), SweepError> {
    let file = path.join(RESULTS);
    let damaged = |what: &str| SweepError::Refused(format!("{} is damaged: {what}", file.display()));
    let mut rows = BufReader::with_capacity(1 << 20, File::open(&file).map_err(SweepError::io(&file))?);
    let mut sum = crc32fast::Hasher::new();
    let mut next = |line: &mut Vec<u8>| {
        let before = line.len();
        rows.read_until(b'\n', line).map_err(SweepError::io(&file))?;
        sum.update(&line[before..]);
        Ok::<_, SweepError>(before)
    };
    let mut piece = Vec::new();
    next(&mut piece)?;
    if piece != row::header(sweep) {
        return Err(damaged("the columns are not those of the sweep"));
    }
    piece.clear();
    let mut chunks = 0;
    for chunk in first..first + part.progress.chunks {
        let copied = chunk < folder.progress().chunks;
        for point in sweep.first_of_chunk(chunk)..sweep.first_of_chunk(chunk + 1) {
            let begin = next(&mut piece)?;
            if !piece[begin..].starts_with(format!("{point},").as_bytes()) || !piece.ends_with(b"\n") {
                return Err(damaged(&format!("the row of point {point} is not in its place")));
            }
        }
        if copied {
            piece.clear();
            continue;
        }
        chunks += 1;
        if piece.len() >= PIECE {
            folder.append(chunks, &piece)?;
            piece.clear();
            chunks = 0;
        }
    }
    next(&mut Vec::new())?;
    // before the last rows are added, the whole part must be unchanged
    if sum.finalize() != part.progress.crc32 {
        return Err(damaged("its checksum differs from the recorded one"));
    }
    folder.append(chunks, &piece)
}
