//! Timoshenko beams: closed forms, multiple precision, limits, orthonormality, the count in both spectra.

use crate::common::{ENDS, gauss_rule, rows, segment};
use beam_modes::{Beam, BeamSystem, End, Modes, Segment, ShearSection};
use std::f64::consts::PI;

fn shear(shear_rigidity_n: f64, rotary_inertia_kg_m: f64) -> ShearSection {
    ShearSection { shear_rigidity_n, rotary_inertia_kg_m }
}

fn timoshenko(parts: &[(Segment, ShearSection)], ends: [End; 2]) -> BeamSystem {
    let (segments, sections) = parts.iter().copied().unzip();
    BeamSystem { shear: Some(sections), ..BeamSystem::from(Beam { segments, ends }) }
}

/// The two frequencies of a wave number, for unit length and mass per length.
fn frequencies(k: f64, rigidity: f64, section: ShearSection) -> [f64; 2] {
    let ShearSection { shear_rigidity_n: shear, rotary_inertia_kg_m: rotary } = section;
    let (sum, product) = (rigidity * k * k + shear + rotary * shear * k * k, shear * rigidity * k.powi(4));
    let high = (0.5 * (sum + (sum * sum - 4.0 * rotary * product).sqrt()) / rotary).sqrt();
    [(product / rotary).sqrt() / high, high]
}

/// Sines and cosines are modes of a uniform beam with pinned or guided ends: five hundred of both spectra, and the mode of pure
/// shear.
#[test]
fn uniform_beams_with_pinned_and_guided_ends() {
    for (ends, shift) in [
        ([End::Pinned; 2], 0.0),
        ([End::Guided; 2], 0.0),
        ([End::Pinned, End::Guided], 0.5),
        ([End::Guided, End::Pinned], 0.5),
    ] {
        // A beam ten times as long as it is thick, and a slender one.
        for section in [shear(40.0, 1e-2), shear(4e6, 1e-7)] {
            let system = timoshenko(&[(segment(1.0, 1.0, 1.0), section)], ends);
            let cut_off = (section.shear_rigidity_n / section.rotary_inertia_kg_m).sqrt();
            let waves = (1..=500).flat_map(|n| frequencies((n as f64 - shift) * PI, 1.0, section));
            let mut exact: Vec<f64> = waves.collect();
            if ends == [End::Pinned; 2] {
                exact.push(cut_off);
            }
            // A guided beam can also translate.
            exact.extend(vec![0.0; system.rigid_body_count().unwrap()]);
            exact.sort_by(f64::total_cmp);
            let modes = system.modes(500).unwrap();
            for (n, (&omega, &theirs)) in modes.omega_rad_s().iter().zip(&exact).enumerate() {
                assert!((omega - theirs).abs() <= 2e-13 * theirs, "{ends:?} {section:?} {n}: {omega} {theirs}");
            }
            if ends == [End::Pinned; 2] && exact[499] > cut_off {
                let pure = exact.iter().position(|&omega| omega == cut_off).unwrap();
                for x in [0.0, 0.3, 0.71, 1.0] {
                    assert!(modes.shape(pure, x).unwrap().abs() < 1e-11);
                    let rotation = modes.rotation(pure, x).unwrap() * section.rotary_inertia_kg_m.sqrt();
                    assert!((rotation - 1.0).abs() < 1e-10, "{rotation}");
                }
            }
        }
    }
}

#[test]
fn multiple_precision_reference() {
    let parts = [(segment(0.6, 1.0, 1.0), shear(400.0, 1e-3)), (segment(0.4, 0.4, 0.6), shear(280.0, 4e-4))];
    let modes = timoshenko(&parts, [End::Clamped, End::Free]).modes(50).unwrap();
    let reference: Vec<f64> = rows(include_str!("data/beam_system_reference.csv"))
        .filter(|row| row[0] == "timoshenko halves")
        .map(|row| row[2].parse().unwrap())
        .collect();
    assert_eq!(reference.len(), 50);
    // The cut-off of the first segment is at 632 rad/s.
    for (n, (ours, theirs)) in modes.omega_rad_s().iter().zip(&reference).enumerate() {
        assert!((ours / theirs - 1.0).abs() < 1e-12, "mode {n}: {ours} {theirs}");
    }
}

