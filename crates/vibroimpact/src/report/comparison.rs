//! Comparison of a published number with ours.

use crate::text::{significant, superscript};

/// The expected value from a publication.
#[derive(Debug, Clone, PartialEq)]
pub enum Expected {
    /// A number and its tolerance.
    Value {
        /// The number.
        value: f64,
        /// Largest difference that still agrees, in the unit of the number.
        tolerance: f64,
    },
    /// Anything between two limits, both included; an infinite one is no limit.
    Range {
        /// Lower limit.
        low: f64,
        /// Upper limit.
        high: f64,
    },
}

/// The outcome of a comparison.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// Our number lies within the tolerance.
    Agrees,
    /// Our number lies outside the tolerance, or one of the numbers is missing.
    Differs,
}

/// One published statement, our number, and the verdict.
#[derive(Debug, Clone, PartialEq)]
pub struct Comparison {
    /// The compared quantity with its unit.
    pub quantity: String,
    /// Section, table or figure of the statement.
    pub source: String,
    /// The statement as printed.
    pub stated: String,
    /// The statement expressed in numbers.
    pub expected: Expected,
    /// Our number.
    pub ours: f64,
    /// An explanation printed under the table; may be empty.
    pub note: String,
}

impl Comparison {
    pub(super) const HEADERS: [&'static str; 7] =
        ["quantity", "where", "stated", "ours", "difference", "tolerance", "verdict"];

    /// A printed decimal number, such as `0.11027` or `1.7945e10`. Half a unit of its last
    /// digit is allowed. A text that is not a number never agrees.
    pub fn printed(quantity: impl Into<String>, source: &str, printed: &str, ours: f64) -> Comparison {
        let value = printed.parse().unwrap_or(f64::NAN);
        let expected = Expected::Value { value, tolerance: 0.5 * last_digit(printed) };
        Comparison::new(quantity.into(), source, pretty(printed), expected, ours)
    }

    /// A number given loosely in words (`about 0.95`), with the tolerance that the words allow.
    pub fn about(
        quantity: impl Into<String>,
        source: &str,
        words: &str,
        value: f64,
        tolerance: f64,
        ours: f64,
    ) -> Self {
        Comparison::new(quantity.into(), source, words.into(), Expected::Value { value, tolerance }, ours)
    }

    /// A statement that our number lies between two limits.
    pub fn range(quantity: impl Into<String>, source: &str, words: &str, (low, high): (f64, f64), ours: f64) -> Self {
        Comparison::new(quantity.into(), source, words.into(), Expected::Range { low, high }, ours)
    }

    fn new(quantity: String, source: &str, stated: String, expected: Expected, ours: f64) -> Comparison {
        Comparison { quantity, source: source.into(), stated, expected, ours, note: String::new() }
    }

    /// Adds an explanation.
    #[must_use]
    pub fn note(mut self, note: impl Into<String>) -> Comparison {
        self.note = note.into();
        self
    }

    /// Our number minus the stated one; for limits, the distance of our number from them (0 inside).
    pub fn difference(&self) -> f64 {
        match self.expected {
            Expected::Value { value, .. } => self.ours - value,
            Expected::Range { low, high: _ } if self.ours < low => self.ours - low,
            Expected::Range { low: _, high } if self.ours > high => self.ours - high,
            Expected::Range { .. } => 0.0 * self.ours,
        }
    }

    /// Whether our number lies within the tolerance. A number that is not finite never does.
    pub fn verdict(&self) -> Verdict {
        let allowed = match self.expected {
            // rounding of this subtraction must not decide the verdict
            Expected::Value { value, tolerance } => tolerance + 4.0 * f64::EPSILON * value.abs(),
            Expected::Range { .. } => 0.0,
        };
        if self.difference().abs() <= allowed { Verdict::Agrees } else { Verdict::Differs }
    }

    pub(super) fn cells(&self) -> Vec<String> {
        let tolerance = match self.expected {
            Expected::Value { tolerance, .. } => format!("± {}", significant(tolerance, 2)),
            Expected::Range { low, high: f64::INFINITY } => format!("≥ {}", significant(low, 3)),
            Expected::Range { low: f64::NEG_INFINITY, high } => format!("≤ {}", significant(high, 3)),
            Expected::Range { low, high } => format!("{} to {}", significant(low, 3), significant(high, 3)),
        };
        let verdict = match self.verdict() {
            Verdict::Agrees => "✓ agrees",
            Verdict::Differs => "✗ differs",
        };
        let [ours, difference] = [significant(self.ours, 7), significant(self.difference(), 2)];
        vec![
            self.quantity.clone(),
            self.source.clone(),
            self.stated.clone(),
            ours,
            difference,
            tolerance,
            verdict.to_string(),
        ]
    }
}

/// Value of one unit in the last digit of a printed number.
fn last_digit(printed: &str) -> f64 {
    let (mantissa, exponent) = printed.split_once(['e', 'E']).unwrap_or((printed, "0"));
    let decimals = mantissa.split_once('.').map_or(0, |(_, fraction)| fraction.len());
    exponent.parse::<i32>().map_or(f64::NAN, |e| 10f64.powi(e - decimals as i32))
}

/// `1.7945e10` in typographic form.
fn pretty(printed: &str) -> String {
    match printed.split_once(['e', 'E']) {
        Some((mantissa, exponent)) => {
            format!("{mantissa}×10{}", exponent.parse().map_or(exponent.into(), superscript))
        }
        None => printed.into(),
    }
}
