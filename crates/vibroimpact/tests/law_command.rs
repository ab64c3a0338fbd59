//! The command `law`, as a user meets it.

use crate::program::{run, stdout};
use serde_json::Value;
use vibroimpact::contact_models::{HuntCrossley, LankaraniNikravesh, Law};

const WANTED: [&str; 7] = ["law", "--restitution", "0.5", "--mass-kg", "0.2", "--speed-m-s", "1.5"];

fn printed(more: &[&str]) -> String {
    let folder = tempfile::tempdir().unwrap();
    stdout(&run(folder.path(), &[&WANTED, more].concat()))
}

fn answer(more: &[&str]) -> Value {
    serde_json::from_str(&printed(&[more, &["--json"]].concat())).unwrap()
}

/// Runs a command that must reject its input, and returns the message.
fn refusal(arguments: &[&str]) -> String {
    let folder = tempfile::tempdir().unwrap();
    let output = run(folder.path(), arguments);
    let message = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {message}");
    assert!(output.stdout.is_empty() && !message.contains("panicked"), "{message}");
    message
}

#[test]
fn parameters_printed_are_those_of_the_law() {
    let answer = answer(&[]);
    let laws = answer["laws"].as_array().unwrap();
    let number = |law: usize, name: &str| laws[law]["parameters"][name].as_f64().unwrap();
    assert_eq!(answer["compression_m"], 1e-3);
    // MuJoCo and spring and dashpot are the same contact.
    let (stiffness, damping) = (number(1, "stiffness_n_m"), number(1, "damping_n_s_m"));
    let direct = laws[0]["parameters"]["solref_direct"].as_array().unwrap();
    assert!((-direct[0].as_f64().unwrap() * 0.2 / stiffness - 1.0).abs() < 1e-14);
    assert!((-direct[1].as_f64().unwrap() * 0.2 / damping - 1.0).abs() < 1e-14);
    let law = HuntCrossley::new(number(2, "stiffness_n_m1_5"), 1.5, number(2, "damping_s_m")).unwrap();
    assert!((Law::from(law).wall_restitution(0.2, 1.5).unwrap() - 0.5).abs() < 1e-14);
    // Restitutions of the papers' formulas, as in the tables in the documentation of the laws.
    let papers: Vec<f64> = laws.iter().map(|law| law["restitution_by_the_paper"].as_f64().unwrap()).collect();
    for (found, known) in papers.iter().zip([0.550, 0.550, 0.663, 0.470, 0.725]) {
        assert!((found - known).abs() < 5.1e-4, "{papers:?}");
    }
    // Lankarani and Nikravesh's law does not reach one half.
    assert!(laws[4]["parameters"].is_null() && laws[4]["restitution"].is_null());
    assert!(printed(&[]).contains("none: the law cannot have this restitution"));
}

/// The time constant for a short step, and the damping ratio for a restitution near one.
#[test]
fn small_parameters_are_printed_with_all_their_digits() {
    for more in [&["--step-s", "1e-7"][..], &["--restitution", "0.9999"]] {
        let arguments: Vec<&str> =
            if more[0] == "--restitution" { [&["law"], more, &WANTED[3..]].concat() } else { [&WANTED, more].concat() };
        let folder = tempfile::tempdir().unwrap();
        let text = stdout(&run(folder.path(), &[&arguments[..], &["--law", "mujoco"]].concat()));
        let json = stdout(&run(folder.path(), &[&arguments[..], &["--law", "mujoco", "--json"]].concat()));
        let exact = serde_json::from_str::<Value>(&json).unwrap()["laws"][0]["parameters"]["solref"].clone();
        let printed = text.split('"').nth(1).unwrap().split(' ').map(|number| number.parse::<f64>().unwrap());
        for (printed, exact) in printed.zip(exact.as_array().unwrap()) {
            assert!((printed / exact.as_f64().unwrap() - 1.0).abs() < 1e-4, "{text}");
        }
    }
}

#[test]
fn a_step_and_parameters_that_make_up_for_it() {
    let answer = answer(&["--step-s", "0.001"]);
    assert_eq!(answer["compression_m"], 6.0 * 1.5 * 0.001);
    for law in &answer["laws"].as_array().unwrap()[..4] {
        let range = |of: &str| ["lowest", "mean", "highest"].map(|name| law[of][name].as_f64().unwrap());
        let [lowest, mean, highest] = range("at_the_step");
        assert!(lowest < mean && mean < highest && (mean - 0.5).abs() < 0.1, "{law}");
        assert!((range("for_the_step")[1] - 0.5).abs() < 1e-9, "{law}");
    }
    assert!(printed(&["--step-s", "0.001"]).contains("steps in contact"));
    // With a hundredth of the restitution a contact would last a hundred times as many steps, but it need not be computed.
    let short = printed(&["--step-s", "1e-6", "--compression-m", "1e-3", "--law", "hunt-crossley"]);
    assert!(short.contains("gives 0.5000 on average") && !short.contains("none"), "{short}");
}

