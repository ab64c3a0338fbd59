//! Tests of the workflows: actions are pinned, permissions are minimal, versions agree with the manifests, and a release is
//! published only after every check has passed. Linters check the rest (`.github/check.sh`).

use std::fs;
use std::path::{Path, PathBuf};

use saphyr::{LoadableYamlNode, Yaml};
use toml::{Table, Value};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Names and texts of the workflows.
fn texts() -> Vec<(String, String)> {
    let folder = root().join(".github/workflows");
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let mut found: Vec<_> = entries
        .map(|path| (path.file_stem().unwrap().to_str().unwrap().to_owned(), fs::read_to_string(&path).unwrap()))
        .collect();
    found.sort();
    assert!(found.len() >= 5);
    found
}

fn parsed(text: &str) -> Yaml<'_> {
    Yaml::load_from_str(text).unwrap().remove(0)
}

fn workflow(name: &str) -> String {
    texts().into_iter().find(|(own, _)| own == name).unwrap().1
}

/// The value at a path of keys.
fn at<'a>(tree: &'a Yaml<'a>, path: &[&str]) -> Option<&'a Yaml<'a>> {
    path.iter().try_fold(tree, |tree, key| tree.as_mapping_get(key))
}

fn jobs<'a>(workflow: &'a Yaml<'a>) -> Vec<(&'a str, &'a Yaml<'a>)> {
    let jobs = at(workflow, &["jobs"]).and_then(Yaml::as_mapping).unwrap();
    jobs.iter().map(|(name, job)| (name.as_str().unwrap(), job)).collect()
}

fn steps<'a>(job: &'a Yaml<'a>) -> &'a [Yaml<'a>] {
    at(job, &["steps"]).and_then(Yaml::as_sequence).map_or(&[], Vec::as_slice)
}

/// All commands of a workflow.
fn commands(text: &str) -> String {
    let tree = parsed(text);
    let runs = jobs(&tree).into_iter().flat_map(|(_, job)| steps(job)).filter_map(|step| at(step, &["run"])?.as_str());
    runs.map(|run| run.to_owned() + "\n").collect()
}

/// The folders of the workspace's packages, and their manifests.
fn packages() -> Vec<(PathBuf, Table)> {
    let read = |folder: &Path| fs::read_to_string(folder.join("Cargo.toml")).unwrap().parse::<Table>().unwrap();
    let workspace = read(&root());
    let members = workspace["workspace"]["members"].as_array().unwrap().iter().filter_map(Value::as_str);
    let folders = members.flat_map(|member| match member.strip_suffix("/*") {
        Some(parent) => fs::read_dir(root().join(parent)).unwrap().map(|entry| entry.unwrap().path()).collect(),
        None => vec![root().join(member)],
    });
    folders.filter(|folder| folder.join("Cargo.toml").is_file()).map(|folder| (folder.clone(), read(&folder))).collect()
}

#[test]
fn what_is_packed_is_what_is_published() {
    let is_private = |manifest: &Table| manifest["package"].get("publish") == Some(&Value::Boolean(false));
    let (private, public): (Vec<_>, Vec<_>) = packages().into_iter().partition(|(_, manifest)| is_private(manifest));
    assert!(private.len() >= 8 && public.len() >= 8);
    let mut names: Vec<_> = public.iter().map(|(_, manifest)| manifest["package"]["name"].as_str().unwrap()).collect();
    names.sort();
    assert_eq!(crate::published(&root()).unwrap(), names);
    // the same selection, by the shell
    let commands = commands(&workflow("ci"));
    for command in ["cargo package", "cargo semver-checks"] {
        let selects = format!("{command} $(ls crates | sed 's/^/--package=/') ");
        assert!(commands.contains(&selects) && commands.matches(command).count() == 1, "{selects}");
    }
}

#[test]
fn actions_are_pinned_to_a_commit_that_names_its_version() {
    for (name, text) in texts() {
        for line in text.lines() {
            let Some((_, used)) = line.split_once("uses: ") else { continue };
            if used.starts_with("./.github/workflows/") {
                assert!(root().join(used).is_file(), "{name}: {used}");
                continue;
            }
            let (_, pin) = used.split_once('@').unwrap();
            let (commit, version) = pin.split_once(" # v").unwrap_or((pin, ""));
            let is_commit = commit.len() == 40 && commit.bytes().all(|byte| byte.is_ascii_hexdigit());
            assert!(is_commit && !version.is_empty(), "{name}: {used}");
        }
    }
}

