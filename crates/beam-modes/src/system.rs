//! A beam with all that may be said of it: theory of bending, attachments, supports, axial force, foundation.

use crate::beam::{Beam, End, rigid_motions, rigid_shape};
use crate::buckling::require_stable;
use crate::chain::Chain;
use crate::flexure::Flexure;
use crate::location::require_on;
use crate::modes::{Modes, require_count};
use crate::piece::Piece;
use crate::roots::elastic_roots;
use crate::shapes::shapes;
use crate::span::Units;
use crate::statics;
use invalid_input::InvalidInput;

/// What Timoshenko's theory needs of a segment beside its rigidity and mass.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShearSection {
    /// Shear rigidity `kappa G A`, N.
    pub shear_rigidity_n: f64,
    /// Rotary inertia per length `rho I`, kg m; zero neglects it.
    pub rotary_inertia_kg_m: f64,
}

/// Springs and masses fixed to a beam at one location. Each of them may be zero, and is by default.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Attachment {
    /// Distance from the left end, m.
    pub location_m: f64,
    /// Mass, kg.
    pub mass_kg: f64,
    /// Rotary inertia about the axis of bending, kg m^2.
    pub rotary_inertia_kg_m2: f64,
    /// Spring to the ground, N/m.
    pub spring_n_m: f64,
    /// Rotational spring to the ground, N m/rad.
    pub rotational_spring_n_m_rad: f64,
}

/// A rigid support between the ends: no displacement, no moment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Support {
    /// Distance from the left end, m.
    pub location_m: f64,
}

/// A beam by either theory of bending, and what is fixed to it.
///
/// Timoshenko's theory is exact in shear and rotary inertia: each segment has the frequencies of both spectra. Axial
/// force and foundation are those of Euler-Bernoulli's theory.
///
/// ```
/// use beam_modes::{Attachment, Beam, BeamSystem, End, Segment, ShearSection};
/// // 1 m of steel, 50 mm square, pinned at both ends: shear and rotary inertia take a quarter of the tenth frequency
/// let side: f64 = 0.05;
/// let segment = Segment::rectangular(1.0, 2e11, 7800.0, side, side);
/// let shear = ShearSection {
///     shear_rigidity_n: 0.85 * 2e11 / 2.6 * side.powi(2),
///     rotary_inertia_kg_m: 7800.0 * side.powi(4) / 12.0,
/// };
/// let slender = Beam { segments: vec![segment], ends: [End::Pinned, End::Pinned] };
/// let mut thick = BeamSystem { shear: Some(vec![shear]), ..BeamSystem::from(slender.clone()) };
/// let ratio = thick.modes(10)?.omega_rad_s()[9] / slender.modes(10)?.omega_rad_s()[9];
/// assert!((0.75..0.76).contains(&ratio));
/// thick.attachments.push(Attachment { location_m: 0.5, mass_kg: 3.0, ..Attachment::default() });
/// assert!(thick.modes(1)?.omega_rad_s()[0] < 0.9 * slender.modes(1)?.omega_rad_s()[0]);
/// # Ok::<(), beam_modes::InvalidInput>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct BeamSystem {
    /// Segments and ends.
    pub beam: Beam,
    /// One for each segment makes a Timoshenko beam; `None` leaves shear and rotary inertia out (Euler-Bernoulli).
    pub shear: Option<Vec<ShearSection>>,
    /// Springs and masses; those at one place add up.
    pub attachments: Vec<Attachment>,
    /// Rigid supports between the ends.
    pub supports: Vec<Support>,
    /// Axial force, N; tension is positive. It keeps its direction when an end moves. Euler-Bernoulli only.
    pub axial_force_n: f64,
    /// Stiffness per length of an elastic foundation along the whole beam, N/m^2. Euler-Bernoulli only.
    pub foundation_n_m2: f64,
}

