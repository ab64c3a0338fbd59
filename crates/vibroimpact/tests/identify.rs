//! `vibroimpact identify`: parameters from synthetic measurements whose true values are known.

use std::fs;
use std::path::Path;

use crate::program::{run, stdout};
use serde_json::{Value, json};
use vibroimpact::Scene;

/// A list of modes: it is cheap, and its true values are the same for any number of modes.
fn scene(stiffness: f64, mass: f64) -> Value {
    let omega = [58.2, 364.7, 1021.2, 2001.1, 3308.0, 4941.6];
    json!({
        "structure": {
            "kind": "modal", "omega_rad_s": omega, "damping_ratios": [0.004, 0.005, 0.006, 0.008, 0.01, 0.012],
            "points": {
                "tip": { "shape": [1.86, -1.52, 1.22, -0.91, 0.60, -0.31] },
                "middle": { "shape": [0.68, 1.43, 0.04, -1.40, -0.30, 1.2] },
                "quarter": { "shape": [0.19, 0.82, 1.30, 0.80, -0.6, -1.1] }
            }
        },
        "striker": { "mass_kg": mass, "speed_m_s": 1 },
        "contact": { "law": "hertz", "stiffness_n_m1_5": stiffness },
        "location": "tip"
    })
}

/// Normal deviates: SplitMix64 and the method of Box and Muller.
struct Noise(u64);

impl Noise {
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    fn next(&mut self) -> f64 {
        let (a, b) = (1.0 - self.uniform(), self.uniform());
        (-2.0 * a.ln()).sqrt() * (std::f64::consts::TAU * b).cos()
    }
}

const POINTS: [&str; 3] = ["tip", "middle", "quarter"];

/// Impacts at three points and four speeds, measured with this noise.
fn table(truth: &Value, noise: [f64; 2], stated: bool, random: &mut Noise) -> String {
    let mut text = if stated {
        "location,striker.speed_m_s,restitution,restitution_sd,first_contact_s,first_contact_s_sd\n".to_owned()
    } else {
        "location,striker.speed_m_s,restitution,first_contact_s\n".to_owned()
    };
    for point in POINTS {
        for speed in [0.5, 1.0, 2.0, 4.0] {
            let mut tree = truth.clone();
            tree["location"] = json!(point);
            tree["striker"]["speed_m_s"] = json!(speed);
            let found = Scene::from_value(&tree).unwrap().impact().unwrap().solve().unwrap();
            let first = &found.sub_impacts[0];
            let e = found.restitution.unwrap() + noise[0] * random.next();
            let contact = (first.end_s - first.start_s) + noise[1] * random.next();
            text += &if stated {
                format!("{point},{speed:?},{e:?},{:?},{contact:?},{:?}\n", noise[0], noise[1])
            } else {
                format!("{point},{speed:?},{e:?},{contact:?}\n")
            };
        }
    }
    text
}

fn identify(scene: &Value, table: &str, options: &[&str]) -> Value {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scene.json"), scene.to_string()).unwrap();
    fs::write(folder.path().join("data.csv"), table).unwrap();
    in_folder(folder.path(), options)
}

fn in_folder(folder: &Path, options: &[&str]) -> Value {
    let arguments = [&["--quiet", "identify", "data.csv", "--scene", "scene.json", "--json"], options].concat();
    serde_json::from_str(&stdout(&run(folder, &arguments))).unwrap()
}

fn value(found: &Value, j: usize) -> f64 {
    found["parameters"][j]["value"].as_f64().unwrap()
}

const FREE: &str = "contact.stiffness_n_m1_5,striker.mass_kg";

#[test]
fn exact_data_give_their_true_parameters() {
    let table = table(&scene(1.2e9, 0.05), [0.0, 0.0], false, &mut Noise(1));
    let found = identify(&scene(0.8e9, 0.07), &table, &["--free", FREE]);
    assert!((value(&found, 0) / 1.2e9 - 1.0).abs() < 1e-6, "{found:#}");
    assert!((value(&found, 1) / 0.05 - 1.0).abs() < 1e-6, "{found:#}");
    // the estimated noise is not that with which the search begins
    for (j, size) in [(0, 1.2e9), (1, 0.05)] {
        let end = |k: usize| found["parameters"][j]["covariance_interval"][k].as_f64().unwrap();
        assert!(end(1) - end(0) < 1e-6 * size, "{found:#}");
    }
}

/// A plate's peak force needs many more modes than its restitution.
#[test]
fn modes_are_chosen_for_every_measured_quantity() {
    let scene = |law: [f64; 2], speed: f64| {
        json!({
            "structure": {
                "kind": "plate", "length_m": 0.4, "width_m": 0.3, "thickness_m": 0.005, "youngs_modulus_pa": 2e11,
                "poissons_ratio": 0.3, "density_kg_m3": 7800, "damping_ratio": 0.01,
                "edges": ["pinned", "pinned", "pinned", "pinned"]
            },
            "striker": { "density_kg_m3": 7800, "radius_m": 0.015, "speed_m_s": speed },
            "contact": { "law": "hunt-crossley", "stiffness_n_m1_5": law[0], "restitution": law[1] },
            "location_m": [0.2, 0.15]
        })
    };
    let truth = [3e9, 0.7];
    let mut table = "striker.speed_m_s,restitution,restitution_sd,peak_force_n,peak_force_n_sd\n".to_owned();
    for speed in [0.5, 2.0, 4.0] {
        let mut fine = scene(truth, speed);
        (fine["modes"], fine["residual_compliance"]) = (json!(1000), json!(true));
        let found = Scene::from_value(&fine).unwrap().impact().unwrap().solve().unwrap();
        let peak = found.sub_impacts.iter().map(|contact| contact.peak_force_n).fold(0.0, f64::max);
        let restitution = found.restitution.unwrap();
        table += &format!("{speed},{restitution},{},{peak},{}\n", 0.01 * restitution, 0.01 * peak);
    }
    let found =
        identify(&scene([2.5e9, 0.6], 1.0), &table, &["--free", "contact.stiffness_n_m1_5,contact.restitution"]);
    for (j, truth) in truth.into_iter().enumerate() {
        let end = |k: usize| found["parameters"][j]["covariance_interval"][k].as_f64().unwrap();
        assert!((value(&found, j) - truth).abs() < 0.1 * (end(1) - end(0)) / 2.0, "{found:#}");
    }
    let left_out_sd = found["left_out_modes_sd"].as_f64().unwrap();
    assert!(left_out_sd > 0.0 && left_out_sd < 1.0, "{found:#}");
}

