//! Remainder modes compared with moments summed directly.

use crate::common::{ENDS, segment};
use beam_modes::{Beam, End, PointMode, PointsMode, remainder_at_points, remainder_from_trend, remainder_modes};

fn moment(modes: &[PointMode], order: i32) -> f64 {
    modes.iter().rev().map(|m| m.shape * m.shape * m.omega_rad_s.powi(-2 * order)).sum()
}

/// A pinned beam of unit length, rigidity and mass per length, struck at the golden section.
fn pinned(k: usize) -> PointMode {
    let q = k as f64 * std::f64::consts::PI;
    PointMode { omega_rad_s: q * q, shape: 2f64.sqrt() * (q * 0.618_033_988_749_894_9).sin() }
}

#[test]
fn twice_as_many_moments_as_modes() {
    for n in [0, 1, 20, 300] {
        let tail: Vec<PointMode> = (n + 1..n + 1001).map(pinned).collect();
        for count in 1..=4 {
            let remainder = remainder_modes(&tail, 0.0, count).unwrap();
            assert_eq!(remainder.len(), count);
            assert!(remainder.windows(2).all(|w| w[0].omega_rad_s < w[1].omega_rad_s));
            assert!(remainder[0].omega_rad_s >= tail[0].omega_rad_s);
            for order in 1..=2 * count as i32 {
                let error = moment(&remainder, order) / moment(&tail, order) - 1.0;
                assert!(error.abs() < 1e-12, "n {n}, {count} modes, moment {order}: {error:e}");
            }
        }
    }
}

#[test]
fn a_tail_of_few_frequencies_is_its_own_remainder() {
    let at = |omega_rad_s: f64, shape: f64| PointMode { omega_rad_s, shape };
    let tail = [at(5.0, 1.0), at(9.0, -2.0), at(5.0, 1.0), at(7.0, 0.0)];
    let remainder = remainder_modes(&tail, 0.0, 4).unwrap();
    assert_eq!(remainder.len(), 2);
    assert!((remainder[0].omega_rad_s - 5.0).abs() < 1e-12 && (remainder[0].shape - 2f64.sqrt()).abs() < 1e-12);
    assert!((remainder[1].omega_rad_s - 9.0).abs() < 1e-12 && (remainder[1].shape - 2.0).abs() < 1e-12);
    assert!(remainder_modes(&[at(5.0, 0.0)], 0.0, 3).unwrap().is_empty());
    assert!(remainder_modes(&[], 0.0, 1).unwrap().is_empty());
}

/// Evenly spaced frequencies `k` of equal shapes: the sums beyond `k` are known, and the remainder modes have the first moment
/// exactly and the second in the limit.
#[test]
fn compliance_beyond_the_last_mode_follows_the_law_of_shear_waves() {
    let mode = |k: usize| PointMode { omega_rad_s: k as f64, shape: 1.0 };
    let tail: Vec<PointMode> = (11..=400).map(mode).collect();
    let all: Vec<PointMode> = (11..=4_000_000).map(mode).collect();
    let rest: f64 = (401..40_000_000).rev().map(|k| 1.0 / (k as f64 * k as f64)).sum();
    let whole = moment(&tail, 1) + rest;
    for count in 1..=4 {
        let remainder = remainder_modes(&tail, rest, count).unwrap();
        assert!((moment(&remainder, 1) / whole - 1.0).abs() < 1e-13);
        for order in 2..=2 * count as i32 {
            assert!((moment(&remainder, order) / moment(&all, order) - 1.0).abs() < 1e-6);
        }
    }
}

fn block_moments(modes: &[PointsMode], i: usize, j: usize, order: i32) -> f64 {
    modes.iter().rev().map(|m| m.shapes[i] * m.shapes[j] * m.omega_rad_s.powi(-2 * order)).sum()
}

