//! Fields that are known as distributions.

use super::*;
use std::f64::consts::PI;

/// A ball on one mode that is slow compared with the contact, like a free mass: `e = (1 - Z)/(1 + Z) = -tanh(ln(Z)/2)` with
/// `Z = m phi^2`. Below `Z = 1/3`, five standard deviations away, the mode does not return to the ball.
fn on_a_slow_mode() -> Value {
    json!({
        "scene": {
            "structure": { "kind": "modal", "omega_rad_s": [2], "shape_at_location": [1] },
            "striker": { "mass_kg": 0.1, "speed_m_s": 1 },
            "contact": { "law": "hertz", "stiffness_n_m1_5": 1e9 }
        },
        "uncertain": {
            "striker.mass_kg": { "lognormal": [0.1, 0.15] },
            "structure.shape_at_location[0]": { "lognormal": [1, 0.1] }
        },
        "sampling": { "draws": 2048 }
    })
}

/// Mean and standard deviation of the normal `ln(Z)`.
const LN_Z: [f64; 2] = [-2.3025850929940455, 0.25];

/// Computes a sweep and returns its summary.
pub fn summary(sweep: &Value) -> (Bench, Value) {
    let bench = Bench::new(sweep);
    bench.succeeds(&["sweep", "sweep.json", "--out", "out", "--quiet"]);
    let summary = serde_json::from_slice(&bench.read("out/summary.json")).unwrap();
    (bench, summary)
}

pub fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

/// Within four standard errors, which are smaller than `error`, and the tolerance of the draws.
#[track_caller]
pub fn holds(figure: &Value, known: f64, error: f64) {
    let (value, s) = (number(&figure["value"]), number(&figure["standard_error"]));
    assert!((value - known).abs() <= 4.0 * s + 1e-4 && s < error, "{figure}, known {known}");
}

#[test]
fn quantiles_are_those_of_the_closed_form() {
    let (_, summary) = summary(&on_a_slow_mode());
    let found = &summary["distributions"]["restitution"];
    assert_eq!((&found["draws"], &found["with_value"]), (&json!(2048), &json!(2048)));
    // Quantiles of the standard normal distribution.
    for (quantile, x) in found["quantiles"].as_array().unwrap().iter().zip([-2.326_348, -1.644_854, -0.674_490, 0.0]) {
        // e decreases with Z.
        let known = -(0.5 * (LN_Z[0] - LN_Z[1] * x)).tanh();
        holds(quantile, known, 1e-2);
    }
}

#[test]
fn indices_of_sobol_are_those_of_the_closed_form() {
    let mut sweep = on_a_slow_mode();
    sweep["sampling"] = json!({ "draws": 8192, "indices": true });
    let (bench, summary) = summary(&sweep);
    // f = -tanh((x + y)/2), x = ln m and y = 2 ln phi: integrals over standard normal numbers by the trapezoidal rule.
    let steps: Vec<f64> = (-60..=60).map(|k| 0.1 * f64::from(k)).collect();
    let weight = |x: f64| 0.1 * (-0.5 * x * x).exp() / (2.0 * PI).sqrt();
    let f = |x: f64, y: f64| -(0.5 * (LN_Z[0] + 0.15 * x + 0.2 * y)).tanh();
    let over = |g: &dyn Fn(f64) -> f64| steps.iter().map(|&x| weight(x) * g(x)).sum::<f64>();
    let mean = over(&|x| over(&|y| f(x, y)));
    let variance = over(&|x| over(&|y| (f(x, y) - mean).powi(2)));
    let of_mass = over(&|x| (over(&|y| f(x, y)) - mean).powi(2)) / variance;
    let of_shape = over(&|y| (over(&|x| f(x, y)) - mean).powi(2)) / variance;
    let found = &summary["distributions"]["restitution"];
    holds(&found["mean"], mean, 1e-3);
    holds(&found["standard_deviation"], variance.sqrt(), 1e-3);
    let indices = &found["indices"];
    let [mass, shape] = ["striker.mass_kg", "structure.shape_at_location[0]"].map(|field| &indices[field]);
    holds(&mass["first"], of_mass, 0.02);
    holds(&mass["total"], 1.0 - of_shape, 0.02);
    holds(&shape["first"], of_shape, 0.02);
    holds(&shape["total"], 1.0 - of_mass, 0.02);
    let table = String::from_utf8(bench.read("out/distribution.csv")).unwrap();
    let header = table.lines().next().unwrap();
    assert!(header.starts_with("output,draws,with_value,mean,mean_standard_error,"), "{header}");
    assert!(header.ends_with("total_index_structure.shape_at_location[0]_standard_error"), "{header}");
    let told = bench.succeeds(&["sweep", "sweep.json", "--out", "out", "--quiet"]);
    assert!(told.contains("first index") && told.contains("50 % below"), "{told}");
}

