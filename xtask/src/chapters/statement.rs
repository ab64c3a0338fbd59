//! Comparison of a statement of the thesis with our number: the kind of the statement, the tolerance with its reason, and the
//! verdict.

use serde::{Deserialize, Serialize};
use vibroimpact::report::{Comparison, Expected, significant};

/// Kind of a statement, which determines how significant an agreement is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Kind {
    /// A number as printed, held to half a unit of its last digit.
    #[serde(rename = "printed number")]
    PrintedNumber,
    /// A number in words, such as "about 0.95".
    #[serde(rename = "loose number")]
    LooseNumber,
    /// A statement on a figure or table without a number.
    #[serde(rename = "trend")]
    Trend,
    /// A consequence of the equations alone, which only an error of ours could contradict.
    #[serde(rename = "identity")]
    Identity,
    /// A check of our own method or of our own choice, where the text describes a check of the thesis's.
    #[serde(rename = "self-check")]
    SelfCheck,
}

impl Kind {
    /// All kinds, in the order in which they are reported.
    pub const ALL: [Kind; 5] = [Kind::PrintedNumber, Kind::LooseNumber, Kind::Trend, Kind::Identity, Kind::SelfCheck];

    /// As a heading of a table.
    pub const fn title(self) -> &'static str {
        match self {
            Kind::PrintedNumber => "Printed numbers",
            Kind::LooseNumber => "Loose numbers",
            Kind::Trend => "Trends",
            Kind::Identity => "Identities",
            Kind::SelfCheck => "Self-checks",
        }
    }

    /// Whether the statement could be wrong, so that an agreement is significant.
    pub const fn can_fail(self) -> bool {
        matches!(self, Kind::PrintedNumber | Kind::LooseNumber | Kind::Trend)
    }
}

/// Result of comparing the two numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Verdict {
    /// Our number lies within the tolerance, its own uncertainty included.
    #[serde(rename = "agrees")]
    Agrees,
    /// Our number lies outside the tolerance, or there is none.
    #[serde(rename = "differs")]
    Differs,
    /// Our number neither confirms nor refutes the statement: the limit lies within its uncertainty, or it lies between the values
    /// that the words certainly mean and those that they cannot mean.
    #[serde(rename = "indecisive")]
    Indecisive,
    /// The verdict depends on something that the text does not state.
    #[serde(rename = "cannot be decided from the text")]
    Undecidable,
}

impl Verdict {
    /// All verdicts, in the order in which they are reported.
    pub const ALL: [Verdict; 4] = [Verdict::Agrees, Verdict::Differs, Verdict::Indecisive, Verdict::Undecidable];

    /// The verdict with a symbol.
    pub const fn marked(self) -> &'static str {
        match self {
            Verdict::Agrees => "✓ agrees",
            Verdict::Differs => "✗ differs",
            Verdict::Indecisive => "~ indecisive",
            Verdict::Undecidable => "? cannot be decided from the text",
        }
    }
}

/// The statement expressed in numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Bounds {
    /// A number and its tolerance.
    Near { value: f64, tolerance: f64 },
    /// Anything between two limits, both included; an infinite one is no limit.
    Within { low: f64, high: f64 },
    /// As `Within`, but a number outside those limits and within `open` does not refute the statement.
    Graded { low: f64, high: f64, open: (f64, f64) },
    /// The share of equally plausible choices in which the statement holds.
    Choices,
}

/// Limits of any increase and of any decrease.
pub const RISES: (f64, f64) = (f64::MIN_POSITIVE, f64::INFINITY);
/// See [`RISES`].
pub const FALLS: (f64, f64) = (f64::NEG_INFINITY, -f64::MIN_POSITIVE);

/// Share of the choices from which on a statement that depends on a choice counts as confirmed. It counts as refuted if the same
/// share contradicts it.
const MOST: f64 = 0.9;
const FEW: f64 = 0.1;

/// A statement of the thesis, our number, and the data for the verdict.
#[derive(Debug, Clone, PartialEq)]
pub struct Statement {
    /// What kind of statement it is.
    pub kind: Kind,
    /// The compared quantity with its unit.
    pub quantity: String,
    /// Section, table or figure of the statement.
    pub source: String,
    /// The statement as printed.
    pub stated: String,
    bounds: Bounds,
    /// Reason for the tolerance.
    pub reason: String,
    /// Our number.
    pub ours: f64,
    /// Uncertainty of our number, in its unit.
    pub uncertainty: f64,
    /// Information that the verdict would need and the text does not contain; empty if nothing is missing.
    pub missing: String,
    /// An explanation; may be empty.
    pub note: String,
}

