//! Motion and force of an impact on an infinite structure over time.

use vibroimpact_sim::infinite::{Scale, Solution};

use super::{Sample, samples, telling_time};
use crate::export::Table;

/// Samples of each kind in the history.
pub(super) const SAMPLES: usize = 1000;

/// Factors from the units of the solution, and the resulting units.
pub(super) struct Units {
    pub time: f64,
    pub force: f64,
    pub displacement: f64,
    pub speed: f64,
    /// Suffixes of the column names of time, force, displacement and speed.
    pub suffixes: [&'static str; 4],
    /// The same for axes.
    pub names: [&'static str; 4],
}

impl Units {
    pub fn new(scale: Option<&Scale>) -> Units {
        match scale {
            Some(scale) => Units {
                time: scale.time_s,
                force: scale.force_n,
                displacement: scale.displacement_m,
                speed: scale.speed_m_s,
                suffixes: ["_s", "_n", "_m", "_m_s"],
                names: ["s", "N", "m", "m/s"],
            },
            None => Units {
                time: 1.0,
                force: 1.0,
                displacement: 1.0,
                speed: 1.0,
                suffixes: [""; 4],
                names: ["T", "F", "v T", "v"],
            },
        }
    }
}

/// Motion and force over time: what `history.csv` holds, in SI units with `scale`, otherwise in units of the solution.
/// As elsewhere in this crate, displacements and velocities are positive away from the structure.
/// They extend until `until` (units of `T`) as far as the motion is known, or until shortly after the last contact.
pub fn history(solution: &Solution, scale: Option<&Scale>, until: Option<f64>) -> Table {
    let samples = samples(solution, until.unwrap_or_else(|| telling_time(solution)), SAMPLES);
    let units = Units::new(scale);
    let [time, force, displacement, speed] = units.suffixes;
    let column = |name: String, of: &dyn Fn(&Sample) -> f64| (name, samples.iter().map(of).collect());
    // subtracted from zero, so that zero keeps its sign
    Table {
        columns: vec![
            column(format!("time{time}"), &|s| units.time * s.time),
            column(format!("structure_displacement{displacement}"), &|s| {
                units.displacement * s.state.structure_displacement
            }),
            column(format!("striker_displacement{displacement}"), &|s| {
                units.displacement * s.state.striker_displacement
            }),
            column(format!("structure_velocity{speed}"), &|s| units.speed * s.state.structure_velocity),
            column(format!("striker_velocity{speed}"), &|s| units.speed * s.state.striker_velocity),
            column(format!("compression{displacement}"), &|s| units.displacement * s.state.compression),
            column(format!("force{force}"), &|s| units.force * s.state.force),
        ],
    }
}
