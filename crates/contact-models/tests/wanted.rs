//! Laws for a required restitution, compared with step-by-step integration, and their restitutions with a fixed step.

use crate::common::rebound;
use contact_models::{Flores, HuntCrossley, KelvinVoigt, LankaraniNikravesh, Law, Wanted};
use contact_models::{damping_ratio, damping_ratio_if_it_pulled, reduced_mass_kg, stepped_restitution};

const WANTED: Wanted = Wanted { restitution: 0.5, mass_kg: 0.2, speed_m_s: 1.5, compression_m: 1e-3 };

/// Every law that can give this restitution.
fn laws(wanted: &Wanted) -> Vec<Law> {
    let mut laws = vec![
        wanted.kelvin_voigt().unwrap(),
        wanted.hunt_crossley(1.0).unwrap().into(),
        wanted.hunt_crossley(1.5).unwrap().into(),
        wanted.hunt_crossley(3.0).unwrap().into(),
        wanted.flores().unwrap().into(),
    ];
    laws.extend(wanted.lankarani_nikravesh().ok().map(Law::from));
    laws
}

#[test]
fn every_law_has_the_required_restitution() {
    for restitution in [0.05, 0.25, 0.5, 0.7, 0.95, 1.0] {
        let wanted = Wanted { restitution, ..WANTED };
        let laws = laws(&wanted);
        assert_eq!(laws.len(), if restitution > 0.666 { 6 } else { 5 });
        for law in laws {
            let closed = law.wall_restitution(WANTED.mass_kg, WANTED.speed_m_s).unwrap();
            assert!((closed - restitution).abs() < 1e-12, "{law:?}: {closed}");
            let stepped = rebound(&law, WANTED.mass_kg, WANTED.speed_m_s, 5e-3);
            assert!((stepped - restitution).abs() < 1e-9, "{law:?}: {stepped}");
        }
    }
}

/// The maximum compression by integration, where the speed is zero.
#[test]
fn bodies_have_the_required_compression() {
    use contact_models::{ContactLaw, Memory};
    for restitution in [0.05, 0.5, 0.95, 1.0] {
        for law in laws(&Wanted { restitution, ..WANTED }) {
            let branch = law.touch(&Memory::default(), WANTED.speed_m_s);
            let (mut xi, mut v, h) = (0.0, WANTED.speed_m_s, 1e-8);
            while v > 0.0 {
                // The midpoint rule.
                let acceleration = |xi: f64, v: f64| -law.force(&branch, xi, v).force_n / WANTED.mass_kg;
                let middle = (xi + 0.5 * h * v, v + 0.5 * h * acceleration(xi, v));
                (xi, v) = (xi + h * middle.1, v + h * acceleration(middle.0, middle.1));
            }
            assert!((xi / WANTED.compression_m - 1.0).abs() < 1e-8, "{law:?} {restitution}: {xi}");
        }
    }
}

/// Two free bodies, integrated as such, separate as one body of the reduced mass.
#[test]
fn two_bodies_are_equivalent_to_their_reduced_mass() {
    use contact_models::{ContactLaw, Memory};
    let (first, second) = (0.3, 0.6);
    let wanted = Wanted { mass_kg: reduced_mass_kg(first, second).unwrap(), ..WANTED };
    assert!((wanted.mass_kg - 0.2).abs() < 1e-15);
    for mass_kg in [0.3, 0.013, 1e-30, 1e30] {
        assert_eq!(reduced_mass_kg(mass_kg, f64::INFINITY), Ok(mass_kg));
    }
    let law = wanted.hunt_crossley(1.5).unwrap();
    let branch = law.touch(&Memory::default(), wanted.speed_m_s);
    let slope = |[x1, v1, x2, v2]: [f64; 4]| {
        let force = law.force(&branch, x1 - x2, v1 - v2).force_n;
        [v1, -force / first, v2, force / second]
    };
    let along = |s: [f64; 4], h: f64, k: [f64; 4]| [0, 1, 2, 3].map(|i| s[i] + h * k[i]);
    let (mut s, h) = ([0.0, wanted.speed_m_s + 2.0, 0.0, 2.0], 1e-7);
    while s[0] >= s[2] {
        let k1 = slope(s);
        let k2 = slope(along(s, 0.5 * h, k1));
        let k3 = slope(along(s, 0.5 * h, k2));
        let k4 = slope(along(s, h, k3));
        s = [0, 1, 2, 3].map(|i| s[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]));
    }
    assert!(((s[3] - s[1]) / wanted.speed_m_s - 0.5).abs() < 1e-9, "{}", (s[3] - s[1]) / wanted.speed_m_s);
}

