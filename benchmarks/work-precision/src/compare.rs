//! Times at equal error, and comparisons.

use crate::measure::{Origin, Row};

/// The best results of a solver: points of decreasing error and increasing time, none of which another one beats in both.
#[derive(Debug, Clone, PartialEq)]
pub struct Front(Vec<(f64, f64)>);

impl Front {
    /// From errors and times; errors below `floor` count as the floor.
    pub fn new(points: impl IntoIterator<Item = (f64, f64)>, floor: f64) -> Front {
        let mut points: Vec<(f64, f64)> =
            points.into_iter().filter(|p| p.0.is_finite() && p.1 > 0.0).map(|(e, t)| (e.max(floor), t)).collect();
        points.sort_by(|a, b| a.1.total_cmp(&b.1).then(a.0.total_cmp(&b.0)));
        let mut front: Vec<(f64, f64)> = Vec::new();
        for point in points {
            if front.last().is_none_or(|last| point.0 < last.0) {
                front.push(point);
            }
        }
        Front(front)
    }

    /// Time for this error, between two points on the straight line of their logarithms. For errors larger than any reached it
    /// is the shortest time; for smaller ones there is none.
    pub fn time_at(&self, error: f64) -> Option<f64> {
        let next = self.0.iter().position(|point| point.0 <= error)?;
        let (e1, t1) = self.0[next];
        let Some(&(e0, t0)) = next.checked_sub(1).and_then(|i| self.0.get(i)) else { return Some(t1) };
        let share = (error / e0).ln() / (e1 / e0).ln();
        Some(t0 * (t1 / t0).powf(share))
    }
}

/// The chief norm of a problem: the first in its rows.
pub fn chief_norm<'a>(rows: &[&'a Row]) -> &'a str {
    rows.iter().map(|row| row.norm.as_str()).find(|norm| !norm.is_empty()).unwrap_or("")
}

/// Names in the order of their first row.
pub fn names<'a>(values: impl Iterator<Item = &'a str>) -> Vec<&'a str> {
    let mut names: Vec<&str> = Vec::new();
    for value in values {
        if !names.contains(&value) {
            names.push(value);
        }
    }
    names
}

/// The fastest of the given solvers at one error: its name and time.
pub fn fastest<'a>(
    rows: &[&'a Row],
    norm: &str,
    floor: f64,
    error: f64,
    chosen: impl Fn(&Row) -> bool,
) -> Option<(&'a str, f64)> {
    let rows: Vec<&Row> = rows.iter().copied().filter(|row| row.norm == norm && chosen(row)).collect();
    let times = names(rows.iter().map(|row| row.solver.as_str())).into_iter().filter_map(|name| {
        let points = rows.iter().filter(|row| row.solver == name).filter_map(|row| Some((row.error?, row.time_s?)));
        Some((name, Front::new(points, floor).time_at(error)?))
    });
    times.min_by(|a, b| a.1.total_cmp(&b.1))
}

/// The result of the workspace's solvers on one problem at one error.
#[derive(Debug, Clone, PartialEq)]
pub enum Standing<'a> {
    /// Time of the fastest peer over that of the fastest own solver, and the peer.
    Ratio(f64, &'a str),
    /// No peer reaches the error.
    Alone,
    /// No own solver reaches the error; a peer does.
    Behind(&'a str),
    /// No solver reaches the error.
    Nobody,
}

/// Compares the fastest own solver with the fastest of all others.
pub fn standing<'a>(rows: &[&'a Row], norm: &str, floor: f64, error: f64) -> Standing<'a> {
    let own = fastest(rows, norm, floor, error, |row| row.origin == Origin::Own);
    let peer = fastest(rows, norm, floor, error, |row| row.origin != Origin::Own);
    match (own, peer) {
        (Some((_, own)), Some((name, peer))) => Standing::Ratio(peer / own, name),
        (Some(_), None) => Standing::Alone,
        (None, Some((name, _))) => Standing::Behind(name),
        (None, None) => Standing::Nobody,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_interpolated_on_the_front() {
        // The second point is beaten by the third.
        let front = Front::new([(1e-2, 1.0), (1e-3, 9.0), (1e-4, 4.0), (1e-8, 64.0)], 1e-16);
        assert_eq!(front.time_at(0.5), Some(1.0));
        assert!((front.time_at(1e-3).unwrap() - 2.0).abs() < 1e-12);
        assert!((front.time_at(1e-6).unwrap() - 16.0).abs() < 1e-12);
        assert_eq!(front.time_at(1e-9), None);
    }

    #[test]
    fn an_error_below_the_floor_counts_as_the_floor() {
        let front = Front::new([(1e-12, 1.0)], 1e-10);
        assert_eq!(front.time_at(1e-10), Some(1.0));
        assert_eq!(front.time_at(1e-11), None);
    }
}
