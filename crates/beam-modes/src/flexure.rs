//! Bending waves on a stepped beam: count of Wittrick and Williams, characteristic function, and the states from which mode
//! shapes are computed.
//!
//! Everything is dimensionless (see `span`); the trial value is `q = sqrt(omega)`, and a span's scaling wave number is
//! `k = q (m/EI)^(1/4)`. `waves` describes a span with either theory of bending, axial force and foundation; `node` describes
//! the attachments between spans.

use crate::definition::End;
use crate::node::Node;
use crate::piece::Piece;
use crate::plane::{Crossing, Handover, Plane, combine, form, reflect};
use crate::roots::Characteristic;
use crate::shapes::{Match, Waveguide};
use crate::span::Span;
use crate::waves::{State, Waves};

#[derive(Debug, Clone)]
pub(crate) struct Flexure {
    spans: Vec<Span>,
    ends: [End; 2],
    /// At both ends and between spans: one more than the number of spans.
    nodes: Vec<Node>,
    /// `(m/EI)^(1/4)` of each span.
    wave_numbers: Vec<f64>,
    /// `sum k l / q`.
    phase: f64,
    /// Factors of the state from span `i` to span `i + 1`.
    steps: Vec<State>,
    /// There is a foundation somewhere: the ratio of two spans' wave numbers depends on the frequency.
    founded: bool,
    /// There is no shear, rotary inertia, tension or foundation anywhere.
    plain: bool,
}

/// The transformation of a plane between two spans: masses and springs, a support, the change of units.
#[derive(Debug, Clone, Copy)]
struct Joint([Option<Handover>; 3]);

/// The plane of one end at one frequency, propagated along the beam; all lists in the order of the spans. From the left the last span is
/// not crossed.
struct Sweep {
    /// The plane at the entry of each span.
    entries: Vec<Plane>,
    crossings: Vec<Crossing>,
    /// The transformations between spans.
    joints: Vec<Joint>,
}

/// The planes from both ends.
pub(crate) struct Sweeps {
    left: Sweep,
    right: Sweep,
}

/// The states that an end allows: two of the four unit vectors.
pub(crate) fn allowed(end: End) -> [usize; 2] {
    match end {
        End::Clamped => [2, 3],
        End::Pinned => [1, 3],
        End::Free => [0, 1],
        End::Guided => [0, 2],
    }
}

/// The two components that are zero at an end.
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

impl Joint {
    fn exit(&self, entry: Plane) -> Plane {
        self.0.iter().flatten().next_back().map_or(entry, |handover| handover.plane)
    }

    /// Coefficients, in the plane at the entry, of a state of the plane at the exit.
    fn coefficients_before(&self, state: &State, exit: &Plane) -> [f64; 2] {
        self.0.iter().rev().flatten().fold(exit.coefficients(state), |after, handover| handover.before(after))
    }
}

impl Flexure {
    pub fn new(spans: Vec<Span>, ends: [End; 2], nodes: Vec<Node>) -> Self {
        let wave_numbers: Vec<f64> = spans.iter().map(|s| (s.mass / s.rigidity).sqrt().sqrt()).collect();
        let steps =
            (1..spans.len()).map(|i| step(&spans[i - 1], wave_numbers[i - 1], &spans[i], wave_numbers[i])).collect();
        let phase = spans.iter().zip(&wave_numbers).map(|(span, k)| span.length * k).sum();
        let founded = spans.iter().any(|span| span.foundation != 0.0);
        let plain = spans.iter().all(Span::is_plain);
        Self { spans, ends, nodes, wave_numbers, phase, steps, founded, plain }
    }

    /// The span and the ends of a uniform beam to which nothing is attached.
    pub fn uniform(&self) -> Option<(&Span, [End; 2])> {
        let bare = self.nodes.iter().all(|node| *node == Node::default());
        self.spans.first().filter(|_| bare && self.spans.len() == 1).map(|span| (span, self.ends))
    }

    /// The scaling wave number, from the mass or, if it is stiffer, from the foundation.
    fn wave_number(&self, i: usize, q: f64) -> f64 {
        let Span { mass, foundation, rigidity, .. } = self.spans[i];
        if foundation == 0.0 {
            return q * self.wave_numbers[i];
        }
        ((mass * (q * q) * (q * q) - foundation).max(foundation) / rigidity).sqrt().sqrt()
    }

    fn waves(&self, i: usize, q: f64) -> Waves {
        Waves::new(&self.spans[i], self.wave_number(i, q), q)
    }

    /// Factors of the state from span `i - 1` to span `i`.
    fn step(&self, i: usize, q: f64) -> State {
        if !self.founded {
            return self.steps[i - 1];
        }
        step(&self.spans[i - 1], self.wave_number(i - 1, q), &self.spans[i], self.wave_number(i, q))
    }

