//! `vibroimpact emoc` and `vibroimpact fit` as a user meets them.

use std::f64::consts::PI;
use std::fs;

use crate::program::{run, stdout};
use serde_json::{Value, json};
use vibroimpact::net::FitSummary;

/// A pinned beam of 1 kg, whose shapes are sqrt(2) sin(k pi x) exactly.
const PINNED: &str = r#"{ "structure": { "kind": "beam", "ends": ["pinned", "pinned"],
    "segments": [ { "length_m": 1, "flexural_rigidity_n_m2": 274, "mass_per_length_kg_m": 1 } ] },
  "striker": { "mass_kg": 0.2, "speed_m_s": 1.0 },
  "contact": { "law": "hertz", "stiffness_n_m1_5": 1.8e10 },
  "location_m": 0.3, "modes": 40 }"#;

/// Runs in a folder with the scene and, if given, a table; it must reject the input and write nothing.
fn refusal(scene: &str, table: Option<&[u8]>, arguments: &[&str]) -> String {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scene.json"), scene).unwrap();
    if let Some(table) = table {
        fs::write(folder.path().join("data.csv"), table).unwrap();
    }
    let before = fs::read_dir(folder.path()).unwrap().count();
    let output = run(folder.path(), arguments);
    let message = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{message}");
    assert!(output.stdout.is_empty() && !message.contains("panicked"), "{message}");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), before);
    message
}

fn emoc(scene: &str, options: &[&str]) -> Value {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scene.json"), scene).unwrap();
    let arguments = [&["emoc", "scene.json", "--json"], options].concat();
    serde_json::from_str(&stdout(&run(folder.path(), &arguments))).unwrap()
}

fn number(value: &Value, key: &str) -> f64 {
    value[key].as_f64().unwrap_or_else(|| panic!("{key} in {value}"))
}

/// The law of chapter 7, implemented a second time.
fn law([mu0, alpha0, alpha1]: [f64; 3], mass: f64, place: f64, modes: i32) -> [f64; 5] {
    let squares: Vec<f64> = (1..=modes).map(|k| 2.0 * (PI * f64::from(k) * place).sin().powi(2)).collect();
    let z = mass * squares.iter().sum::<f64>();
    let t = mu0 * z;
    let ebar = (t * t + 1.0) / (t * t + t + 1.0);
    let (x, y) = (alpha0 * z / f64::from(modes), alpha1 * mass * squares[0]);
    let (beta0, beta1) = (x / (1.0 + x), y / (1.0 + y));
    [ebar * f64::max(1.0 / (1.0 + z), (beta0 + beta1) / (1.0 + beta0)), z, ebar, beta0, beta1]
}

#[test]
fn emoc_prints_the_law_for_the_parameters_given() {
    let keys = ["restitution", "z", "ebar", "beta0", "beta1"];
    for (parameters, modes) in [([1.0, 1.0, 1.0], 40), ([0.5, 8.0, 0.3], 50), ([2.0, 0.0, 0.0], 7)] {
        let [mu0, alpha0, alpha1] = parameters.map(|p: f64| p.to_string());
        let modes_text = modes.to_string();
        let options = ["--mu0", &mu0, "--alpha0", &alpha0, "--alpha1", &alpha1, "--emoc-modes", &modes_text];
        let found = emoc(PINNED, &options);
        for (key, exact) in keys.iter().zip(law(parameters, 0.2, 0.3, modes)) {
            assert!((number(&found, key) - exact).abs() < 1e-11 * exact.max(1.0), "{key}: {found} {exact}");
        }
        assert_eq!(found["branch"], if parameters[1] == 0.0 { "basic" } else { "outward" });
        assert_eq!(found["modes"], modes);
    }
    // Without options all parameters are 1, and the modes are those of the scene.
    assert!((number(&emoc(PINNED, &[]), "restitution") - law([1.0; 3], 0.2, 0.3, 40)[0]).abs() < 1e-12);
}

