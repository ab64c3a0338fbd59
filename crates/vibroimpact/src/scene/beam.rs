//! A beam of uniform segments, and its modes.

use invalid_input::{InvalidInput, Step};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use vibroimpact_sim::modal;

use super::beam_theory::BeamTheory;
use super::fittings::{Attachment, Damping, Support};
use super::json::{number, objects};
use super::place::require_count;
use super::segment::Segment;
use super::sets::{all_stated, stated_as};

/// A straight beam of uniform segments, from left to right.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("allOf" = theory_and_fields()))]
pub struct Beam {
    /// How the left and the right end are held.
    pub ends: [End; 2],
    /// The segments from left to right; at least one.
    #[serde(deserialize_with = "objects")]
    #[schemars(length(min = 1))]
    pub segments: Vec<Segment>,
    /// Theory of bending. When left out: `"auto"` where the program chooses the modes, otherwise `"euler-bernoulli"`, as
    /// in the thesis.
    pub theory: Option<BeamTheory>,
    /// Damping ratio of every mode; 0 when left out.
    #[serde(default)]
    pub damping_ratio: f64,
    /// Damping ratios of the first elastic modes; those beyond have `damping_ratio`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub damping_ratios: Vec<f64>,
    /// Rayleigh damping by mass (1/s): adds `rayleigh_mass_per_s / (2 omega)` to the damping ratio of every elastic mode.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub rayleigh_mass_per_s: f64,
    /// Rayleigh damping by stiffness (s): adds `rayleigh_stiffness_s omega / 2` to the damping ratio of every mode.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub rayleigh_stiffness_s: f64,
    /// Masses and springs fixed to the beam.
    #[serde(default, skip_serializing_if = "Vec::is_empty", deserialize_with = "objects")]
    pub attachments: Vec<Attachment>,
    /// Rigid supports between the ends.
    #[serde(default, skip_serializing_if = "Vec::is_empty", deserialize_with = "objects")]
    pub supports: Vec<Support>,
    /// Axial force (N), tension positive, which keeps its direction; Euler-Bernoulli only; 0 when left out.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub axial_force_n: f64,
    /// Stiffness per length of an elastic foundation under the whole beam (N/m^2); Euler-Bernoulli only; 0 when left
    /// out.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub foundation_n_m2: f64,
}

/// Schema: what Timoshenko's theory needs of a segment, and what it does not have.
fn theory_and_fields() -> Value {
    let shear = [&["poissons_ratio"][..], &["material"], &["shear_rigidity_n", "rotary_inertia_kg_m"]];
    json!([{
        "if": stated_as("theory", json!({ "const": "timoshenko" })),
        "then": { "properties": {
            "segments": { "items": { "anyOf": shear.map(all_stated) } },
            "axial_force_n": { "const": 0 },
            "foundation_n_m2": { "const": 0 },
        } }
    }])
}

fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

/// How an end of a beam is held.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum End {
    /// Neither displacement nor slope.
    Clamped,
    /// No displacement, no moment.
    Pinned,
    /// No moment, no shear force.
    Free,
    /// No slope, no shear force.
    Guided,
}

invalid_input::names!(End, "end", { Clamped: "clamped", Pinned: "pinned", Free: "free", Guided: "guided" });

impl Beam {
    /// A beam of these ends, with no segments yet and all else left out.
    pub fn new(ends: [End; 2]) -> Beam {
        Beam {
            ends,
            segments: Vec::new(),
            theory: None,
            damping_ratio: 0.0,
            damping_ratios: Vec::new(),
            rayleigh_mass_per_s: 0.0,
            rayleigh_stiffness_s: 0.0,
            attachments: Vec::new(),
            supports: Vec::new(),
            axial_force_n: 0.0,
            foundation_n_m2: 0.0,
        }
    }

    /// Segments and ends as input of [`beam_modes`], by Euler-Bernoulli's theory and without attachments and supports;
    /// [`to_system`](Self::to_system) has all.
    ///
    /// # Errors
    /// A segment whose section is not given in exactly one way, or by numbers that are not positive.
    pub fn to_beam(&self) -> Result<beam_modes::Beam, InvalidInput> {
        let length_m: f64 = self.segments.iter().map(|segment| segment.length_m).sum();
        let segment = |(i, segment): (usize, &Segment)| {
            let within = |fault: InvalidInput| fault.at(i).within("segments");
            let bending = segment.to_segment().map_err(within)?;
            match segment.thickness() {
                Some((field, thickness)) if length_m < 2.0 * thickness => {
                    let allowed = format!(
                        "at most half the length of the whole beam, {} m, because beam theory does not hold for shorter \
                        beams; flexural_rigidity_n_m2 and mass_per_length_kg_m are accepted for any length",
                        number(length_m)
                    );
                    Err(within(InvalidInput::new(field, number(thickness), allowed)))
                }
                _ => Ok(bending),
            }
        };
        Ok(beam_modes::Beam {
            segments: self.segments.iter().enumerate().map(segment).collect::<Result<_, _>>()?,
            ends: self.ends.map(|end| match end {
                End::Clamped => beam_modes::End::Clamped,
                End::Pinned => beam_modes::End::Pinned,
                End::Free => beam_modes::End::Free,
                End::Guided => beam_modes::End::Guided,
            }),
        })
    }

