//! Statements of chapter 3 on the scatter of the restitution over the numbers of modes, and measures of that scatter.

use crate::chapters::figures::Curve;
use crate::chapters::impact::Row;
use crate::chapters::statement::Statement;
use crate::chapters::study::Study;

/// Number of modes from which on the text discusses convergence (3.3.5 and 3.5).
pub(in crate::chapters) const MANY: usize = 25;
/// A ratio of two scatters of at most this value is a significant reduction.
const REDUCED: f64 = 0.5;
/// A ratio of at least this value is no reduction.
const NOT_REDUCED: f64 = 0.7;
const PLACES: [&str; 2] = ["b = 0.4", "b = 0.618"];

/// A curve at each of the two locations.
pub(super) type AtBoth = [Vec<Row>; 2];

/// Restitutions of the rows with at least this many modes.
fn from(rows: &[Row], least: usize) -> impl Iterator<Item = f64> + '_ {
    rows.iter().filter(move |r| r.modes >= least).map(Row::e)
}

/// Standard deviation of the restitution from this many modes on.
pub(super) fn scatter(rows: &[Row], least: usize) -> f64 {
    deviation(&from(rows, least).collect::<Vec<_>>())
}

/// Number of restitutions from [`MANY`] modes on that deviate from their mean by more than this.
pub(super) fn off_the_mean(rows: &[Row], off: f64) -> usize {
    let centre = mean(from(rows, MANY));
    // a missing restitution counts as deviating
    from(rows, MANY).filter(|e| (e - centre).abs() > off || e.is_nan()).count()
}

/// Standard deviation.
pub(in crate::chapters) fn deviation(values: &[f64]) -> f64 {
    let centre = mean(values.iter().copied());
    mean(values.iter().map(|e| (e - centre).powi(2))).sqrt()
}

/// Smallest and largest.
pub(super) fn extremes(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), e| (low.min(e), high.max(e)))
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), e| (sum + e, count + 1.0));
    sum / count
}

/// Ratio of two scatters, and its standard error for this many independent values.
fn ratio(with: &[Row], without: &[Row]) -> (f64, f64) {
    let count = from(with, MANY).count().min(from(without, MANY).count()) as f64;
    let ratio = scatter(with, MANY) / scatter(without, MANY);
    (ratio, ratio / (count - 1.0).max(1.0).sqrt())
}

/// States that damping (the second curve) reduces the scatter, and gives the ratio of the scatters.
pub(super) fn reduction(study: &mut Study, quantity: String, source: &str, words: &str, curves: &[Curve]) -> f64 {
    let [without, with] = curves else { return f64::NAN };
    let (ratio, error) = ratio(&with.rows, &without.rows);
    study.state(reduced(quantity, source, words, (ratio, error)));
    ratio
}

fn reduced(quantity: String, source: &str, words: &str, (ratio, error): (f64, f64)) -> Statement {
    let reason = "half or less is significant, 0.7 and more is not; error of a ratio of scatters";
    let statement = Statement::trend(quantity, source, words, (0.0, REDUCED), reason, ratio);
    statement.open((0.0, NOT_REDUCED)).uncertain(error)
}

/// States that dissipation in the contact does not reduce the scatter.
pub(super) fn remains(study: &mut Study, name: &str, source: &str, hertz: &AtBoth, with: &AtBoth) {
    for (k, place) in PLACES.into_iter().enumerate() {
        let (ratio, error) = ratio(&with[k], &hertz[k]);
        let statement = Statement::trend(
            format!("scatter of e for N ≥ 25, {name} over Hertz, {place}"),
            source,
            "convergence is not improved",
            (NOT_REDUCED, f64::INFINITY),
            "0.7 and more is no reduction, half or less a significant one; error of a ratio of scatters",
            ratio,
        );
        study.state(statement.open((REDUCED, f64::INFINITY)).uncertain(error));
    }
}

