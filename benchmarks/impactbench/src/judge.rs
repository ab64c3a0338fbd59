//! Errors, kinds of failure, and numbers of problems solved.

use crate::codes::own_assembly;
use crate::outcome::Outcome;
use crate::problem::{Family, Problem, What};
use std::collections::BTreeMap;

/// Errors below which problems count as solved.
pub const LEVELS: [f64; 4] = [1e-1, 1e-2, 1e-3, 1e-6];
/// Share of the scale that counts as zero.
const NOTHING: f64 = 1e-9;
/// Distance within which a result counts as that of the motion without contacts.
const MISSED: f64 = 1e-3;

/// The failure of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Failure {
    /// The ball leaves faster than it came.
    EnergyGained,
    /// The result is that of a motion without contacts.
    MissedContact,
    /// The ball still moves into the ground or the structure.
    FellThrough,
    /// The ball does not leave, although it should.
    Stuck,
    /// The error is above a tenth in another way.
    Wrong,
    /// There is no result in the time allowed.
    TooSlow,
    /// There is no result for another reason.
    NoAnswer,
}

impl Failure {
    /// All kinds, in the order of tables.
    pub const ALL: [Failure; 7] = [
        Failure::EnergyGained,
        Failure::MissedContact,
        Failure::FellThrough,
        Failure::Stuck,
        Failure::Wrong,
        Failure::TooSlow,
        Failure::NoAnswer,
    ];

    /// Its name in tables.
    pub fn as_str(self) -> &'static str {
        match self {
            Failure::EnergyGained => "energy gained",
            Failure::MissedContact => "missed contact",
            Failure::FellThrough => "fell through",
            Failure::Stuck => "stuck",
            Failure::Wrong => "wrong by more than 0.1",
            Failure::TooSlow => "too slow",
            Failure::NoAnswer => "no answer",
        }
    }
}

/// A run with its error.
#[derive(Debug, Clone, PartialEq)]
pub struct Judged<'a> {
    /// The run.
    pub outcome: &'a Outcome,
    /// Its error, at least the uncertainty of the reference; `None` without a result.
    pub error: Option<f64>,
    /// Its failure, if any.
    pub failure: Option<Failure>,
}

/// Judges every run of these problems; the results are listed by problem.
pub fn judge<'a>(problems: &'a [Problem], outcomes: &'a [Outcome]) -> BTreeMap<&'a str, Vec<Judged<'a>>> {
    let free: BTreeMap<&str, Option<Vec<f64>>> =
        problems.iter().map(|problem| (problem.name.as_str(), without_contacts(problem))).collect();
    let mut judged: BTreeMap<&str, Vec<Judged>> = BTreeMap::new();
    for outcome in outcomes {
        let Some(problem) = problems.iter().find(|problem| problem.name == outcome.problem) else { continue };
        let answer = outcome.answer().filter(|values| values.len() == problem.quantities.len());
        let error = answer.as_ref().map(|values| problem.error(values)).filter(|error| error.is_finite());
        let failure = match (&answer, error) {
            (Some(values), Some(error)) => failure(problem, free[problem.name.as_str()].as_deref(), values, error),
            _ if outcome.status == "too slow" => Some(Failure::TooSlow),
            _ => Some(Failure::NoAnswer),
        };
        let error = error.map(|error| error.max(problem.floor()));
        judged.entry(&problem.name).or_default().push(Judged { outcome, error, failure });
    }
    judged
}

/// The result of a problem without its contacts.
fn without_contacts(problem: &Problem) -> Option<Vec<f64>> {
    let free = Problem { contacts: vec![], ..problem.clone() };
    own_assembly(&free, &[], 1e-9).ok().filter(|_| problem.infinite_beam_s.is_none())
}

