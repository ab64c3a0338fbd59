//! Rectangular plates.

mod band;
mod block;
mod definition;
mod lanczos;
mod levy;
mod line;
mod modes;
mod navier;
mod ritz;

pub use definition::{Edge, Plate, PlateTheory};
pub use modes::PlateModes;

use invalid_input::InvalidInput;
use ritz::Ritz;

/// Largest number of modes that may be requested.
const MOST: usize = 20_000;
/// With fewer modes the polynomials for this many are used: they cost little, and low modes with singular corners need them.
const AMPLE: usize = 120;

impl Plate {
    /// Largest number of modes that [`Plate::modes`] computes: 20,000 in closed form, otherwise the number that matrices of
    /// 3,000 rows resolve; some 450 for a square without symmetry, 2,000 with it.
    pub fn most_modes(&self) -> usize {
        if self.pinned_all_round() {
            return MOST;
        }
        let (mut fits, mut beyond) = (1, MOST);
        while beyond - fits > 1 {
            let middle = fits.midpoint(beyond);
            *(if Ritz::degrees(self, middle).is_some() { &mut fits } else { &mut beyond }) = middle;
        }
        fits
    }

    /// The first `count` natural modes.
    ///
    /// A plate that is pinned along all edges is solved by Navier's closed form; others by Ritz's method with products of
    /// polynomials whose second derivatives are Legendre polynomials, of a degree that resolves the shortest wave among the
    /// requested modes, or among 120. [`PlateModes::change`] states by how much each frequency still depended on the degree.
    /// Frequencies converge from above. Where a clamped edge meets a free one, the shape is singular and they are accurate to
    /// some 5e-6, elsewhere to 1e-7 and mostly far better.
    ///
    /// # Errors
    /// As [`Plate::checked`]; a count beyond [`Plate::most_modes`].
    pub fn modes(&self, count: usize) -> Result<PlateModes, InvalidInput> {
        self.checked()?;
        if count > MOST {
            return Err(InvalidInput::new("count", count, "at most 20000"));
        }
        if self.pinned_all_round() {
            return Ok(navier::modes(self, count));
        }
        let ample = if count > 0 { Ritz::degrees(self, count.max(AMPLE)) } else { None };
        let degrees = ample.or_else(|| Ritz::degrees(self, count)).ok_or_else(|| {
            InvalidInput::new(
                "count",
                count,
                "smaller, because this number of modes needs matrices of more than 3000 rows",
            )
        })?;
        Ritz::new(self, degrees).modes(count)
    }

    /// Static deflection at a location under a unit load there, m/N; that of the elastic modes alone if the plate can move as a
    /// rigid body.
    ///
    /// For a plate that is pinned along all edges it is in closed form (a single series after summation of Navier's double
    /// one). Otherwise Ritz's method is used with up to some 54 polynomials in each direction, which do not resolve the local
    /// deflection under the load. This error depends on the neighbourhood of the load only, and is therefore taken from a plate
    /// for which it is known: one that is pinned along two opposite edges, with the free or clamped edge that is nearest (Levy's
    /// series), or along all edges. The remaining error is extrapolated in the degree, to some 1e-7, and to 1e-3 a hundredth
    /// of the sides from a corner where a clamped edge makes the deflection tiny;
    /// [`Plate::static_compliance_with_uncertainty`] states it.
    ///
    /// # Errors
    /// As [`Plate::checked`]; a location outside the plate; Mindlin's theory, which gives no finite deflection.
    pub fn static_compliance(&self, x_m: f64, y_m: f64) -> Result<f64, InvalidInput> {
        Ok(self.static_compliance_with_uncertainty(x_m, y_m)?.0)
    }

    /// [`Plate::static_compliance`] and its uncertainty, m/N: the change by the last polynomials and by all further ones, and
    /// some 1e-9 of the value for rounding; 0 for a closed form.
    ///
    /// # Errors
    /// As [`Plate::static_compliance`].
    pub fn static_compliance_with_uncertainty(&self, x_m: f64, y_m: f64) -> Result<(f64, f64), InvalidInput> {
        self.checked()?;
        let (x, y) = self.place(x_m, y_m)?;
        if let PlateTheory::Mindlin { .. } = self.theory {
            let allowed = "\"kirchhoff\", because the deflection of a plate with shear has no limit under a point load";
            return Err(InvalidInput::new("theory", "mindlin", allowed));
        }
        if self.pinned_all_round() {
            return Ok((navier::static_compliance(self, x, y), 0.0));
        }
        self.extrapolated(Ritz::STATIC_DEGREES, x, y)
    }

    /// The static compliance by Ritz's method with polynomials of three degrees, and its uncertainty.
    fn extrapolated(&self, degrees: [usize; 3], x: f64, y: f64) -> Result<(f64, f64), InvalidInput> {
        const ROUNDING: f64 = 1e-9;
        let (known, closed) = self.known_nearby(x, y);
        let of_degree = |degree: usize| -> Result<f64, InvalidInput> {
            let degrees = Ritz::static_degrees(self, degree);
            let missed = closed - Ritz::new(&known, degrees).static_compliance(x, y)?;
            Ok(Ritz::new(self, degrees).static_compliance(x, y)? + missed.max(0.0))
        };
        let [first, second, third] = degrees.map(of_degree);
        let (second, third) = (second?, third?);
        let (before, last) = (second - first?, third - second);
        // The error decreases as a power of the degree, at least the second, so that changes over equal ratios of the degree
        // are a geometric series.
        let slowest = (degrees[1] as f64 / degrees[2] as f64).powi(2);
        let ratio = if before == 0.0 { 0.0 } else { (last / before).clamp(0.0, slowest) };
        let further = last * ratio / (1.0 - ratio);
        let whole = (third + further).max(0.0);
        Ok((whole, last.abs() + further.abs() + ROUNDING * whole))
    }

