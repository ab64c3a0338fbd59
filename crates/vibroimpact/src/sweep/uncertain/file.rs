//! What a sweep file says of uncertain fields.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::Deserialize;
use serde_json::Value;

use super::design::{Sampling, Sequence, Uncertain};
use super::distribution::Distribution;
use super::sobol::MOST_COORDINATES;
use crate::scene::FieldPath;
use crate::scene::InvalidInput;
use crate::scene::json::{number, quote};
use crate::sweep::file::MAX_POINTS;

/// Most uncertain fields: indices take two coordinates each.
const MOST_FIELDS: usize = MOST_COORDINATES / 2;
const DISTRIBUTION: &str =
    "an object with one of uniform, log-uniform, normal and lognormal, which is a list of two numbers";
/// Draws when nothing is said, and scramblings.
const DRAWS: u64 = 16_384;
const REPLICATES: u64 = 16;
const MOST_REPLICATES: u64 = 1000;

/// Fields by their path, each with its distribution. Beside a field of `vary` the drawn number is added to the grid's value
/// (uniform, normal) or multiplied by it (log-uniform, lognormal).
pub(in crate::sweep) type UncertainEntry = BTreeMap<String, Distribution>;

/// How uncertain fields are drawn; each field may be left out.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Sampling")]
pub(in crate::sweep) struct SamplingEntry {
    /// What the draws depend on, beside their number; 1 when left out.
    #[schemars(range(min = 0))]
    seed: Option<u64>,
    /// At most so many draws, 16384 when left out; rounded down to a power of two of groups in each replicate.
    #[schemars(range(min = 1, max = 1_000_000_000_000u64))]
    draws: Option<u64>,
    /// Scrambled Sobol' points (sobol, when left out) or independent random numbers (random).
    sequence: Option<Sequence>,
    /// Independent scramblings, from whose scatter the sampling error is told; 16 when left out.
    #[schemars(range(min = 2, max = 1000))]
    replicates: Option<u64>,
    /// The standard error at which no more draws are made: of the mean and every quantile that is told.
    #[schemars(extend("exclusiveMinimum" = 0))]
    sampling_error: Option<f64>,
    /// Whether first and total indices of Sobol' are computed, which takes as many impacts a draw as there are fields, and two.
    indices: Option<bool>,
}

/// Reads both; `typed` reads an object in the terms of sweeps.
pub(in crate::sweep) fn read(
    uncertain: &Value,
    sampling: Option<&Value>,
    typed: impl FnOnce(&Value) -> Result<SamplingEntry, InvalidInput>,
) -> Result<Uncertain, InvalidInput> {
    let fields = match uncertain {
        Value::Object(map) if (1..=MOST_FIELDS).contains(&map.len()) => map,
        other => {
            let allowed = format!("an object with 1 to {MOST_FIELDS} fields of the scene and their distributions");
            return Err(InvalidInput::new("uncertain", quote(other), allowed));
        }
    };
    let field = |(name, value): (&String, &Value)| {
        let fault = |allowed: &str| InvalidInput::new(format!("uncertain.{name}"), quote(value), allowed);
        let path =
            FieldPath::parse(name).ok_or_else(|| fault("a distribution under the path of a field of the scene"))?;
        let distribution: Distribution = serde_json::from_value(value.clone()).map_err(|_| fault(DISTRIBUTION))?;
        distribution.fault().map_or(Ok((path, distribution)), |allowed| Err(fault(allowed)))
    };
    let fields = fields.iter().map(field).collect::<Result<Vec<_>, _>>()?;
    let within = |found: InvalidInput| found.within("sampling");
    let empty = Value::Object(Default::default());
    let entry = typed(sampling.unwrap_or(&empty)).map_err(within)?;
    let SamplingEntry { seed, draws, sequence, replicates, sampling_error, indices } = entry;
    let sampling = Sampling {
        seed: seed.unwrap_or(1),
        draws: draws.unwrap_or(DRAWS),
        sequence: sequence.unwrap_or_default(),
        replicates: replicates.unwrap_or(REPLICATES),
        sampling_error,
        indices: indices.unwrap_or_default(),
    };
    if !(2..=MOST_REPLICATES).contains(&sampling.replicates) {
        let allowed = format!("a whole number from 2 to {MOST_REPLICATES}");
        return Err(within(InvalidInput::new("replicates", sampling.replicates.to_string(), allowed)));
    }
    if let Some(error) = sampling_error.filter(|error| !(error.is_finite() && *error > 0.0)) {
        return Err(within(InvalidInput::new("sampling_error", number(error), "a number greater than 0")));
    }
    let uncertain = Uncertain::new(fields, sampling);
    let layout = uncertain.draws();
    if layout.groups < 2 || !(1..=MAX_POINTS).contains(&sampling.draws) || layout.groups > 1 << 32 {
        let least = 2 * layout.impacts * layout.replicates;
        let allowed =
            format!("a whole number from {least} (two groups of {} in each replicate) to 1e12", layout.impacts);
        return Err(within(InvalidInput::new("draws", sampling.draws.to_string(), allowed)));
    }
    Ok(uncertain)
}
