//! A checked problem in the form that the methods use: counted evaluations, segments between breaks, kernels by order.

use crate::problem::Volterra;
use crate::solution::Stop;
use invalid_input::InvalidInput;

/// Largest number of unknowns or densities. It limits memory and is far above what the dense Newton systems can solve.
const MOST_COMPONENTS: usize = 2000;

/// Smallest order of a term.
pub(crate) const SMALLEST_ORDER: f64 = 0.01;

/// All terms of one (unknown, density) pair: the kernel `sum of coefficient * t^(orders[index] - 1)`.
#[derive(Debug, Clone)]
pub(crate) struct Pair {
    pub unknown: usize,
    pub density: usize,
    /// `(index into orders, coefficient)`.
    pub kernel: Vec<(usize, f64)>,
}

impl Pair {
    /// The combination `sum of coefficient * value(order index)`.
    pub fn combine(&self, value: impl Fn(usize) -> f64) -> f64 {
        self.kernel.iter().map(|&(index, coefficient)| coefficient * value(index)).sum()
    }
}

/// A time interval inside which forcing and density are smooth functions of `t`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Segment {
    pub start: f64,
    pub end: f64,
    start_is_break: bool,
    end_is_break: bool,
}

impl Segment {
    pub fn length(&self) -> f64 {
        self.end - self.start
    }

    /// A time just before the segment.
    pub fn before(&self) -> f64 {
        self.start * (1.0 - 4.0 * f64::EPSILON)
    }

    /// `t` moved from a break point into the segment, by a few units in the last place.
    pub fn inside(&self, t: f64) -> f64 {
        if self.start_is_break && t <= self.start {
            self.start * (1.0 + 4.0 * f64::EPSILON)
        } else if self.end_is_break && t >= self.end {
            self.end * (1.0 - 4.0 * f64::EPSILON)
        } else {
            t
        }
    }
}

/// Why a step could not be taken.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Fault {
    NonFinite { t: f64 },
    NoConvergence { t: f64 },
}

impl Fault {
    pub fn time(self) -> f64 {
        let (Fault::NonFinite { t } | Fault::NoConvergence { t }) = self;
        t
    }
}

impl From<Fault> for Stop {
    fn from(fault: Fault) -> Stop {
        match fault {
            Fault::NonFinite { t } => Stop::NonFinite { t },
            Fault::NoConvergence { t } => Stop::NoConvergence { t },
        }
    }
}

pub(crate) struct System<'p, 'a> {
    pub problem: &'p Volterra<'a>,
    pub unknowns: usize,
    pub densities: usize,
    /// The distinct orders of all terms.
    pub orders: Vec<f64>,
    pub pairs: Vec<Pair>,
    pub segments: Vec<Segment>,
    pub evaluations: u64,
    pub newton_iterations: u64,
}

impl<'p, 'a> System<'p, 'a> {
    pub fn new(problem: &'p Volterra<'a>, t_end: f64) -> Result<Self, InvalidInput> {
        let components = "a number from 1 to 2000";
        let within = |n: usize| (1..=MOST_COMPONENTS).contains(&n);
        InvalidInput::unless(within(problem.unknowns), "unknowns", problem.unknowns, components)?;
        InvalidInput::unless(within(problem.densities), "densities", problem.densities, components)?;
        InvalidInput::require_positive("t_end", t_end)?;
        let (mut orders, mut pairs) = (Vec::<f64>::new(), Vec::<Pair>::new());
        for (i, term) in problem.terms.iter().enumerate() {
            let field = |name| ("terms", i, name);
            let (u, d) = (term.unknown, term.density);
            InvalidInput::unless(u < problem.unknowns, field("unknown"), u, "less than the number of unknowns")?;
            InvalidInput::unless(d < problem.densities, field("density"), d, "less than the number of densities")?;
            InvalidInput::require_finite(field("coefficient"), term.coefficient)?;
            let in_range = term.order >= SMALLEST_ORDER && term.order <= 16.0;
            InvalidInput::unless(in_range, field("order"), term.order, "a number from 0.01 to 16")?;
            let index = orders.iter().position(|&o| o == term.order).unwrap_or_else(|| {
                orders.push(term.order);
                orders.len() - 1
            });
            match pairs.iter_mut().find(|p| p.unknown == u && p.density == d) {
                Some(pair) => pair.kernel.push((index, term.coefficient)),
                None => pairs.push(Pair { unknown: u, density: d, kernel: vec![(index, term.coefficient)] }),
            }
        }
        Ok(System {
            problem,
            unknowns: problem.unknowns,
            densities: problem.densities,
            orders,
            pairs,
            segments: segments(&problem.breaks, t_end)?,
            evaluations: 0,
            newton_iterations: 0,
        })
    }

    /// Fills `out` with `g(t)`.
    pub fn forcing(&mut self, t: f64, out: &mut [f64]) -> Result<(), Fault> {
        (self.problem.forcing)(t, out);
        finite(out, t)
    }

    /// Fills `out` with `f(t, y)`.
    pub fn density(&mut self, t: f64, y: &[f64], out: &mut [f64]) -> Result<(), Fault> {
        self.evaluations += 1;
        (self.problem.density)(t, y, out);
        finite(out, t)
    }
}

fn finite(values: &[f64], t: f64) -> Result<(), Fault> {
    if values.iter().all(|v| v.is_finite()) { Ok(()) } else { Err(Fault::NonFinite { t }) }
}

fn segments(breaks: &[f64], t_end: f64) -> Result<Vec<Segment>, InvalidInput> {
    for (i, &t) in breaks.iter().enumerate() {
        InvalidInput::require_finite(("breaks", i), t)?;
    }
    let mut inner: Vec<f64> = breaks.iter().copied().filter(|&t| t > 0.0 && t < t_end).collect();
    inner.sort_by(f64::total_cmp);
    // Breaks that are closer to each other than rounding are one break.
    inner.dedup_by(|b, a| *b - *a <= 64.0 * f64::EPSILON * *b);
    inner.retain(|&t| t_end - t > 64.0 * f64::EPSILON * t_end);
    let mut bounds = vec![0.0];
    bounds.extend(inner);
    bounds.push(t_end);
    let last = bounds.len() - 2;
    Ok((0..=last)
        .map(|i| Segment {
            start: bounds[i],
            end: bounds[i + 1],
            start_is_break: i > 0,
            end_is_break: i < last || breaks.contains(&t_end),
        })
        .collect())
}

/// Checks the number of steps, and that the samples of the solution and the density fit into a reasonable memory.
pub(crate) fn require_steps(steps: usize, system: &System<'_, '_>) -> Result<usize, InvalidInput> {
    InvalidInput::unless((1..=1 << 22).contains(&steps), "steps", steps, "a number from 1 to 4194304")?;
    let samples = steps * (system.unknowns + system.densities);
    InvalidInput::unless(
        samples <= 1 << 28,
        "steps",
        steps,
        "smaller, so that solution and density have at most 2^28 values",
    )
    .map(|()| steps)
}
