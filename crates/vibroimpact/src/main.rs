//! The command line: scene files in, results out.
//!
//! Exit codes: 0 for a result (sustained contact and a limit reached among them), 2 for input that cannot be used,
//! 1 for results that cannot be written, 130 for a sweep that was asked to stop.

mod infinite_beam;
mod products;
mod sweep_command;

use std::io::{ErrorKind, Write};
use std::path::PathBuf;
use std::process::ExitCode;

use clap::{CommandFactory, Parser, Subcommand, ValueEnum};
use clap_complete::Shell;
use products::Products;
use vibroimpact::emoc::Parameters;
use vibroimpact::export::{self, Failure, Files};
use vibroimpact::model::{self, Answer};
use vibroimpact::net::{self, FitSummary};
use vibroimpact::scene::{self, schema};
use vibroimpact::simulate::{Resolved, Simulation};
use vibroimpact::summary::ModeTable;
use vibroimpact::sweep::SweepError;
use vibroimpact::vibroimpact_sim::modal::Striker;
use vibroimpact::{InvalidInput, Scene, SceneError, pictures, report, text};

const EXAMPLE: &str = r#"A scene is a JSON file (or TOML, by its name); every quantity is in SI units, and its name says which:

  { "structure": { "kind": "beam", "ends": ["pinned", "pinned"], "damping_ratio": 0.02,
                   "segments": [ { "length_m": 1, "youngs_modulus_pa": 2e11, "density_kg_m3": 7800,
                                   "width_m": 0.011323, "thickness_m": 0.011323 } ] },
    "striker":   { "density_kg_m3": 7800, "radius_m": 0.015, "speed_m_s": 1 },
    "contact":   { "law": "hertz", "youngs_modulus_pa": 2e11, "poissons_ratio": 0.3 },
    "location_m": 0.4, "tolerance": 1e-3 }

The model, and how many modes it takes, are the program's choice (see vibroimpact plan --help). Ends are clamped, pinned, free or guided. A segment may give flexural_rigidity_n_m2 and mass_per_length_kg_m
instead. A structure without ends is { "kind": "infinite-beam" } with such a section, or "infinite-plate".
Laws of contact: hertz, viscous, hysteretic, linear-spring, kelvin-voigt, hunt-crossley,
lankarani-nikravesh, flores, elastoplastic. More scenes are in the folder datasets/scenes."#;

const SIMULATE_EXAMPLES: &str = "Examples:
  vibroimpact simulate ball.json                 a summary to read
  vibroimpact simulate ball.json --json          one JSON object for programs
  vibroimpact simulate ball.json --out ball/     CSV histories, the picture impact.svg, result.json
  vibroimpact simulate ball.json --plot ball.png the picture alone; .svg or .png
  vibroimpact simulate ball.json --report b.html a page with pictures and tables that needs no other file

The exit code is 0 for every result, sustained contact and a limit reached among them, 2 for a scene that cannot be
used (the message names the field, its value and what is allowed; nothing is written), 1 if writing fails.";

const PLAN_EXAMPLES: &str = "Examples:
  vibroimpact plan ball.json                     each model: does it apply, expected error, cost
  vibroimpact plan ball.json --json              the same as one JSON object

Nothing costly is solved. A scene chooses with these fields, each of which may be left out:

  \"model\": \"auto\", \"rigid\", \"infinite-beam\", \"modal\" or \"emoc\"
  \"modes\": \"auto\", or the number of modes that the structure is stated to have
  \"tolerance\": accuracy of the restitution, truncation included where modes are chosen; 1e-3";

const COMPARE_EXAMPLES: &str = "Examples:
  vibroimpact compare ball.json                  restitution, uncertainty, cost of every model
  vibroimpact compare ball.json --json           the same as one JSON object
  vibroimpact compare ball.json --plot models.svg
                                                 restitutions with their uncertainties; .svg or .png

Models that do not apply are listed with the reason. Differences are from the model that is known best.";

const MODES_EXAMPLES: &str = "Examples:
  vibroimpact modes ball.json --count 10         frequencies, and shapes at the point of impact
  vibroimpact modes ball.json --count 40 --json  the same as one JSON object of lists
  vibroimpact modes ball.json --count 6 --plot modes.svg
                                                 shapes along the beam, with the place of impact; .svg or .png

Shapes are mass-normalised (kg^-1/2). Rigid-body modes come first, with omega 0.";

const EMOC_EXAMPLES: &str = "Examples:
  vibroimpact emoc ball.json                               all parameters 1, where nothing has been fitted
  vibroimpact emoc ball.json --mu0 0.5 --alpha0 8 --alpha1 0.3 --emoc-modes 50 --json

