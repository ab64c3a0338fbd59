//! The command-line program.
//!
//! Exit codes: 0 for a result (including sustained contact and a computation that stopped), 2 for invalid input (including a
//! sweep none of whose points can be solved), 1 for results that cannot be written, 130 for a sweep that was interrupted.

mod commands;

use std::io::{ErrorKind, Write};
use std::process::ExitCode;

use clap::{CommandFactory, Parser, Subcommand};
use commands::heartbeat::watched;
use commands::products::Unwritten;
use commands::sweep::NoPointSolved;
use commands::voice::Voice;
use commands::{
    choice, first, identify, infinite_beam, law, modes, net, orbit, predictability, sensitivity, shell, simulate,
    sweep, voice,
};
use vibroimpact::export::Failure;
use vibroimpact::sweep::SweepError;
use vibroimpact::text::{printable, shorten};
use vibroimpact::{InvalidInput, SceneError};

/// A short command touches most of its memory once. The system's allocator takes it in small pages, with 600 page faults for a
/// beam of 40 modes and 5,000 for one of 1,000. Each costs 2 µs on some machines; this allocator asks for large pages.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

const EXAMPLE: &str = r#"First steps:
  vibroimpact demo                        a steel ball strikes a steel bar: contacts, rebound, energy
  vibroimpact init                        writes that scene into impact.toml, every field explained
  vibroimpact simulate impact.toml        solves it; --plot impact.svg draws it
  vibroimpact simulate impact.toml --set striker.speed_m_s=2
  vibroimpact plan impact.toml            which model is used, and why

A scene is a TOML or JSON file, as the ending of its name says; - is the standard input. Every quantity is in SI units,
and the name of its field ends in the unit:

  { "structure": { "kind": "beam", "ends": ["pinned", "pinned"], "damping_ratio": 0.01,
                   "segments": [ { "length_m": 1, "width_m": 0.012, "thickness_m": 0.012, "material": "steel" } ] },
    "striker":   { "material": "steel", "radius_m": 0.02, "speed_m_s": 1 },
    "contact":   { "law": "hertz", "material": "steel" },
    "location_m": 0.3, "tolerance": 1e-3 }

Structures: beam, string, plate, modal, modes-file, infinite-beam, infinite-plate, dropped-rod; or many bodies.
Ends: clamped, pinned, free, guided. Materials: steel, aluminium, glass, rubber, wood, or their numbers.
Laws of contact: hertz, viscous, hysteretic, linear-spring, power, felt, kelvin-voigt, hunt-crossley,
lankarani-nikravesh, flores, elastoplastic.

vibroimpact COMMAND --help shows examples of a command, vibroimpact schema the whole format for editors."#;

/// Impacts of a compact body on a slender vibrating one.
#[derive(Parser)]
#[command(version, after_help = EXAMPLE, arg_required_else_help = true)]
struct Cli {
    #[command(subcommand)]
    command: Command,
    /// Print nothing but results and errors: no progress, no names of files
    #[arg(long, short, global = true, conflicts_with = "verbose", help_heading = "Options of every command")]
    quiet: bool,
    /// Also report each step and its time on the standard error
    #[arg(long, short, global = true, help_heading = "Options of every command")]
    verbose: bool,
}

#[derive(Subcommand)]
enum Command {
    /// Solve a built-in scene: a steel ball strikes a steel bar
    #[command(after_help = first::DEMO_EXAMPLES)]
    Demo(first::DemoArguments),
    /// Write a first scene, complete and explained field by field
    #[command(after_help = first::INIT_EXAMPLES)]
    Init(first::InitArguments),
    /// Resolve one impact: every contact, the rebound, the energy balance
    #[command(after_help = simulate::EXAMPLES)]
    Simulate(simulate::Arguments),
    /// Show which model would be used and why, and the cost of each
    #[command(after_help = choice::PLAN_EXAMPLES)]
    Plan(choice::PlanArguments),
    /// Solve a scene with every model, side by side
    #[command(after_help = choice::COMPARE_EXAMPLES)]
    Compare(choice::CompareArguments),
    /// List natural frequencies, and mode shapes at the point of impact
    #[command(after_help = modes::EXAMPLES)]
    Modes(modes::Arguments),
    /// Compute the net restitution without integration in time: energy minimisation under outward constraints
    #[command(after_help = net::EMOC_EXAMPLES)]
    Emoc(net::EmocArguments),
    /// Fit the three parameters of `emoc` to a table of restitutions
    #[command(after_help = net::FIT_EXAMPLES)]
    Fit(net::FitArguments),
    /// Find fields of a scene from measurements: estimates, intervals, and what the data do not determine
    #[command(after_help = identify::EXAMPLES)]
    Identify(identify::Arguments),
    /// Find the parameters of contact laws for a given restitution, exactly and for a fixed step
    #[command(after_help = law::EXAMPLES)]
    Law(law::Arguments),
    /// Solve the impact on an infinite beam, given by its single parameter S or by a scene
    #[command(after_help = infinite_beam::EXAMPLES)]
    InfiniteBeam(infinite_beam::Arguments),
    /// Find the periodic motion of bodies under a harmonic load, and follow it over a field
    #[command(after_help = orbit::EXAMPLES)]
    Orbit(orbit::Arguments),
    /// Differentiate an impact with respect to the numbers of its scene: which are important, and how much
    #[command(after_help = sensitivity::EXAMPLES)]
    Sensitivity(sensitivity::Arguments),
    /// Compute many scenes that differ in some fields: grids, lists, ranges, random draws
    #[command(after_help = sweep::SWEEP_EXAMPLES)]
    Sweep(sweep::SweepArguments),
    /// Map where the restitution can be predicted: its spread over one or two fields if others are uncertain
    #[command(after_help = predictability::EXAMPLES)]
    Predictability(predictability::Arguments),
    /// Join the parts of a sweep, and check that none is missing
    #[command(after_help = sweep::MERGE_EXAMPLES)]
    Merge(sweep::MergeArguments),
    /// Print a script that completes commands and options in a shell
    #[command(after_help = shell::COMPLETIONS_EXAMPLES)]
    Completions(shell::CompletionsArguments),
    /// Print a manual page, or write those of all commands
    #[command(after_help = shell::MANUAL_EXAMPLES)]
    Manual(shell::ManualArguments),
    /// Print the JSON Schema of a kind of input file, for editors
    #[command(after_help = shell::SCHEMA_EXAMPLES)]
    Schema(shell::SchemaArguments),
}

