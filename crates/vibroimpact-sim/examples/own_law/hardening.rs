//! A contact with plastic hardening and two internal variables: the plastic indentation `p` (m) and the yield force `Y` (N).
//!
//! Source: the one-dimensional model of mixed hardening of J. C. Simo and T. J. R. Hughes, *Computational Inelasticity*
//! (Springer, 1998), section 1.2, with a force in place of a stress. With `xi` the compression,
//!
//! ```text
//! F = k (xi - p)                                                                     (1)
//! X - Y <= F <= X + Y,     X = h p,     Y' = g |p'|                                  (2)
//! ```
//!
//! If `F` reaches the upper or the lower limit of (2), the contact yields in loading or in unloading. `F` then stays at this
//! limit, so that with `s = k/(k + h + g)`, from an anchor `xi_a` on,
//!
//! ```text
//! p = p_a + s (xi - xi_a),     Y = Y_a + g s |xi - xi_a|                             (3)
//! ```
//!
//! and the slope of the force is `k (1 - s)`. The contact opens where the force vanishes, at `xi = p`; `p` and `Y` remain.

// ANCHOR: state
use contact_models::{After, Boundary, Branch, ContactLaw, Force, Internal, InvalidInput, Memory, Stage};

/// The kinds of branches: elastic, and yielding in either direction.
const ELASTIC: Stage = Stage::Single;
const FORWARDS: Stage = Stage::Own(0);
const BACKWARDS: Stage = Stage::Own(1);

/// The internal variables.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Plastic {
    indentation_m: f64,
    yield_force_n: f64,
}

impl From<Plastic> for Internal {
    fn from(plastic: Plastic) -> Internal {
        [plastic.indentation_m, plastic.yield_force_n].into()
    }
}

impl From<Internal> for Plastic {
    fn from(internal: Internal) -> Plastic {
        let [indentation_m, yield_force_n] = internal.into();
        Plastic { indentation_m, yield_force_n }
    }
}
// ANCHOR_END: state

/// The law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hardening {
    /// Elastic stiffness `k` (N/m).
    pub stiffness_n_m: f64,
    /// Force `Y` at which a contact of a fresh surface yields (N).
    pub yield_force_n: f64,
    /// Kinematic hardening `h` (N/m): the range of elastic forces moves with the indentation.
    pub kinematic_n_m: f64,
    /// Isotropic hardening `g` (N/m): the range becomes wider.
    pub isotropic_n_m: f64,
}

impl Hardening {
    /// The law if its parameters are in range.
    ///
    /// # Errors
    /// A parameter that is not positive, or beyond 1e30.
    pub fn validated(self) -> Result<Hardening, InvalidInput> {
        let fields = [
            ("stiffness_n_m", self.stiffness_n_m),
            ("yield_force_n", self.yield_force_n),
            ("kinematic_n_m", self.kinematic_n_m),
            ("isotropic_n_m", self.isotropic_n_m),
        ];
        for (field, value) in fields {
            InvalidInput::unless((1e-30..=1e30).contains(&value), field, value, "a number from 1e-30 to 1e30")?;
        }
        Ok(self)
    }

    /// `s` of (3).
    fn share(&self) -> f64 {
        self.stiffness_n_m / (self.stiffness_n_m + self.kinematic_n_m + self.isotropic_n_m)
    }

    /// The internal variables at this compression on a branch: (3), or unchanged.
    fn plastic(&self, branch: &Branch, compression_m: f64) -> Plastic {
        let start = Plastic::from(branch.internal);
        if branch.stage == ELASTIC {
            return start;
        }
        let change_m = self.share() * (compression_m - branch.anchor_m);
        Plastic {
            indentation_m: start.indentation_m + change_m,
            yield_force_n: start.yield_force_n + self.isotropic_n_m * change_m.abs(),
        }
    }

    /// The elastic branch with these internal variables.
    fn elastic(&self, plastic: Plastic) -> Branch {
        Branch { stage: ELASTIC, anchor_m: plastic.indentation_m, internal: plastic.into() }
    }

