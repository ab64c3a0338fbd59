//! The force of one contact as it is computed, and its integrals over time.

use crate::assembly::wave::{centred_mean, spherical_bessels};
use crate::panel::lanes::{ComplexLanes, Lanes};
use crate::panel::legendre::{Legendre, Q};
use crate::panel::vector::{LANES, vectorized};
use num_complex::Complex64;

/// The contact force from one time to another: a polynomial on each panel.
#[derive(Debug, Clone, PartialEq)]
pub struct Pulse {
    pub(super) from_s: f64,
    pub(super) panels: Vec<Panel>,
}

/// The force on one panel.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Panel {
    pub start_s: f64,
    pub length_s: f64,
    /// The force (N).
    pub force: Legendre,
}

impl Pulse {
    /// The Fourier transform `int F e^{i omega (t - t0)} dt`, with `t0` the time from which the force is taken: real and imaginary
    /// part (N s), in closed form.
    ///
    /// ```
    /// use contact_models::LinearSpring;
    /// use vibroimpact_sim::modal::{Settings, Solver, Striker, Structure};
    ///
    /// // half a sine of the circular frequency 1000 rad/s: 1 kg meets an immovable spring of 1e6 N/m at 1 m/s
    /// let wall = Solver::new(&Structure::default())?;
    /// let ball = Striker { mass_kg: 1.0, speed_m_s: 1.0 };
    /// let (_, history) = wall.record(&ball, &LinearSpring::new(1e6).unwrap(), None, &Settings::default())?;
    /// let [re, im] = history.pulse(0.0, history.duration_s()).transform_n_s(2000.0);
    /// // 1000 N times (1 + e^{2 pi i}) 1000/(1000^2 - 2000^2)
    /// assert!((re + 2.0 / 3.0).abs() < 1e-7 && im.abs() < 1e-7);
    /// # Ok::<(), vibroimpact_sim::InvalidInput>(())
    /// ```
    pub fn transform_n_s(&self, omega_rad_s: f64) -> [f64; 2] {
        self.transforms_n_s(&[omega_rad_s])[0]
    }

    /// The same at some frequencies (rad/s), at a fraction of the cost of single ones.
    pub fn transforms_n_s(&self, omegas_rad_s: &[f64]) -> Vec<[f64; 2]> {
        let mut transforms = Vec::with_capacity(omegas_rad_s.len());
        vectorized(
            #[inline(always)]
            || {
                for some in omegas_rad_s.chunks(LANES) {
                    // the last ones are padded by the first of them
                    let found = self.transforms(Lanes::of(|l| *some.get(l).unwrap_or(&some[0])));
                    transforms.extend((0..some.len()).map(|l| [found.re.0[l], found.im.0[l]]));
                }
            },
        );
        transforms
    }

    #[inline(always)]
    fn transforms(&self, omegas: Lanes) -> ComplexLanes {
        let waves = |after_s: f64| ComplexLanes::of(|l| Complex64::cis(omegas.0[l] * after_s));
        let mut sum = ComplexLanes::ZERO;
        // the wave at this time
        let (mut time_s, mut wave) = (self.from_s, ComplexLanes { re: Lanes::ONE, im: Lanes::ZERO });
        // half a panel of this length turns it so far; most panels follow one of the same length
        let (mut length_s, mut half, mut bessels) = (0.0, wave, [Lanes::ZERO; Q]);
        for panel in &self.panels {
            if panel.start_s != time_s {
                wave = waves(panel.start_s - self.from_s);
            }
            if panel.length_s != length_s {
                length_s = panel.length_s;
                half = waves(0.5 * length_s);
                bessels = spherical_bessels(omegas * (0.5 * length_s), half);
            }
            let middle = wave * half;
            let [re, im] = centred_mean(&bessels, &panel.force);
            sum = sum + middle * ComplexLanes { re, im } * length_s;
            (time_s, wave) = (panel.start_s + length_s, middle * half);
        }
        sum
    }

    /// `int F^2 dt` (N^2 s).
    pub fn square_n2_s(&self) -> f64 {
        // int_0^1 P_n(2s-1)^2 ds = 1/(2n+1)
        let square =
            |Legendre(force): &Legendre| force.iter().enumerate().map(|(n, f)| f * f / (2 * n + 1) as f64).sum::<f64>();
        self.panels.iter().map(|panel| panel.length_s * square(&panel.force)).sum()
    }
}
