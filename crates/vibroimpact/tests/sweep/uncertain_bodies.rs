//! Fields of scenes of bodies that are given as distributions.

use super::uncertain::{holds, number, summary};
use super::*;

/// A ball thrown at a wall with a linear spring: the largest force is `v sqrt(k m)` and the impulse `2 m v`.
/// Both are lognormal if the fields are.
fn thrown() -> Value {
    json!({
        "scene": {
            "bodies": { "ball": { "kind": "mass", "mass_kg": 0.1, "velocity_m_s": 1 } },
            "contacts": [{ "name": "wall", "between": ["ground", { "body": "ball" }], "gap_m": 0.001,
                           "law": "linear-spring", "stiffness_n_m": 1e6 }],
            "end_s": 0.005
        },
        "uncertain": {
            "bodies.ball.mass_kg": { "lognormal": [0.1, 0.12] },
            "bodies.ball.velocity_m_s": { "lognormal": [1, 0.1] },
            "contacts[0].stiffness_n_m": { "lognormal": [1e6, 0.16] }
        },
        "sampling": { "draws": 2048 }
    })
}

/// Quantiles of the standard normal distribution, for the shares 1, 5, 25, 50, 75, 95 and 99 %.
const NORMAL: [f64; 7] = [-2.326_348, -1.644_854, -0.674_490, 0.0, 0.674_490, 1.644_854, 2.326_348];

#[test]
fn quantiles_and_indices_are_those_of_the_closed_form() {
    let mut sweep = thrown();
    let outputs = json!(["largest_force_n", "wall.impulse_n_s", "wall.velocity_1_m_s", "wall.count"]);
    sweep["sampling"] = json!({ "draws": 8192, "indices": true, "outputs": outputs });
    let (bench, summary) = summary(&sweep);
    let of = |output: &str| &summary["distributions"][output];
    // ln F = ln v + (ln k + ln m)/2, ln p = ln 2 + ln m + ln v; the speed after the rebound is that before it.
    let force = (0.1f64 * 1e6).sqrt();
    let known = [
        ("largest_force_n", force, [0.06f64, 0.1, 0.08]),
        ("wall.impulse_n_s", 0.2, [0.12, 0.1, 0.0]),
        ("wall.velocity_1_m_s", -1.0, [0.0, 0.1, 0.0]),
    ];
    let fields = ["bodies.ball.mass_kg", "bodies.ball.velocity_m_s", "contacts[0].stiffness_n_m"];
    for (output, median, shares) in known {
        let variance: f64 = shares.iter().map(|sd| sd * sd).sum();
        let found = of(output);
        let share = found["with_value"].as_f64().unwrap() / found["draws"].as_f64().unwrap();
        assert_eq!(share, 1.0, "{found}");
        for (quantile, x) in found["quantiles"].as_array().unwrap().iter().zip(NORMAL) {
            // That of a negative quantity has the opposite order.
            let known = median * (variance.sqrt() * x * median.signum()).exp();
            holds(quantile, known, 0.02 * median.abs());
        }
        holds(&found["mean"], median * (0.5 * variance).exp(), 1e-3 * median.abs());
        for (field, sd) in fields.iter().zip(shares) {
            // The normal parts of the logarithm add: V = e^(s^2) - 1 up to a factor.
            let first = (sd * sd).exp_m1() / variance.exp_m1();
            let total = 1.0 - (variance - sd * sd).exp_m1() / variance.exp_m1();
            holds(&found["indices"][field]["first"], first, 0.03);
            holds(&found["indices"][field]["total"], total, 0.03);
        }
    }
    // One contact in every draw.
    assert_eq!(
        (number(&of("wall.count")["mean"]["value"]), of("wall.count").get("indices")),
        (1.0, Some(&Value::Null))
    );
    let table = bench.read("out/distribution.csv");
    let mut table = csv::Reader::from_reader(&table[..]);
    let told: Vec<String> = table.records().map(|row| row.unwrap()[0].to_owned()).collect();
    assert_eq!(json!(told), outputs);
    assert!(bench.path("out/figures/distribution-4.svg").exists());
}