#[test]
fn emoc_without_json_is_for_readers() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scene.json"), PINNED).unwrap();
    let text = stdout(&run(folder.path(), &["emoc", "scene.json", "--mu0", "1"]));
    for part in ["restitution", "z ", "ebar", "beta0", "beta1", "branch", "outward"] {
        assert!(text.contains(part), "{part} in\n{text}");
    }
    for command in ["emoc", "fit"] {
        assert!(stdout(&run(folder.path(), &[command, "--help"])).contains("Examples:"));
    }
}

#[test]
fn rigid_body_modes_and_the_striker_have_one_effective_mass() {
    // Two free masses of 1 kg only: the effective mass for the striker of 0.5 kg is 1/(1/0.5 + 1).
    let scene = json!({
        "structure": { "kind": "modal", "omega_rad_s": [0, 100], "shape_at_location": [1, 1] },
        "striker": { "mass_kg": 0.5, "speed_m_s": 1 },
        "contact": { "law": "hertz", "stiffness_n_m1_5": 1e10 },
    });
    let found = emoc(&scene.to_string(), &["--alpha0", "0", "--alpha1", "0", "--mu0", "0"]);
    assert!((number(&found, "mass_kg") - 1.0 / 3.0).abs() < 1e-15 && found["modes"] == 1);
    assert!((number(&found, "restitution") - 1.0 / (1.0 + 1.0 / 3.0)).abs() < 1e-15);
}

/// 10 masses at 9 locations with the restitutions of the law, columns in another order, and one additional column.
fn table(parameters: [f64; 3]) -> String {
    let mut text = "beam,restitution,location_m,mass_kg\n".to_owned();
    for i in 1..10 {
        for j in 0..10 {
            let (place, mass) = (0.05 * f64::from(i), 0.004 * 1.8f64.powi(j));
            text += &format!("a, {:?},{place:?},{mass:?}\r\n", law(parameters, mass, place, 50)[0]);
        }
    }
    text
}

#[test]
fn fit_finds_the_true_parameters() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scene.json"), PINNED).unwrap();
    for parameters in [[0.7, 3.0, 0.2], [0.05, 20.0, 2.0]] {
        fs::write(folder.path().join("data.csv"), table(parameters)).unwrap();
        let arguments = ["fit", "data.csv", "--scene", "scene.json", "--json"];
        let printed = stdout(&run(folder.path(), &arguments));
        let found: Value = serde_json::from_str(&printed).unwrap();
        for (key, exact) in ["mu0", "alpha0", "alpha1"].iter().zip(parameters) {
            assert!((number(&found, key) / exact - 1.0).abs() < 1e-5, "{key}: {found}");
        }
        assert!(number(&found, "rms") < 1e-8 && number(&found, "max_error") < 1e-7 && found["count"] == 90);
        assert_eq!(printed, stdout(&run(folder.path(), &arguments)));
        let text = stdout(&run(folder.path(), &arguments[..4]));
        assert!(text.contains("95 %") && text.contains("90 impacts, 50 modes"), "{text}");
    }
    // emoc accepts the parameters that fit finds.
    let found = emoc(PINNED, &["--mu0", "0.05", "--alpha0", "20", "--alpha1", "2", "--emoc-modes", "50"]);
    assert!((number(&found, "restitution") - law([0.05, 20.0, 2.0], 0.2, 0.3, 50)[0]).abs() < 1e-12);
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2);
}

