//! Collects the ```` ```rust ```` snippets of the book and of the README, one documented item each.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::{env, fs, io};

fn main() -> io::Result<()> {
    let book = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    println!("cargo:rerun-if-changed={}", book.display());
    let mut pages = Vec::new();
    collect(&book, &mut pages)?;
    let readme = book.join("../README.md");
    println!("cargo:rerun-if-changed={}", readme.display());
    pages.push(readme);
    pages.sort();
    let mut items = String::new();
    for page in &pages {
        let name = page.strip_prefix(&book).unwrap_or(page).display().to_string();
        for (line, snippet) in snippets(&fs::read_to_string(page)?) {
            let item: String =
                name.chars().map(|c| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '_' }).collect();
            let _ = writeln!(
                items,
                "/// `{name}`, line {line}\n///\n/// ```\n{snippet}/// ```\npub mod {item}_{line} {{}}"
            );
        }
    }
    let out = PathBuf::from(env::var_os("OUT_DIR").ok_or_else(|| io::Error::other("cargo sets OUT_DIR"))?);
    fs::write(out.join("snippets.rs"), items)
}

fn collect(folder: &Path, pages: &mut Vec<PathBuf>) -> io::Result<()> {
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

/// Line and text, as doc comments, of each fence that says `rust` and no more.
fn snippets(page: &str) -> Vec<(usize, String)> {
    let mut found = Vec::new();
    let mut open: Option<(usize, String)> = None;
    for (number, line) in page.lines().enumerate() {
        match (&mut open, line.trim_end()) {
            (None, "```rust") => open = Some((number + 1, String::new())),
            (Some(_), "```") => found.extend(open.take()),
            (Some((_, text)), code) => {
                let _ = writeln!(text, "/// {code}");
            }
            (None, _) => {}
        }
    }
    found
}
