//! The scene as input of all models: striker, law, the scales of the contact, and the modes that are needed.

use contact_models::Law;
use vibroimpact_sim::modal::{Mode, Settings, Striker, Structure};

use super::wall::Wall;
use super::{Cost, DEFAULT_TOLERANCE, Kept};
use crate::impact::Impact;
use crate::in_scene::in_scene;
use crate::scene::json::number;
use crate::scene::{self, COMPLETE, InvalidInput, Location, Place, Scene, chooses_modes, compliance, require_elastic};

/// Tolerances that can be requested where the program chooses the modes.
const TOLERANCES: std::ops::RangeInclusive<f64> = 1e-10..=0.5;

/// Largest number of modes that is tried.
const MOST_MODES: usize = 4000;
/// A mode that takes up less than this share of the tolerance of the striker's energy counts as not excited.
const UNEXCITED: f64 = 1e-6;

/// Modes of a beam are computed in multiples of this.
const SIZES: usize = 16;

/// A scene, ready for any model.
pub(super) struct Pose<'a> {
    pub scene: &'a Scene,
    pub striker: Striker,
    pub law: Law,
    /// Requested accuracy of the restitution.
    pub tolerance: f64,
    pub wall: Wall,
    pub source: Source<'a>,
    pub kept: &'a mut Kept,
}

/// Source of the modes.
pub(super) enum Source<'a> {
    /// A beam: as many modes as are requested.
    Beam { beam: &'a scene::Beam, location_m: f64, whole_m_n: f64, modes: Vec<Mode> },
    /// A string or plate: as many modes as are requested.
    Computed {
        structure: &'a scene::Structure,
        place: Place<'a>,
        whole_m_n: f64,
        /// Uncertainty of the static compliance.
        uncertain_m_n: f64,
        modes: Vec<Mode>,
    },
    /// A structure given by its modes and, optionally, its whole static compliance.
    Listed { modes: Vec<Mode>, whole_m_n: Option<f64> },
}

