//! Bending waves on a stepped beam: count of Wittrick and Williams, characteristic function, and the states from
//! which mode shapes are unrolled.
//!
//! Everything is dimensionless (see `span`); the trial value is `q = sqrt(omega)`, and a span's wave number is
//! `k = q (m/EI)^(1/4)`.

use crate::beam::End;
use crate::piece::{Piece, SHORT, krylov};
use crate::plane::{Crossing, Handover, Plane, State, combine, form, reflect};
use crate::roots::Characteristic;
use crate::shapes::{Match, Waveguide};
use crate::span::Span;

#[derive(Debug, Clone)]
pub(crate) struct Flexure {
    spans: Vec<Span>,
    ends: [End; 2],
    /// `(m/EI)^(1/4)` of each span.
    wave_numbers: Vec<f64>,
    /// `sum k l / q`.
    phase: f64,
    /// Factors of the state from span `i` to span `i + 1`.
    steps: Vec<State>,
}

/// The plane of one end at one frequency, on its way along the beam; both lists in the order of the spans.
struct Sweep {
    crossings: Vec<Crossing>,
    /// At every step between spans.
    handovers: Vec<Handover>,
}

/// Those of both ends.
pub(crate) struct Sweeps {
    left: Sweep,
    right: Sweep,
}

/// The states an end allows: two of the four unit vectors.
pub(crate) fn allowed(end: End) -> [usize; 2] {
    match end {
        End::Clamped => [2, 3],
        End::Pinned => [1, 3],
        End::Free => [0, 1],
        End::Guided => [0, 2],
    }
}

/// The two components that an end makes zero.
pub(crate) fn constrained(end: End) -> [usize; 2] {
    match end {
        End::Clamped => [0, 1],
        End::Pinned => [0, 2],
        End::Free => [2, 3],
        End::Guided => [1, 3],
    }
}

fn end_plane(end: End) -> Plane {
    Plane(allowed(end).map(|i| {
        let mut unit = [0.0; 4];
        unit[i] = 1.0;
        unit
    }))
}

impl Flexure {
    pub fn new(spans: Vec<Span>, ends: [End; 2]) -> Self {
        let wave_numbers: Vec<f64> = spans.iter().map(|s| (s.mass / s.rigidity).sqrt().sqrt()).collect();
        let steps = (1..spans.len())
            .map(|i| {
                let (left, right) = (&spans[i - 1], &spans[i]);
                let slower = wave_numbers[i - 1] / wave_numbers[i];
                let rho = (right.rigidity / left.rigidity / slower.powi(3)).sqrt();
                [rho, rho * slower, 1.0 / (rho * slower), 1.0 / rho]
            })
            .collect();
        let phase = spans.iter().zip(&wave_numbers).map(|(span, k)| span.length * k).sum();
        Self { spans, ends, wave_numbers, phase, steps }
    }

    fn wave_number(&self, i: usize, q: f64) -> f64 {
        q * self.wave_numbers[i]
    }

    /// The plane that one end allows, carried over every span from there; from the right, in reflected variables.
    fn sweep(&self, q: f64, from_right: bool) -> Sweep {
        let n = self.spans.len();
        let mut plane = end_plane(self.ends[usize::from(from_right)]);
        let mut crossings = Vec::with_capacity(n);
        let mut handovers = Vec::with_capacity(n);
        for step in 0..n {
            let i = if from_right { n - 1 - step } else { step };
            let crossing = plane.cross(self.wave_number(i, q), self.spans[i].length);
            if step + 1 < n {
                let handover = if from_right {
                    crossing.exit.rescaled(&self.steps[i - 1].map(|s| 1.0 / s))
                } else {
                    crossing.exit.rescaled(&self.steps[i])
                };
                plane = handover.plane;
                handovers.push(handover);
            }
            crossings.push(crossing);
        }
        if from_right {
            crossings.reverse();
            handovers.reverse();
        }
        Sweep { crossings, handovers }
    }