    /// The complete beam of the scene, by the theory of [`solved_by`](Self::solved_by).
    ///
    /// # Errors
    /// As [`to_beam`](Self::to_beam), and a segment without the data of Timoshenko's theory if that is requested.
    pub fn to_system(&self) -> Result<beam_modes::BeamSystem, InvalidInput> {
        let beam = self.to_beam()?;
        let theory = self.solved_by()?;
        let mut shear = Vec::with_capacity(self.segments.len());
        for (i, segment) in self.segments.iter().enumerate() {
            let within = |fault: InvalidInput| fault.at(i).within("segments");
            // checked even where it is not used
            match segment.to_shear().map_err(within)? {
                Some(section) => shear.push(section),
                None if theory == BeamTheory::Timoshenko => return Err(within(segment.lacks_shear())),
                None => {}
            }
        }
        let attachment = |attachment: &Attachment| beam_modes::Attachment {
            location_m: attachment.location_m,
            mass_kg: attachment.mass_kg,
            rotary_inertia_kg_m2: attachment.rotary_inertia_kg_m2,
            spring_n_m: attachment.spring_n_m,
            rotational_spring_n_m_rad: attachment.rotational_spring_n_m_rad,
        };
        Ok(beam_modes::BeamSystem {
            beam,
            shear: (theory == BeamTheory::Timoshenko).then_some(shear),
            attachments: self.attachments.iter().map(attachment).collect(),
            supports: self.supports.iter().map(|s| beam_modes::Support { location_m: s.location_m }).collect(),
            axial_force_n: self.axial_force_n,
            foundation_n_m2: self.foundation_n_m2,
        })
    }

    /// Where segments end and where something is attached or supports the beam, between its ends (m).
    pub(crate) fn corners_m(&self) -> Vec<f64> {
        let mut end_m = 0.0;
        let mut ends_m: Vec<f64> = Vec::with_capacity(self.segments.len());
        for segment in &self.segments {
            end_m += segment.length_m;
            ends_m.push(end_m);
        }
        ends_m.pop();
        let attached_m = self.attachments.iter().map(|attachment| attachment.location_m);
        ends_m.into_iter().chain(attached_m).chain(self.supports.iter().map(|support| support.location_m)).collect()
    }

    /// Properties of this beam that the slender, uniformly damped beam of the thesis does not have, if any.
    pub(crate) fn beyond_slender(&self) -> Result<Option<&'static str>, InvalidInput> {
        Ok(match self.solved_by()? {
            BeamTheory::Timoshenko => Some("shear and rotary inertia"),
            _ if !self.attachments.is_empty() => Some("attachments"),
            _ if !self.supports.is_empty() => Some("supports between its ends"),
            _ if self.axial_force_n != 0.0 => Some("an axial force"),
            _ if self.foundation_n_m2 != 0.0 => Some("a foundation"),
            _ if !self.damping_ratios.is_empty() => Some("a damping ratio for each mode"),
            _ if self.rayleigh_mass_per_s != 0.0 || self.rayleigh_stiffness_s != 0.0 => Some("Rayleigh damping"),
            _ => None,
        })
    }

    /// The largest damping ratio of its modes; `None` where it grows with the frequency or against it.
    pub(crate) fn largest_damping_ratio(&self) -> Option<f64> {
        let constant = self.rayleigh_mass_per_s == 0.0 && self.rayleigh_stiffness_s == 0.0;
        constant.then(|| self.damping_ratios.iter().copied().fold(self.damping_ratio, f64::max))
    }

    /// The damping ratio of the elastic mode `n`, from zero, if its frequency is this.
    pub(crate) fn damping_ratio_at(&self, n: usize, omega_rad_s: f64) -> f64 {
        self.damping().of(Some(n), omega_rad_s)
    }

    fn damping(&self) -> Damping<'_> {
        Damping {
            ratio: self.damping_ratio,
            ratios: &self.damping_ratios,
            rayleigh: [self.rayleigh_mass_per_s, self.rayleigh_stiffness_s],
        }
    }

    /// The first `count` modes, with shapes at any location.
    pub(crate) fn modes(&self, count: usize) -> Result<BeamModes, InvalidInput> {
        require_count(count)?;
        let modes = || {
            self.damping().check()?;
            let modes = self.to_system()?.modes(count).map_err(|fault| self.in_given_fields(fault))?;
            let rigid = modes.rigid_body_count();
            let ratio = |(k, &omega): (usize, &f64)| self.damping().of(k.checked_sub(rigid), omega);
            let damping_ratios = modes.omega_rad_s().iter().enumerate().map(ratio).collect();
            Ok(BeamModes { modes, damping_ratios })
        };
        modes().map_err(|fault: InvalidInput| fault.within("structure"))
    }
}

impl Beam {
    /// The error of a property of a segment in terms of the fields that the segment gives.
    fn in_given_fields(&self, fault: InvalidInput) -> InvalidInput {
        let [_, Step::Index(i), _] = *fault.field.steps() else { return fault };
        match self.segments.get(i).and_then(|segment| segment.in_given_fields(&fault)) {
            Some(own) if fault.field.first() == Some("segments") => own.at(i).within("segments"),
            _ => fault,
        }
    }
}

/// The modes of a beam.
pub(crate) struct BeamModes {
    modes: beam_modes::Modes,
    damping_ratios: Vec<f64>,
}

impl BeamModes {
    /// Participation of the modes in a uniform acceleration (kg^1/2).
    pub(crate) fn participation_kg0_5(&self) -> Vec<f64> {
        self.modes.participation_kg0_5()
    }

    /// The modes with their shapes at a location on the beam.
    pub(crate) fn seen_from(&self, location_m: f64) -> Result<Vec<modal::Mode>, InvalidInput> {
        let shapes = self.modes.shapes_at(location_m).map_err(|fault| match fault.field.first() {
            Some("x_m") => fault.under("location_m"),
            _ => fault.within("structure"),
        })?;
        let each = self.modes.omega_rad_s().iter().zip(&self.damping_ratios).zip(shapes);
        let mode = |((&omega_rad_s, &damping_ratio), shape)| modal::Mode { omega_rad_s, damping_ratio, shape };
        Ok(each.map(mode).collect())
    }
}