Nothing is integrated in time: the restitution is that of least kinetic energy after the impact under the law's
inequalities, which has a closed form in the mode shapes at the point of impact,

  e = ebar max(1/(1+Z), (beta0+beta1)/(1+beta0)),   Z = m sum phi_k^2,   t = mu0 Z,   ebar = (t^2+1)/(t^2+t+1),
  beta0 = x/(1+x) with x = alpha0 Z/N,              beta1 = y/(1+y) with y = alpha1 m phi_1^2.

The branch printed is the term that is active. Contact, speed and frequencies do not enter. Parameters for a beam come
from `vibroimpact fit`.";

const FIT_EXAMPLES: &str = "Examples:
  vibroimpact fit measured.csv --scene ball.json           the three parameters, their intervals, the error
  vibroimpact fit measured.csv --scene ball.json --json    the same as one JSON object

The table is comma-separated, its first line names the columns:

  mass_kg,location_m,restitution
  0.0638,0.25,0.41
  0.0638,0.50,0.38

Other columns are ignored. The scene gives the beam; masses and places come from the table. At least three lines are
needed, and they should cover light and heavy strikers. The search starts from many points, because the sum of squares
has several minima. Intervals hold each parameter with 95 % probability if the errors are independent, which those of
a law with three parameters are not: take them as a lower bound on the uncertainty.";

const COMPLETIONS_EXAMPLES: &str = "Examples:
  vibroimpact completions bash > ~/.local/share/bash-completion/completions/vibroimpact
  vibroimpact completions zsh > ~/.zfunc/_vibroimpact         (a folder in fpath, before compinit)
  vibroimpact completions fish > ~/.config/fish/completions/vibroimpact.fish
  vibroimpact completions powershell >> $PROFILE";

const MANUAL_EXAMPLES: &str = "Example:
  vibroimpact manual > ~/.local/share/man/man1/vibroimpact.1";

const SCHEMA_EXAMPLES: &str = "Examples:
  vibroimpact schema scene > scene.schema.json
  vibroimpact schema sweep > sweep.schema.json

A scene that says { \"$schema\": \"scene.schema.json\", ... } is then completed and checked by editors that know JSON
Schema.";

/// What happens when a compact body strikes a slender vibrating one.
#[derive(Parser)]
#[command(version, after_help = EXAMPLE, arg_required_else_help = true)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Resolve one impact: every contact, the rebound, where the energy went
    #[command(after_help = SIMULATE_EXAMPLES)]
    Simulate {
        /// The scene file
        scene: PathBuf,
        /// Print one JSON object in place of the summary
        #[arg(long)]
        json: bool,
        /// Write histories, picture and result into this folder
        #[arg(long, value_name = "DIR")]
        out: Option<PathBuf>,
        #[command(flatten)]
        products: Products,
    },
    /// Say which model would be used and why, and what each would cost
    #[command(after_help = PLAN_EXAMPLES)]
    Plan {
        /// The scene file
        scene: PathBuf,
        /// Print one JSON object in place of the table
        #[arg(long)]
        json: bool,
    },
    /// Answer a scene by every model, side by side
    #[command(after_help = COMPARE_EXAMPLES)]
    Compare {
        /// The scene file
        scene: PathBuf,
        /// Print one JSON object in place of the table
        #[arg(long)]
        json: bool,
        /// Draw restitutions and uncertainties into this file, .svg or .png
        #[arg(long, value_name = "FILE", value_parser = products::picture_file)]
        plot: Option<PathBuf>,
    },
    /// List natural frequencies, and mode shapes at the point of impact
    #[command(after_help = MODES_EXAMPLES)]
    Modes {
        /// The scene file
        scene: PathBuf,
        /// How many modes, from the lowest
        #[arg(long, value_name = "N")]
        count: usize,
        /// Print one JSON object in place of the table
        #[arg(long)]
        json: bool,
        /// Draw the modes into this file, .svg or .png
        #[arg(long, value_name = "FILE", value_parser = products::picture_file)]
        plot: Option<PathBuf>,
    },
    /// Net restitution without integration in time: energy minimisation under outward constraints
    #[command(after_help = EMOC_EXAMPLES)]
    Emoc {
        /// The scene file
        scene: PathBuf,
        /// Moderated mass ratio coefficient, not negative
        #[arg(long, default_value_t = 1.0, allow_negative_numbers = true)]
        mu0: f64,
        /// Modal richness coefficient, not negative
        #[arg(long, default_value_t = 1.0, allow_negative_numbers = true)]
        alpha0: f64,
        /// Slow response coefficient, not negative
        #[arg(long, default_value_t = 1.0, allow_negative_numbers = true)]
        alpha1: f64,
        /// Number of modes in the law; the scene's when left out
        #[arg(long, value_name = "N")]
        emoc_modes: Option<usize>,
        /// Print one JSON object in place of the list
        #[arg(long)]
        json: bool,
    },
    /// Fit the three parameters of `emoc` to a table of restitutions
    #[command(after_help = FIT_EXAMPLES)]
    Fit {
        /// The table (CSV): mass_kg, location_m, restitution
        data: PathBuf,
        /// The scene file that describes the beam
        #[arg(long)]
        scene: PathBuf,
        /// Number of modes in the law
        #[arg(long, value_name = "N", default_value_t = 50)]
        emoc_modes: usize,
        /// Print one JSON object in place of the list
        #[arg(long)]
        json: bool,
    },
    /// Solve the impact on an infinite beam, posed by its one number S or by a scene
    #[command(after_help = infinite_beam::EXAMPLES)]
    InfiniteBeam(infinite_beam::Arguments),
    /// Compute many scenes that differ in some fields: grids, lists, ranges, random draws
    #[command(after_help = sweep_command::SWEEP_EXAMPLES)]
    Sweep(sweep_command::SweepArguments),
    /// Join the parts of a sweep, and prove that none is missing
    #[command(after_help = sweep_command::MERGE_EXAMPLES)]
    Merge(sweep_command::MergeArguments),
    /// Print a script that completes commands and options in a shell
    #[command(after_help = COMPLETIONS_EXAMPLES)]
    Completions {
        /// Which shell
        shell: Shell,
    },
    /// Print the manual page (roff)
    #[command(after_help = MANUAL_EXAMPLES)]
    Manual,
    /// Print the JSON Schema of a kind of input file, for editors
    #[command(after_help = SCHEMA_EXAMPLES)]
    Schema {
        /// The kind of file
        #[arg(value_enum, default_value_t = InputFile::Scene)]
        of: InputFile,
    },
}

