//! One striker at one point of a structure that moves already: the program of several contacts, solved without a quadratic
//! program, an allocator or a library.
//!
//! With the modal speeds `a_k'(0)` before the impact, the speed of closing `u = sum phi_k a_k'(0) - v_i` and the impulse
//! `p = m (v - v_i)`, the program of the crate's root has one contact:
//!
//! ```text
//! min  (m v^2 + sum a_k'^2) / 2
//!      v - sum phi_k a_k'          >= ebar u                                           (1)
//!      v - beta_0 sum |phi_k a_k'| >= beta_1 ebar u                                    (2)
//!      |a_k' - a_k'(0)|            <= |phi_k| p                                        (3)
//! ```
//!
//! For a given `p` the Lagrangian separates into the modes. The speed of mode `k` that (1) and (2) demand is `-s phi_k` with
//! one number `s >= 0` for all modes, the difference of the two multipliers, and (3) restricts it to its range:
//!
//! ```text
//! a_k'(s, p) = the nearest to -s phi_k from a_k'(0) - |phi_k| p to a_k'(0) + |phi_k| p.   (4)
//! ```
//!
//! The left side of (1) grows with `s`, so that bisection finds the smallest `s` that satisfies it. This `s` also minimises
//! `sum |phi_k a_k'|`, because no mode moves further from zero than (1) requires. The remaining problem has the only unknown
//! `p`. A larger `p` widens every range and raises `v`, so that each of (1) and (2) changes from infeasible to feasible at most
//! once; and the smallest energy for a given `p` is a convex function with the slope
//!
//! ```text
//! v - s/m - sum |phi_k| |a_k' + s phi_k|.                                             (5)
//! ```
//!
//! The solution is the smallest `p` at which (1) is feasible, (2) is satisfied and (5) is not negative, found by bisection
//! again. If the energy then grows, or numbers overflow, all demands are lowered by a common share, as for several contacts.

use crate::Coefficients;
use crate::require::{require, require_positive};
use invalid_input::InvalidInput;

/// Share of the energy exchanged by which rounding may exceed what is available.
const ENERGY_ROUNDING: f64 = 1e-10;
/// Number of bisections of the share by which demands are lowered.
const SHARE_HALVINGS: usize = 20;
/// Number of halvings and doublings after which a number is accurate to rounding.
const HALVINGS: usize = 2200;
/// Largest number that is accepted.
const LARGEST: f64 = 1e60;
/// Largest impulse that is searched for, at which no product of the program overflows.
const FARTHEST: f64 = 1e200;

/// A striker that meets a structure at one point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MovingImpact<'a> {
    /// Mass of the striker (kg).
    pub mass_kg: f64,
    /// Its velocity, positive away from the structure (m/s).
    pub velocity_m_s: f64,
    /// `ebar`, `beta_0` and `beta_1`.
    pub coefficients: Coefficients<f64>,
    /// Mass-normalised mode shapes at the location (kg^-1/2).
    pub phi: &'a [f64],
    /// Modal speeds before the impact (kg^1/2 m/s).
    pub rates: &'a [f64],
}

/// The result of the impact.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct MovingRebound {
    /// Velocity of the striker, positive away from the structure (m/s).
    pub velocity_m_s: f64,
    /// Impulse on the striker (N s); zero if the two were not closing.
    pub impulse_n_s: f64,
    /// The number `s` of (4), from which the modal speeds follow.
    pub level: f64,
    /// Share of the demands that was met: 1 unless the energy would grow.
    pub share: f64,
}