    /// A plate of the same size that has the same edges near a location, given in shares of length and width, and its static
    /// compliance there in closed form: pinned along two opposite edges, with the two others of this plate if one of them is
    /// the nearest edge that is not pinned; or pinned along all edges.
    fn known_nearby(&self, x: f64, y: f64) -> (Plate, f64) {
        /// For a strip much narrower than long, Levy's equations are nearly dependent.
        const NARROWEST: f64 = 0.02;
        let [left, right, low, high] = self.edges;
        let (a, b) = (self.length_m, self.width_m);
        let nearest = |edges: [Edge; 2], share: f64, length: f64| {
            let distances = [(edges[0], share * length), (edges[1], (1.0 - share) * length)];
            let not_pinned = distances.into_iter().filter(|(edge, _)| *edge != Edge::Pinned);
            not_pinned.map(|(_, distance)| distance).fold(f64::INFINITY, f64::min)
        };
        let (along, across) = (nearest([left, right], x, a), nearest([low, high], y, b));
        let (nu, rigidity, place) = (self.poissons_ratio, self.flexural_rigidity_n_m(), [x * a, y * b]);
        let (pinned, [u, v]) = (Edge::Pinned, place);
        let (edges, deflection) =
            if across.min(along) == f64::INFINITY || !(NARROWEST..=1.0 / NARROWEST).contains(&(b / a)) {
                ([pinned; 4], navier::static_compliance(&Plate { edges: [pinned; 4], ..*self }, x, y) * rigidity)
            } else if across <= along {
                ([pinned, pinned, low, high], levy::deflection([a, b], [low, high], nu, [u, v]))
            } else {
                ([left, right, pinned, pinned], levy::deflection([b, a], [left, right], nu, [v, u]))
            };
        (Plate { edges, ..*self }, deflection / rigidity)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEEL: Plate = Plate {
        length_m: 0.4,
        width_m: 0.3,
        thickness_m: 0.005,
        youngs_modulus_pa: 2e11,
        poissons_ratio: 0.3,
        density_kg_m3: 7800.0,
        edges: [Edge::Pinned; 4],
        theory: PlateTheory::Kirchhoff,
    };
    const PLACES: [[f64; 2]; 6] = [[0.5, 0.5], [0.3, 0.2], [0.9, 0.9], [0.97, 0.5], [0.05, 0.98], [0.99, 0.99]];

    /// Very near to a clamped edge a plate deflects as a half plane: by `r^2 ln(r/s) + (s^2 - r^2)/2` over `8 pi D` at the
    /// distances `r` from the load and `s` from its image, and by `d^2/(4 pi D)` under the load at the distance `d` from the edge.
    #[test]
    fn beside_a_clamped_edge_a_plate_is_a_half_plane() {
        let (clamped, free, pinned) = (Edge::Clamped, Edge::Free, Edge::Pinned);
        for edges in [[clamped; 4], [free, clamped, clamped, pinned]] {
            let plate = Plate { edges, ..STEEL };
            // At a share of 1e-4 Levy's series has lost six digits more to rounding.
            for (share, rounding) in [(1e-2, 0.0), (1e-3, 0.0), (1e-4, 1e-5)] {
                let d = share * plate.width_m;
                let half_plane = d * d / (4.0 * std::f64::consts::PI * plate.flexural_rigidity_n_m());
                let (found, off) = plate.static_compliance_with_uncertainty(0.15, d).unwrap();
                let allowed = off + (10.0 * share * share + rounding) * half_plane;
                assert!((found - half_plane).abs() < allowed, "{edges:?} {d}: {found:e} {half_plane:e} {off:e}");
            }
        }
    }

    /// In a corner the deflection falls as the square of the distance from it, where an edge is clamped.
    #[test]
    fn the_error_in_corners_is_stated() {
        let (clamped, free) = (Edge::Clamped, Edge::Free);
        for edges in [[clamped; 4], [free, clamped, clamped, free]] {
            let plate = Plate { edges, ..STEEL };
            let at = |share: f64| plate.static_compliance_with_uncertainty(0.4 * share, 0.3 * share).unwrap();
            let ((far, far_off), (near, off)) = (at(1e-2), at(1e-3));
            let expected = far * 1e-2;
            assert!(
                (near - expected).abs() < off + 1e-2 * (far_off + 2e-3 * far),
                "{edges:?}: {near:e} {expected:e} {off:e}"
            );
        }
    }

    /// Near free edges and corners, half as many polynomials again are the reference.
    #[test]
    fn the_error_near_free_edges_is_stated() {
        let (clamped, free, pinned) = (Edge::Clamped, Edge::Free, Edge::Pinned);
        for edges in [[clamped, free, free, free], [clamped, free, free, pinned]] {
            let plate = Plate { edges, ..STEEL };
            for [x, y] in PLACES {
                let (finer, _) = plate.extrapolated([36, 54, 80], x, y).unwrap();
                let (found, off) = plate.extrapolated(Ritz::STATIC_DEGREES, x, y).unwrap();
                assert!((found - finer).abs() < off, "{edges:?} {x} {y}: {found:e} {finer:e} {off:e}");
            }
        }
    }
}
