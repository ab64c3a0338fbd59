//! Semi-analytical solution of the first contact (thesis 2.3).
//!
//! With `C = k_H = 1` and contact lasting from 0 to 1, the force is expanded in the polynomials
//! `phi_k` that Gram-Schmidt makes from `t^2 (1-t)^2 t^(k-1)` (Eqs. 2.14 to 2.20), which are
//! `t^2 (1-t)^2` times Jacobi polynomials of weight `t^4 (1-t)^4`. For a given speed `v` the mass `m`
//! and the coefficients follow from `x(1) = 0` (Eq. 2.24) and from the residual `f^2 - x^3` being
//! orthogonal to every `phi_k` (Eqs. 2.23, 2.25), by Newton's method and continuation from the
//! limit of small speeds, in which the beam does not move.

use super::problem::S_RANGE;
use super::rule::gauss;
use invalid_input::InvalidInput;

/// First contact with a beam, in units in which `C = k_H = 1` and the contact lasts for a unit of time.
#[derive(Debug, Clone, PartialEq)]
pub struct FirstContact {
    /// Speed of impact `v`.
    pub speed: f64,
    /// Mass `m` of the body.
    pub mass: f64,
    /// `S = m^8 v`.
    pub s: f64,
    /// Coefficients `a_k` of the force.
    pub coefficients: Vec<f64>,
}

/// The quantity that continuation holds fixed.
#[derive(Debug, Clone, Copy)]
enum Given {
    Speed,
    S,
}

/// Logarithm of a speed gentle enough for the limit of a beam at rest to be a good guess.
const GENTLE: f64 = 0.0;
/// Largest tensile force, relative to the largest force, that is tolerated.
const UNDERSHOOT: f64 = 0.03;
/// Duration of Hertz contact with a rigid support in its natural unit (Hertz 1882).
const RIGID_DURATION: f64 = 3.218_065_459_719_043;

impl FirstContact {
    /// For a speed of impact (thesis: 70 and 125 in Fig. 2.6) with `n` functions (thesis: 6).
    ///
    /// # Errors
    /// [`InvalidInput`] if `n` is not 2 to 16, the speed not within 1e-3 to 1e4, or no solution with
    /// `f >= 0` can be reached from smaller speeds.
    ///
    /// ```
    /// let contact = vibroimpact_sim::infinite::FirstContact::at_speed(70.0, 6)?;
    /// assert!((contact.mass - 0.555).abs() < 1e-3);
    /// # Ok::<(), vibroimpact_sim::InvalidInput>(())
    /// ```
    pub fn at_speed(speed: f64, n: usize) -> Result<FirstContact, InvalidInput> {
        InvalidInput::unless((1e-3..=1e4).contains(&speed), "speed", speed, "a number from 1e-3 to 1e4")?;
        follow(Given::Speed, speed.ln(), n, "speed", speed)
    }

    /// For a value of `S` with `n` functions.
    ///
    /// # Errors
    /// [`InvalidInput`] if `n` is not 2 to 16, `s` out of [`S_RANGE`], or no solution with `f >= 0` can
    /// be reached from smaller `S`.
    pub fn at_s(s: f64, n: usize) -> Result<FirstContact, InvalidInput> {
        InvalidInput::unless(S_RANGE.contains(&s), "s", s, "a number from 1e-12 to 1e10")?;
        follow(Given::S, s.ln(), n, "s", s)
    }

    /// Force at time `t` (0 before 0 and after 1), in units of `k_H` times length^1.5.
    pub fn force(&self, t: f64) -> f64 {
        if !(0.0..=1.0).contains(&t) {
            return 0.0;
        }
        functions(t, self.coefficients.len()).iter().zip(&self.coefficients).map(|(phi, a)| a * phi).sum()
    }

    /// Velocity of the body at separation over that at impact, `v_f / v`, positive if it rebounds.
    pub fn rebound_ratio(&self) -> f64 {
        let impulse: f64 = gauss(32).iter().map(|&(t, w)| w * self.force(t)).sum();
        impulse / (self.mass * self.speed) - 1.0
    }

