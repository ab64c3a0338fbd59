//! How well a fit predicts data that were omitted from it.

use crate::error::FitError;
use crate::fit::fit_weighted;
use crate::problem::{Outcome, Problem, Settings};
use crate::random::Random;
use crate::report::Residuals;
use invalid_input::InvalidInput;

/// One omitted group.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Fold {
    /// The group's label.
    pub label: usize,
    /// The parameters fitted to all other groups.
    pub parameters: Vec<f64>,
    /// The outcome of that fit.
    pub outcome: Outcome,
    /// Residuals of the fitted data.
    pub fitted: Residuals,
    /// Residuals of the omitted group.
    pub predicted: Residuals,
}

/// The result of omitting one group after the other.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct CrossValidation {
    /// One entry per group, in the order of the labels.
    pub folds: Vec<Fold>,
    /// Each residual as predicted by the fit without its group.
    pub residuals: Vec<f64>,
    /// Their summary.
    pub report: Residuals,
}

/// Labels for `folds`-fold cross-validation: `count` residuals are distributed at random over groups whose sizes differ by at
/// most one. The same `seed` gives the same labels.
///
/// # Errors
/// [`InvalidInput`] unless `2 <= folds <= count`, or if there is no memory for so many labels.
pub fn k_folds(count: usize, folds: usize, seed: u64) -> Result<Vec<usize>, InvalidInput> {
    if folds < 2 || folds > count {
        return Err(InvalidInput::new("folds", folds, "a number from 2 to the number of residuals"));
    }
    let mut labels: Vec<usize> = Vec::new();
    if labels.try_reserve_exact(count).is_err() {
        return Err(InvalidInput::new("count", count, "a number of residuals whose labels fit into the memory"));
    }
    labels.extend((0..count).map(|i| i % folds));
    Random::new(seed).shuffle(&mut labels);
    Ok(labels)
}

/// Fits to all groups but one and predicts that one, for every group. `labels` has one label for each residual, from
/// [`k_folds`] or from the data (a beam, a rod) to omit residuals that belong together.
///
/// ```
/// use fitting::{Parameter, Problem, Settings, cross_validate};
/// let y = [1.0, 1.2, 0.9, 5.0, 5.1, 4.9];
/// let mean = Problem {
///     parameters: vec![Parameter::free("mean", 0.0, (-10.0, 10.0))],
///     count: 6,
///     residuals: &|p, r| r.iter_mut().zip(y).for_each(|(r, y)| *r = p[0] - y),
///     jacobian: None,
/// };
/// let result = cross_validate(&mean, &Settings::default(), &[0, 0, 0, 1, 1, 1])?;
/// assert!((result.folds[0].parameters[0] - 5.0).abs() < 1e-6);
/// assert!(result.folds[0].predicted.rms > 3.9 && result.folds[0].fitted.rms < 0.1);
/// # Ok::<(), fitting::FitError>(())
/// ```
///
/// # Errors
/// [`FitError::Invalid`] for a problem or settings out of range, labels that are not one for each residual, fewer than two
/// different labels, or a group without which there are fewer residuals than parameters; and as [`fit`](crate::fit) for each
/// fit.
pub fn cross_validate(problem: &Problem, settings: &Settings, labels: &[usize]) -> Result<CrossValidation, FitError> {
    problem.validate()?;
    settings.validate()?;
    if labels.len() != problem.count {
        return Err(InvalidInput::new(
            ["labels", "len()"],
            labels.len(),
            "the number of residuals, because each residual has one label",
        )
        .into());
    }
    let mut groups = labels.to_vec();
    groups.sort_unstable();
    groups.dedup();
    if groups.len() < 2 {
        return Err(InvalidInput::new("labels", groups.len(), "a list of at least two different labels").into());
    }
    let mut residuals = vec![0.0; problem.count];
    let mut folds = Vec::with_capacity(groups.len());
    for label in groups {
        let weights: Vec<f64> = labels.iter().map(|&l| if l == label { 0.0 } else { 1.0 }).collect();
        let kept = weights.iter().filter(|w| **w > 0.0).count();
        if kept < problem.parameters.len() {
            let allowed = "a label whose group leaves at least as many residuals as there are parameters";
            return Err(InvalidInput::new("labels", label, allowed).into());
        }
        let fit = fit_weighted(problem, settings, Some(&weights))?;
        let mut all = vec![f64::NAN; problem.count];
        (problem.residuals)(&fit.parameters, &mut all);
        let mut predicted = Vec::new();
        for i in (0..problem.count).filter(|&i| labels[i] == label) {
            residuals[i] = all[i];
            predicted.push(all[i]);
        }
        let (parameters, outcome, fitted) = (fit.parameters, fit.outcome, fit.report);
        folds.push(Fold { label, parameters, outcome, fitted, predicted: Residuals::of(&predicted) });
    }
    Ok(CrossValidation { folds, report: Residuals::of(&residuals), residuals })
}
