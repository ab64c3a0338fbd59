//! Checks of the book: every link has a target, every command in a `sh` fence runs and exits with the code that the page states,
//! every line of a `text` fence that follows such a fence is a line of the commands' output (`...` stands for any lines), every
//! `json scene` or `toml scene` fence holds a valid scene, and the brackets of every formula match.
//!
//! Commands run in a temporary folder with a copy of `datasets`, so that a page may write files. A line may end in
//! `# exits with 2`. Rust snippets are documentation tests of the package `book-snippets`. Formulas are fences named `math` and
//! code between dollar signs, which GitHub and `docs/theme/math.js` typeset.

use pulldown_cmark::{CodeBlockKind, CowStr, Event, Options, Parser, Tag, TagEnd};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use tasks::Failure;
use vibroimpact::Scene;

/// Parts of a page that are checked.
#[derive(Debug, PartialEq)]
enum Item {
    Command { line: String, exit: i32 },
    Output(String),
    JsonScene(String),
    TomlScene(String),
    Link(String),
    Formula(String),
}

/// Checks all pages under `docs`, the README and those of the crates.
pub fn run(root: &Path) -> Result<(), Failure> {
    let mut pages = vec![root.join("README.md")];
    for folder in ["docs", "crates", "datasets"] {
        collect(&root.join(folder), &mut pages)?;
    }
    pages.sort();
    let program = program(root)?;
    let mut faults = Vec::new();
    let mut counts = [0; 5];
    for page in &pages {
        let name = page.strip_prefix(root).unwrap_or(page).display().to_string();
        let mut printed = String::new();
        // each page is read by somebody who has the datasets and no file of another page
        let workplace = tempfile::tempdir()?;
        copy(&root.join("datasets"), &workplace.path().join("datasets"))?;
        for item in items(&fs::read_to_string(page)?) {
            let (kind, result) = match &item {
                Item::Command { line, exit } => {
                    (0, execute(line, *exit, &program, workplace.path()).map(|output| printed += &output))
                }
                Item::Output(text) => (1, shown(text, &std::mem::take(&mut printed))),
                Item::JsonScene(text) => (2, scene(Scene::from_json(text))),
                Item::TomlScene(text) => (2, scene(Scene::from_toml(text))),
                Item::Link(target) => (3, follow(page, target)),
                Item::Formula(text) => (4, formula(text)),
            };
            counts[kind] += 1;
            if let Err(fault) = result {
                faults.push(format!("{name}: {fault}"));
            }
        }
    }
    let [commands, outputs, scenes, links, formulas] = counts;
    eprintln!(
        "{} pages: {commands} commands run, {outputs} outputs compared, {scenes} scenes read, {links} links followed, \
         {formulas} formulas read",
        pages.len()
    );
    if faults.is_empty() { Ok(()) } else { Err(faults.join("\n").into()) }
}

/// Finds the items of a page, in order.
fn items(page: &str) -> Vec<Item> {
    let mut found = Vec::new();
    let mut fence: Option<(String, String)> = None;
    let mut after_commands = false;
    // whether the text before a code span ends in a dollar sign
    let mut dollar = false;
    for event in Parser::new_ext(page, Options::ENABLE_TABLES) {
        let opened = std::mem::replace(&mut dollar, matches!(&event, Event::Text(text) if text.ends_with('$')));
        match event {
            Event::Code(text) if opened => found.push(Item::Formula(text.into_string())),
            Event::Start(Tag::CodeBlock(CodeBlockKind::Fenced(kind))) => {
                fence = Some((kind.to_string(), String::new()))
            }
            Event::Text(text) => {
                if let Some((_, inside)) = &mut fence {
                    inside.push_str(&text);
                }
            }
            Event::End(TagEnd::CodeBlock) => {
                let Some((kind, text)) = fence.take() else { continue };
                let was_after_commands = std::mem::replace(&mut after_commands, kind == "sh");
                match kind.as_str() {
                    "sh" => found.extend(commands(&text)),
                    "text" if was_after_commands => found.push(Item::Output(text)),
                    "json scene" => found.push(Item::JsonScene(text)),
                    "toml scene" => found.push(Item::TomlScene(text)),
                    "math" => found.push(Item::Formula(text)),
                    _ => {}
                }
            }
            Event::Start(Tag::Link { dest_url, .. } | Tag::Image { dest_url, .. }) => found.extend(link(&dest_url)),
            _ => {}
        }
    }
    found
}

/// Splits a fence into commands, one per line; a backslash at the end of a line continues the command.
fn commands(text: &str) -> Vec<Item> {
    let joined = text.replace("\\\n", " ");
    let lines = joined.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with('#'));
    let command = |line: &str| {
        let (line, exit) =
            line.split_once("# exits with ").map_or((line, 0), |(line, code)| (line, code.parse().unwrap_or(-1)));
        Item::Command { line: line.trim().to_owned(), exit }
    };
    lines.map(command).collect()
}

