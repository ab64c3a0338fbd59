use beam_modes::*;
use std::time::Instant;
fn gl() -> Vec<(f64, f64)> {
    // 20 point GL by Newton
    let n = 20;
    (0..n)
        .map(|i| {
            let mut x = (std::f64::consts::PI * (i as f64 + 0.75) / (n as f64 + 0.5)).cos();
            let mut d = 0.0;
            for _ in 0..100 {
                let (mut p0, mut p1) = (1.0, x);
                for j in 2..=n {
                    let p2 = ((2 * j - 1) as f64 * x * p1 - (j - 1) as f64 * p0) / j as f64;
                    p0 = p1;
                    p1 = p2;
                }
                d = n as f64 * (x * p1 - p0) / (x * x - 1.0);
                let dx = p1 / d;
                x -= dx;
                if dx.abs() < 1e-16 {
                    break;
                }
            }
            (x, 2.0 / ((1.0 - x * x) * d * d))
        })
        .collect()
}
fn ortho(beam: &Beam, m: &Modes) -> f64 {
    let n = m.len();
    let mut g = vec![0.0; n * n];
    let l = beam.length_m();
    let rule = gl();
    let mut start = 0.0;
    for s in &beam.segments {
        let k = (m.omega_rad_s()[n - 1]).sqrt() * (s.mass_per_length_kg_m / s.flexural_rigidity_n_m2).powf(0.25);
        let panels = (k * s.length_m / 4.0).ceil().max(1.0) as usize;
        let h = s.length_m / panels as f64;
        for p in 0..panels {
            for &(x, w) in &rule {
                let at = (start + h * (p as f64 + 0.5 * (1.0 + x))).min(l);
                let v = m.shapes_at(at).unwrap();
                let f = 0.5 * h * w * s.mass_per_length_kg_m;
                for i in 0..n {
                    let a = f * v[i];
                    for j in 0..=i {
                        g[i * n + j] += a * v[j];
                    }
                }
            }
        }
        start += s.length_m;
    }
    let mut worst = 0.0f64;
    for i in 0..n {
        for j in 0..=i {
            let e = (g[i * n + j] - if i == j { 1.0 } else { 0.0 }).abs();
            if e > worst || e.is_nan() {
                worst = e;
            }
        }
    }
    worst
}
fn s(l: f64, ei: f64, m: f64) -> Segment {
    Segment { length_m: l, flexural_rigidity_n_m2: ei, mass_per_length_kg_m: m }
}
fn h(l: f64, h: f64) -> Segment {
    s(l, h * h * h, h)
}
use End::*;
fn report(name: &str, b: &Beam, n: usize) {
    let t = Instant::now();
    match b.modes(n) {
        Ok(m) => {
            let t = t.elapsed();
            let w = m.omega_rad_s();
            let gap = w.windows(2).map(|p| (p[1] - p[0]) / p[1]).filter(|g| !g.is_nan()).fold(9.0, f64::min);
            let o = ortho(b, &m);
            // static
            let x = 0.37 * b.length_m();
            let g = b.static_compliance(x).unwrap();
            let sum: f64 =
                m.shapes_at(x).unwrap().iter().zip(w).filter(|(_, w)| **w > 0.0).map(|(p, w)| (p / w).powi(2)).sum();
            println!(
                "{name} {:?} n={n} {t:?} ortho {o:.1e} mingap {gap:.1e} first {:?} G {g} rel {:.1e}",
                b.ends,
                &w[..4.min(n)],
                1.0 - sum / g
            );
        }
        Err(e) => println!("{name} {e}"),
    }
}
#[test]
fn stress() {
    for (a, b) in [
        (Clamped, Free),
        (Free, Free),
        (Pinned, Free),
        (Guided, Guided),
        (Clamped, Clamped),
        (Pinned, Pinned),
        (Free, Guided),
        (Guided, Free),
        (Free, Pinned),
        (Clamped, Guided),
    ] {
        report("2seg", &Beam { segments: vec![s(0.5, 1.0, 1.0), s(0.5, 0.2, 0.5)], ends: [a, b] }, 200);
        report("short", &Beam { segments: vec![h(0.5, 1.0), h(0.001, 100.0), h(0.499, 1.0)], ends: [a, b] }, 200);
        report("extreme", &Beam { segments: vec![h(0.5, 1.0), h(0.3, 100.0), h(0.5, 1.0)], ends: [a, b] }, 200);
        report("extreme4", &Beam { segments: vec![h(0.5, 1.0), h(0.3, 10000.0), h(0.5, 1.0)], ends: [a, b] }, 100);
        report("hinge", &Beam { segments: vec![h(0.5, 1.0), h(0.001, 0.01), h(0.5, 1.0)], ends: [a, b] }, 100);
        report("hinge4", &Beam { segments: vec![h(0.5, 1.0), h(0.001, 0.0001), h(0.5, 1.0)], ends: [a, b] }, 100);
        report(
            "taper200",
            &Beam { segments: (0..200).map(|i| h(1.0, 1.0 - 0.7 * i as f64 / 200.0)).collect(), ends: [a, b] },
            100,
        );
        report(
            "spans",
            &Beam {
                segments: (0..21).map(|i| if i % 2 == 0 { h(1.0, 1.0) } else { h(1.0, 50.0) }).collect(),
                ends: [a, b],
            },
            150,
        );
        let mut r = 12345u64;
        let mut rnd = || {
            r = r.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (r >> 33) as f64 / (1u64 << 31) as f64
        };
        report(
            "random200",
            &Beam {
                segments: (0..200).map(|_| h(10f64.powf(2.0 * rnd()), 10f64.powf(2.0 * rnd()))).collect(),
                ends: [a, b],
            },
            150,
        );
    }
    report("500", &Beam { segments: vec![s(0.5, 1.0, 1.0), s(0.5, 0.2, 0.5)], ends: [Clamped, Free] }, 500);
    report("500u", &Beam { segments: vec![s(0.5, 1.0, 1.0)], ends: [Clamped, Free] }, 500);
}
