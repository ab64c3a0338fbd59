//! Remainder modes of a beam, of which any number of modes can be computed.

use super::{PointsMode, remainder_at_points, remainder_modes};
use crate::definition::{Beam, BeamSystem};
use crate::modes::Modes;
use crate::point_mode::PointMode;
use invalid_input::InvalidInput;

/// Number of modes to compute so that those beyond have little effect on the remainder of the first `kept`: twice as many, and
/// at least 64 more. Restitutions of chapter 3's beam with 64 to 240 modes and their remainder then change by less than 1e-6
/// (Euler-Bernoulli) and 1e-4 (Timoshenko), a tenth of the error of the remainder modes themselves.
pub fn enough_for_remainder(kept: usize) -> usize {
    kept.saturating_mul(2).max(kept.saturating_add(64)).min(100_000)
}

impl Beam {
    /// The `count` remainder modes (1 to 4) at `x_m` of all modes but the first `kept` (rigid-body modes included), so that
    /// `kept` modes and these few respond to a force at `x_m` nearly as all modes do; see [`remainder_modes`].
    ///
    /// Computes twice as many modes as `kept`, and at least 64 more. For many locations or many values of `kept`, use
    /// [`Modes::remainder`] with modes that are computed once.
    ///
    /// ```
    /// use beam_modes::{Beam, End, Segment};
    /// let segment = Segment { length_m: 1.0, flexural_rigidity_n_m2: 275.0, mass_per_length_kg_m: 1.0 };
    /// let beam = Beam { segments: vec![segment], ends: [End::Clamped, End::Free] };
    /// let remainder = beam.remainder(0.8, 40, 2)?;
    /// assert!(remainder.len() == 2 && remainder[0].omega_rad_s > beam.modes(40)?.omega_rad_s()[39]);
    /// # Ok::<(), beam_modes::InvalidInput>(())
    /// ```
    ///
    /// # Errors
    /// [`InvalidInput`] as for [`modes`](Self::modes), for a location outside the beam, and for a `count` other than 1 to 4.
    pub fn remainder(&self, x_m: f64, kept: usize, count: usize) -> Result<Vec<PointMode>, InvalidInput> {
        BeamSystem::from(self.clone()).remainder(x_m, kept, count)
    }

    /// Remainder modes common to several locations on the beam, at most one per location; see [`remainder_at_points`].
    ///
    /// # Errors
    /// [`InvalidInput`] as for [`modes`](Self::modes), and for a location outside the beam.
    pub fn remainder_at(&self, x_m: &[f64], kept: usize) -> Result<Vec<PointsMode>, InvalidInput> {
        BeamSystem::from(self.clone()).remainder_at(x_m, kept)
    }
}

impl BeamSystem {
    /// As [`Beam::remainder`]. The tail of a Timoshenko beam is a wave impedance rather than a spring: it decreases as the
    /// inverse of the number of modes, so that remainder modes improve the result more.
    ///
    /// # Errors
    /// [`InvalidInput`] as for [`modes`](Self::modes), for a location outside the beam, and for a `count` other than 1 to 4.
    pub fn remainder(&self, x_m: f64, kept: usize, count: usize) -> Result<Vec<PointMode>, InvalidInput> {
        let whole_m_n = self.static_compliance(x_m)?;
        self.modes(enough_for_remainder(kept))?.remainder(x_m, kept, count, whole_m_n)
    }

    /// As [`Beam::remainder_at`].
    ///
    /// # Errors
    /// [`InvalidInput`] as for [`modes`](Self::modes), and for a location outside the beam.
    pub fn remainder_at(&self, x_m: &[f64], kept: usize) -> Result<Vec<PointsMode>, InvalidInput> {
        let modes = self.modes(enough_for_remainder(kept))?;
        let shapes = x_m.iter().map(|&x| modes.shapes_at(x)).collect::<Result<Vec<_>, _>>()?;
        let omega = modes.omega_rad_s();
        let elastic = modes.rigid_body_count();
        let mut rest = Vec::with_capacity(x_m.len() * x_m.len());
        for (i, &x) in x_m.iter().enumerate() {
            for (j, &y) in x_m.iter().enumerate() {
                let known = (elastic..omega.len()).map(|k| shapes[i][k] * shapes[j][k] / omega[k].powi(2));
                rest.push(self.static_green(x, y)? - known.sum::<f64>());
            }
        }
        let seen = |k: usize| PointsMode { omega_rad_s: omega[k], shapes: shapes.iter().map(|s| s[k]).collect() };
        let tail: Vec<PointsMode> = (kept.max(elastic)..omega.len()).map(seen).collect();
        remainder_at_points(&tail, &rest)
    }
}

impl Modes {
    /// As [`Beam::remainder`], from modes already computed, preferably twice as many as `kept` ([`enough_for_remainder`]);
    /// `static_compliance_m_n` is that of the whole structure at `x_m`.
    ///
    /// # Errors
    /// [`InvalidInput`] for a location outside the structure, for a `count` other than 1 to 4, if there is no mode beyond
    /// `kept`, and for a compliance that is negative or not finite.
    pub fn remainder(
        &self,
        x_m: f64,
        kept: usize,
        count: usize,
        static_compliance_m_n: f64,
    ) -> Result<Vec<PointMode>, InvalidInput> {
        let all = self.seen_from(x_m)?;
        let elastic = &all[self.rigid_body_count()..];
        let tail = elastic.get(kept.saturating_sub(self.rigid_body_count())..).unwrap_or_default();
        if tail.is_empty() {
            return Err(InvalidInput::new("kept", kept, "less than the number of modes that were computed"));
        }
        if !(static_compliance_m_n >= 0.0 && static_compliance_m_n.is_finite()) {
            let allowed = "a finite number not less than 0";
            return Err(InvalidInput::new("static_compliance_m_n", static_compliance_m_n, allowed));
        }
        // The smallest terms first, so that the sum is as accurate as its last terms.
        let known: f64 = elastic.iter().rev().map(|mode| (mode.shape / mode.omega_rad_s).powi(2)).sum();
        remainder_modes(tail, (static_compliance_m_n - known).max(0.0), count)
    }
}
