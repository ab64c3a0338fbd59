//! Reference solutions in quadruple precision, from `reference/impacts.c`.

use super::definition::Outcome;

/// The file that `reference/impacts.c` wrote.
const TABLE: &str = include_str!("../../reference/impacts.csv");

/// A reference and its own error.
#[derive(Debug, Clone, PartialEq)]
pub struct Reference {
    /// The solution.
    pub outcome: Outcome,
    /// Difference of the restitution from that of a second run with a tolerance a million times larger.
    pub restitution_error: f64,
}

impl Reference {
    /// Time until which a solver has to compute the impact: slightly beyond the last separation (s).
    pub fn end_s(&self) -> f64 {
        1.02 * self.outcome.contact_times_s.last().copied().unwrap_or(0.0)
    }
}

/// The reference of an impact of the library.
///
/// # Errors
/// If the table does not contain it.
pub fn reference(name: &str) -> Result<Reference, String> {
    let fault = || format!("reference/impacts.csv: no valid reference for {name}");
    let mut found = None;
    let (mut contact_times_s, mut impulses_n_s) = (Vec::new(), Vec::new());
    for line in TABLE.lines().skip(1) {
        let fields: Vec<&str> = line.split(',').collect();
        if fields.first() != Some(&name) {
            continue;
        }
        let values: Result<Vec<f64>, _> = fields.iter().skip(2).map(|field| field.parse::<f64>()).collect();
        match (fields.get(1), values.map_err(|_| fault())?.as_slice()) {
            (Some(&"net"), &[restitution, error, _]) => found = Some((restitution, error)),
            (Some(&"contact"), &[start, end, impulse]) => {
                contact_times_s.extend([start, end]);
                impulses_n_s.push(impulse);
            }
            _ => return Err(fault()),
        }
    }
    let (restitution, restitution_error) = found.ok_or_else(fault)?;
    let outcome = Outcome { restitution, contact_times_s, impulses_n_s };
    Ok(Reference { outcome, restitution_error })
}
