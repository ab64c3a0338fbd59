use crate::files::{Files, read};
use crate::history::Stamp;
use crate::list::problems;
use crate::measure::{References, measure_one};
use crate::problem::error;
use crate::record::{Comparison, Conditions, Entry, Record, compare};
use crate::{history, page};
use std::collections::BTreeMap;
use std::path::Path;

/// A record of two problems, one of which counts nothing.
fn example() -> Record {
    let entry = |error, costs: &[(&str, u64)], instructions| Entry {
        error,
        rounding: 1e-13,
        costs: costs.iter().map(|(name, count)| (name.to_string(), *count)).collect(),
        instructions: Some(instructions),
    };
    Record {
        conditions: Conditions {
            rustc: "rustc 1.89.0".into(),
            target: "x86_64-linux".into(),
            profile: "release".into(),
            valgrind: Some("valgrind-3.19.0".into()),
        },
        problems: BTreeMap::from([
            ("modal/one".into(), entry(1e-9, &[("contact_steps", 200), ("rejected_steps", 0)], 1_000_000)),
            ("modes/two".into(), entry(0.0, &[], 5_000_000)),
        ]),
    }
}

/// The one complaint about a record that differs from the example in one thing.
fn complaint(change: impl FnOnce(&mut Record)) -> String {
    let mut measured = example();
    change(&mut measured);
    let found = compare(&example(), &measured);
    assert_eq!(found.worse.len(), 1, "{found:?}");
    assert!(found.better.is_empty());
    found.worse[0].clone()
}

fn passes(change: impl FnOnce(&mut Record)) -> Comparison {
    let mut measured = example();
    change(&mut measured);
    let found = compare(&example(), &measured);
    assert!(found.worse.is_empty(), "{found:?}");
    found
}

fn one(record: &mut Record) -> &mut Entry {
    record.problems.get_mut("modal/one").unwrap()
}

fn two(record: &mut Record) -> &mut Entry {
    record.problems.get_mut("modes/two").unwrap()
}

fn set(record: &mut Record, cost: &str, count: u64) {
    one(record).costs.insert(cost.into(), count);
}

#[test]
fn every_kind_of_regression_is_found_and_named() {
    assert_eq!(
        complaint(|r| set(r, "contact_steps", 211)),
        "modal/one: contact_steps 200 -> 211 (+5.5 %); allowed: 210"
    );
    assert!(complaint(|r| set(r, "rejected_steps", 3)).starts_with("modal/one: rejected_steps 0 -> 3"));
    assert!(complaint(|r| set(r, "sub_steps", 1)).contains("modal/one: sub_steps is not in the record"));
    let uncounted = complaint(|r| one(r).costs.retain(|cost, _| cost != "contact_steps"));
    assert_eq!(uncounted, "modal/one: contact_steps is no longer counted");
    let slow = complaint(|r| two(r).instructions = Some(5_101_000));
    assert_eq!(slow, "modes/two: instructions 5000000 -> 5101000 (+2.0 %); allowed: +2 %");
    assert_eq!(complaint(|r| two(r).instructions = None), "modes/two: instructions are missing");
    assert_eq!(complaint(|r| one(r).error = 3.1e-9), "modal/one: error 1.0e-9 -> 3.1e-9; allowed: 3.0e-9");
    // from exactly right to beyond rounding, and to nonsense
    assert!(complaint(|r| two(r).error = 4e-13).starts_with("modes/two: error"));
    assert!(complaint(|r| one(r).error = f64::NAN).starts_with("modal/one: error"));
    assert!(complaint(|r| r.problems.retain(|name, _| name != "modes/two")).starts_with("modes/two: in the record"));
    let another = complaint(|r| r.problems.extend([("modal/three".into(), example().problems["modal/one"].clone())]));
    assert_eq!(another, "modal/three: not in the record");
}

