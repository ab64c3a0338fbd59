//! Synthetic restitutions of a pinned-pinned uniform beam of 1 kg, and the residuals of the EMOC law.

use emoc::{Impact, Parameters, Site};

/// One impact.
pub struct Datum {
    /// Number of the location on the beam.
    #[allow(dead_code)]
    pub place: usize,
    /// Mass and location in the form that the law uses.
    pub impact: Impact,
    /// The restitution.
    pub restitution: f64,
}

/// 12 masses at 25 locations, 50 modes; the error is `noise` times a fixed sequence within -1..1.
pub fn impacts([mu0, alpha0, alpha1]: [f64; 3], noise: f64) -> Vec<Datum> {
    let law = Parameters { mu0, alpha0, alpha1, notional_restitution: 1.0 };
    let mut data = Vec::new();
    for place in 0..25 {
        let b = (place as f64 + 1.0) / 26.0;
        let phi: Vec<f64> =
            (1..=50).map(|k| 2.0_f64.sqrt() * (std::f64::consts::PI * f64::from(k) * b).sin()).collect();
        let Ok(site) = Site::new(&phi) else { continue };
        for step in 0..12 {
            let mass = 0.005 * 1.8_f64.powi(step);
            let Ok(impact) = Impact::new(mass, &site) else { continue };
            let Ok(rebound) = law.rebound(&impact) else { continue };
            // A golden-ratio sequence is evenly distributed and the same everywhere.
            let error = noise * (2.0 * (data.len() as f64 * 0.618_033_988_749_894_9).fract() - 1.0);
            data.push(Datum { place, impact, restitution: rebound.restitution + error });
        }
    }
    data
}

/// Model minus data.
pub fn residuals(data: &[Datum], p: &[f64], r: &mut [f64]) {
    let law = Parameters { mu0: p[0], alpha0: p[1], alpha1: p[2], notional_restitution: 1.0 };
    for (r, datum) in r.iter_mut().zip(data) {
        *r = law.rebound(&datum.impact).map_or(f64::NAN, |rebound| rebound.restitution - datum.restitution);
    }
}

/// Derivatives with respect to the three parameters.
pub fn jacobian(data: &[Datum], p: &[f64], rows: &mut [f64]) {
    let law = Parameters { mu0: p[0], alpha0: p[1], alpha1: p[2], notional_restitution: 1.0 };
    for (row, datum) in rows.chunks_exact_mut(3).zip(data) {
        if let Ok((_, gradient)) = law.rebound_with_gradient(&datum.impact) {
            row.copy_from_slice(&[gradient.per_mu0, gradient.per_alpha0, gradient.per_alpha1]);
        }
    }
}
