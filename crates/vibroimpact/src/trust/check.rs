//! A figure with its limits, and what it says about a theory.

use serde::Serialize;

/// Whether a theory applies to an impact.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// Within the range of the theory.
    Within,
    /// Near its limits, or somewhat beyond.
    Doubtful,
    /// Outside its range.
    Outside,
}

invalid_input::names!(Verdict, "verdict", { Within: "within", Doubtful: "doubtful", Outside: "outside" });

/// One figure that shows whether a theory holds.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Check {
    /// Name of the check, from the table in [`trust`](super).
    pub check: &'static str,
    /// Within the theory's range, doubtful, or outside.
    pub verdict: Verdict,
    /// The figure, without a unit.
    pub value: f64,
    /// Limit up to which the theory holds, or from which on if `outside` is smaller.
    pub within: f64,
    /// Limit beyond which it does not hold.
    pub outside: f64,
    /// What the figure says, in a sentence.
    pub says: String,
}

impl Check {
    /// `limits` are those of the theory's range and of where it ends; their order shows which direction is better.
    pub(crate) fn new(check: &'static str, value: f64, limits: [f64; 2], says: String) -> Check {
        let [within, outside] = limits;
        let rises = outside > within;
        let beyond = |limit: f64| if rises { value > limit } else { value < limit };
        let verdict = match (beyond(within), beyond(outside)) {
            (false, _) => Verdict::Within,
            (true, false) => Verdict::Doubtful,
            (true, true) => Verdict::Outside,
        };
        Check { check, verdict, value, within, outside, says }
    }
}