/// MuJoCo's numbers: the result of the usual formula, and the two forms of `solref` as the same contact.
#[test]
fn solref_of_mujoco() {
    for (asked, obtained) in [(0.25, 0.361), (0.5, 0.550), (0.75, 0.763)] {
        let zeta = damping_ratio_if_it_pulled(asked).unwrap();
        let law = KelvinVoigt::new(1e4, 2.0 * zeta * (1e4_f64 * 0.2).sqrt()).unwrap();
        let found = Law::from(law).wall_restitution(0.2, 1.0).unwrap();
        assert!((found - obtained).abs() < 5e-4, "{asked}: {found}");
        // The formula as it is written for atan2.
        let z: f64 = damping_ratio(asked).unwrap();
        let root = (1.0 - z * z).sqrt();
        let exponent = z / root * (std::f64::consts::PI - (2.0 * z * root).atan2(1.0 - 2.0 * z * z));
        assert!(((-exponent).exp() - asked).abs() < 1e-14);
    }
    let solref = WANTED.solref().unwrap();
    let (tau, zeta) = (solref.time_constant_s, solref.damping_ratio);
    assert!((solref.stiffness_per_s2 * (tau * zeta).powi(2) - 1.0).abs() < 1e-14);
    assert!((solref.damping_per_s * tau - 2.0).abs() < 1e-14);
    let elastic = Wanted { restitution: 1.0, ..WANTED }.solref().unwrap();
    assert_eq!((elastic.damping_per_s, elastic.time_constant_s), (0.0, f64::INFINITY));
}

/// As the steps become smaller, an engine converges to the law with first order; the mean over the depths of first touch with
/// second order.
#[test]
fn an_engine_converges_to_the_law() {
    let wanted = Wanted { restitution: 0.6, ..WANTED };
    for law in laws(&wanted) {
        let miss = |step_s| stepped_restitution(&law, wanted.mass_kg, wanted.speed_m_s, step_s).unwrap();
        let (coarse, fine) = (miss(2e-5), miss(2e-6));
        assert!(fine.lowest <= fine.mean && fine.mean <= fine.highest);
        assert!((fine.mean - 0.6).abs() < 0.15 * (coarse.mean - 0.6).abs() + 1e-5, "{law:?} {coarse:?} {fine:?}");
        assert!(fine.highest - fine.lowest < 0.2 * (coarse.highest - coarse.lowest), "{law:?} {coarse:?} {fine:?}");
        assert!(fine.steps > 500.0);
    }
}

/// One step computed by hand: the first is deep enough to push the striker out at once.
#[test]
fn a_step_as_long_as_the_contact() {
    let law = Law::from(contact_models::LinearSpring::new(1.0).unwrap());
    // m = 1, v = 1, h = 1.9: at depth d the speed becomes 1 - 1.9 d, then the compression d + 1.9 (1 - 1.9 d).
    let found = stepped_restitution(&law, 1.0, 1.0, 1.9).unwrap();
    assert!(found.highest > 1.5 && found.steps < 3.0, "{found:?}");
}

/// A contact that outlasts the steps that are computed has no restitution, not one of zero.
#[test]
fn a_step_too_short_for_the_contact() {
    let law = Law::from(contact_models::LinearSpring::new(1.0).unwrap());
    // the contact lasts pi
    assert!((stepped_restitution(&law, 1.0, 1.0, 4e-5).unwrap().mean - 1.0).abs() < 1e-4);
    let fault = stepped_restitution(&law, 1.0, 1.0, 3e-5).unwrap_err();
    assert!(fault.field == "step_s" && fault.allowed.contains("100000 steps"), "{fault}");
}

#[test]
fn requirements_out_of_range() {
    let field = |wanted: Wanted| wanted.kelvin_voigt().unwrap_err().field;
    for bad in [f64::NAN, 0.0, -1.0, f64::INFINITY] {
        assert_eq!(field(Wanted { restitution: bad, ..WANTED }), "restitution");
        assert_eq!(field(Wanted { mass_kg: bad, ..WANTED }), "mass_kg");
        assert_eq!(field(Wanted { speed_m_s: bad, ..WANTED }), "speed_m_s");
        assert_eq!(field(Wanted { compression_m: bad, ..WANTED }), "compression_m");
        assert_eq!(damping_ratio(bad).unwrap_err().field, "restitution");
        assert_eq!(damping_ratio_if_it_pulled(bad).unwrap_err().field, "restitution");
        let law = WANTED.kelvin_voigt().unwrap();
        assert_eq!(stepped_restitution(&law, 1.0, 1.0, bad).unwrap_err().field, "step_s");
    }
    assert_eq!(reduced_mass_kg(1.0, 0.0).unwrap_err().field, "mass_kg");
    assert_eq!(reduced_mass_kg(f64::INFINITY, f64::INFINITY).unwrap_err().field, "mass_kg");
    assert_eq!(WANTED.hunt_crossley(0.5).unwrap_err().field, "exponent");
    // Restitutions below the range of Lankarani and Nikravesh.
    let least = Law::from(LankaraniNikravesh::new(1.0, 0.001).unwrap()).wall_restitution(1.0, 1.0).unwrap();
    assert!((least - 0.663).abs() < 5e-5, "{least}");
    assert!(LankaraniNikravesh::with_restitution(1.0, least + 1e-9).is_ok());
    let fault = LankaraniNikravesh::with_restitution(1.0, 0.66).unwrap_err();
    assert!(fault.to_string().contains("0.663"), "{fault}");
    // Limits of the other ranges.
    for restitution in [0.001, 1.0] {
        assert!(Flores::with_restitution(1.0, restitution).is_ok());
        assert!(HuntCrossley::with_restitution(1.0, 1.5, restitution, 1.0).is_ok());
    }
}
