//! The fuzz targets, each for some seconds.

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::chapters::Failure;

/// One input may take this long (s); the targets keep what they solve small.
const HANG_S: u32 = 20;

/// Runs every target of `fuzz/`. What a run finds worth keeping goes to `out/fuzz`; the corpus stays as it is.
pub fn run(root: &Path, seconds: u32) -> Result<(), Failure> {
    let folder = root.join("fuzz");
    let fuzzer = || {
        let mut command = Command::new("rustup");
        command.current_dir(&folder).args(["run", "nightly", "cargo", "fuzz"]);
        command
    };
    if !fuzzer().arg("--version").output().is_ok_and(|output| output.status.success()) {
        return Err(
            "the fuzzer needs `rustup toolchain install nightly` and `cargo install cargo-fuzz`; without them \
                    `cargo test -p vibroimpact --test fuzz_corpus` replays the corpus"
                .into(),
        );
    }
    let mut targets: Vec<String> = fs::read_dir(folder.join("fuzz_targets"))?
        .filter_map(|entry| Some(entry.ok()?.path().file_stem()?.to_string_lossy().into_owned()))
        .collect();
    targets.sort();
    for target in targets {
        eprintln!("== fuzz {target}");
        let found = root.join("out/fuzz").join(&target);
        fs::create_dir_all(&found)?;
        // no sanitizer: the workspace has no unsafe code; panics and hangs are what is looked for
        let mut run = fuzzer();
        run.args(["run", "--sanitizer", "none", &target]).arg(found).arg(format!("corpus/{target}"));
        run.args(["--".to_owned(), format!("-max_total_time={seconds}"), format!("-timeout={HANG_S}")]);
        if !run.status()?.success() {
            return Err(format!("fuzz target {target} failed; the input is in fuzz/artifacts/{target}").into());
        }
    }
    Ok(())
}