    /// `w` to the span's own variables: `w = z_0 / sqrt(EI k^3)`, the common power of `q` left out.
    fn amplitude(&self, i: usize) -> f64 {
        1.0 / (self.spans[i].rigidity * self.wave_numbers[i].powi(3)).sqrt()
    }

    /// The characteristic function: zero when the plane holds a state that the right end allows.
    fn at_right_end(&self, Plane([u, v]): &Plane) -> f64 {
        let [m, n] = constrained(self.ends[1]);
        u[m] * v[n] - v[m] * u[n]
    }
}

/// How many eigenvalues of the symmetric matrix `[[p, r], [r, s]]` are negative.
fn negative_eigenvalues(p: f64, r: f64, s: f64) -> usize {
    let determinant = p * s - r * r;
    if determinant < 0.0 {
        1
    } else if p + s < 0.0 {
        if determinant > 0.0 { 2 } else { 1 }
    } else {
        0
    }
}

/// A span with its far end clamped: how many of its doubly clamped frequencies lie below, and its stiffness matrix
/// at the near end, in the span's variables: `(numerator, denominator)`.
fn clamped_span(y: f64) -> (usize, [f64; 3], f64) {
    if y <= SHORT {
        let [c0, c1, c2, c3] = krylov(y);
        let (c1, c2, c3) = (c1 * y, c2 * y * y, c3 * y * y * y);
        // displacement and slope vanish at the far end: solve for z_2, z_3 in terms of z_0, z_1
        return (0, [c0 * c1 - c2 * c3, c1 * c1 - c0 * c2, c1 * c2 - c0 * c3], c2 * c2 - c1 * c3);
    }
    let (sin, cos) = y.sin_cos();
    let decay = (-y.min(600.0)).exp();
    let (cosh, sinh) = (1.0 + decay * decay, 1.0 - decay * decay);
    let denominator = 2.0 * decay - cos * cosh;
    let half_waves = (y / std::f64::consts::PI).floor();
    let even = half_waves % 2.0 == 0.0;
    // floor(y/pi) - (1 - (-1)^i sign(1 - cosh cos)) / 2, Wittrick and Williams
    let excess = usize::from(even != (denominator > 0.0));
    let count = (half_waves as usize).saturating_sub(excess);
    (count, [cos * sinh + sin * cosh, sin * sinh, sin * cosh - cos * sinh], denominator)
}

impl Characteristic for Flexure {
    fn count_and_function(&self, q: f64) -> (usize, f64) {
        let mut plane = end_plane(self.ends[0]);
        let mut count = 0;
        for (i, span) in self.spans.iter().enumerate() {
            let k = self.wave_number(i, q);
            let (inside, [ww, wt, tt], denominator) = clamped_span(k * span.length);
            // U' (K_left + K_span) U times |denominator|: same signature as K_left + K_span, and no pole
            let [u, v] = plane.0;
            let (size, sign) = (denominator.abs(), denominator.signum());
            let entry = |a: &State, b: &State| {
                let span_part = a[0] * (ww * b[0] + wt * b[1]) + a[1] * (wt * b[0] + tt * b[1]);
                let left_part = a[0] * -b[3] + a[1] * b[2];
                sign * span_part + size * left_part
            };
            let off_diagonal = 0.5 * (entry(&u, &v) + entry(&v, &u));
            count += inside + negative_eigenvalues(entry(&u, &u), off_diagonal, entry(&v, &v));
            plane = plane.cross(k, span.length).exit;
            if let Some(scale) = self.steps.get(i) {
                plane = plane.rescaled(scale).plane;
            }
        }
        // the right end releases what it does not constrain
        let [u, v] = plane.0;
        let orientation = (u[0] * v[1] - v[0] * u[1]).signum();
        count += match self.ends[1] {
            End::Clamped => 0,
            End::Pinned => usize::from(orientation * (u[0] * v[2] - v[0] * u[2]) < 0.0),
            End::Guided => usize::from(orientation * (v[3] * u[1] - u[3] * v[1]) < 0.0),
            End::Free => {
                let entry = |a: &State, b: &State| a[0] * -b[3] + a[1] * b[2];
                negative_eigenvalues(entry(&u, &u), 0.5 * (entry(&u, &v) + entry(&v, &u)), entry(&v, &v))
            }
        };
        (count, self.at_right_end(&plane))
    }

