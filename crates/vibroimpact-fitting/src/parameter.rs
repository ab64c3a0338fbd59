//! Parameters and their unrestricted coordinates.

use invalid_input::InvalidInput;

/// The numbers that a parameter may have. A restricted parameter is represented by a coordinate `u` without restriction, so
/// that no method can leave the range.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Range {
    /// Any number: `u = p`.
    Free,
    /// Greater than zero: `u = ln p`.
    Positive,
    /// Strictly between two numbers: `u = ln((p - low)/(high - p))`.
    Between {
        /// Lower end.
        low: f64,
        /// Upper end.
        high: f64,
    },
}

/// A parameter with its range and the interval that is searched.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Parameter {
    /// Name in messages.
    pub name: String,
    /// First starting point.
    pub start: f64,
    /// Allowed range.
    pub range: Range,
    /// Interval `(low, high)`, within the range, from which further starting points are taken; its length in `u`
    /// also sets the size of the first steps of the derivative-free method, and that of differences if it is below 1.
    pub search: (f64, f64),
}

/// Largest `|u|` of a transformed coordinate, at which `exp` neither overflows nor vanishes.
const LARGEST: f64 = 690.0;

impl Parameter {
    /// A parameter of any sign.
    pub fn free(name: &str, start: f64, search: (f64, f64)) -> Parameter {
        Parameter { name: name.into(), start, range: Range::Free, search }
    }

    /// A parameter greater than zero.
    pub fn positive(name: &str, start: f64, search: (f64, f64)) -> Parameter {
        Parameter { name: name.into(), start, range: Range::Positive, search }
    }

    /// Checks that the numbers are finite and that the start and the search interval are within the range.
    ///
    /// # Errors
    /// [`InvalidInput`] names the parameter and the part of it that is out of range.
    pub fn validate(&self) -> Result<(), InvalidInput> {
        let field = |part: &str| format!("parameter {} {part}", self.name);
        if let Range::Between { low, high } = self.range
            && !(low < high && (high - low).is_finite())
        {
            let allowed = "two finite numbers with low < high";
            return Err(InvalidInput::new(field("range"), format!("{low}..{high}"), allowed));
        }
        for (part, value) in [("start", self.start), ("search.0", self.search.0), ("search.1", self.search.1)] {
            let inside = match self.range {
                Range::Free => value.abs() <= 1e100,
                Range::Positive => (1e-100..=1e100).contains(&value),
                Range::Between { low, high } => value > low && value < high && self.inward(value).abs() < LARGEST,
            };
            if !inside {
                let allowed =
                    "a number within the parameter's range; a positive parameter lies between 1e-100 and 1e100";
                return Err(InvalidInput::new(field(part), value, allowed));
            }
        }
        if self.search.0 > self.search.1 {
            let value = format!("{}..{}", self.search.0, self.search.1);
            return Err(InvalidInput::new(field("search"), value, "an interval with low <= high"));
        }
        Ok(())
    }

    /// `u` of a parameter `p`. At an end of the range, which a search may reach by rounding, it is the largest coordinate.
    pub fn inward(&self, p: f64) -> f64 {
        match self.range {
            Range::Free => p,
            Range::Positive => p.ln().clamp(-LARGEST, LARGEST),
            Range::Between { low, high } => ((p - low) / (high - p)).ln().clamp(-LARGEST, LARGEST),
        }
    }

    /// The ends of the range.
    pub(crate) fn ends(&self) -> (f64, f64) {
        match self.range {
            Range::Free => (f64::NEG_INFINITY, f64::INFINITY),
            Range::Positive => (0.0, f64::INFINITY),
            Range::Between { low, high } => (low, high),
        }
    }

    /// The parameter at `u`.
    pub fn outward(&self, u: f64) -> f64 {
        let clamped = u.clamp(-LARGEST, LARGEST);
        match self.range {
            Range::Free => u,
            Range::Positive => clamped.exp(),
            Range::Between { low, high } => low + (high - low) / (1.0 + (-clamped).exp()),
        }
    }

    /// Size of a change of `u` that matters, where `u` itself is not larger: 1, or less for a free parameter with a short search interval.
    pub(crate) fn unit(&self) -> f64 {
        let length = self.search.1 - self.search.0;
        if self.range == Range::Free && length > 0.0 { length.min(1.0) } else { 1.0 }
    }

    /// `dp/du` at a parameter `p`.
    pub fn slope(&self, p: f64) -> f64 {
        match self.range {
            Range::Free => 1.0,
            Range::Positive => p,
            Range::Between { low, high } => (p - low) * ((high - p) / (high - low)),
        }
    }
}
