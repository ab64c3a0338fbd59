//! The results of a point of a sweep: the columns after the varied fields, for scenes of one impact and for scenes of bodies.

use super::table::Kind;
use crate::assembly::{AnyScene, Simulation, Summary};
use crate::model::{Answer, Draw, Kept};
use crate::scene::json::number;

/// The columns of an impact.
const OF_IMPACT: [(&str, Kind); 23] = [
    ("outcome", Kind::Text),
    ("restitution", Kind::Number),
    ("restitution_uncertainty", Kind::Number),
    ("uncertainty_solver", Kind::Number),
    ("uncertainty_modes_left_out", Kind::Number),
    ("uncertainty_beam_theory", Kind::Number),
    ("settled", Kind::Truth),
    ("spread", Kind::Number),
    ("sub_impact_count", Kind::Whole),
    ("model", Kind::Text),
    ("mode_count", Kind::Whole),
    ("residual_compliance_m_n", Kind::Number),
    ("solves", Kind::Whole),
    ("modes_computed", Kind::Whole),
    ("contact_steps", Kind::Whole),
    ("rejected_steps", Kind::Whole),
    ("newton_iterations", Kind::Whole),
    ("law_evaluations", Kind::Whole),
    ("flight_steps", Kind::Whole),
    ("mode_steps", Kind::Whole),
    ("panels", Kind::Whole),
    ("stopped_by", Kind::Text),
    ("error", Kind::Text),
];

/// The columns of a draw of uncertain fields.
const OF_DRAW: [(&str, Kind); 9] = [
    ("outcome", Kind::Text),
    ("restitution", Kind::Number),
    ("sub_impact_count", Kind::Whole),
    ("model", Kind::Text),
    ("contact_steps", Kind::Whole),
    ("law_evaluations", Kind::Whole),
    ("mode_steps", Kind::Whole),
    ("stopped_by", Kind::Text),
    ("error", Kind::Text),
];

/// The columns of a run before those of its contacts,
const OF_RUN: [(&str, Kind); 9] = [
    ("outcome", Kind::Text),
    ("end_s", Kind::Number),
    ("reliable_until_s", Kind::Number),
    ("motion_periods", Kind::Whole),
    ("motion_intervals", Kind::Whole),
    ("intervals", Kind::Whole),
    ("largest_force_n", Kind::Number),
    ("contact_work_rate_w", Kind::Number),
    ("load_work_j", Kind::Number),
];

/// those of each contact, after its name and a point,
const OF_CONTACT: [(&str, Kind); 10] = [
    ("count", Kind::Whole),
    ("time_share", Kind::Number),
    ("impulse_n_s", Kind::Number),
    ("largest_force_n", Kind::Number),
    ("rms_force_n", Kind::Number),
    ("contact_work_rate_w", Kind::Number),
    ("displacement_0_m", Kind::Number),
    ("velocity_0_m_s", Kind::Number),
    ("displacement_1_m", Kind::Number),
    ("velocity_1_m_s", Kind::Number),
];

/// and the last.
const LAST: [(&str, Kind); 11] = [
    ("modal_damping_j", Kind::Number),
    ("contact_loss_j", Kind::Number),
    ("residual_j", Kind::Number),
    ("contact_steps", Kind::Whole),
    ("rejected_steps", Kind::Whole),
    ("newton_iterations", Kind::Whole),
    ("law_evaluations", Kind::Whole),
    ("flight_steps", Kind::Whole),
    ("events", Kind::Whole),
    ("stopped_by", Kind::Text),
    ("error", Kind::Text),
];

/// Default outputs of a run that are reported as distributions.
const TOLD_OF_RUN: [&str; 3] = ["intervals", "largest_force_n", "contact_work_rate_w"];
/// Numbers of a run that cannot be outputs: the accuracy and the work of the solver, and the motion, which has no mean.
const NOT_OUTPUTS: [&str; 10] = [
    "reliable_until_s",
    "motion_periods",
    "motion_intervals",
    "residual_j",
    "contact_steps",
    "rejected_steps",
    "newton_iterations",
    "law_evaluations",
    "flight_steps",
    "events",
];

