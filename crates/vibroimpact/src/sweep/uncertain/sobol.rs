//! Sobol' points with nested uniform (Owen) scrambling.
//!
//! Bit `l` of coordinate `j` of point `i`, counted from the highest, is
//!
//! ```text
//! x_l = sum_b i_b v_(j,b,l) mod 2                                           (1)
//! u_l = x_l + pi_(j, x_1 .. x_(l-1)) mod 2                                  (2)
//! ```
//!
//! with the direction numbers `v` of Joe and Kuo (2008) and an independent random bit `pi` for every coordinate and every
//! prefix. Each point is uniform by itself, and `2^k` points remain a net for any `k`, so that the error of a mean decreases
//! faster than `n^-1/2`. Independent scramblings give independent errors, whose size follows from their scatter (Owen 1995). The
//! random bits are hashes of key, coordinate and prefix, so that any point can be computed directly. Existing crates with the
//! sequence have 24 bits and 65,536 points for each scrambling, or do not scramble.

/// Largest number of coordinates.
pub(super) const MOST_COORDINATES: usize = 32;
/// Bits of a point's number, and of equation (1).
const BITS: u32 = 32;
/// Bits of a coordinate: all below the prefix's length are random.
const DIGITS: u32 = 52;

/// For every coordinate except the first, the inner coefficients of its primitive polynomial as bits, and the first odd numbers
/// `m`, whose number is its degree.
const POLYNOMIALS: [(u32, &[u32]); MOST_COORDINATES - 1] = [
    (0, &[1]),
    (1, &[1, 3]),
    (1, &[1, 3, 1]),
    (2, &[1, 1, 1]),
    (1, &[1, 1, 3, 3]),
    (4, &[1, 3, 5, 13]),
    (2, &[1, 1, 5, 5, 17]),
    (4, &[1, 1, 5, 5, 5]),
    (7, &[1, 1, 7, 11, 19]),
    (11, &[1, 1, 5, 1, 1]),
    (13, &[1, 1, 1, 3, 11]),
    (14, &[1, 3, 5, 5, 31]),
    (1, &[1, 3, 3, 9, 7, 49]),
    (13, &[1, 1, 1, 15, 21, 21]),
    (16, &[1, 3, 1, 13, 27, 49]),
    (19, &[1, 1, 1, 15, 7, 5]),
    (22, &[1, 3, 1, 15, 13, 25]),
    (25, &[1, 1, 5, 5, 19, 61]),
    (1, &[1, 3, 7, 11, 23, 15, 103]),
    (4, &[1, 3, 7, 13, 13, 15, 69]),
    (7, &[1, 1, 3, 13, 7, 35, 63]),
    (8, &[1, 3, 5, 9, 1, 25, 53]),
    (14, &[1, 3, 1, 13, 9, 35, 107]),
    (19, &[1, 3, 1, 5, 27, 61, 31]),
    (21, &[1, 1, 5, 11, 19, 41, 61]),
    (28, &[1, 3, 5, 3, 3, 13, 69]),
    (31, &[1, 1, 7, 13, 1, 19, 1]),
    (32, &[1, 3, 7, 5, 13, 19, 59]),
    (37, &[1, 1, 3, 9, 25, 29, 41]),
    (41, &[1, 3, 5, 13, 23, 1, 55]),
    (42, &[1, 3, 7, 3, 13, 59, 17]),
];

/// The sequence in some coordinates.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Sobol {
    /// `v` of every coordinate, highest bit first.
    directions: Vec<[u32; BITS as usize]>,
}

impl Sobol {
    /// The sequence in this number of coordinates, at most [`MOST_COORDINATES`].
    pub(super) fn new(coordinates: usize) -> Sobol {
        let first = std::array::from_fn(|bit| 1 << (BITS - 1 - bit as u32));
        let others = POLYNOMIALS.iter().map(|(inner, start)| directions(*inner, start));
        Sobol { directions: std::iter::once(first).chain(others).take(coordinates).collect() }
    }

    /// A coordinate of a point, strictly between 0 and 1, in the scrambling of this key.
    pub(super) fn at(&self, point: u32, coordinate: usize, key: u64) -> f64 {
        let bits = self.directions[coordinate].iter().enumerate();
        let plain = bits.filter(|(bit, _)| point >> bit & 1 == 1).fold(0, |sum, (_, direction)| sum ^ direction);
        let key = mixed(key, coordinate as u64);
        let flipped = |length: u32| {
            // the prefix with a leading one, which encodes its length
            let prefix = (1u64 << length) | (u64::from(plain) >> (BITS - length));
            mixed(key, prefix)
        };
        let scrambled = (0..BITS)
            .fold(0u64, |sum, length| sum << 1 | (u64::from(plain >> (BITS - 1 - length) & 1) ^ flipped(length) >> 63));
        let below = flipped(BITS) >> (64 - (DIGITS - BITS));
        unit(scrambled << (DIGITS - BITS) | below)
    }
}