    /// Duration of contact in units of `T`.
    pub fn duration(&self) -> f64 {
        1.0 / (self.mass * self.mass)
    }

    /// Force at time `t` in units of `F`, where `t` is in units of `T`.
    pub fn nondimensional_force(&self, t: f64) -> f64 {
        self.force(t / self.duration()) * self.mass / self.speed
    }
}

/// The orthonormal functions `phi_1 .. phi_n` at `t`.
pub(super) fn functions(t: f64, n: usize) -> Vec<f64> {
    let bump = (t * (1.0 - t)).powi(2);
    let u = 2.0 * t - 1.0;
    // Gegenbauer polynomials C_k^(9/2), and their norms on (0, 1)
    let mut c = vec![1.0; n];
    if n > 1 {
        c[1] = 9.0 * u;
    }
    for k in 2..n {
        let j = k as f64;
        c[k] = (2.0 * (j + 3.5) * u * c[k - 1] - (j + 7.0) * c[k - 2]) / j;
    }
    // squared norm h_k with h_0 = B(5,5) = 1/630, h_k / h_(k-1) = (k + 8)(k + 7/2) / (k (k + 9/2))
    let mut norm = 1.0 / 630.0_f64;
    for (k, value) in c.iter_mut().enumerate() {
        if k > 0 {
            let j = k as f64;
            norm *= (j + 8.0) * (j + 3.5) / (j * (j + 4.5));
        }
        *value *= bump / norm.sqrt();
    }
    c
}

/// Values of the functions and of their integrals at the quadrature points; the last is `t = 1`.
struct Grid {
    weight: Vec<f64>,
    phi: Vec<Vec<f64>>,
    /// `int_0^t sqrt(t - s) phi_k ds`.
    beam: Vec<Vec<f64>>,
    /// `int_0^t (t - s) phi_k ds`.
    body: Vec<Vec<f64>>,
    time: Vec<f64>,
}

impl Grid {
    fn new(n: usize) -> Grid {
        // products of up to three displacements and a function are polynomials in sqrt(t) of degree
        // 9 (n + 3) at most
        let points = gauss(5 * n + 20);
        let inner = gauss(n + 8);
        let mut grid = Grid { weight: vec![], phi: vec![], beam: vec![], body: vec![], time: vec![] };
        for (y, w) in points.into_iter().chain([(1.0, 0.0)]) {
            let t = y * y;
            let (mut beam, mut body) = (vec![0.0; n], vec![0.0; n]);
            for &(q, wq) in &inner {
                let lag = t * q * q;
                let part = wq * 2.0 * t * q;
                for (k, phi) in functions(t - lag, n).into_iter().enumerate() {
                    beam[k] += part * lag.sqrt() * phi;
                    body[k] += part * lag * phi;
                }
            }
            grid.weight.push(w * 2.0 * y);
            grid.phi.push(functions(t, n));
            grid.beam.push(beam);
            grid.body.push(body);
            grid.time.push(t);
        }
        grid
    }
}