#[test]
fn several_points_share_their_modes() {
    let beam = Beam { segments: vec![segment(0.6, 1.0, 1.0), segment(0.4, 0.4, 0.7)], ends: [End::Clamped, End::Free] };
    // One twice, one at the clamp, one close to another.
    let places = [0.3, 0.8, 0.0, 0.3, 0.800_001, 1.0];
    let modes = beam.modes(400).unwrap();
    let seen = |k: usize| PointsMode {
        omega_rad_s: modes.omega_rad_s()[k],
        shapes: places.iter().map(|&x| modes.shape(k, x).unwrap()).collect(),
    };
    let tail: Vec<PointsMode> = (30..400).map(seen).collect();
    let remainder = remainder_at_points(&tail, &[0.0; 36]).unwrap();
    assert!((3..=4).contains(&remainder.len()), "{}", remainder.len());
    assert!(remainder.iter().all(|m| m.omega_rad_s > 0.999 * tail[0].omega_rad_s && m.shapes[2] == 0.0));
    for order in 1..=2 {
        for i in 0..places.len() {
            for j in 0..places.len() {
                let size = (block_moments(&tail, i, i, order) * block_moments(&tail, j, j, order)).sqrt();
                let error = block_moments(&remainder, i, j, order) - block_moments(&tail, i, j, order);
                // At the clamp both are rounding.
                assert!(
                    i == 2 || j == 2 || error.abs() <= 1e-9 * size,
                    "moment {order} of {i}, {j}: {error:e} of {size:e}"
                );
            }
        }
    }
    // For a single point the result is the quadrature of its measure.
    let alone: Vec<PointMode> =
        tail.iter().map(|m| PointMode { omega_rad_s: m.omega_rad_s, shape: m.shapes[0] }).collect();
    let first = |m: &PointsMode| PointsMode { omega_rad_s: m.omega_rad_s, shapes: vec![m.shapes[0]] };
    let block = remainder_at_points(&tail.iter().map(first).collect::<Vec<_>>(), &[0.0]).unwrap();
    let gauss = remainder_modes(&alone, 0.0, 1).unwrap();
    assert!((block[0].omega_rad_s / gauss[0].omega_rad_s - 1.0).abs() < 1e-13);
    assert!((block[0].shapes[0].abs() / gauss[0].shape - 1.0).abs() < 1e-13);
}

/// Retained modes and remainder together have the whole static compliance, for any ends.
#[test]
fn a_beam_has_its_whole_compliance() {
    for left in ENDS {
        for right in ENDS {
            let beam = Beam { segments: vec![segment(0.6, 1.0, 1.0), segment(0.4, 0.4, 0.7)], ends: [left, right] };
            let modes = beam.modes(25).unwrap();
            let elastic = modes.rigid_body_count();
            let (x, y) = (0.37, 0.74);
            let sum =
                |u: &[f64], v: &[f64]| (elastic..25).map(|k| u[k] * v[k] / modes.omega_rad_s()[k].powi(2)).sum::<f64>();
            let (u, v) = (modes.shapes_at(x).unwrap(), modes.shapes_at(y).unwrap());
            let whole = beam.static_compliance(x).unwrap();
            for count in 1..=3 {
                let remainder = beam.remainder(x, 25, count).unwrap();
                assert!(remainder[0].omega_rad_s > modes.omega_rad_s()[24]);
                assert!((sum(&u, &u) + moment(&remainder, 1) - whole).abs() < 1e-13 * whole);
            }
            let block = beam.remainder_at(&[x, y], 25).unwrap();
            let cross = beam.static_green(x, y).unwrap();
            let error = sum(&u, &v) + block_moments(&block, 0, 1, 1) - cross;
            assert!(error.abs() < 1e-13 * whole, "{left:?} {right:?}: {error:e}");
        }
    }
}

