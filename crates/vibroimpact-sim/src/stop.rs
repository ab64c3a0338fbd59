//! Reasons why a computation stopped before the end of the impact.

/// The reason why a computation stopped before the end of the impact. All results up to that time are valid; the outcome of the
/// impact is not known.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum StopReason {
    /// The limit of steps in contact was reached (`max_steps`; for an infinite structure the limit of panels, `max_panels`).
    Steps,
    /// A contact needs steps shorter than the shortest, `2^-200` s, or the times of a run need more digits than a number has.
    FinestStep,
    /// The limit of contacts (`max_sub_impacts`) was reached.
    SubImpacts,
    /// A compression or its rate exceeded [`contact_models::LARGEST`], the limit up to which laws are defined.
    LawRange,
    /// The search for the next contact reached the limit of steps (`max_steps`): the surfaces approach each other again and again
    /// without touching.
    Flight,
    /// Further contacts depend on digits below rounding.
    DigitsExhausted,
    /// A contact on an infinite structure still lasts after 300 times the sum of its natural time, the relaxation time of its
    /// damping and, on a plate, the time in which the plate takes the speed of the striker, and it is not known whether it ends.
    ContactLasts,
    /// The contact law violates its contract; [`contact_models::check_contract`] reports which part, and where.
    Law,
}

invalid_input::names!(StopReason, "stopped_by", {
    Steps: "steps",
    FinestStep: "finest step",
    SubImpacts: "sub-impacts",
    LawRange: "law range",
    Flight: "flight",
    DigitsExhausted: "digits exhausted",
    ContactLasts: "contact lasts",
    Law: "law",
});

impl StopReason {
    /// All reasons.
    pub const ALL: [StopReason; 8] = [
        StopReason::Steps,
        StopReason::FinestStep,
        StopReason::SubImpacts,
        StopReason::LawRange,
        StopReason::Flight,
        StopReason::DigitsExhausted,
        StopReason::ContactLasts,
        StopReason::Law,
    ];

    /// One sentence with the reason and advice.
    pub fn advice(self) -> &'static str {
        match self {
            StopReason::Steps => {
                "the limit of steps in contact was reached: take fewer modes, add damping, or allow more steps (max_steps in Rust)"
            }
            StopReason::FinestStep => {
                "a contact needs steps that are too short for floating-point numbers: loosen the tolerance, or bring masses and \
                 stiffnesses closer together"
            }
            StopReason::SubImpacts => {
                "the limit of contacts was reached: add damping, or allow more (max_sub_impacts in Rust)"
            }
            StopReason::LawRange => {
                "a compression or its rate exceeded 1e30, the limit up to which contact laws are defined: check the units"
            }
            StopReason::Flight => {
                "the surfaces approach each other again and again without touching: change the gap, add damping, or \
                 allow more steps (max_steps in Rust)"
            }
            StopReason::DigitsExhausted => {
                "the next contacts depend on more digits than floating-point numbers have: the listed contacts are \
                certain, later ones are not known"
            }
            StopReason::ContactLasts => {
                "the contact still lasts at the end of the computation, and it is not known whether it ever ends: the \
                listed contacts are certain"
            }
            StopReason::Law => {
                "the contact law violates its contract: contact_models::check_contract reports which part, and where"
            }
        }
    }
}
