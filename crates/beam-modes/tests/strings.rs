//! Strings compared with known results: frequencies, the static deflection, and the limit of a beam.

use beam_modes::{Beam, End, Segment, TautString};

fn c4(flexural_rigidity_n_m2: f64) -> TautString {
    TautString { length_m: 0.62, tension_n: 670.0, mass_per_length_kg_m: 3.93e-3 / 0.62, flexural_rigidity_n_m2 }
}

#[test]
fn a_flexible_string_has_harmonics_and_a_stiff_one_fletcher_s() {
    let modes = c4(0.0).modes(50).unwrap();
    let first = modes.omega_rad_s()[0];
    assert!((first * 0.62 / std::f64::consts::PI / (670.0 * 0.62 / 3.93e-3f64).sqrt() - 1.0).abs() < 1e-15);
    // 1 mm of steel wire: f_n = n f (1 + B n^2)^(1/2), B = pi^2 EI/(T L^2).
    let rigidity = 2e11 * std::f64::consts::PI * 1e-3f64.powi(4) / 64.0;
    let b = std::f64::consts::PI.powi(2) * rigidity / (670.0 * 0.62 * 0.62);
    for (n, (stiff, flexible)) in
        c4(rigidity).modes(50).unwrap().omega_rad_s().iter().zip(modes.omega_rad_s()).enumerate()
    {
        let n = (n + 1) as f64;
        assert!((flexible / first / n - 1.0).abs() < 1e-14);
        assert!((stiff / flexible / (1.0 + b * n * n).sqrt() - 1.0).abs() < 1e-14);
    }
}

/// Compared with the sum over a million modes, and with the closed form without stiffness.
#[test]
fn static_deflection_is_the_sum_over_modes() {
    for (rigidity, x_m) in [(0.0, 0.0744), (0.0098, 0.0744), (0.0098, 0.31), (5.0, 0.2), (1e-9, 0.6)] {
        let string = c4(rigidity);
        let whole = string.static_compliance(x_m).unwrap();
        let modes = string.modes(100_000).unwrap();
        let shapes = modes.shapes_at(x_m).unwrap();
        let sum: f64 = modes.omega_rad_s().iter().zip(&shapes).map(|(w, phi)| (phi / w).powi(2)).sum();
        // Sum over n > N of at most 2 L/(T pi^2 n^2).
        let rest = 2.0 * 0.62 / (670.0 * std::f64::consts::PI.powi(2) * 1e5);
        assert!(whole >= sum * (1.0 - 1e-12) && whole - sum < rest, "{rigidity} {x_m}: {whole} {sum}");
        if rigidity == 0.0 {
            assert!((whole / (x_m * (0.62 - x_m) / (670.0 * 0.62)) - 1.0).abs() < 1e-14);
        }
    }
}

#[test]
fn a_string_of_low_tension_is_a_beam() {
    let string =
        TautString { length_m: 1.0, tension_n: 1e-9, mass_per_length_kg_m: 1.0, flexural_rigidity_n_m2: 274.0 };
    let segment = Segment { length_m: 1.0, flexural_rigidity_n_m2: 274.0, mass_per_length_kg_m: 1.0 };
    let beam = Beam { segments: vec![segment], ends: [End::Pinned, End::Pinned] };
    for x_m in [0.01, 0.3, 0.5] {
        let (a, b) = (string.static_compliance(x_m).unwrap(), beam.static_compliance(x_m).unwrap());
        assert!((a / b - 1.0).abs() < 1e-10, "{x_m}: {a} {b}");
    }
    let (a, b) = (string.modes(20).unwrap(), beam.modes(20).unwrap());
    for (string, beam) in a.omega_rad_s().iter().zip(b.omega_rad_s()) {
        assert!((string / beam - 1.0).abs() < 1e-10);
    }
    let (a, b) = (a.shapes_at(0.3).unwrap(), b.shapes_at(0.3).unwrap());
    assert!(a.iter().zip(&b).all(|(a, b)| (a - b).abs() < 1e-11));
}

#[test]
fn a_rigidity_of_minus_zero_is_none() {
    assert_eq!(c4(-0.0).static_compliance(0.2).unwrap(), c4(0.0).static_compliance(0.2).unwrap());
}

#[test]
fn input_out_of_range_is_named() {
    let field = |string: TautString| string.modes(3).unwrap_err().field;
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(field(TautString { length_m: bad, ..c4(0.0) }), "length_m");
        assert_eq!(field(TautString { tension_n: bad, ..c4(0.0) }), "tension_n");
        assert_eq!(field(TautString { mass_per_length_kg_m: bad, ..c4(0.0) }), "mass_per_length_kg_m");
    }
    for bad in [-1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(field(c4(bad)), "flexural_rigidity_n_m2");
        assert_eq!(c4(0.0).static_compliance(bad).unwrap_err().field, "x_m");
    }
    assert_eq!(c4(0.0).modes(1_000_000).unwrap_err().field, "count");
    assert_eq!(field(TautString { tension_n: 1e300, length_m: 1e-200, ..c4(0.0) }), "tension_n");
    assert_eq!(c4(0.0).static_compliance(0.0), Ok(0.0));
}
