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
fn gram(beam: &Beam, m: &Modes) -> Vec<f64> {
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
    g
}
