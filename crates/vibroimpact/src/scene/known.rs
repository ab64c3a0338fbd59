//! Modes computed for earlier scenes of the same structure.

use invalid_input::InvalidInput;

use super::beam::{Beam, BeamModes};
use super::plate::Plate;

/// Cached modes of the last beam and of the last plate by their requested number, which scenes of one structure share.
#[derive(Default)]
pub(crate) struct KnownModes {
    pub(super) beams: Sets<Beam, BeamModes>,
    pub(super) plates: Sets<Plate, beam_modes::PlateModes>,
}

/// Sets of modes of one structure.
pub(super) struct Sets<S, M> {
    structure: Option<S>,
    sets: Vec<(usize, M)>,
}

impl<S, M> Default for Sets<S, M> {
    fn default() -> Sets<S, M> {
        Sets { structure: None, sets: Vec::new() }
    }
}

/// Largest number of cached sets.
const MOST_SETS: usize = 32;

impl<S: Clone + PartialEq, M> Sets<S, M> {
    /// The first `count` modes of a structure. A larger set is not truncated to this size: it may differ in the last bit, and
    /// results must not depend on earlier requests.
    pub fn first(
        &mut self,
        structure: &S,
        count: usize,
        compute: impl Fn(&S, usize) -> Result<M, InvalidInput>,
    ) -> Result<&M, InvalidInput> {
        if self.structure.as_ref() != Some(structure) {
            *self = Sets { structure: Some(structure.clone()), sets: Vec::new() };
        }
        let place = match self.sets.iter().position(|(size, _)| *size == count) {
            Some(place) => place,
            None => {
                let modes = compute(structure, count)?;
                if self.sets.len() == MOST_SETS {
                    self.sets.remove(0);
                }
                self.sets.push((count, modes));
                self.sets.len() - 1
            }
        };
        Ok(&self.sets[place].1)
    }
}

impl KnownModes {
    /// The first `count` modes of a beam.
    pub(crate) fn first(&mut self, beam: &Beam, count: usize) -> Result<&BeamModes, InvalidInput> {
        self.beams.first(beam, count, Beam::modes)
    }
}
