//! Matching of the modes of a structure with those of a neighbouring one.
//!
//! The sign of a mode is arbitrary, and two modes change their order where their frequencies cross. Modes that are computed have
//! the sign of the whole mode, which rarely changes from neighbour to neighbour. The shape at the contact alone does not show it: at
//! a node it passes through zero.

/// Largest relative change of a mode from a structure to its neighbour; beyond it they count as different modes.
const SAME: f64 = 1e-2;

/// A mode that moves the points here by less than this share of its motion at the neighbour does not move them here.
const UNSEEN: f64 = 1e-8;

/// The mode of a neighbour that is the same as one here.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Match {
    /// The position of the mode, which is to be swapped into that of the mode here.
    pub from: usize,
    /// Its sign.
    pub sign: f64,
}

/// The compared data of a mode.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Seen {
    /// Its frequency (rad/s).
    pub omega_rad_s: f64,
    /// Its shape at the points.
    pub shapes: Vec<f64>,
}

impl Seen {
    /// The difference of another mode from this one, and the sign with which it is the same mode: the opposite sign only if it is
    /// not the same mode with its own. If the frequency has not changed, the structure has not, but only the point where it is
    /// seen: at a support, where no mode moves, the shapes tell nothing. A mode that does not move the points here has no definite
    /// frequency if it is a remainder mode.
    fn compared(&self, other: &Seen, largest: f64) -> (f64, f64) {
        if self.omega_rad_s == other.omega_rad_s && self.omega_rad_s > 0.0 {
            return (0.0, 1.0);
        }
        let by_frequency = (self.omega_rad_s - other.omega_rad_s).abs() / self.omega_rad_s.max(f64::MIN_POSITIVE);
        if self.is_unseen_beside(other) {
            return (by_frequency.min(SAME), 1.0);
        }
        let distance = |sign: f64| {
            let by_shape = self.shapes.iter().zip(&other.shapes).map(|(one, other)| (one - sign * other).abs());
            by_shape.fold(0.0, f64::max) / largest
        };
        let (own, opposite) = (distance(1.0), distance(-1.0));
        let (by_shape, sign) = if own <= SAME || own <= opposite { (own, 1.0) } else { (opposite, -1.0) };
        (by_shape.max(by_frequency), sign)
    }

    fn is_unseen_beside(&self, other: &Seen) -> bool {
        let largest = |mode: &Seen| mode.shapes.iter().fold(0.0f64, |most, shape| most.max(shape.abs()));
        largest(self) <= UNSEEN * largest(other)
    }
}

/// For each mode in turn the matching mode of the neighbour. Beyond these the neighbour may have remainder modes, if no mode moves the
/// points here: the effect of a mode grows with the square of its shape, so that they have none on derivatives here.
///
/// # Errors
/// The reason why they are not the same modes.
pub(crate) fn matched(own: &[Seen], mut found: Vec<Seen>) -> Result<Vec<Match>, &'static str> {
    if own.iter().flat_map(|mode| &mode.shapes).all(|shape| *shape == 0.0) {
        found.truncate(own.len());
    }
    if own.len() != found.len() {
        return Err("the number of modes that the contact moves changes");
    }
    let rigid = |modes: &[Seen]| modes.iter().filter(|mode| mode.omega_rad_s == 0.0).count();
    if rigid(own) != rigid(&found) {
        return Err("a rigid-body motion becomes a vibration");
    }
    let largest = own.iter().flat_map(|mode| &mode.shapes).fold(f64::MIN_POSITIVE, |most, shape| most.max(shape.abs()));
    let mut steps = Vec::with_capacity(own.len());
    for (k, mode) in own.iter().enumerate() {
        let distance = |i: usize| mode.compared(&found[i], largest).0;
        let later = (k + 1..own.len().min(k + 3)).filter(|i| distance(*i) < distance(k));
        let i = later.min_by(|i, j| distance(*i).total_cmp(&distance(*j))).unwrap_or(k);
        if distance(i) > SAME {
            let elsewhere = (0..found.len()).any(|i| distance(i) <= SAME);
            return Err(if elsewhere {
                "two modes swap their order"
            } else {
                "a mode changes abruptly, or moves the point by no more than its rounding"
            });
        }
        found.swap(k, i);
        let sign = mode.compared(&found[k], largest).1;
        steps.push(Match { from: i, sign });
    }
    Ok(steps)
}