/// 95 % intervals of 12 tables with noise, twice; the study has thousands. Of 24 intervals that contain the true value with
/// probability 0.95, fewer than 19 do so one time in ten thousand.
#[test]
fn intervals_contain_the_true_values_as_often_as_stated() {
    use vibroimpact::identify::{Data, Free, Request, identify};
    let truth = scene(1.2e9, 0.05);
    let begin = Scene::from_value(&scene(1.3e9, 0.055)).unwrap();
    let free: Vec<Free> = FREE.split(',').map(|field| Free::parse(field).unwrap()).collect();
    let request = Request { starts: 1, ..Request::default() };
    let exact = table(&truth, [0.0, 0.0], false, &mut Noise(0));
    for (stated, noise) in [(true, [0.004, 4e-7]), (false, [0.004, 4e-7])] {
        let (mut covered, mut by_covariance, mut fits) = (0, 0, 0);
        for seed in 0..12 {
            let noisy = with_noise(&exact, noise, stated, &mut Noise(1000 + seed));
            let data = Data::parse(noisy.as_bytes(), &|_| unreachable!()).unwrap();
            let found = identify(&begin, &data, &free, &request).unwrap();
            for (parameter, truth) in found.parameters.iter().zip([1.2e9, 0.05]) {
                let [low, high] = parameter.profile_interval;
                covered += usize::from(low.is_none_or(|low| low <= truth) && high.is_none_or(|high| high >= truth));
                let [low, high] = parameter.covariance_interval.unwrap();
                by_covariance += usize::from(low <= truth && truth <= high);
            }
            fits += usize::from(found.lack_of_fit.iter().all(|test| !test.noticed));
        }
        assert!((19..=24).contains(&covered), "{stated}: {covered} of 24 by profile");
        assert!((19..=24).contains(&by_covariance), "{stated}: {by_covariance} of 24 by covariance");
        assert!(fits >= 10, "{stated}: {fits} of 12 fit");
    }
}

/// The same table with added noise.
fn with_noise(exact: &str, noise: [f64; 2], stated: bool, random: &mut Noise) -> String {
    let mut lines = exact.lines();
    let header = lines.next().unwrap();
    let sds = if stated { ",restitution_sd,first_contact_s_sd" } else { "" };
    let mut text = format!("{header}{sds}\n");
    for line in lines {
        let cells: Vec<&str> = line.split(',').collect();
        let number = |k: usize| cells[k].parse::<f64>().unwrap();
        let (e, contact) = (number(2) + noise[0] * random.next(), number(3) + noise[1] * random.next());
        let sds = if stated { format!(",{:?},{:?}", noise[0], noise[1]) } else { String::new() };
        text += &format!("{},{},{e:?},{contact:?}{sds}\n", cells[0], cells[1]);
    }
    text
}

#[test]
fn a_wrong_model_is_detected() {
    let table = table(&scene(1.2e9, 0.05), [0.004, 4e-7], true, &mut Noise(7));
    let noticed = |scene: &Value, free: &str| {
        let found = identify(scene, &table, &["--free", free, "--starts", "1"]);
        let test = &found["lack_of_fit"][0];
        assert_eq!(test["test"], "chi-square");
        test["noticed"].as_bool().unwrap()
    };
    assert!(!noticed(&scene(1.3e9, 0.055), FREE));
    // Another law: a linear spring, whose contacts have the same duration at every speed.
    let mut other = scene(1.0, 0.055);
    other["contact"] = json!({ "law": "linear-spring", "stiffness_n_m": 1e7 });
    assert!(noticed(&other, "contact.stiffness_n_m"));
    // Another damping: far more in the higher modes.
    let mut other = scene(1.3e9, 0.055);
    other["structure"]["damping_ratios"] = json!([0.004, 0.005, 0.3, 0.3, 0.3, 0.3]);
    assert!(noticed(&other, FREE));
}

#[test]
fn repeated_rows_reveal_a_wrong_model_without_stated_noise() {
    let truth = scene(1.2e9, 0.05);
    let mut random = Noise(11);
    let exact = table(&truth, [0.0, 0.0], false, &mut random);
    let mut text = exact.lines().next().unwrap().to_owned() + "\n";
    for _ in 0..3 {
        let noisy = with_noise(&exact, [0.004, 4e-7], false, &mut random);
        text += noisy.split_once('\n').unwrap().1;
    }
    let found = identify(&scene(1.3e9, 0.055), &text, &["--free", FREE, "--starts", "1"]);
    assert_eq!(
        (&found["lack_of_fit"][0]["test"], &found["lack_of_fit"][0]["noticed"]),
        (&json!("repeated rows"), &json!(false))
    );
    // The noise is estimated, too.
    for (noise, truth) in found["noise"].as_array().unwrap().iter().zip([0.004, 4e-7]) {
        assert!((noise["standard_deviation"].as_f64().unwrap() / truth - 1.0).abs() < 0.3, "{noise}");
    }
    let mut other = scene(1.3e9, 0.055);
    other["structure"]["damping_ratios"] = json!([0.004, 0.005, 0.3, 0.3, 0.3, 0.3]);
    let found = identify(&other, &text, &["--free", FREE, "--starts", "1"]);
    assert_eq!(found["lack_of_fit"][0]["noticed"], true, "{found:#}");
}

