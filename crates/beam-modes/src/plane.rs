//! The plane of states that one end of a beam allows, carried along the beam without loss.
//!
//! The state at a place is `z = sqrt(EI k^3) (w, w'/k, w''/k^2, w'''/k^3)` with the span's own `k`. The states that
//! satisfy the two conditions of an end form a plane; its orthonormal basis is all that an eigenvalue search needs.
//! Crossing a span turns the oscillating part, shrinks one exponential and stretches the other: the basis is first
//! turned so that a single column holds the growing exponential, and that column is measured at the far end.

use crate::piece::{Piece, SHORT, krylov};

pub(crate) type State = [f64; 4];

/// Two orthonormal columns.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Plane(pub [State; 2]);

/// A span crossed: enough to follow a state of the plane back.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Crossing {
    k: f64,
    length: f64,
    /// Columns where the span was entered: wave amplitudes `a, b, c, d` (long span) or states (short).
    entry: [[f64; 4]; 2],
    /// What the second column was multiplied by on the way.
    shrink: f64,
    /// The amplitude of the second column's growing exponential, measured at the far end.
    arrived: f64,
    /// Columns as they arrived = `exit` times this.
    triangle: Triangle,
    /// The plane where the span was left.
    pub exit: Plane,
}

/// A plane handed to the next span, in that span's variables.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Handover {
    pub plane: Plane,
    /// The old basis, rescaled, = `plane` times this.
    triangle: Triangle,
}

/// Upper triangle `(r11, r12, r22)`: what Gram and Schmidt divided out.
#[derive(Debug, Clone, Copy)]
struct Triangle(f64, f64, f64);

impl Triangle {
    fn solve(&self, [alpha, beta]: [f64; 2]) -> [f64; 2] {
        let q = beta / self.2;
        [(alpha - self.1 * q) / self.0, q]
    }
}

pub(crate) fn dot(u: &State, v: &State) -> f64 {
    u[0] * v[0] + u[1] * v[1] + u[2] * v[2] + u[3] * v[3]
}

pub(crate) fn combine(p: f64, u: &State, q: f64, v: &State) -> State {
    [p * u[0] + q * v[0], p * u[1] + q * v[1], p * u[2] + q * v[2], p * u[3] + q * v[3]]
}

/// The state seen by a traveller in the other direction: odd derivatives change sign.
pub(crate) fn reflect(z: &State) -> State {
    [z[0], -z[1], z[2], -z[3]]
}

/// The bilinear form that stays constant along a span: `U_l . P_r + P_l . U_r` with displacements `U = (w, w')` and the
/// conjugate forces `P` on the left part, `(-w''', w'')`, and on the right part, the opposite.
pub(crate) fn form(left: &State, right: &State) -> f64 {
    left[0] * right[3] - left[3] * right[0] - left[1] * right[2] + left[2] * right[1]
}

fn to_waves(z: &State) -> [f64; 4] {
    let (p, q) = (0.25 * (z[0] + z[2]), 0.25 * (z[1] + z[3]));
    [0.5 * (z[0] - z[2]), 0.5 * (z[1] - z[3]), p - q, p + q]
}

fn from_waves([a, b, c, d]: [f64; 4]) -> State {
    [a + (c + d), b + (d - c), (c + d) - a, (d - c) - b]
}

impl Plane {
    /// Gram-Schmidt; positive factors only, so that orientation is kept.
    fn orthonormal(u: State, v: State) -> (Plane, Triangle) {
        let r11 = dot(&u, &u).sqrt();
        let e1 = u.map(|c| c / r11);
        let r12 = dot(&e1, &v);
        let rest = combine(1.0, &v, -r12, &e1);
        // once more, against the rounding of nearly parallel columns
        let again = dot(&e1, &rest);
        let rest = combine(1.0, &rest, -again, &e1);
        let r22 = dot(&rest, &rest).sqrt();
        (Plane([e1, rest.map(|c| c / r22)]), Triangle(r11, r12 + again, r22))
    }

