//! The loads on an assembly, and the motion of the ground.

use std::f64::consts::TAU;
use std::path::Path;

use invalid_input::most_extreme;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use vibroimpact_sim::assembly::Force;

use super::contact::Point;
use super::fields::FREQUENCY;
use super::schema::courses;
use crate::input::{Table, read_bytes};
use crate::scene::json::number;
use crate::scene::{InvalidInput, Location, SceneError, such_that, table_path};

/// A force on a point of a body, positive along `+x`: constant (`force_n`), harmonic (`force_n sin(2 pi frequency_hz t +
/// phase)`), or straight lines between values (`times_s` and `forces_n`, or a table), zero before the first and after the
/// last.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("oneOf" = courses(&["force_n"], "forces_n", true)))]
pub struct Load {
    /// Name of the body.
    pub body: String,
    /// Location on a beam, string or rod, from its left end (m); on a plate `[x, y]`.
    pub location_m: Option<Location>,
    /// Name of the point of a modal structure.
    pub location: Option<String>,
    /// The force, or its amplitude (N).
    pub force_n: Option<f64>,
    /// Frequency (Hz).
    pub frequency_hz: Option<f64>,
    /// Phase at the start (degrees); 0 when left out.
    pub phase_deg: Option<f64>,
    /// Times (s), ascending; equal neighbours make a jump.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub times_s: Vec<f64>,
    /// Forces at these times (N).
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub forces_n: Vec<f64>,
    /// A table of comma-separated values with the columns `time_s` and `force_n`, in the folder of the scene or below, in
    /// place of the two lists.
    pub file: Option<String>,
}

/// A motion of the ground along `x`. Displacements and velocities are then relative to the ground, in what is given and in
/// what is reported, and every body feels the inertial load of the ground's acceleration.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("oneOf" = courses(&["displacement_m", "acceleration_m_s2"], "accelerations_m_s2", false)))]
pub struct GroundMotion {
    /// Amplitude of a displacement `displacement_m sin(2 pi frequency_hz t + phase)` (m).
    pub displacement_m: Option<f64>,
    /// Amplitude of an acceleration, likewise, in its place (m/s^2).
    pub acceleration_m_s2: Option<f64>,
    /// Frequency (Hz).
    pub frequency_hz: Option<f64>,
    /// Phase at the start (degrees); 0 when left out.
    pub phase_deg: Option<f64>,
    /// Times of a measured acceleration (s), ascending.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub times_s: Vec<f64>,
    /// Accelerations at these times (m/s^2), with straight lines between them and zero outside.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub accelerations_m_s2: Vec<f64>,
    /// A table of comma-separated values with the columns `time_s` and `acceleration_m_s2`, in the folder of the scene or
    /// below, in place of the two lists.
    pub file: Option<String>,
}

/// One way to state a function of time.
struct Course<'a> {
    amplitude: (&'static str, Option<f64>),
    frequency_hz: Option<f64>,
    phase_deg: Option<f64>,
    times_s: &'a [f64],
    values: (&'static str, &'a [f64]),
    file: Option<&'a str>,
    /// Whether a value without a frequency is allowed, which is then constant.
    constant: bool,
}

impl Course<'_> {
    fn to_force(&self) -> Result<Force, InvalidInput> {
        let (name, amplitude) = self.amplitude;
        let (list, values) = self.values;
        if let Some(file) = self.file {
            let allowed = "replaced by its table, as AssemblyScene::read and AssemblyScene::read_tables do";
            return Err(InvalidInput::new("file", format!("{file:?}"), allowed));
        }
        let sampled = !self.times_s.is_empty() || !values.is_empty();
        for (field, value) in [(name, amplitude), ("frequency_hz", self.frequency_hz), ("phase_deg", self.phase_deg)] {
            let Some(value) = value else { continue };
            if sampled {
                let allowed = format!("left out in the presence of times_s and {list}");
                return Err(InvalidInput::new(field, number(value), allowed));
            }
            require_finite(field, value)?;
        }
        if sampled {
            return self.sampled();
        }
        let Some(force_n) = amplitude else {
            let allowed =
                format!("given, unless times_s and {list}, of at least two values each, or file take its place");
            return Err(InvalidInput::missing(name, allowed));
        };
        match (self.frequency_hz, self.phase_deg) {
            (Some(frequency_hz), phase_deg) => {
                if !FREQUENCIES_HZ.contains(&frequency_hz) {
                    return Err(InvalidInput::new("frequency_hz", number(frequency_hz), FREQUENCY));
                }
                let phase_rad = phase_deg.unwrap_or(0.0).to_radians();
                Ok(Force::Harmonic { force_n, omega_rad_s: TAU * frequency_hz, phase_rad })
            }
            (None, None) if self.constant => Ok(Force::Constant { force_n }),
            (None, Some(phase_deg)) if self.constant => {
                Err(InvalidInput::new("phase_deg", number(phase_deg), "left out in the absence of frequency_hz"))
            }
            (None, _) => Err(InvalidInput::missing("frequency_hz", FREQUENCY)),
        }
    }

    fn sampled(&self) -> Result<Force, InvalidInput> {
        let (list, values) = self.values;
        let times = self.times_s;
        if times.len() != values.len() || times.len() < 2 {
            let (field, length, other, count) = if times.len() < 2 {
                ("times_s", times.len(), list, values.len())
            } else {
                (list, values.len(), "times_s", times.len())
            };
            let allowed = format!("a list of at least two values, and as long as {other}, which has {count}");
            return Err(InvalidInput::new(field, format!("{length} values"), allowed));
        }
        for (field, values) in [("times_s", times), (list, values)] {
            for (i, value) in values.iter().enumerate() {
                require_finite((field, i), *value)?;
            }
        }
        if let Some(i) = (1..times.len()).find(|&i| times[i] < times[i - 1]) {
            let allowed = format!("not less than the time before, {}", number(times[i - 1]));
            return Err(InvalidInput::new(("times_s", i), number(times[i]), allowed));
        }
        Ok(Force::Sampled { times_s: times.to_vec(), forces_n: values.to_vec() })
    }
}

