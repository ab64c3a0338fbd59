//! Runs the functions of the fuzzer on every file of its corpus, without a fuzzer or a nightly compiler.

#[path = "../../../fuzz/src/targets.rs"]
mod targets;

use std::path::Path;

/// Processes the files of a folder, in the order of their names, and returns their number.
fn feed(target: &str, function: fn(&[u8])) -> usize {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/corpus").join(target);
    let mut files: Vec<_> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    for file in &files {
        // Prints the name of the file in the output of a test that fails.
        println!("{}", file.display());
        function(&std::fs::read(file).unwrap());
    }
    files.len()
}

#[test]
fn scenes() {
    assert!(feed("scene", targets::scene) >= 16);
}

#[test]
fn sweeps() {
    assert!(feed("sweep", targets::sweep) >= 8);
}

#[test]
fn data_tables() {
    assert!(feed("data_table", targets::data_table) >= 4);
}

#[test]
fn impacts() {
    assert!(feed("impact", targets::impact) >= 10);
}