/// Files that come in and have a schema.
#[derive(Clone, Copy, ValueEnum)]
enum InputFile {
    /// A scene
    Scene,
    /// A sweep
    Sweep,
}

/// Exit code of a sweep that was asked to stop.
const STOPPED: u8 = 130;

fn main() -> ExitCode {
    match run(Cli::parse().command) {
        Ok(()) => ExitCode::SUCCESS,
        // a reader that has seen enough is no failure
        Err(failure) if is_broken_pipe(&failure) => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("error: {failure}");
            let of_sweep = failure.downcast_ref::<SweepError>();
            if matches!(of_sweep, Some(SweepError::Stopped { .. })) {
                return ExitCode::from(STOPPED);
            }
            let of_input = failure.is::<SceneError>() || failure.is::<InvalidInput>();
            ExitCode::from(if of_input || of_sweep.is_some_and(SweepError::is_of_input) { 2 } else { 1 })
        }
    }
}

fn is_broken_pipe(failure: &Failure) -> bool {
    failure.downcast_ref::<std::io::Error>().is_some_and(|error| error.kind() == ErrorKind::BrokenPipe)
}

/// A fault in the number of modes, which an option gave.
fn of_option(fault: InvalidInput) -> InvalidInput {
    if fault.field == "modes" { InvalidInput { field: "--emoc-modes".to_owned(), ..fault } } else { fault }
}

