//! Statements of the chapter on related problems and on late contacts: Zener's plate, a linear contact stiffness, the time of
//! the second contact, and the trends of later contacts.

use super::{in_ratio, solved};
use crate::chapters::statement::{FALLS, Statement};
use crate::chapters::study::Study;
use fracdiff::{Collocation, Method, Volterra};
use serde::Serialize;
use tasks::Failure;
use vibroimpact::report::significant;
use vibroimpact_sim::infinite::{Settings, Solution, Structure, critical_s, solve};

pub(super) fn run(study: &mut Study) -> Result<(), Failure> {
    plate(study)?;
    linear_stiffness(study)?;
    late_contacts(study)?;
    second_contact(study)
}

/// Rebound over speed of approach of a point mass on Hertz spring and dashpot in series, in the units of `S`:
/// `u' = -f`, `x' = u - f`, `f = sqrt(S) x^(3/2)`, by the classical rule of Runge and Kutta.
fn on_a_dashpot(s: f64, steps: usize) -> f64 {
    let force = |x: f64| s.sqrt() * x.max(0.0).powf(1.5);
    let rates = |[x, u]: [f64; 2]| [u - force(x), -force(x)];
    let h = 40.0 / (s.powf(0.2).min(1.0) * steps as f64);
    let mut state = [0.0, 1.0];
    loop {
        let after = |[a, b]: [f64; 2], share: f64| [state[0] + share * h * a, state[1] + share * h * b];
        let k1 = rates(state);
        let k2 = rates(after(k1, 0.5));
        let k3 = rates(after(k2, 0.5));
        let k4 = rates(after(k3, 1.0));
        let next = [0, 1].map(|i| state[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]));
        if next[0] <= 0.0 || !next[0].is_finite() {
            return -next[1];
        }
        state = next;
    }
}

/// Section 2.1: an infinite plate acts as a dashpot.
fn plate(study: &mut Study) -> Result<(), Failure> {
    study.section("Zener's plate, a dashpot");
    let settings = Settings { estimate_uncertainty: false, ..Settings::default() };
    let (mut worst, mut lines) = (0.0_f64, Vec::new());
    for s in [1e-4, 1e-2, 0.1, 1.0, 3.0] {
        let Some(ratio) = solve(Structure::Plate, s, &settings)?.first_rebound_ratio() else { continue };
        let dashpot = on_a_dashpot(s, 40_000);
        worst = worst.max((ratio - dashpot).abs());
        lines.push([s, ratio, dashpot].map(|number| significant(number, 6)).to_vec());
    }
    study.table(&["S", "v_f / v on a plate", "on a dashpot"], &lines);
    study.state(Statement::identity(
        "largest difference of v_f / v between plate and dashpot",
        ["2.1, Fig. 2.1", "mathematically the same as a point mass falling on a dashpot", "the Runge-Kutta rule"],
        (0.0, 1e-5),
        worst,
    ));
    Ok(())
}

/// Number of contacts, and whether the last one is sustained, for a mass that strikes an infinite beam through a linear spring
/// of this stiffness (in units of `T` and `F`).
fn linear(stiffness: f64) -> Result<(usize, bool), Failure> {
    const SAMPLES: usize = 20_000;
    let force = move |x: f64| stiffness * x.max(0.0);
    let equation = Volterra::scalar(|t| t, move |_, x| force(x), &[(2.0, -1.0), (1.5, -1.0)]);
    let solution = equation.solve(&Method::Collocation(Collocation::default()), UNTIL)?;
    let (mut contacts, mut pressed) = (0, false);
    for i in 1..=SAMPLES {
        // more samples at the start, where contacts are short
        let time = solution.end_time() * (i as f64 / SAMPLES as f64).powi(3);
        let now = solution.at(time)?.first().is_some_and(|x| *x > 0.0);
        contacts += usize::from(now && !pressed);
        pressed = now;
    }
    Ok((contacts, pressed))
}

/// Final time of an impact with a linear spring (units of `T`).
const UNTIL: f64 = 40.0;

#[derive(Serialize)]
struct LinearRow {
    stiffness: f64,
    contacts: usize,
    in_contact_at_the_end: bool,
}

/// Section 2.1: Yigit and Christoforou with a linear contact stiffness.
fn linear_stiffness(study: &mut Study) -> Result<(), Failure> {
    study.section("A linear contact stiffness");
    let values = study.thin(&in_ratio(1e-2, 1e4, 13), 5);
    let found = study.sweep(&values, 1, |&stiffness| linear(stiffness))?;
    let rows: Vec<LinearRow> = values
        .iter()
        .zip(&found)
        .map(|(&stiffness, &(contacts, in_contact_at_the_end))| LinearRow {
            stiffness,
            contacts,
            in_contact_at_the_end,
        })
        .collect();
    study.csv("linear-stiffness.csv", &rows)?;
    let (Some(soft), Some(hard)) = (rows.first(), rows.last()) else { return Ok(()) };
    let between = rows.iter().map(|row| row.contacts).max().unwrap_or(0);
    study.text(&format!(
        "The contact is a linear spring of the dimensionless stiffness k C² m T, and the motion is followed up to t = \
         {UNTIL} T. With the softest spring ({}) the body leaves after {} contact, with the hardest ({}) it stays in \
         contact after {}, and between them there are up to {between} contacts.",
        significant(soft.stiffness, 2),
        soft.contacts,
        significant(hard.stiffness, 2),
        hard.contacts
    ));
    study.state(Statement::trend(
        "sum of the contacts of the softest and of the hardest linear spring",
        "2.1",
        "identifying single contact at two extremes",
        (2.0, 2.0),
        "one each",
        (soft.contacts + hard.contacts) as f64,
    ));
    study.state(Statement::trend(
        "most contacts between them",
        "2.1",
        "the intermediate regime where multiple impact events are possible",
        (2.0, f64::INFINITY),
        "more than one",
        between as f64,
    ));
    Ok(())
}

