//! Points that cover a box evenly, and seeded random numbers.

/// SplitMix64 (Steele, Lea and Flood 2014), implemented here so that a seed always gives the same numbers.
pub(crate) struct Random(u64);

impl Random {
    pub(crate) fn new(seed: u64) -> Random {
        Random(seed)
    }

    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// An index below `n`; all are equally likely up to `n / 2^64`. `n` is at least 1.
    pub(crate) fn below(&mut self, n: usize) -> usize {
        ((u128::from(self.bits()) * n as u128) >> 64) as usize
    }

    /// A standard normal deviate by the method of Box and Muller.
    pub(crate) fn normal(&mut self) -> f64 {
        // from 0 up to, but without, 1
        let mut share = || (self.bits() >> 11) as f64 / (1u64 << 53) as f64;
        let (radius, angle) = ((-2.0 * (1.0 - share()).ln()).sqrt(), std::f64::consts::TAU * share());
        radius * angle.cos()
    }

    /// A shuffle by the method of Fisher and Yates.
    pub(crate) fn shuffle<T>(&mut self, items: &mut [T]) {
        for i in (1..items.len()).rev() {
            items.swap(i, self.below(i + 1));
        }
    }
}

/// Coordinate number `dimension` of point number `index` of Halton's sequence: the digits of `index` in the
/// `dimension`-th prime, mirrored at the point. In (0, 1) for `index > 0`.
pub(crate) fn halton(index: usize, dimension: usize) -> f64 {
    let base = prime(dimension);
    let (mut rest, mut value, mut place) = (index, 0.0, 1.0);
    while rest > 0 {
        place /= base as f64;
        value += place * (rest % base) as f64;
        rest /= base;
    }
    value
}

fn prime(place: usize) -> usize {
    let is_prime = |n: &usize| (2..).take_while(|d| d * d <= *n).all(|d| !n.is_multiple_of(d));
    (2..).filter(is_prime).nth(place).unwrap_or(2)
}
