//! The result of an identification.

use std::collections::BTreeMap;

use serde::Serialize;

/// The object that `vibroimpact identify --json` prints.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Identification {
    /// The parameters, in the requested order.
    pub parameters: Vec<Identified>,
    /// Probability with which an interval holds its parameter.
    pub level: f64,
    /// Correlations of the parameters' coordinates, row by row; null where the data do not determine all.
    pub correlation: Option<Vec<Vec<f64>>>,
    /// Combinations that the data do not determine.
    pub undetermined: Vec<Undetermined>,
    /// Products of powers of parameters in these combinations that the data do determine.
    pub combinations: Vec<Combination>,
    /// Number of measured values, including samples of force histories.
    pub count: usize,
    /// That number minus the parameters and the offsets of force histories.
    pub degrees_of_freedom: usize,
    /// Weighted sum of squares, Eq. (1).
    pub sum_of_squares: f64,
    /// Whether the search ended at a minimum.
    pub converged: bool,
    /// Noise of each measured quantity.
    pub noise: Vec<Noise>,
    /// Tests of the model against the noise; empty if the data allow none.
    pub lack_of_fit: Vec<LackOfFit>,
    /// Number of modes, chosen once; null for all that are listed.
    pub modes: Option<usize>,
    /// Largest change of a measured quantity other than the restitution by further modes, in standard deviations of its noise, where the
    /// number of modes is chosen and noise is stated. The number of modes is raised until it is at most 0.2, or to 500.
    pub left_out_modes_sd: Option<f64>,
    /// Rows whose number of contacts changes within the steps of the derivative: they are near grazing, and the sum of squares is
    /// not smooth there.
    pub grazing_lines: Vec<u64>,
    /// Starting points of the searches, and their ends.
    pub starts: Vec<StartFound>,
    /// Measured and predicted values.
    pub predictions: Vec<Predicted>,
    /// Force histories.
    pub records: Vec<RecordFit>,
    /// Candidate experiments, the most informative first; empty if none were stated.
    pub candidates: Vec<Candidate>,
    /// The profiles behind the intervals.
    pub profiles: Vec<ProfileCurve>,
}

/// A parameter.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Identified {
    /// Path of the field.
    pub field: String,
    /// The value in the scene; for the time constant of a gauge, the start of the search.
    pub start: f64,
    /// The estimate; where the data do not determine the parameter, the value at which the search stopped.
    pub value: f64,
    /// Whether the data determine the parameter. They do not if its interval is open on both sides, or on one side while a
    /// combination that contains the parameter is undetermined.
    pub determined: bool,
    /// Interval by the covariance; null where the data do not determine the parameter.
    pub covariance_interval: Option<[f64; 2]>,
    /// Interval by the likelihood profile; an end is null if the sum of squares does not rise enough.
    pub profile_interval: [Option<f64>; 2],
    /// Whether the two differ by more than a tenth of their half-width; the interval by the covariance is then too simple.
    pub bent: bool,
}

/// A combination of parameters that the data do not determine.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Undetermined {
    /// Unit vector in the coordinates of the parameters (logarithms, mostly), by their fields; entries below 0.1 are left out.
    pub direction: BTreeMap<String, f64>,
    /// Standard deviation along it; null if the data contain no information.
    pub standard_deviation: Option<f64>,
    /// The same in words.
    pub text: String,
}

/// A product of powers of parameters that the data determine.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Combination {
    /// The product in words.
    pub product: String,
    /// The exponent of each parameter, by its field.
    pub exponents: BTreeMap<String, f64>,
    /// The estimate of the product, in SI units.
    pub value: f64,
    /// Interval by the covariance.
    pub interval: [f64; 2],
}

/// Noise of a measured quantity.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Noise {
    /// The quantity.
    pub quantity: String,
    /// Number of its values.
    pub count: usize,
    /// Standard deviation in its unit: estimated, or the root mean square of those stated.
    pub standard_deviation: f64,
    /// Whether it was stated.
    pub stated: bool,
    /// Root mean square difference of measurement and prediction, in its unit.
    pub rms: f64,
}

/// A test of the model.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LackOfFit {
    /// Name of the test.
    pub test: String,
    /// Sum of squares, ratio of variances, or correlation.
    pub statistic: f64,
    /// Probability that the right model has a value at least as extreme.
    pub probability: f64,
    /// Whether that is below 0.01.
    pub noticed: bool,
}

/// A starting point.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StartFound {
    /// Where the search began.
    pub from: Vec<f64>,
    /// Where it ended, to a few digits.
    pub parameters: Vec<f64>,
    /// The robust sum there, of `ln(1 + r^2)`; null where the model does not exist.
    pub robust_sum: Option<f64>,
}

/// A measured value and its prediction.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Predicted {
    /// Line of the table.
    pub line: u64,
    /// The quantity.
    pub quantity: &'static str,
    /// The measured value.
    pub measured: f64,
    /// The prediction with the estimated parameters.
    pub predicted: f64,
    /// Standard deviation of the measurement.
    pub measured_sd: f64,
    /// Standard deviation of the prediction, from that of the parameters; null where that is not determined.
    pub predicted_sd: Option<f64>,
}

/// A force history and its prediction.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RecordFit {
    /// Line of the table.
    pub line: u64,
    /// The file.
    pub file: String,
    /// Time of the first touch by the clock of the gauge (s).
    pub offset_s: f64,
    /// Samples: time (s), measured and predicted force (N).
    #[serde(skip)]
    pub samples: [Vec<f64>; 3],
}

/// A candidate experiment.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Candidate {
    /// Line of the table of candidates.
    pub line: u64,
    /// Its fields.
    pub fields: BTreeMap<String, serde_json::Value>,
    /// Volume of the confidence region with it over that without; the smaller, the more informative. Null if its impact cannot be
    /// resolved, or lacks a quantity that was measured.
    pub volume_ratio: Option<f64>,
    /// Standard deviation of each parameter's coordinate with it over that without; null likewise.
    pub sd_ratios: Option<Vec<f64>>,
}

/// A likelihood profile.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ProfileCurve {
    /// The parameter.
    pub field: String,
    /// Values at which it was held.
    pub values: Vec<f64>,
    /// Minimum of the sum of squares there, minus that of the fit.
    pub rise: Vec<f64>,
    /// The rise at the ends of the interval.
    pub limit: f64,
}
