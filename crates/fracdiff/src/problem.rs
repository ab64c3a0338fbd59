//! The problem: a system of weakly singular Volterra equations of the second kind.

use std::fmt;

/// One memory term: `coefficient * integral_0^t (t-s)^(order-1) f_density(s, y(s)) ds` in the equation of `y_unknown`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Term {
    /// The component of `y` in whose equation the term appears.
    pub unknown: usize,
    /// The component of the density that the term integrates.
    pub density: usize,
    /// Order of the integral, 0.01 to 16; below 1 the kernel is singular.
    pub order: f64,
    /// Factor of the kernel, without a Gamma function.
    pub coefficient: f64,
}

impl Term {
    /// The Riemann-Liouville integral `factor * I^order f_density`, whose kernel includes `1/Gamma(order)`.
    pub fn riemann_liouville(unknown: usize, density: usize, order: f64, factor: f64) -> Term {
        Term { unknown, density, order, coefficient: factor / libm::tgamma(order) }
    }
}

/// Which sign changes of an event function count.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Direction {
    /// Both.
    #[default]
    Any,
    /// From negative to positive.
    Rising,
    /// From positive to negative.
    Falling,
}

invalid_input::names!(Direction, "direction", { Any: "any", Rising: "rising", Falling: "falling" });

/// A function of time and solution whose sign changes are located.
///
/// Signs are compared at the ends of steps, or at the ends and nodes of panels; two sign changes between neighbouring points
/// are not detected. A detected change is located on the solution to rounding.
pub struct Event<'a> {
    /// The function `e(t, y)`. A value of exactly 0 has neither sign, so a start at 0 is no event.
    pub function: EventFunction<'a>,
    /// Which sign changes count.
    pub direction: Direction,
    /// Whether the solution ends at the first sign change that counts.
    pub terminal: bool,
}

impl<'a> Event<'a> {
    /// An event that is located while the run continues.
    pub fn new(function: impl Fn(f64, &[f64]) -> f64 + 'a) -> Self {
        Event { function: Box::new(function), direction: Direction::Any, terminal: false }
    }

    /// Counts sign changes of one direction only.
    pub fn direction(mut self, direction: Direction) -> Self {
        self.direction = direction;
        self
    }

    /// Ends the solution at the event.
    pub fn terminal(mut self) -> Self {
        self.terminal = true;
        self
    }
}

impl fmt::Debug for Event<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Event")
            .field("direction", &self.direction)
            .field("terminal", &self.terminal)
            .finish_non_exhaustive()
    }
}

/// A function of time and solution.
pub type EventFunction<'a> = Box<dyn Fn(f64, &[f64]) -> f64 + 'a>;
/// A function of time that fills a vector.
pub type Forcing<'a> = Box<dyn Fn(f64, &mut [f64]) + 'a>;
/// A function of time and solution that fills a vector.
pub type Density<'a> = Box<dyn Fn(f64, &[f64], &mut [f64]) + 'a>;

/// The system `y(t) = g(t) + sum of terms`, see [`Term`].
///
/// `y` has [`unknowns`](Self::unknowns) components, the density `f(t, y)` has
/// [`densities`](Self::densities); several terms may integrate the same component of the density
/// (a sum of kernels), which is then evaluated once.
///
/// The infinite beam struck by a ball, `x = t - int [(t-s) + sqrt(t-s)] max(x, 0)^(3/2) ds`:
///
/// ```
/// use fracdiff::{Collocation, Method, Volterra};
/// let beam = Volterra::scalar(|t| t, |_, x| x.max(0.0).powf(1.5), &[(2.0, -1.0), (1.5, -1.0)]);
/// let solution = beam.solve(&Method::Collocation(Collocation::default()), 1.0)?;
/// assert!(solution.at(1.0)?[0] > 0.5);
/// # Ok::<(), fracdiff::InvalidInput>(())
/// ```
pub struct Volterra<'a> {
    /// Number of components of `y`, 1 to 2000.
    pub unknowns: usize,
    /// Number of components of the density `f`, 1 to 2000.
    pub densities: usize,
    /// The memory terms.
    pub terms: Vec<Term>,
    /// `g(t)`: fills `unknowns` values.
    pub forcing: Forcing<'a>,
    /// `f(t, y)`: fills `densities` values.
    pub density: Density<'a>,
    /// Times at which `g` or `f` may jump or have a kink in `t`. Every method steps onto them. The functions are never
    /// evaluated at such a time itself, but on its two sides.
    pub breaks: Vec<f64>,
    /// Events to locate.
    pub events: Vec<Event<'a>>,
}

impl<'a> Volterra<'a> {
    /// One equation `y(t) = forcing(t) + sum of coefficient * integral (t-s)^(order-1) density(s, y(s)) ds`,
    /// the kernels given as pairs `(order, coefficient)`.
    pub fn scalar(
        forcing: impl Fn(f64) -> f64 + 'a,
        density: impl Fn(f64, f64) -> f64 + 'a,
        kernels: &[(f64, f64)],
    ) -> Self {
        Volterra {
            unknowns: 1,
            densities: 1,
            terms: kernels
                .iter()
                .map(|&(order, coefficient)| Term { unknown: 0, density: 0, order, coefficient })
                .collect(),
            forcing: Box::new(move |t, g| g.iter_mut().for_each(|v| *v = forcing(t))),
            density: Box::new(move |t, y, f| {
                if let (Some(f), Some(&y)) = (f.first_mut(), y.first()) {
                    *f = density(t, y);
                }
            }),
            breaks: Vec::new(),
            events: Vec::new(),
        }
    }

    /// Adds break points, see [`breaks`](Self::breaks).
    pub fn with_breaks(mut self, times: &[f64]) -> Self {
        self.breaks.extend_from_slice(times);
        self
    }

    /// Adds an event.
    pub fn with_event(mut self, event: Event<'a>) -> Self {
        self.events.push(event);
        self
    }
}

impl fmt::Debug for Volterra<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Volterra")
            .field("unknowns", &self.unknowns)
            .field("densities", &self.densities)
            .field("terms", &self.terms)
            .field("breaks", &self.breaks)
            .field("events", &self.events)
            .finish_non_exhaustive()
    }
}
