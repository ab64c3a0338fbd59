//! The location of impact, and the largest number of modes of a scene.

use invalid_input::InvalidInput;

use super::fields;
use super::location::Location;

/// A location on a structure: coordinates, or the name of a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Place<'a> {
    pub location_m: Option<Location>,
    pub location: Option<&'a str>,
}

impl Place<'_> {
    /// Rejects a location that is given; `allowed` states the reason.
    pub(crate) fn require_none(&self, allowed: &str) -> Result<(), InvalidInput> {
        self.require_no_distance(allowed)?;
        self.require_no_name(allowed)
    }

    /// The location on a structure with coordinates.
    pub(crate) fn on_structure(&self) -> Result<Location, InvalidInput> {
        self.require_no_name("left out, because the location on this structure is stated by location_m")?;
        let missing = || InvalidInput::missing("location_m", fields::allowed("location_m").unwrap_or_default());
        self.location_m.ok_or_else(missing)
    }

    pub(crate) fn require_no_distance(&self, allowed: &str) -> Result<(), InvalidInput> {
        match self.location_m {
            Some(location_m) => Err(InvalidInput::new("location_m", location_m.to_string(), allowed)),
            None => Ok(()),
        }
    }

    pub(crate) fn require_no_name(&self, allowed: &str) -> Result<(), InvalidInput> {
        match self.location {
            Some(location) => Err(InvalidInput::new("location", format!("{location:?}"), allowed)),
            None => Ok(()),
        }
    }
}

/// Largest number of modes that a scene may request.
pub const MOST_MODES: usize = 10_000;

pub(crate) fn require_count(count: usize) -> Result<(), InvalidInput> {
    if count <= MOST_MODES {
        Ok(())
    } else {
        Err(InvalidInput::new("modes", count.to_string(), fields::allowed("modes").unwrap_or_default()))
    }
}
