//! Output of impacts on infinite beams and plates: [`Summary`] for programs, [`text`] for the terminal, [`files`] for tables,
//! [`picture`] for a figure. The solver is [`vibroimpact_sim::infinite`].

#[cfg(feature = "files")]
mod files;
mod history;
mod pose;
mod text;

use invalid_input::InvalidInput;
use serde::Serialize;
use vibroimpact_sim::StopReason;
use vibroimpact_sim::infinite::{
    CriticalS, MOST_TURNING_POINTS, Outcome, Scale, Solution, State, TurningPoint, critical_s, turning_points,
};

#[cfg(feature = "files")]
pub use files::{files, picture};
pub use history::history;
pub use pose::Posed;
pub use text::{text, turning_points_text};

/// The object that `infinite-beam --json` prints. Times are in units of `T`, speeds of `v`, forces of `F` (thesis
/// Eqs. 2.9 and 2.10).
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Summary {
    /// The nondimensional number `S` of Hertz contact; null for other laws.
    pub s: Option<f64>,
    /// `rebound`, `sustained` or `stopped`.
    pub outcome: &'static str,
    /// The reason why it stopped before the end of the impact, as a word of [`StopReason`]; null if it did not.
    #[serde(serialize_with = "crate::stop_word::word")]
    pub stopped_by: Option<StopReason>,
    /// Number of separations.
    pub separations: usize,
    /// Number of separations, from the first, that a solution of higher resolution has too; later ones are not known.
    pub certain_separations: Option<usize>,
    /// Speed away from the structure after the last separation over the speed of impact; null unless the striker
    /// rebounds.
    pub rebound_ratio: Option<f64>,
    /// The same after the first separation, below zero if the striker still moves towards the structure; null if
    /// there is none.
    pub first_rebound_ratio: Option<f64>,
    /// Largest relative difference, over all contacts, from a solution of higher resolution; null if the two differ
    /// in the number of contacts.
    pub relative_error: Option<f64>,
    /// Decimal digits that the two solutions agree on.
    pub digits: Option<f64>,
    /// The contacts in order of time.
    pub contacts: Vec<Contact>,
    /// The same in physical units, if the impact was stated in them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub physical: Option<Physical>,
}

/// One contact.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Contact {
    /// Touch.
    pub start: f64,
    /// Separation; null if the contact does not end.
    pub end: Option<f64>,
    /// From touch to separation, with its own relative precision.
    pub duration: Option<f64>,
    /// Rate of compression at touch.
    pub closing_speed: f64,
    /// Largest force.
    pub peak_force: f64,
}

/// An impact in physical units.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Physical {
    /// Unit of time `T`.
    pub time_unit_s: f64,
    /// Unit of force `F`.
    pub force_unit_n: f64,
    /// Unit of displacement `v T`.
    pub displacement_unit_m: f64,
    /// Speed of impact `v`.
    pub speed_m_s: f64,
    /// Velocity of the striker at the end, positive away from the structure; null unless it rebounds.
    pub rebound_velocity_m_s: Option<f64>,
    /// The contacts in order of time.
    pub contacts: Vec<PhysicalContact>,
}

/// One contact in physical units.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct PhysicalContact {
    /// Touch.
    pub start_s: f64,
    /// Separation; null if the contact does not end.
    pub end_s: Option<f64>,
    /// Largest force.
    pub peak_force_n: f64,
}

impl Summary {
    /// Collects a solution for printing, in physical units too if they are given.
    ///
    /// ```
    /// use vibroimpact::infinite::Summary;
    /// use vibroimpact::vibroimpact_sim::infinite::{Settings, Structure, solve};
    /// let summary = Summary::new(&solve(Structure::Beam, 15.0, &Settings::default())?, None);
    /// assert_eq!((summary.outcome, summary.separations), ("sustained", 4));
    /// # Ok::<(), vibroimpact::vibroimpact_sim::InvalidInput>(())
    /// ```
    pub fn new(solution: &Solution, scale: Option<&Scale>) -> Summary {
        let contacts: Vec<Contact> = solution
            .sub_impacts
            .iter()
            .zip(solution.peak_forces())
            .map(|(contact, peak_force)| Contact {
                start: contact.start,
                end: contact.end,
                duration: contact.duration,
                closing_speed: contact.closing_speed,
                peak_force,
            })
            .collect();
        Summary {
            s: solution.s,
            outcome: solution.outcome.as_str(),
            stopped_by: solution.outcome.stopped_by(),
            separations: solution.separations(),
            certain_separations: solution.certain_separations,
            rebound_ratio: solution.rebound_ratio(),
            first_rebound_ratio: solution.first_rebound_ratio(),
            relative_error: solution.relative_uncertainty.filter(|error| error.is_finite()),
            digits: solution.digits(),
            physical: scale.map(|scale| Physical::new(scale, solution.rebound_ratio(), &contacts)),
            contacts,
        }
    }
}

