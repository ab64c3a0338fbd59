//! Free motion of the gap under the after-effect of past impulses.
//!
//! With rate `r` at the time origin the compression of free motion is
//!
//! ```text
//! x(tau) = x_0 + r tau + tau^2 sum_j c_j / (sqrt(d_j + tau) + sqrt(d_j))^2,   c_j = w_j / (2 sqrt(d_j)),
//! ```
//!
//! which is `u tau - sum_j w_j [sqrt(d_j + tau) - sqrt(d_j)]` with the line taken out: every term of
//! the sum is positive, so the bend of the curve is known to full relative precision even when
//! the body and the structure move at nearly the same speed.

use super::history::Impulse;

/// The impulses as free motion needs them.
#[derive(Debug, Clone, Default)]
pub(super) struct Free {
    age: Vec<f64>,
    root: Vec<f64>,
    c: Vec<f64>,
}

/// Time (natural units of the contact) over which far impulses are represented by a series; far
/// are those of twice this age, so that a series of `n` terms errs by `9.9^(-n)`.
pub(super) const REACH: f64 = 6.0;

impl Free {
    /// From impulses in the units of the free motion.
    pub fn of(impulses: impl Iterator<Item = Impulse>) -> Free {
        let mut free = Free::default();
        for Impulse { age, weight } in impulses {
            let root = age.sqrt();
            free.push(age, root, weight / (2.0 * root));
        }
        free
    }

    fn push(&mut self, age: f64, root: f64, c: f64) {
        self.age.push(age);
        self.root.push(root);
        self.c.push(c);
    }

    /// `[x(tau) - x_0 - r tau] / tau^2`.
    pub fn bend(&self, tau: f64) -> f64 {
        self.sum(|age, root, c| {
            let both = (age + tau).sqrt() + root;
            c / (both * both)
        })
    }

    /// [`bend`](Self::bend) and `x'(tau) - r`, with a single square root for each impulse.
    pub fn bend_and_gain(&self, tau: f64) -> (f64, f64) {
        let [bend, gain] = self.sums(|age, root, c| {
            let now = (age + tau).sqrt();
            let both = now + root;
            let share = c / (now * both * both);
            [share * now, share * both]
        });
        (bend, tau * gain)
    }

    /// Speed of the structure's point at the time origin.
    pub fn structure_speed(&self) -> f64 {
        self.sum(|_, _, c| c)
    }

    /// Sum over the impulses.
    fn sum(&self, term: impl Fn(f64, f64, f64) -> f64) -> f64 {
        let [sum] = self.sums(|age, root, c| [term(age, root, c)]);
        sum
    }

    /// Sums over the impulses in four interleaved parts, which the compiler can vectorise.
    fn sums<const N: usize>(&self, terms: impl Fn(f64, f64, f64) -> [f64; N]) -> [f64; N] {
        let (mut parts, mut rest) = ([[0.0; N]; 4], [0.0; N]);
        let add = |sums: &mut [f64; N], terms: [f64; N]| (0..N).for_each(|n| sums[n] += terms[n]);
        let (ages, roots, cs) = (self.age.chunks_exact(4), self.root.chunks_exact(4), self.c.chunks_exact(4));
        for ((&age, &root), &c) in ages.remainder().iter().zip(roots.remainder()).zip(cs.remainder()) {
            add(&mut rest, terms(age, root, c));
        }
        for ((age, root), c) in ages.zip(roots).zip(cs) {
            for i in 0..4 {
                add(&mut parts[i], terms(age[i], root[i], c[i]));
            }
        }
        std::array::from_fn(|n| (parts[0][n] + parts[1][n]) + (parts[2][n] + parts[3][n]) + rest[n])
    }
}