#[test]
fn it_ends_once_the_sampling_error_is_small_enough_despite_interruptions() {
    let mut sweep = on_a_slow_mode();
    sweep["sampling"] = json!({ "draws": 1_000_000, "sampling_error": 4e-3 });
    let (bench, summary) = summary(&sweep);
    let draws = number(&summary["points"]) as u64;
    assert!([1024, 2048, 4096, 8192].contains(&draws), "{draws}");
    let errors = summary["distributions"]["restitution"]["quantiles"].as_array().unwrap();
    assert!(errors.iter().all(|quantile| number(&quantile["standard_error"]) <= 4e-3));
    // Stopped on the way, and with another number of threads.
    assert_eq!(bench.rows("out").len() as u64, draws);
    let mut child =
        bench.command(&["sweep", "sweep.json", "--out", "again", "--threads", "1", "--quiet"]).spawn().unwrap();
    std::thread::sleep(std::time::Duration::from_millis(60));
    let _ = child.kill();
    child.wait().unwrap();
    bench.succeeds(&["sweep", "sweep.json", "--out", "again", "--threads", "3", "--quiet"]);
    assert_same(&bench.path("out"), &bench.path("again"));
    // Parts cannot know when the whole suffices.
    let told = bench.refuses(&["sweep", "sweep.json", "--out", "part", "--shard", "1/2"]);
    assert!(told.contains("sampling.sampling_error = 0.004 is not allowed; it must be left out"), "{told}");
    assert!(!bench.path("part").exists());
}

#[test]
fn a_sampling_error_that_is_not_reached_is_reported() {
    let mut sweep = on_a_slow_mode();
    sweep["sampling"] = json!({ "draws": 1024, "sampling_error": 1e-6 });
    let (bench, summary) = summary(&sweep);
    let found = &summary["distributions"]["restitution"];
    assert_eq!((&found["requested_error"], &found["reached"]), (&json!(1e-6), &json!(false)));
    let told = bench.succeeds(&["sweep", "sweep.json", "--out", "out", "--quiet"]);
    assert!(told.contains("NOT REACHED: the largest standard error is 0.00"), "{told}");
}

#[test]
fn indices_are_those_of_the_draws_that_have_a_result() {
    let mut sweep = on_a_slow_mode();
    // One draw in a hundred has a negative mass.
    sweep["uncertain"]["striker.mass_kg"] = json!({ "normal": [0.1, 0.043] });
    sweep["sampling"] = json!({ "draws": 4096, "indices": true });
    let (bench, summary) = summary(&sweep);
    let found = &summary["distributions"]["restitution"];
    let failures = number(&summary["failures"]);
    assert!((10.0..100.0).contains(&failures) && number(&found["with_value"]) == 4096.0 - failures, "{summary:#}");
    let groups = number(&found["index_groups"]);
    assert!((1024.0 - failures..1024.0).contains(&groups), "{groups}");
    // The mass has more than three times the variance of the shape.
    let mass = &found["indices"]["striker.mass_kg"];
    assert!(number(&mass["first"]["value"]) > 0.7 && number(&mass["first"]["standard_error"]) < 0.1, "{mass}");
    let told = bench.succeeds(&["sweep", "sweep.json", "--out", "out", "--quiet"]);
    assert!(told.contains(&format!("of the {groups} groups of draws in which every draw has a value")), "{told}");
}

