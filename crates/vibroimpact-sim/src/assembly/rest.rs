//! Rest: the proof that no contact opens or closes any more.
//!
//! With the closed contacts `C` held closed, the loads have a static equilibrium: forces `F*` and rigid amplitudes with
//!
//! ```text
//! F_c = law_c(xi_c),   xi_c = xi_c0 - sum_c' S_cc' F_c' + sum_r psi_rc a_r,   sum_c psi_rc F_c = f_r
//! ```
//!
//! where `S_cc' = sum_elastic psi_kc psi_kc'/omega_k^2`. Above it the motion has the energy
//!
//! ```text
//! E' = sum (b_k^2 + omega_k^2 (a_k - a_k*)^2)/2 + sum_c (U_c(xi) - U_c(xi*) - F_c* (xi - xi*))
//! ```
//!
//! with `U` the energy that a contact stores: every term is positive, and `E'` never grows. A contact that opens at the
//! compression `xi_r` needs the energy `F* (xi* - xi_r) - U(xi*)` to open. As long as none opens, the motion is bounded as follows:
//! an elastic mode moves by at most `sqrt(2 E')/omega`; a closed contact yields by at most the `d_c` at which its own term
//! is `E'`; and the rigid modes follow them. With `P` the weights of the rigid modes in the closed contacts, and any `G`
//! with `G P = 1`,
//!
//! ```text
//! |sum_r psi_r da_r| <= sum_c |(psi^T G)_c| w_c,    w_c = d_c + sum_elastic |psi_kc| sqrt(2 E')/omega_k.
//! ```
//!
//! An open contact stays open if that is less than its distance at equilibrium.

use super::motion::March;
use super::state::State;
use contact_models::{After, Branch, ContactLaw, boundaries};
use nalgebra::{DMatrix, DVector};

/// Newton's method on the equilibrium.
const ITERATIONS_MAX: usize = 40;

/// A static equilibrium: contact forces (N), compressions (m), amplitudes of the rigid modes.
struct Equilibrium {
    closed: Vec<usize>,
    force: Vec<f64>,
    compression: Vec<f64>,
    rigid: Vec<(usize, f64)>,
    /// `P`: a row for each closed contact, a column for each rigid mode.
    rigid_part: DMatrix<f64>,
}

/// Whether the remaining motion of two bodies with one contact and without loads is below this part of the speed of their first
/// approach. The motion consists of their relative rigid motion, the contact force and their vibrations. If a body is supported,
/// vibrations are measured from its deflection under the present force.
pub(crate) fn has_faded(march: &March, part: f64) -> bool {
    let [state] = march.states.as_slice() else { return false };
    let (system, link) = (march.system, &march.system.links[0]);
    if !march.loads.is_empty() {
        return false;
    }
    let held = link.rigid.is_empty();
    let (force, _) = law_at(march, 0, state.overlap);
    let mut energy = if held { 0.0 } else { (force * state.overlap).abs() };
    if !held {
        let rate: f64 = link.rigid.iter().map(|(k, psi)| psi * march.rate[*k]).sum();
        energy += 0.5 * rate * rate / state.inverse_mass;
    }
    for &(k, psi) in &link.elastic {
        let omega = system.modes[k].omega_rad_s;
        let deflected = if held { psi * force / omega } else { 0.0 };
        energy += 0.5 * ((omega * march.amplitude[k] + deflected).powi(2) + march.rate[k].powi(2));
    }
    energy < (part * state.speed_m_s()).powi(2) / state.inverse_mass
}

/// The compression at which a contact on this branch opens, or at which its force vanishes before it opens. `None` if another
/// branch, which opens at another compression, may come first.
fn opens_at(law: &dyn ContactLaw, branch: &Branch, compression: f64, depth: usize) -> Option<f64> {
    let ends = || boundaries(law, branch);
    if ends().any(|boundary| boundary.per_rate == 0.0 && boundary.per_compression < 0.0) {
        return None;
    }
    for (which, boundary) in ends().enumerate() {
        let after = |compression| law.cross(branch, which, compression, 0.0);
        if boundary.per_rate == 0.0 && boundary.per_compression > 0.0 {
            if let After::Release(memory) = after(boundary.level / boundary.per_compression) {
                return Some(memory.touch_m);
            }
        } else if boundary.per_rate != 0.0
            && depth > 0
            && let After::Continue(next) = after(compression)
            && law.force(&next, compression, 0.0).force_n == 0.0
        {
            return opens_at(law, &next, compression, depth - 1);
        }
    }
    None
}

