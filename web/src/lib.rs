//! Solves one impact in a web page: the input is a scene as JSON, the output is JSON for the page.
//!
//! The page and this library share two texts in the memory of the module. The page calls [`reserve`], writes the scene at the
//! address that it returns, calls [`solve`], and reads the returned number of bytes at [`answer`]. No tool for bindings is
//! needed.

use std::cell::RefCell;

use serde::Serialize;
use serde_json::Value;
use vibroimpact::Scene;
use vibroimpact::deflection::Deflection;
use vibroimpact::emoc::Parameters;
use vibroimpact::export::Failure;
use vibroimpact::simulate::Simulation;

/// Number of intervals of length and of time for the deflection.
const PIECES: [usize; 2] = [60, 300];
/// Number of modes that are listed and played.
const LISTED_MODES: usize = 12;

/// The data for the page.
#[derive(Serialize)]
struct Drawing {
    /// The object that `vibroimpact simulate --json` prints.
    result: Value,
    /// The motion; null if there is no beam that moves.
    deflection: Option<Deflection>,
    /// Time (s) and contact force (N) with every step in contact.
    force: Option<[Vec<f64>; 2]>,
    /// The first elastic modes: frequency (Hz), damping ratio, and energy at the end (J).
    modes: Vec<[f64; 3]>,
    /// Net restitution by the law of energy minimisation under outward constraints; null if it does not apply.
    emoc: Option<f64>,
}

/// Solves a scene; an error as an object with the field `error`.
pub fn solve_text(scene: &str) -> String {
    solved(scene).unwrap_or_else(|fault| serde_json::json!({ "error": fault.to_string() }).to_string())
}

fn solved(scene: &str) -> Result<String, Failure> {
    let posed = Scene::from_json(scene)?;
    let found = posed.simulate()?;
    let scene = found.scene(&posed);
    let result = serde_json::from_str(&found.json(&posed)?)?;
    let (mut deflection, mut modes) = (None, Vec::new());
    if let Simulation::Modal(resolved) = &found {
        deflection = resolved.deflection(&scene, resolved.until_s(None), PIECES)?;
        let energies = resolved.history.energy_ledger().modes_j;
        let elastic = resolved.impact.structure.modes.iter().zip(energies).filter(|(mode, _)| mode.omega_rad_s > 0.0);
        let listed = |(mode, energy_j): (&vibroimpact::vibroimpact_sim::modal::Mode, f64)| {
            [mode.omega_rad_s / std::f64::consts::TAU, mode.damping_ratio, energy_j]
        };
        modes = elastic.map(listed).take(LISTED_MODES).collect();
    }
    let history = found.history(None);
    let column =
        |name: &str| history.as_ref()?.columns.iter().find(|(own, _)| own == name).map(|(_, values)| values.clone());
    let force = column("time_s").zip(column("force_n")).map(|(time, force)| [time, force]);
    let emoc = posed.emoc(&Parameters::default(), None).ok().map(|rebound| rebound.restitution);
    Ok(serde_json::to_string(&Drawing { result, deflection, force, modes, emoc })?)
}

thread_local! {
    static SCENE: RefCell<Vec<u8>> = const { RefCell::new(Vec::new()) };
    static ANSWER: RefCell<String> = const { RefCell::new(String::new()) };
}

/// Allocates memory for a scene of this number of bytes of UTF-8, and returns its address.
#[unsafe(no_mangle)]
pub extern "C" fn reserve(bytes: usize) -> *mut u8 {
    SCENE.with_borrow_mut(|scene| {
        scene.clear();
        scene.resize(bytes, 0);
        scene.as_mut_ptr()
    })
}

/// Solves the scene in this memory, and returns the number of bytes of the result.
#[unsafe(no_mangle)]
pub extern "C" fn solve() -> usize {
    let solved = SCENE.with_borrow(|scene| solve_text(&String::from_utf8_lossy(scene)));
    ANSWER.with_borrow_mut(|answer| {
        *answer = solved;
        answer.len()
    })
}

/// Address of the result.
#[unsafe(no_mangle)]
pub extern "C" fn answer() -> *const u8 {
    ANSWER.with_borrow(|answer| answer.as_ptr())
}