/// Follows the physical branch from the gentle limit to `ln(v)` or `ln(S)` = `target`.
fn follow(given: Given, target: f64, n: usize, field: &'static str, value: f64) -> Result<FirstContact, InvalidInput> {
    InvalidInput::unless((2..=16).contains(&n), "n", n, "a number from 2 to 16")?;
    let grid = Grid::new(n);
    // gentle limit: m v / tau = (v tau)^(3/2), tau = 1 / RIGID_DURATION
    let tau = 1.0 / RIGID_DURATION;
    let gentle = match given {
        Given::Speed => GENTLE.min(target),
        Given::S => (20.0 * tau.ln() + 5.0 * GENTLE).min(target),
    };
    let nu = match given {
        Given::Speed => gentle,
        Given::S => (gentle - 20.0 * tau.ln()) / 5.0,
    };
    let mu = 2.5 * tau.ln() + 0.5 * nu;
    let peak = (1.25_f64.powf(0.4) * nu.exp() * tau).powf(1.5);
    let mut unknowns: Vec<f64> = (0..n)
        .map(|k| {
            let shape = |t: f64| (std::f64::consts::PI * t).sin().powf(1.5);
            grid.time
                .iter()
                .zip(&grid.weight)
                .zip(&grid.phi)
                .map(|((&t, w), phi)| w * peak * shape(t.min(1.0)).max(0.0) * phi[k])
                .sum()
        })
        .chain([mu, nu])
        .collect();
    let nothing = || {
        let allowed = "smaller, because the branch with f >= 0 cannot be followed to this value with n functions";
        InvalidInput::new(field, value, allowed)
    };
    let (mut at, mut step) = (gentle, 0.1_f64);
    unknowns = newton(&grid, given, at, unknowns).ok_or_else(nothing)?;
    let mut before: Option<(f64, Vec<f64>)> = None;
    while at < target {
        let next = (at + step).min(target);
        // extrapolate along the branch
        let guess: Vec<f64> = match &before {
            Some((old, values)) => {
                let ratio = (next - at) / (at - old);
                unknowns.iter().zip(values).map(|(new, old)| new + ratio * (new - old)).collect()
            }
            None => unknowns.clone(),
        };
        match newton(&grid, given, next, guess).filter(|found| physical(&grid, found)) {
            Some(found) => {
                before = Some((at, std::mem::replace(&mut unknowns, found)));
                at = next;
                step = (1.5 * step).min(0.1);
            }
            None => {
                step *= 0.5;
                if step < 1e-4 {
                    return Err(nothing());
                }
            }
        }
    }
    if !physical(&grid, &unknowns) {
        return Err(nothing());
    }
    let (mass, speed) = (unknowns[n].exp(), unknowns[n + 1].exp());
    unknowns.truncate(n);
    Ok(FirstContact { speed, mass, s: mass.powi(8) * speed, coefficients: unknowns })
}

/// Whether the force is compressive all the time, to plotting accuracy: a polynomial that approximates
/// `t^(3/2)` at the ends may become negative there by a few percent (at the largest S), while the unphysical
/// solutions have tensile forces as large as the compressive ones.
fn physical(grid: &Grid, unknowns: &[f64]) -> bool {
    let force = |phi: &Vec<f64>| phi.iter().zip(unknowns).map(|(phi, a)| a * phi).sum::<f64>();
    let (low, high) = grid.phi.iter().map(force).fold((0.0_f64, 0.0_f64), |(low, high), f| (low.min(f), high.max(f)));
    low >= -UNDERSHOOT * high
}