impl Physical {
    fn new(scale: &Scale, rebound_ratio: Option<f64>, contacts: &[Contact]) -> Physical {
        let contact = |contact: &Contact| PhysicalContact {
            start_s: scale.time_s * contact.start,
            end_s: contact.end.map(|end| scale.time_s * end),
            peak_force_n: scale.force_n * contact.peak_force,
        };
        Physical {
            time_unit_s: scale.time_s,
            force_unit_n: scale.force_n,
            displacement_unit_m: scale.displacement_m,
            speed_m_s: scale.speed_m_s,
            rebound_velocity_m_s: rebound_ratio.map(|ratio| scale.speed_m_s * ratio),
            contacts: contacts.iter().map(contact).collect(),
        }
    }
}

/// The object that `infinite-beam turning-points --json` prints.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TurningPoints {
    /// The `S` above which the first separation is not the last.
    pub critical_s: f64,
    /// Estimate of its absolute error.
    pub critical_s_uncertainty: f64,
    /// The `S` at which the n-th separation disappears.
    pub turning_points: Vec<Turning>,
}

/// One turning point.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Turning {
    /// Number of the separation, from 1.
    pub n: usize,
    /// The separation exists for smaller `S`.
    pub s: f64,
    /// Estimate of the absolute error of `s`.
    pub uncertainty: f64,
}

impl TurningPoints {
    /// The critical `S` and the first `count` turning points, computed.
    ///
    /// # Errors
    /// A count that is not from 1 to [`MOST_TURNING_POINTS`].
    pub fn first(count: usize) -> Result<TurningPoints, InvalidInput> {
        if !(1..=MOST_TURNING_POINTS).contains(&count) {
            let allowed = format!("a whole number from 1 to {MOST_TURNING_POINTS}");
            return Err(InvalidInput::new("count", count.to_string(), allowed));
        }
        Ok(TurningPoints::new(critical_s(), &turning_points(count)?))
    }

    /// Collects turning points for printing.
    pub fn new(critical: CriticalS, points: &[TurningPoint]) -> TurningPoints {
        let turning = |&TurningPoint { n, s, uncertainty }: &TurningPoint| Turning { n, s, uncertainty };
        TurningPoints {
            critical_s: critical.s,
            critical_s_uncertainty: critical.uncertainty,
            turning_points: points.iter().map(turning).collect(),
        }
    }
}

/// Motion at one time (units of `T`).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// Time since first touch.
    pub time: f64,
    /// Motion and force.
    pub state: State,
}

/// Samples the motion until a time, densely enough for a picture on a linear and on a logarithmic axis of time: evenly,
/// in equal ratios, and within each contact anew. `count` is the number of samples of each kind.
pub fn samples(solution: &Solution, until: f64, count: usize) -> Vec<Sample> {
    let until = until.min(solution.known_until);
    let count = count.max(2);
    let first = solution.sub_impacts.first().and_then(|contact| contact.end).unwrap_or(until).min(until);
    let least = 1e-3 * first;
    let ratio = (until / least).ln();
    let even = (0..=count).map(|i| until * i as f64 / count as f64);
    let in_ratio = (0..count).map(|i| least * (ratio * i as f64 / count as f64).exp());
    let sample = |time: f64| solution.at(time).map(|state| Sample { time, state });
    let mut samples: Vec<Sample> = even.chain(in_ratio).filter_map(sample).collect();
    let each = (count / solution.sub_impacts.len().max(1)).max(12);
    for (index, contact) in solution.sub_impacts.iter().enumerate().take_while(|(_, contact)| contact.start <= until) {
        let duration = contact.duration.unwrap_or(until - contact.start);
        samples.extend((0..=each).filter_map(|i| {
            let after = duration * i as f64 / each as f64;
            let time = contact.start + after;
            let state = solution.in_contact(index, after)?;
            (time <= until).then_some(Sample { time, state })
        }));
    }
    samples.sort_by(|a, b| a.time.total_cmp(&b.time));
    samples.dedup_by_key(|sample| sample.time);
    samples
}

/// End of a figure of the whole impact (units of `T`): after the last separation, or in sustained contact.
pub fn telling_time(solution: &Solution) -> f64 {
    let last = solution.sub_impacts.last().map_or(0.0, |contact| contact.end.unwrap_or(contact.start));
    match solution.outcome {
        Outcome::Rebound => 1.5 * last,
        _ => solution.known_until,
    }
}
