//! The spectral solution compared with independent methods and closed forms.

use std::f64::consts::PI;
use vibroimpact_sim::infinite::{BeamSection, FirstContact, Impact, Material, Settings, Solution, Structure, solve};
use vibroimpact_sim::modal::Striker;

fn once() -> Settings {
    Settings { estimate_uncertainty: false, ..Settings::default() }
}

fn beam(s: f64) -> Solution {
    solve(Structure::Beam, s, &Settings::default()).unwrap()
}

/// First contacts in 25-digit arithmetic by another discretisation (one global panel); the script is beside the data.
#[test]
fn first_contact_against_multiprecision() {
    let data = include_str!("data/infinite_first_contact.csv");
    let mut rows = 0;
    for line in data.lines().skip(1) {
        let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
        // The finer of the two numbers of nodes.
        if cells[1] < 30.0 {
            continue;
        }
        let solution = beam(cells[0]);
        let duration = solution.sub_impacts[0].duration.unwrap();
        let ratio = solution.first_rebound_ratio().unwrap();
        assert!((duration / cells[2] - 1.0).abs() < 1e-12, "{line}: {duration}");
        assert!((ratio - cells[3]).abs() < 1e-12, "{line}: {ratio}");
        rows += 1;
    }
    assert!(rows >= 5);
}

/// Solution of the Volterra equation by the product trapezoidal rule on a uniform grid: compressions at the grid points. It is
/// of second order, so that two grids can be extrapolated.
fn march(s: f64, end: f64, steps: usize) -> Vec<f64> {
    let h = end / steps as f64;
    // Weights of hat functions: second differences of the kernel's second integral.
    let second = |m: f64| (m * h).powi(3) / 6.0 + 4.0 / 15.0 * (m * h).powf(2.5);
    let weight: Vec<f64> = (0..=steps)
        .map(|m| {
            let m = m as f64;
            let before = if m > 0.0 { second(m - 1.0) } else { 0.0 };
            (second(m + 1.0) - 2.0 * second(m) + before) / h
        })
        .collect();
    let (mut x, mut f) = (vec![0.0; steps + 1], vec![0.0; steps + 1]);
    for n in 1..=steps {
        let past: f64 = (1..n).map(|j| weight[n - j] * f[j]).sum();
        let free = n as f64 * h - past;
        // x + w f(x) = free, by Newton's method.
        let mut value = free.min(x[n - 1] + 2.0 * h);
        for _ in 0..50 {
            let up = value.max(0.0);
            let step =
                (value + weight[0] * s.sqrt() * up.powf(1.5) - free) / (1.0 + weight[0] * s.sqrt() * 1.5 * up.sqrt());
            value -= step;
            if step.abs() < 1e-16 {
                break;
            }
        }
        (x[n], f[n]) = (value, s.sqrt() * value.max(0.0).powf(1.5));
    }
    x
}

/// Two contacts and the flight between them, at S = 15 (and one contact at S = 1 and 0.001), compared with the extrapolated
/// trapezoidal rule.
#[test]
fn agrees_with_a_trapezoidal_march() {
    for (s, end, steps) in [(1e-3, 20.0, 1500), (1.0, 8.0, 1500), (100.0, 20.0, 5000), (15.0, 46.0, 6000)] {
        let solution = solve(Structure::Beam, s, &Settings { horizon: end, ..once() }).unwrap();
        let (coarse, fine) = (march(s, end, steps), march(s, end, 2 * steps));
        let (mut worst, mut worst_fine) = (0.0_f64, 0.0_f64);
        for n in 1..=steps {
            let state = solution.at(end * n as f64 / steps as f64).unwrap();
            let extrapolated = fine[2 * n] + (fine[2 * n] - coarse[n]) / 3.0;
            worst = worst.max((extrapolated - state.compression).abs());
            worst_fine = worst_fine.max((fine[2 * n] - state.compression).abs());
        }
        assert!(worst < 2e-6 * end && worst < 0.5 * worst_fine, "S = {s}: {worst:e} {worst_fine:e}");
    }
}