impl MovingImpact<'_> {
    /// The impact of least energy under the outward constraints. If the bodies are not closing, nothing happens.
    ///
    /// ```
    /// use emoc::{Coefficients, MovingImpact};
    /// let coefficients = Coefficients { ebar: 0.9, beta0: 0.2, beta1: 0.1 };
    /// let at_rest = MovingImpact { mass_kg: 0.2, velocity_m_s: -1.0, coefficients, phi: &[1.0, 0.6], rates: &[0.0; 2] };
    /// let closed_form = coefficients.rebound(0.2 * 1.36)?.restitution;
    /// assert!((at_rest.rebound()?.velocity_m_s - closed_form).abs() < 1e-14);
    ///
    /// // a structure that comes towards the striker throws it back faster
    /// let met = MovingImpact { rates: &[0.3, 0.0], ..at_rest }.rebound()?;
    /// assert!(met.velocity_m_s > closed_form);
    /// # Ok::<(), emoc::InvalidInput>(())
    /// ```
    ///
    /// # Errors
    /// A mass that is not positive, coefficients out of range, a number that is not finite or beyond 1e60, or lists of
    /// different length.
    pub fn rebound(&self) -> Result<MovingRebound, InvalidInput> {
        self.validate()?;
        let inverse_inertia = 1.0 / self.mass_kg + self.phi.iter().map(|phi| phi * phi).sum::<f64>();
        let closing = self.modes().map(|(phi, rate)| phi * rate).sum::<f64>() - self.velocity_m_s;
        if closing <= 0.0 {
            let velocity_m_s = self.velocity_m_s;
            return Ok(MovingRebound { velocity_m_s, impulse_n_s: 0.0, level: 0.0, share: 1.0 });
        }
        // The impact without demands, in which every mode takes up the whole impulse, is always feasible.
        let plastic = Point { impulse: closing / inverse_inertia, level: f64::MAX };
        let Coefficients { ebar, beta1, .. } = self.coefficients;
        let demanded = [ebar * closing, beta1 * ebar * closing];
        let attained = [0.0, self.outward(&plastic)];
        let attempt = |share: f64| {
            let lowered =
                |i: usize| demanded[i].min(attained[i].max(attained[i] + share * (demanded[i] - attained[i])));
            let found = self.solve(lowered(0), lowered(1));
            found.filter(|point| self.keeps_energy(point))
        };
        let (best, share) = match attempt(1.0) {
            Some(point) => (point, 1.0),
            None => {
                // The feasible shares are those from 0 up to a limit.
                let (mut best, mut met, mut too_much) = (plastic, 0.0, 1.0);
                for _ in 0..SHARE_HALVINGS {
                    let share = 0.5 * (met + too_much);
                    match attempt(share) {
                        Some(point) => (best, met) = (point, share),
                        None => too_much = share,
                    }
                }
                (best, met)
            }
        };
        let Point { impulse: impulse_n_s, level } = best;
        Ok(MovingRebound { velocity_m_s: self.velocity(impulse_n_s), impulse_n_s, level, share })
    }

    /// Modal speed after the impact of mode `k` (kg^1/2 m/s); zero beyond the last mode.
    ///
    /// These are the speeds of least energy in the law. The structure has more energy after a real impact: every lower mode
    /// takes up its part of an impulse that lasts as long as the contact force.
    pub fn modal_rate(&self, rebound: &MovingRebound, k: usize) -> f64 {
        let point = Point { impulse: rebound.impulse_n_s, level: rebound.level };
        self.modes().nth(k).map_or(0.0, |(phi, rate)| point.rate(phi, rate))
    }

    fn validate(&self) -> Result<(), InvalidInput> {
        self.coefficients.validate()?;
        require_positive("mass_kg", self.mass_kg)?;
        let count = self.rates.len();
        require(count == self.phi.len(), ["rates", "len()"], count as f64, "the number of mode shapes")?;
        let allowed = "a number from -1e60 to 1e60";
        let inverse = 1.0 / self.mass_kg;
        require(self.mass_kg.max(inverse) <= LARGEST, "mass_kg", self.mass_kg, "a number from 1e-60 to 1e60")?;
        require(self.coefficients.beta0 <= LARGEST, "beta0", self.coefficients.beta0, "a number from 0 to 1e60")?;
        require(self.velocity_m_s.abs() <= LARGEST, "velocity_m_s", self.velocity_m_s, allowed)?;
        for (field, list) in [("phi", self.phi), ("rates", self.rates)] {
            for (index, &value) in list.iter().enumerate() {
                require(value.abs() <= LARGEST, (field, index), value, allowed)?;
            }
        }
        Ok(())
    }

    /// Shape and speed of each mode.
    fn modes(&self) -> impl Iterator<Item = (f64, f64)> {
        self.phi.iter().copied().zip(self.rates.iter().copied())
    }

    fn velocity(&self, impulse: f64) -> f64 {
        self.velocity_m_s + impulse / self.mass_kg
    }

    /// Whether the energy does not grow beyond rounding of what the bodies exchange: a light striker has only a small share of the
    /// energy of a structure that moves. It is false if numbers overflow.
    fn keeps_energy(&self, point: &Point) -> bool {
        let p = point.impulse;
        let striker = [p * self.velocity_m_s, 0.5 * p * (p / self.mass_kg)];
        let modes = self.modes().flat_map(|(phi, rate)| {
            let change = point.change(phi, rate);
            [change * rate, 0.5 * change * change]
        });
        let [gain, size] =
            striker.into_iter().chain(modes).fold([0.0, 0.0], |[gain, size], e| [gain + e, size + e.abs()]);
        gain <= ENERGY_ROUNDING * size
    }

    /// The left side of (1).
    fn opening(&self, point: &Point) -> f64 {
        self.velocity(point.impulse) - self.modes().map(|(phi, rate)| phi * point.rate(phi, rate)).sum::<f64>()
    }

    /// The left side of (2).
    fn outward(&self, point: &Point) -> f64 {
        let buzz: f64 = self.modes().map(|(phi, rate)| (phi * point.rate(phi, rate)).abs()).sum();
        self.velocity(point.impulse) - self.coefficients.beta0 * buzz
    }

    /// The slope (5).
    fn slope(&self, point: &Point) -> f64 {
        let held = |(phi, rate): (f64, f64)| phi.abs() * (point.rate(phi, rate) + point.level * phi).abs();
        self.velocity(point.impulse) - point.level / self.mass_kg - self.modes().map(held).sum::<f64>()
    }

    /// The smallest energy for the demands (1) and (2); `None` if numbers overflow.
    fn solve(&self, opening: f64, outward: f64) -> Option<Point> {
        let enough = |impulse: f64| {
            let point = self.at(impulse, opening)?;
            (self.outward(&point) >= outward && self.slope(&point) >= 0.0).then_some(point)
        };
        let mut high = self.mass_kg * (opening - self.velocity_m_s).abs();
        let mut best = None;
        for _ in 0..HALVINGS {
            best = enough(high);
            if best.is_some() || !(high > 0.0 && high < FARTHEST) {
                break;
            }
            high *= 2.0;
        }
        let mut best = best?;
        let mut low = 0.0;
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if middle <= low || middle >= high {
                break;
            }
            match enough(middle) {
                Some(point) => (best, high) = (point, middle),
                None => low = middle,
            }
        }
        Some(best)
    }

    /// The smallest level at which (1) is satisfied with this impulse; `None` if there is none.
    fn at(&self, impulse: f64, opening: f64) -> Option<Point> {
        let met = |level: f64| self.opening(&Point { impulse, level }) >= opening;
        if met(0.0) {
            return Some(Point { impulse, level: 0.0 });
        }
        // From here on every mode is at the end of its range.
        let end = |(phi, rate): (f64, f64)| if phi == 0.0 { 0.0 } else { impulse - rate / phi };
        let (mut low, mut high) = (0.0, self.modes().map(end).fold(0.0, f64::max));
        if !met(high) {
            return None;
        }
        for _ in 0..HALVINGS {
            // (1) is linear between the ends of ranges: if both ends of the search are in one piece, the secant is exact, and
            // it is tried once before each halving.
            let [below, above] = [low, high].map(|level| self.opening(&Point { impulse, level }) - opening);
            let secant = low - below * ((high - low) / (above - below));
            for level in [secant, 0.5 * (low + high)] {
                if level > low && level < high {
                    *(if met(level) { &mut high } else { &mut low }) = level;
                }
            }
            if high - low <= f64::EPSILON * high {
                break;
            }
        }
        Some(Point { impulse, level: high })
    }
}

/// An impulse and a level, which determine all speeds.
#[derive(Clone, Copy)]
struct Point {
    impulse: f64,
    level: f64,
}

impl Point {
    /// The speed (4) of a mode.
    fn rate(&self, phi: f64, rate: f64) -> f64 {
        rate + self.change(phi, rate)
    }

    /// Its difference from the speed before the impact.
    fn change(&self, phi: f64, rate: f64) -> f64 {
        let range = phi.abs() * self.impulse;
        (-self.level * phi - rate).clamp(-range, range)
    }
}
