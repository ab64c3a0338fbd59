//! The first steps of a new user: `demo`, `init`, fields set on the command line, scenes from the standard input, materials by
//! name, manual pages, and the amount of output.

use std::fs;
use std::io::Write;
use std::path::Path;
use std::process::{Command, Output, Stdio};

use crate::program::{run, stdout};
use serde_json::Value;
use vibroimpact::Scene;
use vibroimpact::scene::{MATERIALS, schema};
use vibroimpact::simulate::Simulation;

/// Runs the program with a text on its standard input.
fn fed(folder: &Path, arguments: &[&str], text: &str) -> Output {
    let mut program = Command::new(env!("CARGO_BIN_EXE_vibroimpact"))
        .current_dir(folder)
        .args(arguments)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    // A program that rejects its arguments does not read its input.
    let _ = program.stdin.take().unwrap().write_all(text.as_bytes());
    program.wait_with_output().unwrap()
}

fn refused(output: &Output) -> String {
    let message = String::from_utf8(output.stderr.clone()).unwrap();
    assert_eq!(output.status.code(), Some(2), "{message}");
    assert!(output.stdout.is_empty(), "{message}");
    message
}

fn json(output: &Output) -> Value {
    serde_json::from_str(&stdout(output)).unwrap()
}

/// The text of the first scene of a kind.
fn first_scene(folder: &Path, kind: &str) -> String {
    stdout(&run(folder, &["init", "--kind", kind, "-"]))
}

