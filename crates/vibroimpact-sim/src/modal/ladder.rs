//! Tables of the steps `h = 2^-j` s: everything about the structure that does not depend on the striker.
//!
//! The excited elastic modes are carried as `alpha_k = phi_k a_k`, so that the structure's displacement at the
//! contact is their plain sum and `alpha_k'' + 2 zeta_k omega_k alpha_k' + omega_k^2 alpha_k = -phi_k^2 F`.

use super::forcing::Forcing;
use super::legendre::{Matrix, Nodal, Q, TAYLOR, dot};
use super::oscillator::{Propagator, propagate};
use super::problem::Mode;

/// Coarsest and finest step: `2^J_MIN` to `2^J_MAX` parts of a second.
pub(crate) const J_MIN: i32 = -120;
pub(crate) const J_MAX: i32 = 200;

/// Step length of a level (s): the number with just this exponent.
pub(crate) fn step_s(j: i32) -> f64 {
    f64::from_bits(((1023 - j) as u64) << 52)
}

/// The coarsest level whose step is not longer than `t` (s), a positive number.
pub(crate) fn level_within(t: f64) -> i32 {
    let exponent = ((t.to_bits() >> 52) & 0x7ff) as i32 - 1023;
    (-exponent).clamp(J_MIN, J_MAX)
}

/// Excited elastic modes: displacement and velocity at the contact, one entry a mode.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Vibration {
    pub alpha: Vec<f64>,
    pub beta: Vec<f64>,
}

/// Free motion over one step of the ladder.
pub(crate) struct Rotation {
    pub p11_less_1: Vec<f64>,
    pub p12: Vec<f64>,
    pub p21: Vec<f64>,
    pub p22: Vec<f64>,
}

#[derive(Default)]
struct Level {
    rotation: Option<Box<Rotation>>,
    forcing: Option<Box<Forcing>>,
}

/// The excited elastic modes of one structure with their tables, filled as levels are first used.
pub(crate) struct Ladder {
    /// The modes, by rising frequency.
    pub modes: Vec<Mode>,
    /// `phi_k^2` (1/kg), `2 zeta_k omega_k` (1/s), `omega_k^2` (1/s^2).
    pub weight: Vec<f64>,
    pub drag: Vec<f64>,
    pub square: Vec<f64>,
    /// No motion of the modes up to this one is faster (rad/s).
    pub turning: Vec<f64>,
    /// Derivatives at zero of the impulse response at the contact, `sum_k phi_k^2 k_k^(p)(0)`.
    pub kernel: [f64; TAYLOR],
    /// No motion is faster than this (rad/s).
    pub fastest_rad_s: f64,
    /// One more than is stepped on, for the half steps of the finest.
    levels: Vec<Level>,
}

impl Ladder {
    pub fn new(mut modes: Vec<Mode>) -> Ladder {
        modes.sort_by(|a, b| a.omega_rad_s.total_cmp(&b.omega_rad_s));
        let weight: Vec<f64> = modes.iter().map(|mode| mode.shape * mode.shape).collect();
        let drag: Vec<f64> = modes.iter().map(|mode| 2.0 * mode.damping_ratio * mode.omega_rad_s).collect();
        let square: Vec<f64> = modes.iter().map(|mode| mode.omega_rad_s * mode.omega_rad_s).collect();
        let mut kernel = [0.0; TAYLOR];
        let mut fastest_rad_s: f64 = 0.0;
        let mut turning = Vec::with_capacity(modes.len());
        for (k, w) in weight.iter().enumerate() {
            let (square, drag) = (square[k], drag[k]);
            fastest_rad_s = fastest_rad_s.max(modes[k].omega_rad_s + drag);
            turning.push(fastest_rad_s);
            let (mut here, mut next) = (0.0, *w);
            for value in kernel.iter_mut() {
                *value += here;
                (here, next) = (next, -drag * next - square * here);
            }
        }
        let levels = std::iter::repeat_with(Level::default).take((J_MAX - J_MIN + 2) as usize).collect();
        Ladder { modes, weight, drag, square, turning, kernel, fastest_rad_s, levels }
    }

    /// Free motion over one step of level `j`.
    pub fn rotate(&mut self, j: i32, state: &mut Vibration) {
        self.rotation(j).apply(state);
    }