/// Moments by the trend of the list alone, compared with sums of frequencies that do grow as a power of their index: the first
/// is exact, the others agree as an integral does with a sum.
#[test]
fn a_trend_of_listed_modes_gives_the_tail() {
    for (n, growth, count) in [(6, 2.0, 1), (20, 2.0, 4), (20, 1.0, 4), (40, 1.5, 3), (40, 0.8, 2)] {
        let mode = |k: usize| PointMode { omega_rad_s: (k as f64).powf(growth), shape: 1.0 };
        let (kept, tail): (Vec<_>, Vec<_>) = ((1..=n).map(mode).collect(), (n + 1..2_000_000).map(mode).collect());
        let remainder = remainder_from_trend(&kept, moment(&tail, 1), count).unwrap();
        assert_eq!(remainder.len(), count);
        assert!(remainder[0].omega_rad_s > kept[n - 1].omega_rad_s);
        assert!((moment(&remainder, 1) / moment(&tail, 1) - 1.0).abs() < 1e-12);
        for order in 2..=2 * count as i32 {
            let power = 2.0 * growth * f64::from(order);
            let sum_by_integral = power * (power - 1.0) / (24.0 * (n as f64 + 0.5).powi(2));
            let error = moment(&remainder, order) / moment(&tail, order) - 1.0;
            assert!(error.abs() < 0.01 + 2.0 * sum_by_integral, "{n} {growth} {order}: {error:e} {sum_by_integral:e}");
        }
    }
    let rigid = PointMode { omega_rad_s: 0.0, shape: 1.0 };
    assert!(remainder_from_trend(&[rigid], 1.0, 4).unwrap().is_empty());
    assert!(remainder_from_trend(&[pinned(1)], 0.0, 4).unwrap().is_empty());
    let one = remainder_from_trend(&[rigid, pinned(1)], 1e-3, 1).unwrap();
    assert!(one.len() == 1 && one[0].omega_rad_s > pinned(1).omega_rad_s);
}

#[test]
fn bad_input_is_named() {
    let field = |result: Result<Vec<PointMode>, beam_modes::InvalidInput>| result.unwrap_err().field;
    let good = [pinned(1)];
    assert_eq!(field(remainder_modes(&good, 0.0, 0)), "count");
    assert_eq!(field(remainder_modes(&good, 0.0, 5)), "count");
    assert_eq!(field(remainder_from_trend(&good, 1.0, 5)), "count");
    assert_eq!(field(remainder_modes(&good, -1.0, 1)), "static_rest_m_n");
    assert_eq!(field(remainder_modes(&good, f64::NAN, 1)), "static_rest_m_n");
    assert_eq!(field(remainder_modes(&[], 1.0, 1)), "static_rest_m_n");
    let bad = |omega_rad_s: f64, shape: f64| [pinned(1), PointMode { omega_rad_s, shape }];
    assert_eq!(field(remainder_modes(&bad(0.0, 1.0), 0.0, 1)), "tail[1].omega_rad_s");
    assert_eq!(field(remainder_modes(&bad(1.0, f64::INFINITY), 0.0, 1)), "tail[1].shape");
    let points = |shapes: &[f64]| PointsMode { omega_rad_s: 1.0, shapes: shapes.to_vec() };
    let unequal = remainder_at_points(&[points(&[1.0]), points(&[])], &[0.0]);
    assert_eq!(unequal.unwrap_err().field, "tail[1].shapes");
    assert_eq!(remainder_at_points(&[points(&[1.0])], &[]).unwrap_err().field, "static_rest_m_n");
    assert_eq!(remainder_from_trend(&[pinned(1)], -1.0, 1).unwrap_err().field, "residual_compliance_m_n");
    let beam = Beam { segments: vec![segment(1.0, 1.0, 1.0)], ends: [End::Pinned; 2] };
    assert_eq!(beam.remainder(2.0, 10, 1).unwrap_err().field, "x_m");
    assert_eq!(beam.remainder(0.5, 100_000, 1).unwrap_err().field, "kept");
}
