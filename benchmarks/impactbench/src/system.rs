//! A problem as a system of ordinary differential equations, and as an assembly of this workspace.

use crate::problem::{Load, Problem, What};
use contact_models::{After, Boundary, Branch, ContactLaw, Law, Memory};
use vibroimpact_sim::assembly::{self, Assembly, Force, Point};

/// The equations (1) and (2) of the crate's root: all amplitudes, then all rates.
#[derive(Debug, Clone)]
pub struct System {
    /// `omega_k^2`.
    stiffness: Vec<f64>,
    /// `2 zeta_k omega_k`.
    damping: Vec<f64>,
    /// Constant acceleration of each mode.
    constant: Vec<f64>,
    /// Harmonic loads: frequency, phase, and the effect on every mode.
    harmonics: Vec<(f64, f64, Vec<f64>)>,
    /// The contacts: the contribution of each mode to the compression, the gap, and the law.
    contacts: Vec<(Vec<f64>, f64, Law)>,
}

/// The state of a contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum State {
    /// The surfaces are separate, with this memory.
    Open(Memory),
    /// They touch.
    Closed(Branch),
}

impl System {
    /// The problem with these laws, one per contact.
    ///
    /// # Errors
    /// A contact with a body that does not exist.
    pub fn new(problem: &Problem, laws: &[Law]) -> Result<System, String> {
        let places = places(problem);
        let count = problem.bodies.iter().map(|body| body.shape.len()).sum();
        let spread = |name: &str, shape: &Option<Vec<f64>>, scale: f64, into: &mut [f64]| {
            let (number, body) = problem.body(name)?;
            for (sum, shape) in into[places[number]..].iter_mut().zip(shape.as_ref().unwrap_or(&body.shape)) {
                *sum += scale * shape;
            }
            Ok::<_, String>(())
        };
        let (mut stiffness, mut damping, mut constant) = (Vec::new(), Vec::new(), Vec::new());
        for body in &problem.bodies {
            for (omega, ratio) in body.omega_rad_s.iter().zip(&body.damping_ratio) {
                stiffness.push(omega * omega);
                damping.push(2.0 * ratio * omega);
                constant.push(-problem.gravity_m_s2 * body.free_mass_kg().map_or(0.0, f64::sqrt));
            }
        }
        let mut harmonics = Vec::new();
        for Load { body, shape, force_n, omega_rad_s, phase_rad } in &problem.loads {
            if *omega_rad_s == 0.0 {
                spread(body, shape, force_n * phase_rad.sin(), &mut constant)?;
            } else {
                let mut amplitude = vec![0.0; count];
                spread(body, shape, *force_n, &mut amplitude)?;
                harmonics.push((*omega_rad_s, *phase_rad, amplitude));
            }
        }
        let mut contacts = Vec::new();
        for (contact, law) in problem.contacts.iter().zip(laws) {
            let mut psi = vec![0.0; count];
            for (name, shape, sign) in
                [(&contact.upper, &contact.upper_shape, -1.0), (&contact.lower, &contact.lower_shape, 1.0)]
            {
                if let Some(name) = name {
                    spread(name, shape, sign, &mut psi)?;
                }
            }
            contacts.push((psi, contact.gap_m, *law));
        }
        Ok(System { stiffness, damping, constant, harmonics, contacts })
    }

    /// Number of modes.
    pub fn modes(&self) -> usize {
        self.stiffness.len()
    }

    /// Circular frequency of a mode (rad/s).
    pub fn omega(&self, k: usize) -> f64 {
        self.stiffness[k].sqrt()
    }

    /// A rough bound on the modal rate that the loads can cause up to a time.
    pub fn driven(&self, time_s: f64) -> f64 {
        let force = |k: usize| {
            let harmonic: f64 = self.harmonics.iter().map(|(_, _, amplitude)| amplitude[k].abs()).sum();
            (self.constant[k].abs() + harmonic) * time_s.min(1.0 / self.omega(k))
        };
        (0..self.modes()).map(|k| force(k).powi(2)).sum::<f64>().sqrt()
    }

    /// Compression of a contact and its rate.
    pub fn compression(&self, contact: usize, y: &[f64]) -> (f64, f64) {
        let (psi, gap, _) = &self.contacts[contact];
        let (a, b) = y.split_at(self.modes());
        let dot = |values: &[f64]| psi.iter().zip(values).map(|(psi, value)| psi * value).sum::<f64>();
        (dot(a) - gap, dot(b))
    }

    /// Accelerations of the modes at a time.
    pub fn accelerations(&self, states: &[State], time_s: f64, y: &[f64], out: &mut [f64]) {
        let (a, b) = y.split_at(self.modes());
        for k in 0..self.modes() {
            out[k] = self.constant[k] - self.damping[k] * b[k] - self.stiffness[k] * a[k];
        }
        for (omega, phase, amplitude) in &self.harmonics {
            let now = (omega * time_s + phase).sin();
            for (out, amplitude) in out.iter_mut().zip(amplitude) {
                *out += now * amplitude;
            }
        }
        for (c, state) in states.iter().enumerate() {
            let State::Closed(branch) = state else { continue };
            let (psi, _, law) = &self.contacts[c];
            let (xi, rate) = self.compression(c, y);
            let force = law.force(branch, xi, rate).force_n;
            for (out, psi) in out.iter_mut().zip(psi) {
                *out -= psi * force;
            }
        }
    }

