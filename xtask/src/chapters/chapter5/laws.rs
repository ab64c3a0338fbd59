//! Comparison of every impact law with every table.

use crate::chapters::chapter7::{Dataset, LAW_MODES};
use crate::chapters::impact::Row;
use crate::chapters::statement::Statement;
use crate::chapters::study::Study;
use emoc::{Coefficients, Contact, Friction, Impact, Mode, Problem, Solver};
use serde::Serialize;
use tasks::Failure;
use vibroimpact::net::{Observations, law};
use vibroimpact::report::significant;

/// A law and the number of its parameters that are fitted to a beam.
pub(super) struct Law {
    pub name: &'static str,
    formula: &'static str,
    fitted: usize,
    predict: fn(&[&Row], &Observations) -> Result<Vec<f64>, Failure>,
}

/// A law without fitted parameters, which is computed for each impact from its data alone.
fn each(observations: &Observations, of: impl Fn(&Impact) -> Result<f64, Failure>) -> Result<Vec<f64>, Failure> {
    observations.impacts.iter().map(of).collect()
}

/// Perfectly elastic contact, since the tables have no dissipation in the contact.
const ELASTIC: f64 = 1.0;

pub(super) const LAWS: [Law; 9] = [
    Law {
        name: "Newton, vibration ignored",
        formula: "e = 1",
        fitted: 0,
        predict: |_, o| each(o, |_| Ok(emoc::newton_restitution(ELASTIC, 0.0)?)),
    },
    Law {
        name: "one impulse on all modes",
        formula: "(1 − Z)/(1 + Z)",
        fitted: 0,
        predict: |_, o| each(o, |impact| Ok(emoc::newton_restitution(ELASTIC, impact.z)?)),
    },
    Law {
        name: "one impulse, clipped",
        formula: "max(0, (1 − Z)/(1 + Z))",
        fitted: 0,
        predict: |_, o| each(o, |impact| Ok(emoc::newton_restitution(ELASTIC, impact.z)?.max(0.0))),
    },
    Law {
        name: "linear complementarity (LCP)",
        formula: "(v_f + e v_i) P = 0",
        fitted: 0,
        predict: |_, o| each(o, |impact| complementarity(impact.z)),
    },
    Law {
        name: "Todorov: least energy",
        formula: "−Z/(1 + Z)",
        fitted: 0,
        predict: |_, o| each(o, |impact| Ok(emoc::newton_restitution(0.0, impact.z)?)),
    },
    Law {
        name: "least energy with Eq. 6.6 alone",
        formula: "1/(1 + Z)",
        fitted: 0,
        predict: |_, o| {
            let coefficients = Coefficients { ebar: ELASTIC, beta0: 0.0, beta1: 0.0 };
            each(o, |impact| Ok(coefficients.rebound(impact.z)?.restitution))
        },
    },
    Law { name: "a constant", formula: "q₀", fitted: 1, predict: |_, o| Ok(regression(&[], o)) },
    Law {
        name: "linear regression",
        formula: "q₀ + q₁ m + q₂ b",
        fitted: 3,
        predict: |rows, o| {
            let columns = [|row: &Row| row.mass_kg, |row: &Row| row.location_m];
            Ok(regression(&columns.map(|of| rows.iter().map(|row| of(row)).collect()), o))
        },
    },
    Law {
        name: EMOC,
        formula: "ē max(1/(1+Z), (β₀+β₁)/(1+β₀))",
        fitted: 3,
        predict: |_, o| {
            let fitted = law(&o.fit()?.parameters);
            each(o, |impact| Ok(fitted.rebound(impact)?.restitution))
        },
    },
];

pub(super) const EMOC: &str = "EMOC";
const LCP: &str = "linear complementarity (LCP)";
const TODOROV: &str = "Todorov: least energy";
const IMPULSE: &str = "one impulse on all modes";
const REGRESSION: &str = "linear regression";

