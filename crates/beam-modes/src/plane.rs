//! The plane of states that one end of a beam allows, propagated along the beam without loss of digits.
//!
//! The state at a location is `z = sqrt(EI k^3) (w, t/k, M/(EI k^2), -V/(EI k^3))` with the span's own `k` (see `waves`); for
//! Euler-Bernoulli's beam these are the derivatives of `w`. The states that satisfy the two conditions of an end form a plane,
//! and an eigenvalue search needs only an orthonormal basis of it. Over a span the oscillating part rotates, one exponential
//! decays and the other grows: the basis is first rotated so that a single column contains the growing exponential, and that
//! column is normalised at the far end.

use crate::piece::Piece;
use crate::waves::{Form, State, Waves, decay};

/// Two orthonormal columns.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Plane(pub [State; 2]);

/// A span over which the plane was propagated, with the data to follow a state of the plane back.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Crossing {
    waves: Waves,
    /// Columns at the entry of the span: wave amplitudes (long span) or states (short).
    entry: [[f64; 4]; 2],
    /// Factor of the second column over the span.
    shrink: f64,
    /// The amplitude of the second column's growing exponential, normalised at the far end, if there is one.
    arrived: Option<f64>,
    /// Columns before normalisation = `exit` times this.
    triangle: Triangle,
    /// The plane at the exit of the span.
    pub exit: Plane,
}

/// A plane in the variables of the next span.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Handover {
    pub plane: Plane,
    back: Back,
}

/// The transformation of coefficients back.
#[derive(Debug, Clone, Copy)]
enum Back {
    /// The old basis before normalisation = `plane` times this.
    Triangle(Triangle),
    /// The old state is this combination of the old basis, times the coefficient of the second column.
    Support([f64; 2]),
}

/// Upper triangle `(r11, r12, r22)` of the Gram-Schmidt process.
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

/// The state for the opposite direction: odd derivatives change sign.
pub(crate) fn reflect(z: &State) -> State {
    [z[0], -z[1], z[2], -z[3]]
}

/// The bilinear form that is constant along a span: `U_l . P_r + P_l . U_r` with displacements `U = (w, w')` and the conjugate
/// forces `P`, which are `(-w''', w'')` on the left part and the opposite on the right part.
pub(crate) fn form(left: &State, right: &State) -> f64 {
    left[0] * right[3] - left[3] * right[0] - left[1] * right[2] + left[2] * right[1]
}

impl Plane {
    /// Gram-Schmidt process with positive factors only, so that the orientation does not change.
    fn orthonormal(u: State, v: State) -> (Plane, Triangle) {
        let r11 = dot(&u, &u).sqrt();
        let e1 = u.map(|c| c / r11);
        let r12 = dot(&e1, &v);
        let rest = combine(1.0, &v, -r12, &e1);
        // Repeated, because of the rounding of nearly parallel columns.
        let again = dot(&e1, &rest);
        let rest = combine(1.0, &rest, -again, &e1);
        let r22 = dot(&rest, &rest).sqrt();
        (Plane([e1, rest.map(|c| c / r22)]), Triangle(r11, r12 + again, r22))
    }

    /// The same plane in the variables of a neighbouring span.
    pub fn rescaled(&self, scale: &[f64; 4]) -> Handover {
        let apply = |z: &State| [z[0] * scale[0], z[1] * scale[1], z[2] * scale[2], z[3] * scale[3]];
        let (plane, triangle) = Self::orthonormal(apply(&self.0[0]), apply(&self.0[1]));
        Handover { plane, back: Back::Triangle(triangle) }
    }

    /// Coefficients of a state of the plane.
    pub fn coefficients(&self, z: &State) -> [f64; 2] {
        [dot(&self.0[0], z), dot(&self.0[1], z)]
    }