    /// How far free motion has moved at the nodes of a step of level `j`, and the compliance there to nodal forces.
    pub fn at_nodes(&mut self, j: i32, state: &Vibration) -> (Nodal, &Matrix) {
        let forcing = self.forcing(j);
        let mut free = [0.0; Q];
        for ((from_alpha, from_beta), (&alpha, &beta)) in
            forcing.at_nodes.iter().zip(state.alpha.iter().zip(&state.beta))
        {
            for i in 0..Q {
                free[i] += from_alpha[i] * alpha + from_beta[i] * beta;
            }
        }
        (free, &forcing.compliance)
    }

    /// Motion over one step of level `j` under a force with these Legendre coefficients; returns how far the sum of the
    /// modes moves, which is known better than where it is.
    pub fn advance(&mut self, j: i32, state: &mut Vibration, force: &Nodal) -> f64 {
        let rotation = self.rotation(j);
        let free = rotation.moves(state);
        rotation.apply(state);
        let forcing = self.forcing(j);
        accumulate(&mut state.alpha, &forcing.displacement, force);
        accumulate(&mut state.beta, &forcing.velocity, force);
        free + dot(&forcing.at_end, force)
    }

    fn rotation(&mut self, j: i32) -> &Rotation {
        let (modes, level) = (&self.modes, &mut self.levels[(j - J_MIN) as usize]);
        level.rotation.get_or_insert_with(|| Box::new(Rotation::new(modes, step_s(j))))
    }

    fn forcing(&mut self, j: i32) -> &Forcing {
        let (coarser, finer) = self.levels.split_at_mut((j + 1 - J_MIN) as usize);
        let (modes, weight) = (&self.modes, &self.weight);
        coarser[(j - J_MIN) as usize].forcing.get_or_insert_with(|| {
            // half a step is a step of the next level
            let half = finer[0].rotation.get_or_insert_with(|| Box::new(Rotation::new(modes, step_s(j + 1))));
            Box::new(Forcing::new(modes, weight, step_s(j), half))
        })
    }
}

/// `state[k] += sum_n table[n][k] force[n]`, in one pass.
fn accumulate(state: &mut [f64], table: &[Vec<f64>; Q], force: &Nodal) {
    let [t0, t1, t2, t3, t4, t5, t6, t7] = table.each_ref().map(|row| &row[..state.len()]);
    let [f0, f1, f2, f3, f4, f5, f6, f7] = *force;
    for k in 0..state.len() {
        state[k] +=
            (t0[k] * f0 + t1[k] * f1 + t2[k] * f2 + t3[k] * f3) + (t4[k] * f4 + t5[k] * f5 + t6[k] * f6 + t7[k] * f7);
    }
}

impl Rotation {
    pub fn new(modes: &[Mode], h: f64) -> Rotation {
        let [mut p11_less_1, mut p12, mut p21, mut p22] = [(); 4].map(|()| Vec::with_capacity(modes.len()));
        for mode in modes {
            let p = propagate(mode, h);
            p11_less_1.push(p.p11_less_1);
            p12.push(p.p12);
            p21.push(p.p21);
            p22.push(p.p22);
        }
        Rotation { p11_less_1, p12, p21, p22 }
    }

    /// Free motion of one mode.
    pub fn of(&self, k: usize) -> Propagator {
        Propagator { p11_less_1: self.p11_less_1[k], p12: self.p12[k], p21: self.p21[k], p22: self.p22[k] }
    }

    /// How far free motion moves the sum of the modes, to rounding of this distance. A loop of its own: summed up in that of
    /// `apply`, it would keep that one from the vector units.
    fn moves(&self, state: &Vibration) -> f64 {
        let n = self.p12.len();
        let (less, p12) = (&self.p11_less_1[..n], &self.p12[..n]);
        let (alpha, beta) = (&state.alpha[..n], &state.beta[..n]);
        (0..n).map(|k| less[k] * alpha[k] + p12[k] * beta[k]).sum()
    }

    fn apply(&self, state: &mut Vibration) {
        let n = self.p12.len();
        let (less, p12, p21, p22) = (&self.p11_less_1[..n], &self.p12[..n], &self.p21[..n], &self.p22[..n]);
        let (alpha, beta) = (&mut state.alpha[..n], &mut state.beta[..n]);
        for k in 0..n {
            let (a, b) = (alpha[k], beta[k]);
            alpha[k] = a + (less[k] * a + p12[k] * b);
            beta[k] = p21[k] * a + p22[k] * b;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_are_the_powers_of_two_that_fit() {
        for t in [1.0, 0.7, 0.5, 1e-9, 3.3e-20, 1e20] {
            let h = step_s(level_within(t));
            assert!(h <= t && 2.0 * h > t, "{t}");
        }
        assert_eq!((level_within(1e300), level_within(1e-300)), (J_MIN, J_MAX));
    }
}