/// The restitution of a linear contact does not depend on the speed; its rounding errors do.
#[test]
fn an_output_that_does_not_vary_has_no_indices() {
    let mut sweep = on_a_slow_mode();
    sweep["scene"]["contact"] = json!({ "law": "linear-spring", "stiffness_n_m": 1e6 });
    sweep["uncertain"] = json!({ "striker.speed_m_s": { "uniform": [0.5, 1.5] } });
    sweep["sampling"] = json!({ "draws": 192, "indices": true });
    let (bench, summary) = summary(&sweep);
    let found = &summary["distributions"]["restitution"];
    assert_eq!((&found["indices"], &found["index_groups"]), (&json!(null), &json!(64)));
    let told = bench.succeeds(&["sweep", "sweep.json", "--out", "out", "--quiet"]);
    assert!(told.contains("not defined, because restitution does not vary in 64 groups of draws"), "{told}");
    // the lowest quantile of so few draws is known, but not how well
    assert!(found["quantiles"][0]["standard_error"].is_null() && told.contains("standard error unknown"), "{told}");
}

#[test]
fn counts_have_bars_at_whole_numbers() {
    let mut sweep = on_a_slow_mode();
    sweep["sampling"]["outputs"] = json!(["sub_impact_count"]);
    let (_, summary) = summary(&sweep);
    let histogram = &summary["distributions"]["sub_impact_count"]["histogram"];
    assert_eq!(*histogram, json!({ "from": 0.5, "to": 1.5, "counts": [2048] }));
}

#[test]
fn a_fixed_number_of_draws_can_be_computed_in_parts() {
    let (bench, _) = summary(&on_a_slow_mode());
    for part in ["1/2", "2/2"] {
        bench.succeeds(&["sweep", "sweep.json", "--out", &part[..1], "--shard", part, "--quiet"]);
    }
    bench.succeeds(&["merge", "1", "2", "--out", "merged"]);
    assert_same(&bench.path("out"), &bench.path("merged"));
}

#[test]
fn on_a_grid_each_point_has_its_width() {
    let mut sweep = on_a_slow_mode();
    sweep["vary"] = json!([
        { "field": "structure.shape_at_location[0]", "from": 0.5, "to": 2, "count": 3, "scale": "log" },
        { "field": "striker.mass_kg", "values": [0.01, 0.07] }
    ]);
    // One per cent of the mass, a hundredth of the shape.
    sweep["uncertain"] = json!({
        "striker.mass_kg": { "lognormal": [1, 0.01] },
        "structure.shape_at_location[0]": { "uniform": [-0.01, 0.01] }
    });
    sweep["sampling"] = json!({ "draws": 256 });
    let (bench, summary) = summary(&sweep);
    assert_eq!((&summary["points"], summary.get("distributions")), (&json!(6 * 256), None));
    let results = String::from_utf8(bench.read("out/results.csv")).unwrap();
    let header = "index,structure.shape_at_location[0],striker.mass_kg,drawn.striker.mass_kg,drawn.structure.shape_at_location[0],";
    assert!(results.starts_with(header), "{}", &results[..200]);
    assert!(bench.path("out/figures/predictability.svg").exists());
    let mut table = csv::Reader::from_reader(&*bench.read("out/distribution.csv").leak());
    let names = table.headers().unwrap().clone();
    let at = |name: &str| names.iter().position(|column| column == name).unwrap();
    let rows: Vec<Vec<f64>> =
        table.records().map(|row| row.unwrap().iter().map(|cell| cell.parse().unwrap_or(f64::NAN)).collect()).collect();
    assert_eq!((rows.len(), at("output")), (6, 2));
    for row in &rows {
        let (phi, mass) = (row[0], row[1]);
        let z = mass * phi * phi;
        assert!((row[at("quantile_0.5")] - (1.0 - z) / (1.0 + z)).abs() < 1e-3);
        // To first order: de = 2 Z/(1+Z)^2 d ln Z.
        let of_ln_z = (0.01f64.powi(2) + (2.0 * 0.01 / phi).powi(2) / 3.0).sqrt();
        let expected = 2.0 * z / (1.0 + z).powi(2) * of_ln_z;
        assert!((row[at("standard_deviation")] / expected - 1.0).abs() < 0.03, "{row:?}, {expected}");
    }
}

