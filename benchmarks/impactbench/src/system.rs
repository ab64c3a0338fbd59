//! A problem as a system of ordinary differential equations, and as an assembly of this workspace.

use crate::problem::{Problem, What};
use contact_models::{After, Boundary, Branch, ContactLaw, Law, Memory};
use vibroimpact_sim::assembly::{self, Assembly, Force, Load, Point};

/// The equations (1) and (2) of the crate's root: all amplitudes, then all rates.
#[derive(Debug, Clone)]
pub struct System {
    /// `omega_k^2`.
    stiffness: Vec<f64>,
    /// `2 zeta_k omega_k`.
    damping: Vec<f64>,
    /// Constant acceleration of each mode.
    constant: Vec<f64>,
    /// The contacts: what each mode adds to the compression, the gap, and the law.
    contacts: Vec<(Vec<f64>, f64, Law)>,
}

/// What a contact is doing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum State {
    /// The surfaces are apart and remember this.
    Open(Memory),
    /// They touch.
    Closed(Branch),
}

impl System {
    /// The problem with these laws, one a contact.
    ///
    /// # Errors
    /// A contact with a body that is not there.
    pub fn new(problem: &Problem, laws: &[Law]) -> Result<System, String> {
        let places = places(problem);
        let count = problem.bodies.iter().map(|body| body.shape.len()).sum();
        let (mut stiffness, mut damping, mut constant) = (Vec::new(), Vec::new(), Vec::new());
        for body in &problem.bodies {
            for (omega, ratio) in body.omega_rad_s.iter().zip(&body.damping_ratio) {
                stiffness.push(omega * omega);
                damping.push(2.0 * ratio * omega);
                constant.push(-problem.gravity_m_s2 * body.free_mass_kg().map_or(0.0, f64::sqrt));
            }
        }
        let mut contacts = Vec::new();
        for (contact, law) in problem.contacts.iter().zip(laws) {
            let mut psi = vec![0.0; count];
            let upper = Some((&contact.upper, -1.0));
            for (name, sign) in upper.into_iter().chain(contact.lower.as_ref().map(|name| (name, 1.0))) {
                let body = number(problem, name)?;
                for (k, shape) in problem.bodies[body].shape.iter().enumerate() {
                    psi[places[body] + k] += sign * shape;
                }
            }
            contacts.push((psi, contact.gap_m, *law));
        }
        Ok(System { stiffness, damping, constant, contacts })
    }

    /// Number of modes.
    pub fn modes(&self) -> usize {
        self.stiffness.len()
    }

    /// Circular frequency of a mode (rad/s).
    pub fn omega(&self, k: usize) -> f64 {
        self.stiffness[k].sqrt()
    }

    /// Compression of a contact and its rate.
    pub fn compression(&self, contact: usize, y: &[f64]) -> (f64, f64) {
        let (psi, gap, _) = &self.contacts[contact];
        let (a, b) = y.split_at(self.modes());
        let dot = |values: &[f64]| psi.iter().zip(values).map(|(psi, value)| psi * value).sum::<f64>();
        (dot(a) - gap, dot(b))
    }

    /// Accelerations of the modes.
    pub fn accelerations(&self, states: &[State], y: &[f64], out: &mut [f64]) {
        let (a, b) = y.split_at(self.modes());
        for k in 0..self.modes() {
            out[k] = self.constant[k] - self.damping[k] * b[k] - self.stiffness[k] * a[k];
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

    /// The ends of what a contact is doing: it goes on while neither margin is negative.
    pub fn margins(&self, contact: usize, state: &State, y: &[f64]) -> [f64; 2] {
        let (xi, rate) = self.compression(contact, y);
        let boundaries = match state {
            State::Open(memory) => [Boundary::compression_rises_to(memory.touch_m), Boundary::NEVER],
            State::Closed(branch) => self.contacts[contact].2.boundaries(branch),
        };
        boundaries.map(|boundary| boundary.margin(xi, rate))
    }

    /// What a contact does after it has met an end.
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

    /// Every contact open, or closed where the surfaces meet at once.
    pub fn first_states(&self, y: &[f64]) -> Vec<State> {
        let of = |c: usize| {
            let open = State::Open(Memory::default());
            let (xi, rate) = self.compression(c, y);
            if xi >= 0.0 && rate > 0.0 { self.next(&open, c, 0, y) } else { open }
        };
        (0..self.contacts.len()).map(of).collect()
    }
}

/// Where each body's modes begin.
fn places(problem: &Problem) -> Vec<usize> {
    let counts = problem.bodies.iter().map(|body| body.shape.len());
    counts.scan(0, |sum, count| Some(std::mem::replace(sum, *sum + count))).collect()
}

fn number(problem: &Problem, name: &str) -> Result<usize, String> {
    let found = problem.bodies.iter().position(|body| body.name == name);
    found.ok_or_else(|| format!("{}: no body is called {name}", problem.name))
}

/// Amplitudes and rates at the start.
pub fn start(problem: &Problem) -> Vec<f64> {
    let amplitudes = problem.bodies.iter().flat_map(|body| &body.amplitude);
    amplitudes.chain(problem.bodies.iter().flat_map(|body| &body.rate)).copied().collect()
}

/// What is asked for, from amplitudes and rates at the end.
///
/// # Errors
/// A body that is not there.
pub fn answers(problem: &Problem, y: &[f64]) -> Result<Vec<f64>, String> {
    let places = places(problem);
    let of = |quantity: &crate::problem::Quantity| {
        let body = number(problem, &quantity.body)?;
        let from = places[body] + if quantity.what == What::VelocityMS { y.len() / 2 } else { 0 };
        Ok(problem.bodies[body].at_point(&y[from..]))
    };
    problem.quantities.iter().map(of).collect()
}

/// The problem as an assembly.
///
/// # Errors
/// A contact with a body that is not there.
pub fn assembly(problem: &Problem, laws: &[Law]) -> Result<Assembly<Law>, String> {
    let side = |name: &str| {
        let body = number(problem, name)?;
        Ok::<_, String>(Point::OfBody { body, shape: problem.bodies[body].shape.clone() })
    };
    let mut contacts = Vec::new();
    for (contact, law) in problem.contacts.iter().zip(laws) {
        let lower = contact.lower.as_ref().map_or(Ok(Point::Ground), |name| side(name))?;
        contacts.push(assembly::Contact { sides: [side(&contact.upper)?, lower], gap_m: contact.gap_m, law: *law });
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
        Some(Load { body: i, shape: vec![mass_kg.sqrt()], force })
    };
    let loads = problem.bodies.iter().enumerate().filter_map(weight).collect();
    Ok(Assembly { bodies: bodies.collect(), contacts, loads })
}
