//! The pages of the chapters (`docs/chapters`): their tables are made from `statements.csv` beside them, which is that of
//! a run of all chapters, and their figures are those of the run.

use crate::chapters::{CHAPTERS, Failure, run_all};
use serde::Deserialize;
use std::fs;
use std::path::{Path, PathBuf};
use vibroimpact::report::{Report, significant, write_whole};

/// Between these two lines of a page stands its table.
const BEGIN: &str = "<!-- from statements.csv; `cargo xtask book --write` writes it -->";
const END: &str = "<!-- end -->";
/// A page's figures are linked so, followed by the chapter's number, a hyphen and the run's name of the figure.
const FIGURE: &str = "(../figures/chapter-";
/// Two runs agree to this share of a number, or to this in total: differences between solvers near rounding are among
/// the numbers, and machines round differently.
const SHARE: f64 = 1e-4;
const TOTAL: f64 = 1e-7;

/// What the pages need of a row of `statements.csv`.
#[derive(Debug, Clone, PartialEq, Deserialize)]
struct Statement {
    chapter: u32,
    quantity: String,
    source: String,
    stated: String,
    ours: f64,
    agrees: bool,
}

fn folder(root: &Path) -> PathBuf {
    root.join("docs/chapters")
}

fn statements(path: &Path) -> Result<Vec<Statement>, Failure> {
    Ok(csv::Reader::from_path(path)?.deserialize().collect::<Result<_, _>>()?)
}

/// Runs all chapters and writes table and figures of every page.
pub fn write(root: &Path) -> Result<(), Failure> {
    let run = tempfile::tempdir()?;
    run_all(run.path(), false, None)?;
    let table = folder(root).join("statements.csv");
    write_whole(&table, &fs::read(run.path().join("statements.csv"))?)?;
    let all = statements(&table)?;
    for chapter in CHAPTERS {
        let path = folder(root).join(format!("chapter-{chapter}.md"));
        let page = fs::read_to_string(&path)?;
        write_whole(&path, with_table(&page, &of(&all, chapter))?.as_bytes())?;
        for name in figures(&page, chapter) {
            let svg = fs::read(run.path().join(format!("chapter-{chapter}/figures/{name}")))?;
            write_whole(&root.join(format!("docs/figures/chapter-{chapter}-{name}")), &svg)?;
        }
    }
    Ok(())
}

/// Checks that the pages' tables are those of `statements.csv`, and that a run of all chapters still gives its numbers.
pub fn check(root: &Path) -> Result<(), Failure> {
    tables_are_current(root)?;
    let run = tempfile::tempdir()?;
    run_all(run.path(), false, None)?;
    let found = statements(&run.path().join("statements.csv"))?;
    let faults = differences(&statements(&folder(root).join("statements.csv"))?, &found);
    if faults.is_empty() { Ok(()) } else { Err(faults.join("\n").into()) }
}

fn tables_are_current(root: &Path) -> Result<(), Failure> {
    let all = statements(&folder(root).join("statements.csv"))?;
    for chapter in CHAPTERS {
        let page = fs::read_to_string(folder(root).join(format!("chapter-{chapter}.md")))?;
        if with_table(&page, &of(&all, chapter))? != page {
            return Err(
                format!("docs/chapters/chapter-{chapter}.md is not what `cargo xtask book --write` makes").into()
            );
        }
    }
    Ok(())
}

/// What of a run is not as recorded.
fn differences(recorded: &[Statement], found: &[Statement]) -> Vec<String> {
    if recorded.len() != found.len() {
        return vec![format!("statements.csv has {} rows, a run gives {}", recorded.len(), found.len())];
    }
    let same = |a: &Statement, b: &Statement| {
        let close = (a.ours - b.ours).abs() <= TOTAL + SHARE * a.ours.abs();
        close && Statement { ours: a.ours, ..b.clone() } == *a
    };
    let pairs = recorded.iter().zip(found).filter(|(a, b)| !same(a, b));
    pairs.map(|(a, b)| format!("statements.csv has {a:?}, a run gives {b:?}")).collect()
}

fn of(all: &[Statement], chapter: u32) -> Vec<Statement> {
    all.iter().filter(|statement| statement.chapter == chapter).cloned().collect()
}

/// The page with its table made anew.
fn with_table(page: &str, statements: &[Statement]) -> Result<String, Failure> {
    let parts = page.split_once(BEGIN).and_then(|(before, rest)| Some((before, rest.split_once(END)?.1)));
    let (before, after) = parts.ok_or_else(|| format!("the page has no lines `{BEGIN}` and `{END}`"))?;
    Ok(format!("{before}{BEGIN}\n\n{}\n{END}{after}", table(statements)))
}

fn table(statements: &[Statement]) -> String {
    let mut table = Report::new("");
    let agree = statements.iter().filter(|statement| statement.agrees).count();
    table.text(&format!("{agree} of {} statements agree within their tolerance.", statements.len()));
    let row = |statement: &Statement| {
        let Statement { quantity, source, stated, ours, agrees, .. } = statement.clone();
        vec![quantity, source, stated, significant(ours, 5), if agrees { "✓" } else { "✗" }.to_owned()]
    };
    let rows: Vec<_> = statements.iter().map(row).collect();
    table.table(&["quantity", "where", "thesis", "ours", ""], &rows);
    let markdown = table.markdown();
    markdown.trim_start_matches(['#', ' ', '\n']).to_owned()
}

/// Names, in the run, of the figures that a page shows.
fn figures(page: &str, chapter: u32) -> Vec<&str> {
    let beginning = format!("{FIGURE}{chapter}-");
    page.split(&beginning).skip(1).filter_map(|rest| rest.split(')').next()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn statement(ours: f64) -> Statement {
        let text = str::to_owned;
        Statement { chapter: 2, quantity: text("S"), source: text("2.5"), stated: text("1.559"), ours, agrees: true }
    }

    #[test]
    fn the_pages_show_the_recorded_numbers() {
        tables_are_current(Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap()).unwrap();
    }

    #[test]
    fn a_table_is_replaced_and_nothing_else() {
        let page = format!("# A\n\n{BEGIN}\nold\n{END}\n\nend\n");
        let new = with_table(&page, &[statement(1.560_52)]).unwrap();
        assert!(new.starts_with("# A\n") && new.ends_with("\n\nend\n") && !new.contains("old"));
        assert!(new.contains("| S | 2.5 | 1.559 | 1.5605 | ✓ |") && new.contains("1 of 1 statements"));
        assert_eq!(with_table(&new, &[statement(1.560_52)]).unwrap(), new);
        assert!(with_table("# A\n", &[]).is_err());
    }

    #[test]
    fn a_number_that_moved_is_found() {
        let recorded = [statement(1.5)];
        assert!(differences(&recorded, &[statement(1.5 + 1e-5)]).is_empty());
        assert_eq!(differences(&recorded, &[statement(1.501)]).len(), 1);
        assert_eq!(differences(&recorded, &[Statement { agrees: false, ..statement(1.5) }]).len(), 1);
        assert_eq!(differences(&recorded, &[]).len(), 1);
    }

    #[test]
    fn figures_are_named_as_in_the_run() {
        assert_eq!(
            figures("![a](../figures/chapter-2-fig-2-03.svg) ![b](../figures/chapter-3-x.svg)", 2),
            ["fig-2-03.svg"]
        );
    }
}
