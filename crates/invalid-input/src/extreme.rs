//! Which of several numbers makes what follows from them too large or too small.

/// Of several fields with their values, the one whose value is farthest from 1, as a factor; of equally far ones the first, and
/// `None` if there are none. This is the field to name if a product of powers of the values is out of range.
///
/// Signs do not count. Zero and infinity are infinitely far, and NaN is farther still. If usual values of the fields differ by
/// orders of magnitude, divide each value by its usual one.
///
/// ```
/// use invalid_input::most_extreme;
///
/// // the mass of a sphere that is too heavy
/// let fields = [("density_kg_m3", 7800.0), ("radius_m", 1e40)];
/// assert_eq!(most_extreme(fields), Some(("radius_m", 1e40)));
/// ```
pub fn most_extreme<F>(fields: impl IntoIterator<Item = (F, f64)>) -> Option<(F, f64)> {
    fields.into_iter().reduce(|most, next| {
        let is_farther = from_one(next.1).total_cmp(&from_one(most.1)).is_gt();
        if is_farther { next } else { most }
    })
}

/// The factor between this size and 1, in either direction.
fn from_one(value: f64) -> f64 {
    let size = value.abs();
    if size < 1.0 { size.recip() } else { size }
}
