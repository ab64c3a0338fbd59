//! Static deflection of a beam with attachments under a unit force.
//!
//! The affine plane of states that one end allows (its plane, and one particular solution of the loads) is propagated to the
//! force from either side, in each span's own units, and orthonormalised on the way, so that neither springs nor foundations
//! cause a loss of digits. Where both meet, the force determines the solution, which is then followed back.
//!
//! Rigid-body motions take up their part of the force as uniform acceleration, as in `compliance`.

use crate::chain::Chain;
use crate::definition::End;
use crate::node::Node;
use crate::quadrature::gauss;
use crate::rigid::rigid_motions;
use crate::span::Span;

/// `(w, t, M, -V)`, scaled by the span's units.
type State = [f64; 4];
/// Two columns of a plane and a particular solution.
type Frame = [State; 3];
/// Columns of a frame before a step, as combinations of those after it.
type Back = [[f64; 3]; 3];

/// A load per length `p + q x` and a couple per length, from accelerations.
#[derive(Clone, Copy)]
struct Acceleration {
    p: f64,
    q: f64,
}

/// A span of one side, entered from its left (in the direction of that side).
struct Stage {
    span: Span,
    k: f64,
    start: Frame,
    /// From the coefficients at the entry of the next span to those of this one.
    back: Back,
}

/// `(EI k^3)^(1/2)` and `(EI k)^(1/2)`: in these units displacement and rotation have the size of their forces.
fn units(span: &Span) -> [f64; 4] {
    let k = 1.0 / span.length;
    let [force, moment] = [(span.rigidity * k).sqrt() * k, (span.rigidity * k).sqrt()];
    [force, moment, 1.0 / moment, 1.0 / force]
}

fn scaled(z: &State, by: [f64; 4]) -> State {
    [z[0] * by[0], z[1] * by[1], z[2] * by[2], z[3] * by[3]]
}

fn combine(frame: &Frame, c: [f64; 3]) -> State {
    [0, 1, 2, 3].map(|i| c[0] * frame[0][i] + c[1] * frame[1][i] + c[2] * frame[2][i])
}

fn dot(u: &State, v: &State) -> f64 {
    (0..4).map(|i| u[i] * v[i]).sum()
}

/// Propagates a state by `x` into a span; `loaded` is the acceleration for the particular solution.
fn carried(span: &Span, z: &State, x: f64, loaded: Option<Acceleration>) -> State {
    let k = 1.0 / span.length;
    let unit = span.rigidity * k * k;
    let [shear, rotary, inertia] = [span.shear * unit, -span.tension / unit, -span.foundation / (unit * k * k)];
    let root = (span.rigidity * k).sqrt();
    // Loads relative to bending: force per length at the left end, its growth, and the couple per length.
    let (f0, f1, couple) = loaded.map_or((0.0, 0.0, 0.0), |Acceleration { p, q }| {
        let force = -span.mass / (root * k * k);
        (force * (p + q * span.start), force * q / k, -span.rotary * q / (root * k))
    });
    let xi = k * x;
    let (mut sum, mut term) = (*z, *z);
    for n in 1..=40 {
        let [a, b, c, d] = term;
        let h = xi / f64::from(n);
        let load = match n {
            1 => f0,
            2 => f1 * xi,
            _ => 0.0,
        };
        let moment = if n == 1 { -couple } else { 0.0 };
        term = [h * (b - shear * d), h * c, h * (d - rotary * b + moment), h * (inertia * a + load)];
        (0..4).for_each(|i| sum[i] += term[i]);
        if n > 2 && (0..4).all(|i| term[i].abs() <= 1e-18 * sum[i].abs()) {
            break;
        }
    }
    sum
}

/// Springs, and the forces of accelerated masses, for an unscaled state.
fn loaded(node: &Node, x: f64, z: &State, acceleration: Option<Acceleration>) -> State {
    let [force, moment] =
        acceleration.map_or([0.0; 2], |Acceleration { p, q }| [node.mass[0] * (p + q * x), node.mass[1] * q]);
    [z[0], z[1], z[2] + node.spring[1] * z[1] + moment, z[3] - node.spring[0] * z[0] - force]
}

/// Orthonormal columns, and a particular solution orthogonal to them.
fn orthonormal(frame: &Frame) -> (Frame, Back) {
    let [u, v, t] = frame;
    let r11 = dot(u, u).sqrt();
    let e1 = u.map(|c| c / r11);
    let along = |e: &State, v: &State| -> (State, f64) {
        let r = dot(e, v);
        let rest = [0, 1, 2, 3].map(|i| v[i] - r * e[i]);
        let again = dot(e, &rest);
        ([0, 1, 2, 3].map(|i| rest[i] - again * e[i]), r + again)
    };
    let (rest, r12) = along(&e1, v);
    let r22 = dot(&rest, &rest).sqrt();
    let e2 = rest.map(|c| c / r22);
    let (t1, r13) = along(&e1, t);
    let (t2, r23) = along(&e2, &t1);
    // Inverse of the triangle.
    let back =
        [[1.0 / r11, -r12 / (r11 * r22), (r12 * r23 / r22 - r13) / r11], [0.0, 1.0 / r22, -r23 / r22], [0.0, 0.0, 1.0]];
    ([e1, e2, t2], back)
}