/// States that viscous dissipation lowers the mean.
pub(super) fn lower(study: &mut Study, hertz: &AtBoth, viscous: &AtBoth) {
    let changes: Vec<f64> =
        viscous.iter().flatten().zip(hertz.iter().flatten()).map(|(with, without)| with.e() - without.e()).collect();
    let statement = Statement::trend(
        "mean of e with viscous dissipation minus mean without, all N, both b",
        "3.3.3",
        "on average there is some indication of lower rebound",
        (-1.0, 0.0),
        "any amount beyond the mean's standard error",
        mean(changes.iter().copied()),
    );
    study.state(statement.uncertain(deviation(&changes) / (changes.len() as f64).sqrt()));
}

/// States that modal damping reduces the scatter and the number of modes that are needed.
pub(super) fn damped(study: &mut Study, hertz: &AtBoth, modal: &AtBoth) {
    for (k, place) in PLACES.into_iter().enumerate() {
        let quantity = format!("scatter of e for N ≥ 25, damped over undamped, {place}");
        let words = "a significant reduction in variability";
        study.state(reduced(quantity, "3.3.5, Fig. 3.11", words, ratio(&modal[k], &hertz[k])));
        let centre = mean(from(&modal[k], MANY));
        study.state(Statement::loose(
            format!("scatter of e for N ≥ 25 over its mean, damped, {place}"),
            "3.5",
            "a variability within several percent (as opposed to a factor of 6)",
            (0.05, 0.05),
            "up to a tenth; relative, as the factor is",
            scatter(&modal[k], MANY) / centre,
        ));
    }
    let needed = |curves: &AtBoth| curves.iter().map(|rows| settles(rows)).max().unwrap_or(0) as f64;
    let most = hertz[0].last().map_or(0, |row| row.modes);
    let (near, reason) = ("within 0.05 of its mean over N ≥ 50 from there on", "as stated; 0.05 is our reading");
    study.state(Statement::trend(
        format!("modes from which on the undamped e stays {near}, of {most}"),
        "9",
        "the number of modes required decreases from more than 60",
        (60.0, f64::INFINITY),
        reason,
        needed(hertz),
    ));
    study.state(Statement::loose(
        format!("modes from which on the damped e stays {near}"),
        "9",
        "to around 25",
        (25.0, 5.0),
        "a fifth; 0.05 is our reading of \"reasonably accurate\"",
        needed(modal),
    ));
    study.state(Statement::loose(
        "modes that suffice with damping, to within 0.05 as above",
        "3.5",
        "the first 30 to 40 modes may be sufficient in the presence of small damping",
        (35.0, 5.0),
        "as stated; 0.05 is our reading of \"acceptable\"",
        needed(modal),
    ));
}

/// The least number of modes from which on the restitution stays near its late mean.
fn settles(rows: &[Row]) -> usize {
    const LATE: usize = 50;
    const NEAR: f64 = 0.05;
    let centre = mean(from(rows, LATE));
    let last = rows.iter().filter(|row| (row.e() - centre).abs() > NEAR).map(|row| row.modes).max();
    last.map_or(1, |last| rows.iter().map(|row| row.modes).find(|modes| *modes > last).unwrap_or(last + 1))
}

