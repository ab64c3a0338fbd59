//! Messages about scenes without derivatives.

use crate::scene::InvalidInput;
use crate::text::significant;
use vibroimpact_sim::modal::NoDerivative;

/// The error of the scene whose run had this outcome; `name` returns the name of a contact.
pub(super) fn refusal(why: NoDerivative, outcome: &str, name: impl Fn(usize) -> String) -> InvalidInput {
    let seconds = |time_s: f64| significant(time_s, 6);
    let (value, allowed) = match why {
        NoDerivative::Outcome => (
            format!("a run whose outcome is {outcome:?}"),
            "a run that reaches its end, or one impact that ends with a rebound",
        ),
        NoDerivative::Graze { contact, time_s } => {
            (format!("{}, which touches without speed at {} s", name(contact), seconds(time_s)), CONTACTS)
        }
        NoDerivative::Together { contact, time_s } => {
            (format!("{}, which begins with a jump beside another at {} s", name(contact), seconds(time_s)), CONTACTS)
        }
        NoDerivative::Fork { contact, time_s } => (
            format!("{}, whose law may follow either of two branches at {} s", name(contact), seconds(time_s)),
            CONTACTS,
        ),
        NoDerivative::Break { time_s } => (
            format!("an event just where a load breaks, at {} s", seconds(time_s)),
            "breaks of loads apart from events of contacts",
        ),
        _ => ("a run whose derivatives are not finite".to_owned(), "a run with finite derivatives"),
    };
    InvalidInput::new("scene", value, format!("{allowed}; there is no derivative otherwise"))
}

const CONTACTS: &str = "contacts that begin with a speed, each at a time of its own";
