//! When a contact is known to last: what still moves is too little to part the surfaces.
//!
//! Against an immovable stop the surfaces part only where the modes together stand at the compression of release,
//! `sum alpha_k = s`. That takes at least the energy `V = s^2 / (2 C)`, `C = sum phi_k^2 / omega_k^2` the static compliance of
//! the modes kept. Damping and contact only take energy away, so a structure pressed against the stop (`s < 0`) whose
//! energy, that stored in the contact included, is below `V` stays in contact for ever. This is a bound, not a guess.
//!
//! Where that cannot tell, the energy of what still moves is compared with what counts as none. Measured from the
//! deflection under the present force, `d_k = alpha_k + phi_k^2 F / omega_k^2`, it is at least the energy above the static
//! equilibrium, whatever the preload.

use super::ladder::Ladder;
use super::motion::Motion;
use contact_models::{After, Branch, ContactLaw, Stage};

/// Part by which the energy has to stay below what parting takes.
const MARGIN: f64 = 1e-6;

/// A contact at one moment.
pub(crate) struct Pressed<'a, L> {
    pub law: &'a L,
    pub branch: &'a Branch,
    pub compression: f64,
    pub rate: f64,
    /// Inverse mass of striker and rigid-body modes together (1/kg).
    pub mu: f64,
    pub residual_compliance: f64,
}

impl<L: ContactLaw> Pressed<'_, L> {
    /// Whether the surfaces cannot part any more, or nothing moves by more than `rest_energy` (J) allows.
    pub fn lasts(&self, ladder: &Ladder, motion: &Motion, rest_energy: f64) -> bool {
        let force = self.law.force(self.branch, self.compression, self.rate).force_n;
        if self.mu > 0.0 {
            // free bodies that press on each other do not stay where they are
            let drift = 0.5 * motion.drift_rate.powi(2) / self.mu;
            return drift + energy(ladder, motion, 0.0) + (force * self.compression).abs() < rest_energy;
        }
        energy(ladder, motion, force) < rest_energy || self.is_held(ladder, motion, force)
    }

    /// Whether the energy does not suffice to bring the surfaces to where they part.
    fn is_held(&self, ladder: &Ladder, motion: &Motion, force: f64) -> bool {
        let stored = self.law.stored_energy_j(self.branch, self.compression);
        let energy = energy(ladder, motion, 0.0) + stored + 0.5 * self.residual_compliance * force * force;
        let static_compliance: f64 = ladder.weight.iter().zip(&ladder.square).map(|(w, square)| w / square).sum();
        let to_reach = |gap: f64| {
            let way = gap - motion.drift;
            if way < 0.0 { 0.5 * way * way / static_compliance } else { 0.0 }
        };
        let Some(release) = self.release(self.branch, 1) else { return false };
        energy < (1.0 - MARGIN) * to_reach(release)
    }

    /// The compression at which the branch would release the contact; `None` if another branch, with another release, may
    /// come first.
    fn release(&self, branch: &Branch, depth: usize) -> Option<f64> {
        let boundaries = self.law.boundaries(branch);
        let yields = boundaries.iter().any(|boundary| boundary.per_rate == 0.0 && boundary.per_compression < 0.0);
        if branch.stage == Stage::Loading || yields {
            return None;
        }
        for (which, boundary) in boundaries.iter().enumerate() {
            let after = |compression| self.law.cross(branch, which, compression, 0.0);
            if boundary.per_rate == 0.0 && boundary.per_compression > 0.0 {
                if let After::Release(memory) = after(boundary.level / boundary.per_compression) {
                    return Some(memory.touch_m);
                }
            } else if boundary.per_rate != 0.0
                && depth > 0
                && let After::Continue(next) = after(self.compression)
                && next.stage == Stage::Slack
            {
                return self.release(&next, depth - 1);
            }
        }
        None
    }
}

/// Kinetic and elastic energy of the modes (J), the latter from their deflection under this force (N).
fn energy(ladder: &Ladder, motion: &Motion, force: f64) -> f64 {
    let state = &motion.vibration;
    let mut energy = 0.0;
    for (k, weight) in ladder.weight.iter().enumerate() {
        let omega = ladder.modes[k].omega_rad_s;
        let (a, b) = (omega * state.alpha[k] + weight * force / omega, state.beta[k]);
        energy += 0.5 * (a * a + b * b) / weight;
    }
    energy
}
