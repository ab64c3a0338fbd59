//! The momentum that a contact exchanges: the scale of the error that its impulse may have on a panel. A contact that has exchanged none
//! yet takes it from the motion of its bodies or from the loads.

use super::motion::March;
use super::state::State;
use contact_models::Memory;

impl<'a> March<'a> {
    /// The momentum that a contact that has just closed is expected to exchange. `stored_j` is the energy that it stores already.
    pub(super) fn expect_momentum(&mut self, c: usize, stored_j: f64) {
        let link = &self.system.links[c];
        let State { rate: approach, inverse_mass: inverse, .. } = self.states[c];
        if inverse > 0.0 {
            // bodies approach with their masses, but vibrations only with their effective masses, which are small
            let vibrates: f64 =
                if link.rigid.is_empty() { 0.0 } else { link.elastic.iter().map(|(k, psi)| psi * self.rate[*k]).sum() };
            let rigid = approach - vibrates;
            let speed = rigid.abs().max((2.0 * stored_j * inverse).sqrt());
            let momentum = speed / inverse + (approach - rigid).abs() / link.mobility;
            self.states[c].momentum = self.states[c].momentum.max(momentum);
            if self.states[c].momentum == 0.0 {
                // it has no speed of its own: the momentum that it will transmit is that of the other contacts or, at rest, that which
                // displaced modes can give it
                let others = self.states.iter().map(State::speed_m_s).fold(0.0, f64::max);
                let speed = if others > 0.0 { others } else { self.speed_of_displaced_modes(c) };
                self.states[c].momentum = speed / inverse;
            }
        }
    }

    /// The relative speed that displaced modes can give the surfaces of a contact (m/s).
    pub(super) fn speed_of_displaced_modes(&self, c: usize) -> f64 {
        let displaced = |(k, psi): &(usize, f64)| (psi * self.system.omega[*k] * self.amplitude[*k]).abs();
        self.system.links[c].elastic.iter().map(displaced).sum()
    }

    /// The momentum that the loads give a contact during its deformation (N s), a scale for contacts that only loads have closed.
    pub(super) fn momentum_of_loads(&self, c: usize) -> f64 {
        let inverse = self.states[c].inverse_mass;
        let mut acceleration = self.loads.acceleration(c, 0.0).abs();
        for load in self.posed.loads {
            let span = self.system.span(load.body, &load.shape);
            let links = self.system.links[c].spans.iter().filter(|link| link.modes == span.modes);
            let drive: f64 = links.map(|link| link.psi.iter().zip(&span.psi).map(|(a, b)| a * b).sum::<f64>()).sum();
            acceleration = acceleration.max(drive.abs() * load.force.largest());
        }
        let force = acceleration / inverse;
        if !(force > 0.0 && force.is_finite()) {
            return 0.0;
        }
        let law = self.law(c);
        let branch = law.touch(&Memory::default(), 0.0);
        let (mut low, mut high) = (-30.0f64, 10.0f64);
        for _ in 0..50 {
            let middle = 0.5 * (low + high);
            let found = law.force(&branch, 10f64.powf(middle), 0.0).force_n;
            *(if found < force { &mut low } else { &mut high }) = middle;
        }
        (2.0 * acceleration * 10f64.powf(low)).sqrt() / inverse
    }
}
