//! Permanent indentation after a plastic contact.

use contact_models::{Hertz, Thornton, trace};
use std::f64::consts::PI;

/// Presses to the given depths, each back to a gap, in unit time.
fn presses<'a>(depths: &'a [f64]) -> (Vec<f64>, impl Fn(f64) -> (f64, f64) + 'a) {
    let times = (0..=200 * depths.len() as u32).map(|i| f64::from(i) / 200.0).collect();
    let motion = |t: f64| {
        let i = (t as usize).min(depths.len() - 1);
        let (phase, swing) = (2.0 * PI * (t - i as f64), depths[i] + 0.1);
        (0.5 * swing * (1.0 - phase.cos()) - 0.1, PI * swing * phase.sin())
    };
    (times, motion)
}

#[test]
fn a_second_lighter_press_is_elastic_and_a_deeper_one_yields_again() {
    let law = Thornton::new(1.0, 1.0, 0.3).unwrap();
    let (times, motion) = presses(&[1.5, 1.4, 1.5, 2.5]);
    let path = trace(&law, &times, motion).unwrap();
    let lost = |time: f64| {
        let point = path.iter().find(|point| point.time_s == time).unwrap();
        point.work_j - point.stored_energy_j
    };
    assert!(lost(1.0) > 0.05);
    assert!((lost(2.0) - lost(1.0)).abs() < 1e-12, "a lighter press loses nothing");
    assert!((lost(3.0) - lost(2.0)).abs() < 1e-12, "an equal press loses nothing");
    assert!(lost(4.0) > lost(3.0) + 0.05);
    // The loading line does not depend on the number of presses by which it was followed.
    let (times, motion) = presses(&[2.5]);
    let once = trace(&law, &times, motion).unwrap();
    assert!((lost(4.0) - once.last().unwrap().work_j).abs() < 1e-9);
}

/// Below yield the law is Hertz of the same bodies; unloading is Hertz of Thornton's radius.
#[test]
fn elastic_lines_are_hertz() {
    let (modulus, radius, pressure) = (1.1e11, 0.015, 1.2e9);
    let law = Thornton::new(modulus, radius, pressure).unwrap();
    let hertz = |radius: f64| Hertz::new(4.0 / 3.0 * modulus * radius.sqrt()).unwrap();
    use contact_models::{After, ContactLaw, Memory};
    let touch = law.touch(&Memory::default(), 1.0);
    let xi = 0.7 * law.yield_compression_m();
    let elastic = hertz(radius).force(&touch, xi, 0.0);
    assert!((law.force(&touch, xi, 0.0).force_n / elastic.force_n - 1.0).abs() < 1e-14);

    let xi_max = 5.0 * law.yield_compression_m();
    let After::Continue(loading) = law.cross(&touch, 1, law.yield_compression_m(), 1.0) else { panic!() };
    // Force and slope are continuous at yield.
    let (before, after) =
        (law.force(&touch, law.yield_compression_m(), 0.0), law.force(&loading, law.yield_compression_m(), 0.0));
    assert!((before.force_n / after.force_n - 1.0).abs() < 1e-14);
    assert!((before.per_compression_n_m / after.per_compression_n_m - 1.0).abs() < 1e-14);

    let After::Continue(unloading) = law.cross(&loading, 0, xi_max, 0.0) else { panic!() };
    let (f_max, f_y) = (law.force(&loading, xi_max, 0.0).force_n, law.yield_force_n());
    let flattened = 4.0 * modulus / (3.0 * f_max) * ((2.0 * f_max + f_y) / (2.0 * PI * pressure)).powf(1.5);
    for share in [0.1, 0.5, 1.0] {
        let depth = share * (xi_max - unloading.anchor_m);
        let expected = hertz(flattened).force(&touch, depth, 0.0).force_n;
        let got = law.force(&unloading, unloading.anchor_m + depth, 0.0).force_n;
        assert!((got / expected - 1.0).abs() < 1e-12, "{share}");
    }
}
