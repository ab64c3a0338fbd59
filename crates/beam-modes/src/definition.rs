//! The input: a beam and its attachments.

/// A uniform segment of a beam.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Segment {
    /// Length, m.
    pub length_m: f64,
    /// Flexural rigidity `E I`, N m^2.
    pub flexural_rigidity_n_m2: f64,
    /// Mass per unit length `rho A`, kg/m.
    pub mass_per_length_kg_m: f64,
}

/// A uniform segment of rectangular section, by its dimensions and its material. It converts into a [`Segment`], whose values
/// are checked when the beam is used.
///
/// ```
/// use beam_modes::{RectangularSegment, Segment};
/// let ruler = RectangularSegment {
///     length_m: 1.0,
///     youngs_modulus_pa: 2e11,
///     density_kg_m3: 7800.0,
///     width_m: 0.0254,
///     thickness_m: 0.00549,
/// };
/// let steel = Segment::from(ruler);
/// assert!((steel.flexural_rigidity_n_m2 - 2e11 * 0.0254 * 0.00549f64.powi(3) / 12.0).abs() < 1e-9);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct RectangularSegment {
    /// Length, m.
    pub length_m: f64,
    /// Young's modulus, Pa.
    pub youngs_modulus_pa: f64,
    /// Density, kg/m^3.
    pub density_kg_m3: f64,
    /// Width, across the plane of bending, m.
    pub width_m: f64,
    /// Thickness, in the plane of bending, m.
    pub thickness_m: f64,
}

impl From<RectangularSegment> for Segment {
    fn from(stretch: RectangularSegment) -> Segment {
        let RectangularSegment { length_m, youngs_modulus_pa, density_kg_m3, width_m, thickness_m } = stretch;
        Segment {
            length_m,
            flexural_rigidity_n_m2: youngs_modulus_pa * width_m * thickness_m.powi(3) / 12.0,
            mass_per_length_kg_m: density_kg_m3 * width_m * thickness_m,
        }
    }
}

/// The boundary condition at an end of a beam.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum End {
    /// Zero displacement and slope.
    Clamped,
    /// Zero displacement and moment.
    Pinned,
    /// Zero moment and shear force.
    Free,
    /// Zero slope and shear force.
    Guided,
}

invalid_input::names!(End, "end", { Clamped: "clamped", Pinned: "pinned", Free: "free", Guided: "guided" });

/// An Euler-Bernoulli beam of uniform segments, joined end to end from `x = 0` on.
///
/// ```
/// use beam_modes::{Beam, End, Segment};
/// let segment = Segment { length_m: 1.0, flexural_rigidity_n_m2: 275.0, mass_per_length_kg_m: 1.0 };
/// let beam = Beam { segments: vec![segment], ends: [End::Pinned, End::Pinned] };
/// let modes = beam.modes(40)?;
/// let first = std::f64::consts::PI.powi(2) * 275f64.sqrt();
/// assert!((modes.omega_rad_s()[0] / first - 1.0).abs() < 1e-14);
/// assert!((modes.shape(0, 0.5)? - 2f64.sqrt()).abs() < 1e-14);
/// # Ok::<(), beam_modes::InvalidInput>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Beam {
    /// Segments from left to right.
    pub segments: Vec<Segment>,
    /// The left and the right end.
    pub ends: [End; 2],
}

impl Beam {
    /// Total length, m.
    pub fn length_m(&self) -> f64 {
        self.segments.iter().map(|s| s.length_m).sum()
    }

    /// Total mass, kg.
    pub fn mass_kg(&self) -> f64 {
        self.segments.iter().map(|s| s.length_m * s.mass_per_length_kg_m).sum()
    }
}

/// The properties of a segment that Timoshenko's theory needs in addition to its rigidity and mass.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct ShearSection {
    /// Shear rigidity `kappa G A`, N.
    pub shear_rigidity_n: f64,
    /// Rotary inertia per length `rho I`, kg m; zero neglects it.
    pub rotary_inertia_kg_m: f64,
}

/// Springs and masses attached to a beam at one location. Each of them may be zero, which is the default.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
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

/// A rigid support between the ends: zero displacement, free rotation.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Support {
    /// Distance from the left end, m.
    pub location_m: f64,
}

/// A beam by either theory of bending, with its attachments.
///
/// Timoshenko's theory includes shear and rotary inertia exactly: each segment has the frequencies of both spectra. Axial force
/// and foundation are available with Euler-Bernoulli's theory only.
///
/// ```
/// use beam_modes::{Attachment, Beam, BeamSystem, End, RectangularSegment, ShearSection};
/// // 1 m of steel, 50 mm square, pinned at both ends: shear and rotary inertia lower the tenth frequency by a quarter
/// let side: f64 = 0.05;
/// let segment = RectangularSegment {
///     length_m: 1.0,
///     youngs_modulus_pa: 2e11,
///     density_kg_m3: 7800.0,
///     width_m: side,
///     thickness_m: side,
/// };
/// let shear = ShearSection {
///     shear_rigidity_n: 0.85 * 2e11 / 2.6 * side.powi(2),
///     rotary_inertia_kg_m: 7800.0 * side.powi(4) / 12.0,
/// };
/// let slender = Beam { segments: vec![segment.into()], ends: [End::Pinned, End::Pinned] };
/// let mut thick = BeamSystem { shear: Some(vec![shear]), ..BeamSystem::from(slender.clone()) };
/// let ratio = thick.modes(10)?.omega_rad_s()[9] / slender.modes(10)?.omega_rad_s()[9];
/// assert!((0.75..0.76).contains(&ratio));
/// thick.attachments.push(Attachment { location_m: 0.5, mass_kg: 3.0, ..Attachment::default() });
/// assert!(thick.modes(1)?.omega_rad_s()[0] < 0.9 * slender.modes(1)?.omega_rad_s()[0]);
/// # Ok::<(), beam_modes::InvalidInput>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct BeamSystem {
    /// Segments and ends.
    pub beam: Beam,
    /// One for each segment makes a Timoshenko beam; `None` neglects shear and rotary inertia (Euler-Bernoulli).
    pub shear: Option<Vec<ShearSection>>,
    /// Springs and masses; those at the same location are added.
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

/// Whether the end cannot move sideways.
pub(crate) fn is_held(end: End) -> bool {
    matches!(end, End::Clamped | End::Pinned)
}

/// An end with a support.
pub(crate) fn held(end: End) -> End {
    match end {
        End::Free | End::Pinned => End::Pinned,
        End::Guided | End::Clamped => End::Clamped,
    }
}
