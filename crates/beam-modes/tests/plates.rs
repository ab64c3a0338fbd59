//! Plates compared with published tables, closed forms, limits and each other.

use beam_modes::{Edge, Plate, PlateTheory};
use std::f64::consts::PI;

use Edge::{Clamped as C, Free as F, Pinned as P};

/// `a = 1`, with `D = rho h = 1`, so that frequencies are Leissa's `omega a^2 sqrt(rho h/D)`.
fn unit(width_m: f64, poissons_ratio: f64, edges: [Edge; 4]) -> Plate {
    let thickness_m: f64 = 0.01;
    let youngs_modulus_pa = 12.0 * (1.0 - poissons_ratio * poissons_ratio) / thickness_m.powi(3);
    Plate {
        length_m: 1.0,
        width_m,
        thickness_m,
        youngs_modulus_pa,
        poissons_ratio,
        density_kg_m3: 1.0 / thickness_m,
        edges,
        theory: PlateTheory::Kirchhoff,
    }
}

/// Of steel, pinned along all edges.
const STEEL: Plate = Plate {
    length_m: 0.4,
    width_m: 0.3,
    thickness_m: 0.005,
    youngs_modulus_pa: 2e11,
    poissons_ratio: 0.3,
    density_kg_m3: 7800.0,
    edges: [P; 4],
    theory: PlateTheory::Kirchhoff,
};

fn frequencies(plate: &Plate, count: usize) -> Vec<f64> {
    plate.modes(count).unwrap().omega_rad_s().to_vec()
}

/// A. W. Leissa, *J. Sound Vib.* 31 (1973) 257: squares, `nu = 0.3`. With two opposite pinned edges the values are exact. The
/// others, by 36 products of beam functions, are upper bounds, up to 1.1 % too high for free edges.
#[test]
fn leissa_s_tables() {
    let exact: [(&str, [Edge; 4], [f64; 6]); 4] = [
        ("SSSS", [P, P, P, P], [19.7392, 49.3480, 49.3480, 78.9568, 98.6960, 98.6960]),
        ("SCSC", [P, P, C, C], [28.9509, 54.7431, 69.3270, 94.5853, 102.2162, 129.0955]),
        ("SSSF", [P, P, P, F], [11.6845, 27.7563, 41.1967, 59.0655, 61.8606, 90.2941]),
        ("SFSF", [P, P, F, F], [9.6314, 16.1348, 36.7256, 38.9450, 46.7381, 70.7401]),
    ];
    for (name, edges, table) in exact {
        for (found, listed) in frequencies(&unit(1.0, 0.3, edges), 6).iter().zip(table) {
            assert!((found - listed).abs() < 6e-5, "{name}: {found} {listed}");
        }
    }
    let bounds: [(&str, [Edge; 4], usize, [f64; 6]); 3] = [
        ("CCCC", [C, C, C, C], 0, [35.992, 73.413, 73.413, 108.27, 131.64, 132.24]),
        ("CFFF", [C, F, F, F], 0, [3.4917, 8.5246, 21.429, 27.331, 31.111, 54.443]),
        ("FFFF", [F, F, F, F], 3, [13.489, 19.789, 24.432, 35.024, 35.024, 61.526]),
    ];
    for (name, edges, rigid, table) in bounds {
        let plate = unit(1.0, 0.3, edges);
        let modes = plate.modes(rigid + 6).unwrap();
        assert_eq!(modes.rigid_body_count(), rigid);
        assert!(modes.omega_rad_s()[..rigid].iter().all(|omega| *omega == 0.0));
        for (found, listed) in modes.omega_rad_s()[rigid..].iter().zip(table) {
            assert!(*found < listed + 5e-3 && *found > listed * 0.989, "{name}: {found} {listed}");
        }
    }
    // Clamped: 35.98519, 73.39385, 108.2165, 131.5808, 132.2048 are converged in the literature.
    let clamped = frequencies(&unit(1.0, 0.3, [C, C, C, C]), 6);
    for (found, known) in clamped.iter().zip([35.98519, 73.39385, 73.39385, 108.2165, 131.5808, 132.2048]) {
        assert!((found / known - 1.0).abs() < 1e-6, "{found} {known}");
    }
}

