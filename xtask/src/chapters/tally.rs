//! Statements as rows of `statements.csv` and as tables of reports and pages, and counts of their verdicts.

use super::statement::{Kind, Statement, Verdict};
use serde::{Deserialize, Serialize};
use tasks::Failure;
use vibroimpact::report::{Report, significant};

/// One statement in `statements.csv`; numbers in the unit that the quantity names.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Chapter of the thesis to which the statement belongs here.
    pub chapter: u32,
    /// What kind of statement it is.
    pub kind: Kind,
    /// The compared quantity.
    pub quantity: String,
    /// Section, table or figure of the statement.
    pub source: String,
    /// The statement as printed.
    pub stated: String,
    /// Our number.
    pub ours: f64,
    /// Uncertainty of our number.
    pub uncertainty: f64,
    /// Our number minus the stated one, or the distance of our number from the limits.
    pub difference: f64,
    /// The tolerance.
    pub tolerance: String,
    /// Reason for the tolerance.
    pub reason: String,
    /// The verdict.
    pub verdict: Verdict,
    /// Information that is missing for a verdict.
    pub missing: String,
    /// An explanation.
    pub note: String,
}

impl Row {
    /// The row of a statement.
    pub fn new(chapter: u32, statement: &Statement) -> Row {
        Row {
            chapter,
            kind: statement.kind,
            quantity: statement.quantity.clone(),
            source: statement.source.clone(),
            stated: statement.stated.clone(),
            ours: statement.ours,
            uncertainty: statement.uncertainty,
            difference: statement.difference(),
            tolerance: statement.tolerance(),
            reason: statement.reason.clone(),
            verdict: statement.verdict(),
            missing: statement.missing.clone(),
            note: statement.note.clone(),
        }
    }

    /// Our number with the digits that a comparison with the statement needs.
    pub fn ours(&self) -> String {
        significant(self.ours, if self.kind == Kind::PrintedNumber { 7 } else { 5 })
    }

    fn cells(&self) -> Vec<String> {
        let ours = match self.uncertainty {
            0.0 => self.ours(),
            uncertainty => format!("{} ± {}", self.ours(), significant(uncertainty, 1)),
        };
        vec![
            self.quantity.clone(),
            self.source.clone(),
            self.stated.clone(),
            ours,
            self.tolerance.clone(),
            self.reason.clone(),
            self.verdict.marked().to_owned(),
        ]
    }

    /// Remarks below the table; may be empty.
    fn remark(&self) -> String {
        let missing =
            if self.missing.is_empty() { String::new() } else { format!("The text does not state {}.", self.missing) };
        let parts: Vec<&str> = [missing.as_str(), &self.note].into_iter().filter(|part| !part.is_empty()).collect();
        parts.join(" ")
    }
}

/// How many statements of a kind have which verdict.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Tally([[usize; Verdict::ALL.len()]; Kind::ALL.len()]);

impl Tally {
    /// Counts.
    pub fn of<'a>(rows: impl IntoIterator<Item = &'a Row>) -> Tally {
        let mut tally = Tally::default();
        for row in rows {
            tally.0[row.kind as usize][row.verdict as usize] += 1;
        }
        tally
    }

    /// Number of statements of a kind.
    pub fn all(&self, kind: Kind) -> usize {
        self.0[kind as usize].iter().sum()
    }

    /// Number of statements of a kind with a verdict.
    pub fn with(&self, kind: Kind, verdict: Verdict) -> usize {
        self.0[kind as usize][verdict as usize]
    }

    /// The headline: counts of each kind of statement that could fail, followed by the kinds that could not.
    pub fn headline(&self) -> String {
        let told = |kind: Kind| {
            let verdicts = Verdict::ALL.into_iter().filter(|verdict| self.with(kind, *verdict) > 0);
            let counts: Vec<String> = verdicts
                .map(|verdict| {
                    let plural = |one: &'static str, many: &'static str| match self.with(kind, verdict) {
                        1 => one,
                        _ => many,
                    };
                    let word = match verdict {
                        Verdict::Agrees => plural("agrees", "agree"),
                        Verdict::Differs => plural("differs", "differ"),
                        Verdict::Indecisive => plural("is indecisive", "are indecisive"),
                        Verdict::Undecidable => "cannot be decided from the text",
                    };
                    format!("{} {word}", self.with(kind, verdict))
                })
                .collect();
            format!("{} ({}): {}", kind.title(), self.all(kind), counts.join(", "))
        };
        let [could, could_not]: [Vec<String>; 2] = [true, false].map(|can_fail| {
            let chosen = Kind::ALL.into_iter().filter(|kind| kind.can_fail() == can_fail && self.all(*kind) > 0);
            chosen.map(told).collect()
        });
        let mut parts = could;
        if !could_not.is_empty() {
            parts.push(format!(
                "Not counted, because only an error of ours could make them fail: {}",
                could_not.join("; ")
            ));
        }
        format!("{}.", parts.join(". "))
    }
}

