//! The quantities of each point in figures of a sweep.

use std::collections::BTreeMap;

use super::results::Results;
use super::row::NO_MOTION;
use crate::plot::Axis;

/// The column of motions, which are not numbers.
pub(super) const MOTION: &str = "motion";
/// Number of motions with a separate colour, the most common ones; the others share one.
const MOST_MOTIONS: usize = 9;

/// A quantity that is drawn.
pub(super) struct Quantity {
    /// Its column, and that of its uncertainty.
    pub column: &'static str,
    pub uncertainty: Option<&'static str>,
    pub axis: Axis,
}

impl Quantity {
    fn new(column: &'static str, axis: Axis) -> Quantity {
        Quantity { column, uncertainty: None, axis }
    }
}

/// Largest number of quantities of one sweep.
pub(super) const QUANTITIES: usize = 3;

/// The drawn values of one point; NaN if there is none.
#[derive(Debug, Clone, Copy)]
pub(super) struct Drawn {
    pub values: [f64; QUANTITIES],
    /// Of the first.
    pub uncertainty: f64,
}

pub(super) fn median(draws: &[Drawn], quantity: usize) -> f64 {
    quantile(draws, 0.5, quantity)
}

/// Quantile of the draws that have a value.
pub(super) fn quantile(draws: &[Drawn], share: f64, quantity: usize) -> f64 {
    let mut values: Vec<f64> = draws.iter().map(|drawn| drawn.values[quantity]).filter(|v| !v.is_nan()).collect();
    values.sort_by(f64::total_cmp);
    let last = values.len().saturating_sub(1);
    values.get((share * last as f64).round() as usize).copied().unwrap_or(f64::NAN)
}

/// The number of a motion, which is the next one if the motion is new; NaN if there is no motion.
pub(super) fn motion_number(motions: &mut Vec<(String, u64)>, name: String) -> f64 {
    if name.is_empty() {
        return f64::NAN;
    }
    let known = motions.iter().position(|(other, _)| *other == name);
    let number = known.unwrap_or_else(|| {
        motions.push((name, 0));
        motions.len() - 1
    });
    motions[number].1 += 1;
    number as f64
}

/// For each motion its position among the drawn ones, and the names of these positions: first the most common motions in the order
/// of their periods and intervals, then all others, then no motion.
pub(super) fn ranked(motions: &[(String, u64)]) -> (Vec<usize>, Vec<String>) {
    let parts = |name: &str| -> Option<(u64, u64)> {
        let (intervals, periods) = name.split_once('/')?;
        Some((periods.parse().ok()?, intervals.parse().ok()?))
    };
    let mut common: Vec<&(String, u64)> = motions.iter().filter(|(name, _)| name != NO_MOTION).collect();
    common.sort_by_key(|(name, count)| (std::cmp::Reverse(*count), parts(name)));
    let others = common.len() > MOST_MOTIONS;
    common.truncate(MOST_MOTIONS);
    common.sort_by_key(|(name, _)| parts(name));
    let mut names: Vec<String> = common.iter().map(|(name, _)| name.clone()).collect();
    if others {
        names.push("other".to_owned());
    }
    if motions.iter().any(|(name, _)| name == NO_MOTION) {
        names.push(NO_MOTION.to_owned());
    }
    let places: BTreeMap<&str, usize> = names.iter().enumerate().map(|(place, name)| (name.as_str(), place)).collect();
    let place = |(name, _): &(String, u64)| *places.get(name.as_str()).or(places.get("other")).unwrap_or(&0);
    (motions.iter().map(place).collect(), names)
}

/// The drawn quantities of a sweep, and their name in titles.
pub(super) fn of_results(results: &Results) -> (&'static str, Vec<Quantity>) {
    match results {
        Results::Impact | Results::Draw => {
            let restitution = Quantity::new("restitution", Axis::new("restitution"));
            let uncertainty = Some("restitution_uncertainty");
            let sub_impacts = Quantity::new("sub_impact_count", Axis::new("sub-impacts").integers());
            ("Restitution and sub-impacts", vec![Quantity { uncertainty, ..restitution }, sub_impacts])
        }
        Results::Run { .. } => (
            "Contact",
            vec![
                Quantity::new("largest_force_n", Axis::new("largest force").unit("N")),
                Quantity::new("contact_work_rate_w", Axis::new("contact work rate").unit("W")),
                Quantity::new(MOTION, Axis::new("intervals/periods").integers()),
            ],
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_leave_out_what_is_not_there() {
        let draws = [3.0, f64::NAN, 1.0, 2.0].map(|value| Drawn { values: [value, 1.0, 1.0], uncertainty: 0.0 });
        assert_eq!(median(&draws, 0), 2.0);
        assert!(median(&[], 0).is_nan());
    }

    #[test]
    fn motions_are_ordered_by_periods_and_the_rare_ones_share_a_place() {
        let of =
            |motions: &[(&str, u64)]| ranked(&motions.iter().map(|(n, c)| ((*n).to_owned(), *c)).collect::<Vec<_>>());
        let (places, names) = of(&[("none", 5), ("3/2", 1), ("1/1", 7), ("0/1", 2), ("1/10", 3)]);
        assert_eq!(names, ["0/1", "1/1", "3/2", "1/10", "none"]);
        assert_eq!(places, [4, 2, 1, 0, 3]);
        let many: Vec<(String, u64)> = (1..=11).map(|n| (format!("1/{n}"), 20 - n)).collect();
        let (places, names) = ranked(&many);
        assert_eq!((names.len(), names[9].as_str(), places[8], places[9], places[10]), (10, "other", 8, 9, 9));
    }
}
