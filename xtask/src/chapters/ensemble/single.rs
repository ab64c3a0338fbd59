//! The figures of chapter 4 that show single impacts, for every step and thin part: Figs. 4.3, 4.4, 4.5, 4.10 and 4.11.

use super::{Variant, claim};
use crate::chapters::chapter4::Case;
use crate::chapters::chapter4::trends::{Limits, Trend};
use crate::chapters::impact::{Ball, Row, Setup};
use crate::chapters::study::Study;
use serde::Serialize;
use tasks::Failure;

pub(super) fn run(study: &mut Study, case: &Case, variants: &[Variant]) -> Result<(), Failure> {
    speeds(study, case, variants)?;
    convergence(study, case, variants)?;
    detailed(study, case, variants)?;
    along_the_beam(study, case, variants)
}

/// "Only a small effect".
const SMALL: Limits = ((0.0, 0.1), "a tenth of the range from 0 to 1");
const CLOSE: Limits = ((0.0, 0.05), "a twentieth of the range from 0 to 1");
const LARGE: Limits = ((20.0, f64::INFINITY), "more than most impacts of chapter 3 have");
const FAR_MORE: Limits = ((10.0, f64::INFINITY), "ten times");
const NONE: Limits = ((0.0, 0.0), "three locations, in order");
const SEVERAL: Limits = ((2.0, f64::INFINITY), "more than one");
const COARSELY: Limits = ((0.5, 1.0), "1 is strict order, 0 none; the text says \"very coarsely\"");

fn of_beam<'a>(variants: &'a [Variant], name: &str) -> Vec<&'a Variant> {
    variants.iter().filter(|variant| variant.beam.name == name).collect()
}

fn claim_each(study: &mut Study, trends: &[Vec<Trend>], beam: &str, figure: &str) {
    let all: Vec<&[Trend]> = trends.iter().map(Vec::as_slice).collect();
    claim(study, &all, beam, figure);
}

/// The effect of the speed for one beam and location.
#[derive(Serialize)]
struct SpeedRow {
    step_m: f64,
    slim_thickness_fraction: f64,
    location_m: f64,
    largest_change: f64,
}

/// Fig. 4.3 for all stepped cantilevers and locations.
fn speeds(study: &mut Study, case: &Case, variants: &[Variant]) -> Result<(), Failure> {
    study.section("The speed, over steps, slim parts and locations (Fig. 4.3)");
    let p = &case.parameters.our_choice.speed_study;
    let ball = Ball::new(&case.parameters.material, p.diameter_m)?;
    let places: Vec<(&Variant, f64)> = of_beam(variants, &p.beam)
        .into_iter()
        .flat_map(|variant| p.locations_m.iter().map(move |&b| (variant, b)))
        .collect();
    let exponents = [0.0, -1.0, -0.5, 0.5, 1.0];
    let rows = study.sweep(&places, exponents.len(), |&(variant, location_m)| {
        let setup = case.setup(&variant.beam, ball, location_m);
        let solver = setup.solver()?;
        let e = exponents
            .iter()
            .map(|x| {
                let speed_m_s = case.parameters.speed_m_s * p.factor.powf(*x);
                Ok(Setup { speed_m_s, ..setup }.solve_with(&solver)?.e())
            })
            .collect::<Result<Vec<f64>, Failure>>()?;
        let (step_m, slim_thickness_fraction) = variant.step.unwrap_or((f64::NAN, 1.0));
        // a change of NaN does not count as small
        let largest_change = e.iter().map(|other| (other - e[0]).abs()).fold(0.0, |a, b| if a >= b { a } else { b });
        Ok(SpeedRow { step_m, slim_thickness_fraction, location_m, largest_change })
    })?;
    study.csv("speeds.csv", &rows)?;
    let trend = |row: &SpeedRow| {
        let quantity = "largest change of e from that at 1 m/s, speeds from 1/15 to 15 m/s, one location";
        let words = "changing the velocity up or down by a factor of 15 has only a small effect";
        vec![Trend { source: "footnote, 4.1", ..Trend::new(quantity, words, SMALL, row.largest_change) }]
    };
    claim_each(study, &rows.iter().map(trend).collect::<Vec<_>>(), &p.beam, "4.3");
    Ok(())
}

/// Fig. 4.4 for all stepped cantilevers, with damping.
fn convergence(study: &mut Study, case: &Case, variants: &[Variant]) -> Result<(), Failure> {
    study.section("The number of modes, over steps and slim parts (Fig. 4.4)");
    let p = &case.parameters.our_choice.convergence_study;
    let ball = Ball::new(&case.parameters.material, p.diameter_m)?;
    let counts: Vec<usize> = (20..=super::MOST_MODES).step_by(4).collect();
    let beams = of_beam(variants, &p.beam);
    let trends = study.sweep(&beams, counts.len() * p.locations_m.len(), |variant| {
        let solve =
            |location_m: f64, modes: usize| Setup { modes, ..case.setup(&variant.beam, ball, location_m) }.solve();
        let at = |&b: &f64| counts.iter().map(|&modes| solve(b, modes)).collect::<Result<Vec<Row>, Failure>>();
        let places = p.locations_m.iter().map(at).collect::<Result<Vec<_>, Failure>>()?;
        Ok(of_convergence(&places))
    })?;
    claim_each(study, &trends, &p.beam, "4.4");
    Ok(())
}

/// Smallest and largest value of a quantity over the results with at least this many modes.
fn range(rows: &[Row], least: usize, value: fn(&Row) -> f64) -> (f64, f64) {
    let chosen = rows.iter().filter(|row| row.modes >= least).map(value);
    chosen.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)))
}