    /// The attachments at a node, for a plane in the units of a span beside it.
    fn pass(&self, node: usize, plane: Plane, span: usize, q: f64) -> Joint {
        let node = &self.nodes[node];
        let load = (!node.is_bare()).then(|| {
            let (k, rigidity) = (self.wave_number(span, q), self.spans[span].rigidity);
            let [force, moment] = node.dynamic_stiffness(q);
            plane.loaded([force / (rigidity * k * k * k), moment / (rigidity * k)])
        });
        let joint = Joint([load, None, None]);
        let support = if node.support { joint.exit(plane).supported() } else { None };
        Joint([load, support, None])
    }

    /// The same between two spans, into the units of the next span: `scale`.
    fn join(&self, node: usize, plane: Plane, span: usize, q: f64, scale: &State) -> Joint {
        let mut joint = self.pass(node, plane, span, q);
        joint.0[2] = Some(joint.exit(plane).rescaled(scale));
        joint
    }

    /// The plane that one end allows, including its attachments.
    fn start(&self, q: f64, from_right: bool) -> Plane {
        let n = self.spans.len();
        let plane = end_plane(self.ends[usize::from(from_right)]);
        let (node, span) = if from_right { (n, n - 1) } else { (0, 0) };
        self.pass(node, plane, span, q).exit(plane)
    }

    /// The plane that one end allows, propagated from there up to the last span; from the right over it, in reflected variables.
    fn sweep(&self, q: f64, from_right: bool) -> Sweep {
        let n = self.spans.len();
        let mut plane = self.start(q, from_right);
        let mut sweep =
            Sweep { entries: Vec::with_capacity(n), crossings: Vec::with_capacity(n), joints: Vec::with_capacity(n) };
        for step in 0..n {
            let i = if from_right { n - 1 - step } else { step };
            sweep.entries.push(plane);
            if step + 1 == n && !from_right {
                // shapes are followed back to the left end from the start of a span only
                break;
            }
            let crossing = plane.cross(&self.waves(i, q));
            if step + 1 < n {
                let joint = if from_right {
                    self.join(i, crossing.exit, i, q, &self.step(i, q).map(|s| 1.0 / s))
                } else {
                    self.join(i + 1, crossing.exit, i, q, &self.step(i + 1, q))
                };
                plane = joint.exit(crossing.exit);
                sweep.joints.push(joint);
            }
            sweep.crossings.push(crossing);
        }
        if from_right {
            sweep.entries.reverse();
            sweep.crossings.reverse();
            sweep.joints.reverse();
        }
        sweep
    }

    /// From `w` to the span's own variables: `w = z_0 / sqrt(EI k^3)`; a common power of `q` is omitted where there is one.
    fn amplitude(&self, i: usize, q: f64) -> f64 {
        let k = if self.founded { self.wave_number(i, q) } else { self.wave_numbers[i] };
        1.0 / (self.spans[i].rigidity * k.powi(3)).sqrt()
    }

    /// The plane propagated over one span and, unless it is the last, into the next.
    fn advance(&self, i: usize, plane: Plane, waves: &Waves, q: f64) -> Plane {
        let exit = plane.cross(waves).exit;
        if i + 1 < self.spans.len() {
            self.join(i + 1, exit, i, q, &self.step(i + 1, q)).exit(exit)
        } else {
            self.pass(i + 1, exit, i, q).exit(exit)
        }
    }

    /// The characteristic function, which is zero if the plane contains a state that the right end allows.
    fn at_right_end(&self, Plane([u, v]): &Plane) -> f64 {
        let [m, n] = constrained(self.ends[1]);
        u[m] * v[n] - v[m] * u[n]
    }

    /// Number of half waves on the whole beam.
    fn half_waves(&self, q: f64) -> f64 {
        (0..self.spans.len()).map(|i| self.waves(i, q).half_waves()).sum()
    }
}

/// Factors of the state from a span with the wave number `k` to the next with another.
fn step(left: &Span, left_k: f64, right: &Span, right_k: f64) -> State {
    let slower = left_k / right_k;
    let rho = (right.rigidity / left.rigidity / slower.powi(3)).sqrt();
    [rho, rho * slower, 1.0 / (rho * slower), 1.0 / rho]
}

/// Number of negative eigenvalues of the symmetric matrix `[[p, r], [r, s]]`.
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

