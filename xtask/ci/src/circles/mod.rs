//! No crate has a cycle among its files.
//!
//! A file uses another if a path in its code, tests included, leads to an item that the other defines. A re-export is not a
//! use: a path through it leads to the file that defines the item, so that a module may re-export what its children define.
//! Calls of methods, and of macros by name alone, have no path and are not detected.

mod modules;

use std::collections::btree_map::Entry;
use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::fs;
use std::path::{Path, PathBuf};

use modules::Crate;

#[test]
fn no_crate_has_a_cycle_among_its_files() {
    let workspace = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").canonicalize().unwrap();
    let mut roots = Vec::new();
    collect(&workspace, &mut roots);
    assert!(roots.len() > 100, "only {} roots found", roots.len());
    let mut found = BTreeSet::new();
    for root in &roots {
        let read = Crate::read(root);
        for circle in circles(&read.uses()) {
            let name = |file: &usize| read.files[*file].strip_prefix(&workspace).unwrap().display().to_string();
            found.insert(circle.iter().map(name).collect::<Vec<_>>().join(" -> "));
        }
    }
    assert!(found.is_empty(), "{} circles:\n{}", found.len(), found.into_iter().collect::<Vec<_>>().join("\n"));
}

/// The roots of all crates below a folder, as cargo finds them.
fn collect(folder: &Path, roots: &mut Vec<PathBuf>) {
    if folder.join("Cargo.toml").is_file() {
        for root in ["src/lib.rs", "src/main.rs", "build.rs"] {
            roots.extend(Some(folder.join(root)).filter(|path| path.is_file()));
        }
        for part in ["src/bin", "tests", "examples", "benches", "fuzz_targets"] {
            for entry in fs::read_dir(folder.join(part)).into_iter().flatten() {
                let path = entry.unwrap().path();
                let main = path.join("main.rs");
                if main.is_file() {
                    roots.push(main);
                } else if path.extension().is_some_and(|extension| extension == "rs") {
                    roots.push(path);
                }
            }
        }
    }
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy();
        if path.is_dir() && !name.starts_with('.') && !["target", "src", "out"].contains(&name.as_ref()) {
            collect(&path, roots);
        }
    }
}

/// A shortest cycle through each file that is on one, beginning at its first file.
fn circles(uses: &BTreeSet<(usize, usize)>) -> BTreeSet<Vec<usize>> {
    let files: BTreeSet<usize> = uses.iter().map(|(file, _)| *file).collect();
    let circle = |file: &usize| {
        let mut from = BTreeMap::new();
        let mut queue = VecDeque::from([*file]);
        while let Some(reached) = queue.pop_front() {
            for &(_, used) in uses.range((reached, 0)..=(reached, usize::MAX)) {
                if let Entry::Vacant(place) = from.entry(used) {
                    place.insert(reached);
                    queue.push_back(used);
                }
            }
        }
        let mut circle = vec![*from.get(file)?];
        while circle.last() != Some(file) {
            circle.push(from[circle.last().unwrap()]);
        }
        circle.reverse();
        let first = circle.iter().enumerate().min_by_key(|(_, file)| **file)?.0;
        circle.rotate_left(first);
        Some(circle)
    };
    files.iter().filter_map(circle).collect()
}

/// The cycles of a crate with these files in addition to its root.
fn circles_of(root: &str, files: &[(&str, &str)]) -> Vec<String> {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("lib.rs"), root).unwrap();
    for (name, text) in files {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }
    let read = Crate::read(&folder.path().join("lib.rs"));
    let name = |file: &usize| read.files[*file].file_stem().unwrap().to_string_lossy().into_owned();
    circles(&read.uses()).iter().map(|circle| circle.iter().map(name).collect::<Vec<_>>().join(" ")).collect()
}

#[test]
fn cycles_are_found_in_all_kinds_of_paths() {
    let b = ("b.rs", "use super::a::A; pub struct B(A);");
    for (a, is_circle) in [
        ("pub struct A;", false),
        ("pub struct A; fn f() -> crate::b::B { panic!() }", true),
        ("use crate::b; pub struct A; fn f(b: b::B) {}", true),
        ("use crate::b::*; pub struct A; fn f(b: B) {}", true),
        ("pub struct A; fn f() { assert!(size_of::<crate::b::B>() > 0) }", true),
        ("pub struct A; fn f() { use super::b::B as C; drop(C) }", true),
        ("#[derive(Serialize)] #[serde(with = \"crate::b::B\")] pub struct A;", true),
        ("pub struct A; #[cfg(test)] mod tests { use crate::b::B; }", true),
        // Neither a comment nor a crate nor a visibility.
        ("/// See [`B`](crate::b::B).\npub struct A; use b::C; pub(in crate) struct D;", false),
    ] {
        let found = circles_of("mod a; mod b;", &[("a.rs", a), b]);
        assert_eq!(found, if is_circle { vec!["a b"] } else { vec![] }, "{a}");
    }
    // Through a third file.
    let files = [("a.rs", "use crate::b::B; pub struct A;"), ("b.rs", "use crate::c::C; pub struct B;")];
    let third = ("c/mod.rs", "use crate::a::A; pub struct C;");
    assert_eq!(circles_of("mod a; mod b; mod c;", &[files[0], files[1], third]), ["a b mod"]);
}

#[test]
fn a_parent_may_re_export_what_its_children_define() {
    let child = ("a.rs", "use crate::{B, Outside}; pub struct A(B, Outside);");
    let other = ("b.rs", "pub struct B;");
    let shown = "mod a; mod b; pub use a::A; pub use b::B; pub use outside::Outside;";
    assert!(circles_of(shown, &[child, other]).is_empty());
    // A function may have the name of a module.
    assert!(
        circles_of(&format!("{shown} pub fn b(_: a::A) {{}}"), &[("a.rs", "use super::b::B; pub struct A;"), other])
            .is_empty()
    );
    // But with items of its own the parent is a file like any other.
    let own = format!("{shown} pub struct Own; fn f(_: A) {{}}");
    assert!(circles_of(&own, &[child, other]).is_empty());
    assert_eq!(circles_of(&own, &[("a.rs", "pub struct A(crate::Own);"), other]), ["lib a"]);
}