/// A number strictly between 0 and 1 from its first 52 bits: the middle of the interval that they define.
pub(super) fn unit(digits: u64) -> f64 {
    (digits as f64 + 0.5) * (-f64::from(DIGITS)).exp2()
}

/// `v_b = m_b 2^(32-b)`, continued by the recurrence of the polynomial.
fn directions(inner: u32, start: &[u32]) -> [u32; BITS as usize] {
    let degree = start.len();
    let mut v = [0u32; BITS as usize];
    for bit in 0..BITS as usize {
        v[bit] = match start.get(bit) {
            Some(m) => m << (BITS - 1 - bit as u32),
            None => {
                let last = v[bit - degree] ^ (v[bit - degree] >> degree);
                let terms = (1..degree).filter(|k| inner >> (degree - 1 - k) & 1 == 1);
                terms.fold(last, |sum, k| sum ^ v[bit - k])
            }
        };
    }
    v
}

/// Mixes a number into a key, so that every bit of either reaches every bit of the result (the finaliser of SplitMix64, Steele,
/// Lea and Flood 2014).
pub(super) fn mixed(key: u64, number: u64) -> u64 {
    let mut z = key ^ number.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    for (shift, factor) in [(30, 0xbf58_476d_1ce4_e5b9), (27, 0x94d0_49bb_1331_11eb)] {
        z = (z ^ z >> shift).wrapping_mul(factor);
    }
    z ^ z >> 31
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Fifteen points a coordinate from a reference implementation (SciPy 1.17, unscrambled, in the order of the numbers
    /// themselves), as multiples of 1/16.
    #[test]
    fn unscrambled_points_are_those_of_joe_and_kuo() {
        const REFERENCE: [(usize, [u32; 16]); 5] = [
            (0, [0, 8, 4, 12, 2, 10, 6, 14, 1, 9, 5, 13, 3, 11, 7, 15]),
            (1, [0, 8, 12, 4, 10, 2, 6, 14, 15, 7, 3, 11, 5, 13, 9, 1]),
            (2, [0, 8, 12, 4, 6, 14, 10, 2, 9, 1, 5, 13, 15, 7, 3, 11]),
            (9, [0, 8, 4, 12, 14, 6, 10, 2, 11, 3, 15, 7, 5, 13, 1, 9]),
            (31, [0, 8, 12, 4, 14, 6, 2, 10, 3, 11, 15, 7, 13, 5, 1, 9]),
        ];
        let sobol = Sobol::new(MOST_COORDINATES);
        for (coordinate, points) in REFERENCE {
            for (point, expected) in points.into_iter().enumerate() {
                let bits = (0..BITS as usize).filter(|bit| point >> bit & 1 == 1);
                let plain = bits.fold(0, |sum, bit| sum ^ sobol.directions[coordinate][bit]);
                assert_eq!(plain >> 28, expected, "point {point} of coordinate {coordinate}");
            }
        }
    }

    /// Every elementary interval of two coordinates of a net holds as many of its points as its share.
    #[test]
    fn scrambled_points_stay_a_net() {
        let sobol = Sobol::new(MOST_COORDINATES);
        for key in 0..20 {
            // one coordinate: a point in each of 1024 intervals
            for coordinate in 0..MOST_COORDINATES {
                let mut hit = [false; 1024];
                (0..1024).for_each(|i| hit[(1024.0 * sobol.at(i, coordinate, key)) as usize] = true);
                assert!(hit.iter().all(|hit| *hit), "coordinate {coordinate}");
            }
            // the first two are a net of quality 0
            for power in 0..=6 {
                let (wide, high) = (1usize << power, 64usize >> power);
                let mut hit = [false; 64];
                for i in 64..128 {
                    let cell = [(0, wide), (1, high)].map(|(j, n)| (n as f64 * sobol.at(i, j, key)) as usize);
                    hit[cell[0] * high + cell[1]] = true;
                }
                assert!(hit.iter().all(|hit| *hit));
            }
        }
    }

    #[test]
    fn points_of_many_scramblings_are_uniform_and_independent() {
        let sobol = Sobol::new(2);
        let count = 40_000;
        let of = |i: u32, j: usize, key: u64| sobol.at(i, j, mixed(7, key)) - 0.5;
        let mean = |f: &dyn Fn(u64) -> f64| (0..count).map(f).sum::<f64>() / count as f64;
        // five standard deviations of each mean
        for i in [0, 1, 77] {
            assert!(mean(&|key| of(i, 0, key)).abs() < 5.0 * (1.0 / 12.0 / count as f64).sqrt());
            assert!(
                (mean(&|key| of(i, 1, key).powi(2)) - 1.0 / 12.0).abs() < 5.0 * (1.0 / 180.0 / count as f64).sqrt()
            );
            assert!(mean(&|key| of(i, 0, key) * of(i, 1, key)).abs() < 5.0 / 12.0 / (count as f64).sqrt());
        }
    }
}
