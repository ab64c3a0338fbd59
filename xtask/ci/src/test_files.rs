//! A crate whose tests are one program names each of their files in `tests/main.rs`. A file that is not named is never compiled.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

/// Files and folders of `tests` that hold tests, without their endings, apart from `main.rs` itself.
fn present(tests: &Path) -> BTreeSet<String> {
    let entries = fs::read_dir(tests).unwrap().map(|entry| entry.unwrap().path());
    let holds_tests = |path: &std::path::PathBuf| {
        path.extension().is_some_and(|ending| ending == "rs")
            || path.join("mod.rs").is_file()
            || path.join("main.rs").is_file()
    };
    let name = |path: std::path::PathBuf| path.file_stem().unwrap().to_str().unwrap().to_owned();
    entries.filter(holds_tests).map(name).filter(|name| name != "main").collect()
}

/// The modules of `main.rs`, and the tests that are programs of their own.
fn named(manifest: &str, main: &str) -> BTreeSet<String> {
    let modules = main.lines().filter_map(|line| line.strip_prefix("mod ")?.strip_suffix(';'));
    let programs =
        manifest.split("[[test]]").skip(1).filter_map(|entry| entry.split("name = \"").nth(1)?.split('"').next());
    modules.chain(programs).map(str::to_owned).filter(|name| name != "tests").collect()
}

#[test]
fn every_file_of_tests_is_compiled() {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../crates");
    let mut checked = 0;
    for folder in fs::read_dir(crates).unwrap().map(|entry| entry.unwrap().path()) {
        let manifest = fs::read_to_string(folder.join("Cargo.toml")).unwrap();
        if !manifest.contains("autotests = false") {
            continue;
        }
        let main = fs::read_to_string(folder.join("tests/main.rs")).unwrap();
        assert_eq!(named(&manifest, &main), present(&folder.join("tests")), "{}", folder.display());
        checked += 1;
    }
    assert!(checked >= 6, "{checked}");
}

#[test]
fn a_file_that_is_not_named_is_found() {
    let folder = tempfile::tempdir().unwrap();
    for file in ["main.rs", "known.rs", "alone.rs", "forgotten.rs", "data.csv"] {
        fs::write(folder.path().join(file), "").unwrap();
    }
    let named = named("[[test]]\nname = \"tests\"\n\n[[test]]\nname = \"alone\"\n", "//! Tests.\n\nmod known;\n");
    let missing: Vec<_> = present(folder.path()).difference(&named).cloned().collect();
    assert_eq!(missing, ["forgotten"]);
}
