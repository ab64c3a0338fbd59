//! Impulse response of the struck point, and the units in which an impact is solved.

use super::groups::{BeamSection, Groups, Impact, PlateSection};
use super::problem::Structure;
use crate::modal::Striker;
use invalid_input::{InvalidInput, Step};

/// Powers of time that an impulse response may have besides 0: those for which the product integration was checked.
const POWERS: std::ops::RangeInclusive<f64> = 0.1..=0.9;
/// Most terms of an impulse response.
const MOST_TERMS: usize = 8;

/// An impulse response is that of any striker and contact.
pub(super) const UNIT: Striker = Striker { mass_kg: 1.0, speed_m_s: 1.0 };

/// One term `coefficient t^power` of an impulse response.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Term {
    /// Displacement (m) under a unit impulse (N s) after one second: m/(N s^(1 + power)), positive.
    pub coefficient: f64,
    /// Power of time: 0, or 0.1 to 0.9.
    pub power: f64,
}

/// The impulse response of the struck point of an infinite structure, `y(t) = sum_k c_k t^(p_k)` m per N s: the counterpart in
/// time of the receptance `sum_k c_k Gamma(1 + p_k) / (i omega)^(1 + p_k)`.
///
/// All `c_k` are positive and all `p_k` are below 1, so that the point keeps moving away after an impulse, with decreasing
/// speed. It follows that the gap is convex in flight: the next contact is found with certainty, or there is none.
///
/// | structure, struck at | `y(t)` |
/// |---|---|
/// | an infinite beam ([`beam`](Receptance::beam)) | `C sqrt(t)`, `C = (EI)^(-1/4) m'^(-3/4) / sqrt(2 pi)` (thesis Eq. 2.2) |
/// | the free end of a semi-infinite beam | `4 C sqrt(t)` |
/// | a thin infinite plate ([`plate`](Receptance::plate)) | `1 / (8 sqrt(D m''))` (Zener 1941) |
/// | an infinite string of tension `H` | `1 / (2 sqrt(H m'))` |
/// | the end of a semi-infinite rod | `1 / (A sqrt(E rho))` |
///
/// ```
/// use vibroimpact_sim::infinite::{Receptance, Term};
/// // the end of a steel rod of 1 cm^2
/// let impedance_n_s_m = 1e-4 * (200e9_f64 * 7800.0).sqrt();
/// let rod = Receptance::new(&[Term { coefficient: 1.0 / impedance_n_s_m, power: 0.0 }])?;
/// assert_eq!(rod.displacement_m(1e-3), 1.0 / impedance_n_s_m);
/// # Ok::<(), vibroimpact_sim::InvalidInput>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Receptance {
    terms: Vec<Term>,
}

/// The units in which an impact on an infinite structure is solved: `T`, `F`, `v T` and `v`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scale {
    /// Unit of time `T`, at which an impulse has displaced the struck point as far as the free striker, `m y(T) = T`.
    pub time_s: f64,
    /// Unit of force `F = m v / T`.
    pub force_n: f64,
    /// Unit of displacement, `v T`.
    pub displacement_m: f64,
    /// Unit of speed, `v`.
    pub speed_m_s: f64,
}

impl From<Groups> for Scale {
    fn from(groups: Groups) -> Scale {
        let Groups { time_s, force_n, displacement_m, speed_m_s, .. } = groups;
        Scale { time_s, force_n, displacement_m, speed_m_s }
    }
}

impl Receptance {
    /// The sum of 1 to 8 terms.
    ///
    /// # Errors
    /// [`InvalidInput`] for another number of terms, a coefficient that is not positive, or a power that is neither 0
    /// nor from 0.1 to 0.9.
    pub fn new(terms: &[Term]) -> Result<Receptance, InvalidInput> {
        InvalidInput::unless(
            (1..=MOST_TERMS).contains(&terms.len()),
            "terms",
            terms.len(),
            "a number of terms from 1 to 8",
        )?;
        for (i, term) in terms.iter().enumerate() {
            let within = |fault: InvalidInput| fault.within(Step::Index(i)).within("terms");
            InvalidInput::require_positive("coefficient", term.coefficient).map_err(within)?;
            let power = term.power == 0.0 || POWERS.contains(&term.power);
            InvalidInput::unless(power, "power", term.power, "0, or a number from 0.1 to 0.9").map_err(within)?;
        }
        Ok(Receptance { terms: terms.to_vec() })
    }

