//! The values of a draw by its number.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use schemars::JsonSchema;
use serde::Deserialize;

use super::distribution::Distribution;
use super::sobol::{Sobol, mixed, unit};
use crate::scene::FieldPath;

/// Smallest number of groups in a replicate after which it is decided whether they are sufficient.
const FIRST_STAGE: u64 = 64;

/// Source of the draws.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Sequence {
    /// Scrambled Sobol' points.
    #[default]
    Sobol,
    /// Independent random numbers: plain Monte Carlo.
    Random,
}

invalid_input::names!(Sequence, "sequence", { Sobol: "sobol", Random: "random" });

/// Sampling of uncertain fields.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sampling {
    /// What the draws depend on, beside their number.
    pub seed: u64,
    /// Largest number of draws, rounded down to a power of two of groups in each replicate.
    pub draws: u64,
    /// Their source.
    pub sequence: Sequence,
    /// Number of independent scramblings, whose scatter gives the sampling error.
    pub replicates: u64,
    /// Whether first and total indices of Sobol' are computed.
    pub indices: bool,
}

/// Fields that are known as distributions.
#[derive(Debug, Clone, PartialEq)]
pub struct Uncertain {
    /// The fields.
    pub fields: Vec<(FieldPath, Distribution)>,
    /// How they are drawn.
    pub sampling: Sampling,
    /// The outputs that are reported as distributions.
    pub outputs: Vec<Output>,
    sobol: Sobol,
}

/// A result of the sweep that is reported as a distribution.
#[derive(Debug, Clone, PartialEq)]
pub struct Output {
    /// Its column.
    pub name: String,
    /// Requested standard error of the mean and of every quantile, in the unit of the output. Drawing ends once all outputs have
    /// reached theirs.
    pub sampling_error: Option<f64>,
}

/// The layout of draws: draw `(group * replicates + replicate) * impacts + impact`, so that all draws up to any group of all
/// replicates are a sample.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::sweep) struct Draws {
    /// Impacts in a group: one, or one each of `a`, `b` and every `ab_j`.
    pub impacts: u64,
    pub replicates: u64,
    /// Groups in a replicate.
    pub groups: u64,
}

impl Draws {
    /// Total number of draws.
    pub fn count(&self) -> u64 {
        self.impacts * self.replicates * self.groups
    }
}

impl Uncertain {
    /// Needs at most 128 coordinates, two for each field if indices are computed and one otherwise, and enough draws for two groups in each replicate.
    pub(super) fn new(fields: Vec<(FieldPath, Distribution)>, sampling: Sampling) -> Uncertain {
        let coordinates = if sampling.indices { 2 * fields.len() } else { fields.len() };
        Uncertain { sobol: Sobol::new(coordinates), fields, sampling, outputs: Vec::new() }
    }

    /// Whether draws end by their sampling error.
    pub(in crate::sweep) fn is_adaptive(&self) -> bool {
        self.outputs.iter().any(|output| output.sampling_error.is_some())
    }

    /// The layout of the draws.
    pub(in crate::sweep) fn draws(&self) -> Draws {
        let Sampling { draws, replicates, indices, .. } = self.sampling;
        let impacts = if indices { self.fields.len() as u64 + 2 } else { 1 };
        let groups = draws / (impacts * replicates);
        Draws { impacts, replicates, groups: groups.checked_ilog2().map_or(0, |power| 1 << power) }
    }

    /// Draws of a chunk of work, a whole number of groups of all replicates, about `most`.
    pub(in crate::sweep) fn draws_per_chunk(&self, most: u64) -> u64 {
        let Draws { impacts, replicates, groups } = self.draws();
        let whole = impacts * replicates;
        let times = (most / whole).checked_ilog2().map_or(1, |power| 1 << power);
        whole * times.min(groups)
    }

