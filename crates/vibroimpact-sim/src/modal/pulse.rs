//! The force of one contact as it is computed, and its integrals over time.

use crate::assembly::wave::{turned, turned_means};
use crate::panel::legendre::{Nodal, Q};
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
    /// Legendre coefficients (N).
    pub force: Nodal,
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
        let mut last: Option<(f64, [Complex64; Q])> = None;
        for panel in &self.panels {
            let length_s = panel.length_s;
            // most panels are as long as the one before
            let means = match last {
                Some((known_s, means)) if known_s == length_s => means,
                _ => turned_means(omega_rad_s * length_s),
            };
            last = Some((length_s, means));
            let turn = Complex64::cis(omega_rad_s * (panel.start_s - self.from_s));
            sum += length_s * turn * turned(&means, &panel.force);
        }
        [sum.re, sum.im]
    }

    /// `int F^2 dt` (N^2 s).
    pub fn square_n2_s(&self) -> f64 {
        // int_0^1 P_n(2s-1)^2 ds = 1/(2n+1)
        let square = |force: &Nodal| force.iter().enumerate().map(|(n, f)| f * f / (2 * n + 1) as f64).sum::<f64>();
        self.panels.iter().map(|panel| panel.length_s * square(&panel.force)).sum()
    }
}