/// A striker of unit mass on a single mode that replaces all modes: every law of one impulse depends on `Z` alone.
fn problem(z: f64, ebar: f64) -> Problem {
    let coefficients = Coefficients { ebar, beta0: 0.0, beta1: 0.0 };
    Problem {
        contacts: vec![Contact { friction: Friction::None, coefficients }],
        inverse_inertia_per_kg: vec![1.0],
        velocity_m_s: vec![-1.0],
        modes: vec![Mode { rate: 0.0, shape: vec![z.sqrt()] }],
    }
}

fn complementarity(z: f64) -> Result<f64, Failure> {
    let solution =
        emoc::lcp::newton_impact(&problem(z, ELASTIC))?.ok_or("no solution of the complementarity problem")?;
    solution.velocity_m_s.first().copied().ok_or_else(|| "no velocity".into())
}

/// Least squares of the restitution on a constant and these columns, by the normal equations about the means.
fn regression(columns: &[Vec<f64>], observations: &Observations) -> Vec<f64> {
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let centred = |values: &[f64]| values.iter().map(|v| v - mean(values)).collect::<Vec<f64>>();
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let e = &observations.restitution;
    let mut predicted = vec![mean(e); e.len()];
    if let [x, y] = columns {
        let (x, y, rest) = (centred(x), centred(y), centred(e));
        let (xx, xy, yy) = (dot(&x, &x), dot(&x, &y), dot(&y, &y));
        let determinant = xx * yy - xy * xy;
        let (of_x, of_y) = (dot(&x, &rest), dot(&y, &rest));
        let (p, q) = ((yy * of_x - xy * of_y) / determinant, (xx * of_y - xy * of_x) / determinant);
        for (value, (x, y)) in predicted.iter_mut().zip(x.iter().zip(&y)) {
            *value += p * x + q * y;
        }
    }
    predicted
}

/// What a law predicts for every impact of every beam.
pub(super) struct Found {
    pub by_beam: Vec<Vec<f64>>,
}

#[derive(Serialize)]
struct LawRow {
    law: &'static str,
    fitted_numbers: usize,
    beam: String,
    rms: f64,
    mean_difference: f64,
    largest_difference: f64,
    below_zero: f64,
}

pub(super) fn run(study: &mut Study, data: &[Dataset]) -> Result<Vec<Found>, Failure> {
    study.section("The laws on the tables");
    let observations = data.iter().map(|data| data.observations(LAW_MODES)).collect::<Result<Vec<_>, _>>()?;
    let found = study.sweep(&LAWS, 0, |law| {
        let by_beam = data.iter().zip(&observations).map(|(data, o)| (law.predict)(&data.rows, o));
        Ok(Found { by_beam: by_beam.collect::<Result<_, Failure>>()? })
    })?;
    let differences = |found: &Found, k: usize| -> Vec<f64> {
        found.by_beam[k].iter().zip(&observations[k].restitution).map(|(law, e)| law - e).collect()
    };
    let mut rows = Vec::new();
    let mut lines = Vec::new();
    for (law, found) in LAWS.iter().zip(&found) {
        let mut line = vec![law.name.to_owned(), law.formula.to_owned(), law.fitted.to_string()];
        let mut all = Vec::new();
        for (k, data) in data.iter().enumerate() {
            let these = differences(found, k);
            line.push(significant(rms(&these), 3));
            rows.push(LawRow {
                law: law.name,
                fitted_numbers: law.fitted,
                beam: data.beam.name.clone(),
                rms: rms(&these),
                mean_difference: these.iter().sum::<f64>() / these.len() as f64,
                largest_difference: these.iter().fold(0.0, |largest, d| f64::max(largest, d.abs())),
                below_zero: share(&found.by_beam[k], |e| e < 0.0),
            });
            all.extend(these);
        }
        line.push(significant(rms(&all), 3));
        lines.push(line);
    }
    study.csv("laws.csv", &rows)?;
    let names: Vec<&str> = data.iter().map(|data| data.beam.name.as_str()).collect();
    study.table(&[&["law", "formula", "fitted parameters per beam"], names.as_slice(), &["all"]].concat(), &lines);
    study.text(
        "The table has the root-mean-square difference between law and table. A single impulse cannot reverse a ball \
         that is heavier than the part of the beam that responds at once (Z > 1): by the law the ball would move on \
         into the beam, while in fact further sub-impacts throw it back. With least energy and no outward constraint \
         ball and beam move on together. Clipping, and Eq. 6.6 alone, correct the sign but not the rebound.",
    );
    claims(study, data, &found, &rows)?;
    Ok(found)
}