/// Newton's method for `(a_1 .. a_n, ln m, ln v)`; `None` if it does not converge.
fn newton(grid: &Grid, given: Given, target: f64, mut unknowns: Vec<f64>) -> Option<Vec<f64>> {
    let n = unknowns.len() - 2;
    for _ in 0..30 {
        let (m, v) = (unknowns[n].exp(), unknowns[n + 1].exp());
        let mut system = vec![vec![0.0; n + 3]; n + 2];
        for (i, &t) in grid.time.iter().enumerate() {
            let last = i + 1 == grid.time.len();
            let (mut f, mut x, mut x_mu) = (0.0, v * t, 0.0);
            for k in 0..n {
                f += unknowns[k] * grid.phi[i][k];
                x -= unknowns[k] * (grid.beam[i][k] + grid.body[i][k] / m);
                x_mu += unknowns[k] * grid.body[i][k] / m;
            }
            let x_a = |j: usize| -(grid.beam[i][j] + grid.body[i][j] / m);
            if last {
                // Eq. 2.24
                (0..n).for_each(|j| system[n][j] = x_a(j));
                (system[n][n], system[n][n + 1], system[n][n + 2]) = (x_mu, v * t, -x);
                continue;
            }
            for k in 0..n {
                // Eq. 2.25
                let w = grid.weight[i] * grid.phi[i][k];
                for j in 0..n {
                    system[k][j] += w * (2.0 * f * grid.phi[i][j] - 3.0 * x * x * x_a(j));
                }
                system[k][n] -= w * 3.0 * x * x * x_mu;
                system[k][n + 1] -= w * 3.0 * x * x * v * t;
                system[k][n + 2] -= w * (f * f - x * x * x);
            }
        }
        let present = match given {
            Given::Speed => unknowns[n + 1],
            Given::S => 8.0 * unknowns[n] + unknowns[n + 1],
        };
        system[n + 1][n] = if matches!(given, Given::S) { 8.0 } else { 0.0 };
        system[n + 1][n + 1] = 1.0;
        system[n + 1][n + 2] = target - present;
        let step = eliminate(system)?;
        // a step changes no logarithm by more than 1
        let damp = (1.0 / step[n].abs().max(step[n + 1].abs()).max(1.0)).min(1.0);
        let size = unknowns[..n].iter().fold(0.0_f64, |size, a| size.max(a.abs()));
        let change = step[..n].iter().fold(0.0_f64, |change, s| change.max(s.abs())) / size + step[n].abs();
        unknowns.iter_mut().zip(&step).for_each(|(u, s)| *u += damp * s);
        if !change.is_finite() {
            return None;
        }
        if change < 1e-12 {
            return Some(unknowns);
        }
    }
    None
}

/// Solves a linear system given with its right-hand side as last column.
fn eliminate(mut rows: Vec<Vec<f64>>) -> Option<Vec<f64>> {
    let n = rows.len();
    for row in &mut rows {
        let scale = row[..n].iter().fold(0.0_f64, |scale, a| scale.max(a.abs()));
        row.iter_mut().for_each(|a| *a /= scale);
    }
    for k in 0..n {
        let best = (k..n).max_by(|&i, &j| rows[i][k].abs().total_cmp(&rows[j][k].abs()))?;
        rows.swap(k, best);
        let pivot = rows[k].clone();
        if pivot[k] == 0.0 || pivot[k].is_nan() {
            return None;
        }
        for row in &mut rows[k + 1..] {
            let factor = row[k] / pivot[k];
            row.iter_mut().zip(&pivot).for_each(|(a, p)| *a -= factor * p);
        }
    }
    let mut solution = vec![0.0; n];
    for k in (0..n).rev() {
        let known: f64 = (k + 1..n).map(|j| rows[k][j] * solution[j]).sum();
        solution[k] = (rows[k][n] - known) / rows[k][k];
    }
    Some(solution)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The functions printed in the thesis, Eqs. 2.15 to 2.20, and their orthogonality.
    #[test]
    fn functions_are_those_of_the_thesis() {
        for t in [0.1_f64, 0.35, 0.8] {
            let b = (t * (t - 1.0)).powi(2) * 3.0;
            let w = 2.0 * t - 1.0;
            let printed = [
                b * 70f64.sqrt(),
                b * w * 770f64.sqrt(),
                b * (22.0 * t * t - 22.0 * t + 5.0) * 182f64.sqrt(),
                b * w * (26.0 * t * t - 26.0 * t + 5.0) * 770f64.sqrt(),
            ];
            for (ours, printed) in functions(t, 6).iter().zip(printed) {
                assert!((ours / printed - 1.0).abs() < 1e-13, "{ours} {printed}");
            }
        }
        let product = |j: usize, k: usize| -> f64 {
            gauss(30).iter().map(|&(t, w)| w * functions(t, 9)[j] * functions(t, 9)[k]).sum()
        };
        for j in 0..9 {
            for k in 0..9 {
                assert!((product(j, k) - f64::from(u8::from(j == k))).abs() < 1e-13);
            }
        }
    }
}
