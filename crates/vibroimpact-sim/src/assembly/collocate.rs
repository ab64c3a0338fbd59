//! Collocation of the contact forces on one panel: the only unknowns of the motion.
//!
//! On a panel the force of each closed contact acts as a polynomial, whose values at the nodes are `T F`. `T` is one unless the force
//! begins or ends as `t^(3/2)` (`panel/ends.rs`). At each node the law must hold, `F = law(xi, xi')` with
//! `xi_c = xi_c,free + sum_c' R_cc' T_c' F_c'`, `R` the exact responses, and the same for `xi'` with their rates `V`. Newton's matrix
//! `1 - F_xi R T - F_rate V T` has a block for each pair of contacts, which is zero if they share no body. The iteration ends when the
//! remaining correction changes the impulse of no contact by more than a hundredth of the error allowed for a panel.
//!
//! Rates are computed only where the force depends on them, and are exact. The derivative of the polynomial through the start and the
//! nodes would misrepresent vibrations that turn far on the panel. It would also miss a part of the rate of a rigid body, and a deviation
//! of the speed would then grow as soon as the panel is longer than 31 time constants of a dashpot.

use super::solution::Counts;
use crate::panel::ends::Ends;
use crate::panel::legendre::{Legendre, Matrix, Nodal, Q, apply};
use crate::panel::vector::vectorized;
use contact_models::{Branch, ContactLaw, Force};

/// More iterations than this mean that the panel is too long.
const ITERATIONS_MAX: u32 = 16;
/// A ratio of successive changes above this requires a new matrix.
const SLOW: f64 = 0.1;
/// A contact is left out of the matrix if the motion that its force causes changes the force by less than this share.
const SOFT: f64 = 1e-3;

/// A closed contact on a panel, before its force is known.
pub(crate) struct Unknown<'a> {
    pub law: &'a dyn ContactLaw,
    pub branch: Branch,
    /// Compression at the start of the panel (m).
    pub start: f64,
    /// Its increase from the start to the nodes without contact forces (m). The value at the start is excluded, since slopes would
    /// magnify its rounding on short panels.
    pub free: Nodal,
    /// Rate there without contact forces (m/s), if the force may depend on it.
    pub free_rate: Option<Nodal>,
    /// Requested accuracy of the force (N).
    pub accuracy: f64,
    /// A first guess of the force at the nodes (N).
    pub guess: Nodal,
    /// How the force begins and ends on the panel.
    pub ends: Ends,
}

/// How a force moves the overlap of a contact on a panel.
#[derive(Clone, Copy)]
pub(crate) struct Mobility<'r> {
    /// Change of the overlap at the nodes by the force there (m/N).
    pub nodes: &'r Matrix,
    /// Change of its rate (m/(N s)), if the force of the moved contact may depend on it.
    pub rates: Option<&'r Matrix>,
}

/// Force (N), compression (m), its increase from the start (m) and its rate (m/s; zero unless needed) at the nodes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Collocated {
    pub force: Nodal,
    pub ends: Ends,
    /// Nodal values of the polynomial that moves the modes.
    pub acting: Nodal,
    pub compression: Nodal,
    pub moved: Nodal,
    pub rate: Nodal,
}

impl Collocated {
    /// The polynomial `P` of its force `w P`; `acting` is the polynomial that moves the modes, the same for a smooth force.
    pub fn quotient(&self, acting: &Legendre) -> Legendre {
        if self.ends.is_smooth() { *acting } else { self.ends.quotient(&self.force) }
    }
}

/// Memory of Newton's method: forces and their derivatives from the laws, changes, and the matrix.
#[derive(Default)]
pub(crate) struct Newton {
    values: Vec<[Force; Q]>,
    change: Vec<Nodal>,
    blocks: Blocks,
}

/// Solves the laws at all nodes of a panel of `h`; `response` gives `R_cc'` (m/N). `false` if the iteration does not
/// converge.
pub(crate) fn collocate<'r>(
    unknowns: &[Unknown],
    response: impl Fn(usize, usize) -> Option<Mobility<'r>>,
    (newton, found): (&mut Newton, &mut Vec<Collocated>),
    counts: &mut Counts,
) -> bool {
    vectorized(
        #[inline(always)]
        || newton.solve(unknowns, &response, found, counts),
    )
}