/// Ritz's method on plates with a reference: a plate with a pinned edge is half of a free plate twice as long, whose
/// antisymmetric modes have a pinned line. The second test is a longer list.
#[test]
fn ritz_agrees_with_lines_of_symmetry() {
    // Antisymmetric modes of [F, F] about the middle line are those of [P, F] on one half.
    let whole = Plate { length_m: 2.0, ..unit(0.8, 0.3, [F, F, C, P]) };
    let half = unit(0.8, 0.3, [P, F, C, P]);
    // As many polynomials as the singular corners between clamped and free edges require.
    let (all, halves) = (whole.modes(400).unwrap(), frequencies(&half, 200));
    let middle = all.shapes_at(1.0, 0.37).unwrap();
    let odd = all.omega_rad_s().iter().zip(&middle).filter(|(_, phi)| phi.abs() < 1e-9).map(|(omega, _)| *omega);
    for (a, b) in odd.zip(halves).take(10) {
        assert!((a / b - 1.0).abs() < 1e-6, "{a} {b}");
    }
}

/// The stated change of the first modes is an upper bound on the effect of many more polynomials, also where a clamped edge
/// meets a free one.
#[test]
fn the_stated_change_bounds_the_error() {
    for edges in [[C, F, F, P], [C, F, F, F], [C, F, C, F], [F, F, F, F]] {
        let plate = unit(0.75, 0.3, edges);
        let (few, many) = (plate.modes(20).unwrap(), plate.modes(300).unwrap());
        let elastic = few.rigid_body_count()..20;
        let error = |k: usize| few.omega_rad_s()[k] / many.omega_rad_s()[k] - 1.0;
        let largest = elastic.clone().map(error).fold(0.0, f64::max);
        let stated = elastic.clone().map(|k| few.change()[k]).fold(0.0, f64::max);
        assert!(elastic.clone().all(|k| error(k) > -1e-11) && largest < stated, "{edges:?}: {largest:e} {stated:e}");
    }
}

/// Exchanged edges, mirrored edges, and exchanged length and width: the same plate.
#[test]
fn one_plate_seen_in_four_ways() {
    let plate = unit(0.7, 0.25, [C, F, P, F]);
    let (x, y) = (0.3, 0.61);
    let count = 12;
    let modes = plate.modes(count).unwrap();
    let whole = plate.static_compliance(x, y).unwrap();
    let mirrored = (Plate { edges: [F, C, F, P], ..plate }, 1.0 - x, 0.7 - y);
    let turned = (Plate { length_m: 0.7, width_m: 1.0, edges: [P, F, C, F], ..plate }, y, x);
    for (other, x_m, y_m) in [mirrored, turned] {
        let seen = other.modes(count).unwrap();
        for k in 0..count {
            assert!((seen.omega_rad_s()[k] / modes.omega_rad_s()[k] - 1.0).abs() < 1e-9);
            let (a, b) = (seen.shapes_at(x_m, y_m).unwrap()[k], modes.shapes_at(x, y).unwrap()[k]);
            assert!((a.abs() - b.abs()).abs() < 1e-7, "{k}: {a} {b}");
        }
        assert!((other.static_compliance(x_m, y_m).unwrap() / whole - 1.0).abs() < 1e-8);
    }
}

/// A strip without lateral contraction bends as a beam.
#[test]
fn a_narrow_strip_is_a_beam() {
    let strip = unit(0.1, 0.0, [C, F, F, F]);
    let found = frequencies(&strip, 3);
    for (found, root) in found.iter().zip([1.875_104_07_f64, 4.694_091_13, 7.854_757_44]) {
        assert!((found / root.powi(2) - 1.0).abs() < 1e-5, "{found} {root}");
    }
    // At the tip 1/(3 D b), and the local deflection of the plate under the load.
    let tip = strip.static_compliance(1.0, 0.05).unwrap();
    assert!((tip * 3.0 * 0.1 - 1.0).abs() < 0.01, "{tip}");
}

