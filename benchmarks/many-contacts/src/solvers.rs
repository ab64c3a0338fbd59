//! The solvers. Each gives the state at the end and the least time of repeated runs.

use crate::problem::Problem;
use crate::system::{Harmonic, Row, System};
use ivp::prelude::{Direction, EventConfig, FirstOrderSystem, Ivp, Method};
use std::fmt::Write;
use std::fs;
use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};
use vibroimpact_sim::assembly::{Settings, Solver};

/// What a solver says that was stopped.
pub const TOO_SLOW: &str = "too slow";

/// What a solver found.
#[derive(Debug, Clone, PartialEq)]
pub struct Found {
    /// Amplitudes, then rates.
    pub state: Vec<f64>,
    /// Least time of a run (s).
    pub time_s: f64,
}

/// Runs are repeated until they have taken so long together.
const BUDGET: Duration = Duration::from_millis(300);

fn least(mut run: impl FnMut() -> Result<Vec<f64>, String>) -> Result<Found, String> {
    let begun = Instant::now();
    let mut found = Found { state: Vec::new(), time_s: f64::INFINITY };
    while found.state.is_empty() || begun.elapsed() < BUDGET {
        let clock = Instant::now();
        found.state = run()?;
        found.time_s = found.time_s.min(clock.elapsed().as_secs_f64());
    }
    Ok(found)
}

/// The engine, its tables built anew in every run.
///
/// # Errors
/// A run that did not come to its end.
pub fn own(problem: &Problem, tolerance: f64) -> Result<Found, String> {
    let settings = Settings { tolerance, stop_at_rest: false, ..Settings::until(problem.end_s) };
    least(|| {
        let mut solver = Solver::new(&problem.assembly).map_err(|fault| fault.to_string())?;
        let run = solver.run(&settings, &mut ()).map_err(|fault| fault.to_string())?;
        if run.end_s < problem.end_s {
            return Err(format!("{:?} at {} s", run.outcome, run.end_s));
        }
        Ok(run.amplitude.concat().into_iter().chain(run.rate.concat()).collect())
    })
}

/// A smooth phase: these contacts are closed, time is counted from its start.
struct Phase<'a> {
    system: &'a System,
    closed: &'a [bool],
    start_s: f64,
}

impl FirstOrderSystem for Phase<'_> {
    fn derivative(&self, t: f64, y: &[f64], dy: &mut [f64]) {
        self.system.rates(self.start_s + t, y, self.closed, dy);
    }

    fn events(&self, _: f64, y: &[f64], out: &mut [f64]) {
        for (c, out) in out.iter_mut().enumerate() {
            *out = self.system.overlap(c, y);
        }
    }

    fn n_events(&self) -> usize {
        self.closed.len()
    }

    fn event_config(&self, contact: usize) -> EventConfig {
        let mut config = EventConfig::new();
        config.terminal();
        config.direction(if self.closed[contact] { Direction::Negative } else { Direction::Positive });
        config
    }
}

/// DOP853 with root finding on its dense output.
///
/// # Errors
/// Why it could not go on.
pub fn dop853(system: &System, size: f64, tolerance: f64, deadline: Instant) -> Result<Found, String> {
    least(|| {
        let (mut y, mut start_s) = (system.start.clone(), 0.0);
        // touching at the start, with an approach
        let mut closed: Vec<bool> = (0..system.contacts.len()).map(|c| system.overlap(c, &y) >= 0.0).collect();
        loop {
            if Instant::now() > deadline {
                return Err(TOO_SLOW.into());
            }
            let length = system.end_s - start_s;
            let phase = Phase { system, closed: &closed, start_s };
            let solution = Ivp::first_order(&phase, 0.0, length, &y)
                .method(Method::DOP853)
                .rtol(1e-14)
                .atol(system.tolerances(tolerance, size))
                .max_steps(100_000_000)
                .t_eval(vec![length])
                .solve()
                .map_err(|fault| fault.to_string())?;
            let event = |c: usize| Some((c, *solution.t_events.get(c)?.first()?, solution.y_events.get(c)?.first()?));
            let first = (0..closed.len()).filter_map(event).min_by(|a, b| a.1.total_cmp(&b.1));
            match first {
                Some((contact, time, state)) => {
                    (start_s, y) = (start_s + time, state.clone());
                    closed[contact] = !closed[contact];
                }
                None => return solution.y.last().cloned().ok_or_else(|| format!("{:?}", solution.status)),
            }
        }
    })
}

/// The text that `cvode/solve.c` reads.
fn exported(system: &System, size: f64) -> String {
    let mut text = String::new();
    let mut line = |values: &[f64]| {
        for value in values {
            // a String does not fail to be written
            let _ = write!(text, "{value:e} ");
        }
        text.push('\n');
    };
    let counts = [system.modes(), system.contacts.len(), system.harmonics.len()].map(|count| count as f64);
    line(&counts);
    line(&[system.end_s, size]);
    for values in [&system.omega_2, &system.damping, &system.start, &system.constant] {
        line(values);
    }
    for Row { law, gap_m, first, psi } in &system.contacts {
        line(&[2.0 * law.exponent, law.stiffness, law.damping_s_m, *gap_m, *first as f64, psi.len() as f64]);
        line(psi);
    }
    for Harmonic { omega_rad_s, phase_rad, amplitude } in &system.harmonics {
        line(&[*omega_rad_s, *phase_rad]);
        line(amplitude);
    }
    text
}

/// CVODE by the program built from `cvode/solve.c`; `formula` is `adams` or `bdf`.
///
/// # Errors
/// Why it could not go on.
pub fn cvode(
    program: &Path,
    folder: &Path,
    system: &System,
    size: f64,
    formula: &str,
    tolerance: f64,
) -> Result<Found, String> {
    let file = folder.join("problem.txt");
    fs::write(&file, exported(system, size)).map_err(|fault| fault.to_string())?;
    let budget = BUDGET.as_secs_f64().to_string();
    let output = Command::new(program).arg(&file).args([formula, &tolerance.to_string(), &budget]).output();
    let output = output.map_err(|fault| fault.to_string())?;
    if !output.status.success() {
        return Err(String::from_utf8_lossy(&output.stderr).trim().to_owned());
    }
    let printed = String::from_utf8_lossy(&output.stdout);
    let mut numbers = printed.split_whitespace().map(|word| word.parse::<f64>().map_err(|fault| fault.to_string()));
    let time_s = numbers.next().ok_or("nothing was printed")??;
    // evaluations of the right-hand side
    numbers.next().ok_or("nothing but a time was printed")??;
    Ok(Found { state: numbers.collect::<Result<_, _>>()?, time_s })
}
