//! Tables of the steps `h = 2^-j` s: everything about the structure that does not depend on the striker.
//!
//! The excited elastic modes are carried as `alpha_k = phi_k a_k`, so that the structure's displacement at the
//! contact is their plain sum and `alpha_k'' + 2 zeta_k omega_k alpha_k' + omega_k^2 alpha_k = -phi_k^2 F`.

use super::legendre::{BASIS, Matrix, Nodal, Q, TAYLOR};
use super::oscillator::{propagate, response};
use super::problem::Mode;

/// Coarsest and finest step: `2^J_MIN` to `2^J_MAX` parts of a second.
pub(crate) const J_MIN: i32 = -120;
pub(crate) const J_MAX: i32 = 200;

/// A mode that turns by less than this (rad) in a step is expanded in a power series.
const SLOW: f64 = 0.5;

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
struct Rotation {
    p11: Vec<f64>,
    p12: Vec<f64>,
    p21: Vec<f64>,
    p22: Vec<f64>,
}

/// What a step in contact needs beyond the rotation.
struct Forcing {
    /// Free displacement at the nodes, per mode: from `alpha`, from `beta`.
    at_nodes: Vec<(Nodal, Nodal)>,
    /// Response at the nodes, summed over the modes, to nodal forces.
    compliance: Matrix,
    /// Response of each mode at the end of the step, `[n][k]` for Legendre force `n`.
    displacement: [Vec<f64>; Q],
    velocity: [Vec<f64>; Q],
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
    /// `phi_k^2` (1/kg).
    pub weight: Vec<f64>,
    /// Derivatives at zero of the impulse response at the contact, `sum_k phi_k^2 k_k^(p)(0)`.
    pub kernel: [f64; TAYLOR],
    /// No motion is faster than this (rad/s).
    pub fastest_rad_s: f64,
    levels: Vec<Level>,
}

impl Ladder {
    pub fn new(mut modes: Vec<Mode>) -> Ladder {
        modes.sort_by(|a, b| a.omega_rad_s.total_cmp(&b.omega_rad_s));
        let weight: Vec<f64> = modes.iter().map(|mode| mode.shape * mode.shape).collect();
        let mut kernel = [0.0; TAYLOR];
        let mut fastest_rad_s: f64 = 0.0;
        for (mode, w) in modes.iter().zip(&weight) {
            let (square, drag) = (mode.omega_rad_s * mode.omega_rad_s, 2.0 * mode.damping_ratio * mode.omega_rad_s);
            fastest_rad_s = fastest_rad_s.max(mode.omega_rad_s + drag);
            let (mut here, mut next) = (0.0, *w);
            for value in kernel.iter_mut() {
                *value += here;
                (here, next) = (next, -drag * next - square * here);
            }
        }
        let levels = std::iter::repeat_with(Level::default).take((J_MAX - J_MIN + 1) as usize).collect();
        Ladder { modes, weight, kernel, fastest_rad_s, levels }
    }

    /// Free motion over one step of level `j`.
    pub fn rotate(&mut self, j: i32, state: &mut Vibration) {
        let rotation = rotation(&mut self.levels[(j - J_MIN) as usize], &self.modes, j);
        rotation.apply(state);
    }

    /// Free displacement at the nodes of a step of level `j`, and the compliance there to nodal forces.
    pub fn at_nodes(&mut self, j: i32, state: &Vibration) -> (Nodal, &Matrix) {
        let forcing = forcing(&mut self.levels[(j - J_MIN) as usize], &self.modes, &self.weight, j);
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

    /// Motion over one step of level `j` under a force with these Legendre coefficients.
    pub fn advance(&mut self, j: i32, state: &mut Vibration, force: &Nodal) {
        let level = &mut self.levels[(j - J_MIN) as usize];
        rotation(level, &self.modes, j).apply(state);
        let forcing = forcing(level, &self.modes, &self.weight, j);
        accumulate(&mut state.alpha, &forcing.displacement, force);
        accumulate(&mut state.beta, &forcing.velocity, force);
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

fn rotation<'a>(level: &'a mut Level, modes: &[Mode], j: i32) -> &'a Rotation {
    level.rotation.get_or_insert_with(|| Box::new(Rotation::new(modes, step_s(j))))
}

fn forcing<'a>(level: &'a mut Level, modes: &[Mode], weight: &[f64], j: i32) -> &'a Forcing {
    level.forcing.get_or_insert_with(|| Box::new(Forcing::new(modes, weight, step_s(j))))
}

impl Rotation {
    fn new(modes: &[Mode], h: f64) -> Rotation {
        let (mut p11, mut p12, mut p21, mut p22) = (vec![], vec![], vec![], vec![]);
        for mode in modes {
            let p = propagate(mode, h);
            p11.push(p.p11);
            p12.push(p.p12);
            p21.push(p.p21);
            p22.push(p.p22);
        }
        Rotation { p11, p12, p21, p22 }
    }

    fn apply(&self, state: &mut Vibration) {
        let n = self.p11.len();
        let (p11, p12, p21, p22) = (&self.p11[..n], &self.p12[..n], &self.p21[..n], &self.p22[..n]);
        let (alpha, beta) = (&mut state.alpha[..n], &mut state.beta[..n]);
        for k in 0..n {
            let (a, b) = (alpha[k], beta[k]);
            alpha[k] = p11[k] * a + p12[k] * b;
            beta[k] = p21[k] * a + p22[k] * b;
        }
    }
}