/// Force histories of four speeds with noise, delayed by the gauge and by its clock, in separate files.
fn with_records(folder: &Path, truth: &Value, time_constant: f64, noise: f64) {
    let mut random = Noise(21);
    let mut text = "striker.speed_m_s,force_file,force_n_sd\n".to_owned();
    for (i, speed) in [0.5, 1.0, 2.0].into_iter().enumerate() {
        let mut tree = truth.clone();
        tree["striker"]["speed_m_s"] = json!(speed);
        let (_, history) = Scene::from_value(&tree).unwrap().impact().unwrap().record().unwrap();
        // The gauge by explicit steps of its equation, far finer than the samples.
        let (offset, until) = (0.3 + 0.1 * i as f64, 1.1 * history.duration_s());
        let steps = 400_000;
        let h = until / f64::from(steps);
        let (mut shown, mut file) = (0.0, "time_s,force_n\n".to_owned());
        for k in 0..steps {
            if k % 1000 == 0 {
                file += &format!("{:?},{:?}\n", offset + h * f64::from(k), shown + noise * random.next());
            }
            // The midpoint rule.
            let force = history.at(h * (f64::from(k) + 0.5)).force_n;
            shown += h / (time_constant + 0.5 * h) * (force - shown);
        }
        fs::write(folder.join(format!("force-{i}.csv")), file).unwrap();
        text += &format!("{speed:?},force-{i}.csv,{noise:?}\n");
    }
    fs::write(folder.join("data.csv"), text).unwrap();
}

#[test]
fn force_histories_determine_the_contact_and_the_gauge() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scene.json"), scene(1.4e9, 0.05).to_string()).unwrap();
    with_records(folder.path(), &scene(1.2e9, 0.05), 2e-5, 2.0);
    let free = "contact.stiffness_n_m1_5,gauge.time_constant_s=1e-6..1e-3";
    // One start, because the misfit has one minimum.
    fs::write(folder.path().join("next.csv"), "striker.speed_m_s\n0.1\n4\n").unwrap();
    let options = ["--free", free, "--starts", "1", "--plot", "picture.svg", "--candidates", "next.csv"];
    let found = in_folder(folder.path(), &options);
    // A force history is measured again: at 4 m/s with a force over twelve times as large as the one in the table's third.
    let ratio = |k: usize| found["candidates"][k]["volume_ratio"].as_f64().unwrap();
    assert!(found["candidates"][0]["line"] == 3 && ratio(0) < 0.5 && (0.5..1.0).contains(&ratio(1)), "{found:#}");
    for (j, truth) in [1.2e9, 2e-5].into_iter().enumerate() {
        let [low, high] = [0, 1].map(|k| found["parameters"][j]["profile_interval"][k].as_f64().unwrap());
        // Three standard deviations.
        let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
        assert!((middle - truth).abs() < 1.6 * half && half < 0.03 * truth, "{j}: {low} to {high}");
    }
    for (record, offset) in found["records"].as_array().unwrap().iter().zip([0.3, 0.4, 0.5]) {
        assert!((record["offset_s"].as_f64().unwrap() - offset).abs() < 1e-6, "{record}");
    }
    assert!(found["lack_of_fit"].as_array().unwrap().iter().all(|test| test["noticed"] == false), "{found:#}");
    assert!(fs::read_to_string(folder.path().join("picture.svg")).unwrap().contains("force-0.csv"));
    // A gauge that is assumed to have no delay.
    let found = in_folder(folder.path(), &["--free", "contact.stiffness_n_m1_5", "--starts", "1"]);
    assert!(found["lack_of_fit"].as_array().unwrap().iter().all(|test| test["noticed"] == true), "{found:#}");
}

/// The history that `simulate` writes is a force history as it is: its columns of displacements and velocities are passed over.
#[test]
fn the_history_of_simulate_is_a_force_history() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("truth.json"), scene(1.2e9, 0.05).to_string()).unwrap();
    fs::write(folder.path().join("scene.json"), scene(1.4e9, 0.05).to_string()).unwrap();
    stdout(&run(folder.path(), &["--quiet", "simulate", "truth.json", "--out", "simulated"]));
    fs::write(folder.path().join("data.csv"), "location,force_file,force_n_sd\ntip,simulated/history.csv,1\n").unwrap();
    let options = ["--free", "contact.stiffness_n_m1_5", "--starts", "1"];
    let found = in_folder(folder.path(), &options);
    assert!((value(&found, 0) / 1.2e9 - 1.0).abs() < 1e-5, "{found:#}");
    // The same columns and one more.
    let history = folder.path().join("simulated/history.csv");
    let more = |(k, line): (usize, &str)| format!("{line},{}\n", if k == 0 { "temperature_k" } else { "293" });
    let text: String = fs::read_to_string(&history).unwrap().lines().enumerate().map(more).collect();
    fs::write(&history, text).unwrap();
    let output = run(folder.path(), &[&["identify", "data.csv", "--scene", "scene.json"], &options[..]].concat());
    let message = String::from_utf8(output.stderr).unwrap();
    let said =
        "simulated/history.csv, column temperature_k = 1 column is not allowed; it must be left out: a force history";
    assert!(output.status.code() == Some(2) && message.contains(said), "{message}");
}