/// The method of the thesis (appendix A.1): the beam's memory as N internal states on a range of frequencies, with the
/// frequencies above taken as quasi-steady. Here it is driven by the force, `y' = (1/sqrt(pi)) int a(xi) d xi`,
/// `a' = -xi^2 a + f`, and integrated by Runge-Kutta steps.
#[test]
fn agrees_with_internal_states() {
    let (s, states) = (15.0_f64, 56);
    let (low, high) = (1e-4_f64, 150.0_f64);
    let spacing = (high / low).ln() / (states - 1) as f64;
    let xi: Vec<f64> = (0..states).map(|k| low * (spacing * k as f64).exp()).collect();
    let weight: Vec<f64> =
        (0..states).map(|k| xi[k] * spacing * if k == 0 || k + 1 == states { 0.5 } else { 1.0 }).collect();
    // (x, u, impulse, a_1 .. a_N)
    let rates = |y: &[f64], d: &mut [f64]| {
        let f = s.sqrt() * y[0].max(0.0).powf(1.5);
        let memory: f64 = weight.iter().zip(&y[3..]).map(|(w, a)| w * a).sum();
        d[0] = y[1] - (memory + low * y[2] + f / high) / PI.sqrt();
        d[1] = -f;
        d[2] = f;
        for k in 0..states {
            d[3 + k] = f - xi[k] * xi[k] * y[3 + k];
        }
    };
    let solution = beam(s);
    let duration = solution.sub_impacts[0].duration.unwrap();
    let n = states + 3;
    let steps = 30_000;
    let h = duration / steps as f64;
    let (mut y, mut k, mut z) = (vec![0.0; n], vec![vec![0.0; n]; 4], vec![0.0; n]);
    y[1] = 1.0;
    let mut worst = 0.0_f64;
    for step in 1..=steps {
        for stage in 0..4 {
            let c = [0.0, 0.5, 0.5, 1.0][stage] * h;
            for i in 0..n {
                z[i] = y[i] + if stage > 0 { c * k[stage - 1][i] } else { 0.0 };
            }
            rates(&z, &mut k[stage]);
        }
        for i in 0..n {
            y[i] += h / 6.0 * (k[0][i] + 2.0 * k[1][i] + 2.0 * k[2][i] + k[3][i]);
        }
        let state = solution.at(duration * step as f64 / steps as f64).unwrap();
        worst = worst.max((state.compression - y[0]).abs()).max((state.striker_velocity + y[1]).abs());
    }
    assert!(worst < 2e-5, "{worst:e}");
}

/// Errors decrease with the tolerance and the number of nodes, and the error estimate has the size of the error.
#[test]
fn converges_with_a_correct_error_estimate() {
    let exact = solve(Structure::Beam, 15.0, &Settings { nodes: 28, tolerance: 1e-13, ..once() }).unwrap();
    let error = |solution: &Solution| {
        assert_eq!(solution.sub_impacts.len(), exact.sub_impacts.len());
        let pairs = solution.sub_impacts.iter().zip(&exact.sub_impacts);
        pairs.map(|(a, b)| (a.closing_speed / b.closing_speed - 1.0).abs()).fold(0.0, f64::max)
    };
    let run = |nodes: usize, tolerance: f64| {
        let solution = solve(Structure::Beam, 15.0, &Settings { nodes, tolerance, ..Settings::default() }).unwrap();
        (error(&solution), solution.relative_uncertainty.unwrap())
    };
    let (rough, estimate) = run(8, 1e-3);
    assert!(rough > 1e-11 && rough < 1e-4 && estimate > 0.1 * rough, "{rough:e} {estimate:e}");
    let (fine, estimate) = run(20, 1e-10);
    assert!(fine < 1e-12 && estimate < 1e-12, "{fine:e} {estimate:e}");
}

/// The motion at any time is consistent: it is continuous at touch and separation, rates are derivatives, the body's momentum
/// balances the impulse, and nothing penetrates in flight.
#[test]
fn motion_is_consistent() {
    let solution = solve(Structure::Beam, 15.0, &Settings { horizon: 200.0, ..once() }).unwrap();
    for contact in &solution.sub_impacts {
        for time in [Some(contact.start), contact.end].into_iter().flatten() {
            let (a, b) = (solution.at(time * (1.0 - 1e-12)), solution.at(time * (1.0 + 1e-12) + 1e-13));
            let (a, b) = (a.unwrap(), b.unwrap());
            assert!((a.striker_displacement - b.striker_displacement).abs() < 1e-9);
            assert!((a.structure_displacement - b.structure_displacement).abs() < 1e-9);
            assert!((a.structure_velocity - b.structure_velocity).abs() < 1e-7, "{time}: {a:?} {b:?}");
        }
    }
    for n in 1..2000 {
        let t = 0.0987 * f64::from(n);
        let h = 1e-4 * (t.min(1.0));
        let (now, before, after) = (solution.at(t).unwrap(), solution.at(t - h).unwrap(), solution.at(t + h).unwrap());
        assert!((now.compression > 0.0) == (now.force > 0.0));
        let rate = (after.compression - before.compression) / (2.0 * h);
        assert!((rate - now.compression_rate).abs() < 2e-6, "{t}: {rate} {now:?}");
        let speed = (after.striker_displacement - before.striker_displacement) / (2.0 * h);
        assert!((speed - now.striker_velocity).abs() < 2e-6);
        let force = (after.striker_velocity - before.striker_velocity) / (2.0 * h);
        assert!((force - now.force).abs() < 1e-4, "{t}: {force} {now:?}");
        let sum = now.structure_displacement - now.striker_displacement - now.compression;
        assert!(sum.abs() < 1e-12);
    }
}

