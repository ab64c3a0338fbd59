//! The folder of a sweep, whose contents survive an interruption at any moment.
//!
//! Rows are appended to `results.csv`. When they have reached the disk, `progress.json` is replaced as a whole. It states the
//! number of chunks in `results.csv`, its length and its checksum. Bytes beyond that length were being written when the sweep was
//! interrupted, and are dropped when it is resumed.

use std::collections::BTreeMap;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::definition::Sweep;
use super::error::SweepError;
use super::part::Part;
use super::row;
use super::status::Sink;

/// The description of a folder, `sweep.json`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Record {
    pub program: String,
    pub fingerprint: String,
    pub points: u64,
    pub part: Part,
    pub sweep: Value,
}

impl Record {
    pub(super) fn new(sweep: &Sweep, part: Part) -> Record {
        Record {
            program: concat!("vibroimpact ", env!("CARGO_PKG_VERSION")).to_owned(),
            fingerprint: sweep.fingerprint(),
            points: sweep.points(),
            part,
            sweep: sweep.canonical().clone(),
        }
    }
}

/// The progress of a folder, `progress.json`.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Progress {
    /// Chunks whose rows are in `results.csv`.
    pub chunks: u64,
    /// Length of `results.csv` with them.
    pub bytes: u64,
    /// Checksum of these bytes.
    pub crc32: u32,
    /// Whether the final files are complete too.
    pub finished: bool,
    /// Checksums of the final files, by their paths in the folder.
    #[serde(default)]
    pub made: BTreeMap<String, u32>,
}

/// A folder that only this process uses.
#[derive(Debug)]
pub(super) struct Folder {
    path: PathBuf,
    results: File,
    progress: Progress,
    /// The lock of the folder.
    _lock: File,
}

pub(super) const RECORD: &str = "sweep.json";
pub(super) const RESULTS: &str = "results.csv";
pub(super) const TABLE: &str = "results.parquet";
pub(super) const SUMMARY: &str = "summary.json";
pub(super) const DISTRIBUTION: &str = "distribution.csv";
const PROGRESS: &str = "progress.json";
const LOCK: &str = "lock";
/// The files of a sweep in addition to its record. Without a record they belong to something else, and are not replaced.
const WRITTEN: [&str; 8] = [RESULTS, PROGRESS, TABLE, SUMMARY, DISTRIBUTION, "report.html", "report.md", "figures"];

impl Folder {
    /// Opens the folder of a sweep, to begin or to resume it.
    ///
    /// # Errors
    /// A folder that is in use, belongs to another sweep, or is damaged; errors of the system.
    pub(super) fn open(path: &Path, sweep: &Sweep, part: Part) -> Result<Folder, SweepError> {
        if !path.is_dir() && path.symlink_metadata().is_ok() {
            let text = format!("{} is a file; the results need a folder", path.display());
            return Err(SweepError::Refused(text));
        }
        let record = Record::new(sweep, part);
        // nothing is written into the folder of something else
        has_begun(path, &record)?;
        fs::create_dir_all(path).map_err(SweepError::io(path))?;
        let lock = lock(path)?;
        // until now another process may have begun a sweep in it
        if !has_begun(path, &record)? {
            write_durably(&path.join(RECORD), &json(&record)?)?;
        }
        let file = path.join(RESULTS);
        let begun = read_json::<Progress>(&path.join(PROGRESS))?;
        let is_new = begun.is_none();
        let opened = OpenOptions::new().read(true).write(true).create(is_new).truncate(false).open(&file);
        let results = opened.map_err(|source| match source.kind() {
            io::ErrorKind::NotFound => {
                SweepError::Refused(format!("{} is missing; remove the folder to begin anew", file.display()))
            }
            _ => SweepError::Io { path: file, source },
        })?;
        let mut folder = Folder { path: path.to_owned(), results, progress: begun.unwrap_or_default(), _lock: lock };
        if is_new {
            folder.cut()?;
            folder.append(0, &row::header(sweep))?;
        }
        folder.check()?;
        folder.cut()?;
        Ok(folder)
    }

    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    pub(super) fn progress(&self) -> &Progress {
        &self.progress
    }