fn main() -> ExitCode {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(fault) => return misused(&fault),
    };
    voice::set(match (cli.quiet, cli.verbose) {
        (true, _) => Voice::Quiet,
        (_, true) => Voice::Verbose,
        _ => Voice::Normal,
    });
    match run(cli.command).and_then(|printed| print(&printed)) {
        Ok(()) => ExitCode::SUCCESS,
        // a reader that closes the pipe early is not an error
        Err(failure) if is_broken_pipe(&failure) => ExitCode::SUCCESS,
        Err(failure) => {
            let no_point = failure.downcast_ref().map(|NoPointSolved { printed, .. }| printed);
            let unwritten = failure.downcast_ref().map(|Unwritten { printed, .. }| printed);
            if let Some(printed) = no_point.or(unwritten) {
                // the results are complete, and are printed as usual
                let _ = print(printed);
            }
            voice::tell(format_args!("error: {}", printable(&failure.to_string())));
            let of_sweep = failure.downcast_ref::<SweepError>();
            if matches!(of_sweep, Some(SweepError::Stopped { .. })) {
                return ExitCode::from(sweep::STOPPED);
            }
            let of_input = failure.is::<SceneError>() || failure.is::<InvalidInput>() || failure.is::<NoPointSolved>();
            ExitCode::from(if of_input || of_sweep.is_some_and(SweepError::is_of_input) { 2 } else { 1 })
        }
    }
}

/// Reports errors of the command line, or prints the requested help. The user's input is not repeated in a form that could
/// control the terminal.
fn misused(fault: &clap::Error) -> ExitCode {
    let hostile = |argument: &String| shorten(&printable(argument)) != *argument;
    let mut typed: Vec<String> = std::env::args_os().map(|argument| argument.to_string_lossy().into_owned()).collect();
    // if an option and its value are one argument, only the value is repeated
    typed.extend(typed.clone().iter().filter_map(|argument| Some(argument.split_once('=')?.1.to_owned())));
    if fault.use_stderr() && typed.iter().any(hostile) {
        let told = typed.iter().fold(fault.render().to_string(), |told, argument| {
            if hostile(argument) { told.replace(argument.as_str(), &shorten(&printable(argument))) } else { told }
        });
        voice::tell(printable(told.trim_end()));
    } else {
        // there is no other place for the message
        let _ = fault.print();
    }
    ExitCode::from(u8::try_from(fault.exit_code()).unwrap_or(2))
}

fn run(command: Command) -> Result<String, Failure> {
    match command {
        Command::Demo(arguments) => first::demo(arguments),
        Command::Init(arguments) => first::init(arguments),
        Command::Simulate(arguments) => simulate::run(arguments),
        Command::Plan(arguments) => watched("plan", || choice::plan(arguments)),
        Command::Compare(arguments) => watched("compare", || choice::compare(arguments)),
        Command::Modes(arguments) => watched("modes", || modes::run(arguments)),
        Command::Emoc(arguments) => watched("emoc", || net::emoc(arguments)),
        Command::Fit(arguments) => watched("fit", || net::fit(arguments)),
        Command::Identify(arguments) => watched("identify", || identify::run(arguments)),
        Command::InfiniteBeam(arguments) => watched("infinite-beam", || infinite_beam::run(arguments)),
        Command::Law(arguments) => law::run(arguments),
        Command::Orbit(arguments) => watched("orbit", || orbit::run(arguments)),
        Command::Sensitivity(arguments) => watched("sensitivity", || sensitivity::run(arguments)),
        Command::Sweep(arguments) => sweep::sweep(arguments),
        Command::Predictability(arguments) => predictability::run(arguments),
        Command::Merge(arguments) => sweep::merge(arguments),
        Command::Completions(arguments) => shell::completions(arguments, Cli::command()),
        Command::Manual(arguments) => shell::manual(arguments, Cli::command()),
        Command::Schema(arguments) => Ok(shell::schema_of(arguments)),
    }
}

fn is_broken_pipe(failure: &Failure) -> bool {
    failure.downcast_ref::<std::io::Error>().is_some_and(|error| error.kind() == ErrorKind::BrokenPipe)
}

fn print(printed: &str) -> Result<(), Failure> {
    let mut stdout = std::io::stdout().lock();
    stdout.write_all(printed.as_bytes())?;
    stdout.flush()?;
    Ok(())
}