/// Adds the statements to a report: the headline, a table for each kind, and the remarks.
pub fn tell(report: &mut Report, rows: &[Row]) {
    report.text(&Tally::of(rows).headline());
    for kind in Kind::ALL {
        let chosen: Vec<&Row> = rows.iter().filter(|row| row.kind == kind).collect();
        if chosen.is_empty() {
            continue;
        }
        report.text(&format!("**{}**", kind.title()));
        let cells: Vec<Vec<String>> = chosen.iter().map(|row| row.cells()).collect();
        report.table(&["quantity", "where", "thesis", "ours", "tolerance", "why this tolerance", "verdict"], &cells);
        // a remark that applies to several rows is written once
        let mut remarks: Vec<(String, Vec<&str>)> = Vec::new();
        for row in chosen {
            let remark = row.remark();
            match remarks.iter_mut().find(|(text, _)| *text == remark) {
                Some((_, quantities)) => quantities.push(&row.quantity),
                None if !remark.is_empty() => remarks.push((remark, vec![&row.quantity])),
                None => {}
            }
        }
        let remarks: Vec<String> = remarks.into_iter().map(|(text, of)| format!("*{}*: {text}", told(&of))).collect();
        if !remarks.is_empty() {
            report.list(&remarks);
        }
    }
}

/// The first of some quantities, and how many more there are.
fn told(quantities: &[&str]) -> String {
    let first = quantities.first().copied().unwrap_or_default();
    match quantities.len() {
        0 | 1 => first.to_owned(),
        n => format!("{first}, and {} more", n - 1),
    }
}

/// Writes the table of all statements as CSV.
///
/// # Errors
/// Errors of the writer.
pub fn csv(rows: &[Row]) -> Result<Vec<u8>, Failure> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    for row in rows {
        writer.serialize(row)?;
    }
    Ok(writer.into_inner()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows() -> Vec<Row> {
        let printed = |ours: f64| Statement::printed("a", "1", "1.5", ours);
        let trend = |ours: f64| Statement::trend("b", "2", "rises", (0.0, 1.0), "any rise", ours);
        let statements = [
            printed(1.5),
            printed(1.6).note("A slip."),
            trend(0.5),
            trend(0.5).missing("the scale"),
            Statement::identity("c", ["3", "equal", "rounding"], (0.0, 1e-9), 0.0),
        ];
        statements.iter().map(|statement| Row::new(2, statement)).collect()
    }

    #[test]
    fn the_headline_counts_what_could_fail_kind_by_kind() {
        let headline = Tally::of(&rows()).headline();
        assert_eq!(
            headline,
            "Printed numbers (2): 1 agrees, 1 differs. Trends (2): 1 agrees, 1 cannot be decided from the text. \
             Not counted, because only an error of ours could make them fail: Identities (1): 1 agrees."
        );
    }

    #[test]
    fn a_wrong_number_turns_the_headline() {
        let mut wrong = rows();
        wrong[0] = Row::new(2, &Statement::printed("a", "1", "1.5", 1.56));
        assert!(Tally::of(&wrong).headline().starts_with("Printed numbers (2): 2 differ."));
    }

    #[test]
    fn tables_show_tolerance_reason_and_verdict() {
        let mut report = Report::new("");
        tell(&mut report, &rows());
        let text = report.markdown();
        assert!(text.contains("| a | 1 | 1.5 | 1.6 | ± 0.05 | half a unit of the last digit | ✗ differs |"));
        assert!(text.contains("- *a*: A slip.") && text.contains("- *b*: The text does not state the scale."));
    }

    #[test]
    fn rows_come_back_from_the_file() {
        let bytes = csv(&rows()).unwrap();
        let back: Vec<Row> = ::csv::Reader::from_reader(bytes.as_slice()).deserialize().map(Result::unwrap).collect();
        assert_eq!(back, rows());
    }
}