impl Newton {
    #[inline(always)]
    fn solve<'r>(
        &mut self,
        unknowns: &[Unknown],
        response: &impl Fn(usize, usize) -> Option<Mobility<'r>>,
        found: &mut Vec<Collocated>,
        counts: &mut Counts,
    ) -> bool {
        let Newton { values, change, blocks } = self;
        let n = unknowns.len();
        let start = |unknown: &Unknown| Collocated {
            force: unknown.guess,
            ends: unknown.ends,
            acting: unknown.ends.acting(&unknown.guess),
            compression: [0.0; Q],
            moved: [0.0; Q],
            rate: [0.0; Q],
        };
        found.clear();
        found.extend(unknowns.iter().map(start));
        values.resize(n, [Force::ZERO; Q]);
        change.resize(n, [0.0; Q]);
        let mut factored = false;
        let mut last: Option<f64> = None;
        follow(unknowns, response, found);
        for _ in 0..ITERATIONS_MAX {
            counts.newton_iterations += 1;
            for (c, unknown) in unknowns.iter().enumerate() {
                unknown.law.forces(&unknown.branch, &found[c].compression, &found[c].rate, &mut values[c]);
                counts.law_evaluations += Q as u64;
                for i in 0..Q {
                    change[c][i] = values[c][i].force_n - found[c].force[i];
                }
            }
            if !factored {
                blocks.factor_stiff(values, unknowns, response);
                factored = true;
            }
            blocks.solve_here(change);
            // the largest change relative to the requested accuracy
            let (mut excess, mut converged) = (0.0f64, true);
            for (c, unknown) in unknowns.iter().enumerate() {
                let (mut largest, mut size) = (0.0f64, 0.0f64);
                for i in 0..Q {
                    found[c].force[i] += change[c][i];
                    largest = largest.max(change[c][i].abs());
                    size = size.max(found[c].force[i].abs());
                }
                found[c].acting = unknown.ends.acting(&found[c].force);
                // a sum propagates NaN, maxima do not
                if !found[c].force.iter().sum::<f64>().is_finite() {
                    return false;
                }
                converged &= largest <= 1e-15 * size;
                excess = excess.max(largest / unknown.accuracy);
            }
            follow(unknowns, response, found);
            // with a constant matrix the changes shrink by a constant ratio, from which the remaining correction follows
            let ratio = last.map_or(1.0, |last: f64| if last > 0.0 { excess / last } else { 0.0 });
            if converged || ratio * excess <= 1.0 {
                return true;
            }
            if ratio > SLOW && last.is_some() {
                factored = false;
            }
            last = Some(excess);
        }
        false
    }
}

/// Compressions and their rates at the nodes under these forces.
#[inline(always)]
fn follow<'r>(
    unknowns: &[Unknown],
    response: &impl Fn(usize, usize) -> Option<Mobility<'r>>,
    found: &mut [Collocated],
) {
    for (c, unknown) in unknowns.iter().enumerate() {
        let (mut moved, mut rate) = (unknown.free, unknown.free_rate.unwrap_or_default());
        for (other, solved) in found.iter().enumerate() {
            if let Some(response) = response(c, other) {
                let forced = apply(response.nodes, &solved.acting);
                for i in 0..Q {
                    moved[i] += forced[i];
                }
                if let Some(rates) = response.rates {
                    let forced = apply(rates, &solved.acting);
                    for i in 0..Q {
                        rate[i] += forced[i];
                    }
                }
            }
        }
        (found[c].moved, found[c].rate) = (moved, rate);
        found[c].compression = moved.map(|moved| unknown.start + moved);
    }
}

/// Newton's matrix in blocks, factored. Off the diagonal of ones its size is `(h omega)^2` with `omega` the contacts' own
/// frequency, so that elimination needs no pivoting.
#[derive(Default)]
pub(crate) struct Blocks {
    contacts: usize,
    /// `[p * contacts + q]`; on the diagonal the inverses, above it `A_pp^-1 A_pq`, below it `A_pq`.
    blocks: Vec<Matrix>,
    /// Which blocks are not zero; on the diagonal, which are not the identity.
    present: Vec<bool>,
}