/// Checks a link to a file of the repository, without its anchor.
fn link(target: &CowStr) -> Option<Item> {
    relative(target.split('#').next().unwrap_or_default())
}

fn relative(file: &str) -> Option<Item> {
    (!file.is_empty() && !file.contains("://") && !file.starts_with("mailto:")).then(|| Item::Link(file.to_owned()))
}

fn follow(page: &Path, target: &str) -> Result<(), Failure> {
    let place = page.parent().unwrap_or(Path::new("")).join(target);
    let place = place.canonicalize().map_err(|_| format!("the link {target} leads nowhere"))?;
    // a book has no pages but those of its folder
    let is_in_book = |path: &Path| path.iter().any(|part| part == "docs");
    if is_in_book(page) && !is_in_book(&place) {
        return Err(format!("the link {target} leads out of the book").into());
    }
    Ok(())
}

/// Checks that braces, environments and `\left`/`\right` brackets are closed in the order in which they are opened.
fn formula(text: &str) -> Result<(), Failure> {
    let (mut depth, mut least) = (0, 0);
    let mut characters = text.chars();
    while let Some(character) = characters.next() {
        match character {
            '\\' => drop(characters.next()),
            '{' => depth += 1,
            '}' => depth -= 1,
            _ => {}
        }
        least = depth.min(least);
    }
    let alike = |a: &str, b: &str| text.matches(a).count() == text.matches(b).count();
    if depth == 0 && least == 0 && alike("\\begin{", "\\end{") && alike("\\Bigl", "\\Bigr") && alike("\\bigl", "\\bigr")
    {
        Ok(())
    } else {
        Err(format!("the formula {text} is not closed").into())
    }
}

fn scene(read: Result<Scene, vibroimpact::SceneError>) -> Result<(), Failure> {
    Ok(read.map(drop)?)
}

/// Checks that the lines of a page are lines of the output, in its order, apart from blanks.
fn shown(page: &str, output: &str) -> Result<(), Failure> {
    let words = |line: &str| line.split_whitespace().map(str::to_owned).collect::<Vec<_>>();
    let mut printed = output.lines().map(words);
    for line in page.lines().map(words).filter(|line| !line.is_empty() && line != &["..."]) {
        if !printed.any(|found| found == line) {
            return Err(format!("the line `{}` is not in the output\n{output}", line.join(" ")).into());
        }
    }
    Ok(())
}

/// Runs a line of the shell with `vibroimpact` and `cargo xtask` built from this workspace, and returns what it prints.
fn execute(line: &str, exit: i32, programs: &Path, folder: &Path) -> Result<String, Failure> {
    let path = std::env::var_os("PATH").unwrap_or_default();
    let path = std::env::join_paths(std::iter::once(programs.to_owned()).chain(std::env::split_paths(&path)))?;
    let xtask = std::env::current_exe()?;
    let line = line.replace("cargo xtask", &format!("'{}'", xtask.display()));
    let output = Command::new("sh").args(["-c", &line]).current_dir(folder).env("PATH", path).output()?;
    let told = String::from_utf8_lossy(&output.stderr).into_owned();
    if output.status.code() == Some(exit) {
        return Ok(String::from_utf8_lossy(&output.stdout).into_owned() + &told);
    }
    Err(format!("`{line}` ended with {}, not with exit code {exit}\n{told}", output.status).into())
}

/// The folder of the built program.
fn program(root: &Path) -> Result<PathBuf, Failure> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    // the profile with which `cargo test --workspace` has built it
    let build = "build --workspace --bins --profile test --locked --message-format json-render-diagnostics";
    let build = build.split(' ');
    let output = Command::new(cargo).current_dir(root).args(build).stderr(std::process::Stdio::inherit()).output()?;
    let messages = String::from_utf8_lossy(&output.stdout);
    let executable =
        messages.lines().filter_map(|line| serde_json::from_str::<serde_json::Value>(line).ok()).find_map(|message| {
            let target = message.get("target")?.get("name")?.as_str()? == "vibroimpact";
            message.get("executable")?.as_str().filter(|_| target).map(PathBuf::from)
        });
    let executable = executable.ok_or("cargo built no program named vibroimpact")?;
    Ok(executable.parent().unwrap_or(Path::new("")).to_owned())
}

fn collect(folder: &Path, pages: &mut Vec<PathBuf>) -> Result<(), Failure> {
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            collect(&path, pages)?;
        } else if path.extension().is_some_and(|extension| extension == "md") {
            pages.push(path);
        }
    }
    Ok(())
}

