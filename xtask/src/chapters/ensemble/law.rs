//! Statements of section 7.2 on the accuracy of the law, for one table and the law fitted to it.

use crate::chapters::chapter4::tables::Table;
use crate::chapters::chapter4::trends::{Limits, RISES, Trend};
use crate::chapters::chapter7::{Dataset, LAW_MODES};
use beam_modes::End;
use tasks::Failure;

/// Number of modes of the tables, which is also tried in the law.
const TABLE_MODES: usize = 40;
const GOOD: Limits = ((0.0, 0.1), "chapter 9: within ±0.1 in a range from 0 to 1 there is no comparable effort");
const LINE: Limits = ((0.0, 0.02), "a line's width, a fiftieth of a figure's height");
const TENTH: Limits = ((0.0, 0.1), "a tenth");
const MOST: Limits = ((0.75, 1.0), "three of four; half would be chance");

/// The trends of one table, always the same ones for a beam.
pub(super) fn trends(table: &Table) -> Result<Vec<Trend>, Failure> {
    let data = Dataset::new(table);
    let fewer = data.observations(TABLE_MODES)?.fit()?.report.rms;
    let fit = data.observations(LAW_MODES)?.fit()?;
    let mean = fit.residuals.iter().sum::<f64>() / fit.residuals.len() as f64;
    let new = |quantity, words, limits, ours| Trend { source: "7.2", ..Trend::new(quantity, words, limits, ours) };
    let mut trends = vec![
        new("rms error of the fit", "captures reasonably well the variation of v_f with m", GOOD, fit.report.rms),
        new(
            "size of the mean difference of law and table",
            "the average behavior is reasonably captured",
            LINE,
            mean.abs(),
        ),
        new(
            "change of the rms error from N = 40 to N = 50 in the law, as a share of it",
            "results do not change much between N = 40 and 50",
            TENTH,
            (fit.report.rms / fewer - 1.0).abs(),
        ),
    ];
    // table and law at one place, for one ball
    let at = |place_m: f64, mass_kg: f64| {
        let found = data.rows.iter().zip(&fit.residuals).find(|(r, _)| r.location_m == place_m && r.mass_kg == mass_kg);
        found.map(|(row, residual)| [row.e(), row.e() + residual])
    };
    let changes = |from_m: f64, to_m: f64| -> Vec<[f64; 2]> {
        let of_ball = |mass_kg: f64| {
            let (from, to) = (at(from_m, mass_kg)?, at(to_m, mass_kg)?);
            Some([to[0] - from[0], to[1] - from[1]])
        };
        table.balls.iter().filter_map(|ball| of_ball(ball.mass_kg)).collect()
    };
    if let (End::Free, [.., before, _, end]) = (table.beam.model.beam.ends[1], table.places_m.as_slice()) {
        let rises = changes(*before, *end);
        let mean = |k: usize| rises.iter().map(|rise| rise[k]).sum::<f64>() / rises.len() as f64;
        trends.push(new(
            "mean e at the free end minus that two locations before, of table and law the smaller",
            "captures correctly the rising trend near the beam's free end",
            RISES,
            mean(0).min(mean(1)),
        ));
    }
    if let [thick, _, ..] = table.beam.model.beam.segments.as_slice() {
        let step_m = thick.length_m;
        let before = table.places_m.iter().copied().filter(|b| *b < step_m - 1e-9).fold(0.0, f64::max);
        let beyond = table.places_m.iter().copied().filter(|b| *b > step_m + 1e-9).fold(f64::INFINITY, f64::min);
        let steps = changes(before, beyond);
        let alike = steps.iter().filter(|[table, law]| table * law > 0.0).count();
        trends.push(new(
            "share of balls for which law and table change alike across the step",
            "captures correctly the variations seen near the beam's steps in geometry",
            MOST,
            alike as f64 / steps.len() as f64,
        ));
    }
    Ok(trends)
}