#[test]
fn errors_name_field_value_and_what_is_allowed() {
    let refused = |change: &dyn Fn(&mut Value), message: &str| {
        let mut sweep = on_a_slow_mode();
        change(&mut sweep);
        let bench = Bench::new(&sweep);
        let told = bench.refuses(&["sweep", "sweep.json", "--out", "out"]);
        assert!(told.contains(message), "{message:?} in {told}");
        assert!(!bench.path("out").exists());
    };
    let distribution = |value: Value| move |sweep: &mut Value| sweep["uncertain"]["striker.mass_kg"] = value.clone();
    let of_mass = "uncertain.striker.mass_kg = ";
    let list = "is not allowed; it must be an object with one of uniform, log-uniform, normal and lognormal, which is a list of two";
    for (value, allowed) in [
        (json!(3), list),
        (json!({ "gauss": [1, 2] }), list),
        (json!({ "normal": [1] }), list),
        (json!({ "normal": [1, 2], "uniform": [1, 2] }), list),
        (
            json!({ "normal": [1, 0] }),
            "is not allowed; it must be stated by a finite mean and a positive standard deviation",
        ),
        (
            json!({ "uniform": [2, 1] }),
            "is not allowed; it must be stated by two finite numbers, the first below the second",
        ),
        (
            json!({ "log-uniform": [0, 1] }),
            "is not allowed; it must be stated by two positive numbers, the first below the second",
        ),
        (
            json!({ "lognormal": [-1, 1] }),
            "is not allowed; it must be stated by a positive median and a positive standard deviation",
        ),
    ] {
        refused(&distribution(value.clone()), &format!("{of_mass}{value} {allowed}"));
    }
    refused(
        &|sweep| sweep["uncertain"] = json!({}),
        "uncertain = {} is not allowed; it must be an object with 1 to 128 fields",
    );
    refused(&|sweep| sweep["uncertain"]["striker.weight"] = json!({ "normal": [1, 2] }), "uncertain.striker.weight = ");
    refused(&|sweep| sweep["uncertain"]["a..b"] = json!({ "normal": [1, 2] }), "uncertain.a..b = ");
    refused(&|sweep| sweep["uncertain"]["structure.kind"] = json!({ "normal": [1, 2] }), "uncertain.structure.kind = ");
    refused(
        &|sweep| sweep["sampling"]["draws"] = json!(16),
        "sampling.draws = 16 is not allowed; it must be a whole number from 32",
    );
    refused(&|sweep| sweep["sampling"]["draws"] = json!(-1), "sampling.draws = -1 is not allowed");
    refused(&|sweep| sweep["sampling"]["draws"] = json!(2_000_000_000_000u64), "sampling.draws = 2000000000000");
    refused(
        &|sweep| sweep["sampling"]["replicates"] = json!(1),
        "sampling.replicates = 1 is not allowed; it must be a whole number",
    );
    refused(
        &|sweep| sweep["sampling"]["sequence"] = json!("sobel"),
        "sampling.sequence = \"sobel\" is not allowed; it must be sobol",
    );
    refused(&|sweep| sweep["sampling"]["sampling_error"] = json!(0), "sampling.sampling_error = 0.0 is not allowed");
    refused(
        &|sweep| sweep["sampling"]["indices"] = json!(3),
        "sampling.indices = 3 is not allowed; it must be true or false",
    );
    refused(
        &|sweep| {
            let many = (0..65).map(|k| (format!("structure.omega_rad_s[{k}]"), json!({ "normal": [1, 0.1] })));
            sweep["uncertain"] = many.collect();
            sweep["sampling"]["indices"] = json!(true);
        },
        "sampling.indices = true is not allowed; it must be left out, because indices need at most 64 uncertain fields and there are 65",
    );
    refused(&|sweep| sweep["sampling"]["count"] = json!(3), "sampling.count = 3 is not a known field");
    refused(&|sweep| drop(sweep.as_object_mut().unwrap().remove("uncertain")), "uncertain is missing");
    refused(
        &|sweep| {
            sweep["vary"] = json!([{ "field": "striker.speed_m_s", "values": [1, 2] }]);
            sweep["sampling"]["sampling_error"] = json!(0.1);
        },
        "sampling.sampling_error = 0.1 is not allowed; it must be left out in the presence of vary",
    );
    refused(
        &|sweep| {
            let speeds = json!([{ "field": "striker.speed_m_s", "from": 1, "to": 2 }]);
            sweep["random"] = json!({ "seed": 1, "draws": 2, "fields": speeds });
        },
        "random = {...} is not allowed; it must be left out in the presence of uncertain",
    );
}

