//! Gauss's rule for products of shapes.

/// Positive nodes and weights of Gauss's rule with ten points (Abramowitz and Stegun, table 25.4).
const GAUSS: [(f64, f64); 5] = [
    (0.148_874_338_981_631_22, 0.295_524_224_714_752_87),
    (0.433_395_394_129_247_2, 0.269_266_719_309_996_35),
    (0.679_409_568_299_024_4, 0.219_086_362_515_982_04),
    (0.865_063_366_688_984_5, 0.149_451_349_150_580_6),
    (0.973_906_528_517_171_7, 0.066_671_344_308_688_14),
];

/// Gauss's rule with ten points on `[0, length]`: exact for polynomials up to degree 19.
pub(crate) fn gauss(length: f64, f: impl Fn(f64) -> f64) -> f64 {
    let half = 0.5 * length;
    GAUSS.iter().map(|(node, weight)| half * weight * (f(half * (1.0 + node)) + f(half * (1.0 - node)))).sum()
}