/// What one mode contributes to a level.
struct Part {
    /// Free displacement at the nodes, from displacement and from velocity.
    at_nodes: (Nodal, Nodal),
    /// Displacement and velocity at the end of the step to unit Legendre forces, for unit weight.
    end: (Nodal, Nodal),
}

impl Part {
    /// A mode that turns by less than [`SLOW`] in the step: power series, whose terms serve nodes and end alike.
    fn slow(mode: &Mode, h: f64, kernel: &mut [f64; TAYLOR], weight: f64) -> Part {
        let basis = &*BASIS;
        let (square, drag) = (mode.omega_rad_s * mode.omega_rad_s, 2.0 * mode.damping_ratio * mode.omega_rad_s);
        let mut part = Part { at_nodes: ([0.0; Q], [0.0; Q]), end: ([0.0; Q], [0.0; Q]) };
        // derivatives of the free motions that start with unit displacement and with unit velocity
        let (mut one, mut one_next) = (1.0, 0.0);
        let (mut other, mut other_next) = (0.0, 1.0);
        let mut power = 1.0;
        for p in 0..TAYLOR {
            kernel[p] += weight * other;
            for i in 0..Q {
                part.at_nodes.0[i] += one * power * basis.node_powers[p][i];
                part.at_nodes.1[i] += other * power * basis.node_powers[p][i];
                part.end.0[i] += other * power * h * basis.power_legendre[p][i];
                part.end.1[i] += other_next * power * h * basis.power_legendre[p][i];
            }
            (one, one_next) = (one_next, -drag * one_next - square * one);
            (other, other_next) = (other_next, -drag * other_next - square * other);
            power *= h;
        }
        part
    }

    /// Any mode; adds its response at the nodes to Legendre forces to `compliance`.
    fn fast(mode: &Mode, h: f64, compliance: &mut Matrix, weight: f64) -> Part {
        let basis = &*BASIS;
        let mut at_nodes = ([0.0; Q], [0.0; Q]);
        for i in 0..Q {
            let part = basis.nodes[i] * h;
            let p = propagate(mode, part);
            (at_nodes.0[i], at_nodes.1[i]) = (p.p11, p.p12);
            let (to_node, _) = response(mode, part);
            for l in 0..Q {
                for m in 0..=l {
                    compliance[i][l] -= weight * basis.restricted[i][l][m] * to_node[m];
                }
            }
        }
        Part { at_nodes, end: response(mode, h) }
    }
}

impl Forcing {
    fn new(modes: &[Mode], weight: &[f64], h: f64) -> Forcing {
        let basis = &*BASIS;
        let mut at_nodes = Vec::with_capacity(modes.len());
        let mut displacement = [const { Vec::new() }; Q];
        let mut velocity = [const { Vec::new() }; Q];
        for table in displacement.iter_mut().chain(velocity.iter_mut()) {
            table.reserve_exact(modes.len());
        }
        // slow modes answer through the series of their common impulse response, the others one by one
        let (mut kernel, mut legendre_compliance) = ([0.0; TAYLOR], [[0.0; Q]; Q]);
        for (mode, &w) in modes.iter().zip(weight) {
            let part = if mode.omega_rad_s * (1.0 + 2.0 * mode.damping_ratio) * h < SLOW {
                Part::slow(mode, h, &mut kernel, w)
            } else {
                Part::fast(mode, h, &mut legendre_compliance, w)
            };
            at_nodes.push(part.at_nodes);
            for n in 0..Q {
                displacement[n].push(-w * part.end.0[n]);
                velocity[n].push(-w * part.end.1[n]);
            }
        }
        let mut compliance = [[0.0; Q]; Q];
        let mut power = h;
        for p in 0..TAYLOR {
            for i in 0..Q {
                for j in 0..Q {
                    compliance[i][j] -= kernel[p] * power * basis.power[p][i][j];
                }
            }
            power *= h;
        }
        for i in 0..Q {
            for l in 0..Q {
                for j in 0..Q {
                    compliance[i][j] += legendre_compliance[i][l] * basis.to_coefficients[l][j];
                }
            }
        }
        Forcing { at_nodes, compliance, displacement, velocity }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_series_of_slow_modes_meet_the_closed_forms() {
        for (omega, damping_ratio) in [(0.49, 0.0), (0.45, 0.02), (0.2, 0.9), (1e-9, 0.1)] {
            let (mode, h) = (Mode { omega_rad_s: omega, damping_ratio, shape: 1.0 }, 1.0);
            let (mut kernel, mut one_by_one) = ([0.0; TAYLOR], [[0.0; Q]; Q]);
            let (slow, fast) = (Part::slow(&mode, h, &mut kernel, 1.0), Part::fast(&mode, h, &mut one_by_one, 1.0));
            let close = |a: &Nodal, b: &Nodal, what: &str| {
                for i in 0..Q {
                    assert!((a[i] - b[i]).abs() < 1e-14, "{omega} {damping_ratio} {what} {i}: {} {}", a[i], b[i]);
                }
            };
            close(&slow.at_nodes.0, &fast.at_nodes.0, "from displacement");
            close(&slow.at_nodes.1, &fast.at_nodes.1, "from velocity");
            close(&slow.end.0, &fast.end.0, "displacement");
            close(&slow.end.1, &fast.end.1, "velocity");
        }
    }

    #[test]
    fn levels_are_the_powers_of_two_that_fit() {
        for t in [1.0, 0.7, 0.5, 1e-9, 3.3e-20, 1e20] {
            let h = step_s(level_within(t));
            assert!(h <= t && 2.0 * h > t, "{t}");
        }
        assert_eq!((level_within(1e300), level_within(1e-300)), (J_MIN, J_MAX));
    }
}
