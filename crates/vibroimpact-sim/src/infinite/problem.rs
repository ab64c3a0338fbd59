//! The problem and the settings of its solution.

use invalid_input::InvalidInput;

/// Smallest and largest number of nodes a panel may have.
pub(super) const NODES: std::ops::RangeInclusive<usize> = 8..=32;

/// Smallest and largest `S` that [`solve`](super::solve()) accepts.
pub const S_RANGE: std::ops::RangeInclusive<f64> = 1e-12..=1e10;

/// The struck structure, which determines the kernel `K` of the Volterra equation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Structure {
    /// Infinite Euler-Bernoulli beam: `K = sqrt(t)` (thesis Eq. 2.1).
    Beam,
    /// Thin infinite plate: `K = 1` (Zener 1941; thesis 2.1).
    Plate,
}

invalid_input::names!(Structure, "structure", { Beam: "beam", Plate: "plate" });

/// Accuracy and extent of a solution.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Collocation nodes per panel, 8 to 32. Default 20.
    pub nodes: usize,
    /// Largest impulse of the last two Legendre coefficients of the force on a panel, relative to those of the panels
    /// before, 1e-14 to 1e-3. Default 1e-10.
    pub tolerance: f64,
    /// Sustained contact is followed at least up to this time (units of `T`). Default 0: as far as
    /// it takes to know that it lasts.
    pub horizon: f64,
    /// Whether to solve a second time with more nodes, for
    /// [`Solution::relative_uncertainty`](super::Solution::relative_uncertainty). Default true.
    pub estimate_uncertainty: bool,
    /// Most panels to try before stopping ([`StopReason::Steps`](crate::StopReason)). Default 200,000. Only `S`
    /// close above the critical value needs many: the separations number 33 at `S = 1.6`, 120 at
    /// a relative distance of 1e-3, 1,008 at 1e-5, 4,401 at 1e-6 and more than 16,000 at 1e-7; nearer still times leave
    /// the range of numbers first ([`StopReason::DigitsExhausted`](crate::StopReason)).
    pub max_panels: usize,
    /// Most contacts to follow: 1 for the first alone. Where the body would come back once more, the run stops
    /// ([`StopReason::SubImpacts`](crate::StopReason)), known up to the next touch. Default: no limit.
    pub max_sub_impacts: usize,
}

impl Default for Settings {
    fn default() -> Settings {
        Settings {
            nodes: 20,
            tolerance: 1e-10,
            horizon: 0.0,
            estimate_uncertainty: true,
            max_panels: 200_000,
            max_sub_impacts: usize::MAX,
        }
    }
}

impl Settings {
    pub(super) fn check(&self) -> Result<(), InvalidInput> {
        InvalidInput::unless(NODES.contains(&self.nodes), "nodes", self.nodes, "a number from 8 to 32")?;
        let tolerance = (1e-14..=1e-3).contains(&self.tolerance);
        InvalidInput::unless(tolerance, "tolerance", self.tolerance, "a number from 1e-14 to 1e-3")?;
        let horizon = (0.0..=1e12).contains(&self.horizon);
        InvalidInput::unless(horizon, "horizon", self.horizon, "a number from 0 to 1e12, in units of T")?;
        InvalidInput::unless(self.max_panels > 0, "max_panels", self.max_panels, "at least 1")?;
        InvalidInput::unless(self.max_sub_impacts > 0, "max_sub_impacts", self.max_sub_impacts, "at least 1")
    }
}
