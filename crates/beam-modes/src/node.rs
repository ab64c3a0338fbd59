//! The attachments of a beam at one location.

/// Springs, masses and a support at one location, dimensionless.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Node {
    /// Springs against displacement and against rotation.
    pub spring: [f64; 2],
    /// Mass and rotary inertia.
    pub mass: [f64; 2],
    /// Whether the displacement is zero.
    pub support: bool,
}

impl Node {
    /// Whether there are neither springs nor masses.
    pub fn is_bare(&self) -> bool {
        self.spring == [0.0; 2] && self.mass == [0.0; 2]
    }

    pub fn is_heavy(&self) -> bool {
        self.mass != [0.0; 2]
    }

    /// Force over displacement and moment over rotation at `omega = q^2`.
    pub fn dynamic_stiffness(&self, q: f64) -> [f64; 2] {
        let omega2 = (q * q) * (q * q);
        [0, 1].map(|i| self.spring[i] - omega2 * self.mass[i])
    }

    pub fn add(&mut self, other: &Node) {
        for i in 0..2 {
            self.spring[i] += other.spring[i];
            self.mass[i] += other.mass[i];
        }
        self.support |= other.support;
    }
}
