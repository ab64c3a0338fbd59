//! Beyond the thesis: the same studies with remainder modes that represent the truncated modes, up to N = 400.

use super::Case;
use crate::chapters::figures::{Column, Curve, restitution};
use crate::chapters::impact::{Row, Setup};
use crate::chapters::study::Study;
use tasks::Failure;
use vibroimpact::plot::{Axis, Colour, Marker};
use vibroimpact::report::significant;

const MEANING: &str = "The truncated modes are so fast that they hardly vibrate during a contact and respond nearly as \
a spring. Without them the beam is too stiff at the contact, by the residual compliance c = G(b,b) − Σ φ_k²/ω_k², \
where G is the static compliance of the whole beam. This error is small, but a small change of the first contact \
changes all contacts that follow. Two remainder modes, which have the compliance c and the next three moments of the \
truncated modes, remove the error. With them the damped restitution converges to a number that plain truncation \
approaches only slowly. The undamped restitution, which still scatters at N = 400 with plain truncation, converges \
too, with more modes. Much of the scatter that the chapter ascribes to missing damping is therefore due to the \
stiffness that truncation adds. Damping reduces the number of modes that are needed.";

pub(super) fn run(study: &mut Study, case: &Case) -> Result<(), Failure> {
    study.section("Remainder modes for the truncated modes, up to N = 400");
    study.text(MEANING);
    let counts = study.thin(&case.parameters.our_choice.residual_modes, 7);
    let zeta = case.parameters.damping_ratio;
    let mut table = Vec::new();
    for (damping_ratio, name) in [(zeta, "damped"), (0.0, "undamped")] {
        let mut columns: Vec<Column> = Vec::new();
        for &location_m in &case.parameters.locations_m {
            let mut curves = Vec::new();
            for residual in [false, true] {
                let setup = Setup { damping_ratio, residual, ..case.setup(location_m, 0) };
                let setups: Vec<Setup> = counts.iter().map(|&modes| Setup { modes, ..setup }).collect();
                let rows = study.sweep(&setups, 1, Setup::solve)?;
                table.push(summary(name, location_m, residual, &rows));
                curves.push(match residual {
                    false => Curve::new("plain truncation", Marker::Circle, Colour::Blue, rows),
                    true => Curve::new("with remainder modes", Marker::Cross, Colour::Vermilion, rows),
                });
            }
            columns.push((format!("b = {location_m:.4} m, ζ = {damping_ratio}"), curves));
        }
        let axis = Axis::new("number of modes N").log();
        let figure = restitution(
            &format!("Restitution with and without remainder modes, {name}"),
            &axis,
            |r| r.modes as f64,
            &columns,
        );
        let file = format!("residual-compliance-{name}");
        let rows: Vec<Row> = columns.iter().flat_map(|c| &c.1).flat_map(|c| &c.rows).cloned().collect();
        study.csv(&format!("{file}.csv"), &rows)?;
        let caption = "Blue: the retained modes alone, as in the thesis. Red: the same modes with two remainder modes \
                       for all others.";
        study.figure(&file, &figure, caption)?;
    }
    study.text("The spread is the largest minus the smallest restitution over the numbers of modes from 80 or 200 on.");
    study.table(
        &["damping", "location (m)", "remainder modes", "e at most modes", "spread, N ≥ 80", "spread, N ≥ 200"],
        &table,
    );
    Ok(())
}

fn summary(name: &str, location_m: f64, residual: bool, rows: &[Row]) -> Vec<String> {
    let spread = |least: usize| {
        let many = rows.iter().filter(|r| r.modes >= least).map(Row::e);
        let (low, high) = many.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h): (f64, f64), e| (l.min(e), h.max(e)));
        significant(high - low, 2)
    };
    let last = rows.last().map_or(f64::NAN, Row::e);
    let yes = if residual { "yes" } else { "no" };
    vec![name.into(), format!("{location_m:.4}"), yes.into(), significant(last, 5), spread(80), spread(200)]
}