impl Statement {
    /// A printed decimal number, such as `0.11027` or `1.7945e10`, with a tolerance of half a unit of its last digit. A text that
    /// is not a number never agrees.
    pub fn printed(quantity: impl Into<String>, source: &str, printed: &str, ours: f64) -> Statement {
        let read = Comparison::printed("", source, printed, ours);
        let bounds = match read.expected {
            Expected::Value { value, tolerance } => Bounds::Near { value, tolerance },
            Expected::Range { low, high } => Bounds::Within { low, high },
        };
        let (kind, reason) = (Kind::PrintedNumber, "half a unit of the last digit");
        Statement::new(kind, quantity.into(), [source, &read.stated, reason], bounds, ours)
    }

    /// A number in words, with the tolerance that the words allow.
    pub fn loose(
        quantity: impl Into<String>,
        source: &str,
        words: &str,
        (value, tolerance): (f64, f64),
        reason: &str,
        ours: f64,
    ) -> Statement {
        let bounds = Bounds::Near { value, tolerance };
        Statement::new(Kind::LooseNumber, quantity.into(), [source, words, reason], bounds, ours)
    }

    /// A statement without a number, which is confirmed by a number of ours between two limits.
    pub fn trend(
        quantity: impl Into<String>,
        source: &str,
        words: &str,
        limits: (f64, f64),
        reason: &str,
        ours: f64,
    ) -> Statement {
        Statement::within(Kind::Trend, quantity, [source, words, reason], limits, ours)
    }

    /// A statement that only an error of ours could contradict. `texts` are location, wording and reason of the tolerance.
    pub fn identity(quantity: impl Into<String>, texts: [&str; 3], limits: (f64, f64), ours: f64) -> Statement {
        Statement::within(Kind::Identity, quantity, texts, limits, ours)
    }

    /// A check of our own. `texts` are location, wording and reason of the tolerance.
    pub fn self_check(quantity: impl Into<String>, texts: [&str; 3], limits: (f64, f64), ours: f64) -> Statement {
        Statement::within(Kind::SelfCheck, quantity, texts, limits, ours)
    }

    /// A trend that depends on parameters that the text does not state. It holds in `holds` of `of` plausible choices.
    pub fn choices(quantity: impl Into<String>, source: &str, words: &str, (holds, of): (usize, usize)) -> Statement {
        let reason = "confirmed if it holds in nine of ten choices, refuted if it fails in nine of ten; otherwise the \
                      choice decides";
        let share = holds as f64 / of as f64;
        let texts = [source, words, reason];
        Statement::new(Kind::Trend, quantity.into(), texts, Bounds::Choices, share)
            .note(format!("It holds in {holds} of {of} choices."))
    }

    fn within(
        kind: Kind,
        quantity: impl Into<String>,
        texts: [&str; 3],
        (low, high): (f64, f64),
        ours: f64,
    ) -> Statement {
        Statement::new(kind, quantity.into(), texts, Bounds::Within { low, high }, ours)
    }

    fn new(kind: Kind, quantity: String, texts: [&str; 3], bounds: Bounds, ours: f64) -> Statement {
        let [source, stated, reason] = texts.map(str::to_owned);
        let (missing, note) = (String::new(), String::new());
        Statement { kind, quantity, source, stated, bounds, reason, ours, uncertainty: 0.0, missing, note }
    }

    /// Adds an explanation.
    #[must_use]
    pub fn note(mut self, note: impl AsRef<str>) -> Statement {
        if !self.note.is_empty() {
            self.note.push(' ');
        }
        self.note += note.as_ref();
        self
    }

    /// States the uncertainty of our number.
    #[must_use]
    pub fn uncertain(mut self, uncertainty: f64) -> Statement {
        self.uncertainty = uncertainty;
        self
    }

    /// States wider limits, within which a number does not refute the statement even if it does not confirm it.
    #[must_use]
    pub fn open(mut self, open: (f64, f64)) -> Statement {
        if let Bounds::Within { low, high } = self.bounds {
            self.bounds = Bounds::Graded { low, high, open };
        }
        self
    }

    /// Tightens the tolerance of a printed number to less than half a unit of its last digit.
    #[must_use]
    pub fn held_to(mut self, tolerance: f64, reason: &str) -> Statement {
        if let Bounds::Near { value, tolerance: half } = self.bounds {
            self.bounds = Bounds::Near { value, tolerance: tolerance.min(half) };
            self.reason = reason.to_owned();
        }
        self
    }

    /// States which information is missing for a verdict.
    #[must_use]
    pub fn missing(mut self, what: &str) -> Statement {
        self.missing = what.to_owned();
        self
    }

