//! All checks share the third parties that they compile. A package is compiled once more where it has other features, so that each
//! selection of packages turns on those that the tests of the whole workspace do.

use std::collections::BTreeSet;
use std::path::Path;
use std::process::Command;

/// The third parties with their features that `cargo tree` lists with these arguments.
fn compiled(arguments: &[&str]) -> BTreeSet<String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).unwrap();
    let mut cargo = Command::new(env!("CARGO"));
    cargo.args(["tree", "--locked", "--prefix", "none", "--no-dedupe", "--format", "{p} with {f}"]).args(arguments);
    let listed = cargo.current_dir(root).output().unwrap();
    assert!(listed.status.success(), "{}", String::from_utf8_lossy(&listed.stderr));
    let text = String::from_utf8(listed.stdout).unwrap();
    // the name of a member of the workspace is followed by its folder
    let is_member = |line: &str| line.contains(root.to_str().unwrap());
    text.lines().filter(|line| !line.is_empty() && !is_member(line)).map(str::to_owned).collect()
}

#[test]
fn every_check_turns_on_the_same_features() {
    let tests = compiled(&["--workspace", "--edges", "normal,build,dev"]);
    let others = [
        &["--workspace", "--edges", "normal,build"][..],
        &["--package", "vibroimpact", "--package", "third-parties", "--no-default-features", "--edges", "normal,build"],
    ];
    for selection in others {
        let found = compiled(selection);
        assert!(found.len() > 100, "{selection:?}: {}", found.len());
        let again: Vec<&String> = found.difference(&tests).collect();
        assert!(
            again.is_empty(),
            "{selection:?} compiles once more {again:?}; `cargo tree --workspace --edges all,features --invert NAME` shows what \
             turns on the missing feature: make it a dependency of xtask/third-parties"
        );
    }
    // without them there is more than one set of features
    let alone = compiled(&["--package", "vibroimpact", "--no-default-features", "--edges", "normal,build"]);
    assert!(alone.difference(&tests).next().is_some());
}