    /// The same plane in the variables of a neighbouring span.
    pub fn rescaled(&self, scale: &[f64; 4]) -> Handover {
        let apply = |z: &State| [z[0] * scale[0], z[1] * scale[1], z[2] * scale[2], z[3] * scale[3]];
        let (plane, triangle) = Self::orthonormal(apply(&self.0[0]), apply(&self.0[1]));
        Handover { plane, triangle }
    }

    /// Coefficients of a state of the plane.
    pub fn coefficients(&self, z: &State) -> [f64; 2] {
        [dot(&self.0[0], z), dot(&self.0[1], z)]
    }

    /// Carries the plane over a span.
    pub fn cross(&self, k: f64, length: f64) -> Crossing {
        let y = k * length;
        if y <= SHORT {
            let [c0, c1, c2, c3] = krylov(y);
            let (c1, c2, c3) = (c1 * y, c2 * y * y, c3 * y * y * y);
            let carry = |z: &State| {
                [
                    c0 * z[0] + c1 * z[1] + c2 * z[2] + c3 * z[3],
                    c3 * z[0] + c0 * z[1] + c1 * z[2] + c2 * z[3],
                    c2 * z[0] + c3 * z[1] + c0 * z[2] + c1 * z[3],
                    c1 * z[0] + c2 * z[1] + c3 * z[2] + c0 * z[3],
                ]
            };
            let (exit, triangle) = Self::orthonormal(carry(&self.0[0]), carry(&self.0[1]));
            return Crossing { k, length, entry: self.0, shrink: 1.0, arrived: 0.0, triangle, exit };
        }
        let (u, v) = (to_waves(&self.0[0]), to_waves(&self.0[1]));
        let growing = u[3].hypot(v[3]);
        // beyond exp(-600) an exponential is nothing; the floor keeps every quotient finite
        let decay = (-y.min(600.0)).exp();
        let (mut first, mut second, mut shrink, mut arrived) = (u, v, 1.0, 0.0);
        if growing > 1e-150 {
            let (cos, sin) = (v[3] / growing, u[3] / growing);
            first = combine(cos, &u, -sin, &v);
            second = combine(sin, &u, cos, &v);
            (shrink, arrived) = (decay, growing);
        }
        (first[3], second[3]) = (0.0, arrived);
        let (sin, cos) = y.sin_cos();
        let carry = |[a, b, c, _]: [f64; 4], factor: f64, d: f64| {
            from_waves([factor * (a * cos + b * sin), factor * (b * cos - a * sin), factor * decay * c, d])
        };
        let (exit, triangle) = Self::orthonormal(carry(first, 1.0, 0.0), carry(second, shrink, arrived));
        Crossing { k, length, entry: [first, second], shrink, arrived, triangle, exit }
    }
}

impl Handover {
    /// Coefficients, in the basis before the handover, of a state after it. (Taking the state itself back would lose
    /// the digits of its small components where the spans differ much.)
    pub fn coefficients_before(&self, z: &State) -> [f64; 2] {
        self.triangle.solve(self.plane.coefficients(z))
    }
}

impl Crossing {
    /// From a state's coefficients in the exit plane: the solution on the span, and the state where the span was
    /// entered. Both in the variables of the span; the piece runs in the direction of travel.
    pub fn follow_back(&self, coefficients: [f64; 2]) -> (Piece, State) {
        let [p, q] = self.triangle.solve(coefficients);
        let (k, length) = (self.k, self.length);
        let entry = combine(p, &self.entry[0], q * self.shrink, &self.entry[1]);
        if k * length <= SHORT {
            let start = [entry[0], entry[1] * k, entry[2] * k * k, entry[3] * k * k * k];
            return (Piece::Short { k, length, start }, entry);
        }
        let wave = [entry[0], entry[1], entry[2], q * self.arrived];
        (Piece::Long { k, length, wave }, from_waves(entry))
    }
}