/// Impacts at a rigid location, where contact durations determine only the ratio of stiffness to mass: T ~ (m/k)^(2/5).
fn at_a_rigid_location() -> (Value, &'static str) {
    let scene = json!({
        "structure": { "kind": "modal", "omega_rad_s": [1000], "shape_at_location": [1e-6] },
        "striker": { "mass_kg": 0.1, "speed_m_s": 1 },
        "contact": { "law": "hertz", "stiffness_n_m1_5": 1e9 }
    });
    let table = "striker.speed_m_s,first_contact_s,first_contact_s_sd\n0.5,3.0e-4,1e-6\n1,2.6e-4,1e-6\n2,2.2e-4,1e-6\n";
    (scene, table)
}

/// The duration `T = c (m/k)^(2/5) v^(-1/5)` by Hertz, fitted by hand.
#[test]
fn a_combination_that_is_determined_has_its_value() {
    let (scene, table) = at_a_rigid_location();
    let found = identify(&scene, table, &["--free", FREE]);
    for parameter in found["parameters"].as_array().unwrap() {
        assert_eq!(parameter["determined"], false);
        assert_eq!(parameter["covariance_interval"], Value::Null);
        assert_eq!(parameter["profile_interval"], json!([null, null]));
    }
    let only = &found["combinations"][0];
    assert_eq!(found["combinations"].as_array().unwrap().len(), 1);
    let exponent = |field: &str| only["exponents"][field].as_f64().unwrap();
    let power = exponent("contact.stiffness_n_m1_5");
    assert!((power.abs() - 1.0).abs() < 1e-5 && (exponent("striker.mass_kg") / power + 1.0).abs() < 1e-5, "{only}");
    // 2 sqrt(pi) Gamma(7/5)/Gamma(9/10)
    let c = 2.943_275_1 * 1.25f64.powf(0.4);
    let slopes = [0.5f64, 1.0, 2.0].map(|speed| c * speed.powf(-0.2));
    let square: f64 = slopes.iter().map(|slope| slope * slope).sum();
    let a = slopes.iter().zip([3.0e-4, 2.6e-4, 2.2e-4]).map(|(slope, duration)| slope * duration).sum::<f64>() / square;
    let half = 1.959_964 * 2.5 * 1e-6 / square.sqrt() / a;
    let ratio = a.powf(-2.5).powf(power.signum());
    assert!((only["value"].as_f64().unwrap() / ratio - 1.0).abs() < 1e-4, "{only} {ratio}");
    let [low, high] = [0, 1].map(|k| only["interval"][k].as_f64().unwrap());
    assert!(((high / low).ln() / (2.0 * half) - 1.0).abs() < 1e-3, "{only} {half}");

    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scene.json"), scene.to_string()).unwrap();
    fs::write(folder.path().join("data.csv"), table).unwrap();
    let text =
        stdout(&run(folder.path(), &["--quiet", "identify", "data.csv", "--scene", "scene.json", "--free", FREE]));
    for field in FREE.split(',') {
        let line = text.lines().find(|line| line.trim_start().starts_with(field)).unwrap();
        assert!(line.contains("  not determined  open; the search stopped at "), "{text}");
    }
    let product = only["product"].as_str().unwrap();
    assert!(text.contains(&format!("  determined            {product} = ")), "{text}");
    // A field that the data determine beside those is printed as before.
    let found = identify(&scene, table, &["--free", "contact.stiffness_n_m1_5"]);
    assert_eq!((&found["parameters"][0]["determined"], &found["combinations"]), (&json!(true), &json!([])));
}

#[test]
fn undetermined_combinations_are_reported() {
    let (scene, table) = at_a_rigid_location();
    let found = identify(&scene, table, &["--free", "contact.stiffness_n_m1_5,striker.mass_kg"]);
    let open = &found["undetermined"][0];
    assert_eq!(found["undetermined"].as_array().unwrap().len(), 1);
    let text = open["text"].as_str().unwrap();
    assert!(text.contains("leave a combination open: raising") && text.contains("and raising"), "{text}");
    let entry = |field: &str| open["direction"][field].as_f64().unwrap();
    let ratio = entry("contact.stiffness_n_m1_5") / entry("striker.mass_kg");
    assert!((ratio - 1.0).abs() < 1e-3, "{ratio}");
    assert_eq!(found["parameters"][0]["profile_interval"], json!([null, null]));
    // Damping has no effect there.
    let mut damped = scene.clone();
    damped["structure"]["damping_ratios"] = json!([0.01]);
    let found = identify(&damped, table, &["--free", "structure.damping_ratios[0]"]);
    assert!(found["undetermined"][0]["text"].as_str().unwrap().contains("structure.damping_ratios[0]"));
}

