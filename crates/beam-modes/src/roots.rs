//! Natural frequencies by a count and a root finder, so that none can be missed.
//!
//! At a trial frequency, a waveguide gives the number of natural frequencies below it (the count of Wittrick and Williams) and
//! a characteristic function. The count divides an interval until each part contains one frequency; there the characteristic
//! function changes sign once, and Chandrupatla's method converges to the last digits. If frequencies coincide to rounding, the
//! count alone is used to enclose them.
//!
//! The two are computed differently, so that each checks the other: the sign of the characteristic function must have the
//! parity of the count.

use crate::span::RESOLVABLE;
use invalid_input::InvalidInput;

/// The functions that the search evaluates at a trial value `q` (any increasing function of frequency).
pub(crate) trait Characteristic {
    /// Number of natural frequencies below `q`, rigid-body ones included, and the characteristic function at `q`.
    fn count_and_function(&self, q: f64) -> (usize, f64);
    /// The characteristic function alone.
    fn function(&self, q: f64) -> f64;
    /// A rough value of `q` below which `count` natural frequencies are expected.
    fn estimate(&self, count: usize) -> f64;
}

/// A trial value with its count and characteristic function.
#[derive(Clone, Copy)]
struct Trial {
    q: f64,
    below: usize,
    value: f64,
}

/// Relative width below which an interval counts as a point.
const CLOSED: f64 = 4.0 * f64::EPSILON;

/// Fractions at which an interval is divided.
const SPLITS: [f64; 4] = [0.487_139, 0.531_477, 0.461_893, 0.549_917];

/// Where the search for roots begins, unless frequencies lie below.
fn first_trial(problem: &impl Characteristic) -> f64 {
    0.4137 * problem.estimate(1)
}

/// The number of natural frequencies below those for which [`elastic_roots`] searches first.
pub(crate) fn count_below_search(problem: &impl Characteristic) -> usize {
    problem.count_and_function(first_trial(problem)).0
}

/// The first `wanted` roots after `rigid` zero ones, in ascending order.
pub(crate) fn elastic_roots(
    problem: &impl Characteristic,
    rigid: usize,
    wanted: usize,
) -> Result<Vec<f64>, InvalidInput> {
    let mut roots = Vec::with_capacity(wanted);
    if wanted == 0 {
        return Ok(roots);
    }
    let trial = |q: f64| {
        let (below, value) = problem.count_and_function(q);
        Trial { q, below, value }
    };
    let mut low = trial(first_trial(problem));
    for _ in 0..60 {
        if low.below == rigid {
            break;
        }
        low = trial(0.4871 * low.q);
    }
    // Each root changes the sign once: from here on the sign must agree with the parity of the count.
    let agrees = |t: &Trial| (t.value * low.value > 0.0) == t.below.abs_diff(rigid).is_multiple_of(2);
    let mut high = trial(problem.estimate(rigid + wanted));
    for _ in 0..200 {
        if high.below >= rigid + wanted && agrees(&high) {
            break;
        }
        high = trial(1.2137 * high.q);
    }
    if high.below < rigid + wanted || low.below != rigid {
        return Err(InvalidInput::new("segments", "as given", RESOLVABLE));
    }

    let mut pending = vec![(low, high)];
    while let Some((low, high)) = pending.pop() {
        let inside = high.below - low.below;
        if inside == 0 || roots.len() >= wanted {
            continue;
        }
        if high.q - low.q <= CLOSED * high.q {
            roots.extend(std::iter::repeat_n(0.5 * (low.q + high.q), inside));
        } else if inside == 1 && low.value * high.value < 0.0 {
            roots.push(chandrupatla(|q| problem.function(q), (low.q, low.value), (high.q, high.value)));
        } else {
            // Within rounding of a pole of the stiffness of a part the count can be wrong by one, and the parity shows it.
            // These fractions avoid likely poles, and there is a second choice.
            let at = |fraction: f64| trial(low.q + fraction * (high.q - low.q));
            let mut split = SPLITS.iter().map(|&f| at(f)).find(&agrees).unwrap_or_else(|| at(SPLITS[0]));
            split.below = split.below.clamp(low.below, high.below);
            pending.push((split, high));
            pending.push((low, split));
        }
    }
    roots.truncate(wanted);
    Ok(roots)
}

/// Root of `f` between two points of opposite sign (T. R. Chandrupatla, Adv. Eng. Softw. 28:145, 1997): inverse quadratic
/// interpolation if it is safe, bisection otherwise.
fn chandrupatla(f: impl Fn(f64) -> f64, (mut a, mut fa): (f64, f64), (mut b, mut fb): (f64, f64)) -> f64 {
    let mut fraction = 0.5;
    for _ in 0..200 {
        let x = a + fraction * (b - a);
        let fx = f(x);
        let (c, fc) = if (fx > 0.0) == (fa > 0.0) {
            let old = (a, fa);
            (a, fa) = (x, fx);
            old
        } else {
            let old = (b, fb);
            (b, fb) = (a, fa);
            (a, fa) = (x, fx);
            old
        };
        let best = if fa.abs() < fb.abs() { a } else { b };
        let narrow = 0.5 * CLOSED * best.abs() / (b - a).abs();
        if narrow >= 0.5 || fa == 0.0 {
            return best;
        }
        let xi = (a - b) / (c - b);
        let phi = (fa - fb) / (fc - fb);
        fraction = if phi * phi < xi && (1.0 - phi) * (1.0 - phi) < 1.0 - xi {
            fa / (fb - fa) * fc / (fb - fc) + (c - a) / (b - a) * fa / (fc - fa) * fb / (fc - fb)
        } else {
            0.5
        };
        fraction = fraction.clamp(narrow, 1.0 - narrow);
    }
    a
}