#[test]
fn the_demo_needs_no_file_and_writes_none_unasked() {
    let folder = tempfile::tempdir().unwrap();
    let text = stdout(&run(folder.path(), &["demo"]));
    let signature = concat!("\n  the built-in scene, by vibroimpact ", env!("CARGO_PKG_VERSION"), " in ");
    for part in ["rebound", "restitution", "sub-impacts           5", signature] {
        assert!(text.contains(part), "{part} in\n{text}");
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
    // Hertz's law loses nothing, so the work of the computed force is an error.
    let result: Value = serde_json::from_str(&stdout(&run(folder.path(), &["demo", "--json"]))).unwrap();
    let [work_j, rounding_j] = ["contact_j", "residual_j"].map(|key| result["energy"][key].as_f64().unwrap());
    assert!(work_j != 0.0 && rounding_j.abs() < 1e-3 * work_j.abs(), "{work_j} {rounding_j}");
    let lines = format!("    contact                      0 J\n    unaccounted{:>21}\n", format!("{work_j:.0e} J"));
    assert!(text.contains(&lines), "{lines}\nin\n{text}");
    // a law with losses states them, however small
    let lossy = ["demo", "--set", "contact.law=hunt-crossley", "--set", "contact.restitution=0.9999"];
    assert!(!stdout(&run(folder.path(), &lossy)).contains("contact                      0 J"));

    let text = stdout(&run(folder.path(), &["demo", "--plot", "demo.svg", "--report", "demo.html"]));
    assert!(text.contains("wrote demo.svg") && text.contains("wrote demo.html"), "{text}");
    assert!(fs::read_to_string(folder.path().join("demo.svg")).unwrap().starts_with("<svg"));
    // The same impact by the file that init writes.
    stdout(&run(folder.path(), &["init"]));
    let [demo, file] = [["demo", "--json"].as_slice(), &["simulate", "impact.toml", "--json"]]
        .map(|arguments| stdout(&run(folder.path(), arguments)));
    assert_eq!(demo, file);
}

#[test]
fn init_writes_scenes_that_can_be_solved() {
    let folder = tempfile::tempdir().unwrap();
    let validator = jsonschema::draft202012::options().build(&schema::of_scenes()).unwrap();
    for kind in ["beam", "cantilever", "plate", "bodies"] {
        let file = format!("{kind}.toml");
        let told = stdout(&run(folder.path(), &["init", "--kind", kind, &file]));
        assert!(told.contains(&format!("wrote {file}")) && told.contains(&format!("simulate {file}")), "{told}");
        let text = fs::read_to_string(folder.path().join(&file)).unwrap();
        assert!(text.lines().filter(|line| line.starts_with('#')).count() > 10 && text.contains(&file), "{text}");
        let tree = serde_json::to_value(text.parse::<toml::Table>().unwrap()).unwrap();
        assert!(
            validator.is_valid(&tree),
            "{kind}: {:?}",
            validator.iter_errors(&tree).map(|e| e.to_string()).collect::<Vec<_>>()
        );
        let result = json(&run(folder.path(), &["simulate", &file, "--json"]));
        assert!(result["outcome"] == if kind == "bodies" { "end" } else { "rebound" }, "{kind}: {}", result["outcome"]);
    }
    let message = refused(&run(folder.path(), &["init", "beam.toml"]));
    assert!(message.contains("FILE = beam.toml is not allowed; it must be the name of a new file"), "{message}");
    stdout(&run(folder.path(), &["init", "beam.toml", "--kind", "plate", "--force"]));
    assert!(fs::read_to_string(folder.path().join("beam.toml")).unwrap().contains("kind = \"plate\""));
    assert!(refused(&run(folder.path(), &["init", "impact.json"])).contains("a file name that ends in .toml"));
}

#[test]
fn a_scene_may_come_from_the_standard_input() {
    let folder = tempfile::tempdir().unwrap();
    let toml = first_scene(folder.path(), "beam");
    fs::write(folder.path().join("scene.toml"), &toml).unwrap();
    let as_json = Scene::from_toml(&toml).unwrap().to_json();
    for arguments in [&["simulate"][..], &["plan"], &["modes", "--count", "3"], &["emoc"]] {
        let with = |scene| [arguments, &["--json", scene][..]].concat();
        let from_file = stdout(&run(folder.path(), &with("scene.toml")));
        assert_eq!(stdout(&fed(folder.path(), &with("-"), &toml)), from_file, "{arguments:?}");
        assert_eq!(stdout(&fed(folder.path(), &with("-"), &as_json)), from_file, "{arguments:?}");
    }
    fs::write(folder.path().join("notes.md"), "# Notes\n").unwrap();
    assert!(refused(&run(folder.path(), &["simulate", "notes.md"])).contains("(in notes.md)"));
    for (text, part) in [
        ("", "ends too early"),
        ("{", "ends too early"),
        ("structure", "line 1"),
        ("\u{feff}{}", "structure is missing"),
        // JSON, though not a scene
        ("[]", "the scene = [] is not allowed; it must be "),
        ("[1, 2", "the text ends too early"),
        (" [1]\n", "the scene = [1] is not allowed; it must be "),
        ("3", "the scene = 3 is not allowed; it must be "),
        // tables of TOML begin in the same way
        ("[structure]\nkind = \"beam\"\n", "striker is missing"),
        ("[structure] # the beam\nkind = \"beam\"\n", "striker is missing"),
    ] {
        let message = refused(&fed(folder.path(), &["simulate", "-"], text));
        assert!(message.contains(part), "{text:?}: {message}");
    }
}

#[test]
fn fields_are_set_on_the_command_line() {
    let folder = tempfile::tempdir().unwrap();
    let toml = first_scene(folder.path(), "beam");
    fs::write(folder.path().join("scene.toml"), toml.replace("speed_m_s = 1", "speed_m_s = 2")).unwrap();
    let in_file = stdout(&run(folder.path(), &["simulate", "scene.toml", "--json", "--set", "modes=30"]));
    let set = ["demo", "--json", "--set", "striker.speed_m_s=2", "--set", " modes = 30 "];
    assert_eq!(stdout(&run(folder.path(), &set)), in_file);
    let printed = stdout(&run(folder.path(), &["simulate", "scene.toml", "--set", "modes=30"]));
    assert!(printed.contains("\n  scene.toml with modes=30, by vibroimpact "), "{printed}");
    // A text, a list, a field of an object that does not exist yet, and an omitted one.
    let set = [
        "demo",
        "--json",
        "--set",
        "structure.ends=[\"clamped\",\"free\"]",
        "--set",
        "start.gap_m=0.001",
        "--set",
        "modes=9",
        "--set",
        "structure.segments[0].material=glass",
        "--set",
        "contact.striker_material=rubber",
        "--set",
        "tolerance=null",
    ];
    let scene = &json(&run(folder.path(), &set))["scene"];
    assert_eq!(scene["structure"]["ends"][0], "clamped");
    assert_eq!(scene["start"]["gap_m"], 0.001);
    assert_eq!(scene["structure"]["segments"][0]["youngs_modulus_pa"], 7e10);
    assert!(scene.get("tolerance").is_none());
    for (assignment, part) in [
        ("striker", "--set = striker is not allowed; it must be FIELD=VALUE"),
        ("=1", "FIELD=VALUE"),
        ("a..b=1", "FIELD=VALUE"),
        ("strkier.speed_m_s=2", "did you mean striker?"),
        ("striker.sped_m_s=2", "striker.sped_m_s = 2 is not a known field"),
        ("structure.segments[0].materail=steel", "did you mean material?"),
        ("structure.segments[7].length_m=2", "counted from 0"),
        ("striker.speed_m_s=fast", "striker.speed_m_s = \"fast\" is not allowed; it must be a finite number"),
        ("striker.speed_m_s=NaN", "striker.speed_m_s = \"NaN\" is not allowed"),
        ("structure.ends=[1", "is complete JSON"),
        ("location_m=3", "location_m = 3 is not allowed"),
        ("striker.radius_m=-1", "striker.radius_m = -1.0 is not allowed"),
    ] {
        let message = refused(&run(folder.path(), &["demo", "--out", "there", "--set", assignment]));
        assert!(message.contains(part), "{assignment}: {message}");
        assert!(!folder.path().join("there").exists());
    }
    // Every command that reads a scene accepts it.
    for arguments in [&["plan"][..], &["compare"], &["modes", "--count", "2"], &["emoc"]] {
        let set = [arguments, &["scene.toml", "--set", "location_m=9"]].concat();
        assert!(refused(&run(folder.path(), &set)).contains("location_m = 9"), "{arguments:?}");
    }
}

/// The ball moves according to its history, and an impact that cannot be animated is rejected.
#[test]
fn an_impact_is_animated() {
    let folder = tempfile::tempdir().unwrap();
    let told = stdout(&run(folder.path(), &["demo", "--animate", "moving.svg"]));
    assert!(told.contains("wrote moving.svg"), "{told}");
    let svg = fs::read_to_string(folder.path().join("moving.svg")).unwrap();
    assert!(
        svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>") && svg.len() < 250_000,
        "{} bytes",
        svg.len()
    );
    let (beam, ball) = (animated(&svg, "d"), animated(&svg, "cy"));
    assert_eq!((beam.len(), ball.len()), (241, 241));
    // The largest force is that of the result, although it lasts for less than one frame.
    assert!(told.contains("2.133 kN") && svg.contains(">2.133 kN<"), "{told}");
    // Upwards means smaller numbers: the ball first moves down with the beam, and leaves upwards.
    let heights: Vec<f64> = ball.iter().map(|y| y.parse().unwrap()).collect();
    assert!(heights[10] > heights[0] && heights[240] < heights[230]);
    let bodies = first_scene(folder.path(), "bodies");
    let plate = first_scene(folder.path(), "plate");
    for text in [bodies, plate] {
        let message = refused(&fed(folder.path(), &["simulate", "-", "--animate", "other.svg"], &text));
        assert!(
            message.contains("--animate = other.svg is not allowed; it must be left out for this scene"),
            "{message}"
        );
    }
    assert!(refused(&run(folder.path(), &["demo", "--animate", "a.gif"])).contains("ends in .svg"));
    assert!(refused(&run(folder.path(), &["demo", "--animate", "moving.svg"])).contains("this file exists"));
}

/// In a short time the ball pushes the beam in by much less than it moves, and in a long one no frame shows a contact.
#[test]
fn an_animation_stays_in_its_picture_however_long_it_is() {
    let folder = tempfile::tempdir().unwrap();
    for until_s in ["1e-30", "1e-12", "1e-6", "1e-4", "0.02", "1e12"] {
        stdout(&run(folder.path(), &["demo", "--animate", "a.svg", "--until", until_s, "--force"]));
        let svg = fs::read_to_string(folder.path().join("a.svg")).unwrap();
        let (beam, ball) = (animated(&svg, "d"), animated(&svg, "cy"));
        let points = beam.iter().flat_map(|line| line.split(['M', 'L', ',']).skip(1));
        let numbers: Vec<f64> = points.map(|number| number.parse().unwrap()).collect();
        // the line of the beam at rest is at 160, and the axis of the force begins at 265
        assert!(numbers.chunks(2).all(|point| (85.0..=235.0).contains(&point[1])), "{until_s}");
        // a ball that leaves upwards is out of sight just above the picture
        assert!(ball.iter().all(|y| (-44.0..=240.0).contains(&y.parse::<f64>().unwrap())), "{until_s}: {ball:?}");
    }
}

/// The values of an animated attribute, frame by frame.
fn animated(svg: &str, attribute: &str) -> Vec<String> {
    let part = svg.split(&format!("attributeName=\"{attribute}\"")).nth(1).unwrap();
    part.split("values=\"").nth(1).unwrap().split('"').next().unwrap().split(';').map(str::to_owned).collect()
}

/// Compares a figure of the book with the one that the program draws.
fn assert_drawn(arguments: &[&str], figure: &str) {
    let folder = tempfile::tempdir().unwrap();
    stdout(&run(folder.path(), &[arguments, &["--plot", "drawn.svg"]].concat()));
    let drawn = fs::read_to_string(folder.path().join("drawn.svg")).unwrap();
    let checked_in = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/figures").join(figure);
    if std::env::var_os("VIBROIMPACT_BLESS").is_some() {
        fs::write(&checked_in, &drawn).unwrap();
    }
    let shown = fs::read_to_string(&checked_in).unwrap_or_default();
    assert!(shown == drawn, "docs/figures/{figure} is not current; VIBROIMPACT_BLESS=1 writes it");
}

/// The force pulse of the piano hammer in the book is drawn by the program.
#[test]
fn the_book_shows_the_hammer() {
    let scene = concat!(env!("CARGO_MANIFEST_DIR"), "/../../datasets/scenes/piano-hammer.json");
    assert_drawn(&["simulate", scene], "piano-hammer.svg");
}

/// The picture of the README is drawn by the program.
#[test]
fn the_readme_shows_the_demo() {
    assert_drawn(&["demo"], "first-impact.svg");
    let readme = fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../../README.md")).unwrap();
    assert!(readme.contains("](docs/figures/first-impact.svg)"));
}

/// The page with the library in it, except for the library itself, which `web/check.sh` tests in a browser.
#[test]
fn the_interactive_page_is_current_and_small() {
    let read = |name: &str| fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(name)).unwrap();
    let (source, page) = (read("web/page.html"), read("docs/play.html"));
    let (before, after) = source.split_once("@MODULE@").unwrap();
    assert!(page.starts_with(before) && page.ends_with(after), "docs/play.html is not current; web/build.sh writes it");
    assert!(page.len() < 1_500_000, "{} bytes", page.len());
    // the packed library between the two may contain any four letters
    assert!(!before.contains("http") && !after.contains("http"), "the page refers to an address");
}