    /// Our number minus the stated one; for limits, the distance of our number from them (0 inside).
    pub fn difference(&self) -> f64 {
        match self.bounds {
            Bounds::Near { value, .. } => self.ours - value,
            Bounds::Within { low, high } | Bounds::Graded { low, high, .. } => outside(self.ours, low, high),
            Bounds::Choices => outside(self.ours, MOST, 1.0),
        }
    }

    /// The difference in units of the tolerance, for a statement with a number.
    pub fn deviation(&self) -> Option<f64> {
        match self.bounds {
            Bounds::Near { value, tolerance } => Some((self.ours - value) / tolerance),
            _ => None,
        }
    }

    /// The verdict. A number that is not finite differs.
    pub fn verdict(&self) -> Verdict {
        let between =
            |low, high| Statement::judge((self.ours - self.uncertainty, self.ours + self.uncertainty), low, high);
        if !self.ours.is_finite() {
            return Verdict::Differs;
        }
        if !self.missing.is_empty() {
            return Verdict::Undecidable;
        }
        match self.bounds {
            Bounds::Near { value, tolerance } => {
                // rounding of this subtraction must not decide the verdict
                let allowed = tolerance + 4.0 * f64::EPSILON * value.abs();
                between(value - allowed, value + allowed)
            }
            Bounds::Within { low, high } => between(low, high),
            Bounds::Graded { low, high, open } => match (between(low, high), between(open.0, open.1)) {
                (Verdict::Differs, Verdict::Agrees | Verdict::Indecisive) => Verdict::Indecisive,
                (verdict, _) => verdict,
            },
            Bounds::Choices if self.ours >= MOST => Verdict::Agrees,
            Bounds::Choices if self.ours <= FEW => Verdict::Differs,
            Bounds::Choices => Verdict::Undecidable,
        }
    }

    /// Compares the interval of our number and its uncertainty with two limits.
    fn judge((from, to): (f64, f64), low: f64, high: f64) -> Verdict {
        if from >= low && to <= high {
            Verdict::Agrees
        } else if to < low || from > high || low.is_nan() || high.is_nan() {
            Verdict::Differs
        } else {
            Verdict::Indecisive
        }
    }

    /// The tolerance in words.
    pub fn tolerance(&self) -> String {
        match self.bounds {
            Bounds::Near { tolerance, .. } => format!("± {}", significant(tolerance, 2)),
            Bounds::Within { low, high } => limits(low, high),
            Bounds::Graded { low, high, open } => {
                format!("{}; open: {}", limits(low, high), limits(open.0, open.1))
            }
            Bounds::Choices => limits(MOST, f64::INFINITY),
        }
    }
}

fn outside(ours: f64, low: f64, high: f64) -> f64 {
    if ours < low {
        ours - low
    } else if ours > high {
        ours - high
    } else {
        0.0 * ours
    }
}