/// Restitutions that are a little higher than those without damping: the least sum of squares is at zero damping, far below the
/// interval of the search, and the data still exclude a large one.
#[test]
fn a_damping_that_is_best_at_zero_has_an_upper_limit() {
    let scene = json!({
        "structure": { "kind": "modal", "omega_rad_s": [900, 2500], "damping_ratios": [0.05, 0.05], "shape_at_location": [1.0, 0.7] },
        "striker": { "mass_kg": 0.5, "speed_m_s": 1 },
        "contact": { "law": "linear-spring", "stiffness_n_m": 4e5 }
    });
    let restitution = |damping: f64| {
        let mut scene = scene.clone();
        scene["structure"]["damping_ratios"] = json!([damping, 0.05]);
        Scene::from_json(&scene.to_string()).unwrap().answer().unwrap().restitution.unwrap()
    };
    let measured = restitution(0.0) + 1e-3;
    let sd = 0.01;
    let table = format!("striker.speed_m_s,restitution,restitution_sd\n1,{measured},{sd}\n2,{measured},{sd}\n");
    let found = identify(&scene, &table, &["--free", "structure.damping_ratios[0]=0.001..0.2"]);
    let parameter = &found["parameters"][0];
    let [low, high] = [0, 1].map(|end| parameter["profile_interval"][end].as_f64());
    assert!(low.is_none() && parameter["determined"] == false, "{parameter}");
    // 2 (1e-3 + fall)^2 / sd^2 = 2 (1e-3)^2 / sd^2 + 1.96^2
    let rise = |damping: f64| 2.0 * ((measured - restitution(damping)).powi(2) - 1e-6) / (sd * sd);
    assert!((rise(high.unwrap()).sqrt() / 1.96 - 1.0).abs() < 0.02, "{parameter}");
    let text = found["undetermined"][0]["text"].as_str().unwrap();
    assert_eq!(text, "The data determine only an upper limit of structure.damping_ratios[0].");
}

#[test]
fn the_next_experiment_is_the_most_informative_one() {
    let folder = tempfile::tempdir().unwrap();
    let truth = scene(1.2e9, 0.05);
    fs::write(folder.path().join("scene.json"), scene(1.2e9, 0.05).to_string()).unwrap();
    fs::write(folder.path().join("data.csv"), table(&truth, [0.004, 4e-7], true, &mut Noise(3))).unwrap();
    let mut candidates = "location,striker.speed_m_s\n".to_owned();
    for point in POINTS {
        for speed in [0.2, 1.0, 5.0] {
            candidates += &format!("{point},{speed:?}\n");
        }
    }
    fs::write(folder.path().join("next.csv"), &candidates).unwrap();
    let found = in_folder(folder.path(), &["--free", FREE, "--starts", "1", "--candidates", "next.csv"]);
    let ranked = found["candidates"].as_array().unwrap();
    let ratios: Vec<f64> = ranked.iter().map(|one| one["volume_ratio"].as_f64().unwrap()).collect();
    assert!(ratios.len() == 9 && ratios.is_sorted() && ratios[0] < 0.95 && ratios[8] <= 1.0, "{ratios:?}");
    // The second method: simulate the best and the worst of them, and fit again.
    let volume = |found: &Value| {
        let se = |j: usize| {
            let ends = &found["parameters"][j]["covariance_interval"];
            (ends[1].as_f64().unwrap() / ends[0].as_f64().unwrap()).ln()
        };
        let correlation = found["correlation"][0][1].as_f64().unwrap();
        se(0) * se(1) * (1.0 - correlation * correlation).sqrt()
    };
    let before = volume(&found);
    for (one, ratio) in [(&ranked[0], ratios[0]), (&ranked[8], ratios[8])] {
        let mut tree = truth.clone();
        let (point, speed) = (&one["fields"]["location"], &one["fields"]["striker.speed_m_s"]);
        tree["location"] = point.clone();
        tree["striker"]["speed_m_s"] = speed.clone();
        let made = Scene::from_value(&tree).unwrap().impact().unwrap().solve().unwrap();
        let first = made.sub_impacts[0].end_s - made.sub_impacts[0].start_s;
        let data = fs::read_to_string(folder.path().join("data.csv")).unwrap();
        let measured = format!("{:?},0.004,{first:?},4e-7", made.restitution.unwrap());
        let with = format!("{data}{},{speed},{measured}\n", point.as_str().unwrap());
        let again = identify(&truth, &with, &["--free", FREE, "--starts", "1"]);
        // The fit changes slightly, and with it the derivatives.
        assert!((volume(&again) / before / ratio - 1.0).abs() < 0.1, "{one}: {} {ratio}", volume(&again) / before);
    }
}

/// Impacts with three to six contacts, whose sum of squares has many minima: several starts find the true parameters where one
/// does not, and the text says what a misfit may mean. The ratings of further experiments are recomputed from the derivatives that
/// `sensitivity` gives.
#[test]
fn many_minima_are_searched_and_reported() {
    let folder = tempfile::tempdir().unwrap();
    let truth = scene(1.2e9, 0.5);
    let at = |point: &str, speed: f64| {
        let mut tree = truth.clone();
        tree["location"] = json!(point);
        tree["striker"]["speed_m_s"] = json!(speed);
        tree
    };
    let mut text = "location,striker.speed_m_s,restitution,restitution_sd\n".to_owned();
    let places: Vec<(&str, f64)> = POINTS.into_iter().flat_map(|p| [0.5, 1.0, 2.0, 4.0].map(|v| (p, v))).collect();
    for (point, speed) in &places {
        let found = Scene::from_value(&at(point, *speed)).unwrap().impact().unwrap().solve().unwrap();
        assert!(found.sub_impacts.len() > 2);
        text += &format!("{point},{speed:?},{:?},0.001\n", found.restitution.unwrap());
    }
    fs::write(folder.path().join("scene.json"), scene(2e9, 0.4).to_string()).unwrap();
    fs::write(folder.path().join("data.csv"), text).unwrap();
    fs::write(folder.path().join("next.csv"), "location,striker.speed_m_s\ntip,8\nmiddle,0.2\nquarter,8\n").unwrap();
    let command = |starts: &str, more: &[&str]| {
        // quiet, since a slow machine would report the progress
        let arguments =
            ["--quiet", "identify", "data.csv", "--scene", "scene.json", "--free", FREE, "--starts", starts];
        stdout(&run(folder.path(), &[&arguments[..], more].concat())).split_whitespace().collect::<Vec<_>>().join(" ")
    };
    for said in ["THE MODEL DOES NOT FIT, or the search has missed the least sum", "from one starting point: the sum"] {
        assert!(command("1", &[]).contains(said));
    }
    assert!(command("4", &[]).contains("3 of 4 starting points lead to the least robust sum: there are other minima"));
    let options = ["--free", FREE, "--starts", "4", "--candidates", "next.csv"];
    let found = in_folder(folder.path(), &options);
    assert!((value(&found, 0) / 1.2e9 - 1.0).abs() < 1e-6 && (value(&found, 1) / 0.5 - 1.0).abs() < 1e-6);

    // with the logarithms of both parameters
    let fields = FREE.split(',').map(str::to_owned).collect::<Vec<_>>();
    let row = |point: &str, speed: f64| {
        let found = Scene::from_value(&at(point, speed)).unwrap().sensitivity(&fields).unwrap();
        let of = |field: &str, value: f64| found.of("restitution", field).unwrap().value * value / 0.001;
        [of(&fields[0], 1.2e9), of(&fields[1], 0.5)]
    };
    let prior = 9f64.ln().powi(-2);
    let mut known = [prior, 0.0, prior];
    let add = |m: [f64; 3], [a, b]: [f64; 2]| [m[0] + a * a, m[1] + a * b, m[2] + b * b];
    let volume = |m: [f64; 3]| (m[0] * m[2] - m[1] * m[1]).sqrt().recip();
    for (point, speed) in places {
        known = add(known, row(point, speed));
    }
    for one in found["candidates"].as_array().unwrap() {
        let (point, speed) = (&one["fields"]["location"], &one["fields"]["striker.speed_m_s"]);
        let with = add(known, row(point.as_str().unwrap(), speed.as_f64().unwrap()));
        let ratio = volume(with) / volume(known);
        assert!((one["volume_ratio"].as_f64().unwrap() / ratio - 1.0).abs() < 1e-4, "{one} {ratio}");
    }
}

