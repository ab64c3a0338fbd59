//! The scene of a command: a file or the standard input, and fields that are set on the command line.

use std::io::stdin;
use std::path::{Path, PathBuf};

use clap::Args;
use vibroimpact::draft::Draft;
use vibroimpact::text::{printable, shorten};
use vibroimpact::{Scene, SceneError};

use super::voice::{name_scene, note};

/// The scene of a command.
#[derive(Args)]
pub struct SceneSource {
    /// The scene, a JSON or TOML file; - reads the standard input
    scene: PathBuf,
    #[command(flatten)]
    changes: Changes,
}

/// Fields that differ from those in the file.
#[derive(Args)]
pub struct Changes {
    /// Set a field of the scene, as in striker.speed_m_s=2; may be repeated
    #[arg(long = "set", value_name = "FIELD=VALUE", help_heading = "Scene")]
    set: Vec<String>,
}

impl SceneSource {
    /// The scene before it is checked.
    pub fn draft(&self) -> Result<Draft, SceneError> {
        self.changes.draft(&self.scene)
    }

    /// The scene of one impact.
    pub fn impact(&self) -> Result<Scene, SceneError> {
        self.draft()?.impact()
    }
}

impl Changes {
    /// The scene in a file, or `-` for the standard input, with these fields.
    pub fn draft(&self, path: &Path) -> Result<Draft, SceneError> {
        let draft = if path == Path::new("-") {
            Draft::from_reader(stdin().lock(), "the standard input")?
        } else {
            Draft::read(path)?
        };
        let name = printable(&path.display().to_string());
        note(|| format!("read {name}"));
        self.apply(draft, if name == "-" { "the standard input" } else { &name })
    }

    /// A scene with these fields; `name` is its name at the end of the printed result.
    pub fn apply(&self, mut draft: Draft, name: &str) -> Result<Draft, SceneError> {
        for assignment in &self.set {
            draft.set(assignment)?;
            note(|| format!("set {}", printable(assignment)));
        }
        let changes = self.set.iter().map(|assignment| shorten(&printable(assignment))).collect::<Vec<_>>().join(", ");
        name_scene(if changes.is_empty() { name.to_owned() } else { format!("{name} with {changes}") });
        Ok(draft)
    }
}