#[test]
fn elastic_contacts_have_no_damping() {
    let arguments = ["law", "--restitution", "1", "--mass-kg", "1", "--speed-m-s", "1", "--json"];
    let folder = tempfile::tempdir().unwrap();
    let answer: Value = serde_json::from_str(&stdout(&run(folder.path(), &arguments))).unwrap();
    for law in answer["laws"].as_array().unwrap() {
        assert_eq!(law["restitution"], 1.0, "{law}");
        assert_eq!(law["restitution_by_the_paper"], 1.0, "{law}");
    }
    assert!(answer["laws"][0]["parameters"]["solref"].is_null());
    assert_eq!(answer["laws"][0]["parameters"]["solref_direct"][1], 0.0);
}

/// Two equal bodies are equivalent to one of half the mass.
#[test]
fn the_other_body() {
    let answer = answer(&["--other-mass-kg", "0.2", "--law", "mujoco"]);
    assert_eq!((&answer["reduced_mass_kg"], answer["laws"].as_array().unwrap().len()), (&Value::from(0.1), 1));
}

#[test]
fn errors_name_the_option() {
    for bad in ["0", "-1", "nan", "inf", "1e99", "much"] {
        for (place, option) in [(4, "--mass-kg"), (6, "--speed-m-s")] {
            let mut arguments = WANTED;
            arguments[place] = bad;
            let message = refusal(&arguments);
            assert!(message.contains(&format!("'{bad}' for '{option}")) && message.contains("it must be"), "{message}");
        }
        for option in ["--compression-m", "--step-s", "--other-mass-kg"] {
            let message = refusal(&[&WANTED[..], &[option, bad]].concat());
            assert!(message.contains(&format!("'{bad}' for '{option}")) && message.contains("it must be"), "{message}");
        }
    }
    for bad in ["0", "-1", "1.01", "nan"] {
        let mut arguments = WANTED;
        arguments[2] = bad;
        assert!(refusal(&arguments).to_lowercase().contains(&format!("--restitution = {bad}")));
    }
    // Numbers that are each in range, and parameters or a number of steps that are not.
    for (options, part) in [
        (
            &["--compression-m", "1e-29"][..],
            "--compression-m = 1e-29 is not allowed; it must be such that stiffness_n_m",
        ),
        (&["--step-s", "1e-8", "--compression-m", "1e-3"], "--step-s = 0.00000001 is not allowed; it must be longer"),
    ] {
        let message = refusal(&[&WANTED[..], options].concat());
        assert!(message.contains(part), "{message}");
    }
    let message = refusal(&[&WANTED[..], &["--law", "lankarani-nikravesh"]].concat());
    assert!(message.contains("--restitution = 0.5") && message.contains("0.663"), "{message}");
    assert!(refusal(&["law", "--restitution", "0.5"]).contains("--mass-kg"));
    assert!(refusal(&[&WANTED[..], &["--law", "hertz"]].concat()).contains("possible values"));
}

/// The lowest restitution of the law, as in the table in its documentation.
#[test]
fn the_least_restitution_of_lankarani_and_nikravesh() {
    assert!(LankaraniNikravesh::with_restitution(1.0, LankaraniNikravesh::LEAST_RESTITUTION).is_ok());
    assert!(LankaraniNikravesh::with_restitution(1.0, LankaraniNikravesh::LEAST_RESTITUTION - 1e-4).is_err());
}

/// The page of the book, including its table of approximations.
#[test]
fn the_book_shows_what_is_printed() {
    let page = include_str!("../../../docs/how-to/wanted-restitution.md");
    let folder = tempfile::tempdir().unwrap();
    let law = |options: &str| {
        let options = format!("law --mass-kg 0.1 --speed-m-s 2 {options}");
        stdout(&run(folder.path(), &options.split(' ').collect::<Vec<_>>()))
    };
    for options in ["--restitution 0.5", "--restitution 0.5 --step-s 0.002 --law mujoco"] {
        let printed = law(options);
        let (_, laws) = printed.split_once("\n\n").unwrap();
        assert!(page.contains(&format!("```text\n{laws}```")), "{laws}");
    }
    for wanted in ["0.9", "0.75", "0.5", "0.25"] {
        let answer: Value = serde_json::from_str(&law(&format!("--restitution {wanted} --json"))).unwrap();
        let by = |law: usize| answer["laws"][law]["restitution_by_the_paper"].as_f64().unwrap();
        let row = format!("| {wanted} | {:.3} | {:.3} | {:.3} | {:.3} |", by(0), by(2), by(4), by(3));
        assert!(page.contains(&row), "{row}");
    }
}