fn run(command: Command) -> Result<(), Failure> {
    let printed = match command {
        Command::Simulate { scene, json, out, products } => {
            let scene = Scene::read(&scene)?;
            let found = scene.simulate()?;
            let Resolved { impact, summary, history } = match &found {
                Simulation::Modal(resolved) => resolved.as_ref(),
                Simulation::Infinite { groups, solution } => {
                    return print(&infinite_beam::of_scene(&scene, groups, solution, json, out, &products)?);
                }
                Simulation::Net(answer) => {
                    products.refuse(answer.model)?;
                    return print(&without_course(&scene, answer, json, out)?);
                }
            };
            let headline = text::headline(&scene, &impact.striker);
            let mut printed = if json {
                found.json()?
            } else {
                format!(
                    "{headline}

{}",
                    text::result(summary)
                )
            };
            let reason = summary.choice.as_ref().map_or("", |choice| &choice.reason);
            let modelled = report::modelled(&scene, impact, reason);
            let prepared = products.prepare(
                || pictures::impact(&headline, summary, history),
                |figure| report::of_impact(&headline, &scene, &modelled, summary, figure),
            )?;
            if let Some(folder) = out {
                let files = Files::new(&headline, summary, history)?;
                files.write(&folder)?;
                if !json {
                    let names: Vec<&str> = files.names().collect();
                    printed += &format!("\n  wrote {} to {}\n", names.join(", "), folder.display());
                }
            }
            printed + &prepared.write(json)?
        }
        Command::Plan { scene, json } => {
            let scene = Scene::read(&scene)?;
            let plan = scene.plan()?;
            if json { export::json(&plan)? } else { model::plan_text(&plan) }
        }
        Command::Compare { scene, json, plot } => {
            let scene = Scene::read(&scene)?;
            let comparison = scene.compare()?;
            let told = match plot {
                Some(path) => {
                    let figure = pictures::of_comparison(&headline(&scene)?, &comparison);
                    products::Prepared::picture(&path, &figure)?.write(json)?
                }
                None => String::new(),
            };
            let printed = if json { export::json(&comparison)? } else { model::comparison_text(&comparison) };
            printed + &told
        }
        Command::Modes { scene, count, json, plot } => {
            let scene = Scene::read(&scene)?;
            let modes = scene.mode_shapes(count)?;
            let told = match plot {
                Some(path) => products::Prepared::picture(&path, &pictures::modes(&scene, count)?)?.write(json)?,
                None => String::new(),
            };
            let printed = if json { export::json(&ModeTable::new(&modes))? } else { text::modes(&modes) };
            printed + &told
        }
        Command::Emoc { scene, mu0, alpha0, alpha1, emoc_modes, json } => {
            let parameters = Parameters { mu0, alpha0, alpha1, ..Parameters::default() };
            let rebound = Scene::read(&scene)?.emoc(&parameters, emoc_modes);
            let rebound = if emoc_modes.is_some() { rebound.map_err(of_option)? } else { rebound? };
            if json { export::json(&rebound)? } else { text::net_rebound(&rebound) }
        }
        Command::Fit { data, scene, emoc_modes, json } => {
            let scene = Scene::read(&scene)?;
            let observations = scene.observations(&net::read(&data)?, emoc_modes).map_err(of_option)?;
            let fit = FitSummary::new(&observations, emoc_modes)?;
            if json { export::json(&fit)? } else { text::fit(&fit) }
        }
        Command::InfiniteBeam(arguments) => infinite_beam::run(arguments)?,
        Command::Completions { shell } => {
            let mut script = Vec::new();
            clap_complete::generate(shell, &mut Cli::command(), "vibroimpact", &mut script);
            String::from_utf8(script)?
        }
        Command::Manual => {
            let mut page = Vec::new();
            clap_mangen::Man::new(Cli::command()).render(&mut page)?;
            String::from_utf8(page)?
        }
        Command::Schema { of: InputFile::Scene } => schema::text(&schema::of_scenes()),
        Command::Schema { of: InputFile::Sweep } => schema::text(&vibroimpact::sweep::schema()),
        Command::Sweep(arguments) => sweep_command::sweep(arguments)?,
        Command::Merge(arguments) => sweep_command::merge(arguments)?,
    };
    print(&printed)
}

/// A scene in a line.
fn headline(scene: &Scene) -> Result<String, Failure> {
    if scene.is_infinite() {
        return Ok(text::infinite_headline(scene, &scene.infinite_impact()?));
    }
    // that of a dropped rod is not the striker's
    let rod = matches!(scene.structure, scene::Structure::DroppedRod(_));
    let mass_kg = if rod { f64::NAN } else { scene.striker.mass_kg()? };
    Ok(text::headline(scene, &Striker { mass_kg, speed_m_s: scene.striker.speed_m_s }))
}

/// What `simulate` prints, and writes, for a model that has no modal history.
fn without_course(scene: &Scene, answer: &Answer, json: bool, out: Option<PathBuf>) -> Result<String, Failure> {
    let headline = headline(scene)?;
    let result = export::json(answer)?;
    let mut printed = if json { result.clone() } else { format!("{headline}\n\n{}", model::net_text(answer)) };
    if let Some(folder) = out {
        Files::result(result).write(&folder)?;
        if !json {
            printed += &format!("\n  wrote result.json to {}\n", folder.display());
        }
    }
    if !json {
        printed += "\n  This model has no histories; \"model\": \"modal\" resolves the course in time.\n";
    }
    Ok(printed)
}

fn print(printed: &str) -> Result<(), Failure> {
    let mut stdout = std::io::stdout().lock();
    stdout.write_all(printed.as_bytes())?;
    stdout.flush()?;
    Ok(())
}
