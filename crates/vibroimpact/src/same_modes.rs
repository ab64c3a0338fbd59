//! Matching of the modes of a structure with those of a neighbouring one.
//!
//! The sign of a mode is arbitrary, and two modes change their order where their frequencies cross.

/// Largest relative change of a mode from a structure to its neighbour; beyond it they count as different modes.
const SAME: f64 = 1e-2;

/// The compared data of a mode.
pub(crate) struct Seen {
    /// Its frequency (rad/s).
    pub omega_rad_s: f64,
    /// Its shape at the points.
    pub shapes: Vec<f64>,
}

impl Seen {
    /// The sign with which another mode is most similar to this one.
    fn sign_of(&self, other: &Seen) -> f64 {
        let product: f64 = self.shapes.iter().zip(&other.shapes).map(|(one, other)| one * other).sum();
        if product < 0.0 { -1.0 } else { 1.0 }
    }

    fn distance(&self, other: &Seen, largest: f64) -> f64 {
        let sign = self.sign_of(other);
        let by_shape = self.shapes.iter().zip(&other.shapes).map(|(one, other)| (one - sign * other).abs() / largest);
        let by_frequency = (self.omega_rad_s - other.omega_rad_s).abs() / self.omega_rad_s.max(f64::MIN_POSITIVE);
        by_shape.fold(by_frequency, f64::max)
    }
}

/// For each mode in turn: the position of the matching mode, which is to be swapped into its own, and the sign. `None` if they are
/// not the same modes.
pub(crate) fn matched(own: &[Seen], mut found: Vec<Seen>) -> Option<Vec<(usize, f64)>> {
    if own.len() != found.len() {
        return None;
    }
    let largest = own.iter().flat_map(|mode| &mode.shapes).fold(f64::MIN_POSITIVE, |most, shape| most.max(shape.abs()));
    let mut steps = Vec::with_capacity(own.len());
    for (k, mode) in own.iter().enumerate() {
        let distance = |i: usize| mode.distance(&found[i], largest);
        let later = (k + 1..own.len().min(k + 3)).filter(|i| distance(*i) < distance(k));
        let i = later.min_by(|i, j| distance(*i).total_cmp(&distance(*j))).unwrap_or(k);
        if distance(i) > SAME {
            return None;
        }
        found.swap(k, i);
        steps.push((i, mode.sign_of(&found[k])));
    }
    Some(steps)
}
