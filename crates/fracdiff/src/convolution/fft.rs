//! Products of power series by the fast Fourier transform.

// A planner for any length and vector unit would be most of the compiled code of this crate.
use rustfft::algorithm::Radix4;
use rustfft::num_complex::Complex;
use rustfft::{Fft, FftDirection, Length};

/// The Fourier transform of a sequence.
pub(crate) type Spectrum = Vec<Complex<f64>>;

/// Transforms of one length.
pub(crate) struct Transform(Radix4<f64>);

impl Transform {
    /// Transforms of so many values, a power of two.
    pub fn new(length: usize) -> Transform {
        Transform(Radix4::new(length, FftDirection::Forward))
    }

    /// The spectrum of real values, padded with zeros.
    pub fn spectrum(&self, values: &[f64]) -> Spectrum {
        let mut buffer: Spectrum = values.iter().map(|&v| Complex::new(v, 0.0)).collect();
        buffer.resize(self.0.len(), Complex::new(0.0, 0.0));
        self.0.process(&mut buffer);
        buffer
    }

    /// The real values of a spectrum.
    pub fn values(&self, mut spectrum: Spectrum) -> Vec<f64> {
        // the inverse transform is the conjugate of the transform of the conjugate
        spectrum.iter_mut().for_each(|c| *c = c.conj());
        self.0.process(&mut spectrum);
        let scale = 1.0 / spectrum.len() as f64;
        spectrum.iter().map(|c| c.re * scale).collect()
    }
}

/// The first `count` coefficients of the product of two series.
pub(crate) fn product(a: &[f64], b: &[f64], count: usize) -> Vec<f64> {
    let (a, b) = (&a[..a.len().min(count)], &b[..b.len().min(count)]);
    if a.len().min(b.len()) <= 32 {
        let mut out = vec![0.0; count];
        for (i, x) in a.iter().enumerate() {
            for (out, y) in out[i..].iter_mut().zip(b) {
                *out += x * y;
            }
        }
        return out;
    }
    let transform = Transform::new((a.len() + b.len()).next_power_of_two());
    let spectrum = transform.spectrum(a).iter().zip(transform.spectrum(b)).map(|(x, y)| x * y).collect();
    let mut out = transform.values(spectrum);
    out.resize(count, 0.0);
    out
}

/// The first `count` coefficients of `1/a`, by Newton's iteration `r <- r (2 - a r)`; `a[0]` must not be 0.
pub(crate) fn reciprocal(a: &[f64], count: usize) -> Vec<f64> {
    let mut r = vec![1.0 / a[0]];
    while r.len() < count {
        let length = (2 * r.len()).min(count);
        let mut correction = product(a, &r, length);
        correction.iter_mut().for_each(|v| *v = -*v);
        correction[0] += 2.0;
        r = product(&r, &correction, length);
    }
    r
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reciprocal_of_a_series() {
        let a: Vec<f64> = (0..500).map(|k| 1.0 / (1.0 + k as f64)).collect();
        let one = product(&a, &reciprocal(&a, 500), 500);
        assert!((one[0] - 1.0).abs() < 1e-14);
        assert!(one[1..].iter().all(|v| v.abs() < 1e-13));
    }
}
