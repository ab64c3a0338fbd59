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

use super::history::{History, Impulse};
use super::rule::{Tables, series};

/// The impulses as free motion needs them.
#[derive(Debug, Clone, Default)]
pub(super) struct Free {
    age: Vec<f64>,
    root: Vec<f64>,
    c: Vec<f64>,
}

/// Free motion during a contact: impulses much older than a contact lasts act on it as a smooth
/// function, sampled once.
#[derive(Debug, Clone, Default)]
pub(super) struct Forcing {
    all: Free,
    near: Free,
    /// Legendre series on `(0, REACH)` of the bend due to the impulses that are not near.
    far: Vec<f64>,
}

/// Time (natural units of the contact) over which far impulses are represented by a series; far
/// are those of twice this age, so that a series of `n` terms errs by `9.9^(-n)`.
pub(super) const REACH: f64 = 6.0;

impl Forcing {
    pub fn new(history: &History, time: f64, impulse: f64, tables: &Tables) -> Forcing {
        let all = Free::new(history, time, impulse);
        let (mut near, mut far) = (Free::default(), Free::default());
        for ((&age, &root), &c) in all.age.iter().zip(&all.root).zip(&all.c) {
            if age < 2.0 * REACH { &mut near } else { &mut far }.push(age, root, c);
        }
        let samples: Vec<f64> = tables.sigma.iter().map(|s| far.bend(REACH * s)).collect();
        Forcing { near, far: tables.coefficients(&samples), all }
    }

    /// See [`Free::bend`].
    pub fn bend(&self, tau: f64) -> f64 {
        if tau <= REACH { self.near.bend(tau) + series(&self.far, tau / REACH) } else { self.all.bend(tau) }
    }

    /// See [`Free::rate_gain`].
    pub fn rate_gain(&self, tau: f64) -> f64 {
        self.all.rate_gain(tau)
    }
}

impl Free {
    /// With ages in units of `time` and impulses in units of `impulse`.
    pub fn new(history: &History, time: f64, impulse: f64) -> Free {
        Free::of(
            history.impulses().map(|Impulse { age, weight }| Impulse { age: age / time, weight: weight / impulse }),
        )
    }

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

    /// `x'(tau) - r`.
    pub fn rate_gain(&self, tau: f64) -> f64 {
        tau * self.sum(|age, root, c| {
            let now = (age + tau).sqrt();
            c / (now * (now + root))
        })
    }

    /// [`bend`](Self::bend) and [`rate_gain`](Self::rate_gain), with a single square root for each impulse.
    pub fn bend_and_gain(&self, tau: f64) -> (f64, f64) {
        let [bend, gain] = self.sums(|age, root, c| {
            let now = (age + tau).sqrt();
            let both = now + root;
            let share = c / (now * both * both);
            [share * now, share * both]
        });
        (bend, tau * gain)
    }

    /// `x''(tau)`.
    pub fn acceleration(&self, tau: f64) -> f64 {
        self.sum(|age, root, c| 0.5 * c * root / ((age + tau) * (age + tau).sqrt()))
    }

    /// Speed of the structure's point at the time origin.
    pub fn structure_speed(&self) -> f64 {
        self.sum(|_, _, c| c)
    }

    /// Total impulse.
    pub fn impulse(&self) -> f64 {
        self.sum(|_, root, c| 2.0 * c * root)
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
