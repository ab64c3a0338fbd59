//! Settings for following a branch.

use crate::assembly::orbit_settings::OrbitSettings;
use invalid_input::InvalidInput;

/// Settings for following a branch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BranchSettings {
    /// Settings for each periodic motion.
    pub orbit: OrbitSettings,
    /// Value of the parameter at which the branch starts.
    pub from: f64,
    /// Value towards which the branch is followed; it ends there.
    pub to: f64,
    /// First step, as a fraction of the range. Default 0.02.
    pub step: f64,
    /// Longest step, as a fraction of the range. Default 0.05.
    pub longest_step: f64,
    /// Largest number of orbits. Default 500.
    pub max_orbits: usize,
}

impl BranchSettings {
    /// The defaults, for this range.
    pub fn over(from: f64, to: f64) -> BranchSettings {
        let orbit = OrbitSettings::default();
        BranchSettings { orbit, from, to, step: 0.02, longest_step: 0.05, max_orbits: 500 }
    }

    /// The range in ascending order.
    pub(super) fn limits(&self) -> (f64, f64) {
        (self.from.min(self.to), self.from.max(self.to))
    }

    pub(super) fn check(&self) -> Result<(), InvalidInput> {
        self.orbit.check()?;
        let range = self.from.is_finite() && self.to.is_finite() && self.from != self.to;
        InvalidInput::unless(range, "to", self.to, "a finite number other than the start of the branch")?;
        let step = self.step > 0.0 && self.step <= 0.5;
        InvalidInput::unless(
            step,
            "step",
            self.step,
            "a fraction of the range, greater than 0 and not greater than 0.5",
        )?;
        let longest = self.longest_step >= self.step && self.longest_step <= 0.5;
        InvalidInput::unless(longest, "longest_step", self.longest_step, "a fraction of the range from step to 0.5")?;
        InvalidInput::unless(self.max_orbits > 0, "max_orbits", self.max_orbits, "at least 1")
    }
}
