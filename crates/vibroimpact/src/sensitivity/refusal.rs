//! Why a scene has no derivatives, in words.

use crate::scene::InvalidInput;
use vibroimpact_sim::modal::NoDerivative;

/// As an error of the scene whose run came to this outcome; `name` tells how a contact is called.
pub(super) fn refusal(why: NoDerivative, outcome: &str, name: impl Fn(usize) -> String) -> InvalidInput {
    let value = match why {
        NoDerivative::Outcome => format!("a run whose outcome is {outcome:?}"),
        NoDerivative::Graze { contact, time_s } => {
            format!("{}, which touches without speed at {time_s:.6e} s", name(contact))
        }
        NoDerivative::Together { contact, time_s } => {
            format!("{}, which begins with a jump beside another at {time_s:.6e} s", name(contact))
        }
        NoDerivative::Fork { contact, time_s } => {
            format!("{}, whose law takes either of two courses at {time_s:.6e} s", name(contact))
        }
        NoDerivative::Break { time_s } => format!("an event just where a load breaks, at {time_s:.6e} s"),
        NoDerivative::CriticalDamping { damping_ratio } => {
            format!("a mode whose damping changes, damped critically ({damping_ratio})")
        }
        NoDerivative::Infinite => "a run whose derivatives are no finite numbers".to_owned(),
        _ => "a run without derivatives".to_owned(),
    };
    let allowed = "a run that ends, one impact with a rebound, and whose contacts begin with a speed, each at its own time: \
                   elsewhere there is no derivative";
    InvalidInput::new("scene", value, allowed)
}
