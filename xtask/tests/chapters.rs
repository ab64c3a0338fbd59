//! All chapters in their quick form, as the command reproduces them.

use std::fs;
use std::process::Command;

#[test]
fn all_chapters_are_reproduced_in_their_quick_form() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let mut command = Command::new(env!("CARGO_BIN_EXE_xtask"));
    let output = command.args(["reproduce-chapter", "all", "--quick", "--out"]).arg(&out).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    for chapter in 2..=8 {
        let folder = out.join(format!("chapter-{chapter}"));
        assert!(fs::read_dir(&folder).is_ok_and(|files| files.count() > 2), "{}", folder.display());
    }
}
