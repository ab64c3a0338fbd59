//! Runs each fuzz target for some seconds.

use std::fs;
use std::path::Path;
use std::process::Command;

use tasks::Failure;

/// Time limit of one input (s). The targets limit the size of the problems that they solve.
const HANG_S: u32 = 20;

/// Runs every target of `fuzz/`. New inputs that reach new code are written to `out/fuzz`; the corpus is not changed.
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
                    `cargo test -p vibroimpact --test tests fuzz_corpus::` replays the corpus"
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
        // no sanitizer is needed without unsafe code: the targets look for panics and hangs
        let mut run = fuzzer();
        run.args(["run", "--sanitizer", "none", &target]).arg(found).arg(format!("corpus/{target}"));
        run.args(["--".to_owned(), format!("-max_total_time={seconds}"), format!("-timeout={HANG_S}")]);
        if !run.status()?.success() {
            return Err(format!("fuzz target {target} failed; the input is in fuzz/artifacts/{target}").into());
        }
    }
    Ok(())
}