#[test]
fn long_names_and_single_numbers_keep_the_text_in_order() {
    let folder = tempfile::tempdir().unwrap();
    let mut scene = scene(1e9, 0.05);
    let name = "middle_of_the_long_upper_beam";
    scene["structure"]["points"][name] = scene["structure"]["points"]["middle"].clone();
    fs::write(folder.path().join("scene.json"), scene.to_string()).unwrap();
    fs::write(folder.path().join("data.csv"), format!("location,restitution,restitution_sd\n{name},0.3,0.01\n"))
        .unwrap();
    fs::write(folder.path().join("next.csv"), "location\ntip\n").unwrap();
    let field = format!("structure.points.{name}.shape[0]");
    let arguments = ["identify", "data.csv", "--scene", "scene.json", "--free", &field, "--candidates", "next.csv"];
    let text = stdout(&run(folder.path(), &arguments));
    let [header, row] = [0, 1].map(|k| text.lines().nth(k).unwrap());
    let value = row.find(&field).unwrap() + field.len() + 2;
    assert_eq!(header.find("value"), Some(value), "{text}");
    assert!(!row[value..].starts_with(' '), "{text}");
    for part in [
        "1 value, ",
        "there are as many parameters as measured values",
        "all modes listed, the same",
        "location = tip\n",
    ] {
        assert!(text.contains(part), "{part} in\n{text}");
    }
}

