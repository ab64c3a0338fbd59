//! Why a computation stopped before the impact had ended.

/// What ended a computation before the impact did. What was found until then is valid; how the impact ends is not known.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum StopReason {
    /// The steps in contact allowed (`max_steps`; of an infinite structure the panels, `max_panels`) were used up.
    Steps,
    /// A contact asked for steps finer than the finest, `2^-200` s, or the times of a run for more digits than a number
    /// has.
    FinestStep,
    /// As many contacts as allowed (`max_sub_impacts`) were found.
    SubImpacts,
    /// A compression or its rate went beyond [`contact_models::LARGEST`], up to which laws are defined.
    LawRange,
    /// The search for the next contact used up the steps allowed (`max_steps`): the surfaces come near each other over
    /// and over without meeting.
    Flight,
    /// Further contacts differ from one another by less than the rounding of what led to them.
    DigitsExhausted,
    /// A contact on an infinite structure still lasts when it has been followed for 300 of its natural times, and whether it
    /// ends is not known.
    ContactLasts,
    /// The law of contact does not keep what laws promise; [`contact_models::check_contract`] says which promise, and where.
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

    /// One sentence on what was reached, and what to do about it.
    pub fn advice(self) -> &'static str {
        match self {
            StopReason::Steps => {
                "the steps allowed in contact were used up: add damping, loosen the tolerance, or allow more steps"
            }
            StopReason::FinestStep => {
                "a contact asked for steps finer than numbers resolve: loosen the tolerance, or bring masses and \
                 stiffnesses closer together"
            }
            StopReason::SubImpacts => "as many contacts as allowed were found: allow more, or add damping",
            StopReason::LawRange => {
                "a compression or its rate went beyond 1e30, up to which contact laws are defined: check the units"
            }
            StopReason::Flight => {
                "the surfaces come near each other again and again without meeting: change the gap, add damping, or \
                 allow more steps"
            }
            StopReason::DigitsExhausted => {
                "the contacts that follow depend on digits that numbers do not have: what is listed is certain, what \
                 follows is not known"
            }
            StopReason::ContactLasts => {
                "the contact still lasts at the time up to which it was followed, and whether it ever ends is not known: \
                 what is listed is certain"
            }
            StopReason::Law => {
                "the contact law breaks what laws promise: contact_models::check_contract tells which promise, and where"
            }
        }
    }
}