/// A material is equivalent to its numbers in the standards.
#[test]
fn a_material_is_equivalent_to_its_numbers() {
    let folder = tempfile::tempdir().unwrap();
    let by_name = Scene::from_toml(&first_scene(folder.path(), "cantilever")).unwrap();
    let numbers = |text: &str, number: &str| text.replace("material = \"aluminium\"", number);
    let text = first_scene(folder.path(), "cantilever")
        .replace("material = \"rubber\"\nradius", "density_kg_m3 = 1100\nradius")
        .replace("striker_material = \"rubber\"", "striker_youngs_modulus_pa = 2.2e6\nstriker_poissons_ratio = 0.4996");
    let (structure, contact) = text.split_once("[contact]").unwrap();
    let by_number = numbers(structure, "youngs_modulus_pa = 7e10\npoissons_ratio = 0.3\ndensity_kg_m3 = 2700")
        + "[contact]"
        + &numbers(contact, "youngs_modulus_pa = 7e10\npoissons_ratio = 0.3");
    assert!(!by_number.contains("material ="), "{by_number}");
    assert_eq!(Scene::from_toml(&by_number).unwrap(), by_name);
    // The schema contains the fields in which a name is allowed.
    let validator = jsonschema::draft202012::options().build(&schema::of_scenes()).unwrap();
    let named: Value =
        serde_json::to_value(first_scene(folder.path(), "beam").parse::<toml::Table>().unwrap()).unwrap();
    for (place, value, valid) in [
        ("/structure/segments/0/material", Value::from("wood"), true),
        ("/structure/segments/0/material", Value::from("gold"), false),
        ("/structure/segments/0/material", Value::Null, false),
        ("/structure/segments/0/density_kg_m3", Value::from(7800), true),
        ("/structure/segments/0/flexural_rigidity_n_m2", Value::from(300), false),
        ("/striker/mass_kg", Value::from(1), false),
        ("/striker/density_kg_m3", Value::from(7800), true),
        ("/contact/striker_material", Value::from("glass"), true),
        ("/contact/striker_material", Value::from("gold"), false),
    ] {
        let mut scene = named.clone();
        let (holder, field) = place.rsplit_once('/').unwrap();
        scene.pointer_mut(holder).unwrap()[field] = value;
        assert_eq!(validator.is_valid(&scene), valid, "{place}: {scene}");
        let read = Scene::from_value(&scene).map_err(|fault| fault.to_string());
        let solved = read.and_then(|scene| scene.plan().map(|_| ()).map_err(|fault| fault.to_string()));
        assert_eq!(solved.is_ok(), valid, "{place}: {solved:?}");
    }
    // The book lists the materials of the program.
    let book = fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/how-to/materials.md")).unwrap();
    for material in MATERIALS {
        let row = format!(
            "| `{}` | {:e} | {} | {} |",
            material.name, material.youngs_modulus_pa, material.poissons_ratio, material.density_kg_m3
        );
        assert!(book.contains(&row), "{row}");
    }
}