#[test]
fn jobs_may_only_read_and_end_in_time() {
    for (name, text) in texts() {
        let tree = parsed(&text);
        assert_eq!(at(&tree, &["permissions", "contents"]).and_then(Yaml::as_str), Some("read"), "{name}");
        for (job, body) in jobs(&tree) {
            let ends = at(body, &["timeout-minutes"]).is_some() || at(body, &["uses"]).is_some();
            assert!(ends, "{name}, {job}: no timeout-minutes");
            let writes = at(body, &["permissions"]).is_some();
            assert!(!writes || name == "release", "{name}, {job}: more permissions than others");
            for step in steps(body).iter().filter(|step| {
                at(step, &["uses"]).and_then(Yaml::as_str).is_some_and(|used| used.starts_with("actions/checkout@"))
            }) {
                let kept = at(step, &["with", "persist-credentials"]).and_then(Yaml::as_bool);
                assert_eq!(kept, Some(false), "{name}, {job}: the checkout keeps its credentials");
            }
        }
    }
}

#[test]
fn scripts_that_are_run_exist() {
    let mut count = 0;
    for (name, text) in texts() {
        let commands = commands(&text);
        for word in commands.split_whitespace().filter(|word| word.ends_with(".sh") || *word == ".ci/run") {
            assert!(root().join(word).is_file(), "{name}: {word}");
            count += 1;
        }
    }
    assert!(count >= 5);
}

#[test]
fn versions_are_those_of_the_manifests() {
    let manifest = fs::read_to_string(root().join("Cargo.toml")).unwrap();
    let rust = manifest.lines().find_map(|line| line.strip_prefix("rust-version = \"")?.strip_suffix('"')).unwrap();
    let check =
        format!("rustup toolchain install {rust} --profile minimal\ncargo +{rust} check --workspace --locked\n");
    assert!(commands(&workflow("ci")).contains(&check), "{check}");
    for project in ["python", "web", "fuzz"] {
        let own = fs::read_to_string(root().join(project).join("Cargo.toml")).unwrap();
        assert!(project == "fuzz" || own.contains(&format!("rust-version = \"{rust}\"")), "{project}");
    }
    let package = fs::read_to_string(root().join("python/pyproject.toml")).unwrap();
    let oldest =
        package.lines().find_map(|line| line.strip_prefix("requires-python = \">=")?.strip_suffix('"')).unwrap();
    assert!(workflow("python").contains(&format!("python-version: \"{oldest}\"")));
    let compiled = fs::read_to_string(root().join("python/Cargo.toml")).unwrap();
    assert!(compiled.contains(&format!("abi3-py{}", oldest.replace('.', ""))));
}

#[test]
fn a_release_checks_everything_before_it_publishes() {
    let (release, ci) = (workflow("release"), workflow("ci"));
    let (release, ci) = (parsed(&release), parsed(&ci));
    let named = |tree: &Yaml, job: &str| jobs(tree).iter().any(|(own, _)| *own == job);
    for job in ["test", "alone", "oldest-rust", "licences-and-advisories", "semver", "workflows"] {
        assert!(named(&ci, job), "ci lacks {job}");
    }
    for called in ["ci", "python"] {
        let text = workflow(called);
        assert!(at(&parsed(&text), &["on"]).is_some_and(|on| at(on, &["workflow_call"]).is_some()), "{called}");
    }
    let needed = |job: &str| -> Vec<String> {
        let needs = at(&release, &["jobs", job, "needs"]).unwrap();
        let one = needs.as_str().map(str::to_owned);
        let several = needs.as_sequence().into_iter().flatten().filter_map(|name| name.as_str().map(str::to_owned));
        one.into_iter().chain(several).collect()
    };
    assert_eq!(needed("crates"), ["version", "checks", "wheels", "programs"]);
    assert_eq!(needed("python-package"), ["crates"]);
    assert_eq!(needed("page"), ["crates", "python-package"]);
    for job in ["crates", "python-package", "page"] {
        assert!(needed(job).iter().all(|name| named(&release, name)));
        let when = at(&release, &["jobs", job, "if"]).and_then(Yaml::as_str);
        assert_eq!(when, Some("github.ref_type == 'tag'"), "{job} must not publish without a tag");
    }
    let targets = at(&release, &["jobs", "programs", "strategy", "matrix", "include"]).and_then(Yaml::as_sequence);
    let systems: Vec<_> = targets.unwrap().iter().filter_map(|entry| at(entry, &["os"])?.as_str()).collect();
    for system in ["ubuntu", "macos", "windows"] {
        assert!(systems.iter().any(|own| own.starts_with(system)), "no program for {system}");
    }
}
