//! The page and its figures.

use crate::judge::{Failure, Judged, LEVELS, codes, judge, least_error, time_at};
use crate::outcome::Outcome;
use crate::problem::{Family, Problem};
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use vibroimpact::plot::{Axis, Colour, Figure, Marker, Panel, Series};

/// Text before and after the numbers.
const ABOVE: &str = include_str!("above.md");
const BELOW: &str = include_str!("below.md");
const FAILURES: &str = "The table counts the runs of each code at all settings, coarse ones included, that fail:\n\n\
- energy gained: the ball leaves faster than it came;\n\
- missed contact: the code answers as if there were no contact;\n\
- fell through: the ball still moves into what it struck;\n\
- stuck: the ball should leave but stands still;\n\
- wrong by more than 0.1: the error is above a tenth in another way;\n\
- too slow, no answer: the run ended without a result.\n\n\
The first, the third and the fourth are judged where one ball rebounds once.";
const FAMILIES: [(Family, &str, &str); 6] = [
    (Family::Law, "A given law at the ground", "law"),
    (Family::Restitution, "A given restitution", "restitution"),
    (Family::Structure, "Beams and plates", "structure"),
    (Family::InfiniteBeam, "Infinite beams", "infinite-beam"),
    (Family::Several, "Several bodies or contacts", "several"),
    (Family::Stop, "Elastic stops", "stop"),
];
const COLOURS: [Colour; 7] =
    [Colour::Blue, Colour::Vermilion, Colour::Green, Colour::Orange, Colour::Purple, Colour::Sky, Colour::Grey];
const MARKERS: [Marker; 4] = [Marker::Circle, Marker::Square, Marker::Triangle, Marker::Cross];

type ByProblem<'a> = BTreeMap<&'a str, Vec<Judged<'a>>>;

/// A page and the figures that it links to.
#[derive(Debug)]
pub struct Page {
    /// The text, in Markdown.
    pub text: String,
    /// Paths relative to the page, and SVG documents.
    pub figures: Vec<(String, String)>,
}

/// The page of these results; `about` lists the machines and versions.
///
/// # Errors
/// If a figure cannot be drawn.
pub fn page(problems: &[Problem], outcomes: &[Outcome], about: &str) -> Result<Page, String> {
    let judged = judge(problems, outcomes);
    let codes = codes(outcomes);
    let mut text = format!("# impactbench\n\n{}\n\n{}\n", ABOVE.trim(), about.trim());
    text += &shares(problems, &judged, &codes);
    text += &failures(problems, &judged, &codes);
    let mut figures = Vec::new();
    for (family, title, name) in FAMILIES {
        let of: Vec<&Problem> = problems.iter().filter(|problem| problem.family == family).collect();
        if of.is_empty() {
            continue;
        }
        let path = format!("figures/impactbench-{name}.svg");
        let _ = write!(text, "\n## {title}\n\n![Error against time: {title}]({path})\n");
        text += &table("Least error of each code", &of, &judged, &codes, |runs, code| {
            least_error(runs, code).map(|error| format!("{error:.0e}"))
        });
        text += &table("Least time to an error of 1e-6", &of, &judged, &codes, |runs, code| {
            time_at(runs, code, 1e-6).map(duration)
        });
        let figure = figure(title, &of, &judged, &codes);
        figures.push((path, figure.svg().map_err(|error| error.to_string())?));
    }
    text += &statements(problems);
    let _ = write!(text, "\n{}\n", BELOW.trim());
    Ok(Page { text, figures })
}

/// The machine and the versions of the results of each code, from the texts beside the tables.
///
/// # Errors
/// A file that cannot be read, by its name.
pub fn machines(folder: &Path) -> Result<String, String> {
    let entries = std::fs::read_dir(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let mut paths: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    paths.retain(|path| path.extension().is_some_and(|ending| ending == "txt"));
    paths.sort();
    let mut text = String::new();
    for path in paths {
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let about = std::fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
        text += &format!("- `{name}`: {}\n", about.trim());
    }
    Ok(text)
}

/// Number of problems that each code solves.
fn shares(problems: &[Problem], judged: &ByProblem, codes: &[&str]) -> String {
    let count = problems.len();
    let mut text = format!(
        "\n## Problems solved\n\nThe table counts how many of the {count} problems each code solves at its best setting, and \
         on how many it is the fastest to come within 1e-6.\n\n| code | takes part in |"
    );
    for level in LEVELS {
        let _ = write!(text, " within {level:.0e} |");
    }
    text += " fastest to 1e-6 |\n| --- | --- | --- |";
    text += &" --- |".repeat(LEVELS.len());
    let fastest: Vec<&str> = judged.values().filter_map(|runs| fastest(runs, codes)).collect();
    for code in codes {
        let errors: Vec<Option<f64>> = judged
            .values()
            .filter(|runs| runs.iter().any(|run| run.outcome.code == *code))
            .map(|runs| least_error(runs, code))
            .collect();
        let _ = write!(text, "\n| {code} | {} |", errors.len());
        for level in LEVELS {
            let _ = write!(text, " {} |", errors.iter().flatten().filter(|error| **error <= level).count());
        }
        let _ = write!(text, " {} |", fastest.iter().filter(|name| *name == code).count());
    }
    text + "\n"
}

/// The code that comes within 1e-6 in the shortest time.
fn fastest<'a>(runs: &[Judged], codes: &[&'a str]) -> Option<&'a str> {
    let times = codes.iter().filter_map(|code| Some((*code, time_at(runs, code, 1e-6)?)));
    times.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(code, _)| code)
}

