//! What shells, readers of manuals and editors need: `completions`, `manual`, `schema`.

use clap::{Args, Command, ValueEnum};
use clap_complete::Shell;
use vibroimpact::export::Failure;
use vibroimpact::scene::schema;
use vibroimpact::sweep;

pub const COMPLETIONS_EXAMPLES: &str = "Examples:
  vibroimpact completions bash > ~/.local/share/bash-completion/completions/vibroimpact
  vibroimpact completions zsh > ~/.zfunc/_vibroimpact         (a folder in fpath, before compinit)
  vibroimpact completions fish > ~/.config/fish/completions/vibroimpact.fish
  vibroimpact completions powershell >> $PROFILE";

pub const MANUAL_EXAMPLES: &str = "Example:
  vibroimpact manual > ~/.local/share/man/man1/vibroimpact.1";

pub const SCHEMA_EXAMPLES: &str = "Examples:
  vibroimpact schema scene > scene.schema.json
  vibroimpact schema sweep > sweep.schema.json

A scene that says { \"$schema\": \"scene.schema.json\", ... } is then completed and checked by editors that know JSON
Schema.";

/// The shell to complete in.
#[derive(Args)]
pub struct CompletionsArguments {
    /// Which shell
    shell: Shell,
}

/// The file to describe.
#[derive(Args)]
pub struct SchemaArguments {
    /// The kind of file
    #[arg(value_enum, default_value_t = InputFile::Scene)]
    of: InputFile,
}

/// Files that come in and have a schema.
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

/// The manual page of `program`.
pub fn manual(program: Command) -> Result<String, Failure> {
    let mut page = Vec::new();
    clap_mangen::Man::new(program).render(&mut page)?;
    Ok(String::from_utf8(page)?)
}

/// The JSON Schema of a kind of file.
pub fn schema_of(SchemaArguments { of }: SchemaArguments) -> String {
    match of {
        InputFile::Scene => schema::text(&schema::of_scenes()),
        InputFile::Sweep => schema::text(&sweep::schema()),
    }
}
