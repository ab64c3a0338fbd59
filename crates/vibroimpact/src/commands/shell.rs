//! The commands `completions`, `manual` and `schema`, for shells, manual pages and editors.

use std::path::PathBuf;

use clap::{Args, Command, ValueEnum};
use clap_complete::Shell;
use vibroimpact::export::Failure;
use vibroimpact::report::write_whole;
use vibroimpact::scene::schema;
use vibroimpact::text::printable;
use vibroimpact::{InvalidInput, sweep};

use super::products::{require_folder, require_free};

pub const COMPLETIONS_EXAMPLES: &str = "Examples:
  vibroimpact completions bash > ~/.local/share/bash-completion/completions/vibroimpact
  vibroimpact completions zsh > ~/.zfunc/_vibroimpact         (a folder in fpath, before compinit)
  vibroimpact completions fish > ~/.config/fish/completions/vibroimpact.fish
  vibroimpact completions powershell >> $PROFILE";

pub const MANUAL_EXAMPLES: &str = "Examples:
  vibroimpact manual --out ~/.local/share/man/man1        all pages; then: man vibroimpact-simulate
  vibroimpact manual simulate | man -l -                  one page, at once";

pub const SCHEMA_EXAMPLES: &str = "Examples:
  vibroimpact schema scene > scene.schema.json
  vibroimpact schema sweep > sweep.schema.json

A scene that says { \"$schema\": \"scene.schema.json\", ... } is then completed and checked by editors that know JSON
Schema.";

/// The shell to complete in.
#[derive(Args)]
pub struct CompletionsArguments {
    /// The shell
    shell: Shell,
}

/// The manual pages to print or write.
#[derive(Args)]
pub struct ManualArguments {
    /// The command whose page is printed; default: the page of the program itself
    #[arg(conflicts_with = "out")]
    command: Option<String>,
    /// Write the pages of the program and of all its commands to this folder
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Replace files that exist
    #[arg(long)]
    force: bool,
}

/// The file to describe.
#[derive(Args)]
pub struct SchemaArguments {
    /// The kind of file
    #[arg(value_enum, default_value_t = InputFile::Scene)]
    of: InputFile,
}

/// Input files that have a schema.
#[derive(Clone, Copy, ValueEnum)]
enum InputFile {
    /// A scene
    Scene,
    /// A sweep
    Sweep,
}

/// The script that completes the commands of `program`.
pub fn completions(
    CompletionsArguments { shell }: CompletionsArguments,
    mut program: Command,
) -> Result<String, Failure> {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut program, "vibroimpact", &mut script);
    Ok(String::from_utf8(script)?)
}

/// The manual page of `program` or of one of its commands, or all of them into a folder.
pub fn manual(ManualArguments { command, out, force }: ManualArguments, program: Command) -> Result<String, Failure> {
    let mut program =
        program.disable_help_subcommand(true).mut_subcommands(|command| command.disable_help_subcommand(true));
    // names the pages of commands after the program, as in vibroimpact-simulate
    program.build();
    let page = |command: &Command| -> Result<String, Failure> {
        let mut page = Vec::new();
        let source = concat!("vibroimpact ", env!("CARGO_PKG_VERSION"));
        clap_mangen::Man::new(command.clone()).source(source).render(&mut page)?;
        Ok(with_examples(&String::from_utf8(page)?))
    };
    let commands = || program.get_subcommands();
    let Some(folder) = out else {
        let Some(name) = command else { return page(&program) };
        let of_name = commands().find(|command| command.get_name() == name);
        return page(of_name.ok_or_else(|| {
            let names: Vec<&str> = commands().map(Command::get_name).collect();
            InvalidInput::new("COMMAND", name.as_str(), format!("one of {}", names.join(", ")))
        })?);
    };
    let mut pages = vec![("vibroimpact.1".to_owned(), page(&program)?)];
    for command in commands().flat_map(|command| std::iter::once(command).chain(command.get_subcommands())) {
        pages.push((format!("{}.1", command.get_display_name().unwrap_or(command.get_name())), page(command)?));
    }
    require_folder("--out", &folder)?;
    for (name, _) in &pages {
        require_free("--out", Some(&folder.join(name)), force)?;
    }
    for (name, text) in &pages {
        write_whole(&folder.join(name), text.as_bytes())
            .map_err(|error| format!("cannot write to {}: {error}", folder.display()))?;
    }
    let place = printable(&folder.display().to_string());
    Ok(format!("wrote {} pages to {place}\n  read one with: man -l {place}/vibroimpact-simulate.1\n", pages.len()))
}

/// A manual page whose last part is called by its content, and in which indented lines, such as commands, stay lines.
fn with_examples(page: &str) -> String {
    let Some((options, rest)) = page.split_once(".SH EXTRA\n") else { return page.to_owned() };
    let rest = rest.strip_prefix("Examples:\n").or_else(|| rest.strip_prefix("Example:\n")).unwrap_or(rest);
    let mut filled = true;
    let mut examples = String::new();
    for line in rest.lines() {
        // an empty line belongs to the lines around it
        if !line.is_empty() && filled == line.starts_with("  ") {
            filled = !filled;
            examples += if filled { ".fi\n" } else { ".nf\n" };
        }
        examples += line;
        examples.push('\n');
    }
    format!("{options}.SH EXAMPLES\n{examples}")
}

/// The JSON Schema of a kind of file.
pub fn schema_of(SchemaArguments { of }: SchemaArguments) -> String {
    match of {
        InputFile::Scene => schema::text(&schema::of_scenes()),
        InputFile::Sweep => schema::text(&sweep::schema()),
    }
}
