//! Forms of the results of the commands: printed text, a folder of files, a figure, a report.

use std::path::{Component, Path, PathBuf};

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

/// An option that names a file or a folder to write, and the path if it is given.
pub type Output<'a> = (&'static str, Option<&'a Path>);

impl Picture {
    /// Rejects options, these and other ones, that would replace `inputs`, existing files or each other's, before anything is
    /// solved.
    pub fn require_room(&self, inputs: &[PathBuf], others: &[Output]) -> Result<(), InvalidInput> {
        let outputs = [&[("--plot", self.plot.as_deref())], others].concat();
        require_apart(&outputs)?;
        require_files(&outputs, inputs, self.force)
    }

    /// Rejects a figure where there is none to draw.
    pub fn require_none(&self, allowed: &'static str) -> Result<(), InvalidInput> {
        let path = |plot: &PathBuf| Err(InvalidInput::new("--plot", plot.display().to_string(), allowed));
        self.plot.as_ref().map_or(Ok(()), path)
    }

    /// Draws the figure, if it is requested, and adds a line about it to the text; none if the result is JSON.
    pub fn draw(
        &self,
        printed: &mut String,
        json: bool,
        figure: impl FnOnce() -> Result<Figure, Failure>,
    ) -> Result<(), Failure> {
        match &self.plot {
            Some(path) => write_single(printed, path, &picture(path, &figure()?)?, json),
            None => Ok(()),
        }
    }
}

/// Whether anything has this name, even a broken link.
fn is_there(path: &Path) -> bool {
    path.symlink_metadata().is_ok()
}

/// Rejects the name of a file in place of a folder.
pub fn require_folder(option: &str, path: &Path) -> Result<(), InvalidInput> {
    let ok = path.is_dir() || !is_there(path);
    InvalidInput::unless(ok, option, path.display().to_string(), "a folder, because there is a file of this name")
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

/// Rejects options that name a file which the command reads, or an existing file.
fn require_files(outputs: &[Output], inputs: &[PathBuf], force: bool) -> Result<(), InvalidInput> {
    for (option, path) in outputs.iter().filter_map(|(option, path)| Some((option, (*path)?))) {
        if let Some(input) = find_input(path, inputs) {
            let allowed =
                format!("the name of another file, because the command reads this one as {}", input.display());
            return Err(InvalidInput::new(*option, path.display().to_string(), allowed));
        }
        require_free(option, Some(path), force)?;
    }
    Ok(())
}

/// The input that an output would replace. Links and other spellings of a path do not hide it; an output that is not there yet
/// replaces nothing.
fn find_input<'a>(output: &Path, inputs: &'a [PathBuf]) -> Option<&'a Path> {
    let place = output.canonicalize().ok()?;
    inputs.iter().map(PathBuf::as_path).find(|input| input.canonicalize().is_ok_and(|input| input == place))
}

/// Rejects options of which one names the file of another, or a file in its folder.
fn require_apart(outputs: &[Output]) -> Result<(), InvalidInput> {
    let given: Vec<(&str, &Path)> = outputs.iter().filter_map(|(option, path)| Some((*option, (*path)?))).collect();
    for (i, (option, path)) in given.iter().enumerate() {
        let place = normalised(path);
        let meets = |other: &Path| place.starts_with(other) || other.starts_with(&place);
        if let Some((other, there)) = given[..i].iter().find(|(_, other)| meets(&normalised(other))) {
            let allowed = format!("apart from {other} = {}, because one would replace the other", there.display());
            return Err(InvalidInput::new(*option, path.display().to_string(), allowed));
        }
    }
    Ok(())
}

/// The absolute path without `.` and `..`, which need not exist.
fn normalised(path: &Path) -> PathBuf {
    let mut found = PathBuf::new();
    for component in std::path::absolute(path).unwrap_or_else(|_| path.to_owned()).components() {
        match component {
            Component::CurDir => {}
            Component::ParentDir => {
                found.pop();
            }
            step => found.push(step),
        }
    }
    found
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
    /// Rejects options, these and other ones, that would replace `inputs`, existing files or each other's, before anything is
    /// solved.
    pub fn require_room(&self, inputs: &[PathBuf], others: &[Output]) -> Result<(), InvalidInput> {
        if let Some(folder) = &self.out {
            require_folder("--out", folder)?;
            // files of an earlier result are replaced or removed, whether or not this result has them
            let replaced =
                Files::NAMES.into_iter().find_map(|name| Some((name, find_input(&folder.join(name), inputs)?)));
            if let Some((name, input)) = replaced {
                let input = input.display();
                let allowed = format!("another folder, because the command reads {input}, which is {name} in this one");
                return Err(InvalidInput::new("--out", folder.display().to_string(), allowed));
            }
            if let Some(name) = Files::NAMES.into_iter().find(|name| !self.force && is_there(&folder.join(name))) {
                let allowed = format!("a folder without {name}, which this one contains; --force replaces it");
                return Err(InvalidInput::new("--out", folder.display().to_string(), allowed));
            }
        }
        let files = [&[("--plot", self.plot.as_deref()), ("--report", self.report.as_deref())], others].concat();
        require_apart(&[&[("--out", self.out.as_deref())], &files[..]].concat())?;
        require_files(&files, inputs, self.force)
    }

    /// Writes the requested files and adds lines about them to the text; none if the result is JSON. All files are completed in
    /// memory before the first one is written.
    pub fn write(
        &self,
        printed: &mut String,
        figure: impl FnOnce() -> Figure,
        report: impl FnOnce(&Figure) -> std::io::Result<Report>,
        files: impl FnOnce() -> Result<Files, Failure>,
    ) -> Result<(), Failure> {
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
        *printed += &self.write_folder(files)?;
        single.iter().try_for_each(|(path, content)| write_single(printed, path, content, self.json))
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

/// A result that was computed, but not written completely.
#[derive(Debug, thiserror::Error)]
#[error("{failure}")]
pub struct Unwritten {
    failure: Failure,
    /// The text that is printed nevertheless.
    pub printed: String,
}

/// Writes the files of a result, and returns the text to print with the lines about them. If a file cannot be written, the result
/// is printed nevertheless.
pub fn with_files(
    mut printed: String,
    write: impl FnOnce(&mut String) -> Result<(), Failure>,
) -> Result<String, Failure> {
    match write(&mut printed) {
        Ok(()) => Ok(printed),
        Err(failure) => Err(Unwritten { failure, printed }.into()),
    }
}

/// Writes one file and adds a line about it to the text; none if the result is JSON.
pub fn write_single(printed: &mut String, path: &Path, content: &[u8], json: bool) -> Result<(), Failure> {
    write_whole(path, content).map_err(|error| format!("cannot write to {}: {error}", path.display()))?;
    if !json && !is_quiet() {
        *printed += &format!("  wrote {}\n", printable(&path.display().to_string()));
    }
    Ok(())
}
