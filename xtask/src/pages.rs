//! The pages of the chapters (`docs/chapters`). Their tables are made from `statements.csv` in the same folder, which a run of all
//! chapters has written, and their figures come from the same run. These pages and the page on theories of bending may show
//! further tables of the run.

use crate::chapters::statement::Verdict;
use crate::chapters::tally::{Row, Tally, tell};
use crate::chapters::{Part, run_all};
use std::fs;
use std::path::{Path, PathBuf};
use tasks::Failure;
use vibroimpact::report::{Report, write_whole};

/// The table of a page is written between these two lines.
const BEGIN: &str = "<!-- from statements.csv; `cargo xtask book --write` writes it -->";
const END: &str = "<!-- end -->";
/// A further table is written between a line that begins like this and [`END`]. The line continues with the table's file.
const TABLE: &str = "<!-- table ";
/// Folder of the figures. A figure's name consists of the folder of its part, a hyphen and its name in the run.
const FIGURE: &str = "figures/";
/// Two runs agree if a number differs by at most this share or by at most this amount: some numbers are differences between
/// solvers near rounding, and machines round differently.
const SHARE: f64 = 1e-4;
const TOTAL: f64 = 1e-7;

/// Numbers of the chapters that have a page.
fn chapters() -> impl Iterator<Item = u32> {
    Part::ALL.into_iter().filter(|part| *part == Part::Chapter(part.chapter())).map(Part::chapter)
}

fn folder(root: &Path) -> PathBuf {
    root.join("docs/chapters")
}

fn chapter_page(root: &Path, chapter: u32) -> PathBuf {
    folder(root).join(format!("chapter-{chapter}.md"))
}

/// All pages that may show figures and tables of the run.
fn pages(root: &Path) -> impl Iterator<Item = PathBuf> {
    chapters().map(move |chapter| chapter_page(root, chapter)).chain([root.join("docs/theories-of-bending.md")])
}

fn statements(path: &Path) -> Result<Vec<Row>, Failure> {
    Ok(csv::Reader::from_path(path)?.deserialize().collect::<Result<_, _>>()?)
}

/// Runs all chapters and writes the tables and figures of every page.
pub fn write(root: &Path) -> Result<(), Failure> {
    let run = tempfile::tempdir()?;
    run_all(run.path(), false, None)?;
    let table = folder(root).join("statements.csv");
    write_whole(&table, &fs::read(run.path().join("statements.csv"))?)?;
    let all = statements(&table)?;
    let summary = summary_page(root);
    write_whole(&summary, with(&fs::read_to_string(&summary)?, &differing(&all))?.as_bytes())?;
    for chapter in chapters() {
        let path = chapter_page(root, chapter);
        write_whole(&path, with_table(&fs::read_to_string(&path)?, &of(&all, chapter))?.as_bytes())?;
    }
    for path in pages(root) {
        let page = fs::read_to_string(&path)?;
        write_whole(&path, with_tables_of(&page, run.path())?.as_bytes())?;
        for part in Part::ALL {
            let part = part.folder();
            for name in figures(&page, &part) {
                let svg = fs::read(run.path().join(format!("{part}/figures/{name}")))?;
                write_whole(&root.join(format!("docs/figures/{part}-{name}")), &svg)?;
            }
        }
    }
    Ok(())
}

/// The page on all chapters, with the headline and the list of differences.
fn summary_page(root: &Path) -> PathBuf {
    root.join("docs/reproduction.md")
}

/// Checks that the pages' tables are those of `statements.csv`, and that a run of all chapters still gives its numbers.
pub fn check(root: &Path) -> Result<(), Failure> {
    tables_are_current(root)?;
    let run = tempfile::tempdir()?;
    run_all(run.path(), false, None)?;
    let found = statements(&run.path().join("statements.csv"))?;
    let mut faults = differences(&statements(&folder(root).join("statements.csv"))?, &found);
    for path in pages(root) {
        let page = fs::read_to_string(&path)?;
        if with_tables_of(&page, run.path())? != page {
            faults.push(format!("a table of {} is not that of a run", path.display()));
        }
    }
    if faults.is_empty() { Ok(()) } else { Err(faults.join("\n").into()) }
}

fn tables_are_current(root: &Path) -> Result<(), Failure> {
    let all = statements(&folder(root).join("statements.csv"))?;
    let page = fs::read_to_string(summary_page(root))?;
    if with(&page, &differing(&all))? != page {
        return Err("docs/reproduction.md is not what `cargo xtask book --write` makes".into());
    }
    for chapter in chapters() {
        let page = fs::read_to_string(chapter_page(root, chapter))?;
        if with_table(&page, &of(&all, chapter))? != page {
            return Err(
                format!("docs/chapters/chapter-{chapter}.md is not what `cargo xtask book --write` makes").into()
            );
        }
    }
    Ok(())
}

/// Differences between a run and the recorded statements.
fn differences(recorded: &[Row], found: &[Row]) -> Vec<String> {
    if recorded.len() != found.len() {
        return vec![format!("statements.csv has {} rows, a run gives {}", recorded.len(), found.len())];
    }
    let close = |a: f64, b: f64| a == b || (a - b).abs() <= TOTAL + SHARE * a.abs();
    let same = |a: &Row, b: &Row| {
        let numbers = [(a.ours, b.ours), (a.uncertainty, b.uncertainty)];
        // verdicts and remarks that contain numbers may change with the numbers
        let Row { ours, uncertainty, difference, ref note, .. } = *a;
        let alike = Row { ours, uncertainty, difference, note: note.clone(), ..b.clone() };
        alike == *a && numbers.into_iter().all(|(a, b)| close(a, b))
    };
    let pairs = recorded.iter().zip(found).filter(|(a, b)| !same(a, b));
    pairs.map(|(a, b)| format!("statements.csv has {a:?}, a run gives {b:?}")).collect()
}

