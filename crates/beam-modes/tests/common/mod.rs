//! Beams and an independent quadrature for the tests.

use beam_modes::{Beam, End, Modes, Segment};

pub const ENDS: [End; 4] = [End::Clamped, End::Pinned, End::Free, End::Guided];

pub fn segment(length_m: f64, flexural_rigidity_n_m2: f64, mass_per_length_kg_m: f64) -> Segment {
    Segment { length_m, flexural_rigidity_n_m2, mass_per_length_kg_m }
}

/// Unit width, so that `EI = h^3` and `m = h`.
pub fn thick(length_m: f64, h: f64) -> Segment {
    segment(length_m, h.powi(3), h)
}

/// Nodes and weights of Gauss's rule with `n` points on [-1, 1], by Newton's method.
pub fn gauss_rule(n: usize) -> Vec<(f64, f64)> {
    let root = |i: usize| {
        let mut x = (std::f64::consts::PI * (i as f64 + 0.75) / (n as f64 + 0.5)).cos();
        let mut slope = 1.0;
        for _ in 0..50 {
            let (mut before, mut value) = (1.0, x);
            for j in 2..=n {
                let j = j as f64;
                (before, value) = (value, ((2.0 * j - 1.0) * x * value - (j - 1.0) * before) / j);
            }
            slope = n as f64 * (x * value - before) / (x * x - 1.0);
            x -= value / slope;
        }
        (x, 2.0 / ((1.0 - x * x) * slope * slope))
    };
    (0..n).map(root).collect()
}

/// Largest entry of `int m phi_i phi_j dx - delta_ij`; panels follow the shortest wave.
pub fn orthonormality_defect(pieces: &[(f64, f64, f64)], modes: &Modes) -> f64 {
    let n = modes.len();
    let rule = gauss_rule(20);
    let mut gram = vec![0.0; n * n];
    let mut start = 0.0;
    for &(length, mass, wave_number) in pieces {
        let panels = (wave_number * length / 4.0).ceil().max(1.0);
        let h = length / panels;
        for panel in 0..panels as usize {
            for &(node, weight) in &rule {
                let x = start + h * (panel as f64 + 0.5 * (1.0 + node));
                let phi = modes.shapes_at(x.min(modes.length_m())).unwrap();
                let w = 0.5 * h * weight * mass;
                for i in 0..n {
                    for j in 0..=i {
                        gram[i * n + j] += w * phi[i] * phi[j];
                    }
                }
            }
        }
        start += length;
    }
    let mut worst = 0.0f64;
    for i in 0..n {
        for j in 0..=i {
            worst = worst.max((gram[i * n + j] - f64::from(u8::from(i == j))).abs());
        }
    }
    assert!(gram.iter().all(|g| g.is_finite()));
    worst
}

pub fn defect(beam: &Beam, modes: &Modes) -> f64 {
    let highest = modes.omega_rad_s().last().copied().unwrap_or(0.0);
    let pieces: Vec<_> = beam
        .segments
        .iter()
        .map(|s| {
            let k = (highest.powi(2) * s.mass_per_length_kg_m / s.flexural_rigidity_n_m2).powf(0.25);
            (s.length_m, s.mass_per_length_kg_m, k)
        })
        .collect();
    orthonormality_defect(&pieces, modes)
}

/// Rows of a CSV file without its header.
pub fn rows(text: &str) -> impl Iterator<Item = Vec<&str>> {
    text.lines().skip(1).map(|line| line.split(',').collect())
}
