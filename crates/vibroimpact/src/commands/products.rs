//! How the commands give their results: printed, as a folder of files, as a picture, as a report.

use std::path::{Path, PathBuf};

use clap::Args;
use vibroimpact::InvalidInput;
use vibroimpact::export::{Failure, Files};
use vibroimpact::model::Model;
use vibroimpact::plot::{Figure, Format};
use vibroimpact::report::{Report, write_whole};

/// How the result is wanted: printed, and as files.
#[derive(Args)]
pub struct Products {
    /// Print one JSON object in place of the summary
    #[arg(long)]
    pub json: bool,
    /// Write histories, picture and result into this folder
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
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
    pub fn refuse_pictures(&self, model: Model) -> Result<(), InvalidInput> {
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

    /// Writes what is asked for and returns what to tell a reader: nothing beside JSON. Every file is complete in
    /// memory before the first is written.
    pub fn write(
        &self,
        figure: impl FnOnce() -> Figure,
        report: impl FnOnce(&Figure) -> std::io::Result<Report>,
        files: impl FnOnce() -> Result<Files, Failure>,
    ) -> Result<String, Failure> {
        let mut single = Vec::new();
        if self.plot.is_some() || self.report.is_some() {
            let figure = figure();
            if let Some(path) = &self.plot {
                single.push((path, picture(path, &figure)?));
            }
            if let Some(path) = &self.report {
                single.push((path, report(&figure)?.html().into_bytes()));
            }
        }
        let mut told = self.write_files(files)?;
        for (path, content) in single {
            told += &write_single(path, &content, self.json)?;
        }
        Ok(told)
    }

    /// Whether pictures or tables of the course in time are asked for.
    pub fn want_course(&self) -> bool {
        self.out.is_some() || self.plot.is_some() || self.report.is_some()
    }

    /// Writes the folder alone, if one is asked for.
    pub fn write_files(&self, files: impl FnOnce() -> Result<Files, Failure>) -> Result<String, Failure> {
        let Some(folder) = &self.out else { return Ok(String::new()) };
        let files = files()?;
        files.write(folder)?;
        let names: Vec<&str> = files.names().collect();
        Ok(if self.json { String::new() } else { format!("\n  wrote {} to {}\n", names.join(", "), folder.display()) })
    }
}

/// Draws one picture and returns what to tell a reader: nothing beside JSON.
pub fn draw(path: &Path, figure: &Figure, json: bool) -> Result<String, Failure> {
    write_single(path, &picture(path, figure)?, json)
}

fn picture(path: &Path, figure: &Figure) -> Result<Vec<u8>, Failure> {
    Ok(figure.bytes(Format::of(path).ok_or(Format::ENDINGS)?)?)
}

fn write_single(path: &Path, content: &[u8], json: bool) -> Result<String, Failure> {
    write_whole(path, content).map_err(|error| format!("cannot write to {}: {error}", path.display()))?;
    Ok(if json { String::new() } else { format!("\n  wrote {}\n", path.display()) })
}