    /// The limits of (2) (N). The lower one is at least zero, where the contact opens.
    fn range(&self, plastic: Plastic) -> (f64, f64) {
        let back_n = self.kinematic_n_m * plastic.indentation_m;
        let lower = back_n - plastic.yield_force_n;
        // A contact that has opened while it yielded in unloading ends at zero, except for rounding.
        let lower = if lower > 1e-9 * plastic.yield_force_n { lower } else { 0.0 };
        (lower, back_n + plastic.yield_force_n)
    }
}

// ANCHOR: law
impl ContactLaw for Hardening {
    fn touch(&self, memory: &Memory, _approach_speed_m_s: f64) -> Branch {
        let [kept_n] = memory.internal.into();
        // A fresh memory is all zero.
        let yield_force_n = self.yield_force_n.max(kept_n);
        self.elastic(Plastic { indentation_m: memory.touch_m, yield_force_n })
    }

    fn force(&self, branch: &Branch, compression_m: f64, _rate_m_s: f64) -> Force {
        let force_n = self.stiffness_n_m * (compression_m - self.plastic(branch, compression_m).indentation_m);
        let part = if branch.stage == ELASTIC { 1.0 } else { 1.0 - self.share() };
        Force { force_n, per_compression_n_m: self.stiffness_n_m * part, per_rate_n_s_m: 0.0 }
    }

    fn stored_energy_j(&self, branch: &Branch, compression_m: f64) -> f64 {
        let force_n = self.force(branch, compression_m, 0.0).force_n.max(0.0);
        let slope_n_m = self.stiffness_n_m * (1.0 - self.share());
        if branch.stage == BACKWARDS {
            return 0.5 * force_n * force_n / slope_n_m;
        }
        // Unloading is elastic down to the lower limit, and yields from there.
        let lower = self.range(self.plastic(branch, compression_m)).0.min(force_n);
        0.5 * (force_n * force_n - lower * lower) / self.stiffness_n_m + 0.5 * lower * lower / slope_n_m
    }

    fn boundary(&self, branch: &Branch, which: usize) -> Option<Boundary> {
        let start = Plastic::from(branch.internal);
        match (branch.stage, which) {
            (ELASTIC, 0) => {
                let lower_m = self.range(start).0 / self.stiffness_n_m;
                Some(Boundary::compression_falls_to(start.indentation_m + lower_m))
            }
            (ELASTIC, 1) => {
                let upper_m = self.range(start).1 / self.stiffness_n_m;
                Some(Boundary::compression_rises_to(start.indentation_m + upper_m))
            }
            (FORWARDS, 0) => Some(Boundary::rate_falls_to(0.0)),
            (BACKWARDS, 0) => {
                // The compression at which the force vanishes, by its constant slope.
                let force_n = self.force(branch, branch.anchor_m, 0.0).force_n;
                let slope_n_m = self.stiffness_n_m * (1.0 - self.share());
                Some(Boundary::compression_falls_to(branch.anchor_m - force_n / slope_n_m))
            }
            (BACKWARDS, 1) => Some(Boundary::rate_rises_to(0.0)),
            _ => None,
        }
    }

    fn cross(&self, branch: &Branch, which: usize, compression_m: f64, _rate_m_s: f64) -> After {
        let plastic = self.plastic(branch, compression_m);
        let yields = |stage| After::Continue(Branch { stage, anchor_m: compression_m, internal: plastic.into() });
        match (branch.stage, which) {
            (ELASTIC, 1) => yields(FORWARDS),
            (ELASTIC, _) if self.range(plastic).0 > 0.0 => yields(BACKWARDS),
            (ELASTIC, _) | (BACKWARDS, 0) => {
                let Plastic { indentation_m, yield_force_n } = plastic;
                After::Release(Memory { touch_m: indentation_m, internal: [yield_force_n].into() })
            }
            _ => After::Continue(self.elastic(plastic)),
        }
    }
}
// ANCHOR_END: law
