//! What the crates' feature `serde` writes is read back the same, under the names of the fields.

use serde::{Serialize, de::DeserializeOwned};
use serde_json::{Value, json};
use std::fmt::Debug;

fn reads_back<T: Serialize + DeserializeOwned + PartialEq + Debug>(value: T, written: Value) {
    assert_eq!(serde_json::to_value(&value).unwrap(), written, "{value:?}");
    assert_eq!(serde_json::from_value::<T>(written).unwrap(), value);
}

#[test]
fn beams_rods_and_plates() {
    use beam_modes::{Attachment, Beam, BeamSystem, Edge, End, Plate, PlateTheory, Rod, RodEnd, RodSegment, Segment};
    let segment = Segment { length_m: 1.0, flexural_rigidity_n_m2: 275.5, mass_per_length_kg_m: 0.1 };
    let beam = Beam { segments: vec![segment], ends: [End::Clamped, End::Guided] };
    let written = json!({
        "segments": [{ "length_m": 1.0, "flexural_rigidity_n_m2": 275.5, "mass_per_length_kg_m": 0.1 }],
        "ends": ["clamped", "guided"]
    });
    reads_back(beam.clone(), written);
    let system = BeamSystem {
        attachments: vec![Attachment { location_m: 0.3, mass_kg: 0.2, ..Attachment::default() }],
        ..BeamSystem::from(beam)
    };
    let text = serde_json::to_string(&system).unwrap();
    assert_eq!(serde_json::from_str::<BeamSystem>(&text).unwrap(), system);
    // what an attachment does not have may be left out
    let light: Attachment = serde_json::from_value(json!({ "location_m": 0.3, "mass_kg": 0.2 })).unwrap();
    assert_eq!(light, system.attachments[0]);

    let segment = RodSegment { length_m: 0.5, axial_rigidity_n: 2e7, mass_per_length_kg_m: 0.8 };
    let rod = Rod { segments: vec![segment], ends: [RodEnd::Fixed, RodEnd::Free] };
    let written = json!({
        "segments": [{ "length_m": 0.5, "axial_rigidity_n": 2e7, "mass_per_length_kg_m": 0.8 }],
        "ends": ["fixed", "free"]
    });
    reads_back(rod, written);

    let plate = Plate {
        theory: PlateTheory::Mindlin { shear_coefficient: 0.86 },
        ..Plate {
            length_m: 0.4,
            width_m: 0.3,
            thickness_m: 0.005,
            youngs_modulus_pa: 2e11,
            poissons_ratio: 0.3,
            density_kg_m3: 7800.0,
            edges: [Edge::Pinned; 4],
            theory: PlateTheory::Kirchhoff,
        }
    };
    let written = serde_json::to_value(plate).unwrap();
    assert_eq!(written["theory"], json!({ "mindlin": { "shear_coefficient": 0.86 } }));
    assert_eq!(written["edges"], json!(["pinned", "pinned", "pinned", "pinned"]));
    assert_eq!(serde_json::from_value::<Plate>(written).unwrap(), plate);

    let misspelt = serde_json::from_value::<RodSegment>(json!({ "lenght_m": 1.0 })).unwrap_err();
    assert!(misspelt.to_string().contains("lenght_m"), "{misspelt}");
}

#[test]
fn laws_of_contact() {
    use contact_models::{Branch, Hertz, HuntCrossley, Law, LinearSpring, Memory, Stage};
    reads_back(Hertz { stiffness_n_m1_5: 1.8e10 }, json!({ "stiffness_n_m1_5": 1.8e10 }));
    let laws = [
        Law::from(Hertz { stiffness_n_m1_5: 1.8e10 }),
        Law::from(HuntCrossley { stiffness_n_m_n: 1e9, exponent: 1.5, damping_s_m: 0.2 }),
        Law::from(LinearSpring { stiffness_n_m: 1e6 }),
    ];
    for law in laws {
        let written = serde_json::to_value(law).unwrap();
        assert_eq!(written["law"], law.name());
        assert_eq!(serde_json::from_value::<Law>(written).unwrap(), law);
    }
    let branch = Branch { stage: Stage::Unloading, anchor_m: 1e-6, internal: [0.5].into() };
    let internal = json!([0.5, 0.0, 0.0, 0.0, 0.0, 0.0]);
    reads_back(branch, json!({ "stage": "unloading", "anchor_m": 1e-6, "internal": internal }));
    reads_back(
        Branch { stage: Stage::Own(3), ..branch },
        json!({ "stage": { "own": 3 }, "anchor_m": 1e-6, "internal": internal }),
    );
    reads_back(Memory::default(), json!({ "touch_m": 0.0, "internal": [0.0, 0.0, 0.0, 0.0, 0.0, 0.0] }));
}

