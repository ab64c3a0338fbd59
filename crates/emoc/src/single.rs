//! Problem P_1 of section 6.3 and its reduced form, for one striker and a structure at rest.

use crate::closed_form::sum_of_squares;
use crate::engine::{Engine, Failure, Minimum};
use crate::program::Program;
use crate::require::require_positive;
use crate::{Coefficients, SolveError};
use alloc::vec::Vec;
use invalid_input::InvalidInput;

/// One striker and a structure at rest, as in chapter 6. The speed of approach is the unit of velocity.
#[derive(Debug, Clone, PartialEq)]
pub struct SingleImpact<'a> {
    /// Mass `m` of the striker (kg).
    pub mass_kg: f64,
    /// Mass-normalised mode shapes `phi_k(b)` at the contact (kg^-1/2), of either sign.
    pub phi: &'a [f64],
    /// `ebar`, `beta_0`, `beta_1`.
    pub coefficients: Coefficients<f64>,
}

/// The solution of a [`SingleImpact`] by a quadratic program.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct SingleSolution {
    /// `e = v_f / u`.
    pub restitution: f64,
    /// Modal speeds over the speed of approach, `a_k'/u` (kg^1/2).
    pub modal_rates_per_speed: Vec<f64>,
    /// Kinetic energy after the impact over that before it: `e^2 + sum a_k'^2 / (m u^2)`.
    pub energy_ratio: f64,
}

impl SingleImpact<'_> {
    /// Solves P_1 (Eqs. 6.8 to 6.13) with Clarabel: `2 N + 1` variables.
    ///
    /// Modes that the contact does not excite (`phi_k = 0`) stay at rest and are omitted; with them the feasible set would have
    /// no interior.
    ///
    /// # Errors
    /// [`SolveError::Invalid`] for a number out of range, [`SolveError::Stopped`] if the program cannot be solved in double
    /// precision.
    pub fn solve_full(&self) -> Result<SingleSolution, SolveError> {
        let z = self.moderated_mass_ratio()?;
        let Coefficients { ebar, beta0, beta1 } = self.coefficients;
        // Units: ebar u for v_f, ebar sqrt(m) u / sqrt(1+Z) for a' and c, so that sum psi^2 = Z/(1+Z) and the
        // demands are 1 and beta_1.
        let unit = (self.mass_kg / (1.0 + z)).sqrt();
        let psi: Vec<f64> = self.phi.iter().map(|phi| phi.abs() * unit).filter(|&psi| psi > 0.0).collect();
        let n = psi.len();
        let (v, a, c) = (0, 1, 1 + n);
        let mut p1 = Program::new(1 + 2 * n);
        p1.quadratic(v, v, 1.0 + z); // 6.8
        for k in 0..n {
            p1.quadratic(a + k, a + k, 0.5);
            p1.quadratic(c + k, c + k, 0.5);
        }
        let each = |first: usize, weight: f64| psi.iter().enumerate().map(move |(k, psi)| (first + k, weight * psi));
        p1.at_least([(v, 1.0)].into_iter().chain(each(a, -1.0)), 1.0); // 6.9
        p1.at_least([(v, 1.0)].into_iter().chain(each(c, -beta0)), beta1); // 6.10
        for (k, &psi) in psi.iter().enumerate() {
            p1.at_most([(a + k, 1.0), (c + k, -1.0)], 0.0); // 6.11
            p1.at_most([(a + k, -1.0), (c + k, -1.0)], 0.0); // 6.12
            // 6.13, divided by (1+Z)
            p1.at_most([(v, -psi * ebar), (c + k, ebar / (1.0 + z))], psi);
        }
        let x = minimise(p1, z)?;
        let mut found = x[a..a + n].iter();
        let rates = self.phi.iter().map(|&phi| match (phi.abs() * unit > 0.0).then(|| found.next()).flatten() {
            Some(rate) => ebar * rate * unit * phi.signum(),
            None => 0.0,
        });
        Ok(self.solution(ebar * x[v], rates.collect()))
    }

    /// Solves the reduced form with Clarabel: the two variables `e = v_f/u` and `y = -sum phi_k a_k'/u`,
    ///
    /// `min e^2 + y^2/Z`, `e + y >= ebar`, `e - beta_0 y >= beta_1 ebar`, `0 <= y <= Z (1 + e)`.
    ///
    /// # Errors
    /// As [`SingleImpact::solve_full`].
    pub fn solve_reduced(&self) -> Result<SingleSolution, SolveError> {
        let z = self.moderated_mass_ratio()?;
        let Coefficients { ebar, beta0, beta1 } = self.coefficients;
        let (e, y) = (0, 1);
        // Units: ebar for e, ebar sqrt(Z/(1+Z)) for y.
        let unit = (z / (1.0 + z)).sqrt();
        let mut reduced = Program::new(2);
        reduced.quadratic(e, e, 1.0 + z);
        reduced.quadratic(y, y, 1.0);
        reduced.at_least([(e, 1.0), (y, unit)], 1.0);
        reduced.at_least([(e, 1.0), (y, -beta0 * unit)], beta1);
        reduced.at_least([(y, 1.0)], 0.0);
        // y <= Z (1+e), divided by sqrt(Z (1+Z))
        reduced.at_most([(e, -unit * ebar), (y, ebar / (1.0 + z))], unit);
        let x = minimise(reduced, z)?;
        let sum = sum_of_squares(self.phi)?;
        let s = if sum > 0.0 { ebar * x[y] * unit / sum } else { 0.0 };
        Ok(self.solution(ebar * x[e], self.phi.iter().map(|phi| -phi * s).collect()))
    }

    fn moderated_mass_ratio(&self) -> Result<f64, InvalidInput> {
        require_positive("mass_kg", self.mass_kg)?;
        self.coefficients.validate()?;
        let z = self.mass_kg * sum_of_squares(self.phi)?;
        let allowed = "a moderated mass ratio of at most 1e13";
        if z <= 1e13 { Ok(z) } else { Err(InvalidInput::new("z", z, allowed)) }
    }

    fn solution(&self, restitution: f64, modal_rates_per_speed: Vec<f64>) -> SingleSolution {
        let modes: f64 = modal_rates_per_speed.iter().map(|rate| rate * rate).sum();
        let energy_ratio = restitution * restitution + modes / self.mass_kg;
        SingleSolution { restitution, modal_rates_per_speed, energy_ratio }
    }
}

/// Solves a program whose energy is in units of `m u^2 / 2 (1+Z)`, and if that gives no proof, of `m u^2 / 2`. The first suits
/// the basic branch, where the striker's energy is the smaller part; the second suits the outward branch, where the energy of
/// the modes is. Up to `Z` near 1e6 there is no difference.
fn minimise(mut program: Program, z: f64) -> Result<Vec<f64>, SolveError> {
    let first = Engine::default().minimise(&program);
    if let Ok(Minimum { x, proven: true }) = first {
        return Ok(x);
    }
    program.scale_objective(1.0 / (1.0 + z));
    match Engine::default().minimise(&program) {
        Ok(minimum) if minimum.proven => Ok(minimum.x),
        second => Ok(first.or(second)?.x),
    }
}

impl From<Failure> for SolveError {
    fn from(failure: Failure) -> SolveError {
        match failure {
            Failure::Infeasible => SolveError::Stopped("no feasible point was found"),
            Failure::Unbounded => SolveError::Stopped("the energy was found to be unbounded"),
            Failure::Stopped(reason) => SolveError::Stopped(reason),
        }
    }
}
