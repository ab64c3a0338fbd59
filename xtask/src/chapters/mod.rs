//! Reproduction of the chapters of the thesis: tables as CSV, figures as SVG, and a report that compares every number of the
//! text with ours.

mod all;
mod beam;
mod chapter2;
mod chapter3;
mod chapter4;
mod chapter5;
mod chapter6;
mod chapter7;
mod chapter8;
mod ensemble;
mod figures;
mod impact;
mod material;
mod scatter;
pub mod statement;
mod study;
pub mod tally;
mod theories;

use std::path::Path;
use std::str::FromStr;
use tasks::{BadInput, Failure, targets};

pub use all::run_all;
pub use study::Finished;
use study::{Study, finish};

/// Parts of the thesis that can be reproduced separately.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Part {
    /// A chapter by its number.
    Chapter(u32),
    /// Chapter 4 with the parameters varied that the thesis does not state.
    Ensemble,
    /// Chapters 3, 4 and 7 by both theories of bending.
    Theories,
}

impl Part {
    /// All parts, in the order of the thesis.
    pub const ALL: [Part; 9] = [
        Part::Chapter(2),
        Part::Chapter(3),
        Part::Chapter(4),
        Part::Ensemble,
        Part::Chapter(5),
        Part::Chapter(6),
        Part::Chapter(7),
        Part::Chapter(8),
        Part::Theories,
    ];

    /// The chapter whose page shows its statements and figures; 0 is the page on theories of bending.
    pub const fn chapter(self) -> u32 {
        match self {
            Part::Chapter(number) => number,
            Part::Ensemble => 4,
            Part::Theories => 0,
        }
    }

    /// Name of its folder.
    pub fn folder(self) -> String {
        match self {
            Part::Chapter(number) => format!("chapter-{number}"),
            Part::Ensemble => "ensemble".to_owned(),
            Part::Theories => "theories".to_owned(),
        }
    }

    /// Name of the part of the thesis to which its impacts and figures belong.
    fn of_the_thesis(self) -> String {
        match self {
            Part::Theories => self.folder(),
            part => format!("chapter {}", part.chapter()),
        }
    }

    fn title(self) -> String {
        match self {
            Part::Chapter(number) => format!("Chapter {number} of the thesis, computed anew"),
            Part::Ensemble => "Our choices in chapter 4, varied".to_owned(),
            Part::Theories => "Two theories of bending, and the effects beyond the thesis".to_owned(),
        }
    }
}

impl FromStr for Part {
    type Err = BadInput;

    fn from_str(text: &str) -> Result<Part, BadInput> {
        let named = |part: &Part| match part {
            Part::Chapter(number) => text.parse() == Ok(*number),
            Part::Ensemble => text == "ensemble",
            Part::Theories => text == "theories",
        };
        Part::ALL.into_iter().find(named).ok_or_else(|| unknown(text))
    }
}

fn unknown(chapter: &str) -> BadInput {
    BadInput(format!(
        "chapter = {chapter} is not allowed; it must be one of 2, 3, 4, 5, 6, 7, 8, ensemble, theories, all"
    ))
}

/// Runs a part and writes its folder. `quick` computes fewer points with the same code. `data` are measured points for
/// chapter 8.
pub fn run(part: Part, out: &Path, quick: bool, data: Option<&Path>) -> Result<Finished, Failure> {
    if data.is_some() && part != Part::Chapter(8) {
        let fault = format!(
            "--data is not allowed with {}; it must be left out, because only chapter 8 takes measured points",
            part.folder()
        );
        return Err(BadInput(fault).into());
    }
    // the user's file is checked before anything is computed
    let points = data.map(chapter8::points).transpose()?;
    let mut study = Study::new(out, quick)?.part_of_a_larger_one(part.of_the_thesis());
    let introduction = match part {
        Part::Chapter(2) => chapter2::run(&mut study)?,
        Part::Chapter(3) => chapter3::run(&mut study)?,
        Part::Chapter(4) => chapter4::run(&mut study)?,
        Part::Ensemble => ensemble::run(&mut study)?,
        Part::Theories => theories::run(&mut study)?,
        Part::Chapter(5) => chapter5::run(&mut study)?,
        Part::Chapter(6) => chapter6::run(&mut study)?,
        Part::Chapter(7) => chapter7::run(&mut study)?,
        Part::Chapter(8) => chapter8::run(&mut study, points.as_deref())?,
        Part::Chapter(other) => return Err(unknown(&other.to_string()).into()),
    };
    finish(study, part.chapter(), &part.title(), introduction)
}

/// Fits the distribution of the restitution about the law to the tables of chapter 4, and writes the folder of that study.
pub fn study_scatter(out: &Path, quick: bool) -> Result<String, Failure> {
    let mut study = tasks::Study::new(out, quick)?;
    let introduction = scatter::run(&mut study)?;
    Ok(study.finish("The scatter of the law", introduction, targets)?.summary)
}

#[cfg(test)]
mod tests;