impl Blocks {
    pub fn factor<'r>(
        &mut self,
        values: &[[Force; Q]],
        ends: impl Fn(usize) -> Ends,
        response: &impl Fn(usize, usize) -> Option<Mobility<'r>>,
    ) {
        vectorized(
            #[inline(always)]
            || self.factor_rows(values, ends, response, |_| true),
        );
    }

    /// Solves in place.
    pub fn solve(&self, right: &mut [Nodal]) {
        vectorized(
            #[inline(always)]
            || self.solve_here(right),
        );
    }

    /// If there are several contacts, the rows of those with a small response on this panel are left out. The missing parts of the
    /// matrix only slow the iteration down, and only in proportion to their size.
    #[inline(always)]
    fn factor_stiff<'r>(
        &mut self,
        values: &[[Force; Q]],
        unknowns: &[Unknown],
        response: &impl Fn(usize, usize) -> Option<Mobility<'r>>,
    ) {
        let stiff = |p: usize| {
            let by_rate = values[p].iter().any(|value| value.per_rate_n_s_m != 0.0);
            let stiffness = values[p].iter().fold(0.0f64, |most, value| most.max(value.per_compression_n_m.abs()));
            let moved = |own: &Matrix| own.iter().flatten().fold(0.0f64, |most, moved| most.max(moved.abs()));
            values.len() == 1 || by_rate || response(p, p).is_some_and(|own| stiffness * moved(own.nodes) > SOFT)
        };
        self.factor_rows(values, |c| unknowns[c].ends, response, stiff);
    }

    #[inline(always)]
    fn factor_rows<'r>(
        &mut self,
        values: &[[Force; Q]],
        ends: impl Fn(usize) -> Ends,
        response: &impl Fn(usize, usize) -> Option<Mobility<'r>>,
        wanted: impl Fn(usize) -> bool,
    ) {
        let n = values.len();
        let Blocks { contacts, blocks, present } = self;
        *contacts = n;
        blocks.resize(n * n, [[0.0; Q]; Q]);
        present.clear();
        present.resize(n * n, false);
        for p in (0..n).filter(|p| wanted(*p)) {
            for q in 0..n {
                if let Some(response) = response(p, q) {
                    fill(&mut blocks[p * n + q], &values[p], response, ends(q));
                    if p == q {
                        (0..Q).for_each(|j| blocks[p * n + q][j][j] += 1.0);
                    }
                    present[p * n + q] = true;
                }
            }
        }
        for p in 0..n {
            if !present[p * n + p] {
                continue;
            }
            let Some((inverse, above)) = blocks[p * n + p..(p + 1) * n].split_first_mut() else { continue };
            invert(inverse);
            for (block, _) in above.iter_mut().zip(&present[p * n + p + 1..]).filter(|(_, present)| **present) {
                block.iter_mut().for_each(|column| *column = apply(inverse, column));
            }
            for i in p + 1..n {
                if !present[i * n + p] {
                    continue;
                }
                for q in p + 1..n {
                    if !present[p * n + q] {
                        continue;
                    }
                    // row p lies above row i
                    let (above, below) = blocks.split_at_mut(i * n);
                    let (left, target) = below[..n].split_at_mut(q);
                    let (left, target) = (&left[p], &mut target[0]);
                    if !present[i * n + q] {
                        *target = [[0.0; Q]; Q];
                        present[i * n + q] = true;
                    }
                    for (column, right) in target.iter_mut().zip(&above[p * n + q]) {
                        let product = apply(left, right);
                        for r in 0..Q {
                            column[r] -= product[r];
                        }
                    }
                }
            }
        }
    }

    #[inline(always)]
    fn solve_here(&self, right: &mut [Nodal]) {
        let n = self.contacts;
        for p in 0..n {
            for q in 0..p {
                self.subtract(p, q, right);
            }
            if self.present[p * n + p] {
                right[p] = apply(&self.blocks[p * n + p], &right[p]);
            }
        }
        for p in (0..n).rev() {
            for q in p + 1..n {
                self.subtract(p, q, right);
            }
        }
    }

    #[inline(always)]
    fn subtract(&self, p: usize, q: usize, right: &mut [Nodal]) {
        if self.present[p * self.contacts + q] {
            let product = apply(&self.blocks[p * self.contacts + q], &right[q]);
            for i in 0..Q {
                right[p][i] -= product[i];
            }
        }
    }
}

