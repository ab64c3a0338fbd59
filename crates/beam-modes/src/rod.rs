//! Rods in axial vibration.

use crate::axial::{Axial, RodEnd};
use crate::location::require_on;
use crate::modes::{Modes, held_ends, require_count};
use crate::piece::Piece;
use crate::quadrature::gauss;
use crate::roots::elastic_roots;
use crate::shapes::shapes;
use crate::span::{Span, Units, nondimensional};
use invalid_input::InvalidInput;
use std::f64::consts::PI;

/// A uniform segment of a rod.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct RodSegment {
    /// Length, m.
    pub length_m: f64,
    /// Axial rigidity `E A`, N.
    pub axial_rigidity_n: f64,
    /// Mass per unit length `rho A`, kg/m.
    pub mass_per_length_kg_m: f64,
}

/// A rod of uniform segments in axial vibration, joined end to end from `x = 0` on.
///
/// ```
/// use beam_modes::{Rod, RodEnd, RodSegment};
/// let steel = RodSegment { length_m: 1.0, axial_rigidity_n: 8e7, mass_per_length_kg_m: 3.12 };
/// let rod = Rod { segments: vec![steel], ends: [RodEnd::Free, RodEnd::Free] };
/// let modes = rod.modes(2)?;
/// assert_eq!(modes.omega_rad_s()[0], 0.0);
/// let wave_speed = (8e7f64 / 3.12).sqrt();
/// assert!((modes.omega_rad_s()[1] / (std::f64::consts::PI * wave_speed) - 1.0).abs() < 1e-14);
/// # Ok::<(), beam_modes::InvalidInput>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Rod {
    /// Segments from left to right.
    pub segments: Vec<RodSegment>,
    /// The left and the right end.
    pub ends: [RodEnd; 2],
}

impl Rod {
    /// The first `count` axial modes; in a free-free rod the first is the rigid translation, with `omega = 0`.
    ///
    /// # Errors
    /// [`InvalidInput`] as for [`Beam::modes`](crate::Beam::modes).
    pub fn modes(&self, count: usize) -> Result<Modes, InvalidInput> {
        let (spans, units) = self.checked()?;
        require_count(count, spans.len())?;
        let rigid_count = usize::from(self.ends == [RodEnd::Free, RodEnd::Free]);
        let elastic = count.saturating_sub(rigid_count);

        let chain = Axial::new(spans.clone(), self.ends);
        let roots = if spans.len() == 1 {
            let shift = if self.ends[0] == self.ends[1] { 0.0 } else { 0.5 };
            (1..=elastic).map(|n| PI * (n as f64 - shift)).collect()
        } else {
            elastic_roots(&chain, rigid_count, elastic)?
        };
        let translation = 1.0 / spans.iter().map(|s| s.mass * s.length).sum::<f64>().sqrt();
        let still = |s: &Span| Piece::Short { k: 0.0, length: s.length, start: [translation, 0.0, 0.0, 0.0] };
        let rigid = vec![spans.iter().map(still).collect(); rigid_count.min(count)];
        let unit = units.rigidity.sqrt() / units.mass_per_length_kg_m.sqrt() / units.length_m;
        let omega = roots.iter().map(|q| q * unit);
        let elastic = shapes(&chain, &roots);
        let held = held_ends(self.ends.map(|end| end == RodEnd::Fixed));
        Modes::assemble(spans, units, rigid, omega, elastic, held)
    }

    /// Static compliance `G(x, x)`, m/N: displacement at `x_m` under a steady unit force there; for a free-free rod its
    /// elastic part, as for [`Beam::static_compliance`](crate::Beam::static_compliance).
    ///
    /// # Errors
    /// [`InvalidInput`] as for [`modes`](Self::modes), and for a location outside the rod.
    pub fn static_compliance(&self, x_m: f64) -> Result<f64, InvalidInput> {
        let (spans, units) = self.checked()?;
        let x = require_on("x_m", x_m, units.length_m)? / units.length_m;
        Ok(strain_energy(&spans, self.ends, x) * units.length_m / units.rigidity)
    }

    fn checked(&self) -> Result<(Vec<Span>, Units), InvalidInput> {
        let raw: Vec<[f64; 3]> =
            self.segments.iter().map(|s| [s.length_m, s.axial_rigidity_n, s.mass_per_length_kg_m]).collect();
        nondimensional(&raw, ["length_m", "axial_rigidity_n", "mass_per_length_kg_m"])
    }
}

/// `G(x, x)` is the integral of `N^2 / EA`, with `N` the axial force under the unit force at `x`: constant on either side of
/// it, or, in a free-free rod, proportional to the accelerated mass.
fn strain_energy(spans: &[Span], ends: [RodEnd; 2], x: f64) -> f64 {
    let flexibility = |s: &Span| s.length / s.rigidity;
    let total: f64 = spans.iter().map(flexibility).sum();
    let before = |s: &Span| (x - s.start).clamp(0.0, s.length);
    let left: f64 = spans.iter().map(|s| before(s) / s.rigidity).sum();
    match ends {
        [RodEnd::Fixed, RodEnd::Fixed] => left * (total - left) / total,
        [RodEnd::Fixed, RodEnd::Free] => left,
        [RodEnd::Free, RodEnd::Fixed] => total - left,
        [RodEnd::Free, RodEnd::Free] => {
            let mass: f64 = spans.iter().map(|s| s.mass * s.length).sum();
            let (mut energy, mut passed) = (0.0, 0.0);
            for s in spans {
                let (split, rate) = (before(s), s.mass / mass);
                energy += gauss(split, |xi| (passed + rate * xi).powi(2)) / s.rigidity;
                energy += gauss(s.length - split, |xi| (passed + rate * (split + xi) - 1.0).powi(2)) / s.rigidity;
                passed += rate * s.length;
            }
            energy
        }
    }
}