fn copy(from: &Path, to: &Path) -> Result<(), Failure> {
    fs::create_dir_all(to)?;
    for entry in fs::read_dir(from)? {
        let entry = entry?;
        let target = to.join(entry.file_name());
        if entry.file_type()?.is_dir() {
            copy(&entry.path(), &target)?;
        } else {
            fs::copy(entry.path(), target)?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_page_is_taken_apart() {
        let page = "[a](b.md#c) [d](https://e.f) $`x` and `y`$\n\n```sh\n# said only\nvibroimpact --help\nvibroimpact x \\\n  --y  # exits with 2\n```\n\nIt prints\n\n```text\nerror: x\n```\n\n```json scene\n{}\n```\n\n```text\nno output\n```\n";
        let command = |line: &str, exit| Item::Command { line: line.to_owned(), exit };
        assert_eq!(
            items(page),
            [
                Item::Link("b.md".to_owned()),
                Item::Formula("x".to_owned()),
                command("vibroimpact --help", 0),
                command("vibroimpact x    --y", 2),
                Item::Output("error: x\n".to_owned()),
                Item::JsonScene("{}\n".to_owned())
            ]
        );
    }

    #[test]
    fn shown_lines_are_those_of_the_output() {
        let output = "a  1\n\n  b 2\nc 3\n";
        assert!(shown("a 1\n...\nc   3\n", output).is_ok());
        assert!(
            shown("b 2\na 1\n", output).unwrap_err().to_string().starts_with("the line `a 1` is not in the output")
        );
        assert!(shown("b 3\n", output).is_err());
    }

    /// `Name::Variant` for every public enum of the crates whose name has this ending.
    fn variants(root: &Path, ending: &str) -> Vec<String> {
        fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
            for entry in fs::read_dir(folder).unwrap() {
                let path = entry.unwrap().path();
                match path.extension() {
                    _ if path.is_dir() => sources(&path, found),
                    Some(extension) if extension == "rs" => found.push(path),
                    _ => {}
                }
            }
        }
        let mut files = Vec::new();
        for krate in fs::read_dir(root.join("crates")).unwrap() {
            sources(&krate.unwrap().path().join("src"), &mut files);
        }
        let mut found = Vec::new();
        for file in files {
            let text = fs::read_to_string(file).unwrap();
            for declared in text.split("\npub enum ").skip(1) {
                let (name, rest) = declared.split_once(" {\n").unwrap();
                if name.ends_with(ending) {
                    let body = rest.split_once("\n}").unwrap().0;
                    // a variant is indented by four spaces, its fields by more
                    let variant = body.lines().filter_map(|line| line.strip_prefix("    "));
                    let variant = variant.filter(|line| line.starts_with(|c: char| c.is_ascii_uppercase()));
                    found.extend(variant.map(|line| {
                        let end = line.find(|c: char| !c.is_alphanumeric()).unwrap_or(line.len());
                        format!("{name}::{}", &line[..end])
                    }));
                }
            }
        }
        found
    }

    #[test]
    fn every_error_and_outcome_is_on_the_page_of_errors() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
        let page = fs::read_to_string(root.join("docs/errors.md")).unwrap();
        let errors = variants(root, "Error");
        assert!(errors.contains(&"SweepError::Refused".to_owned()) && errors.contains(&"FitError::Invalid".to_owned()));
        let missing: Vec<String> = errors
            .into_iter()
            .chain(variants(root, "Outcome"))
            .chain(variants(root, "Stop"))
            .filter(|name| !page.contains(&format!("`{name}`")))
            .collect();
        assert!(missing.is_empty(), "{missing:?}");
        for krate in fs::read_dir(root.join("crates")).unwrap() {
            let name = krate.unwrap().file_name().into_string().unwrap();
            assert!(page.contains(&format!("`{name}`")), "{name}");
        }
    }

    #[test]
    fn what_does_not_hold_is_found() {
        let here = tempfile::tempdir().unwrap();
        assert!(execute("exit 2", 2, here.path(), here.path()).is_ok());
        assert!(execute("exit 2", 0, here.path(), here.path()).is_err());
        let page = here.path().join("page.md");
        assert!(follow(&page, "absent.md").is_err());
        let book = here.path().join("docs");
        fs::create_dir(&book).unwrap();
        for file in [&page, &book.join("page.md")] {
            fs::write(file, "").unwrap();
        }
        assert!(follow(&page, "docs/page.md").is_ok() && follow(&book.join("page.md"), "page.md").is_ok());
        assert!(follow(&book.join("page.md"), "../page.md").is_err());
        assert!(scene(Scene::from_json("{}")).is_err());
        assert!(formula(r"\frac{1}{\{x\}} \Bigl[ y \Bigr]").is_ok());
        for open in [r"\frac{1}{2", "x}{", r"\begin{aligned} x", r"\Bigl[ y"] {
            assert!(formula(open).is_err(), "{open}");
        }
    }
}