impl<'a> Pose<'a> {
    /// Converts a scene with a finite structure.
    pub fn new(scene: &'a Scene, kept: &'a mut Kept) -> Result<Pose<'a>, InvalidInput> {
        let (striker, law) = scene.striker_and_law(|striker| scene.meets_m_s(striker))?;
        let chosen = chooses_modes(scene);
        let settings = Settings::default();
        let tolerance = scene.tolerance.unwrap_or(if chosen { DEFAULT_TOLERANCE } else { settings.tolerance });
        if chosen && !TOLERANCES.contains(&tolerance) {
            let allowed = "a number from 1e-10 to 0.5, because the program chooses the modes";
            return Err(InvalidInput::new("tolerance", number(tolerance), allowed));
        }
        striker.check().map_err(in_scene)?;
        if !chosen {
            // the tolerance is the solver's own
            Settings { tolerance, ..settings }.check().map_err(in_scene)?;
        }
        let source = match &scene.structure {
            scene::Structure::Beam(beam) => {
                // an empty list of modes checks location, segments and damping
                scene.structure.modes(scene.place(), Some(0))?;
                let location_m = scene.location_m.map_or(Ok(f64::NAN), Location::along)?;
                let whole_m_n = scene.structure.static_compliance_m_n(scene.place())?;
                Source::Beam { beam, location_m, whole_m_n, modes: Vec::new() }
            }
            structure if structure.is_computed() => {
                structure.modes(scene.place(), Some(0))?;
                let (whole_m_n, uncertain_m_n) = structure.static_compliance_with_uncertainty_m_n(scene.place())?;
                Source::Computed { structure, place: scene.place(), whole_m_n, uncertain_m_n, modes: Vec::new() }
            }
            listed => {
                let modes = listed.modes(scene.place(), scene.modes.count())?;
                let modes = scene.solvable(Structure { modes })?.modes;
                let whole_m_n = match listed {
                    scene::Structure::Modal(listed) if listed.gives_compliance(scene.location.as_deref()) => {
                        let whole_m_n = scene.structure.static_compliance_m_n(scene.place())?;
                        if scene.residual_compliance.unwrap_or(chosen) {
                            require_elastic(&modes, whole_m_n)?;
                        }
                        Some(whole_m_n)
                    }
                    _ => None,
                };
                Source::Listed { modes, whole_m_n }
            }
        };
        let striker = Striker { speed_m_s: scene.meets_m_s(&striker), ..striker };
        let wall = Wall::new(&law, &striker);
        Ok(Pose { scene, striker, law, tolerance, wall, source, kept })
    }

    /// The impact on these modes, of which the last are remainder modes.
    pub fn impact(&self, structure: Structure, remainder_modes: usize, settings: Settings) -> Impact {
        let Pose { scene, law, .. } = self;
        let (law, gravity_m_s2) = (*law, scene.gravity_m_s2);
        let striker = Striker { speed_m_s: scene.striker.speed_m_s, ..self.striker };
        let start = scene.fall_from(structure.modes.len());
        Impact { structure, remainder_modes, striker, law, start, gravity_m_s2, settings }
    }

    /// Whether the striker moves towards the structure.
    pub fn approaches(&self) -> bool {
        self.striker.speed_m_s > 0.0
    }

    /// Those of the first `count` modes that a force at the location excites and, if requested and known, remainder modes for the
    /// modes beyond `count`, with their number. A slow mode that is hardly excited is omitted: it does not move during the contact,
    /// and its static compliance is not part of the remainder modes.
    pub fn structure(&mut self, count: usize, cost: &mut Cost) -> Result<(Structure, usize), InvalidInput> {
        let least = UNEXCITED * self.tolerance / (4.0 * self.striker.mass_kg);
        let scene = self.scene;
        let structure = &scene.structure;
        let whole_m_n = self.source.whole_m_n().filter(|_| self.scene.residual_compliance != Some(false));
        let known = self.first(structure.enough_for_remainder(scene.place(), count), cost)?;
        let count = count.min(known.len());
        let remainder = match whole_m_n {
            Some(whole_m_n) => structure.remainder(known, count, whole_m_n)?,
            None => Vec::new(),
        };
        let mut modes: Vec<Mode> = known[..count].iter().filter(|mode| mode.shape.powi(2) > least).copied().collect();
        modes.extend(&remainder);
        Ok((scene.solvable(Structure { modes })?, remainder.len()))
    }

    /// Whether the listed modes are all modes of the structure: they make up its static compliance.
    pub fn is_complete(&self) -> bool {
        match &self.source {
            Source::Listed { modes, whole_m_n: Some(whole_m_n) } => {
                let listed = compliance(modes);
                whole_m_n - listed <= COMPLETE * listed
            }
            _ => false,
        }
    }

    /// The first `count` modes, or all of a list.
    pub fn first(&mut self, count: usize, cost: &mut Cost) -> Result<&[Mode], InvalidInput> {
        match &mut self.source {
            Source::Beam { beam, location_m, modes, .. } => {
                if modes.len() < count {
                    // in few sizes, so that scenes of one beam can share them
                    let size = count.next_multiple_of(SIZES);
                    *modes = self.kept.modes.first(beam, size)?.seen_from(*location_m)?;
                    cost.modes_computed += size as u64;
                }
                Ok(modes.get(..count).unwrap_or(modes))
            }
            Source::Computed { structure, place, modes, .. } => {
                if modes.len() < count {
                    // twice as many as before: the modes of a plate are computed together, at a cost that grows as the cube of
                    // their number
                    let size = count.max(2 * modes.len()).next_multiple_of(SIZES);
                    let size = size.min(structure.most_modes().max(count));
                    *modes = structure.modes_with(*place, Some(size), &mut self.kept.modes)?;
                    cost.modes_computed += size as u64;
                }
                Ok(modes.get(..count).unwrap_or(modes))
            }
            Source::Listed { modes, .. } => Ok(modes.get(..count).unwrap_or(modes)),
        }
    }
}

impl Source<'_> {
    /// Largest number of modes.
    pub fn most(&self) -> usize {
        match self {
            Source::Beam { .. } => MOST_MODES,
            Source::Computed { structure, .. } => structure.most_modes(),
            Source::Listed { modes, .. } => modes.len(),
        }
    }

    /// Uncertainty of the static compliance of a structure whose modes are computed (m/N).
    pub fn uncertain_m_n(&self) -> f64 {
        match self {
            Source::Computed { uncertain_m_n, .. } => *uncertain_m_n,
            Source::Beam { .. } | Source::Listed { .. } => 0.0,
        }
    }

    /// Static compliance of the whole structure at the location, if it is known (m/N).
    pub fn whole_m_n(&self) -> Option<f64> {
        match self {
            Source::Beam { whole_m_n, .. } | Source::Computed { whole_m_n, .. } => Some(*whole_m_n),
            Source::Listed { whole_m_n, .. } => *whole_m_n,
        }
    }
}
