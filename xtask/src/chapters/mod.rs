//! The chapters of the thesis, computed anew: tables as CSV, figures as SVG, and a report that
//! sets every number of the text beside ours.

mod all;
mod beam;
mod chapter2;
mod chapter3;
mod chapter4;
mod chapter6;
mod chapter7;
mod chapter8;
mod choice;
mod figures;
mod impact;
mod study;

use std::error::Error;
use std::fmt;
use std::path::Path;

pub use all::run_all;
pub use study::Finished;
use study::Study;

/// Whatever can go wrong on the way: bad parameters, a full disk.
pub type Failure = Box<dyn Error + Send + Sync>;

/// Input that cannot be used: what, its value, and what is allowed.
#[derive(Debug)]
pub struct BadInput(String);

impl BadInput {
    /// A chapter that there is not.
    pub fn chapter(found: &str) -> BadInput {
        BadInput(format!("chapter = {found} is not allowed: 2, 3, 4, 6, 7, 8 or all"))
    }
}

impl fmt::Display for BadInput {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.0)
    }
}

impl Error for BadInput {}

/// The chapters that can be reproduced.
pub const CHAPTERS: [u32; 6] = [2, 3, 4, 6, 7, 8];

/// Runs a chapter and writes its folder. `quick` takes fewer points through the same code; `data` are measured points
/// for chapter 8.
pub fn run(chapter: u32, out: &Path, quick: bool, data: Option<&Path>) -> Result<Finished, Failure> {
    if data.is_some() && chapter != 8 {
        let fault = format!("--data is not allowed with chapter {chapter}: only chapter 8 takes measured points");
        return Err(BadInput(fault).into());
    }
    let mut study = Study::new(out, quick)?;
    let introduction = match chapter {
        2 => chapter2::run(&mut study)?,
        3 => chapter3::run(&mut study)?,
        4 => chapter4::run(&mut study)?,
        6 => chapter6::run(&mut study)?,
        7 => chapter7::run(&mut study)?,
        8 => chapter8::run(&mut study, data)?,
        other => return Err(BadInput::chapter(&other.to_string()).into()),
    };
    study.finish(&format!("Chapter {chapter} of the thesis, computed anew"), introduction)
}

/// Puts the automatic choice of the model to the test, from a scene of the row on, and writes the folder of that study.
pub fn study_auto(out: &Path, quick: bool, first: u64) -> Result<String, Failure> {
    let mut study = Study::new(out, quick)?;
    study.claims("Targets, and what was found");
    let introduction = choice::run(&mut study, first)?;
    Ok(study.finish("The automatic choice of the model", introduction)?.summary)
}

#[cfg(test)]
mod tests;
