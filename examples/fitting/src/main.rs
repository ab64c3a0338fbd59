//! A cooling curve: three parameters from eleven readings, with intervals.

use fitting::{Parameter, Problem, Settings, fit};

fn main() -> Result<(), fitting::FitError> {
    let temperature_c = [80.1, 69.4, 60.6, 53.5, 47.4, 42.6, 38.5, 35.2, 32.4, 30.2, 28.4];
    let model = |p: &[f64], minutes: f64| p[0] + p[1] * (-p[2] * minutes).exp();
    let problem = Problem {
        parameters: vec![
            Parameter::positive("room", 20.0, (5.0, 40.0)),
            Parameter::positive("excess", 50.0, (10.0, 100.0)),
            Parameter::positive("rate", 0.1, (0.01, 1.0)),
        ],
        count: temperature_c.len(),
        residuals: &|p, r| (0..r.len()).for_each(|i| r[i] = model(p, i as f64) - temperature_c[i]),
        jacobian: None,
    };
    let found = fit(&problem, &Settings::default())?;
    println!("room, excess, rate: {:.4?}, rms {:.3} C", found.parameters, found.report.rms);
    println!("95 %: {:.3?}", found.intervals(0.95)?);
    Ok(())
}