/// Rejected input: exit code 2, nothing written, and the field named.
#[test]
fn bad_input_is_refused_by_name() {
    let good = "location,restitution,restitution_sd\ntip,0.3,0.01\nmiddle,0.3,0.01\n";
    let record = "location,force_file\ntip,force.csv\n";
    let stiffness = "contact.stiffness_n_m1_5";
    for (data, free, said) in [
        (good, "contact.stiffness", "--free contact.stiffness is missing; it must be a field that the scene states"),
        (
            good,
            "contact.law",
            "--free contact.law = \"hertz\" is not allowed; it must be a field of the scene that is a finite number",
        ),
        (good, "contact.stiffness_n_m1_5=2..1", "--free = \"contact.stiffness_n_m1_5=2..1\" is not allowed"),
        (
            good,
            "striker.mass_kg,striker.mass_kg",
            "--free = striker.mass_kg is not allowed; it must be stated only once",
        ),
        (good, "structure.omega_rad_s[9]", "--free structure.omega_rad_s[9] is missing"),
        (good, "gauge.time_constant_s=1e-6..1e-3", "left out, because the table names no force_file"),
        (good, "location", "--free = location is not allowed; it must be a field that the table does not state"),
        (
            record,
            "gauge.time_constant_s",
            "--free gauge.time_constant_s=low..high is missing; it must be an interval with limits greater than 0",
        ),
        ("location\ntip\n", stiffness, "data.csv, a measured quantity is missing"),
        ("location,restitution\n", stiffness, "data.csv, number of rows = 0 is not allowed"),
        ("location,restitution\ntip,\n", stiffness, "data.csv, measured values = 0 is not allowed"),
        (
            "location,restitution\ntip,x\n",
            stiffness,
            "data.csv, line 2, restitution = x is not allowed; it must be a finite number",
        ),
        ("location,restitution\n,0.3\n", stiffness, "data.csv, line 2, location is missing"),
        ("location,restitution\ntap,0.3\ntip,0.3\n", stiffness, "data.csv, line 2, location = \"tap\" is not allowed"),
        (
            "location,restitution,restitution_sd\ntip,0.3,0\n",
            stiffness,
            "data.csv, line 2, restitution_sd = 0.0 is not allowed; it must be a finite number greater than 0",
        ),
        ("location,restitution,restitution_sd\ntip,0.3,\n", stiffness, "data.csv, line 2, restitution_sd is missing"),
        ("location,first_contact_s\ntip,-1\n", stiffness, "data.csv, line 2, first_contact_s = -1.0 is not allowed"),
        (
            "location,restitution,restitution\ntip,1,1\n",
            stiffness,
            "data.csv, column restitution = 2 columns is not allowed",
        ),
        (
            "location,first_contact_s,restitution_sd\ntip,1,1\n",
            stiffness,
            "column restitution_sd = 1 column is not allowed",
        ),
        (
            "location,first_contact_s,restitution,restitution_sd\ntip,1,1,1\n",
            stiffness,
            "column first_contact_s_sd is missing",
        ),
        (
            "location,restitutoin,restitution\ntip,1,1\ntip,1,1\n",
            stiffness,
            "data.csv, line 2, restitutoin = 1.0 is not a known field; it must be one of ",
        ),
        ("location,restituton,first_contact_s\ntip,1,1\ntip,1,1\n", stiffness, "force_file; did you mean restitution?"),
        (
            "location,restituton,restitution_sd\ntip,1,1\n",
            stiffness,
            "column restitution_sd = 1 column is not allowed; it must be beside the column restitution, whose standard \
             deviation it is; is the column restituton misspelt?",
        ),
        ("location,restitution,restituton_sd\ntip,1,1\n", stiffness, "force_n; did you mean restitution?"),
        (good, "contact.stifness_n_m1_5", "as a number; did you mean stiffness_n_m1_5?"),
        (
            "location,striker.mass_kg,restitution\ntip,-1,0.3\ntip,-1,0.3\n",
            stiffness,
            "data.csv, line 2, striker.mass_kg = -1.0 is not allowed",
        ),
        (
            "location,restitution\ntip,0.3\n",
            stiffness,
            "number of measured values = 1 is not allowed; it must be at least 2",
        ),
        (
            "location,force_file\ntip,../force.csv\n",
            stiffness,
            "data.csv, line 2, force_file = \"../force.csv\" is not allowed; it must be the path of a table in the folder of this one",
        ),
        ("location,force_file\ntip,none.csv\n", stiffness, "none.csv"),
        (
            "location,force_file\ntip,bad.csv\n",
            stiffness,
            "data.csv, line 2, bad.csv, line 3, time_s = 0.0 is not allowed; it must be a time after that of the line above",
        ),
        (
            "location,force_file\ntip,short.csv\n",
            stiffness,
            "data.csv, line 2, short.csv, number of samples = 1 is not allowed",
        ),
        (
            "location,force_file\ntip,noise.csv\n",
            stiffness,
            "data.csv, line 2, noise.csv, column force_n_sd = 1 column is not allowed; it must be left out: a force history has the columns \
             time_s and force_n, beside which only those of the history.csv of simulate are allowed (time_s, \
             structure_displacement_m, striker_displacement_m, structure_velocity_m_s, striker_velocity_m_s, compression_m, \
             force_n); its noise is stated in the column force_n_sd beside force_file",
        ),
        (
            good,
            "contact.stiffness_n_m1_5=-1..1",
            "--free contact.stiffness_n_m1_5 = -1.0..1.0 is not allowed; it must be low..high with two values that the field \
             can have, each a number greater than 0",
        ),
        (
            good,
            "contact.stiffness_n_m1_5=0..1e10",
            "--free contact.stiffness_n_m1_5 = 0.0..10000000000.0 is not allowed",
        ),
        (
            good,
            "contact.stiffness_n_m1_5,striker.mass_kg=-1..1",
            "--free striker.mass_kg = -1.0..1.0 is not allowed; it must be low..high with two values that the field can have, \
             each a finite number greater than 0",
        ),
        (
            good,
            "structure.damping_ratios[1]=0..2e6",
            "--free structure.damping_ratios[1] = 0.0..2000000.0 is not allowed; it must be low..high with two values that the \
             field can have, each a number from 0 to 1e6",
        ),
    ] {
        let folder = tempfile::tempdir().unwrap();
        for (name, text) in [
            ("scene.json", scene(1e9, 0.05).to_string().as_str()),
            ("data.csv", data),
            ("force.csv", "time_s,force_n\n0,0\n1,1\n2,1\n3,1\n4,1\n5,1\n6,1\n7,0\n"),
            ("bad.csv", "time_s,force_n\n0,0\n0,1\n"),
            ("short.csv", "time_s,force_n\n0,0\n"),
            ("noise.csv", "time_s,force_n,force_n_sd\n0,0,2\n1,1,2\n2,1,2\n3,1,2\n4,1,2\n5,1,2\n6,1,2\n7,0,2\n"),
        ] {
            fs::write(folder.path().join(name), text).unwrap();
        }
        let before = fs::read_dir(folder.path()).unwrap().count();
        let output =
            run(folder.path(), &["identify", "data.csv", "--scene", "scene.json", "--free", free, "--plot", "p.svg"]);
        let message = String::from_utf8(output.stderr).unwrap();
        assert!(message.contains(said), "{message}\nshould say {said}");
        assert!(
            output.status.code() == Some(2) && output.stdout.is_empty() && !message.contains("panicked"),
            "{message}"
        );
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), before);
    }
}

