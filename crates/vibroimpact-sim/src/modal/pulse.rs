//! The force of one contact as it is computed, and its integrals over time.

use crate::assembly::wave::{centred_mean, spherical_bessel};
use crate::panel::legendre::{Legendre, Nodal};
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
        let mut sum = Complex64::ZERO;
        // most panels follow one of the same length
        let follows =
            |one: &Panel, next: &Panel| next.length_s == one.length_s && next.start_s == one.start_s + one.length_s;
        for run in self.panels.chunk_by(follows) {
            let [first, ..] = run else { continue };
            let bessel = spherical_bessel(0.5 * omega_rad_s * first.length_s);
            let middle_s = first.start_s - self.from_s + 0.5 * first.length_s;
            let mut wave = first.length_s * Complex64::cis(omega_rad_s * middle_s);
            let further = if run.len() > 1 { Complex64::cis(omega_rad_s * first.length_s) } else { Complex64::ONE };
            for panel in run {
                sum += wave * centred_mean(&bessel, &panel.force);
                wave *= further;
            }
        }
        [sum.re, sum.im]
    }

    /// The same at `count` frequencies, the multiples of one step from zero on (rad/s), at a fraction of the cost of single ones:
    /// the waves at the next frequency are those at the one before, turned further.
    pub fn transforms_n_s(&self, step_rad_s: f64, count: usize) -> Vec<[f64; 2]> {
        let mut sums = vec![Complex64::ZERO; count];
        let mut last: Option<(f64, Vec<Nodal>)> = None;
        for panel in &self.panels {
            let length_s = panel.length_s;
            let bessels = match last.take() {
                Some((known_s, bessels)) if known_s == length_s => bessels,
                _ => (0..count).map(|i| spherical_bessel(0.5 * step_rad_s * i as f64 * length_s)).collect(),
            };
            let further = Complex64::cis(step_rad_s * (panel.start_s - self.from_s + 0.5 * length_s));
            let mut wave = Complex64::new(length_s, 0.0);
            for (sum, bessel) in sums.iter_mut().zip(&bessels) {
                *sum += wave * centred_mean(bessel, &panel.force);
                wave *= further;
            }
            last = Some((length_s, bessels));
        }
        sums.into_iter().map(|sum| [sum.re, sum.im]).collect()
    }

    /// `int F^2 dt` (N^2 s).
    pub fn square_n2_s(&self) -> f64 {
        // int_0^1 P_n(2s-1)^2 ds = 1/(2n+1)
        let square =
            |Legendre(force): &Legendre| force.iter().enumerate().map(|(n, f)| f * f / (2 * n + 1) as f64).sum::<f64>();
        self.panels.iter().map(|panel| panel.length_s * square(&panel.force)).sum()
    }
}