/// `-F_xi R T - F_rate V T` of one pair.
#[inline(always)]
fn fill(block: &mut Matrix, values: &[Force; Q], response: Mobility, ends: Ends) {
    let acting = |response: &Matrix| if ends.is_smooth() { *response } else { ends.response(response) };
    let moved = acting(response.nodes);
    for j in 0..Q {
        for i in 0..Q {
            block[j][i] = -values[i].per_compression_n_m * moved[j][i];
        }
    }
    if let Some(rates) = response.rates {
        let rates = acting(rates);
        for j in 0..Q {
            for i in 0..Q {
                block[j][i] -= values[i].per_rate_n_s_m * rates[j][i];
            }
        }
    }
}

/// Replaces a matrix by its inverse. Each iteration of Newton's method waits for the solution. A substitution has 15 steps, each of
/// which waits for the one before; a product with the inverse takes a third of their time.
#[inline(always)]
fn invert(a: &mut Matrix) {
    exchange::<0>(a);
    exchange::<1>(a);
    exchange::<2>(a);
    exchange::<3>(a);
    exchange::<4>(a);
    exchange::<5>(a);
    exchange::<6>(a);
    exchange::<7>(a);
}

/// Exchanges an unknown for a right side. The pivot is constant, so that the compiler can use vector instructions.
#[inline(always)]
fn exchange<const PIVOT: usize>(a: &mut Matrix) {
    let inverse = 1.0 / a[PIVOT][PIVOT];
    let mut own = [0.0; Q];
    for i in 0..Q {
        own[i] = if i == PIVOT { inverse } else { -a[PIVOT][i] * inverse };
    }
    for j in 0..Q {
        if j == PIVOT {
            a[j] = own;
            continue;
        }
        let factor = a[j][PIVOT];
        for i in 0..Q {
            let rest = if i == PIVOT { 0.0 } else { a[j][i] };
            a[j][i] = rest + factor * own[i];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::panel::legendre::BASIS;
    use contact_models::LinearSpring;

    /// Linear springs: the collocation equations are linear, and solved in one iteration to rounding.
    #[test]
    fn coupled_springs_meet_their_laws_at_every_node() {
        let law = LinearSpring::new(3.0).unwrap();
        let matrix = |scale: f64| -> Matrix {
            std::array::from_fn(|j| std::array::from_fn(|i| -scale / (1.0 + (2 * i + 3 * j) as f64)))
        };
        // a chain: the outer two share no body
        let (own, near) = (matrix(0.1), matrix(-0.04));
        let response = |p: usize, q: usize| match p.abs_diff(q) {
            0 => Some(Mobility { nodes: &own, rates: None }),
            1 => Some(Mobility { nodes: &near, rates: None }),
            _ => None,
        };
        let unknown = |c: usize| Unknown {
            law: &law,
            branch: contact_models::ContactLaw::touch(&law, &Default::default(), 1.0),
            start: 0.0,
            free: BASIS.nodes.map(|s| s * (1.0 + c as f64)),
            free_rate: None,
            accuracy: 1e-15,
            guess: [0.0; Q],
            ends: Ends::SMOOTH,
        };
        let unknowns: Vec<_> = (0..3).map(unknown).collect();
        let (mut newton, mut found) = (Newton::default(), Vec::new());
        assert!(collocate(&unknowns, response, (&mut newton, &mut found), &mut Counts::default()));
        for c in 0..3 {
            let mut compression = unknowns[c].free;
            for other in 0..3 {
                if let Some(response) = response(c, other) {
                    let moved = apply(response.nodes, &found[other].force);
                    (0..Q).for_each(|i| compression[i] += moved[i]);
                }
            }
            for i in 0..Q {
                assert!((found[c].force[i] - 3.0 * compression[i]).abs() < 1e-13, "{c} {i}");
            }
        }
    }
}