    /// Of an infinite beam of flexural rigidity `EI` (N m^2) and mass per length (kg/m).
    ///
    /// # Errors
    /// [`InvalidInput`] unless both are finite and positive.
    pub fn beam(flexural_rigidity_n_m2: f64, mass_per_length_kg_m: f64) -> Result<Receptance, InvalidInput> {
        let beam = BeamSection { flexural_rigidity_n_m2, mass_per_length_kg_m };
        Impact::on_beam(beam, UNIT, 1.0).map(|impact| impact.receptance())
    }

    /// Of a thin infinite plate of flexural rigidity `E h^3 / (12 (1 - nu^2))` (N m) and mass per area (kg/m^2).
    ///
    /// # Errors
    /// [`InvalidInput`] unless both are finite and positive.
    pub fn plate(flexural_rigidity_n_m: f64, mass_per_area_kg_m2: f64) -> Result<Receptance, InvalidInput> {
        let plate = PlateSection { flexural_rigidity_n_m, mass_per_area_kg_m2 };
        Impact::on_plate(plate, UNIT, 1.0).map(|impact| impact.receptance())
    }

    /// Its terms.
    pub fn terms(&self) -> &[Term] {
        &self.terms
    }

    /// Displacement (m) under a unit impulse (N s) after a time (s).
    pub fn displacement_m(&self, time_s: f64) -> f64 {
        self.terms.iter().map(|term| term.coefficient * time_s.powf(term.power)).sum()
    }

    /// The units for a striker.
    ///
    /// # Errors
    /// [`InvalidInput`] unless mass and speed are finite and positive, or if a unit leaves the range of numbers.
    pub fn scale(&self, striker: &Striker) -> Result<Scale, InvalidInput> {
        let Striker { mass_kg, speed_m_s } = *striker;
        InvalidInput::require_positive("mass_kg", mass_kg)?;
        InvalidInput::require_positive("speed_m_s", speed_m_s)?;
        // each term alone has a closed form; together they reach T sooner, at most in proportion to their number
        let alone = |term: &Term| (mass_kg * term.coefficient).powf(1.0 / (1.0 - term.power));
        let mut time_s = self.terms.iter().map(alone).fold(0.0, f64::max);
        if self.terms.len() > 1 {
            // m y(T) / T falls with T: Newton's method in ln T on a convex function from the left
            for _ in 0..100 {
                let terms =
                    || self.terms.iter().map(|t| (mass_kg * t.coefficient * time_s.powf(t.power - 1.0), t.power));
                let (sum, slope) = terms().fold((0.0, 0.0), |(sum, slope), (y, p)| (sum + y, slope + (1.0 - p) * y));
                let step = sum.ln() * sum / slope;
                time_s *= step.exp();
                if step.abs() < 1e-15 || step.is_nan() {
                    break;
                }
            }
        }
        let scale =
            Scale { time_s, force_n: mass_kg * speed_m_s / time_s, displacement_m: speed_m_s * time_s, speed_m_s };
        InvalidInput::require_positive("time_s", scale.time_s)?;
        InvalidInput::require_positive("force_n", scale.force_n)?;
        InvalidInput::require_positive("displacement_m", scale.displacement_m)?;
        Ok(scale)
    }
}

impl Impact {
    /// The impulse response of the struck structure.
    pub fn receptance(&self) -> Receptance {
        let power = match self.structure {
            Structure::Beam => 0.5,
            Structure::Plate => 0.0,
        };
        Receptance { terms: vec![Term { coefficient: self.impulse_response, power }] }
    }
}