/// The kind of the results.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Results {
    /// Results of one impact.
    Impact,
    /// Results of one impact among many with uncertain fields.
    Draw,
    /// Results of a run.
    Run {
        /// The contacts of the first point. If another point lacks one of them, its cells are empty.
        contacts: Vec<String>,
        /// Whether `reliable_until_s` is computed.
        reliability: bool,
    },
}

impl Results {
    /// The results of scenes of this kind; `reliability` concerns runs.
    pub(super) fn of(scene: &AnyScene, reliability: bool) -> Results {
        match scene {
            AnyScene::Impact(_) => Results::Impact,
            AnyScene::Bodies(scene) => {
                let contacts = scene.contacts.iter().flat_map(|contact| contact.names()).collect();
                Results::Run { contacts, reliability }
            }
        }
    }

    /// Cache from point to point.
    pub(super) fn kept(&self) -> Kept {
        match self {
            // each draw has another location, if the location is uncertain
            Results::Draw => Kept::passing(),
            _ => Kept::default(),
        }
    }

    /// The columns; the last is `error`.
    pub(super) fn columns(&self) -> Vec<(String, Kind)> {
        let owned = |(name, kind): &(&str, Kind)| ((*name).to_owned(), *kind);
        match self {
            Results::Impact => OF_IMPACT.iter().map(owned).collect(),
            Results::Draw => OF_DRAW.iter().map(owned).collect(),
            Results::Run { contacts, .. } => {
                let of_contact = |contact: &String| OF_CONTACT.map(|(name, kind)| (format!("{contact}.{name}"), kind));
                let contacts = contacts.iter().flat_map(of_contact);
                OF_RUN.iter().map(owned).chain(contacts).chain(LAST.iter().map(owned)).collect()
            }
        }
    }

    /// The columns that can be reported as distributions.
    pub(super) fn outputs(&self) -> Vec<String> {
        match self {
            Results::Impact | Results::Draw => ["restitution", "sub_impact_count"].map(str::to_owned).to_vec(),
            Results::Run { .. } => {
                let is_output =
                    |(name, kind): &(String, Kind)| *kind != Kind::Text && !NOT_OUTPUTS.contains(&name.as_str());
                self.columns().into_iter().filter(is_output).map(|(name, _)| name).collect()
            }
        }
    }

