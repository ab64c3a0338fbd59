//! The entries of a sweep file for uncertain fields.

use std::collections::BTreeMap;

use invalid_input::{InvalidInput, Path};
use schemars::JsonSchema;
use serde::Deserialize;
use serde_json::Value;

use super::design::{Output, Sampling, Sequence, Uncertain};
use super::distribution::Distribution;
use super::sobol::MOST_COORDINATES;
use crate::scene::FieldPath;
use crate::scene::json::{number, quote};
use crate::scene::told::did_you_mean;
use crate::sweep::results::Results;
use crate::sweep::values::MAX_POINTS;

/// Largest number of uncertain fields, and with indices, which need two coordinates for each.
const MOST_FIELDS: usize = MOST_COORDINATES;
const MOST_WITH_INDICES: usize = MOST_COORDINATES / 2;
const DISTRIBUTION: &str =
    "an object with one of uniform, log-uniform, normal and lognormal, which is a list of two numbers";
/// Default numbers of draws and of scramblings.
const DRAWS: u64 = 16_384;
const REPLICATES: u64 = 16;
const MOST_REPLICATES: u64 = 1000;
/// Largest number of outputs: each is stored for all draws of a point of the grid.
const MOST_OUTPUTS: usize = 32;

/// Fields by their path, each with its distribution. Beside a field of `vary` the drawn number is added to the grid's value
/// (uniform, normal) or multiplied by it (log-uniform, lognormal).
pub(in crate::sweep) type UncertainEntry = BTreeMap<String, Distribution>;

/// How uncertain fields are drawn; each field may be left out.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Sampling")]
pub(in crate::sweep) struct SamplingEntry {
    /// Seed of the draws, which depend only on it and on their number; 1 when left out.
    #[schemars(range(min = 0))]
    seed: Option<u64>,
    /// Largest number of draws, 16384 when left out; rounded down to a power of two of groups in each replicate.
    #[schemars(range(min = 1, max = 1_000_000_000_000u64))]
    draws: Option<u64>,
    /// Scrambled Sobol' points (sobol, when left out) or independent random numbers (random).
    sequence: Option<Sequence>,
    /// Number of independent scramblings, whose scatter gives the sampling error; 16 when left out.
    #[schemars(range(min = 2, max = 1000))]
    replicates: Option<u64>,
    /// Results of the sweep whose distributions are computed. When left out: the restitution or, for a scene of bodies, the
    /// intervals of contact, the largest force and the contact work rate.
    #[schemars(length(min = 1, max = 32))]
    outputs: Option<Vec<String>>,
    /// The standard error of the mean and of every quantile at which no more draws are made: a number for a single output, an
    /// object with such numbers for several.
    sampling_error: Option<SamplingError>,
    /// Whether first and total indices of Sobol' are computed, which takes two impacts more for each draw than there are fields.
    indices: Option<bool>,
}

