//! Fractional initial value problems, reduced to Volterra equations.

use crate::method::Method;
use crate::problem::{Density, Event, Term, Volterra};
use crate::solution::Solution;
use crate::system::SMALLEST_ORDER;
use invalid_input::InvalidInput;
use libm::tgamma;
use std::fmt;

/// The left-hand side and initial values of one equation: `D^order y + sum of coefficient D^lower y = rhs`, with Caputo
/// derivatives.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Equation {
    /// Highest order, 0.01 to 16.
    pub order: f64,
    /// `y(0), y'(0), ...`: as many values as `order`, rounded up.
    pub initial: Vec<f64>,
    /// Lower terms `(coefficient, order)` of the same unknown; orders from 0 to `order - 0.01`.
    pub lower: Vec<(f64, f64)>,
}

impl Equation {
    /// `D^order y = rhs` with the given initial values.
    pub fn new(order: f64, initial: &[f64]) -> Equation {
        Equation { order, initial: initial.to_vec(), lower: Vec::new() }
    }

    /// Adds `coefficient * D^order y` to the left-hand side.
    pub fn plus(mut self, coefficient: f64, order: f64) -> Equation {
        self.lower.push((coefficient, order));
        self
    }

    fn check(&self) -> Result<(), InvalidInput> {
        let order_ok = self.order >= 0.01 && self.order <= 16.0;
        InvalidInput::unless(order_ok, "order", self.order, "a number from 0.01 to 16")?;
        let count = self.initial.len();
        let count_ok = count == self.order.ceil() as usize;
        InvalidInput::unless(count_ok, ["initial", "len()"], count, "the order of the equation rounded up")?;
        for (k, &value) in self.initial.iter().enumerate() {
            InvalidInput::require_finite(("initial", k), value)?;
        }
        for (k, &(coefficient, lower)) in self.lower.iter().enumerate() {
            InvalidInput::require_finite(("lower", k, "0"), coefficient)?;
            let lower_ok = lower >= 0.0 && lower <= self.order - 0.01;
            let allowed = "a number from 0 to the equation's order minus 0.01";
            InvalidInput::unless(lower_ok, ("lower", k, "1"), lower, allowed)?;
        }
        Ok(())
    }

    /// Powers `(factor, exponent)` of `t` by which the initial values enter the Volterra equation: the Taylor polynomial, and
    /// for each lower term the integral of the part of the polynomial that its derivative annihilates.
    fn forcing(&self) -> Vec<(f64, f64)> {
        let power = |k: usize, raise: f64, factor: f64| {
            let exponent = k as f64 + raise;
            (factor * self.initial[k] / tgamma(exponent + 1.0), exponent)
        };
        let mut powers: Vec<(f64, f64)> = (0..self.initial.len()).map(|k| power(k, 0.0, 1.0)).collect();
        for &(coefficient, lower) in &self.lower {
            powers.extend((0..lower.ceil() as usize).map(|k| power(k, self.order - lower, coefficient)));
        }
        powers
    }
}

/// A system of fractional differential equations of any orders, one [`Equation`] per unknown.
///
/// An example is the relaxation `D^(1/2) y = -y`, `y(0) = 1`, whose solution is the Mittag-Leffler function `E_(1/2)(-sqrt t)`:
///
/// ```
/// use fracdiff::{Collocation, Equation, InitialValueProblem, Method};
/// let problem = InitialValueProblem::new(vec![Equation::new(0.5, &[1.0])], |_, y, f| f[0] = -y[0]);
/// let solution = problem.solve(&Method::Collocation(Collocation::default()), 1.0)?;
/// assert!((solution.at(1.0)?[0] - 0.42758357615580700).abs() < 1e-12);
/// # Ok::<(), fracdiff::InvalidInput>(())
/// ```
pub struct InitialValueProblem<'a> {
    /// Left-hand sides and initial values.
    pub equations: Vec<Equation>,
    /// `rhs(t, y)`: writes one value per equation.
    pub rhs: Density<'a>,
    /// Times at which the right-hand side may jump or have a kink in `t`, see [`Volterra::breaks`].
    pub breaks: Vec<f64>,
    /// Events to locate.
    pub events: Vec<Event<'a>>,
}

impl fmt::Debug for InitialValueProblem<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("InitialValueProblem")
            .field("equations", &self.equations)
            .field("breaks", &self.breaks)
            .field("events", &self.events)
            .finish_non_exhaustive()
    }
}

impl<'a> InitialValueProblem<'a> {
    /// The system with these left-hand sides and initial values, and this right-hand side.
    pub fn new(equations: Vec<Equation>, rhs: impl Fn(f64, &[f64], &mut [f64]) + 'a) -> Self {
        InitialValueProblem { equations, rhs: Box::new(rhs), breaks: Vec::new(), events: Vec::new() }
    }

    /// Adds break points.
    pub fn with_breaks(mut self, times: &[f64]) -> Self {
        self.breaks.extend_from_slice(times);
        self
    }

    /// Adds an event.
    pub fn with_event(mut self, event: Event<'a>) -> Self {
        self.events.push(event);
        self
    }

    /// The equivalent Volterra equation: `y = T + sum of a I^(order-lower) T_lower + I^order rhs - sum of a
    /// I^(order-lower) y`, with `T` the Taylor polynomial of the initial values and `T_lower` its first terms.
    ///
    /// # Errors
    ///
    /// [`InvalidInput`] for orders and initial values that do not match.
    pub fn volterra(&self) -> Result<Volterra<'_>, InvalidInput> {
        let d = self.equations.len();
        let mut terms = Vec::new();
        // Densities are the right-hand sides, then every unknown that has lower terms.
        let mut copied = Vec::new();
        for (i, equation) in self.equations.iter().enumerate() {
            equation.check().map_err(|fault| fault.at(i).within("equations"))?;
            terms.push(Term::riemann_liouville(i, i, equation.order, 1.0));
            if !equation.lower.is_empty() {
                let lower = equation.lower.iter();
                let density = d + copied.len();
                // The difference of two allowed orders may be too small by its rounding.
                let raised = |lower: f64| (equation.order - lower).max(SMALLEST_ORDER);
                terms.extend(lower.map(|&(a, b)| Term::riemann_liouville(i, density, raised(b), -a)));
                copied.push(i);
            }
        }
        let forcing: Vec<Vec<(f64, f64)>> = self.equations.iter().map(Equation::forcing).collect();
        let events = self.events.iter().map(|e| Event {
            function: Box::new(move |t, y| (e.function)(t, y)),
            direction: e.direction,
            terminal: e.terminal,
        });
        Ok(Volterra {
            unknowns: d,
            densities: d + copied.len(),
            terms,
            forcing: Box::new(move |t, g| {
                for (g, powers) in g.iter_mut().zip(&forcing) {
                    *g = powers.iter().map(|&(factor, exponent)| factor * t.powf(exponent)).sum();
                }
            }),
            density: Box::new(move |t, y, f| {
                let (rhs, copies) = f.split_at_mut(d);
                (self.rhs)(t, y, rhs);
                for (copy, &i) in copies.iter_mut().zip(&copied) {
                    *copy = y[i];
                }
            }),
            breaks: self.breaks.clone(),
            events: events.collect(),
        })
    }

    /// Solves the problem on `[0, t_end]`, see [`Volterra::solve`].
    ///
    /// # Errors
    ///
    /// [`InvalidInput`] for a problem or settings that no run can start from.
    pub fn solve(&self, method: &Method, t_end: f64) -> Result<Solution, InvalidInput> {
        self.volterra()?.solve(method, t_end)
    }
}
