//! The data of a panel in the solution.

use super::panel::Panel;
use super::rule::{Kind, Tables};

/// A panel of the solution.
#[derive(Debug, Clone)]
pub(super) struct Piece {
    pub kind: Kind,
    /// Time from touch to the panel's start, in natural units.
    pub start: f64,
    pub h: f64,
    /// Compression at the nodes.
    pub x: Vec<f64>,
    /// Force at the nodes in the units of the impact; `None` where it is `xi_+^(3/2)`.
    pub force: Option<Vec<f64>>,
    /// `int xi_+^(3/2)` from touch to the panel's start, in natural units.
    pub impulse: f64,
    /// `int (start - theta) xi_+^(3/2)` from touch to the panel's start.
    pub moment: f64,
}

impl Piece {
    /// The panel again, on the time origin of touch.
    pub fn panel(&self, tables: &Tables) -> Panel {
        match &self.force {
            Some(f) => Panel::with_force(tables, self.kind, self.start, self.h, self.x.clone(), f.clone()),
            None => Panel::new(tables, self.kind, self.start, self.h, self.x.clone()),
        }
    }
}
