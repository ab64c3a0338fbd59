//! From an assembly to a run.

use super::dense::in_users_order;
use super::march::March;
use super::problem::{Assembly, Settings};
use super::solution::{ContactEnd, Observer, Run};
use crate::InvalidInput;
use contact_models::ContactLaw;

/// Follows an assembly from its start to the end of the time asked for, and tells the observer what happens.
///
/// # Errors
/// Names the field, its value and what would be allowed, for input that poses no problem.
///
/// ```
/// use contact_models::Hertz;
/// use vibroimpact_sim::assembly::{Assembly, Body, Contact, Force, Load, Outcome, Point, Settings, run};
///
/// // a ball of 0.1 kg dropped from 1 cm onto the ground
/// let ball = Body::mass(0.1, 0.01, 0.0);
/// let shape = vec![0.1f64.sqrt().recip()];
/// let side = Point::OfBody { body: 0, shape };
/// let contact = Contact { sides: [side, Point::Ground], gap_m: 0.0, law: Hertz::new(1e9).unwrap() };
/// let weight = Load { body: 0, shape: vec![0.1f64.sqrt()], force: Force::Constant { force_n: -9.81 } };
/// let assembly = Assembly { bodies: vec![ball], contacts: vec![contact], loads: vec![weight] };
/// let run = run(&assembly, &Settings::until(0.2), &mut ())?;
/// assert_eq!(run.outcome, Outcome::End);
/// // it falls for 45 ms and bounces once in every 90 ms
/// assert_eq!(run.contacts[0].statistics.intervals, 2);
/// # Ok::<(), vibroimpact_sim::InvalidInput>(())
/// ```
pub fn run<L: ContactLaw>(
    assembly: &Assembly<L>,
    settings: &Settings,
    observer: &mut dyn Observer,
) -> Result<Run, InvalidInput> {
    assembly.check()?;
    settings.check()?;
    let mut march = March::new(assembly, *settings, observer);
    let outcome = march.follow();
    let contacts = (0..march.states.len()).map(|c| contact_end(&march, c)).collect();
    let (mut amplitude, mut rate) = (march.amplitude, march.rate);
    march.loads.shift_modes(&march.system, march.time_s, 1.0, &mut amplitude, &mut rate);
    let (amplitude, rate) = in_users_order(&march.system, &amplitude, &rate);
    let by_body = |values: &[f64]| march.system.bodies.iter().map(|body| values[body.clone()].to_vec()).collect();
    Ok(Run {
        outcome,
        end_s: march.time_s,
        amplitude: by_body(&amplitude),
        rate: by_body(&rate),
        contacts,
        energy: None,
        counts: march.counts,
    })
}

fn contact_end<L: ContactLaw>(march: &March<L>, c: usize) -> ContactEnd {
    let state = &march.states[c];
    let law = &march.assembly.contacts[c].law;
    let mut end = ContactEnd {
        statistics: state.statistics,
        displacement_m: [0.0; 2],
        velocity_m_s: [0.0; 2],
        force_n: 0.0,
        stored_j: 0.0,
    };
    for (i, side) in march.system.links[c].sides.iter().enumerate() {
        if let Some(side) = side {
            let (shift, shift_rate) = march.loads.side(&march.system, side, march.time_s);
            end.displacement_m[i] = side.sum(&march.amplitude) + shift;
            end.velocity_m_s[i] = side.sum(&march.rate) + shift_rate;
        }
    }
    if let Some(touch) = state.touch() {
        end.force_n = law.force(&touch.branch, state.overlap, state.rate).force_n;
        end.stored_j = law.stored_energy_j(&touch.branch, state.overlap);
    }
    end
}
