//! The scatter of the law: its closed forms compared with each other, and limits.
#![cfg(feature = "scatter")]

use emoc::{Impact, Parameters, Scatter, ScatteredLaw, Site};

fn impact(mass_kg: f64) -> Impact {
    Impact::new(mass_kg, &Site::new(&[1.2, 0.9, -0.7, 1.1]).unwrap()).unwrap()
}

#[test]
fn probability_is_the_inverse_of_the_draw_and_density_its_derivative() {
    for mass_kg in [1e-3, 0.03, 0.5, 20.0] {
        for notional_restitution in [1.0, 0.6] {
            let law = Parameters { notional_restitution, ..ScatteredLaw::BEAMS.law };
            let scatter = ScatteredLaw { law, ..ScatteredLaw::BEAMS }.rebound(&impact(mass_kg)).unwrap();
            for uniform in [1e-6, 0.01, 0.3, 0.5, 0.8, 0.999] {
                let e = scatter.draw(uniform).unwrap();
                assert!(e > 0.0 && e < notional_restitution);
                let below = |e: f64| scatter.probability_below(e).unwrap();
                assert!((below(e) - uniform).abs() < 1e-9, "{scatter:?} {uniform}");
                // Relative to the distance from the nearer end.
                let step = 1e-6 * e.min(notional_restitution - e);
                let slope = (below(e + step) - below(e - step)) / (2.0 * step);
                assert!((scatter.log_density(e) - slope.ln()).abs() < 1e-4, "{scatter:?} {uniform}");
            }
        }
    }
}

#[test]
fn the_median_is_the_law_and_the_interval_contains_its_share() {
    for mass_kg in [1e-3, 0.03, 0.5, 20.0] {
        let impact = impact(mass_kg);
        let scatter = ScatteredLaw::BEAMS.rebound(&impact).unwrap();
        let median = ScatteredLaw::BEAMS.law.rebound(&impact).unwrap().restitution;
        assert!((scatter.draw(0.5).unwrap() - median).abs() < 1e-15);
        let [low, high] = scatter.interval(0.8).unwrap();
        let within = scatter.probability_below(high).unwrap() - scatter.probability_below(low).unwrap();
        assert!((within - 0.8).abs() < 1e-12);
        // The same share of draws.
        let draws = (0..1000).map(|k| scatter.draw((f64::from(k) + 0.5) / 1000.0).unwrap());
        assert_eq!(draws.filter(|e| (low..=high).contains(e)).count(), 800);
    }
}

#[test]
fn nothing_leaves_the_range_and_nothing_is_not_a_number() {
    let edges = [0.0, f64::MIN_POSITIVE, 1e-300, 1e-9, 0.5, 1.0 - f64::EPSILON, 1.0];
    for median_share in edges {
        for scale in [1e-6, 0.3, 50.0, 1e6] {
            for notional_restitution in [0.0, 0.4, 1.0] {
                let scatter = Scatter { median_share, scale, notional_restitution };
                for uniform in edges {
                    let e = scatter.draw(uniform).unwrap();
                    assert!((0.0..=notional_restitution).contains(&e), "{scatter:?} {uniform}: {e}");
                    let below = scatter.probability_below(e).unwrap();
                    assert!((0.0..=1.0).contains(&below), "{scatter:?} {e}: {below}");
                    assert!(!scatter.log_density(e).is_nan());
                }
            }
        }
    }
    // A fixed point returns the whole speed.
    let rigid = Impact::new(1.0, &Site::new(&[0.0]).unwrap()).unwrap();
    let scatter = ScatteredLaw::BEAMS.rebound(&rigid).unwrap();
    assert_eq!([0.0, 0.5, 1.0].map(|u| scatter.draw(u).unwrap()), [1.0; 3]);
    // An unbounded Z is not an error.
    let heavy = Impact { mass_kg: 1.0, z: f64::MAX, s0: f64::MAX, s1: f64::MAX };
    assert!(ScatteredLaw::BEAMS.rebound(&heavy).unwrap().scale.is_finite());
}

#[test]
fn errors_name_the_field() {
    let scatter = ScatteredLaw::BEAMS.rebound(&impact(0.1)).unwrap();
    for uniform in [-0.1, 1.1, f64::NAN] {
        assert_eq!(scatter.draw(uniform).unwrap_err().field, "uniform");
        assert_eq!(scatter.interval(uniform).unwrap_err().field, "level");
    }
    assert_eq!(scatter.probability_below(f64::NAN).unwrap_err().field, "restitution");
    let fault = |law: ScatteredLaw| law.rebound(&impact(0.1)).unwrap_err().field;
    assert_eq!(fault(ScatteredLaw { single: 0.0, ..ScatteredLaw::BEAMS }), "single");
    assert_eq!(fault(ScatteredLaw { repeated: -1.0, ..ScatteredLaw::BEAMS }), "repeated");
    assert_eq!(fault(ScatteredLaw { onset: f64::NAN, ..ScatteredLaw::BEAMS }), "onset");
}
