//! Forms of the results of the commands: printed text, a folder of files, a figure, a report.

use std::path::{Path, PathBuf};

use clap::Args;
use vibroimpact::InvalidInput;
use vibroimpact::export::{Failure, Files};
use vibroimpact::plot::{Figure, Format};
use vibroimpact::report::{Report, write_whole};
use vibroimpact::text::printable;

use super::voice::is_quiet;

/// The forms of the result: printed, and as files.
#[derive(Args)]
pub struct Products {
    /// Print one JSON object in place of the summary
    #[arg(long)]
    pub json: bool,
    /// Write histories, picture and result to this folder
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Draw the impact to this file, .svg or .png
    #[arg(long, value_name = "FILE", value_parser = picture_file)]
    plot: Option<PathBuf>,
    /// Write a report with pictures and tables to this file, .html
    #[arg(long, value_name = "FILE", value_parser = page_file)]
    report: Option<PathBuf>,
    /// Replace files that exist
    #[arg(long)]
    force: bool,
}

/// A picture in addition to the printed result.
#[derive(Args)]
pub struct Picture {
    /// Draw the result to this file, .svg or .png
    #[arg(long, value_name = "FILE", value_parser = picture_file)]
    plot: Option<PathBuf>,
    /// Replace the file if it exists
    #[arg(long)]
    force: bool,
}

impl Picture {
    /// Rejects options that would replace existing files, before anything is solved.
    pub fn require_room(&self) -> Result<(), InvalidInput> {
        require_free("--plot", self.plot.as_deref(), self.force)
    }

    /// The same for another file, which an option names.
    pub fn require_room_for(&self, option: &str, path: Option<&Path>) -> Result<(), InvalidInput> {
        require_free(option, path, self.force)
    }

    /// Rejects a figure where there is none to draw.
    pub fn require_none(&self, allowed: &'static str) -> Result<(), InvalidInput> {
        let path = |plot: &PathBuf| Err(InvalidInput::new("--plot", plot.display().to_string(), allowed));
        self.plot.as_ref().map_or(Ok(()), path)
    }

    /// Draws the figure, if it is requested, and returns a line about it for the text; empty if the result is JSON.
    pub fn draw(&self, json: bool, figure: impl FnOnce() -> Result<Figure, Failure>) -> Result<String, Failure> {
        match &self.plot {
            Some(path) => write_single(path, &picture(path, &figure()?)?, json),
            None => Ok(String::new()),
        }
    }
}

/// Whether anything has this name, even a broken link.
fn is_there(path: &Path) -> bool {
    path.symlink_metadata().is_ok()
}

/// Rejects the name of an existing file.
pub fn require_free(option: &str, path: Option<&Path>, force: bool) -> Result<(), InvalidInput> {
    match path {
        Some(path) if !force && is_there(path) => {
            let allowed = "the name of a new file, because this file exists; --force replaces it";
            Err(InvalidInput::new(option, path.display().to_string(), allowed))
        }
        _ => Ok(()),
    }
}

/// A file name with the ending of a picture.
fn picture_file(name: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(name);
    Format::of(&path).map(|_| path).ok_or_else(|| format!("it must be {}", Format::ENDINGS))
}

fn page_file(name: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(name);
    let is_page = path.extension().is_some_and(|ending| ["html", "htm"].iter().any(|e| ending.eq_ignore_ascii_case(e)));
    if is_page { Ok(path) } else { Err("it must be a file name that ends in .html".to_owned()) }
}

impl Products {
    /// Whether files that exist may be replaced.
    pub fn may_replace(&self) -> bool {
        self.force
    }

    /// Rejects options that would replace existing files, before anything is solved.
    pub fn require_room(&self) -> Result<(), InvalidInput> {
        if let Some(folder) = &self.out
            && !self.force
            && let Some(name) = Files::NAMES.into_iter().find(|name| is_there(&folder.join(name)))
        {
            let allowed = format!("a folder without {name}, which this one contains; --force replaces it");
            return Err(InvalidInput::new("--out", folder.display().to_string(), allowed));
        }
        for (option, path) in [("--plot", &self.plot), ("--report", &self.report)] {
            require_free(option, path.as_deref(), self.force)?;
        }
        Ok(())
    }

    /// Writes the requested files and returns lines about them for the text; empty if the result is JSON. All files are completed
    /// in memory before the first one is written.
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
        let mut told = self.write_folder(files)?;
        for (path, content) in single {
            told += &write_single(path, &content, self.json)?;
        }
        Ok(told)
    }

    /// Whether pictures or tables of the motion in time are requested.
    pub fn want_course(&self) -> bool {
        self.out.is_some() || self.plot.is_some() || self.report.is_some()
    }

    fn write_folder(&self, files: impl FnOnce() -> Result<Files, Failure>) -> Result<String, Failure> {
        let Some(folder) = &self.out else { return Ok(String::new()) };
        let files = files()?;
        files.write(folder)?;
        let names: Vec<&str> = files.names().collect();
        if self.json || is_quiet() {
            return Ok(String::new());
        }
        let place = printable(&folder.display().to_string());
        // the most readable of the written files
        let first = ["report.html", "run.svg", "impact.svg"].into_iter().find(|name| names.contains(name));
        let look = first.map_or_else(String::new, |first| {
            format!("  look at {} first, with a browser\n", printable(&folder.join(first).display().to_string()))
        });
        Ok(format!("  wrote {} to {place}\n{look}", names.join(", ")))
    }
}

fn picture(path: &Path, figure: &Figure) -> Result<Vec<u8>, Failure> {
    Ok(figure.bytes(Format::of(path).ok_or(Format::ENDINGS)?)?)
}

/// Writes one file and returns a line about it for the text; empty if the result is JSON.
pub fn write_single(path: &Path, content: &[u8], json: bool) -> Result<String, Failure> {
    write_whole(path, content).map_err(|error| format!("cannot write to {}: {error}", path.display()))?;
    let silent = json || is_quiet();
    Ok(if silent { String::new() } else { format!("  wrote {}\n", printable(&path.display().to_string())) })
}