#[test]
fn a_pinned_plate_is_navier_s() {
    let plate = STEEL;
    let modes = plate.modes(500).unwrap();
    // The plate of the gallery as a list of modes.
    assert!((modes.omega_rad_s()[0] - 1312.81534266).abs() < 1e-6);
    assert!((modes.omega_rad_s()[39] - 37809.0818686).abs() < 1e-5);
    assert!(modes.omega_rad_s().windows(2).all(|pair| pair[0] <= pair[1]) && modes.converged(1e-12) == 500);
    let (d, mass) = (plate.flexural_rigidity_n_m(), plate.mass_per_area_kg_m2());
    // No mode is missing: there are as many as pairs (m, n) below the last.
    let last = modes.omega_rad_s()[499];
    let below =
        |m: i32, n: i32| PI * PI * (f64::from(m * m) / 0.16 + f64::from(n * n) / 0.09) * (d / mass).sqrt() <= last;
    let pairs: usize = (1..200).map(|m| (1..200).filter(|n| below(m, *n)).count()).sum();
    assert!((500..=502).contains(&pairs), "{pairs}");
    let centre = plate.static_compliance(0.2, 0.15).unwrap();
    assert!((centre / 5.69683074923e-07 - 1.0).abs() < 1e-6, "{centre}");
    let quarter = plate.static_compliance(0.1, 0.075).unwrap();
    assert!((quarter / 2.86502193169e-07 - 1.0).abs() < 1e-6, "{quarter}");
    // A square's centre: 0.0116008395 a^2/D (double series); the rest of 10,000 modes is Weyl's 1/(4 pi omega sqrt(D rho h)).
    let square = unit(1.0, 0.3, [P; 4]);
    let whole = square.static_compliance(0.37, 0.21).unwrap();
    let modes = square.modes(10_000).unwrap();
    let shapes = modes.shapes_at(0.37, 0.21).unwrap();
    let sum: f64 = modes.omega_rad_s().iter().zip(shapes).map(|(omega, phi)| (phi / omega).powi(2)).sum();
    let rest = 1.0 / (4.0 * PI * modes.omega_rad_s()[9999]);
    assert!(((whole - sum) / rest - 1.0).abs() < 0.05, "{} {rest}", whole - sum);
    assert!((square.static_compliance(0.5, 0.5).unwrap() - 0.0116008397722116).abs() < 1e-14);
}

/// The static compliance of the truncated modes, averaged over locations, is that of Weyl's law, so that shapes, frequencies
/// and compliance are consistent.
#[test]
fn static_deflection_and_modes_are_consistent() {
    // Clamped along all edges, at the centre: 0.005612024 a^2/D.
    let clamped = unit(1.0, 0.3, [C; 4]).static_compliance(0.5, 0.5).unwrap();
    assert!((clamped - 0.0056120238).abs() < 1e-9, "{clamped}");
    for (edges, count) in [([C, F, F, F], 120), ([F, F, F, F], 120), ([C, C, P, P], 150)] {
        let plate = unit(0.9, 0.3, edges);
        let modes = plate.modes(count).unwrap();
        assert!(modes.converged(1e-4) == count, "{edges:?} {:?}", modes.converged(1e-4));
        let places = [(0.3, 0.2), (0.45, 0.52), (0.61, 0.33), (0.74, 0.64)];
        let mut share = 0.0;
        for (x, y) in places {
            let shapes = modes.shapes_at(x, y).unwrap();
            let elastic = modes.omega_rad_s().iter().zip(&shapes).filter(|(omega, _)| **omega > 0.0);
            let sum: f64 = elastic.map(|(omega, phi)| (phi / omega).powi(2)).sum();
            let left = plate.static_compliance(x, y).unwrap() - sum;
            assert!(left > 0.0, "{edges:?} {x} {y}: {left}");
            share += left * 4.0 * PI * modes.omega_rad_s()[count - 1] / places.len() as f64;
        }
        assert!((share - 1.0).abs() < 0.15, "{edges:?}: {share}");
    }
}

#[test]
fn mindlin_s_plate_is_slower_and_tends_to_kirchhoff_s() {
    let thin = STEEL;
    let kappa = Plate::shear_coefficient(0.3);
    let thick = Plate { theory: PlateTheory::Mindlin { shear_coefficient: kappa }, ..thin };
    let (a, b) = (thin.modes(200).unwrap(), thick.modes(200).unwrap());
    let (d, mass, h) = (thin.flexural_rigidity_n_m(), thin.mass_per_area_kg_m2(), 0.005);
    let shear = kappa * 2e11 / 2.6 * h;
    for (k, (kirchhoff, mindlin)) in a.omega_rad_s().iter().zip(b.omega_rad_s()).enumerate() {
        assert!(mindlin < kirchhoff);
        // The characteristic equation at the head of the file, with k^2 from Kirchhoff's frequency.
        let wave = kirchhoff * (mass / d).sqrt();
        let square = mindlin * mindlin;
        let left = (shear * wave - mass * square) * (d * wave + shear - mass * h * h / 12.0 * square);
        assert!((left / (shear * shear * wave) - 1.0).abs() < 1e-9, "{k}");
        // To first order in h: k^2 D/2 (1/S + h^2/(12 D)).
        let slower = 0.5 * wave * (d / shear + h * h / 12.0);
        assert!(((1.0 - mindlin / kirchhoff) / slower - 1.0).abs() < 3.0 * slower, "{k}");
    }
    // A plate that is stiff in shear is Kirchhoff's except for rotary inertia, which remains.
    assert_eq!(thick.static_compliance(0.1, 0.1).unwrap_err().field, "theory");
    // Far beyond the cut-off, sqrt(12 kappa G/rho)/h, both branches exist.
    let cut_off = (shear * 12.0 / (mass * h * h)).sqrt();
    let thicker = Plate { thickness_m: 0.05, ..thick };
    let modes = thicker.modes(400).unwrap();
    assert!(modes.omega_rad_s().windows(2).all(|pair| pair[0] <= pair[1]));
    assert!(modes.omega_rad_s()[399] > 0.1 * cut_off);
}

