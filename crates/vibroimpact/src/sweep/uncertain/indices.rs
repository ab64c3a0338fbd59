//! First and total indices of Sobol', by equations (2) and (3).

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::design::Draws;
use super::figure::{Estimate, mean};

/// Standard deviation, relative to the largest value, up to which an output does not vary. Rounding errors leave up to about 1e-13 of
/// an output that is the same in exact arithmetic, such as the restitution of a linear contact at different speeds.
const ROUNDING: f64 = 1e-12;

/// The shares of the variance that a field causes.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct SobolIndices {
    /// First-order index: the share that would vanish if the field were known.
    pub first: Estimate,
    /// Total index: the share that would remain if all other fields were known.
    pub total: Estimate,
}

/// The sums behind the indices of one field.
#[derive(Clone, Copy, Default)]
struct Sums {
    groups: f64,
    a: f64,
    b: f64,
    squares: f64,
    first: f64,
    total: f64,
}

impl Sums {
    fn add(&mut self, a: f64, b: f64, mixed: f64) {
        self.groups += 1.0;
        self.a += a;
        self.b += b;
        self.squares += 0.5 * (a * a + b * b);
        self.first += b * (mixed - a);
        self.total += 0.5 * (mixed - a).powi(2);
    }

    fn plus(self, other: Sums) -> Sums {
        Sums {
            groups: self.groups + other.groups,
            a: self.a + other.a,
            b: self.b + other.b,
            squares: self.squares + other.squares,
            first: self.first + other.first,
            total: self.total + other.total,
        }
    }

    fn variance(&self) -> f64 {
        self.squares / self.groups - (0.5 * (self.a + self.b) / self.groups).powi(2)
    }

    /// First and total index.
    fn shares(&self) -> [f64; 2] {
        let (n, variance) = (self.groups, self.variance());
        [self.first / n / variance, self.total / n / variance]
    }
}

