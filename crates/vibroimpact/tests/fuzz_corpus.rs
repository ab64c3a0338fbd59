//! Every file of the fuzzer's corpus through what the fuzzer calls: no fuzzer and no nightly compiler are needed.

#[path = "../../../fuzz/src/targets.rs"]
mod targets;

use std::path::Path;

/// Feeds a folder's files, in order of name, and says how many there are.
fn feed(target: &str, function: fn(&[u8])) -> usize {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/corpus").join(target);
    let mut files: Vec<_> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    for file in &files {
        // names the file in the output of a test that fails
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
