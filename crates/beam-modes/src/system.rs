//! Modes and static compliance of a beam with all its options: theory of bending, attachments, supports, axial force,
//! foundation.

use crate::buckling::require_stable;
use crate::chain::Chain;
#[cfg(doc)]
use crate::definition::Beam;
use crate::definition::{BeamSystem, is_held};
use crate::elastic::Elastic;
use crate::flexure::Flexure;
use crate::location::require_on;
use crate::modes::{Modes, held_ends, require_count};
use crate::node::Node;
use crate::piece::Piece;
use crate::rigid::{rigid_motions, rigid_shape};
use crate::roots::count_below_search;
use crate::span::{RESOLVABLE, Units};
use crate::statics;
use invalid_input::InvalidInput;

impl Chain {
    fn waveguide(&self) -> Flexure {
        Flexure::new(self.spans.clone(), self.ends, self.nodes.clone())
    }

    fn assemble(self, rigid: Vec<Vec<Piece>>, elastic: Elastic) -> Result<Modes, InvalidInput> {
        let Self { spans, nodes, ends, units } = self;
        let last = spans.len() - 1;
        let place = |i: usize| if i > last { (last, spans[last].length) } else { (i, 0.0) };
        let heavy = nodes.iter().enumerate().filter(|(_, node)| node.mass[0] > 0.0);
        let fixed = heavy.map(|(i, node)| (place(i).0, place(i).1, node.mass[0])).collect();
        let supported = spans.iter().zip(&nodes).filter(|(_, node)| node.support).map(|(span, _)| span.start);
        let held = held_ends(ends.map(is_held)).into_iter().chain(supported).collect();
        let unit = units.bending_frequency();
        let omega = elastic.omega.iter().map(|omega| omega * unit);
        Ok(Modes::assemble(spans, units, rigid, omega, elastic.shapes, held)?.with_fixed(fixed))
    }
}

impl BeamSystem {
    /// Whether there are only segments and ends.
    fn is_bare(&self) -> bool {
        let Self { beam: _, shear, attachments, supports, axial_force_n, foundation_n_m2 } = self;
        shear.is_none()
            && attachments.is_empty()
            && supports.is_empty()
            && *axial_force_n == 0.0
            && *foundation_n_m2 == 0.0
    }

    /// Number of rigid-body motions that ends, supports, springs, axial force and foundation allow.
    ///
    /// # Errors
    /// As for [`modes`](Self::modes).
    pub fn rigid_body_count(&self) -> Result<usize, InvalidInput> {
        let chain = Chain::of(self)?;
        Ok(rigid_motions(&chain.spans, chain.ends, &chain.nodes).len())
    }

    /// Mass of the segments and of the attachments, kg.
    pub fn mass_kg(&self) -> f64 {
        self.beam.mass_kg() + self.attachments.iter().map(|attachment| attachment.mass_kg).sum::<f64>()
    }

    /// The first `count` modes in bending, beginning with rigid-body motions (`omega = 0`), orthonormal in the whole mass:
    /// `int m w^2 + rho I t^2 dx` and the attached masses and inertias.
    ///
    /// With segments and ends only, these are the modes of [`Beam::modes`], to the last bit. In Timoshenko's theory a beam that
    /// is pinned at both ends has a mode of pure shear at `sqrt(kappa G A / rho I)`; it is counted, and its displacement is
    /// zero.
    ///
    /// # Errors
    /// [`InvalidInput`] as for [`Beam::modes`]; for shear sections that are out of range or not one per segment; for
    /// attachments and supports outside the beam; for axial force or foundation on a Timoshenko beam; for a compression under
    /// which the beam buckles, with the critical load.
    pub fn modes(&self, count: usize) -> Result<Modes, InvalidInput> {
        if self.is_bare() {
            return self.beam.modes(count);
        }
        let whole = Chain::of(self)?;
        if self.axial_force_n < 0.0 {
            require_stable(&whole)?;
        }
        let (chain, raised) = Chain::on_rest_of_foundation(self)?;
        let motions = rigid_motions(&chain.spans, chain.ends, &chain.nodes);
        // Without the common part of the foundation, compression or attached masses may leave a beam that does not stand.
        let may_fall = raised > 0.0 && (self.axial_force_n < 0.0 || chain.nodes.iter().any(Node::is_heavy));
        if may_fall && count_below_search(&chain.waveguide()) > motions.len() {
            let chain = whole.without_common_foundation().0;
            require_count(count, chain.spans.len())?;
            let guide = chain.waveguide();
            let below = count_below_search(&guide);
            let mut found = Elastic::default();
            found.add(&whole.waveguide(), 0, below.min(count), 0.0)?;
            found.add(&guide, below, count - found.shapes.len(), raised)?;
            return chain.assemble(Vec::new(), found);
        }
        require_count(count, chain.spans.len())?;
        let mut rigid: Vec<Vec<Piece>> =
            motions.iter().take(count).map(|motion| rigid_shape(&chain.spans, motion)).collect();
        let elastic = count - rigid.len();
        let mut found = Elastic::default();
        if raised > 0.0 {
            // A foundation in proportion to the mass turns rigid motions into vibrations.
            found = Elastic { omega: vec![raised.sqrt(); rigid.len()], shapes: std::mem::take(&mut rigid) };
        }
        found.add(&chain.waveguide(), motions.len(), elastic, raised)?;
        chain.assemble(rigid, found)
    }

    /// Static compliance `G(x, x)`, m/N, with the deflection in shear; see [`Beam::static_compliance`].
    ///
    /// # Errors
    /// [`InvalidInput`] as for [`modes`](Self::modes), and for a location outside the beam.
    pub fn static_compliance(&self, x_m: f64) -> Result<f64, InvalidInput> {
        self.static_green(x_m, x_m)
    }

    /// Static Green's function `G(x, y)`, m/N; see [`Beam::static_green`].
    ///
    /// # Errors
    /// As for [`static_compliance`](Self::static_compliance).
    pub fn static_green(&self, x_m: f64, y_m: f64) -> Result<f64, InvalidInput> {
        if self.is_bare() {
            return self.beam.static_green(x_m, y_m);
        }
        let length_m = self.beam.length_m();
        Chain::of(self)?;
        let x = require_on("x_m", x_m, length_m)? / length_m;
        let y = require_on("y_m", y_m, length_m)? / length_m;
        let chain = Chain::for_statics(self, y)?;
        if self.axial_force_n < 0.0 {
            require_stable(&Chain::of(self)?)?;
        }
        let Units { rigidity, .. } = chain.units;
        let deflection = statics::green(&chain, x, y);
        if deflection.is_finite() {
            Ok(deflection * length_m.powi(3) / rigidity)
        } else {
            Err(InvalidInput::new("segments", "as given", RESOLVABLE))
        }
    }
}