/// Number of failures of each code, by kind.
fn failures(problems: &[Problem], judged: &ByProblem, codes: &[&str]) -> String {
    let known = |name: &str| problems.iter().any(|problem| problem.name == name);
    let mut text = format!("\n## Failures\n\n{FAILURES}\n\n| code | runs |");
    for kind in Failure::ALL {
        let _ = write!(text, " {} |", kind.as_str());
    }
    text += "\n| --- | --- |";
    text += &" --- |".repeat(Failure::ALL.len());
    for code in codes {
        let runs = judged.iter().filter(|(name, _)| known(name)).flat_map(|(_, runs)| runs);
        let runs: Vec<&Judged> = runs.filter(|run| run.outcome.code == *code).collect();
        let _ = write!(text, "\n| {code} | {} |", runs.len());
        for kind in Failure::ALL {
            let _ = write!(text, " {} |", runs.iter().filter(|run| run.failure == Some(kind)).count());
        }
    }
    text + "\n"
}

/// A cell for each problem and each code that takes part in the family; a dash if a code cannot compute or does not reach it.
fn table(
    title: &str,
    problems: &[&Problem],
    judged: &ByProblem,
    codes: &[&str],
    cell: impl Fn(&[Judged], &str) -> Option<String>,
) -> String {
    let runs = |problem: &Problem| judged.get(problem.name.as_str()).map_or(&[][..], Vec::as_slice);
    let takes_part =
        |code: &&&str| problems.iter().any(|problem| runs(problem).iter().any(|run| run.outcome.code == ***code));
    let codes: Vec<&&str> = codes.iter().filter(takes_part).collect();
    let mut text = format!("\n{title}:\n\n| problem |");
    for code in &codes {
        let _ = write!(text, " {code} |");
    }
    text += "\n| --- |";
    text += &" --- |".repeat(codes.len());
    for problem in problems {
        let _ = write!(text, "\n| {} |", problem.name);
        for code in &codes {
            let _ = write!(text, " {} |", cell(runs(problem), code).unwrap_or_else(|| "-".into()));
        }
    }
    text + "\n"
}

/// Largest error in figures: a run that diverges would hide the others.
const GREATEST_DRAWN: f64 = 10.0;

/// Error against time: a panel for each problem, two in a row.
fn figure(title: &str, problems: &[&Problem], judged: &ByProblem, codes: &[&str]) -> Figure {
    let panel = |problem: &&Problem| {
        let time = Axis::new(format!("{}: time", problem.name)).unit("s").log();
        let mut panel = Panel::new(time, Axis::new("error").log()).height(230.0);
        let runs = judged.get(problem.name.as_str()).map_or(&[][..], Vec::as_slice);
        for (i, code) in codes.iter().enumerate() {
            let points = runs.iter().filter(|run| run.outcome.code == *code);
            let found: Vec<(f64, f64)> = points
                .filter_map(|run| Some((run.outcome.time_s?, run.error?)))
                .filter(|(time, error)| *time > 0.0 && *error <= GREATEST_DRAWN)
                .collect();
            if found.is_empty() {
                continue;
            }
            let (times, errors): (Vec<f64>, Vec<f64>) = found.into_iter().unzip();
            let series = Series::line_points(&times, &errors, MARKERS[i / COLOURS.len() % MARKERS.len()]);
            panel = panel.with(series.label(*code).colour(COLOURS[i % COLOURS.len()]));
        }
        panel
    };
    let panels: Vec<Panel> = problems.iter().map(panel).collect();
    let mut figure = Figure::new(title).width(980.0);
    let mut panels = panels.into_iter();
    while let Some(first) = panels.next() {
        figure = match panels.next() {
            Some(second) => figure.row([first, second]),
            None => figure.row([first]),
        };
    }
    figure
}

/// The description of each problem and the method of its reference.
fn statements(problems: &[Problem]) -> String {
    let mut text =
        "\n## The problems\n\nUncertainties are those of the error: divided by the scale of the problem.\n\n\
                    | problem | what happens | answer | its uncertainty | how it was obtained |\n\
                    | --- | --- | --- | --- | --- |\n"
            .to_owned();
    for problem in problems {
        let values: Vec<String> = problem.quantities.iter().map(|quantity| format!("{:.9}", quantity.value)).collect();
        let _ = writeln!(
            text,
            "| {} | {} | {} | {:.0e} | {} |",
            problem.name,
            problem.statement,
            values.join(", "),
            problem.floor(),
            problem.reference
        );
    }
    text
}

/// A time to two digits, which are the ones that repeat, in a suitable unit.
fn duration(seconds: f64) -> String {
    let seconds: f64 = format!("{seconds:.1e}").parse().unwrap_or(seconds);
    let (value, unit) = match seconds {
        s if s < 1e-6 => (s * 1e9, "ns"),
        s if s < 1e-3 => (s * 1e6, "µs"),
        s if s < 1.0 => (s * 1e3, "ms"),
        s => (s, "s"),
    };
    if value < 9.95 { format!("{value:.1} {unit}") } else { format!("{value:.0} {unit}") }
}

#[cfg(test)]
mod tests {
    use super::duration;

    #[test]
    fn durations_have_two_digits() {
        let found = [4.04e-8, 9.96e-7, 1.2567e-5, 2.5e-4, 0.00994, 0.0996, 3.06].map(duration);
        assert_eq!(found, ["40 ns", "1.0 µs", "13 µs", "250 µs", "9.9 ms", "100 ms", "3.1 s"]);
    }
}
