//! Slopes through neighbouring values.

/// Computes a slope from values at neighbouring points of a parameter on both sides or on one side: that of the polynomial
/// through them.
///
/// ```
/// use vibroimpact_sim::modal::Stencil;
///
/// // at a bound, exact for polynomials of third degree
/// let slope = Stencil::new([0.1, 0.2, 0.3, 0.4]).slope([0.1, 0.2, 0.3, 0.4].map(|x: f64| 2.0 * x + x.powi(3)));
/// assert!((slope - 2.0).abs() < 1e-13);
/// ```
#[derive(Debug, Clone, Copy)]
pub struct Stencil<const N: usize> {
    /// Distances from the value, in its unit.
    pub offsets: [f64; N],
    weights: [f64; N],
}

impl<const N: usize> Stencil<N> {
    /// From distances that differ from each other, one of which may be zero.
    pub fn new(offsets: [f64; N]) -> Stencil<N> {
        // derivative at zero of Lagrange's polynomials
        let weight = |i: usize| {
            let others = || (0..N).filter(|j| *j != i);
            let scale: f64 = others().map(|j| offsets[i] - offsets[j]).product();
            let without = |skip: usize| others().filter(|j| *j != skip).map(|j| -offsets[j]).product::<f64>();
            others().map(without).sum::<f64>() / scale
        };
        Stencil { offsets, weights: std::array::from_fn(weight) }
    }

    /// Slope from the values there (their unit over that of the distances): exactly zero where they are all the same.
    pub fn slope(&self, values: [f64; N]) -> f64 {
        (1..N).map(|i| self.weights[i] * (values[i] - values[0])).sum()
    }

    /// The value of that polynomial at zero.
    pub(crate) fn value(&self, values: [f64; N]) -> f64 {
        let part = |i: usize, j: usize| self.offsets[j] / (self.offsets[j] - self.offsets[i]);
        let weight = |i: usize| (0..N).filter(|j| *j != i).map(|j| part(i, j)).product::<f64>();
        values[0] + (1..N).map(|i| weight(i) * (values[i] - values[0])).sum::<f64>()
    }

    /// Error of the slope per independent error of each value (1/unit of the distances): the root of the sum of squares.
    pub fn magnification(&self) -> f64 {
        self.weights.iter().map(|weight| weight * weight).sum::<f64>().sqrt()
    }
}

impl Stencil<4> {
    pub(crate) fn central(step: f64) -> Stencil<4> {
        Stencil::around(0.0, step)
    }

    /// Neighbours of a value at about one and two steps on either side. The offsets are those of the neighbours after rounding, since a
    /// step may be only a few units in the last place of the value.
    pub(crate) fn around(value: f64, step: f64) -> Stencil<4> {
        let step = step.max(8.0 * f64::EPSILON * value.abs());
        Stencil::new([-2.0, -1.0, 1.0, 2.0].map(|place| (value + place * step) - value))
    }
}
