//! Messages about fields and scenes without derivatives.

use crate::scene::InvalidInput;
use crate::text::significant;
use vibroimpact_sim::modal::NoDerivative;

/// The reason why there is no derivative, in the terms of a scene.
pub(super) struct Refusal {
    /// What happens in the run.
    pub happens: String,
    allowed: &'static str,
}

impl Refusal {
    /// For a run with this outcome; `name` returns the name of a contact.
    pub fn new(why: NoDerivative, outcome: &str, name: impl Fn(usize) -> String) -> Refusal {
        const CONTACTS: &str = "one in which every contact begins with a speed and at a time of its own";
        let seconds = |time_s: f64| significant(time_s, 6);
        let (happens, allowed) = match why {
            NoDerivative::Outcome => (
                format!("its outcome is {outcome:?}"),
                "one that reaches its end, or a single impact that ends with a rebound",
            ),
            NoDerivative::Graze { contact, time_s } => {
                (format!("{} touches without speed at {} s", name(contact), seconds(time_s)), CONTACTS)
            }
            NoDerivative::Rests { contact, time_s } => {
                let (contact, time) = (name(contact), seconds(time_s));
                (
                    format!("{contact} touches without speed and without force until {time} s"),
                    "one in which the surfaces of every contact press on each other or are apart",
                )
            }
            NoDerivative::Together { contact, time_s } => {
                (format!("{} begins with a jump beside another at {} s", name(contact), seconds(time_s)), CONTACTS)
            }
            NoDerivative::Fork { contact, time_s } => {
                let contact = name(contact);
                (format!("the law of {contact} may follow either of two branches at {} s", seconds(time_s)), CONTACTS)
            }
            NoDerivative::Break { time_s } => (
                format!("an event coincides with a break of a load at {} s", seconds(time_s)),
                "one in which no event of a contact coincides with a break of a load",
            ),
            NoDerivative::Split => (
                "a load jumps there or begins with the run, so that the derivatives to both sides differ".to_owned(),
                "one in which no load jumps or begins at the time that is changed",
            ),
            _ => ("the derivatives are not finite".to_owned(), "one with finite derivatives"),
        };
        Refusal { happens, allowed }
    }

    /// The error of a field that the user named, or of the scene.
    pub fn error(&self, field: Option<&str>) -> InvalidInput {
        let Refusal { happens, allowed } = self;
        let (place, value, whose) =
            field.map_or(("scene", "this run", ""), |field| ("--by", field, "a field of a run, "));
        InvalidInput::new(place, value, format!("{whose}{allowed}, so that there is a derivative; here {happens}"))
    }
}
