//! Chapter 4: the tables of the four beams by both theories.

use super::{APART, kaneko};
use crate::chapters::beam::Beam;
use crate::chapters::chapter4::Case;
use crate::chapters::chapter4::tables::{Table, of_beams};
use crate::chapters::impact::Row;
use crate::chapters::study::Study;
use tasks::Failure;
use vibroimpact::plot::{Axis, Colour, Figure, Marker, Panel, Series};
use vibroimpact::report::significant;

/// Modes of the converged tables, with remainder modes for all others.
const MODES: usize = 160;

/// The tables of the four beams, model by model.
pub(super) struct Tables<'a> {
    /// N = 40, plain truncation, as in the thesis.
    pub truncated: Vec<Table<'a>>,
    /// Euler-Bernoulli, converged.
    pub slender: Vec<Table<'a>>,
    /// Timoshenko, converged.
    pub thick: Vec<Table<'a>>,
}

/// The beams of chapter 4 by Timoshenko's theory.
pub(super) struct Thick([Vec<Beam>; 3]);

impl Thick {
    pub fn of(case: &Case) -> Result<Thick, Failure> {
        let material = &case.parameters.material;
        let with = |share: f64| {
            let coefficient = share * kaneko(material);
            case.beams.iter().map(|beam| beam.timoshenko(material, coefficient)).collect::<Result<Vec<_>, Failure>>()
        };
        Ok(Thick([with(1.0)?, with(1.0 - APART)?, with(1.0 + APART)?]))
    }
}

pub(super) fn run<'a>(study: &mut Study, case: &'a Case, thick: &'a Thick) -> Result<Tables<'a>, Failure> {
    study.section("The tables of chapter 4");
    let mut of = |beams, model| of_beams(study, case, beams, model, |setup, solver| setup.solve_once_with(solver));
    let truncated = of(&case.beams, (case.parameters.modes, false))?;
    let slender = of(&case.beams, (MODES, true))?;
    let [thick, soft, stiff] = &thick.0;
    let [thick, soft, stiff] = [of(thick, (MODES, true))?, of(soft, (MODES, true))?, of(stiff, (MODES, true))?];

    let (mut lines, mut curves) = (Vec::new(), Vec::new());
    for k in 0..thick.len() {
        let change =
            |a: &Table, b: &Table| -> Vec<f64> { a.all().zip(b.all()).map(|(a, b)| (a.e() - b.e()).abs()).collect() };
        let coefficient: Vec<f64> =
            change(&soft[k], &thick[k]).iter().zip(change(&stiff[k], &thick[k])).map(|(a, b)| a.max(b)).collect();
        let kinds = [
            ("truncation", change(&truncated[k], &slender[k])),
            ("theory", change(&slender[k], &thick[k])),
            ("coefficient", coefficient),
        ];
        for (kind, changes) in &kinds {
            lines.push(summary(&thick[k].beam.title, kind, changes));
        }
        curves.push(kinds.map(|(kind, changes)| (kind, changes)));
    }
    study.tabled(
        "tables",
        &["beam", "change of e by", "root mean square", "median", "90 % below", "largest", "share above 0.03"],
        &lines,
    )?;
    by_mass(study, &thick, &curves)?;
    for (k, table) in thick.iter().enumerate() {
        let rows: Vec<Row> = slender[k].all().chain(table.all()).cloned().collect();
        study.csv(&format!("table-{}.csv", table.beam.name), &rows)?;
    }
    maps(study, &slender, &thick)?;
    Ok(Tables { truncated, slender, thick })
}

fn rms(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), v| (sum + v * v, count + 1.0));
    (sum / count).sqrt()
}

fn summary(beam: &str, kind: &str, changes: &[f64]) -> Vec<String> {
    let mut sorted = changes.to_vec();
    sorted.sort_by(f64::total_cmp);
    let quantile = |q: f64| sorted[((sorted.len() - 1) as f64 * q).round() as usize];
    let above = changes.iter().filter(|d| **d > 0.03).count();
    let numbers = [rms(changes.iter().copied()), quantile(0.5), quantile(0.9), quantile(1.0)];
    let share = format!("{:.0} %", 100.0 * above as f64 / changes.len() as f64);
    let names = [beam.to_owned(), kind.to_owned()];
    names.into_iter().chain(numbers.map(|v| significant(v, 2))).chain([share]).collect()
}

/// Changes of the restitution by truncation, theory and coefficient at each location.
type Kinds = [(&'static str, Vec<f64>); 3];

/// Root mean square over the locations, for each ball.
fn by_mass(study: &mut Study, tables: &[Table], curves: &[Kinds]) -> Result<(), Failure> {
    let looks = [(Marker::Plus, Colour::Grey), (Marker::Cross, Colour::Vermilion), (Marker::Circle, Colour::Blue)];
    let panel = |(k, (table, kinds)): (usize, (&Table, &Kinds))| {
        let masses: Vec<f64> = table.balls.iter().map(|ball| ball.mass_kg).collect();
        let x = Axis::new("mass of the ball").unit("kg").log();
        let y = Axis::new("rms change of e").log().limits(1e-4, 1.0);
        let panel = Panel::new(x, y).title(table.beam.title.clone()).height(170.0);
        kinds.iter().zip(looks).fold(panel, |panel, ((kind, changes), (marker, colour))| {
            let of_ball = |j: usize| rms(changes.iter().copied().skip(j).step_by(masses.len()));
            let values: Vec<f64> = (0..masses.len()).map(of_ball).collect();
            let series = Series::line_points(&masses, &values, marker).colour(colour);
            panel.with(if k == 0 { series.label(*kind) } else { series })
        })
    };
    let panels: Vec<Panel> = tables.iter().zip(curves).enumerate().map(panel).collect();
    let figure = Figure::new("Truncation, theory and shear coefficient, ball by ball").width(960.0);
    let figure = panels.chunks(2).fold(figure, |figure, row| figure.row(row.to_vec()));
    study.figure(
        "by-mass",
        &figure,
        "The curves are root mean squares over the locations of a beam. Truncation is the difference of N = 40 from \
         the converged restitution.",
    )
}

/// Difference of the tables by Timoshenko's and by Euler-Bernoulli's theory.
fn maps(study: &mut Study, slender: &[Table], thick: &[Table]) -> Result<(), Failure> {
    let panel = |(slender, thick): (&Table, &Table)| {
        let (a, b) = (slender.by_ball(Row::e), thick.by_ball(Row::e));
        let difference = a.iter().zip(&b).map(|(a, b)| a.iter().zip(b).map(|(a, b)| b - a).collect()).collect();
        let value = Axis::new("Timoshenko minus Euler-Bernoulli").limits(-0.3, 0.3);
        thick.map(difference, value).title(thick.beam.title.clone())
    };
    let panels: Vec<Panel> = slender.iter().zip(thick).map(panel).collect();
    let figure = Figure::new("Restitution by Timoshenko's theory minus that by Euler-Bernoulli's").width(960.0);
    let figure = panels.chunks(2).fold(figure, |figure, row| figure.row(row.to_vec()));
    study.figure(
        "maps",
        &figure,
        "Both restitutions are converged. Red: the restitution by Timoshenko's theory is larger. Blue: it is smaller.",
    )
}