#[test]
fn every_command_has_a_manual_page() {
    let folder = tempfile::tempdir().unwrap();
    let told = stdout(&run(folder.path(), &["manual", "--out", "man"]));
    assert!(told.contains("man -l man/vibroimpact-simulate.1"), "{told}");
    let help = stdout(&run(folder.path(), &["--help"]));
    let commands = help.split("Commands:\n").nth(1).unwrap().split("\n\n").next().unwrap();
    for command in commands.lines().filter_map(|line| line.split_whitespace().next()).filter(|name| *name != "help") {
        let page = fs::read_to_string(folder.path().join(format!("man/vibroimpact-{command}.1"))).unwrap();
        assert!(page.contains(&format!(".TH vibroimpact-{command} 1")), "{command}: {page}");
        assert_eq!(stdout(&run(folder.path(), &["manual", command])), page);
        // commands stay on their lines
        let example = format!(".SH EXAMPLES\n.nf\n  vibroimpact {}", command.replace('-', "\\-"));
        assert!(page.contains(&example), "{page}");
    }
    // Every page that a page refers to exists.
    let mut referred = Vec::new();
    for name in ["vibroimpact", "vibroimpact-infinite-beam"] {
        let page = fs::read_to_string(folder.path().join(format!("man/{name}.1"))).unwrap().replace('\\', "");
        referred.extend(page.lines().filter_map(|line| line.strip_suffix("(1)").map(str::to_owned)));
    }
    for name in ["vibroimpact-simulate", "vibroimpact-infinite-beam-turning-points"] {
        assert!(referred.iter().any(|page| page == name), "{name} in {referred:?}");
    }
    assert!(referred.iter().all(|name| folder.path().join(format!("man/{name}.1")).exists()), "{referred:?}");
    assert!(refused(&run(folder.path(), &["manual", "--out", "man"])).contains("this file exists"));
    let page = "man/vibroimpact.1";
    assert!(
        refused(&run(folder.path(), &["manual", "--out", page])).contains("--out = man/vibroimpact.1 is not allowed")
    );
    assert!(
        refused(&run(folder.path(), &["manual", "simulat"]))
            .contains("COMMAND = simulat is not allowed; it must be one of")
    );
}