    /// Propagates the plane over a span.
    pub fn cross(&self, waves: &Waves) -> Crossing {
        let y = waves.k * waves.length;
        let Form::Long(pair) = waves.form else {
            let (exit, triangle) = Self::orthonormal(waves.series(&self.0[0], y), waves.series(&self.0[1], y));
            return Crossing { waves: *waves, entry: self.0, shrink: 1.0, arrived: None, triangle, exit };
        };
        let (u, v) = (pair.to_waves(&self.0[0]), pair.to_waves(&self.0[1]));
        let carry = |wave: [f64; 4], factor: f64| pair.to_state(pair.carry(wave, y, factor));
        let Some(kappa) = pair.decay() else {
            let (exit, triangle) = Self::orthonormal(carry(u, 1.0), carry(v, 1.0));
            return Crossing { waves: *waves, entry: [u, v], shrink: 1.0, arrived: None, triangle, exit };
        };
        let growing = u[3].hypot(v[3]);
        let (mut first, mut second, mut shrink, mut arrived) = (u, v, 1.0, 0.0);
        if growing > 1e-150 {
            let (cos, sin) = (v[3] / growing, u[3] / growing);
            first = combine(cos, &u, -sin, &v);
            second = combine(sin, &u, cos, &v);
            (shrink, arrived) = (decay(kappa * y), growing);
        }
        (first[3], second[3]) = (0.0, arrived);
        let (exit, triangle) = Self::orthonormal(carry(first, 1.0), carry(second, shrink));
        Crossing { waves: *waves, entry: [first, second], shrink, arrived: Some(arrived), triangle, exit }
    }

    /// The plane beyond a spring or a mass: the moment grows by `stiffness[1]` times the rotation, the shear force by
    /// `stiffness[0]` times the displacement, both in the units of the state.
    pub fn loaded(&self, stiffness: [f64; 2]) -> Handover {
        let load = |z: &State| [z[0], z[1], z[2] + stiffness[1] * z[1], z[3] - stiffness[0] * z[0]];
        let (plane, triangle) = Self::orthonormal(load(&self.0[0]), load(&self.0[1]));
        Handover { plane, back: Back::Triangle(triangle) }
    }

    /// The plane beyond a rigid support: zero displacement, any shear force.
    pub fn supported(&self) -> Option<Handover> {
        let [u, v] = &self.0;
        let size = u[0].hypot(v[0]);
        let (cos, sin) = if size > 0.0 { (u[0] / size, v[0] / size) } else { (1.0, 0.0) };
        let still = combine(-sin, u, cos, v);
        let norm = still[1].hypot(still[2]);
        // Without displacement, or with displacement only, the plane does not change.
        if size == 0.0 || norm == 0.0 {
            return None;
        }
        let plane = Plane([[0.0, 0.0, 0.0, 1.0], [0.0, still[1] / norm, still[2] / norm, 0.0]]);
        Some(Handover { plane, back: Back::Support([-sin / norm, cos / norm]) })
    }
}

impl Handover {
    /// Coefficients in the basis before the transformation, from those after it. (A transformation of the state itself would
    /// lose the digits of its small components if the spans differ much.)
    pub fn before(&self, after: [f64; 2]) -> [f64; 2] {
        match self.back {
            Back::Triangle(triangle) => triangle.solve(after),
            Back::Support(still) => still.map(|c| c * after[1]),
        }
    }
}

impl Crossing {
    /// From a state's coefficients in the exit plane: the solution on the span, and the state at its entry. Both are in the
    /// variables of the span; the piece runs in the direction of propagation.
    pub fn follow_back(&self, coefficients: [f64; 2]) -> (Piece, State) {
        let [p, q] = self.triangle.solve(coefficients);
        let entry = combine(p, &self.entry[0], q * self.shrink, &self.entry[1]);
        let Form::Long(pair) = self.waves.form else {
            return (Piece::of_waves(&self.waves, entry), entry);
        };
        let arrived = self.arrived.map_or(entry[3], |arrived| q * arrived);
        (Piece::of_waves(&self.waves, [entry[0], entry[1], entry[2], arrived]), pair.to_state(entry))
    }
}
