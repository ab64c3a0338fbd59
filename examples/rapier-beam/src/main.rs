//! Balls dropped on a vibrating bar in the physics engine rapier.
//!
//! A physics engine has one restitution for each pair of bodies. On a bar this is wrong by a large factor that depends on the
//! location. Here the engine evaluates the EMOC law at each new contact, through its hook for contacts; the law takes some
//! nanoseconds. The results are compared with those of the engine with the best constant for each ball, and with bounces whose
//! contacts are all resolved. A second table follows the bar's motion from bounce to bounce.

mod beam;
mod drops;
mod engine;
mod ringing;

use beam::{Ball, Bar, LENGTH_M, Law};
use drops::{BALLS, COMPARED, DROP_M, fitted};
use std::error::Error;
use std::fmt::Write as _;

/// Number of bounces.
const BOUNCES: usize = 4;

/// Damping ratio of every mode.
const DAMPING: f64 = 0.01;

fn main() -> Result<(), Box<dyn Error>> {
    print!("{}\n{}", tables()?, ringing::table()?);
    Ok(())
}

/// The whole output of the program.
fn tables() -> Result<String, Box<dyn Error>> {
    let mut out = String::new();
    let bar = Bar::new(DAMPING)?;
    let law = fitted(&bar)?;
    let p = law.parameters;
    writeln!(out, "law for all balls: mu0 {:.3}, alpha0 {:.3}, alpha1 {:.3}", p.mu0, p.alpha0, p.alpha1)?;
    for ball in BALLS {
        writeln!(out, "\nball of {:.0} mm, {:.0} g\n", 2e3 * ball.radius_m, 1e3 * ball.mass_kg())?;
        writeln!(out, "                              height (mm) of successive bounces from {:.0} mm", 1e3 * DROP_M)?;
        writeln!(
            out,
            "   x (mm)  e resolved    EMOC       resolved               rapier, EMOC           rapier, constant"
        )?;
        let rows = compare(&bar, &law, ball)?;
        for row in &rows {
            let heights = |of: &dyn Fn(usize) -> Option<f64>| -> String {
                (0..3).map(|i| of(i).map_or(format!("{:>7}", "-"), |h| format!("{:7.1}", 1e3 * h))).collect()
            };
            writeln!(
                out,
                "{:9.1}{:12.3}{:8.3}   {}   {}   {}",
                1e3 * row.x_m,
                row.resolved[0].restitution,
                row.law,
                heights(&|i| row.resolved.get(i).map(|bounce| bounce.height_m)),
                heights(&|i| row.with_law.get(i).map(|bounce| bounce.height_m)),
                heights(&|i| row.with_constant.get(i).map(|bounce| bounce.height_m)),
            )?;
        }
        writeln!(
            out,
            "mean error of the restitution: EMOC {:.3}, constant {:.3}; resolved bounces last up to {:.1} ms",
            mean_error(&rows, |row| &row.with_law),
            mean_error(&rows, |row| &row.with_constant),
            1e3 * rows.iter().flat_map(|row| &row.resolved).map(|bounce| bounce.duration_s).fold(0.0, f64::max),
        )?;
    }
    Ok(out)
}

/// The results for a ball dropped at a location.
struct Row {
    x_m: f64,
    /// Restitution by the law.
    law: f64,
    resolved: Vec<beam::Bounce>,
    with_law: Vec<engine::Bounce>,
    with_constant: Vec<engine::Bounce>,
}

fn compare(bar: &Bar, law: &Law, ball: Ball) -> Result<Vec<Row>, Box<dyn Error>> {
    let locations: Vec<f64> = (1..=COMPARED).map(|i| 0.5 * LENGTH_M * i as f64 / COMPARED as f64).collect();
    let resolved = locations.iter().map(|&x| bar.bounces(ball, x, DROP_M, BOUNCES)).collect::<Result<Vec<_>, _>>()?;
    // The constant that fits these locations best: more than the author of a game would know.
    let constant = resolved.iter().map(|bounces| bounces[0].restitution).sum::<f64>() / COMPARED as f64;
    let at = |x| law.restitution(ball.mass_kg(), x);
    let row = |(x_m, resolved): (f64, Vec<beam::Bounce>)| Row {
        x_m,
        law: at(x_m),
        resolved,
        with_law: engine::bounces(ball, x_m, DROP_M, BOUNCES, at),
        with_constant: engine::bounces(ball, x_m, DROP_M, BOUNCES, |_| constant),
    };
    Ok(locations.into_iter().zip(resolved).map(row).collect())
}

/// Error of the engine's first bounce, compared with the resolved one.
fn mean_error(rows: &[Row], bounces: impl Fn(&Row) -> &[engine::Bounce]) -> f64 {
    let error = |row| (bounces(row)[0].restitution() - row.resolved[0].restitution).abs();
    rows.iter().map(error).sum::<f64>() / rows.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_book_shows_what_is_printed() {
        let page = include_str!("../../../docs/how-to/physics-engine.md");
        let tables = tables().unwrap();
        assert!(page.contains(&format!("```text\n{tables}```")), "{tables}");
        let table = ringing::table().unwrap();
        assert!(page.contains(&format!("```text\n{table}```")), "{table}");
    }

    #[test]
    fn the_engine_rebounds_by_the_law() {
        let bar = Bar::new(DAMPING).unwrap();
        let law = fitted(&bar).unwrap();
        for ball in BALLS {
            for x in [0.02, 0.07, 0.11, 0.15, 0.23, 0.28] {
                let bounces = engine::bounces(ball, x, DROP_M, 2, |x| law.restitution(ball.mass_kg(), x));
                assert_eq!(bounces.len(), 2);
                for bounce in bounces {
                    let wanted = law.restitution(ball.mass_kg(), x) * bounce.speed_before_m_s;
                    // Gravity also acts during the step of the contact.
                    let step = beam::GRAVITY_M_S2 * engine::STEP_S;
                    assert!((bounce.speed_after_m_s - wanted).abs() <= step, "{} {wanted}", bounce.speed_after_m_s);
                }
            }
        }
    }

    #[test]
    fn the_law_is_closer_to_the_resolved_bounce_than_the_best_constants() {
        let bar = Bar::new(DAMPING).unwrap();
        let law = fitted(&bar).unwrap();
        let (mut of_law, mut of_constant) = (0.0, 0.0);
        for ball in BALLS {
            let rows = compare(&bar, &law, ball).unwrap();
            of_law += mean_error(&rows, |row| &row.with_law);
            of_constant += mean_error(&rows, |row| &row.with_constant);
        }
        assert!(of_law < of_constant, "{of_law} {of_constant}");
    }
}