impl Characteristic for Flexure {
    fn count_and_function(&self, q: f64) -> (usize, f64) {
        let mut plane = self.start(q, false);
        let mut count = 0;
        for i in 0..self.spans.len() {
            let waves = self.waves(i, q);
            let (inside, [ww, wt, tt], denominator) = waves.clamped();
            // U' (K_left + K_span) U times |denominator|: the signature of K_left + K_span, without poles.
            let [u, v] = plane.0;
            let (size, sign) = (denominator.abs(), denominator.signum());
            let entry = |a: &State, b: &State| {
                let span_part = a[0] * (ww * b[0] + wt * b[1]) + a[1] * (wt * b[0] + tt * b[1]);
                let left_part = a[0] * -b[3] + a[1] * b[2];
                sign * span_part + size * left_part
            };
            let off_diagonal = 0.5 * (entry(&u, &v) + entry(&v, &u));
            count += inside + negative_eigenvalues(entry(&u, &u), off_diagonal, entry(&v, &v));
            plane = self.advance(i, plane, &waves, q);
        }
        // The right end leaves the other components free.
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
        let start = self.start(q, false);
        let plane = (0..self.spans.len()).fold(start, |plane, i| self.advance(i, plane, &self.waves(i, q), q));
        self.at_right_end(&plane)
    }

    fn estimate(&self, count: usize) -> f64 {
        let slender = (count as f64 + 1.0) * std::f64::consts::PI / self.phase;
        if self.plain {
            return slender;
        }
        // Shear makes waves slower and hence more numerous; a foundation reduces their number.
        let wanted = count as f64 + 1.0;
        let (mut low, mut high) = (0.0, slender);
        for _ in 0..60 {
            if self.half_waves(high) >= wanted {
                break;
            }
            (low, high) = (high, 1.5 * high);
        }
        for _ in 0..20 {
            let middle = 0.5 * (low + high);
            *(if self.half_waves(middle) < wanted { &mut low } else { &mut high }) = middle;
        }
        high
    }
}

impl Waveguide for Flexure {
    type Sweeps = Sweeps;

    fn spans(&self) -> &[Span] {
        &self.spans
    }

    fn inner(&self, u: &[Piece], v: &[Piece]) -> f64 {
        let both = self.spans.iter().zip(u.iter().zip(v));
        let along = both.map(|(span, (u, v))| {
            let rotary = if span.rotary > 0.0 { span.rotary * u.rotation_product(v) } else { 0.0 };
            span.mass * u.product(v) + rotary
        });
        let last = self.spans.len() - 1;
        let fixed = self.nodes.iter().enumerate().filter(|(_, node)| node.is_heavy()).map(|(i, node)| {
            let (span, x) = if i > last { (last, self.spans[last].length) } else { (i, 0.0) };
            let [mass, rotary] = node.mass;
            mass * u[span].displacement(x) * v[span].displacement(x)
                + rotary * u[span].rotation(x) * v[span].rotation(x)
        });
        along.sum::<f64>() + fixed.sum::<f64>()
    }

    fn leading(&self, first: &Piece) -> f64 {
        match allowed(self.ends[0])[0] {
            0 => first.displacement(0.0),
            1 => first.rotation(0.0),
            _ => first.curvature(0.0),
        }
    }

    fn spacing(&self, q: f64) -> f64 {
        if self.plain {
            return std::f64::consts::PI / self.phase;
        }
        let step = 1e-3 * q;
        2.0 * step / (self.half_waves(q + step) - self.half_waves(q - step))
    }

    fn sweeps(&self, q: f64) -> Sweeps {
        Sweeps { left: self.sweep(q, false), right: self.sweep(q, true) }
    }

    fn matches(&self, Sweeps { left, right }: &Sweeps) -> Vec<Match> {
        let mut found = Vec::with_capacity(2 * self.spans.len());
        for i in 0..self.spans.len() {
            let Plane([l0, l1]) = left.entries[i];
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

    fn unroll(&self, q: f64, Sweeps { left, right }: &Sweeps, at: &Match) -> Vec<Piece> {
        let mut pieces = vec![None; self.spans.len()];
        let mut state = at.state;
        for i in (0..at.span).rev() {
            let coefficients = left.joints[i].coefficients_before(&state, &left.entries[i + 1]);
            let (piece, entry) = left.crossings[i].follow_back(coefficients);
            pieces[i] = Some(piece.scaled(self.amplitude(i, q)));
            state = entry;
        }
        let mut coefficients = right.crossings[at.span].exit.coefficients(&reflect(&at.state));
        for i in at.span..self.spans.len() {
            let (piece, entry) = right.crossings[i].follow_back(coefficients);
            pieces[i] = Some(piece.reflected().scaled(self.amplitude(i, q)));
            if let Some(joint) = right.joints.get(i) {
                coefficients = joint.coefficients_before(&entry, &right.entries[i]);
            }
        }
        pieces.into_iter().flatten().collect()
    }
}
