//! The hysteresis loops of thesis Fig. 3.2, as CSV on standard output.
//!
//!     cargo run -p contact-models --example hysteresis_loop > loop.csv

use contact_models::{Hysteretic, InvalidInput, TracePoint, trace};
use std::f64::consts::PI;
use std::io::{self, Write};

fn main() -> io::Result<()> {
    let path = loops().map_err(io::Error::other)?;
    let mut out = io::stdout().lock();
    writeln!(out, "time_s,compression_m,force_n")?;
    for point in path {
        writeln!(out, "{:.12},{:.12},{:.12}", point.time_s, point.compression_m, point.force_n)?;
    }
    Ok(())
}

fn loops() -> Result<Vec<TracePoint>, InvalidInput> {
    let law = Hysteretic { stiffness_n_m1_5: 1.0, theta_m: 1.6, beta: 1.4, k_bar: 4.0, epsilon_m: 1e-4 }.validated()?;
    let motion = |t: f64| {
        let (slow, fast) = (2.0 * PI * t, 8.0 * PI * t);
        (slow.sin() + 0.5 * fast.sin(), 2.0 * PI * slow.cos() + 4.0 * PI * fast.cos())
    };
    let times: Vec<f64> = (0..=1000).map(|i| f64::from(i) / 1000.0).collect();
    trace(&law, &times, motion)
}
