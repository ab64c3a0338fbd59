//! The memory of past forces: a positive measure of point impulses.
//!
//! The later effect of a finished piece of contact on the structure is
//! `int sqrt(t - s) f(s) ds` with `f >= 0`, so any quadrature with positive weights represents
//! it by a set of impulses. Once the piece lies further back than half its own length, the
//! Gauss rule of the measure (Lanczos / Stieltjes recurrence, eigenvalues of the Jacobi matrix)
//! with 14 nodes replaces it to rounding error: the Bernstein ellipse of `sqrt` has parameter
//! `2 + sqrt(3)`, and `3.73^(-28) = 1e-16`.
//!
//! Ages, not dates, are stored: an age grows by additions of positive numbers and keeps its
//! relative precision, however late the contact.

/// Nodes of a condensed block.
const CONDENSED: usize = 14;

/// Impulse `weight` given `age` ago (units `m v` and `T`).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Impulse {
    pub age: f64,
    pub weight: f64,
}

/// Impulses that are condensed together.
#[derive(Debug, Clone)]
struct Block {
    impulses: Vec<Impulse>,
    youngest: f64,
    oldest: f64,
}

/// All impulses before the local time origin.
#[derive(Debug, Clone, Default)]
pub(super) struct History {
    /// Oldest first.
    blocks: Vec<Block>,
}

impl History {
    /// All impulses, oldest block first.
    pub fn impulses(&self) -> impl Iterator<Item = Impulse> + Clone + '_ {
        self.blocks.iter().flat_map(|block| block.impulses.iter().copied())
    }

    /// Moves the time origin forward.
    pub fn advance(&mut self, time: f64) {
        for block in &mut self.blocks {
            block.youngest += time;
            block.oldest += time;
            for impulse in &mut block.impulses {
                impulse.age += time;
            }
        }
    }

    /// Moves the time origin forward through a flight, and condenses what then lies far enough back.
    pub fn rest(&mut self, time: f64) {
        self.advance(time);
        self.condense();
    }

    /// Adds a piece of contact that took place between the ages `oldest` and `youngest`.
    pub fn push(&mut self, impulses: Vec<Impulse>, youngest: f64, oldest: f64) {
        if !impulses.is_empty() {
            self.blocks.push(Block { impulses, youngest, oldest });
        }
    }

    /// Condenses and merges blocks that lie far enough back, seen from the time origin or later.
    pub fn condense(&mut self) {
        let mut i = self.blocks.len();
        while i > 0 {
            i -= 1;
            let block = &mut self.blocks[i];
            if block.impulses.len() > CONDENSED && far(block.youngest, block.oldest) {
                block.impulses = gauss_rule(&block.impulses);
            }
            if i + 1 < self.blocks.len() && far(self.blocks[i + 1].youngest, self.blocks[i].oldest) {
                let younger = self.blocks.remove(i + 1);
                let block = &mut self.blocks[i];
                block.youngest = younger.youngest;
                block.impulses.extend(younger.impulses);
                if block.impulses.len() > CONDENSED {
                    block.impulses = gauss_rule(&block.impulses);
                }
            }
        }
    }
}

fn far(youngest: f64, oldest: f64) -> bool {
    youngest >= 0.5 * (oldest - youngest)
}

