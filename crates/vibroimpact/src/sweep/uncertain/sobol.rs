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
pub(super) const MOST_COORDINATES: usize = 128;
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
    (50, &[1, 3, 1, 3, 5, 53, 69]),
    (55, &[1, 1, 5, 5, 23, 33, 13]),
    (56, &[1, 1, 7, 7, 1, 61, 123]),
    (59, &[1, 1, 7, 9, 13, 61, 49]),
    (62, &[1, 3, 3, 5, 3, 55, 33]),
    (14, &[1, 3, 1, 15, 31, 13, 49, 245]),
    (21, &[1, 3, 5, 15, 31, 59, 63, 97]),
    (22, &[1, 3, 1, 11, 11, 11, 77, 249]),
    (38, &[1, 3, 1, 11, 27, 43, 71, 9]),
    (47, &[1, 1, 7, 15, 21, 11, 81, 45]),
    (49, &[1, 3, 7, 3, 25, 31, 65, 79]),
    (50, &[1, 3, 1, 1, 19, 11, 3, 205]),
    (52, &[1, 1, 5, 9, 19, 21, 29, 157]),
    (56, &[1, 3, 7, 11, 1, 33, 89, 185]),
    (67, &[1, 3, 3, 3, 15, 9, 79, 71]),
    (70, &[1, 3, 7, 11, 15, 39, 119, 27]),
    (84, &[1, 1, 3, 1, 11, 31, 97, 225]),
    (97, &[1, 1, 1, 3, 23, 43, 57, 177]),
    (103, &[1, 3, 7, 7, 17, 17, 37, 71]),
    (115, &[1, 3, 1, 5, 27, 63, 123, 213]),
    (122, &[1, 1, 3, 5, 11, 43, 53, 133]),
    (8, &[1, 3, 5, 5, 29, 17, 47, 173, 479]),
    (13, &[1, 3, 3, 11, 3, 1, 109, 9, 69]),
    (16, &[1, 1, 1, 5, 17, 39, 23, 5, 343]),
    (22, &[1, 3, 1, 5, 25, 15, 31, 103, 499]),
    (25, &[1, 1, 1, 11, 11, 17, 63, 105, 183]),
    (44, &[1, 1, 5, 11, 9, 29, 97, 231, 363]),
    (47, &[1, 1, 5, 15, 19, 45, 41, 7, 383]),
    (52, &[1, 3, 7, 7, 31, 19, 83, 137, 221]),
    (55, &[1, 1, 1, 3, 23, 15, 111, 223, 83]),
    (59, &[1, 1, 5, 13, 31, 15, 55, 25, 161]),
    (62, &[1, 1, 3, 13, 25, 47, 39, 87, 257]),
    (67, &[1, 1, 1, 11, 21, 53, 125, 249, 293]),
    (74, &[1, 1, 7, 11, 11, 7, 57, 79, 323]),
    (81, &[1, 1, 5, 5, 17, 13, 81, 3, 131]),
    (82, &[1, 1, 7, 13, 23, 7, 65, 251, 475]),
    (87, &[1, 3, 5, 1, 9, 43, 3, 149, 11]),
    (91, &[1, 1, 3, 13, 31, 13, 13, 255, 487]),
    (94, &[1, 3, 3, 1, 5, 63, 89, 91, 127]),
    (103, &[1, 1, 3, 3, 1, 19, 123, 127, 237]),
    (104, &[1, 1, 5, 7, 23, 31, 37, 243, 289]),
    (109, &[1, 1, 5, 11, 17, 53, 117, 183, 491]),
    (122, &[1, 1, 1, 5, 1, 13, 13, 209, 345]),
    (124, &[1, 1, 3, 15, 1, 57, 115, 7, 33]),
    (137, &[1, 3, 1, 11, 7, 43, 81, 207, 175]),
    (138, &[1, 3, 1, 1, 15, 27, 63, 255, 49]),
    (143, &[1, 3, 5, 3, 27, 61, 105, 171, 305]),
    (145, &[1, 1, 5, 3, 1, 3, 57, 249, 149]),
    (152, &[1, 1, 3, 5, 5, 57, 15, 13, 159]),
    (157, &[1, 1, 1, 11, 7, 11, 105, 141, 225]),
    (167, &[1, 3, 3, 5, 27, 59, 121, 101, 271]),
    (173, &[1, 3, 5, 9, 11, 49, 51, 59, 115]),
    (176, &[1, 1, 7, 1, 23, 45, 125, 71, 419]),
    (181, &[1, 1, 3, 5, 23, 5, 105, 109, 75]),
    (182, &[1, 1, 7, 15, 7, 11, 67, 121, 453]),
    (185, &[1, 3, 7, 3, 9, 13, 31, 27, 449]),
    (191, &[1, 3, 1, 15, 19, 39, 39, 89, 15]),
    (194, &[1, 1, 1, 1, 1, 33, 73, 145, 379]),
    (199, &[1, 3, 1, 15, 15, 43, 29, 13, 483]),
    (218, &[1, 1, 7, 3, 19, 27, 85, 131, 431]),
    (220, &[1, 3, 3, 3, 5, 35, 23, 195, 349]),
    (227, &[1, 3, 3, 7, 9, 27, 39, 59, 297]),
    (229, &[1, 1, 3, 9, 11, 17, 13, 241, 157]),
    (230, &[1, 3, 7, 15, 25, 57, 33, 189, 213]),
    (234, &[1, 1, 7, 1, 9, 55, 73, 83, 217]),
    (236, &[1, 3, 3, 13, 19, 27, 23, 113, 249]),
    (241, &[1, 3, 5, 3, 23, 43, 3, 253, 479]),
    (244, &[1, 1, 5, 5, 11, 5, 45, 117, 217]),
    (253, &[1, 3, 3, 7, 29, 37, 33, 123, 147]),
    (4, &[1, 3, 1, 15, 5, 5, 37, 227, 223, 459]),
    (13, &[1, 1, 7, 5, 5, 39, 63, 255, 135, 487]),
    (19, &[1, 3, 1, 7, 9, 7, 87, 249, 217, 599]),
    (22, &[1, 1, 3, 13, 9, 47, 7, 225, 363, 247]),
    (50, &[1, 3, 7, 13, 19, 13, 9, 67, 9, 737]),
    (55, &[1, 3, 5, 5, 19, 59, 7, 41, 319, 677]),
    (64, &[1, 1, 5, 3, 31, 63, 15, 43, 207, 789]),
    (69, &[1, 1, 7, 9, 13, 39, 3, 47, 497, 169]),
    (98, &[1, 3, 1, 7, 21, 17, 97, 19, 415, 905]),
    (107, &[1, 3, 7, 1, 3, 31, 71, 111, 165, 127]),
    (115, &[1, 1, 5, 11, 1, 61, 83, 119, 203, 847]),
    (121, &[1, 3, 3, 13, 9, 61, 19, 97, 47, 35]),
    (127, &[1, 1, 7, 7, 15, 29, 63, 95, 417, 469]),
    (134, &[1, 3, 1, 9, 25, 9, 71, 57, 213, 385]),
    (140, &[1, 3, 5, 13, 31, 47, 101, 57, 39, 341]),
    (145, &[1, 1, 3, 3, 31, 57, 125, 173, 365, 551]),
    (152, &[1, 3, 7, 1, 13, 57, 67, 157, 451, 707]),
    (158, &[1, 1, 1, 7, 21, 13, 105, 89, 429, 965]),
    (161, &[1, 1, 5, 9, 17, 51, 45, 119, 157, 141]),
    (171, &[1, 3, 7, 7, 13, 45, 91, 9, 129, 741]),
    (181, &[1, 3, 7, 1, 23, 57, 67, 141, 151, 571]),
    (194, &[1, 1, 3, 11, 17, 47, 93, 107, 375, 157]),
    (199, &[1, 3, 3, 5, 11, 21, 43, 51, 169, 915]),
    (203, &[1, 1, 5, 3, 15, 55, 101, 67, 455, 625]),
    (208, &[1, 3, 5, 9, 1, 23, 29, 47, 345, 595]),
    (227, &[1, 3, 7, 7, 5, 49, 29, 155, 323, 589]),
    (242, &[1, 3, 3, 7, 5, 41, 127, 61, 261, 717]),
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
        const REFERENCE: [(usize, [u32; 16]); 7] = [
            (0, [0, 8, 4, 12, 2, 10, 6, 14, 1, 9, 5, 13, 3, 11, 7, 15]),
            (1, [0, 8, 12, 4, 10, 2, 6, 14, 15, 7, 3, 11, 5, 13, 9, 1]),
            (2, [0, 8, 12, 4, 6, 14, 10, 2, 9, 1, 5, 13, 15, 7, 3, 11]),
            (9, [0, 8, 4, 12, 14, 6, 10, 2, 11, 3, 15, 7, 5, 13, 1, 9]),
            (31, [0, 8, 12, 4, 14, 6, 2, 10, 3, 11, 15, 7, 13, 5, 1, 9]),
            (64, [0, 8, 4, 12, 2, 10, 6, 14, 11, 3, 15, 7, 9, 1, 13, 5]),
            (127, [0, 8, 12, 4, 6, 14, 10, 2, 7, 15, 11, 3, 1, 9, 13, 5]),
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
