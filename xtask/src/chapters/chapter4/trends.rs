//! Statements of sections 4.2 and 7.2 on a table of restitutions, expressed as numbers of one table.

use super::tables::Table;
use crate::chapters::impact::Row;
use crate::chapters::statement;
use crate::chapters::study::Study;
use beam_modes::End;
use vibroimpact::report::significant;

/// A trend of one table.
pub(in crate::chapters) struct Trend {
    /// The measured quantity.
    pub quantity: &'static str,
    /// Section of the thesis that states the trend, besides the figure of the beam.
    pub source: &'static str,
    /// Wording of the thesis.
    pub words: &'static str,
    /// Limits within which the trend holds.
    pub limits: (f64, f64),
    /// Reason for the limits.
    pub reason: &'static str,
    /// Another possible meaning of the wording. If there is one, a number outside the limits does not refute the trend.
    pub otherwise: &'static str,
    /// Value of the quantity for the table.
    pub ours: f64,
}

impl Trend {
    /// Whether it holds.
    pub fn holds(&self) -> bool {
        (self.limits.0..=self.limits.1).contains(&self.ours)
    }

    /// A trend of section 4.2.
    pub fn new(quantity: &'static str, words: &'static str, (limits, reason): Limits, ours: f64) -> Trend {
        Trend { quantity, source: "4.2", words, limits, reason, otherwise: "", ours }
    }
}

