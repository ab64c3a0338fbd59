//! The uncertainty of a restitution and of forces, part by part.

use serde::Serialize;
use vibroimpact_sim::modal::SubImpact;

use super::quantity::Quantity;

use crate::scene::{Scene, Structure};

/// The solver's part if the restitution has a closed form: the rounding of some thousand operations. The closed form of every law
/// agrees with its numerical integration to this accuracy (`tests/restitution.rs` of `contact-models`).
pub(super) const CLOSED_FORM: f64 = 5e-12;

/// The uncertainty of a restitution, or of a force in its unit, in parts that add up. A part is null if it cannot be known;
/// [`Answer::not_known`](super::Answer::not_known) then states the reason.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct Uncertainty {
    /// Error in solving the equations of the model. For modes: compared with the exact motion of the retained modes.
    pub solver: Option<f64>,
    /// Truncation error: the difference between the model and the same structure with all its modes. For models without modes
    /// (`rigid`, `infinite-beam`, `emoc`): the error of their simplification.
    pub modes_left_out: Option<f64>,
    /// Uncertainty of the theory of bending: the difference between Euler-Bernoulli's and Timoshenko's theory, or the change by 2 %
    /// of the shear coefficient if that is larger.
    pub beam_theory: Option<f64>,
}

impl Uncertainty {
    /// The whole of what can be estimated: the sum of the parts that are known; `None` if the solver's part is not, without which no
    /// digit is known.
    pub fn whole(&self) -> Option<f64> {
        self.solver?;
        let known = self.parts().into_iter().filter_map(|(_, part)| part);
        Some(known.sum::<f64>().min(f64::MAX))
    }

    /// The whole, if every part that is known of `other` is known here as well: the uncertainty of a force beside that of the
    /// restitution, of which it would otherwise lack a part.
    pub fn whole_beside(&self, other: &Uncertainty) -> Option<f64> {
        let lacks =
            self.parts().into_iter().zip(other.parts()).any(|((_, own), (_, other))| own.is_none() && other.is_some());
        self.whole().filter(|_| !lacks)
    }

    /// Difference of the restitution from its limit by the same theory: the sum of the known parts without that of the theory.
    pub fn of_model(&self) -> Option<f64> {
        Uncertainty { beam_theory: None, ..*self }.whole()
    }

    /// The parts under their names.
    pub fn parts(&self) -> [(&'static str, Option<f64>); 3] {
        [("solver", self.solver), ("modes left out", self.modes_left_out), ("beam theory", self.beam_theory)]
    }
}

/// The uncertainty of the largest force of each interval of contact (N), part by part. The error of a motion persists, and two motions
/// may agree in one number by accident: a part is at least that of every interval before. It is not known if another impact has no
/// counterpart of the interval (`of` is then infinite), and from the first interval on for which it exceeds the largest of all forces.
pub(super) fn of_peaks(contacts: &[SubImpact], of: impl Fn(usize, &Quantity) -> Uncertainty) -> Vec<Uncertainty> {
    let largest_n = contacts.iter().map(|contact| contact.peak_force_n).fold(0.0, f64::max);
    let mut largest = [0.0f64; 3];
    let mut peak = |i: usize| {
        let Uncertainty { solver, modes_left_out, beam_theory } = of(i, &Quantity::PeakForce { of: contacts, i });
        let mut parts = [solver, modes_left_out, beam_theory];
        for (part, largest) in parts.iter_mut().zip(&mut largest) {
            *part = part.filter(|part| part.is_finite()).and_then(|part| {
                *largest = largest.max(part);
                (*largest <= largest_n).then_some(*largest)
            });
        }
        let [solver, modes_left_out, beam_theory] = parts;
        Uncertainty { solver, modes_left_out, beam_theory }
    };
    (0..contacts.len()).map(&mut peak).collect()
}

/// The uncertainty of a restitution, and why parts of it are not known.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Known {
    pub uncertainty: Uncertainty,
    pub not_known: Vec<String>,
}

impl Known {
    /// The uncertainty of an impact on the structure of `scene`, whose solver error and truncation error may state why they are not
    /// known.
    pub fn new(scene: &Scene, solver: Result<f64, &str>, modes_left_out: Result<f64, String>) -> Known {
        let mut not_known = Vec::new();
        let solver = solver.map_err(|why| not_known.push(format!("solver: {why}"))).ok();
        let modes_left_out =
            modes_left_out.map_err(|why| not_known.push(format!("modes left out: {why}"))).ok().filter(|u| !u.is_nan());
        not_known.push(format!("beam theory: {}", why_not_judged(&scene.structure)));
        Known { uncertainty: Uncertainty { solver, modes_left_out, beam_theory: None }, not_known }
    }

    /// Unknown uncertainty, with one reason for all parts.
    pub fn nothing(why: &str) -> Known {
        Known { uncertainty: Uncertainty::default(), not_known: vec![why.to_owned()] }
    }

    /// The same if there is a restitution.
    pub fn of(self, restitution: Option<f64>) -> Known {
        if restitution.is_some() { self } else { Known::default() }
    }
}

/// The reason why the theory of a structure is not compared with another.
fn why_not_judged(structure: &Structure) -> &'static str {
    match structure {
        Structure::Modal(_) | Structure::ModesFile(_) => {
            "the modes are given; how well they describe the structure is not known here"
        }
        Structure::InfinitePlate(_) | Structure::Plate(_) => {
            "thin-plate theory leaves out shear and rotary inertia, which slow waves shorter than some ten thicknesses"
        }
        Structure::TautString(_) => "the theory of strings has neither shear nor rotary inertia",
        Structure::Beam(beam) if beam.axial_force_n != 0.0 || beam.foundation_n_m2 != 0.0 => {
            "with axial force or foundation only Euler-Bernoulli's theory can be solved, which leaves out shear and rotary \
             inertia"
        }
        Structure::Beam(beam) if beam.theory_variants().is_ok_and(|variants| !variants.is_empty()) => {
            "not estimated here, since this takes further impacts"
        }
        Structure::Beam(_) => {
            "Euler-Bernoulli theory leaves out shear and rotary inertia; with poissons_ratio in every segment Timoshenko's \
             theory shows their effect"
        }
        _ => {
            "Euler-Bernoulli theory leaves out shear and rotary inertia, which slow waves shorter than some ten \
             thicknesses"
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Uncertainty;

    #[test]
    fn the_whole_is_the_sum_of_what_is_known() {
        assert_eq!(Uncertainty::default().whole(), None);
        let some = Uncertainty { solver: Some(0.25), modes_left_out: None, beam_theory: Some(0.5) };
        assert_eq!(some.whole(), Some(0.75));
        assert_eq!(Uncertainty { solver: None, ..some }.whole(), None);
        assert_eq!(some.whole_beside(&Uncertainty { solver: Some(0.1), ..Uncertainty::default() }), Some(0.75));
        assert_eq!(some.whole_beside(&Uncertainty { modes_left_out: Some(0.1), ..some }), None);
    }
}
