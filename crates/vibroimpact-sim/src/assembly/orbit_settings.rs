//! Settings of the search for a periodic motion.

#[cfg(doc)]
use super::{CommonPeriod, Settings};
use invalid_input::InvalidInput;

/// Settings of the search for a periodic motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OrbitSettings {
    /// Common periods of the loads ([`CommonPeriod`]) after which the motion repeats. Default 1.
    pub forcing_periods: u32,
    /// Periods that are followed from the start before Newton's method. Default 100.
    pub transient_periods: u32,
    /// Periods that are followed in search of near returns if Newton's method fails after the transient. Default 1500.
    pub search_periods: u32,
    /// Tolerance of the runs, see [`Settings::tolerance`]. Default 1e-11.
    pub tolerance: f64,
    /// Largest difference `|P(x) - x|` of a periodic motion, relative to its size. Default 1e-9.
    pub closure: f64,
    /// Largest number of Newton iterations. Default 30.
    pub max_iterations: u32,
}

impl Default for OrbitSettings {
    fn default() -> OrbitSettings {
        OrbitSettings {
            forcing_periods: 1,
            transient_periods: 100,
            search_periods: 1500,
            tolerance: 1e-11,
            closure: 1e-9,
            max_iterations: 30,
        }
    }
}

impl OrbitSettings {
    pub(crate) fn check(&self) -> Result<(), InvalidInput> {
        InvalidInput::unless(self.forcing_periods > 0, "forcing_periods", self.forcing_periods, "at least 1")?;
        InvalidInput::unless(self.max_iterations > 0, "max_iterations", self.max_iterations, "at least 1")?;
        let closure = (1e-13..=0.1).contains(&self.closure);
        InvalidInput::unless(closure, "closure", self.closure, "a number from 1e-13 to 0.1")
    }
}