pub(in crate::chapters) type Limits = ((f64, f64), &'static str);

pub(in crate::chapters) const RISES: Limits = (statement::RISES, "any amount");
const FALLS: Limits = (statement::FALLS, "any amount");
const CLEARLY: Limits = ((0.1, f64::INFINITY), "a tenth of the range from 0 to 1");
const VISIBLY: Limits = ((0.05, f64::INFINITY), "a twentieth of the range from 0 to 1");
const MORE: Limits = ((0.5, f64::INFINITY), "one more in every other impact");
const TWICE: Limits = ((2.0, f64::INFINITY), "twice, as half or less counts as a significant reduction in chapter 3");
const ONE: Limits = ((1.0, 1.0), "as stated");

/// All trends that the thesis states for a beam of this kind, always in the same order.
pub(in crate::chapters) fn of(table: &Table) -> Vec<Trend> {
    let (Some(lightest), Some(heaviest)) = (table.balls.first(), table.balls.last()) else { return Vec::new() };
    let length = table.beam.model.beam.length_m();
    let inner = |r: &Row| r.location_m > 0.1 * length && r.location_m < 0.9 * length;
    let of_ball = |mass_kg: f64| move |r: &Row| inner(r) && r.mass_kg == mass_kg;
    let contacts = |r: &Row| r.sub_impacts as f64;

    let means: Vec<f64> = table.balls.iter().map(|ball| table.mean(Row::e, of_ball(ball.mass_kg))).collect();
    let low = (0..means.len()).min_by(|&a, &b| means[a].total_cmp(&means[b])).unwrap_or(0);
    let [first, least, last] = [0, low, means.len() - 1].map(|k| means[k]);
    let most = table.all().filter(|r| of_ball(lightest.mass_kg)(r)).map(contacts).fold(0.0, f64::max);
    let heavier =
        table.balls[..table.balls.len().div_ceil(2)].iter().map(|ball| table.mean(contacts, of_ball(ball.mass_kg)));
    let more = heavier.fold(0.0, f64::max) - table.mean(contacts, of_ball(lightest.mass_kg));
    let words = "for slightly higher m, the number of sub-impacts increases";
    let mut trends = vec![
        Trend::new(
            "most contacts of the lightest ball away from the ends",
            "for very small m there is a single contact event",
            ONE,
            most,
        ),
        Trend::new(
            "mean e away from the ends: lightest ball minus the least of all balls",
            "for very small m, v_f is high; for slightly higher m, v_f is low",
            CLEARLY,
            first - least,
        ),
        Trend::new(
            "mean contacts away from the ends: most of the lighter six balls minus the lightest's",
            words,
            MORE,
            more,
        ),
        Trend::new(
            "mean e away from the ends: heaviest ball minus the least of all balls",
            "as m increases further, v_f increases again",
            VISIBLY,
            last - least,
        ),
    ];
    trends.push(Trend::new(
        "mean relative change of e to the next location where e is below its median, over that elsewhere, away from the ends",
        "the percentage variation in the restitution value is significantly larger when the restitution itself is smaller",
        TWICE,
        relative_variation(table, inner),
    ));
    ends(table, &mut trends);
    if let [thick, _, ..] = table.beam.model.beam.segments.as_slice() {
        step(table, thick.length_m, heaviest.mass_kg, &mut trends);
    }
    trends
}

/// Relative change of a small restitution from location to location, compared with that of a large restitution.
fn relative_variation(table: &Table, inner: impl Fn(&Row) -> bool) -> f64 {
    let mut pairs: Vec<(f64, f64)> = Vec::new();
    for places in table.rows.windows(2) {
        let both = places[0].iter().zip(&places[1]).filter(|(a, b)| inner(a) && inner(b));
        pairs.extend(both.map(|(a, b)| (0.5 * (a.e() + b.e()), (a.e() - b.e()).abs())));
    }
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mean = |pairs: &[(f64, f64)]| pairs.iter().map(|(e, change)| change / e).sum::<f64>() / pairs.len() as f64;
    let (small, large) = pairs.split_at(pairs.len() / 2);
    mean(small) / mean(large)
}

/// The quantity that depends most on the list of balls.
pub(in crate::chapters) const FREE_END: &str = "mean e at the free end minus that two locations before";

const SUDDEN: &str = "there is a sudden rise in restitution very close to pinned or fixed ends";
const VERY_CLOSE: &str = "whether one location from the end, 42 mm, is very close to it; closer to the end there is a rise, and e is 1 at the end itself";

/// Rises between a held end and the location of the tables next to it. `closer` is a table of one such location per held end.
pub(in crate::chapters) fn closer_to_held_ends(table: &Table, closer: &Table) -> Vec<Trend> {
    let names = [
        "mean e a sixteenth of a spacing from the left, held end minus that one location from it",
        "mean e a sixteenth of a spacing from the right, held end minus that one location from it",
    ];
    let nearest = |place_m: f64| {
        let inside = table.places_m.iter().copied().filter(|b| *b > 0.0 && *b < table.beam.model.beam.length_m());
        inside.min_by(|a, b| (a - place_m).abs().total_cmp(&(b - place_m).abs())).unwrap_or(f64::NAN)
    };
    let rise = |place_m: f64| {
        let near = nearest(place_m);
        closer.mean(Row::e, |r| r.location_m == place_m) - table.mean(Row::e, |r| r.location_m == near)
    };
    names
        .into_iter()
        .zip(&closer.places_m)
        .map(|(name, place)| Trend::new(name, SUDDEN, VISIBLY, rise(*place)))
        .collect()
}

/// Rises towards free and held ends.
fn ends(table: &Table, trends: &mut Vec<Trend>) {
    let at = |place_m: f64| table.mean(Row::e, |r| r.location_m == place_m);
    let one_place = |quantity, ours| Trend { otherwise: VERY_CLOSE, ..Trend::new(quantity, SUDDEN, VISIBLY, ours) };
    if let [_, near, further, ..] = table.places_m.as_slice() {
        let quantity = "mean e one location from the left, held end minus that two locations from it";
        trends.push(one_place(quantity, at(*near) - at(*further)));
    }
    match (table.places_m.as_slice(), table.beam.model.beam.ends[1]) {
        ([.., before, _, end], End::Free) => {
            trends.push(Trend::new(
                FREE_END,
                "near free ends, a general rising trend in v_f",
                RISES,
                at(*end) - at(*before),
            ));
        }
        ([.., further, near, _], _) => {
            let quantity = "mean e one location from the right, held end minus that two locations from it";
            trends.push(one_place(quantity, at(*near) - at(*further)));
        }
        _ => {}
    }
}

/// Trends on the thin part and at the step.
fn step(table: &Table, step_m: f64, heaviest_kg: f64, trends: &mut Vec<Trend>) {
    let length = table.beam.model.beam.length_m();
    let inner = |r: &Row| r.location_m > 0.1 * length && r.location_m < 0.9 * length;
    let slim = |least_kg: f64| {
        let on = |side: fn(f64, f64) -> bool| {
            table.mean(Row::e, |r| inner(r) && r.mass_kg > least_kg && side(r.location_m, step_m + 1e-9))
        };
        on(|b, step| b > step) - on(|b, step| b < step - 2e-9)
    };
    let greater = "greater rebound is seen from locations of the thinner portion";
    trends.push(Trend::new("mean e on the slim part minus that on the thick part", greater, RISES, slim(0.0)));
    let heavy = "mean e on the slim part minus that on the thick part, balls above 0.3 of the heaviest";
    trends.push(Trend::new(heavy, greater, RISES, slim(0.3 * heaviest_kg)));

    // the locations next to the step on both sides, without the step itself
    let before = table.places_m.iter().copied().filter(|b| *b < step_m - 1e-9).fold(0.0, f64::max);
    let beyond = table.places_m.iter().copied().filter(|b| *b > step_m + 1e-9).fold(length, f64::min);
    let third = |k: usize| {
        let (from, to) = (k * table.balls.len() / 3, (k + 1) * table.balls.len() / 3);
        let masses: Vec<f64> = table.balls[from..to].iter().map(|ball| ball.mass_kg).collect();
        let at = |place_m: f64| table.mean(Row::e, |r| r.location_m == place_m && masses.contains(&r.mass_kg));
        at(beyond) - at(before)
    };
    let [light, middle, heavy] = [0, 1, 2].map(third);
    let mut at_step = |quantity, words, limits, ours| {
        trends.push(Trend { source: "7.2", ..Trend::new(quantity, words, limits, ours) });
    };
    at_step(
        "change of mean e across the step, lightest third of the balls",
        "downward for very small masses",
        FALLS,
        light,
    );
    at_step(
        "change of mean e across the step, middle third of the balls",
        "upward for intermediate masses",
        RISES,
        middle,
    );
    at_step(
        "size of that change, middle third minus heaviest third",
        "shrinks for larger masses",
        RISES,
        middle.abs() - heavy.abs(),
    );
}

/// Reports the numbers for our choice of steps, thin parts and balls.
pub(super) fn tell(study: &mut Study, tables: &[Table]) {
    study.section("The trends of section 4.2 for our choice");
    study.text(
        "The thesis does not state its steps, slim parts and balls, so that a trend for our choice alone has little \
         significance. These numbers are therefore not counted among the statements; `cargo xtask reproduce-chapter \
         ensemble` counts in how many plausible choices each trend holds.",
    );
    let line = |(table, trend): (&Table, Trend)| {
        let holds = if trend.holds() { "holds" } else { "does not hold" };
        let texts = [&table.beam.name, trend.quantity, trend.words, &significant(trend.ours, 3), holds];
        texts.map(str::to_owned).to_vec()
    };
    let all = tables.iter().flat_map(|table| of(table).into_iter().map(move |trend| (table, trend)));
    study.table(&["beam", "quantity", "thesis", "ours", "for our choice"], &all.map(line).collect::<Vec<_>>());
}