/// Up to the five hundredth mode of stepped beams, thick and slender, of both spectra and below the second.
#[test]
fn five_hundred_modes_against_multiple_precision() {
    use End::{Clamped, Free, Pinned};
    let thick = [(segment(0.6, 1.0, 1.0), shear(400.0, 1e-3)), (segment(0.4, 0.4, 0.6), shear(280.0, 4e-4))];
    let forty = [(segment(0.5, 273.0, 1.0), shear(1.4e5, 5e-4)), (segment(0.5, 34.2, 0.5), shear(7e4, 2.5e-4))];
    let end = |length: f64| (segment(length, 1.0, 1.0), shear(4e6, 1e-7));
    let slender = [end(0.3), (segment(0.45, 0.4, 0.8), shear(3e6, 8e-8)), end(0.25)];
    for (name, parts, ends) in [
        ("thick", &thick[..], [Clamped, Free]),
        ("forty thicknesses", &forty[..], [Clamped, Pinned]),
        ("slender", &slender[..], [Free, Pinned]),
    ] {
        let modes = timoshenko(parts, ends).modes(500).unwrap();
        let reference = rows(include_str!("data/timoshenko_modes_reference.csv")).filter(|row| row[0] == name);
        let mut worst = 0.0f64;
        for row in reference {
            let (n, theirs): (usize, f64) = (row[1].parse().unwrap(), row[2].parse().unwrap());
            let error = (modes.omega_rad_s()[n - 1] / theirs - 1.0).abs();
            assert!(error < 1e-12, "{name}, mode {n}: {error:e}");
            worst = worst.max(error);
        }
        println!("{name}: {worst:e}");
    }
}

/// Largest entry of `int m w_i w_j + rho I t_i t_j dx - delta_ij`.
fn defect(parts: &[(Segment, ShearSection)], modes: &Modes) -> f64 {
    let n = modes.len();
    let rule = gauss_rule(16);
    let mut gram = vec![0.0; n * n];
    let mut start = 0.0;
    for (part, section) in parts {
        let panels = 2 + n / 2;
        let h = part.length_m / panels as f64;
        for panel in 0..panels {
            for &(node, weight) in &rule {
                let x = start + h * (panel as f64 + 0.5 * (1.0 + node));
                let w = modes.shapes_at(x).unwrap();
                let t: Vec<f64> = (0..n).map(|k| modes.rotation(k, x).unwrap()).collect();
                for i in 0..n {
                    for j in 0..=i {
                        gram[i * n + j] += 0.5
                            * h
                            * weight
                            * (part.mass_per_length_kg_m * w[i] * w[j] + section.rotary_inertia_kg_m * t[i] * t[j]);
                    }
                }
            }
        }
        start += part.length_m;
    }
    (0..n).flat_map(|i| (0..=i).map(move |j| (i, j))).fold(0.0, |worst, (i, j)| {
        let delta = if i == j { 1.0 } else { 0.0 };
        f64::max(worst, (gram[i * n + j] - delta).abs())
    })
}

#[test]
fn shapes_are_orthonormal_with_rotary_inertia() {
    let parts = [
        (segment(0.5, 1.0, 1.0), shear(400.0, 1e-3)),
        (segment(0.02, 0.5, 0.8), shear(300.0, 7e-4)),
        (segment(0.48, 1.0, 1.0), shear(400.0, 1e-3)),
    ];
    for left in ENDS {
        for right in ENDS {
            let modes = timoshenko(&parts, [left, right]).modes(60).unwrap();
            let defect = defect(&parts, &modes);
            assert!(defect < 1e-11, "{left:?} {right:?}: {defect:e}");
        }
    }
}

/// Green's function compared with the sum over the modes, whose tail decreases as the inverse of their number: for different
/// locations, where the terms alternate, and the law of the rest at one location.
#[test]
fn static_compliance_is_the_sum_over_the_modes() {
    let parts = [(segment(0.6, 1.0, 1.0), shear(400.0, 1e-3)), (segment(0.4, 0.4, 0.6), shear(280.0, 4e-4))];
    for left in ENDS {
        for right in ENDS {
            let system = timoshenko(&parts, [left, right]);
            let modes = system.modes(3000).unwrap();
            let sum = |x: f64, y: f64, count: usize| {
                let (u, v) = (modes.shapes_at(x).unwrap(), modes.shapes_at(y).unwrap());
                let first = modes.rigid_body_count();
                (first..count).map(|k| u[k] * v[k] / modes.omega_rad_s()[k].powi(2)).sum::<f64>()
            };
            let (apart, at) = (system.static_green(0.31, 0.83).unwrap(), system.static_compliance(0.31).unwrap());
            assert!((sum(0.31, 0.83, 3000) - apart).abs() < 1e-6 * at, "{left:?} {right:?}");
            assert!((apart - system.static_green(0.83, 0.31).unwrap()).abs() < 1e-13 * at);
            let rest = [1500, 3000].map(|count| at - sum(0.31, 0.31, count));
            assert!(rest[1] > 0.0 && (rest[0] / rest[1] - 2.0).abs() < 0.02, "{left:?} {right:?}: {rest:?}");
        }
    }
}

#[test]
fn static_compliance_in_closed_form() {
    let section = shear(40.0, 1e-2);
    for x in [0.1, 0.5, 0.77] {
        let uniform = |ends| timoshenko(&[(segment(1.0, 2.0, 1.0), section)], ends).static_compliance(x).unwrap();
        let pinned = (x * (1.0 - x)).powi(2) / 6.0 + x * (1.0 - x) / 40.0;
        assert!((uniform([End::Pinned; 2]) / pinned - 1.0).abs() < 1e-14);
        let cantilever = x.powi(3) / 6.0 + x / 40.0;
        assert!((uniform([End::Clamped, End::Free]) / cantilever - 1.0).abs() < 1e-14);
    }
}

