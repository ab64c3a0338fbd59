//! The dimensionless chain of uniform spans that beams and rods share.
//!
//! The units are the total length, and the rigidity and mass per length of the first segment.

use crate::definition::{Beam, ShearSection};
use invalid_input::InvalidInput;

/// One uniform segment, dimensionless.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Span {
    /// Start of the span.
    pub start: f64,
    pub length: f64,
    /// `EI` or `EA`.
    pub rigidity: f64,
    /// Mass per length.
    pub mass: f64,
    /// `1/(kappa G A)`; zero without shear.
    pub shear: f64,
    /// Rotary inertia per length, `rho I`.
    pub rotary: f64,
    /// Axial force.
    pub tension: f64,
    /// Stiffness per length of a foundation.
    pub foundation: f64,
}

impl Span {
    /// A span of bending without shear, or of an axial wave.
    pub fn slender(start: f64, length: f64, rigidity: f64, mass: f64) -> Self {
        Self { start, length, rigidity, mass, shear: 0.0, rotary: 0.0, tension: 0.0, foundation: 0.0 }
    }

    /// Whether the span has only rigidity and mass.
    pub fn is_plain(&self) -> bool {
        [self.shear, self.rotary, self.tension, self.foundation] == [0.0; 4]
    }
}

/// Conversion of dimensionless results to SI.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Units {
    pub length_m: f64,
    /// `EI` (N m^2) or `EA` (N) of the first segment.
    pub rigidity: f64,
    pub mass_per_length_kg_m: f64,
}

impl Units {
    /// The unit in rad/s; in bending the dimensionless frequency is `q^2`.
    pub fn bending_frequency(&self) -> f64 {
        self.rigidity.sqrt() / self.mass_per_length_kg_m.sqrt() / self.length_m / self.length_m
    }
}

/// Largest ratio between the segments' lengths, rigidities or masses per length.
const MAX_CONTRAST: f64 = 1e12;
const CONTRAST: &str = "within a factor 1e12 of the same property of every other segment";
const SCALE: &str = "a number between 1e-60 and 1e60";
/// The property that an extreme chain of segments does not have.
pub(crate) const RESOLVABLE: &str =
    "a list without contrasts and sizes so large that double precision cannot resolve the modes";

/// Checks segments `[length, rigidity, mass per length]` and makes them dimensionless.
///
/// Equal neighbours are merged: a uniform beam is one span, however it was divided.
pub(crate) fn nondimensional(raw: &[[f64; 3]], names: [&str; 3]) -> Result<(Vec<Span>, Units), InvalidInput> {
    let Some(first) = raw.first() else {
        return Err(InvalidInput::new("segments", "[]", "a list of at least one segment"));
    };
    for (property, name) in names.into_iter().enumerate() {
        let (mut low, mut high) = (first[property], first[property]);
        for (i, segment) in raw.iter().enumerate() {
            let value = InvalidInput::require_positive(("segments", i, name), segment[property])?;
            if !(1e-60..=1e60).contains(&value) {
                return Err(InvalidInput::new(("segments", i, name), value, SCALE));
            }
            (low, high) = (low.min(value), high.max(value));
            if high / low > MAX_CONTRAST {
                return Err(InvalidInput::new(("segments", i, name), value, CONTRAST));
            }
        }
    }
    Ok(merged(raw, |_| [0.0; 2]))
}

/// The same for a beam, with shear and rotary inertia if they are given.
pub(crate) fn nondimensional_beam(
    beam: &Beam,
    shear: Option<&[ShearSection]>,
) -> Result<(Vec<Span>, Units), InvalidInput> {
    let raw: Vec<[f64; 3]> =
        beam.segments.iter().map(|s| [s.length_m, s.flexural_rigidity_n_m2, s.mass_per_length_kg_m]).collect();
    let bare = nondimensional(&raw, ["length_m", "flexural_rigidity_n_m2", "mass_per_length_kg_m"])?;
    let Some(shear) = shear else { return Ok(bare) };
    if shear.len() != raw.len() {
        return Err(InvalidInput::new(
            "shear",
            format!("{} sections", shear.len()),
            "a list with one section for each segment",
        ));
    }
    let Units { length_m, rigidity, mass_per_length_kg_m } = bare.1;
    let mut sections = Vec::with_capacity(shear.len());
    for (i, section) in shear.iter().enumerate() {
        let path = |field| ("segments", i, field);
        let stiffness = InvalidInput::require_positive(path("shear_rigidity_n"), section.shear_rigidity_n)?;
        let inertia = section.rotary_inertia_kg_m;
        let scaled = [rigidity / length_m / length_m / stiffness, inertia / mass_per_length_kg_m / length_m / length_m];
        if !(0.0..=SHEAR_MOST).contains(&scaled[0]) {
            return Err(InvalidInput::new(path("shear_rigidity_n"), stiffness, SHEAR_RANGE));
        }
        if !(0.0..=SHEAR_MOST).contains(&scaled[1]) {
            return Err(InvalidInput::new(path("rotary_inertia_kg_m"), inertia, ROTARY_RANGE));
        }
        sections.push(scaled);
    }
    Ok(merged(&raw, |i| sections[i]))
}

/// Largest flexibility in shear, and rotary inertia, relative to those in bending of a beam of this length.
const SHEAR_MOST: f64 = 1e6;
const SHEAR_RANGE: &str =
    "at least 1e-6 times the flexural rigidity of the first segment over the square of the length";
const ROTARY_RANGE: &str =
    "from 0 to 1e6 times the mass per length of the first segment times the square of the length";

/// Merges equal neighbours; `section` contains the properties of a segment other than length, rigidity and mass.
fn merged(raw: &[[f64; 3]], section: impl Fn(usize) -> [f64; 2]) -> (Vec<Span>, Units) {
    let first = raw[0];
    let length_m: f64 = raw.iter().map(|s| s[0]).sum();
    let mut spans: Vec<Span> = Vec::with_capacity(raw.len());
    let mut start_m = 0.0;
    let mut i = 0;
    while i < raw.len() {
        let same = |j: &usize| raw[*j][1..] == raw[i][1..] && section(*j) == section(i);
        let run = (i..raw.len()).take_while(same).count();
        let run_m: f64 = raw[i..i + run].iter().map(|s| s[0]).sum();
        let [rigidity, mass] = [raw[i][1] / first[1], raw[i][2] / first[2]];
        let [shear, rotary] = section(i);
        spans.push(Span { shear, rotary, ..Span::slender(start_m / length_m, run_m / length_m, rigidity, mass) });
        start_m += run_m;
        i += run;
    }
    (spans, Units { length_m, rigidity: first[1], mass_per_length_kg_m: first[2] })
}

/// The span that contains the dimensionless location `x`, and the location within it.
pub(crate) fn locate(spans: &[Span], x: f64) -> (usize, f64) {
    let i = spans.partition_point(|span| span.start <= x).saturating_sub(1);
    (i, (x - spans[i].start).clamp(0.0, spans[i].length))
}
