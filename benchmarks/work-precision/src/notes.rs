//! The text of the page.

use crate::{impact, infinite};

/// Subject of the page.
pub const INTRODUCTION: &str = "\
This page shows how much time the solvers of the workspace and their peers need for a given error. On a fixed \
library of problems each solver runs at a series of tolerances, and its error is shown against its time and against \
a deterministic cost. A time is \
the shortest of repeated runs after a warm-up. A run that fails or takes too long is listed under its figure, and \
tighter settings are then not tried. `work-precision.csv` has every number, in every norm.

The peers are DOP853, Hairer's explicit pair of order 8 (crate `ivp`), with events by repeated steps, and diffsol, \
with BDF of variable order and ESDIRK of order 4, an analytic Jacobian and its own root finding. All of them \
integrate phase by phase, restart at every change of contact, and use absolute tolerances scaled to each \
component. They are given the time at which the impact ends, which they cannot determine themselves. *+ exact \
flight* means that between \
contacts the modes are propagated in closed form and a certified search finds the next contact, so that the solver \
integrates contacts alone. Our solver is measured with all tables built for every impact, and with the tables \
cached (*tables kept*), as for many impacts on one beam.";

/// Explanation of the first table.
pub const TARGETS: &str = "\
The times are for an error of 1e-6 in the restitution, interpolated between two measured points on a straight line \
of the logarithms.";

/// Explanation of the second table.
pub const EVERY_ERROR: &str = "\
The next table is for other errors. It states the time of the fastest peer divided by that of the fastest solver of \
the workspace. *alone* means that no peer reaches the error, *none* that it is below what any solver or the \
reference reaches in double precision. For the infinite beam and the fractional equations the peers are the \
general methods of `fracdiff`, which are solvers of this workspace too.";

/// Reasons where the workspace is not ahead.
pub const WHY: &str = "\
A general solver on the whole system spends most of its steps in free flight, on the fastest mode, where nothing \
happens. This explains the first ratio. Given exact flight, it integrates contacts alone, with some tens of \
explicit steps each, and the ratio is that of the cost of a step. A single impact then also pays for our tables of \
the structure. They cost half as much as the impact itself, and the second impact on the same beam repays them.

The target of fifty times the speed of the best explicit solver on the whole system is missed where the ratio is \
smaller. The operations of the steps do not explain this: an impact takes 11 to 15 times \
[those of its steps](performance.md#how-far-from-the-floor). The implicit solvers, and those of the thesis and of \
textbooks, are far slower (figures \
below). At errors above 1e-4 every solver takes as few steps as it can, so there the ratio is that of the least \
cost of a contact.

Among the Volterra methods the second-order rules are cheap at two or three digits, with as few steps as are \
measured here. Only a second run shows how many steps this takes (*to a tolerance, with its error* includes both \
runs). With eight nodes and a long first panel, collocation reaches six more digits in the same time.";

/// Description of a problem, its norms, and its reference.
pub fn about(problem: &str) -> String {
    if let Ok(reference) = impact::reference(problem) {
        let what = impact::library().ok().and_then(|all| all.into_iter().find(|impact| impact.name == problem));
        return format!(
            "{}. {} sub-impacts, restitution {:.12}. Reference: extrapolated midpoint rule of order 16 in quadruple \
             precision (`reference/impacts.c`); its own error is below {:.0e}. Norms: restitution, total impulse \
             (relative), worst time of touch or separation (relative to the last), number of sub-impacts.",
            what.map_or("", |impact| impact.about),
            reference.outcome.impulses_n_s.len(),
            reference.outcome.restitution,
            reference.restitution_error.max(1e-30),
        );
    }
    match problem {
        "beam-S15-story" => {
            let floor = infinite::story_floor().unwrap_or(f64::NAN);
            format!(
                "A ball on an infinite beam, S = 15, until contact is sustained: worst relative error of the eight times \
                 of separation and touch, and the number of separations. The two spectral methods share no code, and \
                 each is the reference of the other; at their tightest they differ by {floor:.0e}."
            )
        }
        name if name.starts_with("beam-S") => format!(
            "A ball on an infinite beam, S = {}, first contact: speed after separation over speed of impact, and time of \
             separation (relative). Reference: one global panel in 25-digit arithmetic, exact to 14 digits.",
            &name[6..]
        ),
        name if name.starts_with("fractional-") => "Largest error at the reference times up to t = 20. Reference: \
             closed forms and Mittag-Leffler functions with 50 digits."
            .into(),
        name if name.starts_with("stepped-modes-N") => format!(
            "The first {} frequencies of a stepped cantilever, worst relative error. Reference: 20 digits by `mpmath`. \
             Exact modes have no tolerance: they are one point.",
            &name[15..]
        ),
        name if name.starts_with("emoc-") => "Net restitution by energy minimisation. Reference: the conditions of \
             optimality solved in rational numbers."
            .into(),
        _ => String::new(),
    }
}