/// The largest force is that of the largest compression, also where it lies next to an end of a panel.
#[test]
fn the_largest_force_is_that_of_the_largest_compression() {
    for k in 0..120 {
        let s = 10_f64.powf(-3.0 + 0.05 * f64::from(k));
        let solution = solve(Structure::Beam, s, &once()).unwrap();
        for (contact, force) in solution.peak_forces().into_iter().enumerate() {
            let of_contact = solution.extrema.iter().filter(|extremum| extremum.contact == contact);
            let compression = of_contact.map(|extremum| extremum.compression).fold(0.0, f64::max);
            let by_law = s.sqrt() * compression.powf(1.5);
            assert!((force / by_law - 1.0).abs() < 1e-11, "{s} {contact}: {force} {by_law}");
        }
    }
}

/// Thesis Table 2.1 (steel sphere, square steel beam), to 0.5 %.
#[test]
fn table_2_1() {
    for (b, r, v, s) in [
        (0.03, 0.02, 0.2, 4.05e-6),
        (0.03, 0.03, 0.1, 0.0512),
        (0.028, 0.033, 0.5, 15.556),
        (0.02, 0.027, 0.4, 371.05),
        (0.015, 0.04, 1.55e-6, 3.54e4),
        (0.05, 0.03, 10000.0, 0.0146),
    ] {
        let groups = Impact::sphere_on_beam(Material::STEEL, b, b, r, v).unwrap().groups().unwrap();
        assert!((groups.s / s - 1.0).abs() < 5e-3, "{b} {r} {v}: {} {s}", groups.s);
    }
}

/// Thesis Table A.1 and the invariance of Fig. A.1: one S, one dimensionless force.
#[test]
fn table_and_figure_a_1() {
    let sets = [
        (0.0279, 1.6481, 97.43, 0.0838, 1.105, 7.389),
        (0.30, 5.0, 2.0, 13.9715, 77.62, 0.36),
        (0.8082, 1.0, 1.2372, 0.8082, 1.0, 1.0),
    ];
    for (c, k, m, v, force, time) in sets {
        let impact =
            Impact { structure: Structure::Beam, impulse_response: c, stiffness_n_m1_5: k, mass_kg: m, speed_m_s: v };
        let groups = impact.groups().unwrap();
        assert!((groups.s / 0.528 - 1.0).abs() < 2e-2, "{groups:?}");
        assert!((groups.force_n / force - 1.0).abs() < 3e-3 && (groups.time_s / time - 1.0).abs() < 3e-3);
        assert!((groups.displacement_m / groups.thesis_length_m / groups.s.cbrt() - 1.0).abs() < 1e-13);
        // Dimensional integration of m z'' = f, y from f, with these constants, compared with the scaled solution.
        let solution = beam(groups.s);
        let steps = 3000;
        let h = 2.0 * groups.time_s / steps as f64;
        let second = |n: f64| (n * h).powi(3) / (6.0 * m) + c * 4.0 / 15.0 * (n * h).powf(2.5);
        let weight: Vec<f64> = (0..=steps)
            .map(|n| {
                let n = n as f64;
                (second(n + 1.0) - 2.0 * second(n) + if n > 0.0 { second(n - 1.0) } else { 0.0 }) / h
            })
            .collect();
        let mut f = vec![0.0; steps + 1];
        for n in 1..=steps {
            let past: f64 = (1..n).map(|j| weight[n - j] * f[j]).sum();
            let (mut low, mut high) = (0.0, v * n as f64 * h);
            for _ in 0..60 {
                let mid = 0.5 * (low + high);
                if mid + weight[0] * k * mid.powf(1.5) + past > v * n as f64 * h { high = mid } else { low = mid }
            }
            f[n] = k * low.powf(1.5);
            let scaled = solution.at(n as f64 * h / groups.time_s).unwrap().force;
            assert!((f[n] / groups.force_n - scaled).abs() < 2e-5, "{n}: {} {scaled}", f[n] / groups.force_n);
        }
    }
}