    /// Records that the folder is finished, with the files that were made from the rows.
    pub(super) fn finish(&mut self, made: &[PathBuf]) -> Result<(), SweepError> {
        let sum_of = |path: &PathBuf| {
            let name = path.strip_prefix(&self.path).unwrap_or(path).to_string_lossy().replace('\\', "/");
            Ok((name, checksum_of(path).map_err(SweepError::io(path))?))
        };
        self.progress.made = made.iter().map(sum_of).collect::<Result<_, SweepError>>()?;
        self.progress.finished = true;
        self.save()
    }

    /// Whether all files that were made from the rows are as they were made.
    pub(super) fn is_intact(&self) -> bool {
        let made = &self.progress.made;
        !made.is_empty()
            && made.iter().all(|(name, sum)| checksum_of(&self.path.join(name)).is_ok_and(|found| found == *sum))
    }

    fn save(&self) -> Result<(), SweepError> {
        write_durably(&self.path.join(PROGRESS), &json(&self.progress)?)
    }

    /// Checks that the beginning of the results agrees with the record, and that nothing follows it in a finished folder.
    fn check(&mut self) -> Result<(), SweepError> {
        let file = self.path.join(RESULTS);
        let bytes = self.progress.bytes;
        let sum = checksum(&mut self.results, bytes).map_err(SweepError::io(&file))?;
        let longer = self.results.metadata().map_err(SweepError::io(&file))?.len() > bytes;
        if sum == Some(self.progress.crc32) && !(self.progress.finished && longer) {
            return Ok(());
        }
        let text =
            format!("{} was changed after this program wrote it; remove the folder to begin anew", file.display());
        Err(SweepError::Refused(text))
    }

    /// Drops the bytes that were being written when the sweep was interrupted.
    fn cut(&mut self) -> Result<(), SweepError> {
        let bytes = self.progress.bytes;
        let cut = self.results.set_len(bytes).and_then(|()| self.results.seek(SeekFrom::Start(bytes)));
        cut.map(drop).map_err(SweepError::io(&self.path.join(RESULTS)))
    }
}

impl Sink for Folder {
    fn chunks(&self) -> u64 {
        self.progress.chunks
    }

    /// Adds the rows of the next chunks; they are on the disk when this returns.
    fn append(&mut self, chunks: u64, rows: &[u8]) -> Result<(), SweepError> {
        let written = self.results.write_all(rows).and_then(|()| self.results.sync_data());
        written.map_err(SweepError::io(&self.path.join(RESULTS)))?;
        let mut sum = crc32fast::Hasher::new_with_initial_len(self.progress.crc32, self.progress.bytes);
        sum.update(rows);
        self.progress.chunks += chunks;
        self.progress.bytes += rows.len() as u64;
        self.progress.crc32 = sum.finalize();
        self.save()
    }
}

/// The contents of the folder of a finished part.
pub(super) struct Finished {
    pub record: Record,
    pub progress: Progress,
}

/// Opens the folder of a part, which must be finished and undamaged.
pub(super) fn look_into(path: &Path) -> Result<Finished, SweepError> {
    let refused = |reason: &str| SweepError::Refused(format!("{} {reason}", path.display()));
    let record = read_json::<Record>(&path.join(RECORD))?.ok_or_else(|| refused("is not the folder of a sweep"))?;
    let progress = read_json::<Progress>(&path.join(PROGRESS))?.filter(|progress| progress.finished);
    let unfinished = || refused(&format!("holds part {}/{}, unfinished", record.part.number, record.part.of));
    let progress = progress.ok_or_else(unfinished)?;
    Ok(Finished { record, progress })
}

/// The checksum of a whole file.
fn checksum_of(path: &Path) -> io::Result<u32> {
    let mut file = File::open(path)?;
    let bytes = file.metadata()?.len();
    checksum(&mut file, bytes)?.ok_or_else(|| io::ErrorKind::UnexpectedEof.into())
}

/// The checksum of the first bytes of a file; `None` if it is shorter.
fn checksum(file: &mut File, bytes: u64) -> io::Result<Option<u32>> {
    file.seek(SeekFrom::Start(0))?;
    let mut sum = crc32fast::Hasher::new();
    let mut left = bytes;
    let mut piece = vec![0; 1 << 20];
    while left > 0 {
        let wanted = left.min(piece.len() as u64) as usize;
        let count = file.read(&mut piece[..wanted])?;
        if count == 0 {
            return Ok(None);
        }
        sum.update(&piece[..count]);
        left -= count as u64;
    }
    Ok(Some(sum.finalize()))
}

