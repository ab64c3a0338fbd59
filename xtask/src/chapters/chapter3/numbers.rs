//! Numbers of section 3.3.1 and of the closing remarks: beam, ball and frequencies.

use super::Case;
use crate::chapters::statement::Statement;
use crate::chapters::study::Study;
use std::f64::consts::PI;
use tasks::Failure;

pub(super) fn run(study: &mut Study, case: &Case) -> Result<(), Failure> {
    let frequency = |n: usize| case.beam.omega_rad_s()[n - 1] / (2.0 * PI);
    let beam = &case.parameters.beam;
    let beam_mass = case.parameters.material.density_kg_m3 * beam.side_m * beam.side_m * beam.length_m;
    study.state(Statement::printed("mass of the 3 cm ball (kg)", "3.3.1", "0.11027", case.ball.mass_kg));
    study.state(Statement::printed("Hertz stiffness (N/m^1.5)", "Eq. 3.20", "1.7945e10", case.ball.stiffness_n_m1_5));
    let (about, reason) = ((1.0, 0.05), "a twentieth");
    study.state(Statement::loose("mass of the beam (kg)", "3.5", "about 1", about, reason, beam_mass));
    study.state(Statement::printed("first natural frequency (Hz)", "3.3.1", "26", frequency(1)));
    study.state(Statement::printed("period of the first mode (s)", "3.3.1", "0.0385", 1.0 / frequency(1)));
    study.state(Statement::loose(
        "60th natural frequency (Hz)",
        "3.3.1",
        "60² × 26 ≈ 93600",
        (93600.0, 50.0),
        "half a unit of the third digit, of which the factor 26 has two",
        frequency(60),
    ));
    study.state(Statement::printed("period of the 60th mode (s)", "3.3.1", "1.0684e-5", 1.0 / frequency(60)));
    let weight = 9.81 * case.ball.mass_kg;
    let (order, reason) = ((1.0, 0.7), "an order of magnitude: down to 1/√10");
    study.state(Statement::loose("weight of the ball (N)", "3.3.2", "on the order of 1", order, reason, weight));

    let wall = case.setup(case.golden_m(), 0);
    let contact_s = wall.record()?.0.sub_impacts.iter().map(|s| s.end_s - s.start_s).sum::<f64>();
    let slower = (1..=case.parameters.our_choice.most_modes.max(100))
        .take_while(|&n| n <= case.beam.omega_rad_s().len() && 1.0 / frequency(n) >= contact_s)
        .count();
    // the ratio of the first mode's period to the contact duration if k_H, in N/m^1.5, is read as N/m
    let linear_s = PI * (case.ball.mass_kg / case.ball.stiffness_n_m1_5).sqrt();
    let slip = (1.0 / (frequency(1) * linear_s)).sqrt();
    let note = format!(
        "The ball is in contact with an immovable beam for {:.3} ms, and mode {slower} is the last one with a longer \
         period. With k_H in N/m the contact would last π √(m/k_H) = {:.4} ms, and √(T₁/(π √(m/k_H))) = {slip:.1} is \
         the number of the text.",
        1e3 * contact_s,
        1e3 * linear_s
    );
    let rule = Statement::loose(
        "modes with periods longer than the contact with an immovable beam",
        "3.5",
        "about 70",
        (70.0, 5.0),
        "half a unit of the only digit",
        slower as f64,
    );
    study.state(rule.note(note));
    Ok(())
}