    /// The default columns that are reported as distributions.
    pub(super) fn told(&self) -> &'static [&'static str] {
        match self {
            Results::Impact | Results::Draw => &["restitution"],
            Results::Run { .. } => &TOLD_OF_RUN,
        }
    }

    /// The position of the column of this name.
    pub(super) fn place(&self, name: &str) -> Option<usize> {
        let among = |columns: &[(&str, Kind)]| columns.iter().position(|(column, _)| *column == name);
        match self {
            Results::Impact => among(&OF_IMPACT),
            Results::Draw => among(&OF_DRAW),
            Results::Run { contacts, .. } => {
                let last = || among(&LAST).map(|place| OF_RUN.len() + contacts.len() * OF_CONTACT.len() + place);
                let of_contact = || {
                    let (contact, column) = name.rsplit_once('.')?;
                    let number = contacts.iter().position(|other| other == contact)?;
                    let place = OF_CONTACT.iter().position(|(other, _)| *other == column)?;
                    Some(OF_RUN.len() + number * OF_CONTACT.len() + place)
                };
                among(&OF_RUN).or_else(last).or_else(of_contact)
            }
        }
    }

    /// The cells of a point that could not be solved.
    pub(super) fn failed(&self, error: String) -> Vec<String> {
        let mut cells = vec![String::new(); self.columns().len()];
        if let Some(last) = cells.last_mut() {
            *last = error;
        }
        cells
    }

    /// The cells of a run.
    pub(super) fn of_run(&self, found: &Simulation) -> Vec<String> {
        let summary = Summary::new(found);
        let contacts = || summary.contacts.values();
        let motion = summary.steady_motion;
        let energy = summary.energy.as_ref();
        let run = [
            summary.outcome.to_owned(),
            number(summary.end_s),
            known(summary.reliable_until_s),
            whole(found.period_s.map(|_| motion.map_or(0, |motion| motion.periods))),
            whole(motion.map(|motion| motion.intervals)),
            contacts().map(|contact| contact.count).sum::<u64>().to_string(),
            number(contacts().map(|contact| contact.largest_force_n).fold(0.0, f64::max)),
            number(contacts().map(|contact| contact.contact_work_rate_w).sum()),
            known(energy.map(|energy| energy.load_work_j)),
        ];
        let names = match self {
            Results::Impact | Results::Draw => &[][..],
            Results::Run { contacts, .. } => contacts,
        };
        let of_contact = |name: &String| {
            let empty: [String; OF_CONTACT.len()] = Default::default();
            summary.contacts.get(name).map_or(empty, |contact| {
                let mut sides = summary.points.iter().filter(|point| point.contact == *name);
                let mut side = || sides.next().map(|side| [side.displacement_m, side.velocity_m_s]).unwrap_or_default();
                let ([displacement_0, velocity_0], [displacement_1, velocity_1]) = (side(), side());
                [
                    contact.count.to_string(),
                    number(contact.time_share),
                    number(contact.impulse_n_s),
                    number(contact.largest_force_n),
                    number(contact.rms_force_n),
                    number(contact.contact_work_rate_w),
                    number(displacement_0),
                    number(velocity_0),
                    number(displacement_1),
                    number(velocity_1),
                ]
            })
        };
        let counts = &summary.counts;
        let last = [
            known(energy.map(|energy| energy.modal_damping_j)),
            known(energy.map(|energy| energy.contact_loss_j)),
            known(energy.map(|energy| energy.residual_j)),
            counts.contact_steps.to_string(),
            counts.rejected_steps.to_string(),
            counts.newton_iterations.to_string(),
            counts.law_evaluations.to_string(),
            counts.flight_steps.to_string(),
            counts.events.to_string(),
            summary.reason.unwrap_or_default().to_owned(),
            String::new(),
        ];
        run.into_iter().chain(names.iter().flat_map(of_contact)).chain(last).collect()
    }
}

/// The cells of an impact.
pub(super) fn of_impact(answer: &Answer) -> Vec<String> {
    let cost = answer.cost;
    let cells: [String; OF_IMPACT.len()] = [
        answer.outcome.to_owned(),
        known(answer.restitution),
        known(answer.restitution_uncertainty),
        known(answer.uncertainty.solver),
        known(answer.uncertainty.modes_left_out),
        known(answer.uncertainty.beam_theory),
        answer.settled.to_string(),
        known(answer.spread),
        answer.sub_impact_count.map_or_else(String::new, |count| count.to_string()),
        answer.model.as_str().to_owned(),
        answer.modes.to_string(),
        number(answer.residual_compliance_m_n),
        cost.solves.to_string(),
        cost.modes_computed.to_string(),
        cost.contact_steps.to_string(),
        cost.rejected_steps.to_string(),
        cost.newton_iterations.to_string(),
        cost.law_evaluations.to_string(),
        cost.flight_steps.to_string(),
        cost.mode_steps.to_string(),
        cost.panels.to_string(),
        answer.stopped_by.map_or_else(String::new, |reason| reason.as_str().to_owned()),
        String::new(),
    ];
    cells.to_vec()
}

/// The cells of a draw.
pub(super) fn of_draw(draw: &Draw) -> Vec<String> {
    let cells: [String; OF_DRAW.len()] = [
        draw.outcome.to_owned(),
        known(draw.restitution),
        draw.sub_impact_count.map_or_else(String::new, |count| count.to_string()),
        draw.model.as_str().to_owned(),
        draw.cost.contact_steps.to_string(),
        draw.cost.law_evaluations.to_string(),
        draw.cost.mode_steps.to_string(),
        draw.stopped_by.map_or_else(String::new, |reason| reason.as_str().to_owned()),
        String::new(),
    ];
    cells.to_vec()
}

fn known(value: Option<f64>) -> String {
    value.map_or_else(String::new, number)
}

fn whole(value: Option<u64>) -> String {
    value.map_or_else(String::new, |value| value.to_string())
}