/// As [`FREQUENCY`] says.
const FREQUENCIES_HZ: std::ops::RangeInclusive<f64> = 1e-12..=LARGEST;

/// The largest number that the solver works with.
pub(super) const LARGEST: f64 = 1e30;

/// Checks that a number is in the range of the solver.
pub(super) fn require_finite(field: impl Into<invalid_input::Path>, value: f64) -> Result<(), InvalidInput> {
    if value.abs() <= LARGEST {
        Ok(())
    } else {
        Err(InvalidInput::new(field, number(value), "a finite number of at most 1e30 in size"))
    }
}

impl Load {
    /// The point of action.
    pub(super) fn point(&self) -> Point {
        Point { body: self.body.clone(), location_m: self.location_m, location: self.location.clone() }
    }

    /// The force as a function of time.
    pub(super) fn to_force(&self) -> Result<Force, InvalidInput> {
        let course = Course {
            amplitude: ("force_n", self.force_n),
            frequency_hz: self.frequency_hz,
            phase_deg: self.phase_deg,
            times_s: &self.times_s,
            values: ("forces_n", &self.forces_n),
            file: self.file.as_deref(),
            constant: true,
        };
        course.to_force()
    }

    pub(super) fn read_table(&mut self, folder: &Path) -> Result<(), SceneError> {
        if let Some(file) = &self.file {
            refuse_lists(&[("times_s", &self.times_s), ("forces_n", &self.forces_n)])?;
            (self.times_s, self.forces_n) = read_history(folder, file, "force_n")?;
            self.file = None;
        }
        Ok(())
    }
}

impl GroundMotion {
    /// The acceleration of the ground as a function of time, in place of a force.
    pub(super) fn to_acceleration(&self) -> Result<Force, InvalidInput> {
        let course = |amplitude| Course {
            amplitude,
            frequency_hz: self.frequency_hz,
            phase_deg: self.phase_deg,
            times_s: &self.times_s,
            values: ("accelerations_m_s2", &self.accelerations_m_s2),
            file: self.file.as_deref(),
            constant: false,
        };
        match (self.displacement_m, self.acceleration_m_s2) {
            (Some(_), Some(acceleration)) => {
                let allowed = "left out in the presence of displacement_m";
                Err(InvalidInput::new("acceleration_m_s2", number(acceleration), allowed))
            }
            (Some(_), None) => match course(("displacement_m", self.displacement_m)).to_force()? {
                // the second derivative of a sine
                Force::Harmonic { force_n: displacement_m, omega_rad_s, phase_rad } => {
                    let force_n = -displacement_m * omega_rad_s * omega_rad_s;
                    require_acceleration(force_n, displacement_m, self.frequency_hz.unwrap_or_default())?;
                    Ok(Force::Harmonic { force_n, omega_rad_s, phase_rad })
                }
                other => Ok(other),
            },
            (None, acceleration) => course(("acceleration_m_s2", acceleration)).to_force(),
        }
    }

    pub(super) fn read_table(&mut self, folder: &Path) -> Result<(), SceneError> {
        if let Some(file) = &self.file {
            refuse_lists(&[("times_s", &self.times_s), ("accelerations_m_s2", &self.accelerations_m_s2)])?;
            (self.times_s, self.accelerations_m_s2) = read_history(folder, file, "acceleration_m_s2")?;
            self.file = None;
        }
        Ok(())
    }
}

/// Refuses an acceleration that is out of range under the more extreme of the fields from which it follows.
fn require_acceleration(acceleration_m_s2: f64, displacement_m: f64, frequency_hz: f64) -> Result<(), InvalidInput> {
    require_finite("acceleration_m_s2", acceleration_m_s2).map_err(|fault| {
        // relative to usual sizes
        let fields = [("displacement_m", displacement_m, 1e-3), ("frequency_hz", frequency_hz, 1e2)];
        let relative = fields.map(|(field, value, usual)| ((field, value), value / usual));
        let ((field, value), _) = most_extreme(relative).unwrap_or_default();
        InvalidInput::new(field, number(value), such_that("the acceleration of the ground in m/s^2", &fault))
    })
}

fn refuse_lists(lists: &[(&str, &Vec<f64>)]) -> Result<(), InvalidInput> {
    lists.iter().find(|(_, list)| !list.is_empty()).map_or(Ok(()), |(field, list)| {
        Err(InvalidInput::new(*field, format!("{} values", list.len()), "left out in the presence of file"))
    })
}

/// The two columns of a table, for a scene in `folder`.
fn read_history(folder: &Path, file: &str, column: &str) -> Result<(Vec<f64>, Vec<f64>), SceneError> {
    let needed = format!("a table of comma-separated values whose line of names holds time_s and {column}");
    let bytes = read_bytes(&folder.join(table_path("file", file)?))?;
    let read = || {
        let table = Table::parse(&bytes, &needed)?;
        let list = |name: &str| {
            let place = table.needed_column(name, &needed)?;
            table.rows.iter().map(|row| row.number(place, name)).collect::<Result<Vec<f64>, InvalidInput>>()
        };
        let (times_s, values) = (list("time_s")?, list(column)?);
        InvalidInput::unless(times_s.len() > 1, "number of rows", times_s.len(), "at least 2")?;
        Ok((times_s, values))
    };
    Ok(read().map_err(|fault: InvalidInput| fault.in_place(file))?)
}
