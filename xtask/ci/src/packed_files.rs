//! A file that a crate compiles in has to be part of its package; otherwise the published crate does not build.

use std::fs;
use std::path::{Path, PathBuf};

use toml::{Table, Value};

/// All source files in a folder.
fn sources(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let within = |path: PathBuf| if path.is_dir() { sources(&path) } else { vec![path] };
    entries.flat_map(within).filter(|path| path.extension().is_some_and(|ending| ending == "rs")).collect()
}

/// The files that a source includes as text or bytes, by their names relative to it.
fn included(source: &str) -> Vec<&str> {
    let after = ["include_str!(\"", "include_bytes!(\""].into_iter().flat_map(|call| source.split(call).skip(1));
    after.filter_map(|rest| rest.split('"').next()).collect()
}

/// Whether an entry of `include` in a manifest, such as `/src` or `/LICENSE-*`, comprises a path in the package.
fn comprises(entry: &str, path: &str) -> bool {
    let entry = entry.trim_start_matches('/');
    match entry.strip_suffix('*') {
        Some(start) => path.starts_with(start),
        None => path == entry || path.strip_prefix(entry).is_some_and(|rest| rest.starts_with('/')),
    }
}

#[test]
fn a_package_contains_every_file_that_its_crate_includes() {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../crates").canonicalize().unwrap();
    let mut found = Vec::new();
    for folder in fs::read_dir(crates).unwrap().map(|entry| entry.unwrap().path()) {
        let manifest = fs::read_to_string(folder.join("Cargo.toml")).unwrap().parse::<Table>().unwrap();
        let packed = manifest["package"]["include"].as_array().unwrap();
        let packed: Vec<&str> = packed.iter().filter_map(Value::as_str).collect();
        for source in sources(&folder.join("src")) {
            for name in included(&fs::read_to_string(&source).unwrap()) {
                let path = source.with_file_name(name).canonicalize().unwrap();
                let path = path.strip_prefix(&folder).unwrap().to_str().unwrap().to_owned();
                assert!(packed.iter().any(|entry| comprises(entry, &path)), "{}: {path}", folder.display());
                found.push(path);
            }
        }
    }
    for known in ["README.md", "fonts/DejaVuSans.ttf", "src/commands/scenes/beam.toml"] {
        assert!(found.iter().any(|path| path == known), "{known}: {found:?}");
    }
}

#[test]
fn an_entry_comprises_its_folder_alone() {
    assert!(comprises("/fonts", "fonts/DejaVuSans.ttf") && comprises("/LICENSE-*", "LICENSE-MIT"));
    assert!(comprises("/README.md", "README.md") && !comprises("/src", "source/a.rs"));
}
