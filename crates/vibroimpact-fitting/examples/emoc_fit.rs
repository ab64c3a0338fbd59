//! Fits the three parameters of the EMOC law to 300 synthetic impacts on a pinned beam, with intervals, cross-validation, and
//! the effect of the kinks of the law.
//!
//! `cargo run --release -p vibroimpact-fitting --example emoc_fit`

mod emoc_data;

use fitting::{Method, Parameter, Problem, Settings, bootstrap, cross_validate, fit, k_folds};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // 12 masses at 25 locations; the restitutions belong to mu_0 = 0.7, alpha_0 = 3, alpha_1 = 0.2 with an error of 0.05.
    let data = emoc_data::impacts([0.7, 3.0, 0.2], 0.05);
    let problem = Problem {
        parameters: vec![
            Parameter::positive("mu0", 1.0, (0.01, 100.0)),
            Parameter::positive("alpha0", 1.0, (0.01, 100.0)),
            Parameter::positive("alpha1", 1.0, (0.01, 100.0)),
        ],
        count: data.len(),
        residuals: &|p, r| emoc_data::residuals(&data, p, r),
        jacobian: Some(&|p, j| emoc_data::jacobian(&data, p, j)),
    };
    for method in [Method::LevenbergMarquardt, Method::Simplex, Method::Both] {
        let found = fit(&problem, &Settings { method, ..Settings::default() })?;
        println!(
            "{method:?}: {:.5?}, rms {:.6}, {} evaluations",
            found.parameters, found.report.rms, found.evaluations
        );
    }
    let found = fit(&problem, &Settings::default())?;
    let ends: Vec<f64> = found.starts.iter().map(|start| start.sum_of_squares).collect();
    println!("sums of squares that the {} starts reach: {ends:.4?}", ends.len());
    if let Some(intervals) = found.intervals(0.95)? {
        println!("95 % from the Jacobian:  {intervals:.3?}");
    }
    println!("95 % from the bootstrap: {:.3?}", bootstrap(&problem, &Settings::default(), &found, 400, 1, 0.95)?);
    let folds = cross_validate(&problem, &Settings::default(), &k_folds(data.len(), 10, 1)?)?;
    println!("fitted rms {:.5}, predicted rms in 10-fold cross-validation {:.5}", found.report.rms, folds.report.rms);
    let places: Vec<usize> = data.iter().map(|impact| impact.place).collect();
    let left_out = cross_validate(&problem, &Settings::default(), &places)?;
    println!("predicted rms when each place on the beam is left out {:.5}", left_out.report.rms);
    Ok(())
}