    /// The numbers of draws after which it is decided whether they are sufficient; the last is the total number.
    pub(in crate::sweep) fn stages(&self) -> impl Iterator<Item = u64> {
        let Draws { impacts, replicates, groups } = self.draws();
        let first = if self.is_adaptive() { FIRST_STAGE.min(groups) } else { groups };
        let stages = std::iter::successors(Some(first), move |stage| (2 * stage <= groups).then_some(2 * stage));
        stages.map(move |stage| stage * impacts * replicates)
    }

    /// A number from each field's distribution, in the draw of this number.
    pub(in crate::sweep) fn draw(&self, number: u64) -> Vec<f64> {
        let Draws { impacts, replicates, .. } = self.draws();
        let (impact, rest) = (number % impacts, number / impacts);
        let (replicate, group) = (rest % replicates, rest / replicates);
        let count = self.fields.len();
        let random = match self.sampling.sequence {
            Sequence::Sobol => Vec::new(),
            Sequence::Random => self.random(rest),
        };
        let key = mixed(self.sampling.seed, replicate);
        let share = |field: usize| {
            // impact 0 is a, 1 is b, 2 + j is a with the field j of b
            let of_b = impact == 1 || impact == field as u64 + 2;
            let coordinate = if of_b { count + field } else { field };
            match self.sampling.sequence {
                // there are at most 2^32 groups, of at most 1e12 draws
                Sequence::Sobol => self.sobol.at(group as u32, coordinate, key),
                Sequence::Random => random[coordinate],
            }
        };
        self.fields.iter().enumerate().map(|(field, (_, distribution))| distribution.quantile(share(field))).collect()
    }

    /// Independent numbers for every coordinate.
    fn random(&self, stream: u64) -> Vec<f64> {
        let mut key = [0; 32];
        key[..8].copy_from_slice(&self.sampling.seed.to_le_bytes());
        let mut generator = ChaCha8Rng::from_seed(key);
        generator.set_stream(stream);
        let coordinates = if self.sampling.indices { 2 * self.fields.len() } else { self.fields.len() };
        (0..coordinates).map(|_| unit(generator.next_u64() >> 12)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn uncertain(draws: u64, indices: bool, sampling_error: Option<f64>) -> Uncertain {
        let fields = ["x", "y"].map(|name| (FieldPath::parse(name).unwrap(), Distribution::Uniform([0.0, 1.0])));
        let sequence = Sequence::Sobol;
        let sampling = Sampling { seed: 1, draws, sequence, replicates: 8, indices };
        let outputs = vec![Output { name: "restitution".to_owned(), sampling_error }];
        Uncertain { outputs, ..Uncertain::new(fields.to_vec(), sampling) }
    }

    #[test]
    fn draws_are_a_power_of_two_in_each_replicate_and_stages_end_with_all_of_them() {
        let plain = uncertain(1000, false, Some(0.1));
        assert_eq!(plain.draws(), Draws { impacts: 1, replicates: 8, groups: 64 });
        assert_eq!(plain.stages().collect::<Vec<_>>(), [512]);
        assert_eq!(uncertain(5000, false, Some(0.1)).stages().collect::<Vec<_>>(), [512, 1024, 2048, 4096]);
        assert_eq!(uncertain(5000, false, None).stages().collect::<Vec<_>>(), [4096]);
        assert_eq!(plain.draws_per_chunk(128), 128);
        assert_eq!(uncertain(5000, true, None).draws_per_chunk(128), 128);
    }

    #[test]
    fn a_group_holds_two_points_and_their_mixtures() {
        for sequence in [Sequence::Sobol, Sequence::Random] {
            let mut uncertain = uncertain(1000, true, None);
            uncertain.sampling.sequence = sequence;
            let [a, b, first, second] = [0, 1, 2, 3].map(|impact| uncertain.draw(4 * 37 + impact));
            assert!(a != b && a[0] != b[0] && a[1] != b[1]);
            assert_eq!((first, second), (vec![b[0], a[1]], vec![a[0], b[1]]));
        }
    }
}