#[test]
fn net_impacts() {
    use emoc::{Branch, Coefficients, Contact, Friction, Mode, Outcome, Problem};
    let coefficients = Coefficients { ebar: 0.9, beta0: 0.2, beta1: 0.1 };
    reads_back(coefficients, json!({ "ebar": 0.9, "beta0": 0.2, "beta1": 0.1 }));
    let problem = Problem {
        contacts: vec![Contact { friction: Friction::Planar { coefficient: 0.3 }, coefficients }],
        inverse_inertia_per_kg: vec![1.0, 0.0, 0.0, 2.0],
        velocity_m_s: vec![-1.0, 0.0],
        modes: vec![Mode { rate: 0.0, shape: vec![1.0, 0.0] }],
    };
    let written = json!({
        "contacts": [{
            "friction": { "planar": { "coefficient": 0.3 } },
            "coefficients": { "ebar": 0.9, "beta0": 0.2, "beta1": 0.1 }
        }],
        "inverse_inertia_per_kg": [1.0, 0.0, 0.0, 2.0],
        "velocity_m_s": [-1.0, 0.0],
        "modes": [{ "rate": 0.0, "shape": [1.0, 0.0] }]
    });
    reads_back(problem.clone(), written);
    let solution = emoc::Solver::new().solve(&problem).unwrap();
    let text = serde_json::to_string(&solution).unwrap();
    assert_eq!(serde_json::from_str::<emoc::Solution>(&text).unwrap(), solution);
    reads_back(Outcome::Relaxed { share: 0.5 }, json!({ "relaxed": { "share": 0.5 } }));
    assert_eq!(serde_json::to_value(Branch::Outward).unwrap(), Branch::Outward.as_str());
}

#[test]
fn fits() {
    use fitting::{Fit, Method, Outcome, Parameter, Problem, Settings, fit};
    let problem = Problem {
        parameters: vec![Parameter::positive("a", 1.0, (0.1, 10.0))],
        count: 2,
        residuals: &|p, r| r.iter_mut().zip([2.0, 2.2]).for_each(|(r, y)| *r = p[0] - y),
        jacobian: None,
    };
    let found = fit(&problem, &Settings::default()).unwrap();
    let text = serde_json::to_string(&found).unwrap();
    let read: Fit = serde_json::from_str(&text).unwrap();
    assert_eq!(read, found);
    // intervals need what is not public
    assert_eq!(read.intervals(0.95), found.intervals(0.95));
    let settings: Settings = serde_json::from_value(json!({ "starts": 3 })).unwrap();
    assert_eq!(settings, Settings { starts: 3, ..Settings::default() });
    for method in [Method::LevenbergMarquardt, Method::Simplex, Method::Both] {
        reads_back(method, method.as_str().into());
    }
    for outcome in [Outcome::Converged, Outcome::LimitReached, Outcome::NonFinite] {
        reads_back(outcome, outcome.as_str().into());
    }
}

#[test]
fn fractional_equations() {
    use fracdiff::{Collocation, Direction, Equation, Method, Stop, Term};
    reads_back(Equation::new(0.5, &[1.0]), json!({ "order": 0.5, "initial": [1.0], "lower": [] }));
    let term = Term { unknown: 0, density: 0, order: 1.5, coefficient: -1.0 };
    reads_back(term, json!({ "unknown": 0, "density": 0, "order": 1.5, "coefficient": -1.0 }));
    let method = Method::Collocation(Collocation { tolerance: 1e-9, ..Collocation::default() });
    let read: Method = serde_json::from_value(json!({ "collocation": { "tolerance": 1e-9 } })).unwrap();
    assert_eq!(read, method);
    assert_eq!(serde_json::from_str::<Method>(&serde_json::to_string(&method).unwrap()).unwrap(), method);
    for direction in [Direction::Any, Direction::Rising, Direction::Falling] {
        reads_back(direction, direction.as_str().into());
    }
    reads_back(Stop::Event { index: 2 }, json!({ "event": { "index": 2 } }));
}