/// The frame beyond a support: any shear force, zero displacement. `None` if the displacement is zero already.
fn supported(frame: &Frame) -> Option<(Frame, Back)> {
    let [u, v, t] = frame;
    let size = u[0].hypot(v[0]);
    let (cos, sin) = if size > 0.0 { (u[0] / size, v[0] / size) } else { return None };
    let share = t[0] / size;
    // Moving, constrained and particular solution in the old columns.
    let still = combine(frame, [-sin, cos, 0.0]);
    let rest = combine(frame, [-share * cos, -share * sin, 1.0]);
    let without = |z: State| [0.0, z[1], z[2], 0.0];
    let back = [[0.0, -sin, -share * cos], [0.0, cos, -share * sin], [0.0, 0.0, 1.0]];
    Some(([[0.0, 0.0, 0.0, 1.0], without(still), without(rest)], back))
}

fn times(a: &Back, b: &Back) -> Back {
    [0, 1, 2].map(|i| [0, 1, 2].map(|j| (0..3).map(|k| a[i][k] * b[k][j]).sum()))
}

fn applied(back: &Back, c: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|i| (0..3).map(|j| back[i][j] * c[j]).sum())
}

/// Passes the attachments at a node: the frame after it, for an unscaled frame.
fn passed(node: &Node, x: f64, frame: &Frame, acceleration: Option<Acceleration>) -> (Frame, Back) {
    let [u, v, t] = frame;
    let loaded = [loaded(node, x, u, None), loaded(node, x, v, None), loaded(node, x, t, acceleration)];
    let held = if node.support { supported(&loaded) } else { None };
    held.unwrap_or((loaded, [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]))
}

/// One side: the stages from its end to the force, and the unscaled frame there, in the last stage's coefficients.
fn side(spans: &[Span], nodes: &[Node], end: End, acceleration: Option<Acceleration>) -> (Vec<Stage>, Frame, Back) {
    let mut frame: Frame = [[0.0; 4]; 3];
    let free = crate::flexure::allowed(end);
    frame[0][free[0]] = 1.0;
    frame[1][free[1]] = 1.0;
    let place = |i: usize| spans.get(i).map_or_else(|| spans.last().map_or(0.0, |s| s.start + s.length), |s| s.start);
    let (mut frame, mut back) = passed(&nodes[0], place(0), &frame, acceleration);
    let mut stages: Vec<Stage> = Vec::with_capacity(spans.len());
    for (i, span) in spans.iter().enumerate() {
        let by = units(span);
        let (start, triangle) = orthonormal(&frame.map(|z| scaled(&z, by)));
        if let Some(last) = stages.last_mut() {
            last.back = times(&back, &triangle);
        }
        let length = span.length;
        let exit = [
            carried(span, &start[0], length, None),
            carried(span, &start[1], length, None),
            carried(span, &start[2], length, acceleration),
        ];
        stages.push(Stage { span: *span, k: 1.0 / length, start, back: [[0.0; 3]; 3] });
        (frame, back) =
            passed(&nodes[i + 1], place(i + 1), &exit.map(|z| scaled(&z, by.map(|b| 1.0 / b))), acceleration);
    }
    (stages, frame, back)
}

/// The solution on one side, from the coefficients at its last node.
struct Followed {
    stages: Vec<Stage>,
    coefficients: Vec<[f64; 3]>,
}

impl Followed {
    fn new(stages: Vec<Stage>, mut at_node: [f64; 3], mut back: Back) -> Self {
        let mut coefficients = vec![[0.0; 3]; stages.len()];
        for i in (0..stages.len()).rev() {
            coefficients[i] = applied(&back, at_node);
            at_node = coefficients[i];
            if i > 0 {
                back = stages[i - 1].back;
            }
        }
        Self { stages, coefficients }
    }

    /// Displacement and rotation in span `i`, `x` from its left end.
    fn motion(&self, i: usize, x: f64, acceleration: Option<Acceleration>) -> [f64; 2] {
        let Stage { span, start, k, .. } = &self.stages[i];
        let [a, b, one] = self.coefficients[i];
        let from = combine(start, [a, b, one]);
        let z = carried(span, &from, x.min(1.0 / k), acceleration);
        let by = units(span);
        [z[0] / by[0], z[1] / by[1]]
    }
}

/// The same beam from the other end.
fn mirrored(spans: &[Span]) -> Vec<Span> {
    let mut start = 0.0;
    let turn = |span: &Span| {
        let turned = Span { start, ..*span };
        start += span.length;
        turned
    };
    spans.iter().rev().map(turn).collect()
}