    fn function(&self, q: f64) -> f64 {
        let mut plane = end_plane(self.ends[0]);
        for (i, span) in self.spans.iter().enumerate() {
            plane = plane.cross(self.wave_number(i, q), span.length).exit;
            if let Some(scale) = self.steps.get(i) {
                plane = plane.rescaled(scale).plane;
            }
        }
        self.at_right_end(&plane)
    }

    fn estimate(&self, count: usize) -> f64 {
        (count as f64 + 1.0) * std::f64::consts::PI / self.phase
    }
}

impl Waveguide for Flexure {
    type Sweeps = Sweeps;

    fn spans(&self) -> &[Span] {
        &self.spans
    }

    fn leading_order(&self) -> usize {
        allowed(self.ends[0])[0]
    }

    fn spacing(&self) -> f64 {
        std::f64::consts::PI / self.phase
    }

    fn sweeps(&self, q: f64) -> Sweeps {
        Sweeps { left: self.sweep(q, false), right: self.sweep(q, true) }
    }

    fn matches(&self, Sweeps { left, right }: &Sweeps) -> Vec<Match> {
        let mut found = Vec::with_capacity(2 * self.spans.len());
        for i in 0..self.spans.len() {
            let Plane([l0, l1]) = if i == 0 { end_plane(self.ends[0]) } else { left.handovers[i - 1].plane };
            let [r0, r1] = right.crossings[i].exit.0.map(|z| reflect(&z));
            let rows = [[form(&l0, &r0), form(&l0, &r1)], [form(&l1, &r0), form(&l1, &r1)]];
            let size = |row: [f64; 2]| row[0] * row[0] + row[1] * row[1];
            let total = size(rows[0]) + size(rows[1]);
            let determinant = (rows[0][0] * rows[1][1] - rows[0][1] * rows[1][0]).abs();
            let largest = (0.5 * (total + (total * total - 4.0 * determinant * determinant).max(0.0).sqrt())).sqrt();
            let smallest = if largest > 0.0 { determinant / largest } else { 0.0 };
            let row = if size(rows[0]) > size(rows[1]) { rows[0] } else { rows[1] };
            let norm = size(row).sqrt();
            let (p, s) = if norm > 0.0 { (-row[1] / norm, row[0] / norm) } else { (1.0, 0.0) };
            found.push(Match { defect: smallest, span: i, state: combine(p, &r0, s, &r1) });
            found.push(Match { defect: largest, span: i, state: combine(-s, &r0, p, &r1) });
        }
        found
    }

    fn unroll(&self, Sweeps { left, right }: &Sweeps, at: &Match) -> Vec<Piece> {
        let mut pieces = vec![None; self.spans.len()];
        let mut state = at.state;
        for i in (0..at.span).rev() {
            let (piece, entry) = left.crossings[i].follow_back(left.handovers[i].coefficients_before(&state));
            pieces[i] = Some(piece.scaled(self.amplitude(i)));
            state = entry;
        }
        let mut coefficients = right.crossings[at.span].exit.coefficients(&reflect(&at.state));
        for i in at.span..self.spans.len() {
            let (piece, entry) = right.crossings[i].follow_back(coefficients);
            pieces[i] = Some(piece.reflected().scaled(self.amplitude(i)));
            if let Some(handover) = right.handovers.get(i) {
                coefficients = handover.coefficients_before(&entry);
            }
        }
        pieces.into_iter().flatten().collect()
    }
}