/// The limits of a search are judged by the scene: those of other laws and structures, and not the interval of a search without
/// stated limits, which may reach further.
#[test]
fn limits_of_a_search_are_those_that_the_scene_allows() {
    let folder = repository().join("datasets");
    let found = |free: &str| {
        let arguments = ["--quiet", "identify", "identification/rubber-ball.csv", "--scene", "scenes/rubber-ball.json"];
        run(&folder, &[&arguments[..], &["--starts", "1", "--free", free]].concat())
    };
    for (free, said) in [
        ("contact.restitution=0.5..1.5", "--free contact.restitution = 0.5..1.5 is not allowed; it must be low..high"),
        ("contact.striker_youngs_modulus_pa=-1e6..1e7", "values that the field can have, each a number greater than 0"),
        ("structure.damping_ratio=-0.1..0.1", "--free structure.damping_ratio = -0.1..0.1 is not allowed"),
        ("structure.segments[0].length_m=0..2", "--free structure.segments[0].length_m = 0.0..2.0 is not allowed"),
    ] {
        let output = found(free);
        let message = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.code() == Some(2) && output.stdout.is_empty() && message.contains(said), "{message}");
    }
    for free in ["contact.restitution=0.5..1", "structure.damping_ratio=0..0.1"] {
        assert!(stdout(&found(free)).contains("chi-square"), "{free}");
    }
}

#[test]
fn bad_options_are_refused_by_name() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scene.json"), scene(1e9, 0.05).to_string()).unwrap();
    fs::write(folder.path().join("data.csv"), "location,restitution\ntip,0.3\nmiddle,0.3\n").unwrap();
    for (name, table) in [
        ("next.csv", "location,restitution\ntip,0.3\n"),
        ("off.csv", "location\ntip\ntap\n"),
        ("unknown.csv", "location,colour\ntip,3\n"),
        ("free.csv", "location,contact.stiffness_n_m1_5\ntip,1e9\n"),
        ("heavy.csv", "striker.mass_kg\n0.05\n-0.05\n"),
    ] {
        fs::write(folder.path().join(name), table).unwrap();
    }
    for (options, said) in [
        (["--level", "1"], "--level = 1.0 is not allowed; it must be a probability from 0.5 to 0.999"),
        (["--starts", "0"], "it must be a whole number from 1 to 1000"),
        (
            ["--candidates", "next.csv"],
            "next.csv, column restitution = 1 column is not allowed; it must be left out of a table of candidates",
        ),
        (["--candidates", "none.csv"], "cannot read none.csv"),
        (["--candidates", "off.csv"], "off.csv, line 3, location = \"tap\" is not allowed; it must be one of"),
        (["--candidates", "unknown.csv"], "unknown.csv, line 2, colour = 3.0 is not a known field"),
        (
            ["--candidates", "free.csv"],
            "column contact.stiffness_n_m1_5 = 1 column is not allowed; it must be left out of a table of candidates",
        ),
        (["--candidates", "heavy.csv"], "heavy.csv, line 3, striker.mass_kg = -0.05 is not allowed"),
    ] {
        let arguments = ["identify", "data.csv", "--scene", "scene.json", "--free", "contact.stiffness_n_m1_5"];
        let output = run(folder.path(), &[&arguments[..], &options].concat());
        let message = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.code() == Some(2) && message.contains(said), "{message}");
    }
}

/// The gallery's rubber ball, whose modulus and restitution at a wall differ from those in the scene, thrown at four locations
/// of the bar at three speeds.
fn rubber_ball(truth: &[(&str, f64)]) -> String {
    let scene = fs::read_to_string(repository().join("datasets/scenes/rubber-ball.json")).unwrap();
    let mut tree: Value = serde_json::from_str(&scene).unwrap();
    truth.iter().for_each(|(field, value)| tree["contact"][*field] = json!(value));
    let mut random = Noise(2019);
    let mut text =
        "location_m,striker.speed_m_s,restitution,restitution_sd,first_contact_s,first_contact_s_sd\n".to_owned();
    for place in [0.3, 0.2, 0.1, 0.03] {
        for speed in [2.0, 5.0, 10.0] {
            tree["location_m"] = json!(place);
            tree["striker"]["speed_m_s"] = json!(speed);
            let found = Scene::from_value(&tree).unwrap().impact().unwrap().solve().unwrap();
            let first = found.sub_impacts[0].end_s - found.sub_impacts[0].start_s;
            let (e, first) = (found.restitution.unwrap() + 0.01 * random.next(), first + 1e-5 * random.next());
            text += &format!("{place:?},{speed:?},{e:.4},0.01,{first:.6},1e-5\n");
        }
    }
    text
}

fn repository() -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

#[test]
fn the_example_of_the_documentation_is_made_here_and_returns_its_true_values() {
    let truth = [("striker_youngs_modulus_pa", 4.2e6), ("restitution", 0.74)];
    let path = repository().join("datasets/identification/rubber-ball.csv");
    let made = rubber_ball(&truth);
    if std::env::var_os("VIBROIMPACT_BLESS").is_some() {
        fs::write(&path, &made).unwrap();
    }
    assert_eq!(fs::read_to_string(&path).unwrap(), made);
    let folder = repository().join("datasets");
    let free = "contact.striker_youngs_modulus_pa,contact.restitution";
    let arguments =
        ["--quiet", "identify", "identification/rubber-ball.csv", "--scene", "scenes/rubber-ball.json", "--free", free];
    let candidates = ["--candidates", "identification/rubber-ball-next.csv"];
    let found: Value =
        serde_json::from_str(&stdout(&run(&folder, &[&arguments[..], &candidates, &["--json"]].concat()))).unwrap();
    for (j, (field, truth)) in truth.iter().enumerate() {
        let [low, high] = [0, 1].map(|k| found["parameters"][j]["profile_interval"][k].as_f64().unwrap());
        assert!(low < *truth && *truth < high && high / low < 1.1, "{field}: {low} to {high}");
    }
    assert_eq!(found["lack_of_fit"][0]["noticed"], false);
    let text = stdout(&run(&folder, &[&arguments[..], &candidates].concat()));
    for part in ["95 % interval", "probability 0.97", "next experiment", "starting points lead to"] {
        assert!(text.contains(part), "{part} in\n{text}");
    }
}