/// A rectangular section given by its dimensions or by EI and mass per length; and a plate.
#[test]
fn physical_parameters() {
    let steel = Material::STEEL;
    let a = Impact::sphere_on_beam(steel, 0.02, 0.03, 0.01, 1.0).unwrap();
    let mass = 4.0 / 3.0 * PI * 1e-6 * 7800.0;
    let beam =
        BeamSection { flexural_rigidity_n_m2: 200e9 * 0.02 * 2.7e-5 / 12.0, mass_per_length_kg_m: 7800.0 * 6e-4 };
    let sphere = Striker { mass_kg: mass, speed_m_s: 1.0 };
    let b = Impact::on_beam(beam, sphere, steel.hertz_stiffness(0.01)).unwrap();
    assert!((a.impulse_response / b.impulse_response - 1.0).abs() < 1e-14);
    assert!((a.groups().unwrap().s / b.groups().unwrap().s - 1.0).abs() < 1e-13);
    let plate = Impact::sphere_on_plate(steel, 0.005, 0.01, 1.0).unwrap();
    let groups = plate.groups().unwrap();
    let (alpha, k) = (plate.impulse_response, plate.stiffness_n_m1_5);
    assert!((groups.s / (alpha.powi(5) * k * k * mass.powi(3)) - 1.0).abs() < 1e-12);
    for (width, field) in [(0.0, "width_m"), (f64::NAN, "width_m"), (-1.0, "width_m")] {
        assert_eq!(Impact::sphere_on_beam(steel, width, 0.03, 0.01, 1.0).unwrap_err().field, field);
    }
    let fluid = Material { poissons_ratio: 0.7, ..steel };
    assert_eq!(Impact::sphere_on_plate(fluid, 0.03, 0.01, 1.0).unwrap_err().field, "poissons_ratio");
    assert!(Impact { mass_kg: 1e200, ..a }.groups().is_err());
}

/// Semi-analytical first contact: thesis Fig. 2.6 (m = 0.555 at v = 70, 0.769 at v = 125). It agrees with the full solution up
/// to S = 1.2e4, more closely with more functions.
#[test]
fn semi_analytical_first_contact() {
    for (v, m) in [(70.0, 0.555), (125.0, 0.769)] {
        let contact = FirstContact::at_speed(v, 6).unwrap();
        assert!((contact.mass - m).abs() < 6e-4, "{contact:?}");
        let solution = beam(contact.s);
        for n in 1..20 {
            let t = contact.duration() * f64::from(n) / 20.0;
            let full = solution.at(t).unwrap().force;
            assert!((contact.nondimensional_force(t) - full).abs() < 0.02, "{v} {t}: {full}");
        }
    }
    for s in [1e-10, 1e-5, 1e-2, 1.0, 15.0, 100.0, 1e3, 5e3] {
        let full = beam(s);
        let error = |n: usize| {
            let contact = FirstContact::at_s(s, n).unwrap();
            assert!((contact.s / s - 1.0).abs() < 1e-10);
            assert!((contact.duration() / full.sub_impacts[0].duration.unwrap() - 1.0).abs() < 6e-3);
            (contact.rebound_ratio() - full.first_rebound_ratio().unwrap()).abs()
        };
        assert!(error(6) < 2e-3 && error(12) < 0.5 * error(6), "{s}: {} {}", error(6), error(12));
    }
    // The range of the thesis for six functions ends at 1.2e4: beyond it there is no solution whose force is positive
    // throughout.
    let full = beam(1.2e4).first_rebound_ratio().unwrap();
    let errors = [6, 8, 10, 12, 14].map(|n| (FirstContact::at_s(1.2e4, n).unwrap().rebound_ratio() - full).abs());
    assert!(errors[0] < 3e-3 && errors.windows(2).all(|pair| pair[1] < 0.7 * pair[0]), "{errors:?}");
    assert!(FirstContact::at_s(1.5e4, 6).is_err() && FirstContact::at_s(1.5e4, 14).is_ok());
    assert_eq!(FirstContact::at_s(1e6, 6).unwrap_err().field, "s");
    assert_eq!(FirstContact::at_speed(f64::NAN, 6).unwrap_err().field, "speed");
    assert_eq!(FirstContact::at_speed(1.0, 40).unwrap_err().field, "n");
}