/// Dimensionless Green's function `G(x, y)`; the chain has a node at `y`.
pub(crate) fn green(chain: &Chain, x: f64, y: f64) -> f64 {
    let Chain { spans, nodes, ends, .. } = chain;
    let motions = rigid_motions(spans, *ends, nodes);
    let n = spans.len();
    let node = (0..n).find(|&i| (spans[i].start - y).abs() <= 2e-12).unwrap_or(n);

    let accelerated = (!motions.is_empty()).then(|| {
        let sum = motions.iter().fold([0.0; 2], |[a, b], &[p, q]| [a + p * (p + q * y), b + q * (p + q * y)]);
        Acceleration { p: sum[0], q: sum[1] }
    });
    let from_right = accelerated.map(|Acceleration { p, q }| Acceleration { p: p + q, q: -q });
    let left = side(&spans[..node], &nodes[..=node], ends[0], accelerated);
    // The node of the force belongs to the left side.
    let mut right_nodes: Vec<Node> = nodes[node..].iter().rev().copied().collect();
    if let Some(last) = right_nodes.last_mut().filter(|_| node > 0 && node <= n) {
        *last = Node::default();
    }
    let mut left = left;
    if node == 0 {
        // If there is nothing to the left, the right side has passed the node already.
        left.1 = end_frame(ends[0]);
    }
    let right_end = if node == n { None } else { Some(ends[1]) };
    let right_spans = mirrored(&spans[node..]);
    let right = match right_end {
        Some(end) => side(&right_spans, &right_nodes, end, from_right),
        None => (Vec::new(), end_frame(ends[1]), identity()),
    };

    // Left state with the unit force = reflected right state, in the units of a span beside it.
    let by = units(&spans[node.min(n - 1)]);
    let l = left.1.map(|z| scaled(&z, by));
    let r = right.1.map(|[w, t, m, v]| scaled(&[w, -t, m, -v], by));
    let mut matrix = [[0.0; 4]; 4];
    let mut rhs = [0.0; 4];
    for i in 0..4 {
        matrix[i] = [l[0][i], l[1][i], -r[0][i], -r[1][i]];
        rhs[i] = r[2][i] - l[2][i] - if i == 3 { by[3] } else { 0.0 };
    }
    let c = solve(matrix, rhs, 4 - motions.len());
    let left = Followed::new(left.0, [c[0], c[1], 1.0], left.2);
    let right = Followed::new(right.0, [c[2], c[3], 1.0], right.2);

    let motion = |i: usize, inside: f64| {
        if i < node {
            left.motion(i, inside, accelerated)
        } else {
            let [w, t] = right.motion(n - 1 - i, spans[i].length - inside, from_right);
            [w, -t]
        }
    };
    let (at, inside) = crate::span::locate(spans, x);
    let mut deflection = motion(at, inside)[0];
    for [p, q] in motions {
        let along = |i: usize| {
            let span = &spans[i];
            gauss(span.length, |xi| {
                let [w, t] = motion(i, xi);
                span.mass * w * (p + q * (span.start + xi)) + span.rotary * t * q
            })
        };
        let fixed = |i: usize| {
            let (span, xi) = if i < n { (i, 0.0) } else { (n - 1, spans[n - 1].length) };
            let [w, t] = motion(span, xi);
            nodes[i].mass[0] * w * (p + q * (spans[span].start + xi)) + nodes[i].mass[1] * t * q
        };
        let heavy = (0..=n).filter(|&i| nodes[i].is_heavy());
        let share = (0..n).map(along).sum::<f64>() + heavy.map(fixed).sum::<f64>();
        deflection -= share * (p + q * x);
    }
    deflection
}

fn identity() -> Back {
    [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
}

fn end_frame(end: End) -> Frame {
    let mut frame = [[0.0; 4]; 3];
    for (column, i) in crate::flexure::allowed(end).into_iter().enumerate() {
        frame[column][i] = 1.0;
    }
    frame
}

/// Solves four equations of known rank by complete pivoting; undetermined unknowns are zero.
pub(crate) fn solve(mut a: [[f64; 4]; 4], mut b: [f64; 4], rank: usize) -> [f64; 4] {
    let mut order = [0, 1, 2, 3];
    for step in 0..rank {
        let (mut row, mut column) = (step, step);
        for i in step..4 {
            for j in step..4 {
                if a[i][j].abs() > a[row][column].abs() {
                    (row, column) = (i, j);
                }
            }
        }
        a.swap(step, row);
        b.swap(step, row);
        order.swap(step, column);
        a.iter_mut().for_each(|row| row.swap(step, column));
        for i in step + 1..4 {
            let factor = a[i][step] / a[step][step];
            for j in step..4 {
                a[i][j] -= factor * a[step][j];
            }
            b[i] -= factor * b[step];
        }
    }
    let mut x = [0.0; 4];
    for i in (0..rank).rev() {
        let known: f64 = (i + 1..rank).map(|j| a[i][j] * x[order[j]]).sum();
        x[order[i]] = (b[i] - known) / a[i][i];
    }
    x
}
