//! Reports: text, tables and figures as Markdown and as one self-contained HTML page.
//!
//! A [`Report`] is written in Markdown piece by piece. Figures are files beside the
//! Markdown and are embedded in the HTML. A [`Comparison`] compares a published number with ours; its
//! verdict follows from the two numbers and the tolerance alone.
//!
//! ```
//! use vibroimpact::report::{Comparison, Report, Verdict};
//! let stiffness = 2.0 * 2e11 * 0.015f64.sqrt() / (3.0 * (1.0 - 0.09));
//! let row = Comparison::printed("Hertz stiffness (N/m^1.5)", "Eq. 3.20", "1.7945e10", stiffness);
//! assert_eq!(row.verdict(), Verdict::Agrees);
//! let mut report = Report::new("Numbers of the text");
//! report.text("Set beside ours:");
//! report.comparisons(&[row]);
//! assert!(report.markdown().contains("1.7945"));
//! assert!(report.html().starts_with("<!DOCTYPE html>"));
//! ```

mod comparison;
mod html;
mod simulation;

use crate::export::aside::Aside;
use crate::text::printable;
pub use crate::text::significant;
pub use comparison::{Comparison, Expected, Verdict};
pub(crate) use simulation::trusted;
pub use simulation::{modelled, of_impact, of_infinite_impact, of_net_impact};

use crate::plot::Figure;
use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// A document that is being written.
#[derive(Debug, Clone, PartialEq)]
pub struct Report {
    title: String,
    body: String,
    /// SVG documents by their path relative to the report.
    figures: BTreeMap<String, String>,
}

impl Report {
    /// An empty document with a title.
    pub fn new(title: impl Into<String>) -> Report {
        Report { title: title.into(), body: String::new(), figures: BTreeMap::new() }
    }

    /// Begins a section.
    pub fn heading(&mut self, text: &str) {
        self.body += &format!("\n## {}\n", one_line(text));
    }

    /// Adds Markdown. Raw HTML in it is shown as text.
    pub fn text(&mut self, markdown: &str) {
        self.body += &format!("\n{}\n", markdown.trim_end());
    }

    /// Adds a list.
    pub fn list(&mut self, items: &[String]) {
        let lines: Vec<String> = items.iter().map(|item| format!("- {}", one_line(item))).collect();
        self.text(&lines.join("\n"));
    }

    /// Adds literal text in a fixed font. Markdown in it is not interpreted.
    pub fn code(&mut self, text: &str) {
        // a fence longer than any run of backticks in the text cannot be closed by it
        let longest = text.split(|c| c != '`').map(str::len).max().unwrap_or(0);
        let fence = "`".repeat(longest.max(2) + 1);
        self.text(&format!("{fence}\n{}\n{fence}", text.trim_end()));
    }

    /// Adds a figure under a file name without extension, with a caption in Markdown.
    ///
    /// # Errors
    /// Those of [`Figure::svg`](crate::plot::Figure::svg).
    pub fn figure(&mut self, name: &str, figure: &Figure, caption: &str) -> io::Result<()> {
        let path = format!("figures/{}.svg", file_name(name));
        self.figures.insert(path.clone(), figure.svg()?);
        let alternative = figure.title.replace(['[', ']', '\\'], " ");
        self.body += &format!("\n![{}]({path})\n\n{}\n", one_line(&alternative), one_line(caption));
        Ok(())
    }

    /// Adds a table; rows are cut or filled to the number of headers.
    pub fn table(&mut self, headers: &[&str], rows: &[Vec<String>]) {
        let line = |cells: &mut dyn Iterator<Item = String>| format!("| {} |\n", cells.collect::<Vec<_>>().join(" | "));
        self.body += "\n";
        self.body += &line(&mut headers.iter().map(|h| cell(h)));
        self.body += &line(&mut headers.iter().map(|_| "---".to_string()));
        for row in rows {
            let filled = row.iter().map(|text| cell(text)).chain(std::iter::repeat(String::new()));
            self.body += &line(&mut filled.take(headers.len()));
        }
    }

    /// Adds a table that compares published numbers with ours, and the number of those that agree.
    pub fn comparisons(&mut self, comparisons: &[Comparison]) {
        let agree = comparisons.iter().filter(|c| c.verdict() == Verdict::Agrees).count();
        self.text(&format!("{agree} of {} statements agree within their tolerance.", comparisons.len()));
        let rows: Vec<Vec<String>> = comparisons.iter().map(Comparison::cells).collect();
        self.table(&Comparison::HEADERS, &rows);
        for (number, note) in comparisons.iter().enumerate().filter(|(_, c)| !c.note.is_empty()) {
            self.text(&format!("Row {}: {}", number + 1, note.note));
        }
    }

    /// Adds the body of another report, without its title, at the end.
    pub fn append(&mut self, other: Report) {
        self.body += &other.body;
        self.figures.extend(other.figures);
    }

    /// The document as Markdown; figures are linked as files. Control characters are shown by their number.
    pub fn markdown(&self) -> String {
        printable(&format!("# {}\n{}", one_line(&self.title), self.body))
    }

    /// The document as one HTML page with the figures in it.
    pub fn html(&self) -> String {
        html::page(&printable(&self.title), &self.markdown(), &self.figures)
    }

    /// Writes `report.md`, `report.html` and the figures into a folder, and gives their paths.
    /// Each file appears whole or not at all.
    ///
    /// # Errors
    /// A folder or file that cannot be written.
    pub fn write(&self, folder: &Path) -> io::Result<Vec<PathBuf>> {
        let documents = [("report.md".to_string(), self.markdown()), ("report.html".to_string(), self.html())];
        let figures = self.figures.iter().map(|(name, svg)| (name.clone(), svg.clone()));
        let mut written = Vec::new();
        for (name, text) in figures.chain(documents) {
            let path = folder.join(name);
            write_whole(&path, text.as_bytes())?;
            written.push(path);
        }
        Ok(written)
    }
}

/// Writes a file in a hidden folder beside it and then moves it to its place, so that it is never incomplete and no other file is
/// touched. Missing folders are created.
///
/// # Errors
/// A path without a file name, or a folder or file that cannot be written.
pub fn write_whole(path: &Path, bytes: &[u8]) -> io::Result<()> {
    path.file_name().ok_or_else(|| io::Error::other("a file needs a name"))?;
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    fs::create_dir_all(folder)?;
    let aside = Aside::new_in(folder)?;
    let whole = aside.path().join("whole");
    fs::write(&whole, bytes)?;
    fs::rename(&whole, path)
}

/// External text as Markdown that shows it literally, in one line.
///
/// ```
/// assert_eq!(vibroimpact::report::literal("*a*\n[b](c)"), "\\*a\\* \\[b\\]\\(c\\)");
/// ```
pub fn literal(text: &str) -> String {
    let escape = |c: char| c.is_ascii_punctuation().then_some('\\').into_iter().chain([c]);
    one_line(text).chars().flat_map(escape).collect()
}

fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

fn cell(text: &str) -> String {
    one_line(text).replace('|', "\\|")
}

fn file_name(name: &str) -> String {
    name.chars().map(|c| if c.is_ascii_alphanumeric() || "-_.".contains(c) { c } else { '-' }).collect()
}

#[cfg(test)]
mod tests;