impl From<Beam> for BeamSystem {
    fn from(beam: Beam) -> Self {
        Self {
            beam,
            shear: None,
            attachments: Vec::new(),
            supports: Vec::new(),
            axial_force_n: 0.0,
            foundation_n_m2: 0.0,
        }
    }
}

impl BeamSystem {
    /// Whether segments and ends are all there is.
    fn is_bare(&self) -> bool {
        let Self { beam: _, shear, attachments, supports, axial_force_n, foundation_n_m2 } = self;
        shear.is_none()
            && attachments.is_empty()
            && supports.is_empty()
            && *axial_force_n == 0.0
            && *foundation_n_m2 == 0.0
    }

    /// How many rigid-body motions ends, supports, springs, axial force and foundation leave.
    ///
    /// # Errors
    /// As for [`modes`](Self::modes).
    pub fn rigid_body_count(&self) -> Result<usize, InvalidInput> {
        let chain = Chain::of(self)?;
        Ok(rigid_motions(&chain.spans, chain.ends, &chain.nodes).len())
    }

    /// Mass of the segments and of what is attached, kg.
    pub fn mass_kg(&self) -> f64 {
        self.beam.mass_kg() + self.attachments.iter().map(|attachment| attachment.mass_kg).sum::<f64>()
    }

    /// The first `count` modes in bending, rigid-body motions (with `omega = 0`) included and first, orthonormal in all
    /// the mass there is: `int m w^2 + rho I t^2 dx` and the attached masses and inertias.
    ///
    /// Without anything beyond segments and ends these are the modes of [`Beam::modes`], to the last bit. A beam pinned
    /// at both ends has, by Timoshenko's theory, a mode of pure shear at `sqrt(kappa G A / rho I)`; it is counted and
    /// moves no point.
    ///
    /// # Errors
    /// [`InvalidInput`] as for [`Beam::modes`]; for shear sections that are not one a segment or out of range; for
    /// attachments and supports off the beam; for axial force or foundation on a Timoshenko beam; for a compression
    /// under which the beam buckles, with the critical load.
    pub fn modes(&self, count: usize) -> Result<Modes, InvalidInput> {
        if self.is_bare() {
            return self.beam.modes(count);
        }
        let chain = Chain::of(self)?;
        if self.axial_force_n < 0.0 {
            require_stable(&chain)?;
        }
        let Chain { spans, nodes, ends, units } = chain;
        require_count(count, spans.len())?;
        let motions = rigid_motions(&spans, ends, &nodes);
        let elastic = count.saturating_sub(motions.len());
        let last = spans.len() - 1;
        let place = |i: usize| if i > last { (last, spans[last].length) } else { (i, 0.0) };
        let heavy = nodes.iter().enumerate().filter(|(_, node)| node.mass[0] > 0.0);
        let fixed = heavy.map(|(i, node)| (place(i).0, place(i).1, node.mass[0])).collect();
        let waveguide = Flexure::new(spans.clone(), ends, nodes);
        let roots = elastic_roots(&waveguide, motions.len(), elastic)?;
        let unit = units.bending_frequency();
        let omega = roots.iter().map(|q| q * q * unit);
        let rigid: Vec<Vec<Piece>> = motions.iter().take(count).map(|motion| rigid_shape(&spans, motion)).collect();
        let elastic = shapes(&waveguide, &roots);
        Ok(Modes::assemble(spans, units, rigid, omega, elastic)?.with_fixed(fixed))
    }

    /// Static compliance `G(x, x)`, m/N, with the deflection in shear; see [`Beam::static_compliance`].
    ///
    /// # Errors
    /// [`InvalidInput`] as for [`modes`](Self::modes), and for a location off the beam.
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
            Err(InvalidInput::new("segments", "as given", crate::modes::RESOLVABLE))
        }
    }
}

/// An end that a support holds.
pub(crate) fn held(end: End) -> End {
    match end {
        End::Free | End::Pinned => End::Pinned,
        End::Guided | End::Clamped => End::Clamped,
    }
}
