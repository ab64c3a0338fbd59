//! Page, Python package and fuzz targets are workspaces of their own, whose lock files must follow the dependencies of the crates.
//! Otherwise their builds, which are `--locked`, fail.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use toml::{Table, Value};

/// The workspaces beside the main one.
const WORKSPACES: [&str; 3] = ["fuzz", "python", "web"];

/// The dependencies of a crate by its manifest: those that are always needed, and all.
fn wanted(manifest: &Table) -> [BTreeSet<String>; 2] {
    let is_optional = |entry: &Value| entry.get("optional").and_then(Value::as_bool) == Some(true);
    [true, false].map(|needed| {
        let all = manifest.get("dependencies").and_then(Value::as_table).into_iter().flatten();
        all.filter(|(_, entry)| !(needed && is_optional(entry))).map(|(name, _)| name.clone()).collect()
    })
}

/// The dependencies of a crate by a lock file, if it is in there.
fn locked(lock: &Table, name: &str) -> Option<BTreeSet<String>> {
    let packages = lock.get("package")?.as_array()?;
    let package = packages.iter().find(|package| package.get("name").and_then(Value::as_str) == Some(name))?;
    let dependencies = package.get("dependencies").and_then(Value::as_array).into_iter().flatten();
    // a name may be followed by a version
    Some(dependencies.filter_map(|entry| Some(entry.as_str()?.split(' ').next()?.to_owned())).collect())
}

/// What a lock file lacks, and what it has in excess.
fn differences(manifest: &Table, lock: &Table, name: &str) -> Vec<String> {
    let Some(locked) = locked(lock, name) else { return Vec::new() };
    let [needed, all] = wanted(manifest);
    needed.difference(&locked).chain(locked.difference(&all)).cloned().collect()
}

#[test]
fn every_lock_file_follows_the_crates() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let read = |path: &str| fs::read_to_string(root.join(path)).unwrap().parse::<Table>().unwrap();
    for workspace in WORKSPACES {
        let lock = read(&format!("{workspace}/Cargo.lock"));
        let mut found = 0;
        for folder in fs::read_dir(root.join("crates")).unwrap() {
            let name = folder.unwrap().file_name().into_string().unwrap();
            let differences = differences(&read(&format!("crates/{name}/Cargo.toml")), &lock, &name);
            assert!(
                differences.is_empty(),
                "{workspace}/Cargo.lock, {name}: {differences:?}; run cargo metadata there"
            );
            found += usize::from(locked(&lock, &name).is_some());
        }
        assert!(found >= 3, "{workspace}: {found} crates");
    }
}

#[test]
fn a_lock_file_that_is_behind_is_found() {
    let manifest =
        "[dependencies]\nlibm = \"0.2\"\nserde = { version = \"1\" }\npng = { version = \"1\", optional = true }";
    let lock = "[[package]]\nname = \"ours\"\ndependencies = [\n \"serde 1.0\",\n \"gone\",\n]";
    let differences = differences(&manifest.parse().unwrap(), &lock.parse().unwrap(), "ours");
    assert_eq!(differences, ["libm", "gone"]);
}