#[test]
fn input_out_of_range_is_named() {
    let plate = unit(0.9, 0.3, [C, F, F, P]);
    let field = |plate: Plate| plate.modes(3).unwrap_err().field;
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(field(Plate { length_m: bad, ..plate }), "length_m");
        assert_eq!(field(Plate { width_m: bad, ..plate }), "width_m");
        assert_eq!(field(Plate { thickness_m: bad, ..plate }), "thickness_m");
        assert_eq!(field(Plate { youngs_modulus_pa: bad, ..plate }), "youngs_modulus_pa");
        assert_eq!(field(Plate { density_kg_m3: bad, ..plate }), "density_kg_m3");
    }
    for bad in [-1.0, 0.51, f64::NAN] {
        assert_eq!(field(Plate { poissons_ratio: bad, ..plate }), "poissons_ratio");
    }
    let theory = PlateTheory::Mindlin { shear_coefficient: 0.86 };
    assert_eq!(field(Plate { theory, ..plate }), "theory");
    for shear_coefficient in [-0.86, 0.0, 2.1, f64::NAN] {
        let theory = PlateTheory::Mindlin { shear_coefficient };
        assert_eq!(field(Plate { theory, edges: [P; 4], ..plate }), "shear_coefficient");
    }
    assert_eq!(field(Plate { width_m: 1e-5, ..plate }), "width_m");
    assert_eq!(field(Plate { thickness_m: 1e-150, ..plate }), "thickness_m");
    assert_eq!(field(Plate { youngs_modulus_pa: 1e300, ..plate }), "youngs_modulus_pa");
    assert_eq!(field(Plate { density_kg_m3: 1e-300, ..plate }), "density_kg_m3");
    assert_eq!(plate.static_compliance(1.1, 0.5).unwrap_err().field, "x_m");
    assert_eq!(plate.static_compliance(0.5, -0.1).unwrap_err().field, "y_m");
    assert_eq!(plate.modes(100_000).unwrap_err().field, "count");
    assert_eq!(plate.modes(plate.most_modes() + 1).unwrap_err().field, "count");
    assert_eq!(plate.modes(0).unwrap().len(), 0);
    // Constrained locations do not move.
    assert_eq!(unit(1.0, 0.3, [P; 4]).static_compliance(0.0, 0.3), Ok(0.0));
    assert!(unit(1.0, 0.3, [C; 4]).static_compliance(0.0, 0.3).unwrap() < 1e-15);
}

/// Static deflection under a unit load, times the rigidity, of a plate pinned at `x = 0` and `x = a` and free at `y = 0` and
/// `y = b`, by Levy's single series (S. P. Timoshenko and S. Woinowsky-Krieger, *Theory of Plates and Shells*, 1959, ch. 6).
fn levy([a, b]: [f64; 2], nu: f64, [x, y]: [f64; 2]) -> f64 {
    // Bending moment and shear force on an edge, with derivatives inwards: of the load's own term, at the distance `u`, and of
    // the two terms that decay from this edge (`u = 0`) or from the other one, for which the sign of the shear force changes.
    let moment = |u: f64| (u - 1.0 - nu * (1.0 + u)) * (-u).exp();
    let shear = |u: f64| -(2.0 - u + (2.0 - nu) * u) * (-u).exp();
    let decaying = |u: f64| {
        let e = (-u).exp();
        [[(1.0 - nu) * e, (u - 2.0 - nu * u) * e], [(1.0 - nu) * e, (3.0 - u - (2.0 - nu) * (1.0 - u)) * e]]
    };
    let terms = (1..=20_000).map(|m| {
        let k = f64::from(m) * PI / a;
        let (low, high, width) = (k * y, k * (b - y), k * b);
        let ([m0, v0], [m1, v1]) = (decaying(0.0), decaying(width));
        let rows = [
            [m0[0], m0[1], m1[0], m1[1], -moment(low)],
            [v0[0], v0[1], -v1[0], -v1[1], -shear(low)],
            [m1[0], m1[1], m0[0], m0[1], -moment(high)],
            [-v1[0], -v1[1], v0[0], v0[1], -shear(high)],
        ];
        let [p, q, r, s] = solved(rows);
        let moved = 1.0 + (p + q * low) * (-low).exp() + (r + s * high) * (-high).exp();
        (k * x).sin().powi(2) * moved / (2.0 * a * k.powi(3))
    });
    terms.sum()
}