/// With the default outputs, and a stated error for one of them.
#[test]
fn it_ends_by_the_error_of_one_output_and_an_interruption_has_no_effect() {
    let mut sweep = thrown();
    sweep["sampling"] = json!({ "draws": 1_000_000, "sampling_error": { "largest_force_n": 1.5 } });
    let (bench, summary) = summary(&sweep);
    let found = &summary["distributions"];
    let outputs: Vec<&String> = found.as_object().unwrap().keys().collect();
    assert_eq!(outputs, ["contact_work_rate_w", "intervals", "largest_force_n"]);
    let errors = found["largest_force_n"]["quantiles"].as_array().unwrap();
    assert!(errors.iter().all(|quantile| number(&quantile["standard_error"]) <= 1.5));
    let draws = number(&summary["points"]) as u64;
    assert!([1024, 2048, 4096, 8192, 16_384].contains(&draws), "{draws}");
    let options = ["sweep", "sweep.json", "--out", "again", "--quiet"];
    let mut child = bench.command(&[&options[..], &["--threads", "1"]].concat()).spawn().unwrap();
    std::thread::sleep(std::time::Duration::from_millis(60));
    let _ = child.kill();
    child.wait().unwrap();
    bench.succeeds(&options);
    assert_same(&bench.path("out"), &bench.path("again"));
}

#[test]
fn over_a_grid_every_output_has_its_width() {
    let mut sweep = thrown();
    sweep["vary"] = json!([{ "field": "bodies.ball.mass_kg", "from": 0.1, "to": 0.4, "count": 3, "scale": "log" }]);
    sweep["uncertain"] = json!({ "bodies.ball.mass_kg": { "lognormal": [1, 0.01] } });
    sweep["sampling"] = json!({ "draws": 256, "outputs": ["largest_force_n", "wall.impulse_n_s"] });
    let (bench, summary) = summary(&sweep);
    // The width grows with the output: it is smallest at the first point and largest at the last.
    for (output, greatest, sd) in [("largest_force_n", 4e5f64.sqrt(), 0.005), ("wall.impulse_n_s", 0.8, 0.01)] {
        let width = &summary["width_90"][output];
        assert_eq!((number(&width["least_index"]), number(&width["greatest_index"])), (0.0, 2.0));
        let known = 2.0 * 1.644_854 * sd * greatest;
        assert!((number(&width["greatest"]) / known - 1.0).abs() < 0.05, "{width}, {known}");
    }
    assert_eq!(String::from_utf8(bench.read("out/distribution.csv")).unwrap().lines().count(), 1 + 3 * 2);
    assert!(bench.path("out/figures/predictability-2.svg").exists());
}

#[test]
fn errors_name_field_value_and_what_is_allowed() {
    for (pointer, value, message) in [
        (
            "/sampling/outputs",
            json!(["wall.force_n"]),
            "sampling.outputs[0] = \"wall.force_n\" is not allowed; it must be one of end_s, ",
        ),
        ("/sampling/outputs", json!(["largest_forse_n"]), "; did you mean largest_force_n?"),
        (
            "/sampling/outputs",
            json!(["end_s", "end_s"]),
            "sampling.outputs[1] = \"end_s\" is not allowed; it must be stated only once",
        ),
        (
            "/sampling/outputs",
            json!([]),
            "sampling.outputs = 0 names is not allowed; it must be a list of 1 to 32 results",
        ),
        (
            "/sampling/outputs",
            json!([3]),
            "sampling.outputs[0] = 3 is not allowed; it must be the name of a result of the sweep",
        ),
        (
            "/sampling/sampling_error",
            json!(0.1),
            "sampling.sampling_error = 0.1 is not allowed; it must be an object with such a number",
        ),
        (
            "/sampling/sampling_error",
            json!({ "end_s": 0.1 }),
            "sampling.sampling_error.end_s = 0.1 is not allowed; it must be stated for one of ",
        ),
        (
            "/sampling/sampling_error",
            json!({ "largest_force_n": -1 }),
            "sampling.sampling_error.largest_force_n = -1.0 is not",
        ),
        (
            "/sampling/sampling_error",
            json!("small"),
            "sampling.sampling_error = \"small\" is not allowed; it must be a number greater than 0",
        ),
        ("/uncertain/contacts[0].length_m", json!({ "normal": [1, 2] }), "uncertain.contacts[0].length_m = "),
    ] {
        let mut sweep = thrown();
        let (parent, key) = pointer.rsplit_once('/').unwrap();
        sweep.pointer_mut(parent).unwrap()[key] = value;
        let bench = Bench::new(&sweep);
        let told = bench.refuses(&["sweep", "sweep.json", "--out", "out"]);
        assert!(told.contains(message), "{message:?} in {told}");
        assert!(!bench.path("out").exists());
    }
}