/// Whether no possible motion opens or closes a contact.
pub(crate) fn is_certain(march: &March) -> bool {
    if !march.loads.are_constant() {
        return false;
    }
    // a free body keeps moving
    let closed: Vec<usize> = (0..march.states.len()).filter(|&c| march.states[c].is_closed()).collect();
    equilibrium(march, closed).is_some_and(|equilibrium| holds(march, &equilibrium))
}

fn equilibrium(march: &March, closed: Vec<usize>) -> Option<Equilibrium> {
    let system = march.system;
    let rigid: Vec<usize> = (0..system.modes.len()).filter(|&k| system.modes[k].is_rigid()).collect();
    let (n, m) = (closed.len(), rigid.len());
    if m > n {
        return None;
    }
    let load = DVector::from_fn(m, |r, _| march.loads.line(rigid[r], march.time_s).0);
    // as many forces as rigid modes are all zero if nothing loads these, and then no contact is held closed
    if m == n && load.iter().all(|load| *load == 0.0) {
        return None;
    }
    let psi = |c: usize, k: usize| -> f64 {
        let found = system.links[c].rigid.iter().find(|(other, _)| *other == k);
        found.map_or(0.0, |(_, psi)| *psi)
    };
    let flexibility = DMatrix::from_fn(n, n, |i, j| {
        let shared = system.links[closed[i]].shared(&system.links[closed[j]]);
        let elastic = shared.filter(|(k, _)| !system.modes[*k].is_rigid());
        elastic.map(|(k, weight)| weight / system.modes[k].omega_rad_s.powi(2)).sum()
    });
    let rigid_part = DMatrix::from_fn(n, m, |i, r| psi(closed[i], rigid[r]));
    // the overlap of each contact without force and with the rigid modes in place
    let unloaded: Vec<f64> = closed
        .iter()
        .map(|&c| {
            let moved: f64 = system.links[c].elastic.iter().map(|(k, psi)| psi * march.amplitude[*k]).sum();
            let rigid: f64 = system.links[c].rigid.iter().map(|(k, psi)| psi * march.amplitude[*k]).sum();
            march.states[c].overlap - moved - rigid
        })
        .collect();
    let mut force: DVector<f64> =
        DVector::from_fn(n, |i, _| law_at(march, closed[i], march.states[closed[i]].overlap).0);
    let mut amplitude: DVector<f64> = DVector::from_fn(m, |r, _| march.amplitude[rigid[r]]);
    for _ in 0..ITERATIONS_MAX {
        let compression = DVector::from_column_slice(&unloaded) - &flexibility * &force + &rigid_part * &amplitude;
        let laws: Vec<(f64, f64)> = (0..n).map(|i| law_at(march, closed[i], compression[i])).collect();
        let mut matrix = DMatrix::zeros(n + m, n + m);
        let mut right = DVector::zeros(n + m);
        for i in 0..n {
            let (at, stiffness) = laws[i];
            right[i] = at - force[i];
            matrix[(i, i)] = 1.0;
            for j in 0..n {
                matrix[(i, j)] += stiffness * flexibility[(i, j)];
            }
            for r in 0..m {
                matrix[(i, n + r)] = -stiffness * rigid_part[(i, r)];
                matrix[(n + r, i)] = rigid_part[(i, r)];
            }
        }
        let balance = &load - rigid_part.transpose() * &force;
        right.rows_mut(n, m).copy_from(&balance);
        let change = matrix.lu().solve(&right)?;
        if !change.iter().all(|value| value.is_finite()) {
            return None;
        }
        force += change.rows(0, n);
        amplitude += change.rows(n, m);
        let small = |change: f64, size: f64| change.abs() <= 1e-12 * size;
        let forces_known = (0..n).all(|i| small(change[i], force[i].abs()));
        let largest = amplitude.iter().fold(f64::MIN_POSITIVE, |most: f64, a| most.max(a.abs()));
        if forces_known && (0..m).all(|r| small(change[n + r], largest)) {
            let compression = DVector::from_column_slice(&unloaded) - &flexibility * &force + &rigid_part * &amplitude;
            return Some(Equilibrium {
                closed,
                force: force.iter().copied().collect(),
                compression: compression.iter().copied().collect(),
                rigid: rigid.into_iter().zip(amplitude.iter().copied()).collect(),
                rigid_part,
            });
        }
    }
    None
}

/// Force of a closed contact at rest with this compression, and its slope.
fn law_at(march: &March, c: usize, compression: f64) -> (f64, f64) {
    let Some(contact) = march.states[c].closed_contact() else { return (0.0, 0.0) };
    let force = march.laws[c].force(&contact.branch, compression, 0.0);
    (force.force_n, force.per_compression_n_m)
}

