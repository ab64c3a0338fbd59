//! Searches a growing solution for events.

use crate::dense::Dense;
use crate::problem::{Direction, Event, Volterra};
use crate::solution::{Counts, EventHit, Solution, Stop};
use crate::system::{Fault, Segment, System};

/// The solution so far and the last sign of each event function.
pub(crate) struct Recorder<'p, 'a> {
    problem: &'p Volterra<'a>,
    pub dense: Dense,
    /// Time and value of each event function when it was last not 0.
    last: Vec<Option<(f64, f64)>>,
    hits: Vec<EventHit>,
}

impl<'p, 'a> Recorder<'p, 'a> {
    pub fn new(problem: &'p Volterra<'a>, dense: Dense) -> Self {
        Recorder { problem, dense, last: vec![None; problem.events.len()], hits: Vec::new() }
    }

    /// The solution just after the start of a segment. The integrals are continuous, so this is the forcing at first, and later
    /// the last value plus the jump of the forcing.
    pub fn start_value(&self, system: &mut System<'_, '_>, segment: &Segment) -> Result<Vec<f64>, Fault> {
        let mut value = vec![0.0; system.unknowns];
        system.forcing(segment.inside(segment.start), &mut value)?;
        if segment.start > 0.0 {
            let mut before = vec![0.0; system.unknowns];
            system.forcing(segment.before(), &mut before)?;
            let values = self.dense.values();
            let last = &values[values.len() - before.len()..];
            for ((v, b), y) in value.iter_mut().zip(&before).zip(last) {
                *v = y + (*v - b);
            }
        }
        Ok(value)
    }

    /// Evaluates the event functions at the given times, ascending, all inside the solution so far. An error is the reason to
    /// stop; the solution then ends at the terminal event.
    pub fn scan(&mut self, times: impl IntoIterator<Item = f64>) -> Result<(), Stop> {
        if self.problem.events.is_empty() {
            return Ok(());
        }
        let mut y = vec![0.0; self.dense.unknowns()];
        for t in times {
            let mut found: Vec<EventHit> = Vec::new();
            for (index, event) in self.problem.events.iter().enumerate() {
                self.dense.eval(t, &mut y);
                let value = (event.function)(t, &y);
                if value.is_nan() {
                    return Err(Stop::NonFinite { t });
                }
                if value == 0.0 {
                    continue;
                }
                let before = self.last[index].replace((t, value));
                if let Some((t0, v0)) = before
                    && (v0 < 0.0) != (value < 0.0)
                    && counts(event.direction, value > 0.0)
                {
                    let at = locate(event, &self.dense, (t0, v0), (t, value));
                    self.dense.eval(at, &mut y);
                    found.push(EventHit { event: index, t: at, y: y.clone(), rising: value > 0.0 });
                }
            }
            found.sort_by(|a, b| a.t.total_cmp(&b.t));
            for hit in found {
                let (at, index) = (hit.t, hit.event);
                self.hits.push(hit);
                if self.problem.events[index].terminal {
                    self.dense.truncate(at);
                    return Err(Stop::Event { index });
                }
            }
        }
        Ok(())
    }

    pub fn finish(self, stop: Stop, system: &System<'_, '_>, counts: Counts) -> Solution {
        let counts = Counts { evaluations: system.evaluations, newton_iterations: system.newton_iterations, ..counts };
        Solution { dense: self.dense, stop, events: self.hits, counts }
    }
}

fn counts(direction: Direction, rising: bool) -> bool {
    match direction {
        Direction::Any => true,
        Direction::Rising => rising,
        Direction::Falling => !rising,
    }
}

/// Locates the sign change between two times by the secant rule with the Illinois correction, inside a bracket that is halved
/// whenever three steps have not halved it.
fn locate(event: &Event<'_>, dense: &Dense, (mut a, mut fa): (f64, f64), (mut b, mut fb): (f64, f64)) -> f64 {
    let mut y = vec![0.0; dense.unknowns()];
    // Magnitudes at the two ends, without the Illinois correction.
    let (mut size_a, mut size_b) = (fa.abs(), fb.abs());
    let mut width = b - a;
    let mut moved_right_end = None;
    for iteration in 1..200 {
        let slow = iteration % 3 == 0 && b - a > 0.5 * width;
        if iteration % 3 == 0 {
            width = b - a;
        }
        let secant = b - fb * (b - a) / (fb - fa);
        let t = if secant > a && secant < b && !slow { secant } else { 0.5 * (a + b) };
        if t <= a || t >= b {
            break;
        }
        dense.eval(t, &mut y);
        let f = (event.function)(t, &y);
        if f == 0.0 {
            return t;
        }
        if f.is_nan() {
            break;
        }
        let right = (f < 0.0) == (fb < 0.0);
        let again = moved_right_end == Some(right);
        moved_right_end = Some(right);
        if right {
            (b, fb, size_b) = (t, f, f.abs());
            fa *= if again { 0.5 } else { 1.0 };
        } else {
            (a, fa, size_a) = (t, f, f.abs());
            fb *= if again { 0.5 } else { 1.0 };
        }
    }
    if size_a < size_b { a } else { b }
}