/// Whether this sweep has begun in the folder. If it has not, a process may have been stopped before it wrote the record: the
/// folder is then empty, or has no files but the lock and a part of the record.
///
/// # Errors
/// The folder is that of another sweep, or of something else.
fn has_begun(path: &Path, record: &Record) -> Result<bool, SweepError> {
    let found = read_json::<Record>(&path.join(RECORD)).map_err(|fault| match fault {
        SweepError::Refused(text) => SweepError::Refused(format!("{text}; choose another folder for the results")),
        other => other,
    })?;
    if let Some(found) = found {
        return same_sweep(path, &found, record).map(|()| true);
    }
    match WRITTEN.into_iter().find(|name| path.join(name).symlink_metadata().is_ok()) {
        None => Ok(false),
        Some(name) => {
            let folder = path.display();
            let text = format!(
                "{folder} holds {name}, but no {RECORD}, so it is not the folder of a sweep; choose another folder"
            );
            Err(SweepError::Refused(text))
        }
    }
}

fn same_sweep(path: &Path, found: &Record, wanted: &Record) -> Result<(), SweepError> {
    let folder = path.display();
    let text = if found.fingerprint != wanted.fingerprint {
        let what = if found.program == wanted.program { "another sweep" } else { "a sweep by another program" };
        format!("{folder} holds results of {what} ({}); choose another folder", found.program)
    } else if found.part != wanted.part {
        let Part { number, of } = found.part;
        format!(
            "{folder} holds part {number}/{of} of this sweep; choose another folder for {}/{}",
            wanted.part.number, wanted.part.of
        )
    } else {
        return Ok(());
    };
    Err(SweepError::Refused(text))
}

fn lock(path: &Path) -> Result<File, SweepError> {
    let file = path.join(LOCK);
    // an existing file with this name is not changed
    let opened = OpenOptions::new().write(true).create(true).truncate(false).open(&file);
    let lock = opened.map_err(SweepError::io(&file))?;
    match lock.try_lock() {
        Ok(()) => Ok(lock),
        Err(TryLockError::WouldBlock) => {
            Err(SweepError::Refused(format!("another process is working in {}", path.display())))
        }
        Err(TryLockError::Error(source)) => Err(SweepError::Io { path: file, source }),
    }
}

pub(super) fn json(value: &impl Serialize) -> Result<Vec<u8>, SweepError> {
    let text = serde_json::to_string_pretty(value).map_err(|fault| SweepError::Refused(fault.to_string()))?;
    Ok((text + "\n").into_bytes())
}

/// Reads a JSON file that this program wrote; `None` if there is none.
pub(super) fn read_json<T: for<'de> Deserialize<'de>>(path: &Path) -> Result<Option<T>, SweepError> {
    let text = match fs::read(path) {
        Err(fault) if fault.kind() == io::ErrorKind::NotFound => return Ok(None),
        text => text.map_err(SweepError::io(path))?,
    };
    let damaged = |fault| SweepError::Refused(format!("{} cannot be read: {fault}", path.display()));
    serde_json::from_slice(&text).map(Some).map_err(damaged)
}

/// Replaces a file atomically; afterwards the new file is on the disk, whatever happens to the machine.
pub(super) fn write_durably(path: &Path, bytes: &[u8]) -> Result<(), SweepError> {
    let part = path.with_extension("part");
    let write = || {
        let mut file = File::create(&part)?;
        file.write_all(bytes)?;
        file.sync_all()?;
        settle(&part, path)
    };
    write().map_err(SweepError::io(path))
}

/// Renames a file that is on the disk.
pub(super) fn settle(part: &Path, path: &Path) -> io::Result<()> {
    fs::rename(part, path)?;
    // the name is stored in the folder, which has to be synchronised separately on Unix
    #[cfg(unix)]
    if let Some(folder) = path.parent() {
        File::open(if folder.as_os_str().is_empty() { Path::new(".") } else { folder })?.sync_all()?;
    }
    Ok(())
}