    /// The change of the accelerations with a small change of the state, per unit of it: the Jacobian times `v`.
    pub fn jacobian_times(&self, states: &[State], y: &[f64], v: &[f64], out: &mut [f64]) {
        let (a, b) = v.split_at(self.modes());
        for k in 0..self.modes() {
            out[k] = -self.damping[k] * b[k] - self.stiffness[k] * a[k];
        }
        for (c, state) in states.iter().enumerate() {
            let State::Closed(branch) = state else { continue };
            let (psi, gap, law) = &self.contacts[c];
            let (xi, rate) = self.compression(c, y);
            let (per_xi, per_rate) = self.compression(c, v);
            let force = law.force(branch, xi, rate);
            let force_n = force.per_compression_n_m * (per_xi + gap) + force.per_rate_n_s_m * per_rate;
            for (out, psi) in out.iter_mut().zip(psi) {
                *out -= psi * force_n;
            }
        }
    }

    /// The ends of the state of a contact: it is valid while neither function is negative.
    pub fn margins(&self, contact: usize, state: &State, y: &[f64]) -> [f64; 2] {
        let (xi, rate) = self.compression(contact, y);
        let boundary = |which| match state {
            State::Open(memory) => (which == 0).then_some(Boundary::compression_rises_to(memory.touch_m)),
            State::Closed(branch) => self.contacts[contact].2.boundary(branch, which),
        };
        // No law here has more than two.
        [0, 1].map(|which| boundary(which).unwrap_or(Boundary::NEVER).margin(xi, rate))
    }

    /// The state of a contact after it has reached an end.
    pub fn next(&self, state: &State, contact: usize, which: usize, y: &[f64]) -> State {
        let (xi, rate) = self.compression(contact, y);
        let law = &self.contacts[contact].2;
        match state {
            State::Open(memory) => State::Closed(law.touch(memory, rate.max(0.0))),
            State::Closed(branch) => match law.cross(branch, which, xi, rate) {
                After::Continue(branch) => State::Closed(branch),
                After::Release(memory) => State::Open(memory),
            },
        }
    }

    /// Every contact is open, or closed if the surfaces meet immediately.
    pub fn first_states(&self, y: &[f64]) -> Vec<State> {
        let of = |c: usize| {
            let open = State::Open(Memory::default());
            let (xi, rate) = self.compression(c, y);
            if xi >= 0.0 && rate > 0.0 { self.next(&open, c, 0, y) } else { open }
        };
        (0..self.contacts.len()).map(of).collect()
    }
}

/// Index of the first mode of each body.
fn places(problem: &Problem) -> Vec<usize> {
    let counts = problem.bodies.iter().map(|body| body.shape.len());
    counts.scan(0, |sum, count| Some(std::mem::replace(sum, *sum + count))).collect()
}

/// Amplitudes and rates at the start.
pub fn start(problem: &Problem) -> Vec<f64> {
    let amplitudes = problem.bodies.iter().flat_map(|body| &body.amplitude);
    amplitudes.chain(problem.bodies.iter().flat_map(|body| &body.rate)).copied().collect()
}

/// The requested quantities, from amplitudes and rates at the end.
///
/// # Errors
/// A body that does not exist.
pub fn answers(problem: &Problem, y: &[f64]) -> Result<Vec<f64>, String> {
    let places = places(problem);
    let of = |quantity: &crate::problem::Quantity| {
        let (number, body) = problem.body(&quantity.body)?;
        let from = places[number] + if quantity.what == What::VelocityMS { y.len() / 2 } else { 0 };
        let shape = quantity.shape.as_ref().unwrap_or(&body.shape);
        Ok(shape.iter().zip(&y[from..]).map(|(shape, value)| shape * value).sum())
    };
    problem.quantities.iter().map(of).collect()
}

/// The problem as an assembly.
///
/// # Errors
/// A contact with a body that does not exist.
pub fn assembly(problem: &Problem, laws: &[Law]) -> Result<Assembly<Law>, String> {
    let side = |name: &Option<String>, shape: &Option<Vec<f64>>| {
        let Some(name) = name else { return Ok(Point::Ground) };
        let (number, body) = problem.body(name)?;
        Ok::<_, String>(Point::OfBody { body: number, shape: shape.as_ref().unwrap_or(&body.shape).clone() })
    };
    let mut contacts = Vec::new();
    for (contact, law) in problem.contacts.iter().zip(laws) {
        let sides = [side(&contact.upper, &contact.upper_shape)?, side(&contact.lower, &contact.lower_shape)?];
        contacts.push(assembly::Contact { sides, gap_m: contact.gap_m, law: *law });
    }
    let bodies = problem.bodies.iter().map(|body| assembly::Body {
        modes: (body.omega_rad_s.iter().zip(&body.damping_ratio))
            .map(|(&omega_rad_s, &damping_ratio)| assembly::BodyMode { omega_rad_s, damping_ratio })
            .collect(),
        amplitude: body.amplitude.clone(),
        rate: body.rate.clone(),
    });
    let weight = |(i, body): (usize, &crate::problem::Body)| {
        let mass_kg = body.free_mass_kg().filter(|_| problem.gravity_m_s2 != 0.0)?;
        let force = Force::Constant { force_n: -problem.gravity_m_s2 };
        Some(assembly::Load { body: i, shape: vec![mass_kg.sqrt()], force })
    };
    let mut loads: Vec<assembly::Load> = problem.bodies.iter().enumerate().filter_map(weight).collect();
    for Load { body, shape, force_n, omega_rad_s, phase_rad } in &problem.loads {
        let (number, body) = problem.body(body)?;
        let force = match *omega_rad_s {
            0.0 => Force::Constant { force_n: force_n * phase_rad.sin() },
            omega_rad_s => Force::Harmonic { force_n: *force_n, omega_rad_s, phase_rad: *phase_rad },
        };
        let shape = shape.as_ref().unwrap_or(&body.shape).clone();
        loads.push(assembly::Load { body: number, shape, force });
    }
    Ok(Assembly { bodies: bodies.collect(), contacts, loads })
}
