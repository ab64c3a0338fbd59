//! The values of a field along an axis and in random draws. Each value is a function of its number alone, so that any part of a
//! sweep can be computed separately.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use schemars::JsonSchema;
use serde::Deserialize;
use serde_json::{Number, Value};

use crate::scene::FieldPath;

/// Most points of a sweep: indices and byte counts stay exact in every format that is written.
pub(super) const MAX_POINTS: u64 = 1_000_000_000_000;

/// How an interval is divided.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Scale {
    /// Equal differences.
    #[default]
    Linear,
    /// Equal ratios.
    Log,
}

invalid_input::names!(Scale, "scale", { Linear: "linear", Log: "log" });

/// An interval of numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interval {
    /// One end.
    pub from: f64,
    /// The other end; may be the lower one.
    pub to: f64,
    /// Its division.
    pub scale: Scale,
    /// Whether values are rounded to whole numbers.
    pub whole_numbers: bool,
}

impl Interval {
    /// The number at a share of the interval, from 0 (`from`) to 1 (`to`).
    fn at(&self, share: f64) -> f64 {
        let value = match (share, self.scale) {
            (0.0, _) => self.from,
            (1.0, _) => self.to,
            // neither form can overflow within the interval
            (_, Scale::Linear) => self.from * (1.0 - share) + self.to * share,
            (_, Scale::Log) => self.from.powf(1.0 - share) * self.to.powf(share),
        };
        if self.whole_numbers { value.round() } else { value }
    }
}

/// A field that runs through values.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// The field.
    pub field: FieldPath,
    /// Its values.
    pub values: AxisValues,
}

/// The values of an axis.
#[derive(Debug, Clone, PartialEq)]
pub enum AxisValues {
    /// `count` numbers from one end of an interval to the other.
    Range(Interval, u64),
    /// As listed: numbers, texts, or whole objects.
    List(Vec<Value>),
}

impl Axis {
    /// Number of values.
    pub fn count(&self) -> u64 {
        match &self.values {
            AxisValues::Range(_, count) => *count,
            AxisValues::List(values) => values.len() as u64,
        }
    }

    /// The value with this number, counted from 0.
    pub(super) fn value(&self, number: u64) -> Value {
        match &self.values {
            AxisValues::Range(interval, count) => {
                json_number(interval.at(number as f64 / count.saturating_sub(1).max(1) as f64))
            }
            AxisValues::List(values) => {
                usize::try_from(number).ok().and_then(|number| values.get(number)).cloned().unwrap_or_default()
            }
        }
    }

    /// Whether every value is a number.
    pub(super) fn is_numeric(&self) -> bool {
        match &self.values {
            AxisValues::Range(..) => true,
            AxisValues::List(values) => values.iter().all(Value::is_number),
        }
    }
}

/// Fields that are drawn at random.
#[derive(Debug, Clone, PartialEq)]
pub struct Random {
    /// The seed: draws depend only on it and on their number.
    pub seed: u64,
    /// Number of draws.
    pub draws: u64,
    /// The fields, each with the interval it is drawn from.
    pub fields: Vec<(FieldPath, Interval)>,
}

impl Random {
    /// The values of all fields in the draw with this number.
    pub(super) fn draw(&self, number: u64) -> Vec<Value> {
        let mut key = [0; 32];
        key[..8].copy_from_slice(&self.seed.to_le_bytes());
        // one stream of the cipher for each draw, so that any draw can be computed directly
        let mut stream = ChaCha8Rng::from_seed(key);
        stream.set_stream(number);
        self.fields.iter().map(|(_, interval)| json_number(interval.at(unit(stream.next_u64())))).collect()
    }
}

/// A number from 0 to 1, 1 excluded, with all 53 digits.
fn unit(bits: u64) -> f64 {
    (bits >> 11) as f64 * (-53f64).exp2()
}

/// A number as JSON; whole numbers without a fraction, so that they are valid in integer fields.
pub(super) fn json_number(value: f64) -> Value {
    const EXACT: f64 = (1u64 << 53) as f64;
    if value.fract() == 0.0 && value.abs() <= EXACT {
        Value::from(value as i64)
    } else {
        Number::from_f64(value).map_or(Value::Null, Value::Number)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn range(from: f64, to: f64, count: u64, scale: Scale) -> Vec<f64> {
        let interval = Interval { from, to, scale, whole_numbers: false };
        let axis = Axis { field: FieldPath::parse("x").unwrap(), values: AxisValues::Range(interval, count) };
        (0..count).map(|i| axis.value(i).as_f64().unwrap()).collect()
    }

    #[test]
    fn ranges_hold_their_ends_and_equal_steps() {
        assert_eq!(range(0.0, 1.0, 5, Scale::Linear), [0.0, 0.25, 0.5, 0.75, 1.0]);
        assert_eq!(range(3.0, 1.0, 3, Scale::Linear), [3.0, 2.0, 1.0]);
        let logarithmic = range(1e-3, 1e3, 7, Scale::Log);
        assert_eq!((logarithmic[0], logarithmic[6]), (1e-3, 1e3));
        for (i, value) in logarithmic.iter().enumerate() {
            assert!((value / 10f64.powi(i as i32 - 3) - 1.0).abs() < 4.0 * f64::EPSILON);
        }
        // no intermediate result overflows
        assert!(range(-1e308, 1e308, 9, Scale::Linear).iter().all(|value| value.is_finite()));
        assert!(range(1e-300, 1e300, 9, Scale::Log).iter().all(|value| value.is_finite() && *value > 0.0));
    }

    #[test]
    fn whole_numbers_are_whole() {
        let interval = Interval { from: 10.0, to: 100.0, scale: Scale::Log, whole_numbers: true };
        let axis = Axis { field: FieldPath::parse("modes").unwrap(), values: AxisValues::Range(interval, 3) };
        assert_eq!([0, 1, 2].map(|i| axis.value(i).as_u64()), [Some(10), Some(32), Some(100)]);
    }

    #[test]
    fn draws_depend_on_seed_and_number_alone_and_fill_the_interval() {
        let interval = Interval { from: 1.0, to: 100.0, scale: Scale::Log, whole_numbers: false };
        let field = FieldPath::parse("x").unwrap();
        let random = Random { seed: 7, draws: 4000, fields: vec![(field.clone(), interval), (field, interval)] };
        assert_eq!(random.draw(123), random.draw(123));
        assert_ne!(random.draw(123), random.draw(124));
        assert_ne!(Random { seed: 8, ..random.clone() }.draw(123), random.draw(123));
        // shares of the logarithm are uniform: mean 1/2, variance 1/12, the two fields uncorrelated
        let shares: Vec<[f64; 2]> = (0..random.draws)
            .map(|i| [0, 1].map(|field| random.draw(i)[field].as_f64().unwrap().ln() / 100f64.ln()))
            .collect();
        let mean = |of: &dyn Fn(&[f64; 2]) -> f64| shares.iter().map(of).sum::<f64>() / shares.len() as f64;
        assert!(shares.iter().flatten().all(|share| (0.0..1.0).contains(share)));
        // four standard deviations of each mean
        assert!((mean(&|s| s[0]) - 0.5).abs() < 0.0183);
        assert!((mean(&|s| (s[0] - 0.5).powi(2)) - 1.0 / 12.0).abs() < 0.0048);
        assert!(mean(&|s| (s[0] - 0.5) * (s[1] - 0.5)).abs() < 0.0053);
    }
}