/// Without dissipation: identical pairs, the two locations, extremes, and the trend of the mean.
pub(super) fn without_dissipation(study: &mut Study, hertz: &AtBoth) {
    let find = |n: usize| hertz[0].iter().find(|r| r.modes == n).map(Row::e);
    let pairs = (1..=13).filter_map(|k| find(5 * k - 1).zip(find(5 * k)));
    let unequal = pairs.map(|(a, b)| (a - b).abs()).fold(f64::NAN, f64::max);
    if unequal.is_finite() {
        study.state(Statement::identity(
            "largest |e(N) − e(N+1)| for N = 4, 9, 14, …, b = 0.4",
            ["3.3.2", "identical", "rounding; the mode is not excited"],
            (0.0, 1e-15),
            unequal,
        ));
    }
    let apart = |least: usize, below: usize| {
        let pairs = hertz[0].iter().zip(&hertz[1]).filter(|(a, _)| (least..below).contains(&a.modes));
        pairs.map(|(a, b)| (a.e() - b.e()).abs()).fold(0.0, f64::max)
    };
    study.state(Statement::trend(
        "largest difference of e between the locations for N < 8",
        "3.3.2",
        "the response is similar",
        (0.0, 0.1),
        "a tenth of the range from 0 to 1",
        apart(1, 8),
    ));
    study.state(Statement::trend(
        "largest difference of e between the locations for N ≥ 20",
        "3.3.2",
        "differ significantly",
        (0.1, 1.0),
        "a tenth of the range from 0 to 1",
        apart(20, usize::MAX),
    ));

    let (wide, error) = ratio(&hertz[1], &hertz[0]);
    study.state(
        Statement::trend(
            "scatter of e for N ≥ 25, undamped, b = 0.618 over b = 0.4",
            "3.1, 3.3.2",
            "the latter location showing richer, or more variable, behavior even with many modes retained",
            (1.0, f64::INFINITY),
            "any amount beyond the error of a ratio of scatters",
            wide,
        )
        .uncertain(error),
    );
    let rows = || hertz.iter().flatten();
    let longest = rows().max_by(|a, b| a.last_separation_s.total_cmp(&b.last_separation_s));
    let net = longest.map_or(f64::NAN, |row| row.last_separation_s);
    let statement = Statement::printed("longest net time of the impacts of Fig. 3.4 (s)", "3.3.2", "0.025", net);
    study.state(statement.note(format!(
        "The text does not say to which impact its 0.025 s belong. The longest one has {} modes at b = {} m, and Fig. \
         3.3 shows N = 25 at 0.4 m.",
        longest.map_or(0, |row| row.modes),
        longest.map_or(f64::NAN, |row| row.location_m)
    )));

    let (low, high) = fingerprint(&hertz[1]);
    let numbers = [
        ("smallest e for N from 30 to 40, b = 0.618", "about 0.1", SMALLEST, low),
        ("largest e for N from 30 to 40, b = 0.618", "about 0.6", LARGEST, high),
        ("largest e over smallest e, N from 30 to 40, b = 0.618", "a factor of 6", FACTOR, high / low),
    ];
    for (quantity, words, number, ours) in numbers {
        study.state(Statement::loose(quantity, "3.5", words, number, "half a unit of the only digit", ours));
    }
    for (rows, place) in hertz.iter().zip(PLACES) {
        let third = rows.len() / 3;
        let of = |rows: &[Row]| {
            let values: Vec<f64> = rows.iter().map(Row::e).collect();
            (mean(values.iter().copied()), deviation(&values).powi(2) / (values.len() as f64 - 1.0).max(1.0))
        };
        let (first, last) = (of(&rows[..third]), of(&rows[rows.len() - third..]));
        let statement = Statement::trend(
            format!("mean of e over the first third of N minus that over the last, {place}"),
            "3.1",
            "on average a decreasing trend with increasing numbers of modes",
            (0.0, 1.0),
            "any amount beyond the standard error of the two means",
            first.0 - last.0,
        );
        study.state(statement.uncertain((first.1 + last.1).sqrt()));
    }
}

/// "About 0.1", "about 0.6" and "a factor of 6" of section 3.5, with half a unit of their only digits.
const SMALLEST: (f64, f64) = (0.1, 0.05);
const LARGEST: (f64, f64) = (0.6, 0.05);
const FACTOR: (f64, f64) = (6.0, 0.5);

/// Smallest and largest restitution for 30 to 40 modes.
pub(super) fn fingerprint(rows: &[Row]) -> (f64, f64) {
    extremes(rows.iter().filter(|r| (30..=40).contains(&r.modes)).map(Row::e))
}

/// Whether these extremes agree with the three numbers of section 3.5.
pub(super) fn gives_the_three_numbers((low, high): (f64, f64)) -> bool {
    let near = |(value, tolerance): (f64, f64), ours: f64| (ours - value).abs() <= tolerance;
    near(SMALLEST, low) && near(LARGEST, high) && near(FACTOR, high / low)
}
