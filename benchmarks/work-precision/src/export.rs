//! The problems as plain text, for the solvers outside Rust and for the reference.

use crate::impact::Impact;
use crate::net;
use contact_models::Law;
use std::fmt::Write;
use std::path::Path;

/// The text of one impact: a name and a value on each line, then a line for each mode (`omega_rad_s`, damping ratio, shape).
/// Every number is read back to the last bit.
///
/// # Errors
/// If the readers do not support the law.
pub fn text(impact: &Impact) -> Result<String, String> {
    let parameters = match impact.law {
        Law::Hertz(law) => [law.stiffness_n_m1_5, 0.0, 0.0, 0.0, 0.0],
        Law::Viscous(law) => [law.stiffness_n_m1_5, law.damping_s_m, 0.0, 0.0, 0.0],
        Law::Hysteretic(law) => [law.stiffness_n_m1_5, law.theta_m, law.beta, law.k_bar, law.epsilon_m],
        other => return Err(format!("no text form for the law {}", other.name())),
    };
    let mut text = String::new();
    let mut line = |arguments: std::fmt::Arguments<'_>| {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{arguments}");
    };
    line(format_args!("name {}", impact.name));
    line(format_args!("mass_kg {:e}", impact.striker.mass_kg));
    line(format_args!("speed_m_s {:e}", impact.striker.speed_m_s));
    let parameters: Vec<String> = parameters.iter().map(|value| format!("{value:e}")).collect();
    line(format_args!("law {} {}", impact.law.name(), parameters.join(" ")));
    line(format_args!("modes {}", impact.structure.modes.len()));
    for mode in &impact.structure.modes {
        line(format_args!("{:e} {:e} {:e}", mode.omega_rad_s, mode.damping_ratio, mode.shape));
    }
    Ok(text)
}

/// Writes `impact-NAME.txt` for every impact into a folder, and `program-NAME.txt` for every quadratic program.
///
/// # Errors
/// If a file cannot be written.
pub fn write(impacts: &[Impact], folder: &Path) -> Result<(), String> {
    std::fs::create_dir_all(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let write = |name: String, text: String| {
        let path = folder.join(name);
        std::fs::write(&path, text).map_err(|error| format!("{}: {error}", path.display()))
    };
    for impact in impacts {
        write(format!("impact-{}.txt", impact.name), text(impact)?)?;
    }
    net::texts().into_iter().try_for_each(|(name, text)| write(format!("program-{name}.txt"), text))
}
