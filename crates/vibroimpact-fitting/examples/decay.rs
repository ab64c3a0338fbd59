//! A decaying exponential fitted to noisy readings: parameters with their 95 % intervals.
//!
//! `cargo run --release -p vibroimpact-fitting --example decay`

use fitting::{FitError, Method, Parameter, Problem, Settings, fit};

fn main() -> Result<(), FitError> {
    // Amplitude 2, rate 0.7 and offset 0.3, with errors up to 0.02 from a golden-ratio sequence.
    let times: Vec<f64> = (0..60).map(|i| 0.1 * f64::from(i)).collect();
    let error = |i: usize| 0.02 * (2.0 * (i as f64 * 0.618_033_988_749_894_9).fract() - 1.0);
    let readings: Vec<f64> = times.iter().enumerate().map(|(i, t)| 2.0 * (-0.7 * t).exp() + 0.3 + error(i)).collect();
    let names = ["amplitude", "rate", "offset"];
    let problem = Problem {
        parameters: names.map(|name| Parameter::positive(name, 1.0, (0.01, 10.0))).to_vec(),
        count: times.len(),
        residuals: &|p, r| {
            for (r, (t, reading)) in r.iter_mut().zip(times.iter().zip(&readings)) {
                *r = p[0] * (-p[1] * t).exp() + p[2] - reading;
            }
        },
        jacobian: None,
    };
    let found = fit(&problem, &Settings { method: Method::LevenbergMarquardt, ..Settings::default() })?;
    println!("rms {:.5} after {} evaluations", found.report.rms, found.evaluations);
    for (name, value) in names.iter().zip(&found.parameters) {
        println!("{name:>10} {value:.5}");
    }
    println!("95 %: {:.4?}", found.intervals(0.95)?);
    Ok(())
}