/// The limit of infinite shear rigidity and zero rotary inertia.
#[test]
fn the_limit_is_euler_bernoulli() {
    let segments = [segment(0.5, 1.0, 1.0), segment(0.2, 0.3, 0.6), segment(0.3, 2.0, 1.3)];
    for left in ENDS {
        for right in ENDS {
            let slender = Beam { segments: segments.to_vec(), ends: [left, right] };
            let stiff = timoshenko(&segments.map(|s| (s, shear(1e16, 0.0))), [left, right]);
            let (exact, ours) = (slender.modes(40).unwrap(), stiff.modes(40).unwrap());
            assert_eq!(exact.rigid_body_count(), ours.rigid_body_count());
            for k in 0..40 {
                let (theirs, omega) = (exact.omega_rad_s()[k], ours.omega_rad_s()[k]);
                assert!((omega - theirs).abs() <= 1e-9 * theirs, "{left:?} {right:?} {k}: {omega} {theirs}");
                for x in [0.0, 0.21, 0.55, 1.0] {
                    let difference = exact.shape(k, x).unwrap() - ours.shape(k, x).unwrap();
                    assert!(difference.abs() < 1e-9, "{left:?} {right:?} {k} at {x}: {difference:e}");
                }
            }
            let [theirs, stiff] = [slender.static_compliance(0.6).unwrap(), stiff.static_compliance(0.6).unwrap()];
            assert!((stiff / theirs - 1.0).abs() < 1e-12 || theirs == 0.0);
        }
    }
}

/// A uniform beam does not depend on its division, nor on its direction; five hundred modes each.
#[test]
fn neither_division_nor_direction_matters() {
    let section = shear(40.0, 1e-2);
    let whole = timoshenko(&[(segment(1.0, 1.0, 1.0), section)], [End::Clamped, End::Free]).modes(500).unwrap();
    let hair = shear(40.0 * (1.0 + 1e-15), 1e-2);
    let parts = [(segment(0.3, 1.0, 1.0), section), (segment(0.7, 1.0, 1.0), hair)];
    let cut = timoshenko(&parts, [End::Clamped, End::Free]).modes(500).unwrap();
    let turned = [parts[1], parts[0]];
    let turned = timoshenko(&turned, [End::Free, End::Clamped]).modes(500).unwrap();
    for k in 0..500 {
        let omega = whole.omega_rad_s()[k];
        for other in [&cut, &turned] {
            assert!((other.omega_rad_s()[k] / omega - 1.0).abs() < 1e-12, "{k}");
        }
        let shapes = [whole.shape(k, 0.62), cut.shape(k, 0.62), turned.shape(k, 0.38)].map(|s| s.unwrap().abs());
        assert!((shapes[1] - shapes[0]).abs() < 1e-9 && (shapes[2] - shapes[0]).abs() < 1e-9, "{k}: {shapes:?}");
    }
}

/// The remainder of a Timoshenko beam, whose tail decreases as `1/N`, has its whole compliance.
#[test]
fn the_remainder_has_the_compliance_of_the_tail() {
    let system = timoshenko(&[(segment(1.0, 1.0, 1.0), shear(400.0, 1e-3))], [End::Pinned, End::Clamped]);
    let (x, kept) = (0.37, 60);
    let modes = system.modes(kept).unwrap();
    let shapes = modes.shapes_at(x).unwrap();
    let sum: f64 = shapes.iter().zip(modes.omega_rad_s()).map(|(phi, omega)| (phi / omega).powi(2)).sum();
    let remainder = system.remainder(x, kept, 4).unwrap();
    assert!(remainder.len() == 4 && remainder[0].omega_rad_s > modes.omega_rad_s()[kept - 1]);
    let rest: f64 = remainder.iter().map(|m| (m.shape / m.omega_rad_s).powi(2)).sum();
    assert!(((sum + rest) / system.static_compliance(x).unwrap() - 1.0).abs() < 1e-13);
}

#[test]
fn bad_shear_is_named() {
    let field = |section: ShearSection| {
        timoshenko(&[(segment(1.0, 1.0, 1.0), section)], [End::Free; 2]).modes(3).unwrap_err().field
    };
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-12] {
        assert_eq!(field(shear(bad, 1e-3)), "segments[0].shear_rigidity_n", "{bad}");
    }
    for bad in [-1.0, f64::NAN, f64::INFINITY, 1e12] {
        assert_eq!(field(shear(1.0, bad)), "segments[0].rotary_inertia_kg_m", "{bad}");
    }
    let two = vec![shear(1.0, 1.0); 2];
    let system = BeamSystem {
        shear: Some(two),
        ..BeamSystem::from(Beam { segments: vec![segment(1.0, 1.0, 1.0)], ends: [End::Free; 2] })
    };
    assert_eq!(system.modes(3).unwrap_err().field, "shear");
    let axial = BeamSystem { shear: Some(vec![shear(1.0, 1.0)]), axial_force_n: 1.0, ..system.clone() };
    assert_eq!(axial.modes(3).unwrap_err().field, "axial_force_n");
}
