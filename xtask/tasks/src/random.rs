//! Random numbers that are the same on every machine.

use std::f64::consts::TAU;

/// SplitMix64 (Steele, Lea and Flood 2014).
#[derive(Debug, Clone)]
pub struct Random(u64);

impl Random {
    /// The sequence that begins from this state.
    pub fn new(state: u64) -> Random {
        Random(state)
    }

    /// Uniform from 0 to 1.
    pub fn share(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Uniform between two numbers.
    pub fn range(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.share()
    }

    /// Log-uniform between two numbers.
    pub fn log(&mut self, low: f64, high: f64) -> f64 {
        low * (high / low).powf(self.share())
    }

    /// Standard normal, by the method of Box and Muller.
    pub fn normal(&mut self) -> f64 {
        let (a, b) = (1.0 - self.share(), self.share());
        (-2.0 * a.ln()).sqrt() * (TAU * b).cos()
    }

    /// One of a list, all of them equally often.
    pub fn of<T: Copy>(&mut self, list: &[T]) -> T {
        list[((self.share() * list.len() as f64) as usize).min(list.len() - 1)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The first outputs for the state 1234567, by the authors' program in C.
    #[test]
    fn the_sequence_is_that_of_splitmix64() {
        let mut random = Random::new(1_234_567);
        for output in [6_457_827_717_110_365_317_u64, 3_203_168_211_198_807_973, 9_817_491_932_198_370_423] {
            assert_eq!(random.share(), (output >> 11) as f64 / (1u64 << 53) as f64);
        }
    }

    #[test]
    fn draws_have_their_means() {
        let mut random = Random::new(1);
        let mut mean = |draw: fn(&mut Random) -> f64| (0..10_000).map(|_| draw(&mut random)).sum::<f64>() / 1e4;
        assert!((mean(|random| random.range(2.0, 4.0)) - 3.0).abs() < 0.03);
        assert!((mean(|random| random.log(1e-2, 1e2).ln())).abs() < 0.15);
        assert!(mean(Random::normal).abs() < 0.05 && (mean(|random| random.normal().powi(2)) - 1.0).abs() < 0.07);
        assert!((mean(|random| random.of(&[1.0, 2.0])) - 1.5).abs() < 0.03);
    }
}
