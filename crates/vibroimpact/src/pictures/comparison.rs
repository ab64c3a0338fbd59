//! Comparison of the results of several models.

use crate::model::{Answer, Comparison};
use crate::plot::{Axis, Colour, Figure, Marker, Panel, Series};
use crate::text::restitution as with_uncertainty;

/// The restitution of each model with its uncertainty and its cost. A value that is not finite (no result, unknown uncertainty, no
/// measured cost) is omitted, and so are values missing from a shorter list. Without any cost there is no axis for it.
///
/// ```
/// use vibroimpact::pictures::comparison;
/// let figure = comparison(
///     "A ball on a beam",
///     &["rigid", "infinite beam", "modal, N = 40"],
///     &[1.0, 0.131, 0.1426],
///     &[f64::NAN, 1e-9, 3e-3],
///     &[1e-6, 2e-4, 3e-3],
/// );
/// assert!(figure.svg()?.contains("infinite beam"));
/// # Ok::<(), std::io::Error>(())
/// ```
pub fn comparison(
    title: &str,
    names: &[impl AsRef<str>],
    restitution: &[f64],
    uncertainty: &[f64],
    cost_s: &[f64],
) -> Figure {
    let count = names.len();
    let value = |list: &[f64], i: usize| list.get(i).copied().filter(|v| v.is_finite()).unwrap_or(f64::NAN);
    // the first model on top
    let line: Vec<f64> = (0..count).map(|i| (count - i) as f64).collect();
    let of = |list: &[f64]| (0..count).map(|i| value(list, i)).collect::<Vec<f64>>();
    let (restitution, cost) = (of(restitution), of(cost_s));
    let error = |i: usize| Some(value(uncertainty, i)).filter(|u| *u > 0.0);
    let texts = (0..count).map(|i| match restitution[i].is_finite() {
        true => with_uncertainty(restitution[i], error(i)),
        false => String::new(),
    });
    // the usual range of a restitution, and values outside it
    let found = || restitution.iter().copied().filter(|e| e.is_finite());
    let range = (found().fold(0.0, f64::min), found().fold(1.0, f64::max));
    let ticks = || line.iter().zip(names).map(|(&y, name)| (y, name.as_ref().to_owned()));
    let y = || Axis::new("").ticks_at(ticks()).limits(0.4, count as f64 + 0.6);
    let height_px = 20.0 + 34.0 * count as f64;
    let margin = 0.03 * (range.1 - range.0);
    let bars = (0..count).flat_map(|i| bar(restitution[i], error(i).unwrap_or(0.0), line[i], range));
    let (along, across): (Vec<f64>, Vec<f64>) = bars.unzip();
    let results = Panel::new(Axis::new("restitution").limits(range.0 - margin, range.1 + margin), y())
        .height(height_px)
        .with(Series::line(&along, &across).colour(Colour::Blue))
        .with(Series::points(&restitution, &line, Marker::Dot).colour(Colour::Blue))
        .with(Series::labels(&restitution, &line, texts));
    if cost.iter().all(|cost| cost.is_nan()) {
        return Figure::new(title).row([results]);
    }
    let costs = Panel::new(Axis::new("time to compute").unit("s").log(), y().unlabelled())
        .height(height_px)
        .with(Series::points(&cost, &line, Marker::Square).colour(Colour::Vermilion));
    Figure::new(title).row([results, costs])
}

/// A bar about a value as a line with gaps. It is cut off at the range, and has a cap at an end that lies within it.
fn bar(value: f64, half: f64, level: f64, (low, high): (f64, f64)) -> Vec<(f64, f64)> {
    const CAP: f64 = 0.07;
    let gap = (f64::NAN, f64::NAN);
    let ends = [value - half, value + half];
    let mut points = ends.map(|end| (end.clamp(low, high), level)).to_vec();
    for end in ends.into_iter().filter(|end| (low..=high).contains(end)) {
        points.extend([gap, (end, level - CAP), (end, level + CAP)]);
    }
    points.push(gap);
    points
}

/// The models that can solve a scene, with the chosen one marked.
pub fn of_comparison(title: &str, comparison: &Comparison) -> Figure {
    let answers: Vec<_> = comparison.tiers.iter().filter_map(|tier| tier.answer.as_ref()).collect();
    let names: Vec<String> = answers
        .iter()
        .map(|answer| {
            let chosen = if answer.model == comparison.chosen.model { " (chosen)" } else { "" };
            // a row without a point states the reason
            let outcome = match answer.restitution {
                Some(_) => String::new(),
                None => format!(": {}", answer.outcome),
            };
            match answer.modes {
                0 => format!("{}{chosen}{outcome}", answer.model.as_str()),
                modes => format!("{}, {modes} modes{chosen}{outcome}", answer.model.as_str()),
            }
        })
        .collect();
    let restitution: Vec<f64> = answers.iter().map(|answer| answer.restitution.unwrap_or(f64::NAN)).collect();
    let uncertainty: Vec<f64> = answers.iter().map(|a| a.restitution_uncertainty.unwrap_or(f64::NAN)).collect();
    self::comparison(title, &names, &restitution, &uncertainty, &[])
}

/// An answer of a model that does not resolve the motion in time: the restitution with its uncertainty.
pub fn of_answer(title: &str, answer: &Answer) -> Figure {
    let title = format!("{title}\n{}: the net result, without motion in time", answer.model.as_str());
    let value = |number: Option<f64>| [number.unwrap_or(f64::NAN)];
    comparison(
        &title,
        &[answer.model.as_str()],
        &value(answer.restitution),
        &value(answer.restitution_uncertainty),
        &[],
    )
}

#[cfg(test)]
mod tests {
    use super::bar;

    #[test]
    fn bars_end_with_the_range() {
        let within = |points: Vec<(f64, f64)>| points.into_iter().all(|(x, _)| x.is_nan() || (0.0..=1.0).contains(&x));
        let (cut, whole) = (bar(1.0, 1.0, 4.0, (0.0, 1.0)), bar(0.5, 0.2, 4.0, (0.0, 1.0)));
        // one cap, and two
        assert_eq!((cut.len(), whole.len()), (6, 9));
        assert!(within(cut) && within(whole));
        assert!(bar(f64::NAN, 0.0, 1.0, (0.0, 1.0)).iter().all(|(x, _)| x.is_nan()));
    }
}
