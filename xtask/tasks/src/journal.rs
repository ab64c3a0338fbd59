//! Rows of a long run in a file, so that an interrupted run can be resumed.

use crate::failure::{BadInput, Failure};
use crate::progress::Progress;
use rayon::prelude::*;
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::fs::{self, File, OpenOptions};
use std::io::{Read, Seek, SeekFrom, Write};
use std::path::Path;

/// A file with one row a line, as JSON, and its rows in memory.
#[derive(Debug)]
pub struct Journal<R> {
    file: File,
    rows: Vec<R>,
}

impl<R: Serialize + DeserializeOwned> Journal<R> {
    /// Opens the file and reads its rows to resume a run, or begins it anew. A last line that an interruption has cut off is
    /// dropped.
    ///
    /// # Errors
    /// If the file cannot be read or written, or holds something else.
    pub fn open(path: &Path, resume: bool) -> Result<Journal<R>, Failure> {
        if let Some(folder) = path.parent() {
            fs::create_dir_all(folder)?;
        }
        let mut file = OpenOptions::new().create(true).read(true).write(true).truncate(!resume).open(path)?;
        let mut text = String::new();
        file.read_to_string(&mut text)?;
        let whole = text.rfind('\n').map_or(0, |end| end + 1);
        let row = |(number, line): (usize, &str)| {
            serde_json::from_str(line)
                .map_err(|fault| BadInput(format!("{}, line {}: {fault}", path.display(), number + 1)))
        };
        let rows = text[..whole].lines().enumerate().map(row).collect::<Result<Vec<R>, _>>()?;
        file.set_len(whole as u64)?;
        file.seek(SeekFrom::End(0))?;
        Ok(Journal { file, rows })
    }

    /// All rows so far.
    pub fn rows(&self) -> &[R] {
        &self.rows
    }

    /// Writes further rows.
    ///
    /// # Errors
    /// If they cannot be written.
    pub fn extend(&mut self, rows: Vec<R>) -> Result<(), Failure> {
        let lines: Result<String, serde_json::Error> =
            rows.iter().map(|row| Ok(serde_json::to_string(row)? + "\n")).collect();
        self.file.write_all(lines?.as_bytes())?;
        self.rows.extend(rows);
        Ok(())
    }

    /// Computes the rows of these cases on all cores. Every batch of so many cases is written before the next one begins.
    ///
    /// # Errors
    /// The first error of `job`, or if rows cannot be written.
    pub fn compute<C: Sync>(
        &mut self,
        cases: &[C],
        batch: usize,
        progress: &Progress,
        job: impl Fn(&C) -> Result<R, Failure> + Sync,
    ) -> Result<(), Failure>
    where
        R: Send,
    {
        let each = |case| {
            let row = job(case);
            progress.add(1);
            row
        };
        for batch in cases.chunks(batch) {
            self.extend(batch.par_iter().map(each).collect::<Result<Vec<R>, Failure>>()?)?;
        }
        Ok(())
    }

    /// All rows.
    pub fn into_rows(self) -> Vec<R> {
        self.rows
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_interrupted_run_is_resumed_from_its_whole_lines() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("below/rows.jsonl");
        let mut journal = Journal::open(&path, true).unwrap();
        journal.extend(vec![1, 2]).unwrap();
        fs::write(&path, "1\n2\n34").unwrap();
        let mut journal: Journal<u32> = Journal::open(&path, true).unwrap();
        assert_eq!(journal.rows(), [1, 2]);
        journal.extend(vec![3]).unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "1\n2\n3\n");
        assert_eq!(journal.into_rows(), [1, 2, 3]);

        fs::write(&path, "1\nx\n").unwrap();
        let fault = Journal::<u32>::open(&path, true).unwrap_err();
        assert!(fault.is::<BadInput>() && fault.to_string().contains("rows.jsonl, line 2: "), "{fault}");
        // a new run does not look at what is there
        assert!(Journal::<u32>::open(&path, false).unwrap().rows().is_empty());
    }
}
