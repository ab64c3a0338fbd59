//! Error against time and cost of every solver of the workspace and of its peers.
//!
//! `cargo xtask work-precision` runs this package; see `docs/work-precision.md` for the results.
//!
//! | module | problems |
//! |---|---|
//! | [`impact`] | a ball on a beam in its modes (thesis chapters 3 and 4) |
//! | [`infinite`] | a ball on an infinite beam (chapter 2) |
//! | [`modes`] | frequencies of stepped beams (chapter 4) |
//! | [`net`] | EMOC (chapters 5 and 6) |
//! | [`fractional`] | fractional test equations |
//!
//! [`measure`] times one run, [`compare`] interpolates times at equal error in the sweeps, [`report`] and [`figures`] present.

pub mod compare;
pub mod export;
pub mod figures;
pub mod fractional;
pub mod impact;
pub mod infinite;
pub mod machine;
pub mod measure;
pub mod modes;
pub mod net;
pub mod notes;
pub mod outside;
pub mod report;

use measure::{Effort, Row};

/// Every row of the library whose problem's name contains `only`; `progress` receives the name of each part before it starts.
///
/// # Errors
/// If a reference is missing or a problem cannot be built.
pub fn run(only: Option<&str>, effort: &Effort, progress: impl Fn(&str)) -> Result<Vec<Row>, String> {
    let wanted = |name: &str| only.is_none_or(|only| name.contains(only));
    let mut rows = Vec::new();
    for impact in impact::library()?.iter().filter(|impact| wanted(impact.name)) {
        progress(impact.name);
        rows.extend(impact::rows(impact, effort)?);
    }
    let family = |prefix: &str| only.is_none_or(|only| only.starts_with(prefix) || prefix.contains(only));
    if family("beam-S") {
        progress("infinite beam");
        rows.extend(infinite::rows(effort)?);
    }
    if family("stepped-modes") {
        progress("modes of stepped beams");
        rows.extend(modes::rows(effort)?);
    }
    if family("emoc") {
        progress("EMOC");
        rows.extend(net::rows(effort));
    }
    if family("fractional") {
        progress("fractional test equations");
        rows.extend(fractional::rows(effort));
    }
    rows.retain(|row| wanted(&row.problem));
    Ok(rows)
}

/// The rows as CSV.
///
/// # Errors
/// If a row cannot be written.
pub fn table(rows: &[Row]) -> Result<String, String> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    for row in rows {
        writer.serialize(row).map_err(|error| error.to_string())?;
    }
    let bytes = writer.into_inner().map_err(|error| error.to_string())?;
    String::from_utf8(bytes).map_err(|error| error.to_string())
}