/// One number for the only output, or an object with numbers for some outputs.
#[derive(Deserialize, JsonSchema)]
#[serde(untagged)]
enum SamplingError {
    OfOne(#[schemars(extend("exclusiveMinimum" = 0))] f64),
    OfEach(BTreeMap<String, f64>),
}

/// The requested outputs, not yet compared with the results of the sweep.
#[derive(Default)]
pub(in crate::sweep) struct Told {
    outputs: Option<Vec<String>>,
    sampling_error: Option<SamplingError>,
}

impl Told {
    /// Whether the number of draws depends on the sampling error.
    pub fn is_adaptive(&self) -> bool {
        self.sampling_error.is_some()
    }
}

impl Uncertain {
    /// The outputs of a sweep with these results.
    pub(in crate::sweep) fn tell(&mut self, told: Told, results: &Results) -> Result<(), InvalidInput> {
        let all = results.outputs();
        let allowed = |name: &str| {
            let meant = did_you_mean(name, all.iter().map(String::as_str));
            format!("one of {}{meant}", all.join(", "))
        };
        let names = told.outputs.unwrap_or_else(|| results.told().iter().map(|name| (*name).to_owned()).collect());
        if !(1..=MOST_OUTPUTS).contains(&names.len()) {
            let allowed = format!("a list of 1 to {MOST_OUTPUTS} results of the sweep");
            return Err(InvalidInput::new("outputs", format!("{} names", names.len()), allowed));
        }
        for (i, name) in names.iter().enumerate() {
            let fault = |allowed| InvalidInput::new(("outputs", i), quote(&name.as_str().into()), allowed);
            if !all.contains(name) {
                return Err(fault(allowed(name)));
            }
            if names[..i].contains(name) {
                return Err(fault("stated only once".to_owned()));
            }
        }
        let wanted = match (told.sampling_error, names.as_slice()) {
            (None, _) => BTreeMap::new(),
            (Some(SamplingError::OfOne(error)), [one]) => BTreeMap::from([(one.clone(), error)]),
            (Some(SamplingError::OfOne(error)), _) => {
                let allowed = format!(
                    "an object with such a number for some of {}, because their units differ",
                    names.join(", ")
                );
                return Err(InvalidInput::new("sampling_error", number(error), allowed));
            }
            (Some(SamplingError::OfEach(wanted)), _) => wanted,
        };
        if let Some((name, error)) = wanted.iter().find(|(name, _)| !names.contains(name)) {
            let allowed = format!("stated for one of {}", names.join(", "));
            return Err(InvalidInput::new(["sampling_error", name], number(*error), allowed));
        }
        let output = |name: String| Output { sampling_error: wanted.get(&name).copied(), name };
        self.outputs = names.into_iter().map(output).collect();
        Ok(())
    }
}

/// Reads both entries; `typed` reads an object with the messages of sweep files.
pub(in crate::sweep) fn read(
    uncertain: &Value,
    sampling: Option<&Value>,
    typed: impl FnOnce(&Value) -> Result<SamplingEntry, InvalidInput>,
) -> Result<(Uncertain, Told), InvalidInput> {
    let fields = match uncertain {
        Value::Object(map) if (1..=MOST_FIELDS).contains(&map.len()) => map,
        other => {
            let allowed = format!("an object with 1 to {MOST_FIELDS} fields of the scene and their distributions");
            return Err(InvalidInput::new("uncertain", quote(other), allowed));
        }
    };
    let field = |(name, value): (&String, &Value)| {
        let fault = |allowed: &str| InvalidInput::new(["uncertain", name], quote(value), allowed);
        let path =
            FieldPath::parse(name).ok_or_else(|| fault("a distribution under the path of a field of the scene"))?;
        let distribution: Distribution = serde_json::from_value(value.clone()).map_err(|_| fault(DISTRIBUTION))?;
        distribution.fault().map_or(Ok((path, distribution)), |allowed| Err(fault(allowed)))
    };
    let fields = fields.iter().map(field).collect::<Result<Vec<_>, _>>()?;
    let within = |found: InvalidInput| found.within("sampling");
    let empty = Value::Object(Default::default());
    let entry = typed(sampling.unwrap_or(&empty)).map_err(within)?;
    let SamplingEntry { seed, draws, sequence, replicates, outputs, sampling_error, indices } = entry;
    let sampling = Sampling {
        seed: seed.unwrap_or(1),
        draws: draws.unwrap_or(DRAWS),
        sequence: sequence.unwrap_or_default(),
        replicates: replicates.unwrap_or(REPLICATES),
        indices: indices.unwrap_or_default(),
    };
    if !(2..=MOST_REPLICATES).contains(&sampling.replicates) {
        let allowed = format!("a whole number from 2 to {MOST_REPLICATES}");
        return Err(within(InvalidInput::new("replicates", sampling.replicates.to_string(), allowed)));
    }
    let positive = |error: f64| error.is_finite() && error > 0.0;
    let fault = match &sampling_error {
        Some(SamplingError::OfOne(error)) if !positive(*error) => Some((Path::from("sampling_error"), *error)),
        Some(SamplingError::OfEach(errors)) => {
            let found = errors.iter().find(|(_, error)| !positive(**error));
            found.map(|(name, error)| (["sampling_error", name].into(), *error))
        }
        _ => None,
    };
    if let Some((field, error)) = fault {
        return Err(within(InvalidInput::new(field, number(error), "a number greater than 0")));
    }
    if sampling.indices && fields.len() > MOST_WITH_INDICES {
        let allowed = format!(
            "left out, because indices need at most {MOST_WITH_INDICES} uncertain fields and there are {}",
            fields.len()
        );
        return Err(within(InvalidInput::new("indices", "true", allowed)));
    }
    let uncertain = Uncertain::new(fields, sampling);
    let layout = uncertain.draws();
    if layout.groups < 2 || !(1..=MAX_POINTS).contains(&sampling.draws) || layout.groups > 1 << 32 {
        let least = 2 * layout.impacts * layout.replicates;
        let allowed =
            format!("a whole number from {least} (two groups of {} in each replicate) to 1e12", layout.impacts);
        return Err(within(InvalidInput::new("draws", sampling.draws.to_string(), allowed)));
    }
    Ok((uncertain, Told { outputs, sampling_error }))
}