/// Four linear equations by elimination.
fn solved(mut rows: [[f64; 5]; 4]) -> [f64; 4] {
    for i in 0..4 {
        let pivot = (i..4).max_by(|&p, &q| rows[p][i].abs().total_cmp(&rows[q][i].abs())).unwrap();
        rows.swap(i, pivot);
        let leading = rows[i];
        for (_, row) in rows.iter_mut().enumerate().filter(|(j, _)| *j != i) {
            let factor = row[i] / leading[i];
            row.iter_mut().zip(leading).for_each(|(value, above)| *value -= factor * above);
        }
    }
    [0, 1, 2, 3].map(|i| rows[i][4] / rows[i][i])
}

#[test]
fn deflection_near_free_edges_is_levy_s() {
    let (sides, nu) = ([1.0, 0.7], 0.3);
    let plate = unit(sides[1], nu, [P, P, F, F]);
    for place in [[0.5, 0.35], [0.3, 0.2], [0.4, 0.6], [0.3, 0.65], [0.1, 0.69], [0.5, 0.7], [0.2, 0.0]] {
        let exact = levy(sides, nu, place);
        let found = plate.static_compliance(place[0], place[1]).unwrap();
        assert!((found / exact - 1.0).abs() < 1e-8, "{place:?}: {found:e} {exact:e}");
    }
}

/// The middle of a free edge, by Ritz's method with the correction of the pinned plate alone: 30 and 42 polynomials along that
/// edge, extrapolated by the square of their number.
#[test]
fn deflection_in_the_middle_of_a_free_edge() {
    let extrapolated = |few: f64, many: f64| many + (many - few) * 900.0 / (1764.0 - 900.0);
    for (edges, few, many) in [([F; 4], 4.915359656e-6, 4.917244909e-6), ([C, F, F, F], 1.154900386e-4, 1.154919335e-4)]
    {
        let plate = Plate {
            length_m: 0.3,
            width_m: 0.2,
            thickness_m: 0.004,
            youngs_modulus_pa: 7e10,
            poissons_ratio: 0.33,
            density_kg_m3: 2700.0,
            edges,
            theory: PlateTheory::Kirchhoff,
        };
        let (found, expected) = (plate.static_compliance(0.3, 0.1).unwrap(), extrapolated(few, many));
        assert!((found / expected - 1.0).abs() < 5e-6, "{edges:?}: {found:e} {expected:e}");
    }
}

/// Several coefficients of the shapes of a square are equally large. Their order must not determine the sign, since rounding and the
/// smallest changes of the plate change it.
#[test]
fn signs_of_the_modes_of_a_square_do_not_depend_on_rounding() {
    let shapes = |width_m: f64| unit(width_m, 0.3, [F; 4]).modes(14).unwrap().shapes_at(0.3, 0.8 * width_m).unwrap();
    let (slim, wide) = (shapes(1.0 - 1e-6), shapes(1.0 + 1e-6));
    // apart from pairs of modes with the same frequency, which have their order by rounding
    for k in [3, 4, 5, 10, 11] {
        assert!((slim[k] - wide[k]).abs() < 1e-3, "{k}: {} {}", slim[k], wide[k]);
    }
}

#[test]
fn nothing_moves_at_a_held_edge() {
    for edges in [[C, F, P, F], [P, P, C, F], [P, P, P, P], [F, C, F, F]] {
        let modes = Plate { edges, ..STEEL }.modes(8).unwrap();
        let Plate { length_m, width_m, .. } = STEEL;
        let places = [(0.0, 0.1), (length_m, 0.1), (0.1, 0.0), (0.1, width_m)];
        for (edge, (x_m, y_m)) in edges.into_iter().zip(places) {
            let shapes = modes.shapes_at(x_m, y_m).unwrap();
            assert_eq!(shapes.iter().all(|shape| *shape == 0.0), edge != F, "{edges:?} {x_m} {y_m}: {shapes:?}");
        }
    }
}
