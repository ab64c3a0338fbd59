//! The theory of bending of a beam, and its variants: the other theory, another shear coefficient.

use invalid_input::InvalidInput;

use super::beam::Beam;
use super::beam_theory::BeamTheory;

/// A variant of the theory of a scene's beam.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TheoryVariant {
    /// The other theory of bending.
    OtherTheory,
    /// Timoshenko's theory with the shear coefficient 2 % smaller.
    SmallerShearCoefficient,
    /// Timoshenko's theory with the shear coefficient 2 % larger.
    LargerShearCoefficient,
}

/// Relative difference of usual shear coefficients.
const SHEAR_COEFFICIENT_SPREAD: f64 = 0.02;

impl Beam {
    /// The theory that the beam is solved by, never `Auto`. (A scene file that states its modes but no theory is read as
    /// one that states Euler-Bernoulli's, as in the thesis.)
    ///
    /// # Errors
    /// If Timoshenko's theory is requested and a segment lacks its data.
    pub fn solved_by(&self) -> Result<BeamTheory, InvalidInput> {
        let possible = self.axial_force_n == 0.0 && self.foundation_n_m2 == 0.0;
        match self.theory.unwrap_or(BeamTheory::Auto) {
            BeamTheory::Auto if possible && self.has_shear()? => Ok(BeamTheory::Timoshenko),
            BeamTheory::Auto => Ok(BeamTheory::EulerBernoulli),
            stated => Ok(stated),
        }
    }

    /// Sets Euler-Bernoulli's theory if the theory is not stated and there is a choice: for scenes that state their modes.
    pub(crate) fn as_the_thesis(&mut self) {
        if self.theory.is_none() && self.has_shear() == Ok(true) {
            self.theory = Some(BeamTheory::EulerBernoulli);
        }
    }

    /// Whether every segment has the data of Timoshenko's theory.
    fn has_shear(&self) -> Result<bool, InvalidInput> {
        let mut all = !self.segments.is_empty();
        for (i, segment) in self.segments.iter().enumerate() {
            let shear = segment.to_shear().map_err(|fault| fault.at(i).within("segments"))?;
            all &= shear.is_some();
        }
        Ok(all)
    }

    /// The variants of a beam whose impacts show the uncertainty of the theory of bending: the same beam by the other theory, and
    /// with a shear coefficient 2 % smaller and larger, if they can be solved. The uncertainty `beam_theory` of a result is the
    /// change of the restitution between them.
    ///
    /// There are none if the segments lack the data of Timoshenko's theory, or if axial force or foundation require
    /// Euler-Bernoulli's.
    ///
    /// ```
    /// use vibroimpact::scene::{Beam, BeamTheory, End, RectangularSegment, Segment, TheoryVariant};
    /// let square = RectangularSegment {
    ///     length_m: 1.0,
    ///     youngs_modulus_pa: 2e11,
    ///     density_kg_m3: 7800.0,
    ///     width_m: 0.0113,
    ///     thickness_m: 0.0113,
    /// };
    /// let segment = Segment { poissons_ratio: Some(0.3), ..square.into() };
    /// let beam = Beam { segments: vec![segment], ..Beam::new([End::Pinned, End::Pinned]) };
    /// assert_eq!(beam.solved_by()?, BeamTheory::Timoshenko);
    /// let variants = beam.theory_variants()?;
    /// assert_eq!(variants.len(), 3);
    /// assert_eq!(variants[0].0, TheoryVariant::OtherTheory);
    /// assert_eq!(variants[0].1.solved_by()?, BeamTheory::EulerBernoulli);
    /// # Ok::<(), vibroimpact::InvalidInput>(())
    /// ```
    ///
    /// # Errors
    /// As [`to_system`](Self::to_system).
    pub fn theory_variants(&self) -> Result<Vec<(TheoryVariant, Beam)>, InvalidInput> {
        let theory = self.solved_by()?;
        if self.axial_force_n != 0.0 || self.foundation_n_m2 != 0.0 || !self.has_shear()? {
            return Ok(Vec::new());
        }
        let with = |theory| Beam { theory: Some(theory), ..self.clone() };
        if theory == BeamTheory::EulerBernoulli {
            return Ok(vec![(TheoryVariant::OtherTheory, with(BeamTheory::Timoshenko))]);
        }
        let mut variants = vec![(TheoryVariant::OtherTheory, with(BeamTheory::EulerBernoulli))];
        for (variant, factor) in [
            (TheoryVariant::SmallerShearCoefficient, 1.0 - SHEAR_COEFFICIENT_SPREAD),
            (TheoryVariant::LargerShearCoefficient, 1.0 + SHEAR_COEFFICIENT_SPREAD),
        ] {
            let mut beam = with(BeamTheory::Timoshenko);
            for segment in &mut beam.segments {
                *segment = segment.with_shear_times(factor);
            }
            variants.push((variant, beam));
        }
        Ok(variants)
    }
}