#[test]
fn margins_hold_and_gains_are_told() {
    passes(|r| set(r, "contact_steps", 210));
    passes(|r| set(r, "rejected_steps", 2));
    passes(|r| one(r).instructions = Some(1_019_000));
    passes(|r| one(r).error = 2.9e-9);
    passes(|r| two(r).error = 2e-13);
    assert_eq!(passes(|r| set(r, "contact_steps", 150)).better, ["modal/one: contact_steps 200 -> 150 (-25.0 %)"]);
    assert!(passes(|r| one(r).instructions = Some(900_000)).better[0].starts_with("modal/one: instructions"));
    assert_eq!(passes(|r| one(r).error = 1e-10).better, ["modal/one: error 1.0e-9 -> 1.0e-10"]);
}

#[test]
fn instructions_are_compared_on_like_machines_only() {
    let slower = |r: &mut Record| two(r).instructions = Some(9_000_000);
    let other = passes(|r| {
        slower(r);
        r.conditions.rustc = "rustc 1.90.0".into();
    });
    assert!(other.instructions_left_out.unwrap().contains("rustc 1.90.0"));
    let none = passes(|r| {
        slower(r);
        r.conditions.valgrind = None;
    });
    assert_eq!(none.instructions_left_out.as_deref(), Some("valgrind is not installed"));
}

#[test]
fn errors_of_results() {
    assert_eq!(error(&[0.5, 100.0], &[1.0, 101.0]).unwrap(), 0.5);
    assert_eq!(error(&[0.0, 99.0], &[0.0, 100.0]).unwrap(), 0.01);
    assert!(error(&[1.0], &[1.0, 2.0]).is_err() && error(&[], &[]).is_err());
    assert!(error(&[1.0, f64::NAN], &[1.0, 2.0]).is_err() && error(&[f64::INFINITY], &[1.0]).is_err());
}

#[test]
fn a_history_grows_by_what_changed_and_shows_in_the_figure() {
    let stamp = |commit: &str| Stamp { date: "2026-01-01".into(), commit: commit.into() };
    let mut rows = Vec::new();
    let mut record = example();
    // two counts, two instructions, two errors
    assert_eq!(history::append(&mut rows, &record, &stamp("a")), 6);
    assert_eq!(history::append(&mut rows, &record, &stamp("b")), 0);
    set(&mut record, "contact_steps", 100);
    assert_eq!(history::append(&mut rows, &record, &stamp("c")), 1);
    assert_eq!(rows.last().map(|row| (row.recording, row.commit.as_str(), row.value)), Some((2, "c", 100.0)));

    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("history.csv");
    assert!(history::read(&path).unwrap().is_empty());
    history::write(&path, &rows).unwrap();
    assert_eq!(history::read(&path).unwrap(), rows);

    let svg = history::figure(&rows, &record).svg().unwrap();
    assert!(svg.contains("</svg>") && svg.contains("instructions"));
    let text = page::page(&record, &rows);
    assert!(
        text.contains("| one | 1.0e-9 | 1.000 M | 100 | 0 |") && text.contains("| 2 | 2026-01-01 | `c` |"),
        "{text}"
    );
}

/// The committed record holds, and a worsened copy of it does not; without callgrind, for the sake of time.
#[test]
fn the_committed_record_holds_and_a_worsened_one_fails() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).unwrap();
    let files = Files::of(&root.join("docs"));
    let (recorded, truth): (Record, References) = (read(&files.record).unwrap(), read(&files.references).unwrap());
    let problems = problems(root).unwrap();
    let entries = problems.iter().map(|p| (p.name.clone(), measure_one(p, &truth).unwrap())).collect();
    let measured =
        Record { conditions: Conditions { valgrind: None, ..recorded.conditions.clone() }, problems: entries };
    let found = compare(&recorded, &measured);
    assert!(found.worse.is_empty(), "{:#?}", found.worse);

    // whatever problem it is, a better record in the file means a regression now
    for name in recorded.problems.keys() {
        let mut better = recorded.clone();
        let entry = better.problems.get_mut(name).unwrap();
        let Some(count) = entry.costs.values_mut().max() else { continue };
        *count /= 2;
        let found = compare(&better, &measured);
        assert!(found.worse.len() == 1 && found.worse[0].starts_with(&format!("{name}: ")), "{found:?}");
    }
}