/// Gauss rule of a discrete positive measure.
fn gauss_rule(measure: &[Impulse]) -> Vec<Impulse> {
    let n = CONDENSED.min(measure.len());
    let total: f64 = measure.iter().map(|m| m.weight).sum();
    let (low, high) = measure.iter().fold((f64::INFINITY, 0.0_f64), |(low, high), m| (low.min(m.age), high.max(m.age)));
    if !(total > 0.0 && high > low) {
        return measure.to_vec();
    }
    let (centre, half) = (0.5 * (low + high), 0.5 * (high - low));
    let nodes: Vec<f64> = measure.iter().map(|m| (m.age - centre) / half).collect();
    // Stieltjes: recurrence of the polynomials orthonormal with respect to the measure
    let (mut alpha, mut beta) = (vec![0.0; n], vec![0.0; n]);
    let mut current: Vec<f64> = measure.iter().map(|m| (m.weight / total).sqrt()).collect();
    let mut before = vec![0.0; nodes.len()];
    for k in 0..n {
        alpha[k] = nodes.iter().zip(&current).map(|(x, q)| x * q * q).sum();
        let off = if k > 0 { beta[k - 1] } else { 0.0 };
        let next: Vec<f64> = (0..nodes.len()).map(|j| (nodes[j] - alpha[k]) * current[j] - off * before[j]).collect();
        let norm = next.iter().map(|q| q * q).sum::<f64>().sqrt();
        beta[k] = norm;
        if norm < 1e-14 && k + 1 < n {
            // the measure has no more than k + 1 significant points
            alpha.truncate(k + 1);
            beta.truncate(k + 1);
            break;
        }
        before = std::mem::replace(&mut current, next.iter().map(|q| q / norm).collect());
    }
    tridiagonal_eigen(&mut alpha, &mut beta)
        .iter()
        .zip(&alpha)
        .map(|(first, x)| Impulse { age: (centre + half * x).clamp(low, high), weight: total * first * first })
        .filter(|impulse| impulse.weight > 0.0)
        .collect()
}

/// Eigenvalues (left in `diagonal`) and first components of the eigenvectors of a symmetric
/// tridiagonal matrix, by implicit QL (Golub and Welsch 1969). `off[k]` couples `k` and `k + 1`.
fn tridiagonal_eigen(diagonal: &mut [f64], off: &mut [f64]) -> Vec<f64> {
    let n = diagonal.len();
    let mut first = vec![0.0; n];
    first[0] = 1.0;
    off[n - 1] = 0.0;
    for l in 0..n {
        for _ in 0..60 {
            let m = (l..n - 1)
                .find(|&m| off[m].abs() <= f64::EPSILON * (diagonal[m].abs() + diagonal[m + 1].abs()))
                .unwrap_or(n - 1);
            if m == l {
                break;
            }
            let mut g = (diagonal[l + 1] - diagonal[l]) / (2.0 * off[l]);
            let r = (g * g + 1.0).sqrt();
            g = diagonal[m] - diagonal[l] + off[l] / (g + r.copysign(g));
            let (mut s, mut c, mut shift) = (1.0, 1.0, 0.0);
            for i in (l..m).rev() {
                let (f, b) = (s * off[i], c * off[i]);
                let r = (f * f + g * g).sqrt();
                off[i + 1] = r;
                if r == 0.0 {
                    diagonal[i + 1] -= shift;
                    off[m] = 0.0;
                    break;
                }
                (s, c) = (f / r, g / r);
                g = diagonal[i + 1] - shift;
                let t = (diagonal[i] - g) * s + 2.0 * c * b;
                shift = s * t;
                diagonal[i + 1] = g + shift;
                g = c * t - b;
                let z = first[i + 1];
                first[i + 1] = s * first[i] + c * z;
                first[i] = c * first[i] - s * z;
            }
            diagonal[l] -= shift;
            off[l] = g;
            off[m] = 0.0;
        }
    }
    first
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::infinite::rule::gauss;

    /// A condensed contact acts like the whole one, at any later time.
    #[test]
    fn condensed_measure_acts_like_the_whole() {
        let whole: Vec<Impulse> =
            gauss(400).iter().map(|&(s, w)| Impulse { age: 0.5 + s, weight: w * (s * (1.0 - s)).powf(1.5) }).collect();
        let mut history = History::default();
        history.push(whole.clone(), 0.5, 1.5);
        history.condense();
        assert_eq!(history.impulses().count(), CONDENSED);
        for later in [0.0, 0.1, 1.0, 1e3] {
            let effect = |set: &mut dyn Iterator<Item = Impulse>| -> f64 {
                set.map(|i| i.weight * (i.age + later).sqrt()).sum()
            };
            let (a, b) = (effect(&mut whole.iter().copied()), effect(&mut history.impulses()));
            assert!((a / b - 1.0).abs() < 4e-15, "{later}: {a} {b}");
        }
    }
}
