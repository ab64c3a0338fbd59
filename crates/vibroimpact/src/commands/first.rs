//! The first steps of a new user: `demo` solves a built-in scene, `init` writes one to start from.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use vibroimpact::draft::Draft;
use vibroimpact::export::Failure;
use vibroimpact::text::printable;

use super::products::{Products, require_free, write_single};
use super::simulate;
use super::source::Changes;

pub const DEMO_EXAMPLES: &str = "Examples:
  vibroimpact demo                               prints a summary of the impact
  vibroimpact demo --plot demo.svg               also draws a picture
  vibroimpact demo --animate demo.svg            also writes an animation of beam and ball, for a browser
  vibroimpact demo --report demo.html            also writes a page with pictures and tables
  vibroimpact demo --set location_m=0.5          the same impact at another location
  vibroimpact init                               writes this scene into a file that you can change

A steel ball of 40 mm strikes a steel bar on two supports at 1 m/s. No file is written unless an option names one.";

pub const INIT_EXAMPLES: &str = "Examples:
  vibroimpact init                               a ball on a beam, into impact.toml
  vibroimpact init --kind plate pane.toml        a ball on a plate, into pane.toml
  vibroimpact init - | vibroimpact simulate -    writes to the standard output, and solves the scene at once

The file is complete, and each of its fields is explained in it. Change a line, and solve it again.";

/// The forms of the result of the built-in scene.
#[derive(Args)]
pub struct DemoArguments {
    #[command(flatten)]
    changes: Changes,
    #[command(flatten)]
    products: Products,
    #[command(flatten)]
    extent: simulate::Extent,
}

/// The scene to write, and its file.
#[derive(Args)]
pub struct InitArguments {
    /// The file to write, which ends in .toml; - is the standard output
    #[arg(default_value = "impact.toml", value_parser = toml_file)]
    file: PathBuf,
    /// The kind of scene
    #[arg(long, value_enum, default_value_t = Kind::Beam)]
    kind: Kind,
    /// Replace the file if it exists
    #[arg(long)]
    force: bool,
}

/// The built-in scenes.
#[derive(Clone, Copy, ValueEnum)]
enum Kind {
    /// A beam on two supports, struck by a ball
    Beam,
    /// A stepped cantilever with a mass at its tip, struck by a ball
    Cantilever,
    /// A plate held along its edges, struck by a ball
    Plate,
    /// A ball that bounces on a beam
    Bodies,
}

impl Kind {
    fn scene(self) -> &'static str {
        match self {
            Kind::Beam => include_str!("scenes/beam.toml"),
            Kind::Cantilever => include_str!("scenes/cantilever.toml"),
            Kind::Plate => include_str!("scenes/plate.toml"),
            Kind::Bodies => include_str!("scenes/bodies.toml"),
        }
    }
}

fn toml_file(name: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(name);
    let is_toml = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("toml"));
    if is_toml || name == "-" { Ok(path) } else { Err("it must be a file name that ends in .toml, or -".to_owned()) }
}

/// Runs `demo` and returns the text to print.
pub fn demo(DemoArguments { changes, extent, products }: DemoArguments) -> Result<String, Failure> {
    products.require_room(&[], &[extent.output()])?;
    let scene = changes.apply(Draft::from_text(Kind::Beam.scene())?, "the built-in scene")?.any()?;
    let json = products.json;
    let printed = simulate::answer(scene, extent, &products)?;
    Ok(if json { printed } else { printed + NEXT })
}

const NEXT: &str = "
  next
    vibroimpact demo --plot demo.svg           draws this impact
    vibroimpact demo --set location_m=0.5      strikes the beam in the middle
    vibroimpact init                           writes the scene, with comments, to change it
";

/// Runs `init` and returns the text to print.
pub fn init(InitArguments { file, kind, force }: InitArguments) -> Result<String, Failure> {
    if file == Path::new("-") {
        return Ok(kind.scene().to_owned());
    }
    require_free("FILE", Some(&file), force)?;
    let name = printable(&file.display().to_string()).replace('\n', " ");
    // the comments refer to the file by its name
    let scene = kind.scene().replace("impact.toml", &name);
    let mut told = String::new();
    write_single(&mut told, &file, scene.as_bytes(), false)?;
    Ok(if told.is_empty() { told } else { format!("{told}  solve it with: vibroimpact simulate {name}\n") })
}