#[test]
fn bad_parameters_are_refused_by_name() {
    for (option, value, part) in [
        ("--mu0", "-1", "error: --mu0 = -1.0 is not allowed; it must be a finite number not less than 0"),
        ("--alpha0", "NaN", "error: --alpha0 = NaN is not allowed"),
        ("--alpha1", "inf", "alpha1 = inf is not allowed"),
        ("--mu0", "one", "one"),
        ("--emoc-modes", "-3", "-3"),
        ("--emoc-modes", "20000", "a whole number from 1 to 10000"),
    ] {
        let message = refusal(PINNED, None, &["emoc", "scene.json", option, value]);
        assert!(message.contains(part), "{part}: {message}");
    }
    for (from, to, part) in [
        ("0.2, \"speed", "0, \"speed", "striker.mass_kg"),
        ("0.3, \"modes", "1.3, \"modes", "location_m = 1.3"),
        ("1.8e10", "-1", "contact.stiffness_n_m1_5"),
        ("\"mass_kg\": 0.2", "\"mass_kg\": 1e308", "it must be such that Z = m sum phi_k^2, now inf,"),
    ] {
        let message = refusal(&PINNED.replace(from, to), None, &["emoc", "scene.json"]);
        assert!(message.contains(part), "{part}: {message}");
    }
    let modal = r#"{ "structure": { "kind": "modal", "omega_rad_s": [-5], "shape_at_location": [1] },
        "striker": { "mass_kg": 0.5, "speed_m_s": 1 }, "contact": { "law": "hertz", "stiffness_n_m1_5": 1e10 } }"#;
    assert!(refusal(modal, None, &["emoc", "scene.json"]).contains("structure.omega_rad_s[0] = -5"));
    let good = modal.replace("-5", "5");
    assert!(refusal(&good, None, &["emoc", "scene.json", "--emoc-modes", "2"]).contains("--emoc-modes = 2"));
    let table = "mass_kg,location_m,restitution\n1,0,1\n1,0,1\n1,0,1\n";
    let message = refusal(&good, Some(table.as_bytes()), &["fit", "data.csv", "--scene", "scene.json"]);
    assert!(message.contains("structure.kind = modal"), "{message}");
}

#[test]
fn bad_tables_are_refused_with_their_line() {
    let fit = ["fit", "data.csv", "--scene", "scene.json"];
    let header = "mass_kg,location_m,restitution\n";
    let good = "0.1,0.2,0.5\n0.2,0.4,0.4\n0.3,0.3,0.3\n";
    for (table, part) in [
        (String::new(), "data.csv, column mass_kg is missing"),
        ("mass_kg,location_m\n0.1,0.2\n".to_owned(), "data.csv, column restitution is missing"),
        (format!("restitution,{header}"), "data.csv, column restitution = 2 columns"),
        (header.to_owned(), "data.csv, lines of data = 0 is not allowed; it must be at least 3"),
        (format!("{header}0.1,0.2,0.5\n"), "data.csv, lines of data = 1"),
        (
            format!("{header}{good}0.1,0.2,high\n"),
            "data.csv, line 5, restitution = high is not allowed; it must be a finite number",
        ),
        (format!("{header}{good}\n0.1,0.2,NaN\n"), "data.csv, line 6, restitution = NaN"),
        (format!("{header}{good}\n\n0.1,0.2,NaN\n").replace('\n', "\r\n"), "data.csv, line 7, restitution = NaN"),
        (format!("\u{feff}{header}0.1,0.2,NaN\n"), "data.csv, line 2, restitution = NaN"),
        (format!("{header}{good}0.1,0.2,inf\n"), "data.csv, line 5, restitution = inf"),
        (format!("{header}{good}0.1,0.2,1e300\n"), "data.csv, line 5, restitution = 1"),
        (
            format!("{header}{good}0.1,0.2\n"),
            "data.csv, line 5 = 2 cells is not allowed; it must be as long as the line of names, which has 3 cells",
        ),
        (format!("{header}{good}0.1,,0.5\n"), "data.csv, line 5, location_m is missing"),
        (format!("{header}0.1,1.01,0.5\n{good}"), "data.csv, line 2, location_m = 1.01 is not allowed"),
        (format!("{header}0.1,-0.01,0.5\n{good}"), "data.csv, line 2, location_m = -0.01"),
        (
            format!("{header}0,0.5,0.5\n{good}"),
            "data.csv, line 2, mass_kg = 0.0 is not allowed; it must be a finite number greater than 0",
        ),
        (format!("{header}-1,0.5,0.5\n{good}"), "data.csv, line 2, mass_kg = -1.0"),
    ] {
        let message = refusal(PINNED, Some(table.as_bytes()), &fit);
        assert!(message.contains(part), "{part}: {message}");
    }
    assert!(refusal(PINNED, Some(b"\xff\xfe\x00,\n\xff"), &fit).contains("not allowed"));
    assert!(refusal(PINNED, None, &fit).contains("cannot read data.csv"));
    assert!(refusal("{", Some(b""), &fit).contains("ends too early"));
    let fit = [&fit[..], &["--emoc-modes", "20000"]].concat();
    assert!(
        refusal(PINNED, Some(format!("{header}{good}").as_bytes()), &fit).contains("a whole number from 1 to 10000")
    );
}