#[test]
fn predictability_maps_the_width_under_a_blur() {
    let bench = Bench::new(&json!({}));
    fs::write(bench.path("scene.json"), on_a_slow_mode()["scene"].to_string()).unwrap();
    let map = |options: &[&str]| {
        let fixed = ["predictability", "scene.json", "--blur", "structure.shape_at_location[0]=0.01", "--out", "out"];
        bench.run(&[&fixed[..], options].concat())
    };
    let shape = "structure.shape_at_location[0]=0.5:1.5:3";
    let options = ["--over", shape, "--over", "striker.mass_kg=0.01:0.1:2:log", "--blur", "striker.speed_m_s=1%"];
    let output = map(&options);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let told = String::from_utf8(output.stdout).unwrap();
    assert!(told.contains("width of 9 in 10"), "{told}");
    assert_eq!(bench.rows("out").len(), 3 * 2 * 256);
    // The speed varies about the scene's own 1 m/s, and has no effect with Hertz's law; the shape has the effect of first
    // order.
    let table = bench.read("out/distribution.csv");
    for row in csv::Reader::from_reader(&table[..]).records().map(Result::unwrap) {
        let at = |place: usize| row[place].parse::<f64>().unwrap();
        let (phi, mass) = (at(0), at(1));
        assert_eq!(&row[2], "restitution");
        let z = mass * phi * phi;
        // The interval of 9 in 10 of a normal distribution.
        let width = 2.0 * 1.644_854 * 4.0 * mass * phi / (1.0 + z).powi(2) * 0.01;
        assert!((at(9) / width - 1.0).abs() < 0.05, "{row:?}, {width}");
    }
    assert!(String::from_utf8_lossy(&map(&options).stdout).contains("nothing; all points were done"));

    let refused = |options: &[&str], message: &str| {
        fs::remove_dir_all(bench.path("out")).unwrap_or_default();
        let output = map(options);
        let told = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{told}");
        assert!(told.contains(message), "{message:?} in {told}");
        assert!(!bench.path("out").exists());
    };
    refused(&["--over", "striker.mass_kg=0:1:3:log"], "--over striker.mass_kg, from = 0.0 is not allowed");
    refused(&["--over", "striker.mass_kg=0:1"], "it must be FIELD=FROM:TO:COUNT");
    refused(&["--over", "striker.mass_kg=NaN:1:3"], "--over striker.mass_kg, from");
    refused(&["--over", "striker.weight=1:2:3"], "--over striker.weight");
    refused(&["--over", shape, "--blur", "striker.weight=1"], "--blur = \"striker.weight\" is not allowed");
    refused(&["--over", shape, "--blur", "striker.mass_kg=x"], "it must be FIELD=WIDTH");
    refused(&["--over", shape, "--blur", "striker.mass_kg=-1%"], "--blur striker.mass_kg = -1.0% is not allowed");
    refused(&["--over", shape, "--draws", "3"], "--draws = 3 is not allowed; it must be a whole number from 32");
    refused(&["--over", shape, "--over", "a=1:2:3", "--over", "b=1:2:3"], "--over = 3 fields is not allowed");
}