fn claims(study: &mut Study, data: &[Dataset], found: &[Found], rows: &[LawRow]) -> Result<(), Failure> {
    let of = |name: &str| LAWS.iter().zip(found).find(|(law, _)| law.name == name).map(|(_, found)| found);
    let (todorov, impulse) = (of(TODOROV).ok_or("no such law")?, of(IMPULSE).ok_or("no such law")?);
    let (mut low, mut count) = (0, 0);
    for (data, predicted) in data.iter().zip(&todorov.by_beam) {
        low += data.rows.iter().zip(predicted).filter(|(row, law)| **law < row.e() - 0.1).count();
        count += predicted.len();
    }
    study.state(Statement::trend(
        "share of impacts that Todorov's law gives a restitution lower by more than 0.1",
        "5.3",
        "often predicts impact outcomes with unrealistically low restitution or rebound",
        (0.5, 1.0),
        "more often than not",
        low as f64 / count as f64,
    ));
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let (low_rebound, multiple) = (todorov.by_beam.concat(), impulse.by_beam.concat());
    study.state(Statement::identity(
        "mean restitution of least energy under the fundamental constraints alone",
        [
            "9",
            "implemented directly, the impact will turn out to have very poor rebound",
            "−Z/(1 + Z) is never above 0",
        ],
        (f64::NEG_INFINITY, 0.0),
        mean(&low_rebound),
    ));
    study.state(Statement::trend(
        "share of impacts after whose first impulse the ball still moves towards the beam",
        "4, 5.1",
        "the impact simulation may not end with one computed impulse",
        (0.05, 1.0),
        "more than one in twenty",
        share(&multiple, |e| e < 0.0),
    ));
    let rms = |law: &str, beam: &str| {
        rows.iter().find(|row| row.law == law && row.beam == beam).map_or(f64::NAN, |row| row.rms)
    };
    for data in data {
        let beam = data.beam.name.as_str();
        for (other, source, words) in [
            (LCP, "5.2.1", "a different approach which has some advantages over the LCP"),
            (
                REGRESSION,
                "7.3",
                "even linear regression would have three fitted coefficients; the overall performance is good",
            ),
        ] {
            study.state(
                Statement::trend(
                    format!("rms error of EMOC over that of {other}, {beam}"),
                    source,
                    words,
                    (0.0, 0.5),
                    "half the error is clearly better; any less is open",
                    rms(EMOC, beam) / rms(other, beam),
                )
                .open((0.0, 1.0)),
            );
        }
    }
    // the closed forms compared with the general solvers of contact problems
    let mut solver = Solver::new();
    let mut worst = 0.0_f64;
    for z in [0.0, 1e-3, 0.1, 1.0, 7.0, 100.0] {
        let least = solver.least_energy(&problem(z, 0.0))?.velocity_m_s[0];
        worst = worst.max((least - emoc::newton_restitution(0.0, z)?).abs());
        worst = worst.max((complementarity(z)? - emoc::newton_restitution(ELASTIC, z)?).abs());
    }
    study.state(Statement::identity(
        "largest difference of quadratic program and LCP from their closed forms in Z",
        ["5.2.1, 5.3", "least energy; complementarity", "rounding of the quadratic program"],
        (0.0, 1e-9),
        worst,
    ));
    Ok(())
}

fn rms(differences: &[f64]) -> f64 {
    (differences.iter().map(|d| d * d).sum::<f64>() / differences.len() as f64).sqrt()
}

fn share(values: &[f64], chosen: impl Fn(f64) -> bool) -> f64 {
    values.iter().filter(|value| chosen(**value)).count() as f64 / values.len() as f64
}