#[test]
fn output_is_quiet_or_verbose_as_requested() {
    let folder = tempfile::tempdir().unwrap();
    let told = stdout(&run(folder.path(), &["demo", "--out", "run"]));
    assert!(told.contains("look at run/impact.svg first"), "{told}");
    let told = stdout(&run(folder.path(), &["demo", "--quiet", "--out", "run", "--force"]));
    assert!(told.contains("restitution") && !told.contains("wrote"), "{told}");
    let output = run(folder.path(), &["demo", "--json", "--verbose", "--set", "modes=10"]);
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(said.contains("set modes=10") && said.contains("simulate: computed in"), "{said}");
    assert!(serde_json::from_slice::<Value>(&output.stdout).is_ok());
    assert!(refused(&run(folder.path(), &["demo", "--quiet", "--verbose"])).contains("cannot be used with"));
}

/// The sum of the modes at the location of impact, compared with the motion that the solver records there.
#[test]
fn the_deflection_agrees_at_the_location_of_impact() {
    let folder = tempfile::tempdir().unwrap();
    for kind in ["beam", "cantilever"] {
        let scene = Scene::from_toml(&first_scene(folder.path(), kind)).unwrap();
        let found = scene.simulate().unwrap();
        let scene = found.scene(&scene);
        let Simulation::Modal(resolved) = &found else { panic!("a beam has modes") };
        let until_s = resolved.until_s(None);
        // 0.3 of 1 m and 0.25 of 0.3 m are locations of the grid.
        let deflection = resolved.deflection(&scene, until_s, [60, 50]).unwrap().unwrap();
        let place = if kind == "beam" { 18 } else { 50 };
        let history = &resolved.history;
        let (modes, kept) = (&resolved.impact.structure.modes, resolved.impact.kept_modes());
        let largest = deflection.structure_m.iter().map(|row| row[place].abs()).fold(0.0, f64::max);
        for (i, &time_s) in deflection.time_s.iter().enumerate() {
            let amplitudes = history.amplitudes(time_s);
            let remainder: f64 = modes[kept..].iter().zip(&amplitudes[kept..]).map(|(mode, q)| mode.shape * q).sum();
            let there = history.at(time_s).structure_displacement_m;
            let sum = deflection.structure_m[i][place] + remainder;
            assert!((sum - there).abs() < 1e-9 * largest, "{kind} at {time_s} s: {sum} and {there}");
            assert_eq!(deflection.striker_m[i], history.at(time_s).striker_surface_m());
        }
        // A support does not move.
        assert!(deflection.structure_m.iter().all(|row| row[0].abs() < 1e-9 * largest));
    }
}