/// The indices of these fields, and the number of groups that they are from: those all of whose draws have a value. No indices if
/// there is no group, or if the draws do not vary.
pub(super) fn indices(
    values: &[f64],
    draws: Draws,
    fields: &[String],
) -> (Option<BTreeMap<String, SobolIndices>>, u64) {
    let groups = || {
        let all = values.chunks_exact(draws.impacts as usize).enumerate();
        all.filter(|(_, group)| group.iter().all(|value| !value.is_nan()))
    };
    // the mean is subtracted, which avoids rounding errors and the scatter of f(b) in equation (2)
    let all: Vec<f64> = groups().flat_map(|(_, group)| group).copied().collect();
    let (middle, largest) = (mean(&all), all.iter().fold(0.0f64, |largest, value| largest.max(value.abs())));
    let of = |(field, name): (usize, &String)| {
        let mut sums = vec![Sums::default(); draws.replicates as usize];
        for (number, group) in groups() {
            let replicate = number % sums.len();
            sums[replicate].add(group[0] - middle, group[1] - middle, group[field + 2] - middle);
        }
        let all = sums.iter().fold(Sums::default(), |all, sums| all.plus(*sums));
        let shares = all.shares();
        let estimate = |which: usize| Estimate::new(shares[which], sums.iter().map(|sums| sums.shares()[which]));
        let varies = all.variance().sqrt() > ROUNDING * largest && shares.iter().all(|share| share.is_finite());
        varies.then(|| (name.clone(), SobolIndices { first: estimate(0), total: estimate(1) }))
    };
    (fields.iter().enumerate().map(of).collect(), groups().count() as u64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::FieldPath;
    use crate::sweep::uncertain::sobol::mixed;
    use crate::sweep::uncertain::{Distribution, Sampling, Sequence, Uncertain};

    /// The indices of a function of three numbers that are uniform from 0 to 1.
    fn of(f: impl Fn(&[f64]) -> f64, sequence: Sequence, draws: u64) -> Vec<SobolIndices> {
        let names = ["x", "y", "z"].map(str::to_owned);
        let fields = names.clone().map(|name| (FieldPath::parse(&name).unwrap(), Distribution::Uniform([0.0, 1.0])));
        let sampling = Sampling { seed: 3, draws, sequence, replicates: 16, indices: true };
        let uncertain = Uncertain::new(fields.to_vec(), sampling);
        let values: Vec<f64> = (0..uncertain.draws().count()).map(|number| f(&uncertain.draw(number))).collect();
        indices(&values, uncertain.draws(), &names).0.unwrap().into_values().collect()
    }

    /// Within four standard errors of the exact value, and with a small standard error.
    #[track_caller]
    fn holds(found: &Estimate, known: f64, error: f64) {
        let Estimate { value, standard_error: Some(s) } = *found else { panic!("{found:?}") };
        assert!((value - known).abs() <= 4.0 * s + 1e-12 && s < error, "{found:?}, known {known}");
    }

    #[test]
    fn an_additive_function_has_the_shares_of_its_terms() {
        // variances 1/12 times 1, 4 and 16
        for (sequence, error) in [(Sequence::Sobol, 1e-3), (Sequence::Random, 1e-1)] {
            let found = of(|x| x[0] + 2.0 * x[1] - 4.0 * x[2], sequence, 80 * 1024);
            for (indices, share) in found.iter().zip([1.0, 4.0, 16.0]) {
                holds(&indices.first, share / 21.0, error);
                holds(&indices.total, share / 21.0, error);
            }
        }
    }

    #[test]
    fn groups_with_a_draw_that_has_no_value_are_left_out() {
        let names = ["x", "y"].map(str::to_owned);
        let fields = names.clone().map(|name| (FieldPath::parse(&name).unwrap(), Distribution::Uniform([0.0, 1.0])));
        let sampling = Sampling { seed: 3, draws: 64 * 1024, sequence: Sequence::Sobol, replicates: 16, indices: true };
        let uncertain = Uncertain::new(fields.to_vec(), sampling);
        let sum =
            |number: u64| uncertain.draw(number).iter().zip([1.0, 3.0]).map(|(x, factor)| factor * x).sum::<f64>();
        let mut values: Vec<f64> = (0..uncertain.draws().count()).map(sum).collect();
        for number in [0, 5, 4099] {
            values[number] = f64::NAN;
        }
        let (found, groups) = indices(&values, uncertain.draws(), &names);
        let found = found.unwrap();
        assert_eq!(groups, uncertain.draws().count() / 4 - 3);
        holds(&found["x"].first, 0.1, 1e-3);
        holds(&found["y"].total, 0.9, 1e-3);
        values.iter_mut().step_by(4).for_each(|value| *value = f64::NAN);
        assert_eq!(indices(&values, uncertain.draws(), &names), (None, 0));
    }

    #[test]
    fn what_varies_by_rounding_alone_has_no_indices() {
        let names = ["x".to_owned()];
        let draws = Draws { impacts: 3, replicates: 2, groups: 16 };
        let of = |scatter: f64| -> Vec<f64> {
            let noise = |number: u64| (mixed(1, number) >> 11) as f64 * 0.5f64.powi(53);
            (0..draws.count()).map(|number| 0.7 + scatter * noise(number)).collect()
        };
        for (scatter, varies) in [(0.0, false), (1e-13, false), (1e-11, true)] {
            let (found, groups) = indices(&of(scatter), draws, &names);
            assert_eq!((found.is_some(), groups), (varies, 32), "{scatter}");
        }
    }

    #[test]
    fn the_function_of_ishigami_has_its_indices() {
        use std::f64::consts::PI;
        let angle = |u: f64| PI * (2.0 * u - 1.0);
        let f = |x: &[f64]| {
            let [x, y, z] = [angle(x[0]), angle(x[1]), angle(x[2])];
            x.sin() + 7.0 * y.sin().powi(2) + 0.1 * z.powi(4) * x.sin()
        };
        // Ishigami and Homma (1990), a = 7, b = 0.1
        let (v1, v2) = (0.5 * (1.0 + 0.1 * PI.powi(4) / 5.0).powi(2), 49.0 / 8.0);
        let v13 = 0.01 * PI.powi(8) * (1.0 / 18.0 - 1.0 / 50.0);
        let v = v1 + v2 + v13;
        let found = of(f, Sequence::Sobol, 80 * 4096);
        for (indices, [first, total]) in found.iter().zip([[v1, v1 + v13], [v2, v2], [0.0, v13]]) {
            holds(&indices.first, first / v, 5e-3);
            holds(&indices.total, total / v, 5e-3);
        }
    }
}