/// Share of the variance of `y` that a straight line over the indices explains (R²).
fn straightness(y: &[f64]) -> f64 {
    let n = y.len() as f64;
    let (centre, mean) = (0.5 * (n - 1.0), y.iter().sum::<f64>() / n);
    let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
    for (k, y) in y.iter().enumerate() {
        let (dx, dy) = (k as f64 - centre, y - mean);
        (xx, xy, yy) = (xx + dx * dx, xy + dx * dy, yy + dy * dy);
    }
    xy * xy / (xx * yy)
}

/// Largest force and duration of every contact that ends in separation.
fn contacts(s: f64) -> Result<[Vec<f64>; 2], Failure> {
    let solution: Solution = solved(s, 0.0)?;
    let durations: Vec<f64> = solution.sub_impacts.iter().filter_map(|contact| contact.duration).collect();
    let largest = |k: usize| {
        let of = solution.extrema.iter().filter(|extremum| extremum.contact == k && !extremum.minimum);
        s.sqrt() * of.map(|extremum| extremum.compression).fold(0.0, f64::max).powf(1.5)
    };
    Ok([(0..durations.len()).map(largest).collect(), durations])
}

/// Appendix A.1: trends of force and duration from contact to contact.
fn late_contacts(study: &mut Study) -> Result<(), Failure> {
    study.section("Later contacts (A.1)");
    // impacts with seven contacts and more, which the appendix describes
    const PLACES: [f64; 5] = [1.65, 1.75, 2.0, 2.5, 3.0];
    let found = study.sweep(&PLACES, 1, |s| contacts(*s))?;
    let [forces, durations] = &found[2];
    let line = |k: usize| {
        let numbers = [forces[k], durations[k]].map(|number| significant(number, 4));
        [vec![(k + 1).to_string()], numbers.to_vec()].concat()
    };
    study.text("The forces and durations of the contacts at S = 2 are:");
    study.table(&["contact", "largest force (F)", "duration (T)"], &(0..durations.len()).map(line).collect::<Vec<_>>());
    // the first contact differs from the later ones, since the beam is at rest before it
    let logs = |values: &[f64]| values.iter().skip(1).map(|value| value.ln()).collect::<Vec<f64>>();
    let from_second = |values: &[f64]| values.iter().skip(1).copied().collect::<Vec<f64>>();
    for (which, name, words) in [
        (0, "largest force", "f decreases roughly exponentially for later sub-impacts"),
        (1, "duration", "the contact duration increases roughly exponentially"),
    ] {
        let all: Vec<(f64, f64)> =
            found.iter().map(|of| (straightness(&logs(&of[which])), straightness(&from_second(&of[which])))).collect();
        let gains = all.iter().map(|(exponential, linear)| exponential - linear);
        let told = |pairs: &dyn Fn(&(f64, f64)) -> f64| {
            all.iter().map(|pair| significant(pairs(pair), 3)).collect::<Vec<_>>().join(", ")
        };
        let statement = Statement::trend(
            format!(
                "{name} of the contacts from the second on: straightness (R²) of its logarithm minus its own, least of five S"
            ),
            "A.1",
            words,
            (0.05, 1.0),
            "0.05 tells a straight line from a curve; less, either way, does not",
            gains.fold(f64::INFINITY, f64::min),
        );
        study.state(statement.open((-0.05, 1.0)).note(format!(
            "At S = {}: {} of the logarithm and {} of the quantity itself.",
            PLACES.map(|s| significant(s, 3)).join(", "),
            told(&|pair| pair.0),
            told(&|pair| pair.1)
        )));
    }
    Ok(())
}

/// A later contact whose curve the thesis also computed.
const LATE: usize = 10;

/// Section 2.3: the time to the second contact grows without bound towards the critical `S`.
fn second_contact(study: &mut Study) -> Result<(), Failure> {
    study.section("The time of the second contact near the critical S");
    let critical = critical_s().s;
    let distances = in_ratio(1e-3, 1e-1, 5);
    let times = study.sweep(&distances, 1, |distance| {
        let solution = solved(critical + distance, 0.0)?;
        let start = |k: usize| solution.sub_impacts.get(k).map(|contact| contact.start).ok_or("a contact is missing");
        Ok([start(1)?, start(LATE - 1)?])
    })?;
    let lines = distances.iter().zip(&times);
    let lines: Vec<Vec<String>> = lines
        .map(|(d, [second, late])| vec![significant(*d, 2), significant(*second, 5), significant(*late, 5)])
        .collect();
    study.table(
        &["S minus its critical value", "start of the second contact (T)", &format!("of contact {LATE} (T)")],
        &lines,
    );
    let power = |k: usize| (times[1][k] / times[0][k]).ln() / (distances[1] / distances[0]).ln();
    study.state(Statement::identity(
        "power of the distance from the critical S in the time of the second contact",
        [
            "2.3",
            "as S → 1.56⁺, the time interval between subsequent impacts increases without bound",
            "the rebound velocity vanishes in proportion to the distance, and v_f t = c √t gives −2",
        ],
        (-2.05, -1.95),
        power(0),
    ));
    study.state(Statement::trend(
        format!("power of the distance from the critical S in the time of contact {LATE}"),
        "2.5",
        "all the contact-time curves approach the same vertical asymptote at S ≈ 1.56",
        FALLS,
        "any negative power",
        power(1),
    ));
    Ok(())
}