/// The failure of a result. Failures of a rebound are distinguished if one ball leaves.
fn failure(problem: &Problem, free: Option<&[f64]>, values: &[f64], error: f64) -> Option<Failure> {
    let of_rebound = matches!(problem.family, Family::Law | Family::Restitution | Family::Structure);
    let wrong = (error > 0.1).then_some(Failure::Wrong);
    let missed = free.is_some_and(|free| problem.distance(values, free) < MISSED);
    if wrong.is_some() && missed {
        return Some(Failure::MissedContact);
    }
    let ([quantity], [value], true) = (problem.quantities.as_slice(), values, of_rebound) else { return wrong };
    let (ratio, wanted) = (value / quantity.scale, quantity.value / quantity.scale);
    match ratio {
        _ if quantity.what != What::VelocityMS => wrong,
        ratio if ratio > 1.0 + 1e-6 => Some(Failure::EnergyGained),
        ratio if ratio < -NOTHING && wanted >= 0.0 => Some(Failure::FellThrough),
        ratio if ratio.abs() <= NOTHING && wanted > 0.01 => Some(Failure::Stuck),
        _ => wrong,
    }
}

/// The names of the codes, in the order in which they come.
pub fn codes(outcomes: &[Outcome]) -> Vec<&str> {
    let mut codes: Vec<&str> = Vec::new();
    for outcome in outcomes {
        if !codes.contains(&outcome.code.as_str()) {
            codes.push(&outcome.code);
        }
    }
    codes
}

/// The smallest error of a code on a problem.
pub fn least_error(judged: &[Judged], code: &str) -> Option<f64> {
    judged.iter().filter(|run| run.outcome.code == code).filter_map(|run| run.error).min_by(f64::total_cmp)
}

/// The shortest time in which a code comes within an error (s).
pub fn time_at(judged: &[Judged], code: &str, error: f64) -> Option<f64> {
    let within = judged.iter().filter(|run| run.outcome.code == code && run.error.is_some_and(|found| found <= error));
    within.filter_map(|run| run.outcome.time_s).min_by(f64::total_cmp)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::problem::{Body, Contact, LawOfContact, Quantity};

    fn problem() -> Problem {
        let quantity = Quantity {
            body: "ball".into(),
            shape: None,
            what: What::VelocityMS,
            value: 1.0,
            uncertainty: 1e-9,
            scale: 2.0,
        };
        Problem {
            name: "p".into(),
            family: Family::Law,
            statement: String::new(),
            needs: vec![],
            bodies: vec![Body::mass("ball", 1.0, 0.0, -2.0)],
            contacts: vec![Contact::new("ball", None, 0.0, LawOfContact::LinearSpring { stiffness_n_m: 1.0 })],
            gravity_m_s2: 0.0,
            loads: vec![],
            infinite_beam_s: None,
            end_s: 1.0,
            quantities: vec![quantity],
            reference: String::new(),
        }
    }

    #[test]
    fn errors_and_failures() {
        let row = |status: &str, values: &str, time_s: f64| Outcome {
            problem: "p".into(),
            code: "c".into(),
            setting: 0.1,
            time_s: Some(time_s),
            status: status.into(),
            values: values.into(),
        };
        let rows = [
            row("ok", "1", 3.0),
            row("ok", "1.02", 1.0),
            row("ok", "2.1", 1.0),
            row("ok", "-2", 1.0),
            row("ok", "-1", 1.0),
            row("ok", "0", 1.0),
            row("ok", "1.5", 1.0),
            row("too slow", "", 1.0),
            row("diverged", "", 1.0),
            row("ok", "1 2", 1.0),
        ];
        let problems = [problem()];
        let judged = judge(&problems, &rows);
        let found: Vec<_> = judged["p"].iter().map(|run| run.failure).collect();
        use Failure::*;
        let wanted = [EnergyGained, MissedContact, FellThrough, Stuck, Wrong, TooSlow, NoAnswer, NoAnswer].map(Some);
        assert_eq!(found, [[None, None].as_slice(), &wanted].concat());
        // The error is at least the uncertainty of the reference.
        assert_eq!(least_error(&judged["p"], "c"), Some(5e-10));
        assert_eq!(time_at(&judged["p"], "c", 0.02), Some(1.0));
        assert_eq!(time_at(&judged["p"], "c", 1e-6), Some(3.0));
        assert_eq!((time_at(&judged["p"], "c", 1e-12), least_error(&judged["p"], "d")), (None, None));
        assert_eq!(codes(&rows), ["c"]);
    }
}
