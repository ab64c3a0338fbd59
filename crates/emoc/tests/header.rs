//! The C header compared with the crate, if there is a C compiler.

use crate::common::Random;
use emoc::{Impact, MovingImpact, MovingRebound, Parameters, Site};
use std::fmt::Write as _;
use std::io::Write as _;
use std::path::Path;
use std::process::{Command, Stdio};

const LINE: usize = 9;

/// The compiler named by `CC`, or that of the system.
fn compiler() -> Option<String> {
    let named = std::env::var("CC").ok();
    let found =
        |name: &String| Command::new(name).arg("--version").output().is_ok_and(|output| output.status.success());
    named.into_iter().chain(["cc", "gcc", "clang"].map(str::to_owned)).find(found)
}

/// One case as the C program reads it, and the numbers that it should print.
fn case(random: &mut Random) -> (String, [f64; LINE]) {
    let n = 1 + random.below(20);
    let phi: Vec<f64> = (0..n).map(|_| random.range(-2.0, 2.0)).collect();
    let ringing = [0.0, 0.05, 1.0][random.below(3)];
    let rates: Vec<f64> = (0..n).map(|_| ringing * random.range(-1.0, 1.0)).collect();
    let law = Parameters {
        mu0: random.log_range(1e-3, 1e3),
        alpha0: random.log_range(1e-3, 1e3),
        alpha1: random.log_range(1e-3, 1e3),
        notional_restitution: random.range(0.0, 1.0),
    };
    let (mass_kg, velocity_m_s) = (random.log_range(1e-12, 1e1), random.range(-3.0, 0.3));
    let mut text = format!(
        "{:?} {:?} {:?} {:?} {mass_kg:?} {velocity_m_s:?} {n}",
        law.mu0, law.alpha0, law.alpha1, law.notional_restitution
    );
    for (phi, rate) in phi.iter().zip(&rates) {
        let _ = write!(text, " {phi:?} {rate:?}");
    }
    let impact = Impact::new(mass_kg, &Site::new(&phi).unwrap()).unwrap();
    let coefficients = law.coefficients(&impact).unwrap();
    let moving = MovingImpact { mass_kg, velocity_m_s, coefficients, phi: &phi, rates: &rates };
    let rebound = moving.rebound().unwrap();
    let speeds: f64 = (0..n).map(|k| (k + 1) as f64 * moving.modal_rate(&rebound, k)).sum();
    let (omega, duration) = (30.0 * mass_kg, 0.07);
    let (amplitude, rate) = rung(omega, 0.1, duration);
    let q = omega * duration / std::f64::consts::PI;
    let half_sine = (0.5 * std::f64::consts::PI * q).cos() / (1.0 - q * q);
    let restitution = law.rebound(&impact).unwrap().restitution;
    let MovingRebound { velocity_m_s, impulse_n_s, share, .. } = rebound;
    (text, [0.0, restitution, velocity_m_s, impulse_n_s, share, speeds, amplitude, rate, half_sine])
}

/// A vibrating mode that starts with amplitude 0.3 and rate -2, by the classical Runge-Kutta method.
fn rung(omega: f64, damping_ratio: f64, time_s: f64) -> (f64, f64) {
    let slope = |(a, b): (f64, f64)| (b, -omega * (2.0 * damping_ratio * b + omega * a));
    let along = |s: (f64, f64), h: f64, k: (f64, f64)| (s.0 + h * k.0, s.1 + h * k.1);
    let (mut s, steps) = ((0.3, -2.0), 4000);
    let h = time_s / f64::from(steps);
    for _ in 0..steps {
        let k1 = slope(s);
        let k2 = slope(along(s, 0.5 * h, k1));
        let k3 = slope(along(s, 0.5 * h, k2));
        let k4 = slope(along(s, h, k3));
        s = (s.0 + h / 6.0 * (k1.0 + 2.0 * (k2.0 + k3.0) + k4.0), s.1 + h / 6.0 * (k1.1 + 2.0 * (k2.1 + k3.1) + k4.1));
    }
    s
}

#[test]
fn the_header_agrees_with_the_crate() {
    let Some(compiler) = compiler() else {
        eprintln!("no compiler for C: the header is not tested");
        return;
    };
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let program = Path::new(env!("CARGO_TARGET_TMPDIR")).join("header");
    let compiled = Command::new(compiler)
        .args(["-std=c99", "-pedantic", "-Wall", "-Wextra", "-Werror", "-O2", "-ffp-contract=off", "-I"])
        .arg(root.join("c"))
        .arg(root.join("tests/header.c"))
        .arg("-o")
        .arg(&program)
        .arg("-lm")
        .output()
        .unwrap();
    assert!(compiled.status.success(), "{}", String::from_utf8_lossy(&compiled.stderr));
    let mut random = Random(6);
    let (cases, known): (Vec<_>, Vec<_>) = (0..2000).map(|_| case(&mut random)).unzip();
    let mut running = Command::new(program).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
    let mut stdin = running.stdin.take().unwrap();
    let writer = std::thread::spawn(move || stdin.write_all((cases.join("\n") + "\n").as_bytes()).unwrap());
    let output = running.wait_with_output().unwrap();
    writer.join().unwrap();
    let printed = String::from_utf8(output.stdout).unwrap();
    assert_eq!(printed.lines().count(), known.len());
    for (line, known) in printed.lines().zip(known) {
        let found: Vec<f64> = line.split(' ').map(|number| number.parse().unwrap()).collect();
        assert_eq!(found.len(), LINE);
        for (found, known) in found.iter().zip(known) {
            assert!((found - known).abs() <= 1e-9 * (1.0 + known.abs()), "{line}\n{known:?}");
        }
    }
}
