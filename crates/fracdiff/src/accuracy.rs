//! Solves problems to a requested accuracy, with settings that the crate chooses.

use crate::collocation::Collocation;
use crate::ivp::InitialValueProblem;
use crate::method::Method;
use crate::problem::Volterra;
use crate::solution::{Solution, Stop};
use invalid_input::InvalidInput;

/// A solution with an estimate of its error.
#[derive(Debug, Clone)]
pub struct Estimated {
    /// The solution.
    pub solution: Solution,
    /// Estimated error of its values at any time, relative to the largest magnitude of the component of the solution: three
    /// times the largest difference from a coarser solution, and 2 % of the tolerance of that one. It is infinite unless
    /// both reach the end of the interval or end at the same event.
    pub error: f64,
    /// The method chosen, with its settings.
    pub method: Method,
}

/// Largest number of times that the settings are tightened.
const ROUNDS: usize = 5;
/// The smallest tolerance that collocation accepts.
const SMALLEST: f64 = 1e-14;
/// Share of a panel's tolerance that is added to the estimate, since two solutions may agree by accident, as at the end of a
/// contact that both resolve to the same extent.
const ACCIDENT: f64 = 0.02;
/// Difference between two solutions, relative to their size, that rounding can hide.
const ROUNDING: f64 = 3e-14;
/// Points of a panel at which two solutions are compared, besides its end.
const PLACES: [f64; 3] = [0.03, 0.35, 0.75];

impl Volterra<'_> {
    /// Solves the problem on `[0, t_end]` to a tolerance from 1e-12 to 0.1. The tolerance is the error allowed in any value,
    /// relative to the largest magnitude of its component.
    ///
    /// The method is always [`Collocation`], with more nodes for smaller tolerances and a first panel of about a
    /// quarter of the mean length of a segment.
    /// The problem is solved a second time with more nodes on other panels: the difference gives the estimate, and the finer
    /// solution is returned. While the estimate is above the tolerance, both are tightened, a few times; if that does not
    /// suffice, the estimate shows it. A single run of a method of low order with few steps costs less, but its error is only
    /// known from a second run with more steps, and then it costs no less (`docs/performance-other.md`).
    ///
    /// The estimate applies to values. The error of the time of an event is the error of its function divided by its rate.
    /// Neither solution sees what happens only between the nodes of both, such as a pulse much shorter than the interval: state
    /// its times as [`breaks`](Self::breaks).
    ///
    /// ```
    /// let problem = fracdiff::Volterra::scalar(|_| 1.0, |_, y| y, &[(0.5, -1.0)]);
    /// let found = problem.solve_to(1e-4, 2.0)?;
    /// let exact = fracdiff::test_problems::abel_exact(0.3);
    /// assert!((found.solution.at(0.3)?[0] - exact).abs() < found.error);
    /// assert!(found.error < 1e-4);
    /// # Ok::<(), fracdiff::InvalidInput>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`InvalidInput`] for a problem that no run can start from, or a tolerance out of range.
    pub fn solve_to(&self, tolerance: f64, t_end: f64) -> Result<Estimated, InvalidInput> {
        let allowed = (1e-12..=0.1).contains(&tolerance);
        InvalidInput::unless(allowed, "tolerance", tolerance, "a number from 1e-12 to 0.1")?;
        let segments = 1 + self.breaks.iter().filter(|&&t| t > 0.0 && t < t_end).count();
        // Fewer nodes for larger tolerances; the finer solution has 3 more nodes and a shorter first panel.
        let nodes = 6 + (-0.75 * tolerance.log10()) as usize;
        let first_panel = |share: f64| Some(share * t_end / segments as f64).filter(|&length| length > 0.0);
        let mut asked = tolerance;
        let mut best = self.estimated(nodes, asked, first_panel, t_end)?;
        for _ in 1..ROUNDS {
            if best.error <= tolerance || asked <= SMALLEST {
                break;
            }
            asked = (0.01 * asked).max(SMALLEST);
            let found = self.estimated(nodes, asked, first_panel, t_end)?;
            if found.error < best.error {
                best = found;
            }
        }
        Ok(best)
    }

    /// Two solutions and their difference.
    fn estimated(
        &self,
        nodes: usize,
        tolerance: f64,
        first_panel: impl Fn(f64) -> Option<f64>,
        t_end: f64,
    ) -> Result<Estimated, InvalidInput> {
        let coarse = Collocation { tolerance, nodes, first_panel: first_panel(0.3), ..Collocation::default() };
        let fine = Collocation {
            tolerance: (0.01 * tolerance).max(SMALLEST),
            nodes: nodes + 3,
            first_panel: first_panel(0.23),
            ..Collocation::default()
        };
        let (coarse, method) = (self.solve(&Method::Collocation(coarse), t_end)?, Method::Collocation(fine));
        let solution = self.solve(&method, t_end)?;
        let error = 3.0 * difference(&coarse, &solution)? + ACCIDENT * tolerance;
        Ok(Estimated { error, solution, method })
    }
}

impl InitialValueProblem<'_> {
    /// Solves the problem on `[0, t_end]` to a tolerance, see [`Volterra::solve_to`].
    ///
    /// # Errors
    ///
    /// [`InvalidInput`] for a problem that no run can start from, or a tolerance out of range.
    pub fn solve_to(&self, tolerance: f64, t_end: f64) -> Result<Estimated, InvalidInput> {
        self.volterra()?.solve_to(tolerance, t_end)
    }
}

/// Largest difference between two solutions where both are known, relative to the size of each component of the second.
fn difference(coarse: &Solution, fine: &Solution) -> Result<f64, InvalidInput> {
    let same_end = match (coarse.stop, fine.stop) {
        (Stop::EndReached, Stop::EndReached) => true,
        (Stop::Event { index: a }, Stop::Event { index: b }) => a == b,
        _ => false,
    };
    if !same_end {
        return Ok(f64::INFINITY);
    }
    let d = fine.unknowns();
    let mut largest = vec![0.0_f64; d];
    for row in fine.values().chunks_exact(d) {
        largest.iter_mut().zip(row).for_each(|(largest, v)| *largest = largest.max(v.abs()));
    }
    let mut worst = vec![0.0_f64; d];
    let end = coarse.end_time().min(fine.end_time());
    for panel in fine.times().windows(2) {
        let inside = PLACES.iter().map(|share| panel[0] + share * (panel[1] - panel[0]));
        for t in inside.chain([panel[1]]).filter(|&t| t <= end) {
            for ((worst, a), b) in worst.iter_mut().zip(coarse.at(t)?).zip(fine.at(t)?) {
                *worst = worst.max((a - b).abs());
            }
        }
    }
    let relative = worst.iter().zip(&largest).map(|(worst, largest)| worst / largest.max(f64::MIN_POSITIVE));
    Ok(relative.fold(ROUNDING, f64::max))
}
