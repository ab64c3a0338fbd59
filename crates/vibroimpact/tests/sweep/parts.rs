//! Parts that are computed separately and merged give the whole, or the reason why not.

use super::*;

fn parts(bench: &Bench, of: usize) -> Vec<String> {
    let names: Vec<String> = (1..=of).map(|number| format!("part-{number}")).collect();
    for (i, name) in names.iter().enumerate() {
        let shard = format!("{}/{of}", i + 1);
        bench.succeeds(&["sweep", "sweep.json", "--out", name, "--shard", &shard, "--quiet"]);
    }
    names
}

fn merge(parts: &[String]) -> Vec<&str> {
    let folders = parts.iter().map(String::as_str);
    std::iter::once("merge").chain(folders).chain(["--out", "merged"]).collect()
}

#[test]
fn merged_parts_are_the_whole() {
    let bench = Bench::new(&super::sweep());
    bench.succeeds(&["sweep", "sweep.json", "--out", "whole", "--quiet"]);
    let mut names = parts(&bench, 3);
    // In any order.
    names.rotate_left(1);
    let printed = bench.succeeds(&merge(&names));
    assert!(printed.contains("600"));
    assert_same(&bench.path("whole"), &bench.path("merged"));
    // A second time changes nothing.
    bench.succeeds(&merge(&names));
    assert_same(&bench.path("whole"), &bench.path("merged"));
}

#[test]
fn there_may_be_more_parts_than_points() {
    let bench = Bench::new(&json!({ "scene": scene(), "vary": [{ "field": "modes", "values": [1, 2, 3] }] }));
    bench.succeeds(&["sweep", "sweep.json", "--out", "whole", "--quiet"]);
    let names = parts(&bench, 5);
    bench.succeeds(&merge(&names));
    assert_same(&bench.path("whole"), &bench.path("merged"));
}

#[test]
fn incomplete_or_foreign_parts_are_refused() {
    let bench = Bench::new(&super::sweep());
    let names = parts(&bench, 4);
    let told = bench.refuses(&merge(&[names[0].clone(), names[2].clone()]));
    assert!(told.contains("2 of 4 parts are missing: 2/4, 4/4"), "{told}");
    let doubled: Vec<String> = names.iter().chain([&names[1]]).cloned().collect();
    let told = bench.refuses(&merge(&doubled));
    assert!(told.contains("hold the same part, 2"), "{told}");
    bench.succeeds(&["sweep", "sweep.json", "--out", "half", "--shard", "1/2", "--quiet"]);
    let told = bench.refuses(&merge(&[names[0].clone(), "half".to_owned()]));
    assert!(told.contains("part-1 is one of 4 parts, half one of 2"), "{told}");
    assert!(bench.refuses(&merge(&["nowhere".to_owned()])).contains("is not the folder of a sweep"));

    let mut other = super::sweep();
    other["random"]["seed"] = json!(6);
    fs::write(bench.path("sweep.json"), other.to_string()).unwrap();
    bench.succeeds(&["sweep", "sweep.json", "--out", "other", "--shard", "4/4", "--quiet"]);
    let told = bench.refuses(&merge(&[&names[..3], &["other".to_owned()]].concat()));
    assert!(told.contains("different sweeps"), "{told}");

    let progress = bench.path("part-3/progress.json");
    let kept = fs::read_to_string(&progress).unwrap();
    fs::write(&progress, kept.replace("\"finished\": true", "\"finished\": false")).unwrap();
    let told = bench.refuses(&merge(&names));
    assert!(told.contains("part-3 holds part 3/4, unfinished"), "{told}");
    assert!(!bench.path("merged").exists());
    fs::write(&progress, kept).unwrap();

    // A digit was changed after the part was finished.
    let results = bench.path("part-3/results.csv");
    let mut rows = fs::read(&results).unwrap();
    let digit = rows.len() - 400 + rows[rows.len() - 400..].iter().position(|byte| byte.is_ascii_digit()).unwrap();
    rows[digit] = if rows[digit] == b'1' { b'2' } else { b'1' };
    fs::write(&results, rows).unwrap();
    let told = bench.refuses(&merge(&names));
    assert!(told.contains("part-3/results.csv is damaged"), "{told}");
}

#[test]
fn shards_are_given_as_k_of_n() {
    let bench = Bench::new(&super::sweep());
    for shard in ["0/3", "4/3", "1", "1/0", "-1/3", "a/b", "1/2/3", "1/9999999"] {
        let told = bench.refuses(&["sweep", "sweep.json", "--out", "out", &format!("--shard={shard}")]);
        assert!(told.contains("K/N"), "{told}");
    }
    assert!(!bench.path("out").exists());
}
