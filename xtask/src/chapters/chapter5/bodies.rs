//! The small examples: two bodies at a point (5.2), the rod of Fig. 5.1, the ball of Fig. 5.2.

use crate::chapters::statement::Statement;
use crate::chapters::study::Study;
use emoc::{Coefficients, Contact, Friction, Problem, Solver};
use serde::Serialize;
use tasks::Failure;
use vibroimpact::plot::{Axis, Colour, Figure, Panel, Series};
use vibroimpact::report::significant;

fn contact(friction: Friction, ebar: f64) -> Contact {
    Contact { friction, coefficients: Coefficients { ebar, beta0: 0.0, beta1: 0.0 } }
}

pub(super) fn run(study: &mut Study) -> Result<(), Failure> {
    two_bodies(study)?;
    rod_on_a_table(study)?;
    dropped_ball(study)
}

/// A uniform rod of 1 kg and 1 m whose end strikes a ball of 0.5 kg in the plane. The rod is inclined at this angle (rad) to
/// the surface of the ball and moves along the normal at 1 m/s.
fn oblique(angle: f64, contact: Contact) -> Result<Problem, Failure> {
    let (mass_kg, half_m, ball_kg) = (1.0, 0.5_f64, 0.5);
    let inertia = mass_kg * (2.0 * half_m).powi(2) / 12.0;
    // velocities: the rod's centre along normal and tangent, its rotation, the ball's centre along both
    let masses = [mass_kg, mass_kg, inertia, ball_kg, ball_kg];
    let mut matrix = vec![0.0; 25];
    for (k, mass) in masses.into_iter().enumerate() {
        matrix[6 * k] = mass;
    }
    let (along, across) = (half_m * angle.sin(), half_m * angle.cos());
    // the ball is smooth: without friction it does not rotate, so its rotation is left out
    let jacobian = [1.0, 0.0, -across, -1.0, 0.0, 0.0, 1.0, along, 0.0, -1.0];
    Ok(Problem::from_bodies(vec![contact], &matrix, &jacobian, &[-1.0, 0.0, 0.0, 0.0, 0.0], Vec::new())?)
}

/// Eq. 5.1 for two bodies.
fn two_bodies(study: &mut Study) -> Result<(), Failure> {
    study.section("Two bodies that touch at a point (Eq. 5.1)");
    let mut solver = Solver::new();
    let (mut worst, mut gained) = (0.0_f64, f64::NEG_INFINITY);
    let mut lines = Vec::new();
    for friction in [0.0, 0.3] {
        let friction = Friction::Planar { coefficient: friction };
        for (name, ebar) in
            [("least energy (Todorov)", None), ("Eq. 5.2, e = 0.5", Some(0.5)), ("Eq. 5.2, e = 1", Some(1.0))]
        {
            let problem = oblique(1.0, contact(friction, ebar.unwrap_or(0.0)))?;
            let solution = match ebar {
                None => solver.least_energy(&problem)?,
                Some(_) => solver.solve(&problem)?,
            };
            let (w, p) = (&problem.inverse_inertia_per_kg, &solution.impulse_n_s);
            for i in 0..2 {
                let change = w[2 * i] * p[0] + w[2 * i + 1] * p[1];
                worst = worst.max((solution.velocity_m_s[i] - problem.velocity_m_s[i] - change).abs());
            }
            gained = gained.max(solution.energy_change_j);
            let numbers = [p[0], p[1], solution.velocity_m_s[0], solution.velocity_m_s[1], solution.energy_change_j];
            let cells = numbers.map(|number| significant(number, 3));
            lines.push([vec![friction.coefficient().to_string(), name.to_owned()], cells.to_vec()].concat());
        }
    }
    study.table(
        &[
            "µ",
            "law",
            "normal impulse (N s)",
            "tangential (N s)",
            "v_n after (m/s)",
            "v_t after (m/s)",
            "energy change (J)",
        ],
        &lines,
    );
    study.text(
        "One end of a rod of 1 kg and 1 m meets a ball of 0.5 kg at 1 m/s along the normal; the rod is inclined at 57° \
         to the surface. The impulse P changes the relative velocity of the contact points by W P, where W is the \
         inverse of the inertia M_C of Eq. 5.1. W has tangential entries, so that a normal impulse alone makes the \
         ends slide.",
    );
    study.state(Statement::identity(
        "largest |Δv_C − M_C⁻¹ P| of six impacts of two bodies (m/s)",
        ["5.2, Eq. 5.1", "P = M_C Δv_C", "rounding"],
        (0.0, 1e-12),
        worst,
    ));
    study.state(Statement::identity(
        "largest gain of energy in six impacts of two bodies (J)",
        ["5.2.2", "the post-impact kinetic energy should not exceed the pre-impact kinetic energy", "rounding"],
        (f64::NEG_INFINITY, 1e-12),
        gained,
    ));
    Ok(())
}

/// Fig. 5.1 for one ratio of the masses.
#[derive(Serialize)]
struct RodRow {
    ball_over_rod: f64,
    impulse_by_equality_n_s: f64,
    right_end_lcp_m_s: f64,
    right_end_least_energy_m_s: f64,
}