fn holds(march: &March, at: &Equilibrium) -> bool {
    let system = march.system;
    if at.force.iter().any(|force| *force <= 0.0) {
        return false;
    }
    let stored = |i: usize, compression: f64| {
        let c = at.closed[i];
        let contact = march.states[c].closed_contact();
        contact.map_or(0.0, |contact| march.laws[c].stored_energy_j(&contact.branch, compression))
    };
    let mut energy: f64 = march.rate.iter().map(|b| 0.5 * b * b).sum();
    for (k, mode) in system.modes.iter().enumerate().filter(|(_, mode)| !mode.is_rigid()) {
        let held: f64 = at.closed.iter().zip(&at.force).map(|(&c, force)| system.links[c].weight(k) * force).sum();
        energy += 0.5 * (mode.omega_rad_s * march.amplitude[k] + held / mode.omega_rad_s).powi(2);
    }
    for (i, &c) in at.closed.iter().enumerate() {
        let (now, still) = (march.states[c].overlap, at.compression[i]);
        energy += (stored(i, now) - stored(i, still) - at.force[i] * (now - still)).max(0.0);
    }
    let speed = (2.0 * energy).sqrt();
    let mut gives = DVector::zeros(at.closed.len());
    for (i, &c) in at.closed.iter().enumerate() {
        let still = at.compression[i];
        let term = |moved: f64| stored(i, still + moved) - stored(i, still) - at.force[i] * moved;
        let contact = march.states[c].closed_contact();
        let opens_at = contact.and_then(|contact| opens_at(march.laws[c], &contact.branch, still, 1));
        // the contact stays closed, and its displacement in the opening direction is smaller than that
        let Some(opening) = opens_at.map(|xi| xi - still).filter(|&opening| term(opening) > energy) else {
            return false;
        };
        let Some(closing) = yields(term, energy, -opening) else { return false };
        let Some(opening) = yields(|moved| term(-moved), energy, -opening) else { return false };
        let elastic: f64 =
            system.links[c].elastic.iter().map(|(k, psi)| psi.abs() / system.modes[*k].omega_rad_s).sum();
        gives[i] = closing.max(opening) + speed * elastic;
    }
    let gram = at.rigid_part.transpose() * &at.rigid_part;
    // without rigid modes the system is empty, which nalgebra does not accept
    let inverse = match gram.is_empty() {
        true => Some(at.rigid_part.transpose()),
        false => gram.lu().solve(&at.rigid_part.transpose()),
    };
    let Some(inverse) = inverse else { return false };
    let mut open = march.states.iter().enumerate().filter(|(_, state)| !state.is_closed());
    open.all(|(c, state)| stays_open(march, at, c, state, speed, (&inverse, &gives)))
}

/// A bound, at most twice too large, on the displacement of a contact at which its term of the energy, which is convex, equals
/// the whole energy. `first` is a guess.
fn yields(term: impl Fn(f64) -> f64, energy: f64, first: f64) -> Option<f64> {
    const DOUBLINGS: usize = 60;
    const HALVINGS: usize = 40;
    let beyond = (0..DOUBLINGS).map(|i| first * 2f64.powi(i as i32)).find(|&moved| term(moved) >= energy)?;
    let mut most = beyond;
    for _ in 0..HALVINGS {
        if term(0.5 * most) < energy {
            break;
        }
        most *= 0.5;
    }
    Some(most)
}

/// Whether an open contact stays open while no closed one opens; `inverse` is `G`, and `gives` are `w`.
fn stays_open(
    march: &March,
    at: &Equilibrium,
    c: usize,
    state: &State,
    speed: f64,
    (inverse, gives): (&DMatrix<f64>, &DVector<f64>),
) -> bool {
    let (system, link) = (march.system, &march.system.links[c]);
    let (shift, _) = march.loads.overlap(c, march.time_s);
    let (mut overlap, mut reach) = (state.reference + shift, 0.0);
    for &(k, psi) in &link.elastic {
        let omega = system.modes[k].omega_rad_s;
        let held: f64 =
            at.closed.iter().zip(&at.force).map(|(&other, force)| system.links[other].weight(k) * force).sum();
        overlap -= psi * held / omega.powi(2);
        reach += psi.abs() * speed / omega;
    }
    let mut follows = DVector::zeros(at.closed.len());
    for &(k, psi) in &link.rigid {
        let Some(r) = at.rigid.iter().position(|(other, _)| *other == k) else { return false };
        overlap += psi * at.rigid[r].1;
        follows += psi * inverse.row(r).transpose();
    }
    reach += follows.iter().zip(gives.iter()).map(|(follows, gives): (&f64, &f64)| follows.abs() * gives).sum::<f64>();
    state.touch_m() - overlap > reach
}
