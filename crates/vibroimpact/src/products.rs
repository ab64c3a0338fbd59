//! Pictures and reports that the commands write.

use std::path::{Path, PathBuf};

use clap::Args;
use vibroimpact::InvalidInput;
use vibroimpact::export::Failure;
use vibroimpact::model::Model;
use vibroimpact::plot::{Figure, Format};
use vibroimpact::report::{Report, write_whole};

/// Files asked for beside what is printed.
#[derive(Args)]
pub struct Products {
    /// Draw the impact into this file, .svg or .png
    #[arg(long, value_name = "FILE", value_parser = picture_file)]
    plot: Option<PathBuf>,
    /// Write a report with pictures and tables into this file, .html
    #[arg(long, value_name = "FILE", value_parser = page_file)]
    report: Option<PathBuf>,
}

/// A file name with the ending of a picture.
pub fn picture_file(name: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(name);
    Format::of(&path).map(|_| path).ok_or_else(|| format!("allowed is {}", Format::ENDINGS))
}

fn page_file(name: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(name);
    let is_page = path.extension().is_some_and(|ending| ["html", "htm"].iter().any(|e| ending.eq_ignore_ascii_case(e)));
    if is_page { Ok(path) } else { Err("allowed is a file name that ends in .html".to_owned()) }
}

impl Products {
    /// Says that this model has no course in time to draw, if a picture or a report is asked for.
    pub fn refuse(&self, model: Model) -> Result<(), InvalidInput> {
        for (option, path) in [("--plot", &self.plot), ("--report", &self.report)] {
            if let Some(path) = path {
                let name = model.as_str();
                return Err(InvalidInput {
                    field: option.to_owned(),
                    value: Some(path.display().to_string()),
                    allowed: format!(
                        "none for the model {name}, which has no course in time; \"model\": \"modal\" has"
                    ),
                });
            }
        }
        Ok(())
    }

    /// Makes the files in memory; figure and report only if they are asked for.
    pub fn prepare(
        &self,
        figure: impl FnOnce() -> Figure,
        report: impl FnOnce(&Figure) -> std::io::Result<Report>,
    ) -> Result<Prepared, Failure> {
        let mut prepared = Prepared::default();
        if self.plot.is_some() || self.report.is_some() {
            let figure = figure();
            if let Some(path) = &self.plot {
                prepared.add_picture(path, &figure)?;
            }
            if let Some(path) = &self.report {
                prepared.0.push((path.clone(), report(&figure)?.html().into_bytes()));
            }
        }
        Ok(prepared)
    }
}

/// Files complete in memory.
#[derive(Default)]
pub struct Prepared(Vec<(PathBuf, Vec<u8>)>);

impl Prepared {
    /// One picture.
    pub fn picture(path: &Path, figure: &Figure) -> Result<Prepared, Failure> {
        let mut prepared = Prepared::default();
        prepared.add_picture(path, figure)?;
        Ok(prepared)
    }

    fn add_picture(&mut self, path: &Path, figure: &Figure) -> Result<(), Failure> {
        let format = Format::of(path).ok_or(Format::ENDINGS)?;
        self.0.push((path.to_owned(), figure.bytes(format)?));
        Ok(())
    }

    /// Writes the files, each whole or not at all, and returns what to tell a reader: nothing beside JSON.
    pub fn write(&self, json: bool) -> Result<String, Failure> {
        let mut told = String::new();
        for (path, content) in &self.0 {
            write_whole(path, content).map_err(|error| format!("cannot write to {}: {error}", path.display()))?;
            if !json {
                told += &format!("\n  wrote {}\n", path.display());
            }
        }
        Ok(told)
    }
}