/// Fig. 5.1: a ball falls on the left end of a rod of 1 kg and 1 m whose right end rests on a table.
fn rod_on_a_table(study: &mut Study) -> Result<(), Failure> {
    study.section("A ball on one end of a rod, the other on a table (Fig. 5.1)");
    let mut solver = Solver::new();
    let mut rows = Vec::new();
    for k in 0..=40 {
        let ball_over_rod = 10f64.powf(-2.0 + 0.1 * f64::from(k));
        // velocities: ball, the rod's centre, its rotation; contacts: ball on the left end, right end on the table
        let masses = [ball_over_rod, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0 / 12.0];
        let jacobian = [1.0, -1.0, 0.5, 0.0, 1.0, 0.5];
        let contacts = vec![contact(Friction::None, 1.0), contact(Friction::None, 1.0)];
        let problem = Problem::from_bodies(contacts, &masses, &jacobian, &[-1.0, 0.0, 0.0], Vec::new())?;
        let w = &problem.inverse_inertia_per_kg;
        // Newton's rule as an equality: the left contact reverses its speed of approach, the speed of the right one remains zero
        let determinant = w[0] * w[3] - w[1] * w[2];
        let impulse_by_equality_n_s = -2.0 * w[2] / determinant;
        let lcp = emoc::lcp::newton_impact(&problem)?.ok_or("no solution of the complementarity problem")?;
        let least = solver.solve(&problem)?;
        rows.push(RodRow {
            ball_over_rod,
            impulse_by_equality_n_s,
            right_end_lcp_m_s: lcp.opening_m_s[1],
            right_end_least_energy_m_s: least.opening_m_s[1],
        });
    }
    study.csv("fig-5-01.csv", &rows)?;
    let column = |of: fn(&RodRow) -> f64| rows.iter().map(of).collect::<Vec<f64>>();
    let x = column(|row| row.ball_over_rod);
    let mass = Axis::new("mass of the ball / mass of the rod").log();
    let impulse = Panel::new(mass.clone(), Axis::new("impulse of the table").unit("N s"))
        .title("(a) what v_f = −e v_i demands")
        .height(200.0)
        .with(Series::horizontal_rule(0.0))
        .with(Series::line(&x, &column(|row| row.impulse_by_equality_n_s)).colour(Colour::Vermilion));
    let speed = Panel::new(mass, Axis::new("speed of the right end").unit("m/s"))
        .title("(b) what v_f ≥ −e v_i allows")
        .height(200.0)
        .with(Series::line(&x, &column(|row| row.right_end_lcp_m_s)).colour(Colour::Blue).label("LCP"))
        .with(
            Series::line(&x, &column(|row| row.right_end_least_energy_m_s))
                .colour(Colour::Black)
                .dashed()
                .label("least energy"),
        );
    study.figure(
        "fig-5-01",
        &Figure::new("Fig. 5.1  A ball falls at 1 m/s on one end of a rod").row([impulse, speed]).width(860.0),
        "Newton's rule as an equality keeps the right end on the table, which would have to pull it down. The \
         inequality lets it rise.",
    )?;
    let largest = |values: Vec<f64>| values.into_iter().fold(f64::NEG_INFINITY, f64::max);
    let least = |values: Vec<f64>| values.into_iter().fold(f64::INFINITY, f64::min);
    study.state(Statement::identity(
        "largest impulse of the table that v_f = −e v_i demands, ball from 0.01 to 100 of the rod's mass (N s)",
        ["5.2.1, Fig. 5.1", "since v_i,n = 0, no finite e can model the impact", "a table cannot pull"],
        (f64::NEG_INFINITY, 0.0),
        largest(column(|row| row.impulse_by_equality_n_s)),
    ));
    study.state(Statement::identity(
        "least speed at which the right end rises under the inequality, LCP and least energy (m/s)",
        ["5.2.1, Fig. 5.1", "new separation at a pre-existing stationary contact", "the end separates from the table"],
        (0.0, f64::INFINITY),
        least(column(|row| row.right_end_lcp_m_s.min(row.right_end_least_energy_m_s))),
    ));
    Ok(())
}

/// Fig. 5.2: least energy of a ball on a rigid surface, with and without Eq. 5.2.
fn dropped_ball(study: &mut Study) -> Result<(), Failure> {
    study.section("A ball on a rigid surface (Fig. 5.2)");
    let mut solver = Solver::new();
    let (mut worst, mut without) = (0.0_f64, 0.0_f64);
    for k in 0..=10 {
        let e = f64::from(k) / 10.0;
        let problem = Problem {
            contacts: vec![contact(Friction::None, e)],
            inverse_inertia_per_kg: vec![1.0],
            velocity_m_s: vec![-1.0],
            modes: Vec::new(),
        };
        worst = worst.max((solver.solve(&problem)?.velocity_m_s[0] - e).abs());
        without = without.max(solver.least_energy(&problem)?.velocity_m_s[0].abs());
    }
    study.text("Least energy under Eq. 5.2 gives v_f = −e v_i; without it the ball stays on the surface.");
    let texts =
        ["5.3, Fig. 5.2", "minimising the energy under Eq. 5.2 we obtain v_f = −e v_i", "the quadratic program"];
    study.state(Statement::identity("largest |v_f + e v_i|, e from 0 to 1", texts, (0.0, 1e-9), worst));
    let texts = ["5.3, Fig. 5.2", "if it was not enforced, v_f = 0", "the quadratic program"];
    study.state(Statement::identity("largest |v_f| without Eq. 5.2", texts, (0.0, 1e-9), without));
    Ok(())
}