#[test]
fn data_that_determine_nothing_still_give_a_result() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scene.json"), PINNED).unwrap();
    // At the support nothing vibrates for any parameters.
    fs::write(folder.path().join("data.csv"), "mass_kg,location_m,restitution\n1,0,1\n2,0,1\n3,0,1\n4,0,1\n").unwrap();
    let arguments = ["fit", "data.csv", "--scene", "scene.json"];
    assert!(stdout(&run(folder.path(), &arguments)).contains("do not determine"));
    let found: Value =
        serde_json::from_str(&stdout(&run(folder.path(), &[&arguments[..], &["--json"]].concat()))).unwrap();
    assert!(found["intervals"].is_null() && number(&found, "rms") == 0.0);
}

/// The longest number that a fit can give does not run into the words beside it.
#[test]
fn a_parameter_at_its_limit_is_apart_from_its_interval() {
    let (mu0, alpha0, alpha1) = (1.0, 1.0, 2.17174e-300);
    let known = FitSummary {
        mu0,
        alpha0,
        alpha1,
        rms: 0.0,
        max_error: 0.0,
        count: 4,
        modes: 50,
        intervals: None,
        converged: false,
        undetermined: vec!["alpha1"],
    };
    let text = vibroimpact::text::fit(&known);
    assert!(text.contains("2.17174×10⁻³⁰⁰  interval"), "{text}");
}

#[test]
fn a_parameter_without_influence_is_not_determined() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scene.json"), PINNED).unwrap();
    let fit = |masses: &[f64]| -> Value {
        let mut text = "mass_kg,location_m,restitution\n".to_owned();
        for (mass, place) in masses.iter().flat_map(|mass| [0.13, 0.21, 0.34, 0.48].map(|place| (mass, place))) {
            text += &format!("{mass:?},{place:?},{:?}\n", law([0.7, 3.0, 0.2], *mass, place, 50)[0]);
        }
        fs::write(folder.path().join("data.csv"), text).unwrap();
        let arguments = ["fit", "data.csv", "--scene", "scene.json", "--json"];
        serde_json::from_str(&stdout(&run(folder.path(), &arguments))).unwrap()
    };
    // light balls rebound by the first term of the maximum alone
    let light = fit(&[0.001, 0.002]);
    assert_eq!((&light["undetermined"], &light["converged"]), (&json!(["alpha0", "alpha1"]), &json!(false)), "{light}");
    assert!((number(&light, "mu0") / 0.7 - 1.0).abs() < 1e-5 && light["intervals"].is_null(), "{light}");
    let both = fit(&[0.001, 0.5]);
    assert_eq!((&both["undetermined"], &both["converged"]), (&json!([]), &json!(true)), "{both}");
}

#[test]
fn emoc_states_the_source_of_its_parameters_and_that_compare_has_another_law() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scene.json"), PINNED).unwrap();
    let defaults = stdout(&run(folder.path(), &["emoc", "scene.json"]));
    assert!(defaults.contains("mu0 1, alpha0 1, alpha1 1") && defaults.contains("never fitted"), "{defaults}");
    let stated = stdout(&run(folder.path(), &["emoc", "scene.json", "--alpha0", "8"]));
    assert!(stated.contains("mu0 1, alpha0 8, alpha1 1") && !stated.contains("never fitted"), "{stated}");
    for text in [&defaults, &stated] {
        assert!(text.contains("vibroimpact compare is another law"), "{text}");
    }
    let found = emoc(PINNED, &["--mu0", "0.5"]);
    assert_eq!((&found["mu0"], &found["alpha0"], &found["alpha1"]), (&0.5.into(), &1.0.into(), &1.0.into()));
    let compared = stdout(&run(folder.path(), &["compare", "scene.json"]));
    assert!(compared.contains("vibroimpact emoc takes the three-parameter law"), "{compared}");
}