/// Statements of the text on Fig. 4.4. The locations are in order, and the free end is the last one.
fn of_convergence(places: &[Vec<Row>]) -> Vec<Trend> {
    let changes = places.iter().map(|rows| range(rows, 40, Row::e)).map(|(low, high)| high - low);
    let mut shares: Vec<(f64, f64)> =
        places.iter().map(|rows| range(rows, 0, Row::e)).map(|(low, high)| (low + high, high / low)).collect();
    shares.sort_by(|a, b| a.0.total_cmp(&b.0));
    let slower = shares.windows(2).filter(|pair| pair[1].1 >= pair[0].1).count();
    let count = |row: &Row| row.sub_impacts as f64;
    let tip = places.last().map_or(&[][..], Vec::as_slice);
    let (fewest, most) = range(tip, 0, count);
    let (low, high) = range(tip, 0, Row::e);
    vec![
        Trend::new(
            "largest change of e at three locations from 40 modes on, damped",
            "reasonable convergence is achieved for N ≈ 40",
            CLOSE,
            changes.fold(0.0, f64::max),
        ),
        Trend::new(
            "locations where e is higher and its relative change from 20 modes on no smaller, damped",
            "convergence is more rapid where restitution is higher",
            NONE,
            slower as f64,
        ),
        Trend::new(
            "most sub-impacts at the free end from 20 modes on, damped",
            "near the free end of the beam the number of impacts can be quite large",
            LARGE,
            most,
        ),
        Trend::new(
            "free end, damped, from 20 modes on: span of the number of sub-impacts over that of e, as shares",
            "the number of sub-impacts may change a lot while the net restitution does not change much",
            FAR_MORE,
            (most / fewest - 1.0) / (high / low - 1.0),
        ),
    ]
}

/// Fig. 4.5, whose locations and ball the thesis states.
fn detailed(study: &mut Study, case: &Case, variants: &[Variant]) -> Result<(), Failure> {
    study.section("Four locations, over steps and slim parts (Fig. 4.5)");
    let p = &case.parameters.our_choice.detailed;
    let ball = Ball::new(&case.parameters.material, p.diameter_m)?;
    let beams = of_beam(variants, &p.beam);
    let trends = study.sweep(&beams, p.locations_m.len(), |variant| {
        let solve = |&b: &f64| Ok(case.setup(&variant.beam, ball, b).solve()?.sub_impacts);
        let counts = p.locations_m.iter().map(solve).collect::<Result<Vec<usize>, Failure>>()?;
        let fewest = counts.into_iter().min().unwrap_or(0) as f64;
        Ok(vec![Trend::new("fewest sub-impacts of the four cases", "multiple sub-impacts are seen", SEVERAL, fewest)])
    })?;
    claim_each(study, &trends, &p.beam, "4.5");
    Ok(())
}

/// Number of times at which a displacement is sampled.
const SAMPLES: u32 = 60;

/// Figs. 4.10 and 4.11, over every other location of the beam.
fn along_the_beam(study: &mut Study, case: &Case, variants: &[Variant]) -> Result<(), Failure> {
    study.section("Displacements along the cantilevers (Figs. 4.10 and 4.11)");
    for p in &case.parameters.our_choice.histories {
        let ball = Ball::new(&case.parameters.material, p.diameter_m)?;
        let beams = of_beam(variants, &p.beam);
        let trends = study.sweep(&beams, case.parameters.places / 2, |variant| {
            let places: Vec<f64> = case.places(&variant.beam).into_iter().skip(2).step_by(2).collect();
            let (mut depths, mut counts) = (Vec::new(), Vec::new());
            for &location_m in &places {
                let (solution, history) = case.setup(&variant.beam, ball, location_m).record()?;
                let times = (1..=SAMPLES).map(|i| solution.end_s * f64::from(i) / f64::from(SAMPLES));
                let yields = times.map(|time_s| history.at(time_s).structure_displacement_m.abs());
                depths.push(yields.fold(0.0, f64::max));
                counts.push(solution.sub_impacts.len() as f64);
            }
            Ok(vec![
                Trend::new(
                    "rank correlation of location and deepest displacement",
                    "for the larger b's, the magnitudes of the displacements of the beam-contact-point increase",
                    COARSELY,
                    rank_correlation(&places, &depths),
                ),
                Trend::new(
                    "rank correlation of location and number of sub-impacts",
                    "for the larger b's, more than one subsequent impacts occur",
                    COARSELY,
                    rank_correlation(&places, &counts),
                ),
            ])
        })?;
        claim_each(study, &trends, &p.beam, &p.figure);
    }
    Ok(())
}

/// Spearman's rank correlation; equal values share their mean rank.
fn rank_correlation(x: &[f64], y: &[f64]) -> f64 {
    let ranks = |values: &[f64]| -> Vec<f64> {
        let below = |v: f64| values.iter().filter(|w| **w < v).count() as f64;
        let upto = |v: f64| values.iter().filter(|w| **w <= v).count() as f64;
        values.iter().map(|v| 0.5 * (below(*v) + upto(*v)) - 0.5 * values.len() as f64).collect()
    };
    let (x, y) = (ranks(x), ranks(y));
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    dot(&x, &y) / (dot(&x, &x) * dot(&y, &y)).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rank_correlation_sees_order_and_nothing_else() {
        let x = [1.0, 2.0, 3.0, 4.0];
        assert_eq!(rank_correlation(&x, &[1.0, 10.0, 11.0, 1e6]), 1.0);
        assert_eq!(rank_correlation(&x, &[4.0, 3.0, 2.0, 1.0]), -1.0);
        // equal values share their ranks
        assert!((rank_correlation(&x, &[1.0, 2.0, 2.0, 3.0]) - 0.9_f64.sqrt()).abs() < 1e-12);
        assert!(rank_correlation(&x, &[1.0; 4]).is_nan());
    }
}
