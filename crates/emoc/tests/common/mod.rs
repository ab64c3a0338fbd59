//! Numbers for random cases, the same on every machine.

pub mod enumeration;

use emoc::Coefficients;

/// SplitMix64 (Steele, Lea and Flood 2014).
pub struct Random(pub u64);

impl Random {
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Uniform in `low..high`.
    pub fn range(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Uniform in the logarithm.
    pub fn log_range(&mut self, low: f64, high: f64) -> f64 {
        self.range(low.ln(), high.ln()).exp()
    }

    pub fn below(&mut self, n: usize) -> usize {
        (self.bits() % n as u64) as usize
    }

    /// Coefficients anywhere in their ranges, the ends included one time in five.
    pub fn coefficients(&mut self) -> Coefficients<f64> {
        let end = |random: &mut Random| match random.below(10) {
            0 => 0.0,
            1 => 1.0,
            _ => random.range(0.0, 1.0),
        };
        let beta0 = match self.below(10) {
            0 => 0.0,
            1 => self.range(1.0, 30.0),
            _ => self.range(0.0, 1.0),
        };
        Coefficients { ebar: end(self), beta0, beta1: end(self) }
    }
}