/// Two limits in words.
pub(super) fn limits(low: f64, high: f64) -> String {
    match (low, high) {
        RISES => "> 0".to_owned(),
        FALLS => "< 0".to_owned(),
        (_, f64::INFINITY) => format!("≥ {}", significant(low, 3)),
        (f64::NEG_INFINITY, _) => format!("≤ {}", significant(high, 3)),
        _ if low == high => format!("= {}", significant(low, 3)),
        _ => format!("{} to {}", significant(low, 6), significant(high, 6)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn printed(text: &str, ours: f64) -> Verdict {
        Statement::printed("q", "s", text, ours).verdict()
    }

    #[test]
    fn a_printed_number_is_held_to_half_a_unit_of_its_last_digit() {
        assert_eq!(printed("0.0146", 0.014_548), Verdict::Differs);
        assert_eq!(printed("0.0145", 0.014_548), Verdict::Agrees);
        assert_eq!(printed("3.528e4", 35_264.3), Verdict::Differs);
        assert_eq!(printed("3.53e4", 35_264.3), Verdict::Agrees);
        assert_eq!(printed("6.030", 6.029_53), Verdict::Agrees);
        assert_eq!(printed("4", 5.0), Verdict::Differs);
        assert_eq!(printed("1600", 1600.0), Verdict::Agrees);
        assert_eq!(printed("none", 0.0), Verdict::Differs);
        assert_eq!(printed("1.5", f64::NAN), Verdict::Differs);
        let exact = Statement::printed("q", "s", "1", 1.1);
        assert_eq!(exact.verdict(), Verdict::Agrees);
        assert_eq!(exact.clone().held_to(1e-3, "exact").verdict(), Verdict::Differs);
        assert_eq!(Statement::printed("q", "s", "1.5", 1.6).held_to(9.0, "no").verdict(), Verdict::Differs);
    }

    #[test]
    fn a_number_decides_only_beyond_its_own_uncertainty() {
        let about = |ours: f64| {
            Statement::loose("q", "s", "about 0.95", (0.95, 0.005), "its last digit", ours).uncertain(0.002).verdict()
        };
        let found = [0.95, 0.954, 0.956, 0.96].map(about);
        assert_eq!(found, [Verdict::Agrees, Verdict::Indecisive, Verdict::Indecisive, Verdict::Differs]);
    }

    #[test]
    fn between_what_words_mean_and_what_they_cannot_mean_nothing_is_decided() {
        let improved = |ours: f64| {
            Statement::trend("q", "s", "not improved", (0.7, f64::INFINITY), "", ours).open((0.5, f64::INFINITY))
        };
        let found = [1.2, 0.7, 0.55, 0.4].map(|ours| improved(ours).verdict());
        assert_eq!(found, [Verdict::Agrees, Verdict::Agrees, Verdict::Indecisive, Verdict::Differs]);
        assert_eq!(improved(0.6).tolerance(), "≥ 0.7; open: ≥ 0.5");
        assert_eq!(improved(0.6).uncertain(0.2).verdict(), Verdict::Indecisive);
    }

    #[test]
    fn choices_that_the_text_leaves_open_decide_when_nearly_all_agree() {
        let of = |holds: usize| Statement::choices("q", "s", "w", (holds, 30)).verdict();
        assert_eq!([30, 27, 26, 4, 3, 0].map(of), {
            use Verdict::{Agrees, Differs, Undecidable};
            [Agrees, Agrees, Undecidable, Undecidable, Differs, Differs]
        });
        assert_eq!(Statement::choices("q", "s", "w", (0, 0)).verdict(), Verdict::Differs);
    }

    #[test]
    fn what_the_text_does_not_say_is_not_decided() {
        let statement = Statement::trend("q", "s", "w", (0.0, 1.0), "r", 0.5);
        assert_eq!(statement.verdict(), Verdict::Agrees);
        assert_eq!(statement.missing("the scale").verdict(), Verdict::Undecidable);
    }

    #[test]
    fn a_number_a_little_wrong_turns_the_verdict_of_every_kind() {
        use Verdict::{Differs, Indecisive};
        type Make = fn(f64) -> Statement;
        let made: [(Make, [f64; 2], Verdict); 8] = [
            (|ours| Statement::printed("q", "s", "74.391", ours), [74.390_6, 74.390_4], Differs),
            (|ours| Statement::loose("q", "s", "about 70", (70.0, 5.0), "r", ours), [74.9, 75.1], Differs),
            (
                |ours| Statement::loose("q", "s", "about 70", (70.0, 5.0), "r", ours).uncertain(0.5),
                [74.4, 74.6],
                Indecisive,
            ),
            (|ours| Statement::trend("q", "s", "it falls", FALLS, "r", ours), [-1e-12, 0.0], Differs),
            (|ours| Statement::trend("q", "s", "it rises", RISES, "r", ours), [1e-12, 0.0], Differs),
            (
                |ours| Statement::trend("q", "s", "reduced", (0.0, 0.5), "r", ours).open((0.0, 0.7)),
                [0.49, 0.51],
                Indecisive,
            ),
            (|ours| Statement::identity("q", ["s", "equal", "r"], (0.0, 1e-9), ours), [0.9e-9, 1.1e-9], Differs),
            (|ours| Statement::self_check("q", ["s", "equal", "r"], (1.0, 1.0), ours), [1.0, 2.0], Differs),
        ];
        for (statement, [right, wrong], turned) in made {
            assert_eq!(statement(right).verdict(), Verdict::Agrees, "{:?}", statement(right));
            assert_eq!(statement(wrong).verdict(), turned, "{:?}", statement(wrong));
            assert_eq!(statement(f64::NAN).verdict(), Differs);
        }
    }

    #[test]
    fn a_deviation_counts_tolerances() {
        assert!((Statement::printed("q", "s", "74.391", 74.392).deviation().unwrap() - 2.0).abs() < 1e-9);
        assert_eq!(Statement::trend("q", "s", "it rises", RISES, "r", 1.0).deviation(), None);
    }

    #[test]
    fn limits_read_as_they_are_meant() {
        assert_eq!([limits(RISES.0, RISES.1), limits(FALLS.0, FALLS.1)], ["> 0", "< 0"]);
        assert_eq!([limits(0.5, f64::INFINITY), limits(1.0, 1.0), limits(0.0, 0.1)], ["≥ 0.5", "= 1", "0 to 0.1"]);
    }
}
