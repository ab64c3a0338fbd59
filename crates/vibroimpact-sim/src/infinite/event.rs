//! Event location: where a panel leaves the branch of the law on which it was solved.

use super::law::Margin;
use super::panel::elapsed;
use super::rule::{Kind, Tables, dot, series, series_slope};
use crate::panel::root::{EXACTLY, root};

/// A boundary that is met within a panel.
#[derive(Debug, Clone, Copy)]
pub(super) struct Event {
    /// Number of the boundary.
    pub which: usize,
    /// Elapsed fraction of the panel; 0 if the panel is beyond the boundary from its start.
    pub fraction: f64,
}

/// The first boundary that the motion on a panel meets, given by the Legendre series of compression and rate; that of the rate
/// may be empty if no boundary depends on it. `noise` is the rounding of an event function: a branch may begin on a boundary,
/// which is met when the event function falls below zero.
pub(super) fn first(
    tables: &Tables,
    kind: Kind,
    margins: &[Margin],
    [x, rate]: [&[f64]; 2],
    noise: impl Fn(&Margin) -> f64,
) -> Option<Event> {
    let mut found: Option<Event> = None;
    for (which, margin) in margins.iter().enumerate() {
        let mut polynomial: Vec<f64> = x.iter().map(|c| margin.per_compression * c).collect();
        polynomial.iter_mut().zip(rate).for_each(|(sum, c)| *sum += margin.per_rate * c);
        polynomial[0] -= margin.level;
        if let Some(s) = crossing(tables, kind, &polynomial, noise(margin)) {
            let fraction = elapsed(kind, s);
            if found.is_none_or(|other| fraction < other.fraction) {
                found = Some(Event { which, fraction });
            }
        }
    }
    found
}

/// The panel variable at which an event function falls below zero. The polynomial is sampled more densely than its nodes, and at
/// its minima in between.
fn crossing(tables: &Tables, kind: Kind, polynomial: &[f64], noise: f64) -> Option<f64> {
    // the sum of all coefficients bounds the deviation of the polynomial from its mean
    let wander: f64 = polynomial[1..].iter().map(|c| c.abs()).sum();
    if polynomial[0] > wander {
        return None;
    }
    let (p, count) = (tables.p, tables.sample.len());
    let at = |i: usize| if kind == Kind::End { count - 1 - i } else { i };
    let start = tables.sample[at(0)];
    let (mut before, mut above) = (start, (series(polynomial, start) > noise).then_some(start));
    for i in 1..count {
        let here = tables.sample[at(i)];
        let slope = |i: usize| dot(&tables.slope[at(i) * p..(at(i) + 1) * p], polynomial);
        let low = [(slope(i - 1) < 0.0) != (slope(i) < 0.0)]
            .into_iter()
            .filter(|turns| *turns)
            .map(|_| root(before, here, EXACTLY, |s| series_slope(polynomial, s)))
            .find(|s| (before.min(here)..=before.max(here)).contains(s));
        for s in low.into_iter().chain([here]) {
            let value = series(polynomial, s);
            if value < -noise {
                return Some(above.map_or(start, |above| root(above, s, EXACTLY, |s| series(polynomial, s))));
            }
            if value > noise {
                above = Some(s);
            }
        }
        before = here;
    }
    None
}