fn of(all: &[Row], chapter: u32) -> Vec<Row> {
    all.iter().filter(|statement| statement.chapter == chapter).cloned().collect()
}

/// The page with a new table of statements.
fn with_table(page: &str, statements: &[Row]) -> Result<String, Failure> {
    with(page, &table(statements))
}

/// The page with new text between the two lines.
fn with(page: &str, made: &str) -> Result<String, Failure> {
    let parts = page.split_once(BEGIN).and_then(|(before, rest)| Some((before, rest.split_once(END)?.1)));
    let (before, after) = parts.ok_or_else(|| format!("the page has no lines `{BEGIN}` and `{END}`"))?;
    Ok(format!("{before}{BEGIN}\n\n{made}\n{END}{after}"))
}

/// The page with new tables from the folder of a run.
fn with_tables_of(page: &str, run: &Path) -> Result<String, Failure> {
    let mut parts = page.split(TABLE);
    let mut made = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let named = part.split_once(" -->").and_then(|(name, rest)| Some((name, rest.split_once(END)?.1)));
        let (name, after) = named.ok_or_else(|| format!("the page has a line `{TABLE}` without ` -->` or `{END}`"))?;
        made += &format!("{TABLE}{name} -->\n\n{}\n{END}{after}", table_of_file(&run.join(name))?);
    }
    Ok(made)
}

/// A Markdown table of formatted cells.
fn table_of_file(path: &Path) -> Result<String, Failure> {
    let mut reader = csv::Reader::from_path(path)?;
    let headers: Vec<String> = reader.headers()?.iter().map(str::to_owned).collect();
    let cells = reader.records().map(|record| Ok(record?.iter().map(str::to_owned).collect()));
    let rows = cells.collect::<Result<Vec<Vec<String>>, Failure>>()?;
    let mut table = Report::new("");
    table.table(&headers.iter().map(String::as_str).collect::<Vec<_>>(), &rows);
    Ok(table.markdown().trim_start_matches(['#', ' ', '\n']).to_owned())
}

fn table(statements: &[Row]) -> String {
    let mut table = Report::new("");
    tell(&mut table, statements);
    table.markdown().trim_start_matches(['#', ' ', '\n']).to_owned()
}

/// The headline of all chapters, and the statements that differ.
fn differing(all: &[Row]) -> String {
    let mut page = Report::new("");
    page.text(&Tally::of(all).headline());
    let differ = all.iter().filter(|row| row.verdict == Verdict::Differs);
    let line = |row: &Row| {
        let texts = [&row.quantity, &row.source, &row.stated];
        [&row.chapter.to_string()].into_iter().chain(texts).chain([&row.ours()]).cloned().collect()
    };
    page.table(&["chapter", "quantity", "where", "the thesis", "ours"], &differ.map(line).collect::<Vec<_>>());
    page.markdown().trim_start_matches(['#', ' ', '\n']).to_owned()
}

/// Names of the figures that a page shows, as in the run.
fn figures<'a>(page: &'a str, part: &str) -> Vec<&'a str> {
    let beginning = format!("{FIGURE}{part}-");
    page.split(&beginning).skip(1).filter_map(|rest| rest.split(')').next()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chapters::statement::Statement;

    fn statement(ours: f64) -> Row {
        Row::new(2, &Statement::printed("S", "2.5", "1.56", ours))
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
        assert!(new.contains("| S | 2.5 | 1.56 | 1.56052 | ± 0.005 | half a unit of the last digit | ✓ agrees |"));
        assert!(new.contains("Printed numbers (1): 1 agrees."));
        assert_eq!(with_table(&new, &[statement(1.560_52)]).unwrap(), new);
        assert!(with_table("# A\n", &[]).is_err());
        assert!(differing(&[statement(1.57)]).contains("| 2 | S | 2.5 | 1.56 | 1.57 |"));
    }

    #[test]
    fn tables_of_a_run_are_replaced_where_they_stand() {
        let run = tempfile::tempdir().unwrap();
        fs::create_dir(run.path().join("theories")).unwrap();
        fs::write(run.path().join("theories/law.csv"), "beam,rms\npinned,0.05\n").unwrap();
        let page = format!("# A\n\n{TABLE}theories/law.csv -->\nold\n{END}\n\nend\n");
        let new = with_tables_of(&page, run.path()).unwrap();
        assert!(new.contains("| beam | rms |") && new.contains("| pinned | 0.05 |") && !new.contains("old"), "{new}");
        assert!(new.starts_with("# A\n") && new.ends_with(&format!("{END}\n\nend\n")));
        assert_eq!(with_tables_of(&new, run.path()).unwrap(), new);
        assert!(with_tables_of(&format!("{TABLE}absent.csv -->{END}"), run.path()).is_err());
        assert!(with_tables_of(&format!("{TABLE}theories/law.csv -->"), run.path()).is_err());
    }

    #[test]
    fn a_number_that_moved_is_found() {
        let recorded = [statement(1.5605)];
        assert!(differences(&recorded, &[statement(1.5605 + 1e-5)]).is_empty());
        assert_eq!(differences(&recorded, &[statement(1.561)]).len(), 1);
        // a changed verdict is a difference, however little the number changed
        assert_eq!(differences(&[statement(1.564_99)], &[statement(1.565_01)]).len(), 1);
        assert_eq!(differences(&recorded, &[]).len(), 1);
    }

    #[test]
    fn figures_are_named_as_in_the_run() {
        assert_eq!(
            figures("![a](../figures/chapter-2-fig-2-03.svg) ![b](figures/chapter-3-x.svg)", "chapter-2"),
            ["fig-2-03.svg"]
        );
    }
}
