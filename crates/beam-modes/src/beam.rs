//! Modes and static compliance of a plain beam.

use crate::compliance::green;
use crate::definition::{Beam, End, is_held};
use crate::elastic::Elastic;
use crate::flexure::Flexure;
use crate::location::require_on;
use crate::modes::{Modes, held_ends, require_count};
use crate::node::Node;
use crate::piece::Piece;
use crate::rigid::{rigid_motions, rigid_shape};
use crate::span::{Span, Units, nondimensional_beam};
use invalid_input::InvalidInput;

impl Beam {
    /// Number of rigid-body motions that the ends allow: two for free-free, one for pinned-free, guided-free and guided-guided,
    /// none otherwise.
    pub fn rigid_body_count(&self) -> usize {
        use End::{Free, Guided, Pinned};
        match self.ends {
            [Free, Free] => 2,
            [Guided, Free | Guided] | [Free, Guided | Pinned] | [Pinned, Free] => 1,
            _ => 0,
        }
    }

    /// The first `count` modes in bending, beginning with rigid-body motions (`omega = 0`).
    ///
    /// # Errors
    /// [`InvalidInput`] for lengths, rigidities or masses that are not positive and finite (or beyond 1e-60 to
    /// 1e60), for contrasts between segments beyond 1e12, and for a `count` above 100,000.
    pub fn modes(&self, count: usize) -> Result<Modes, InvalidInput> {
        let (spans, units) = self.checked()?;
        require_count(count, spans.len())?;
        let nodes = vec![Node::default(); spans.len() + 1];
        let motions = rigid_motions(&spans, self.ends, &nodes);
        let elastic = count.saturating_sub(motions.len());

        let chain = Flexure::new(spans.clone(), self.ends, nodes);
        let Elastic { omega, shapes } = Elastic::of(&chain, motions.len(), elastic)?;
        let unit = units.bending_frequency();
        let omega = omega.iter().map(|omega| omega * unit);
        let rigid: Vec<Vec<Piece>> = motions.iter().take(count).map(|motion| rigid_shape(&spans, motion)).collect();
        Modes::assemble(spans, units, rigid, omega, shapes, held_ends(self.ends.map(is_held)))
    }

    /// Static compliance `G(x, x)`: displacement at `x_m` under a steady unit force there, m/N.
    ///
    /// If the ends allow rigid-body motions, this is the elastic part: the response orthogonal (in mass) to those motions,
    /// without the uniform accelerations that the force causes. In either case it equals the sum of `phi_k(x)^2 / omega_k^2`
    /// over all elastic modes, and is computed exactly, from the piecewise polynomial deflection.
    ///
    /// ```
    /// use beam_modes::{Beam, End, Segment};
    /// let segment = Segment { length_m: 2.0, flexural_rigidity_n_m2: 100.0, mass_per_length_kg_m: 1.0 };
    /// let cantilever = Beam { segments: vec![segment], ends: [End::Clamped, End::Free] };
    /// assert!((cantilever.static_compliance(2.0)? - 8.0 / 300.0).abs() < 1e-15);
    /// # Ok::<(), beam_modes::InvalidInput>(())
    /// ```
    ///
    /// # Errors
    /// [`InvalidInput`] as for [`modes`](Self::modes), and for a location outside the beam.
    pub fn static_compliance(&self, x_m: f64) -> Result<f64, InvalidInput> {
        self.static_green(x_m, x_m)
    }

    /// Static Green's function `G(x, y)`: displacement at `x_m` under a steady unit force at `y_m`, m/N; symmetric.
    /// See [`static_compliance`](Self::static_compliance) for beams with rigid-body motions.
    ///
    /// # Errors
    /// As for [`static_compliance`](Self::static_compliance).
    pub fn static_green(&self, x_m: f64, y_m: f64) -> Result<f64, InvalidInput> {
        let (spans, units) = self.checked()?;
        let x = require_on("x_m", x_m, units.length_m)? / units.length_m;
        let y = require_on("y_m", y_m, units.length_m)? / units.length_m;
        let motions = rigid_motions(&spans, self.ends, &[]);
        let deflection = green(&spans, self.ends, &motions, x, y);
        Ok(deflection * units.length_m.powi(3) / units.rigidity)
    }

    pub(crate) fn checked(&self) -> Result<(Vec<Span>, Units), InvalidInput> {
        nondimensional_beam(self, None)
    }
}
