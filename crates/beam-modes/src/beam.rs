//! The beam as the user poses it.

use crate::compliance::green;
use crate::flexure::Flexure;
use crate::location::require_on;
use crate::modes::{Modes, require_count};
use crate::node::Node;
use crate::piece::Piece;
use crate::roots::elastic_roots;
use crate::shapes::shapes;
use crate::span::{Span, Units, nondimensional_beam};
use crate::uniform;
use invalid_input::InvalidInput;

/// A uniform stretch of a beam.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Segment {
    /// Length, m.
    pub length_m: f64,
    /// Flexural rigidity `E I`, N m^2.
    pub flexural_rigidity_n_m2: f64,
    /// Mass per unit length `rho A`, kg/m.
    pub mass_per_length_kg_m: f64,
}

impl Segment {
    /// A segment of rectangular section; `thickness_m` is measured in the plane of bending.
    ///
    /// ```
    /// let steel = beam_modes::Segment::rectangular(1.0, 2e11, 7800.0, 0.0254, 0.00549);
    /// assert!((steel.flexural_rigidity_n_m2 - 2e11 * 0.0254 * 0.00549f64.powi(3) / 12.0).abs() < 1e-9);
    /// ```
    ///
    /// The values are checked when the beam is used.
    pub fn rectangular(
        length_m: f64,
        youngs_modulus_pa: f64,
        density_kg_m3: f64,
        width_m: f64,
        thickness_m: f64,
    ) -> Self {
        Self {
            length_m,
            flexural_rigidity_n_m2: youngs_modulus_pa * width_m * thickness_m.powi(3) / 12.0,
            mass_per_length_kg_m: density_kg_m3 * width_m * thickness_m,
        }
    }
}

/// How an end of a beam is held.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum End {
    /// No displacement, no slope.
    Clamped,
    /// No displacement, no moment.
    Pinned,
    /// No moment, no shear force.
    Free,
    /// No slope, no shear force.
    Guided,
}

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

    /// How many rigid-body motions the ends leave: two for free-free, one for pinned-free, guided-free and
    /// guided-guided, none otherwise.
    pub fn rigid_body_count(&self) -> usize {
        use End::{Free, Guided, Pinned};
        match self.ends {
            [Free, Free] => 2,
            [Guided, Free | Guided] | [Free, Guided | Pinned] | [Pinned, Free] => 1,
            _ => 0,
        }
    }

    /// The first `count` modes in bending, rigid-body motions (with `omega = 0`) included and first.
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
        let roots = if spans.len() == 1 {
            (1..=elastic).map(|n| uniform::root(self.ends, n)).collect()
        } else {
            elastic_roots(&chain, motions.len(), elastic)?
        };

        let unit = units.bending_frequency();
        let omega = roots.iter().map(|q| q * q * unit);
        let rigid: Vec<Vec<Piece>> = motions.iter().take(count).map(|motion| rigid_shape(&spans, motion)).collect();
        let elastic = shapes(&chain, &roots);
        Modes::assemble(spans, units, rigid, omega, elastic)
    }

    /// Static compliance `G(x, x)`: displacement at `x_m` under a steady unit force there, m/N.
    ///
    /// When the ends leave rigid-body motions, this is the elastic part: the response orthogonal (in mass) to those
    /// motions, with the uniform accelerations that the force causes taken out. In either case it equals the sum of
    /// `phi_k(x)^2 / omega_k^2` over all elastic modes, and is computed exactly, from the piecewise polynomial
    /// deflection.
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
    /// [`InvalidInput`] as for [`modes`](Self::modes), and for a location off the beam.
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

/// Mass-normalised displacements `p + q x` that strain nothing: a translation before a rotation about the centre of
/// mass.
pub(crate) fn rigid_motions(spans: &[Span], ends: [End; 2], nodes: &[Node]) -> Vec<[f64; 2]> {
    use End::{Free, Guided, Pinned};
    let places = || spans.iter().map(|s| s.start).chain([1.0]);
    let fixed = || places().zip(nodes).filter(|(_, node)| node.is_heavy());
    let mass: f64 = spans.iter().map(|s| s.mass * s.length).sum::<f64>() + fixed().map(|(_, n)| n.mass[0]).sum::<f64>();
    let first_moment = spans.iter().map(|s| s.mass * s.length * (s.start + 0.5 * s.length)).sum::<f64>()
        + fixed().map(|(x, node)| node.mass[0] * x).sum::<f64>();
    let centre = first_moment / mass;
    let held =
        places().zip(nodes).filter(|(_, n)| n.support || n.spring[0] > 0.0).map(|(x, _)| x).collect::<Vec<f64>>();
    let founded = spans.iter().any(|s| s.foundation > 0.0);
    // an axial force keeps its direction, and so turns the beam towards it
    let turned = spans.iter().any(|s| s.tension != 0.0) || nodes.iter().any(|node| node.spring[1] > 0.0);
    let stands = |&[p, q]: &[f64; 2]| !founded && (!turned || q == 0.0) && held.iter().all(|x| p + q * x == 0.0);
    let motions = match ends {
        [Free, Free] => match held.as_slice() {
            // about the only location that is held
            [x, rest @ ..] if rest.iter().all(|other| other == x) => vec![[-x, 1.0]],
            _ => vec![[1.0, 0.0], [-centre, 1.0]],
        },
        [Guided, Free | Guided] | [Free, Guided] => vec![[1.0, 0.0]],
        [Pinned, Free] => vec![[0.0, 1.0]],
        [Free, Pinned] => vec![[1.0, -1.0]],
        _ => vec![],
    };
    let normalised = |[p, q]: [f64; 2]| {
        // the integral of (p + q x)^2 over a span, by its mean and its spread
        let square = |s: &Span| (p + q * (s.start + 0.5 * s.length)).powi(2) + (q * s.length).powi(2) / 12.0;
        let along = spans.iter().map(|s| s.mass * s.length * square(s) + s.rotary * s.length * q * q).sum::<f64>();
        let fixed = fixed().map(|(x, node)| node.mass[0] * (p + q * x).powi(2) + node.mass[1] * q * q).sum::<f64>();
        let norm = (along + fixed).sqrt();
        [p / norm, q / norm]
    };
    motions.into_iter().filter(stands).map(normalised).collect()
}

pub(crate) fn rigid_shape(spans: &[Span], &[p, q]: &[f64; 2]) -> Vec<Piece> {
    spans.iter().map(|s| Piece::Short { k: 0.0, length: s.length, start: [p + q * s.start, q, 0.0, 0.0] }).collect()
}
