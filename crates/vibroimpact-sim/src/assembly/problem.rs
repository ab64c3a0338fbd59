//! The mechanical problem: bodies with their modes, contacts between their points, and loads.

pub use crate::panel::oscillator::BodyMode;
use contact_models::ContactLaw;
use invalid_input::InvalidInput;

/// Bounds on magnitudes: wide enough for any system of units, narrow enough that no product overflows.
pub(crate) const SCALE_MAX: f64 = 1e30;
/// The steepest change of a sampled force (N/s).
const SLOPE_MAX_N_S: f64 = 1e60;
/// Largest frequency (rad/s). No structure has higher ones; the limit keeps every power of them finite.
const OMEGA_MAX_RAD_S: f64 = 1e15;
/// Least frequency of an elastic mode (rad/s), with a period far beyond the age of the universe. Static deflections, which grow with its
/// inverse square, stay within the range of the solver.
const OMEGA_MIN_RAD_S: f64 = 1e-30;
/// The allowed frequencies of a mode.
pub(crate) const OMEGA_ALLOWED: &str = "0 for a rigid body, or a number from 1e-30 to 1e15 rad/s";
/// Smallest tolerance.
pub(crate) const FINEST_TOLERANCE: f64 = 1e-13;
/// The largest steady motion of a rigid mode at a contact (m): rounding is then below 1e-9 m.
const STEADY_MAX_M: f64 = 1e6;
/// A harmonic load whose frequency is closer than this (relative) to that of an undamped mode which it excites is resonant.
const RESONANCE: f64 = 1e-9;

/// A linear body: its modes, and their motion at the start.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Body {
    /// The mass-normalised modes, in any order.
    pub modes: Vec<BodyMode>,
    /// Modal amplitudes `a_k` at the start (m kg^1/2), one for each mode.
    pub amplitude: Vec<f64>,
    /// Their rates (m kg^1/2 / s), one for each mode.
    pub rate: Vec<f64>,
}

impl Body {
    /// A compact body, which moves along `x` without vibrating: one rigid mode, whose shape at any point is
    /// `mass_kg^(-1/2)`.
    pub fn mass(mass_kg: f64, position_m: f64, velocity_m_s: f64) -> Body {
        let root = mass_kg.sqrt();
        Body {
            modes: vec![BodyMode { omega_rad_s: 0.0, damping_ratio: 0.0 }],
            amplitude: vec![root * position_m],
            rate: vec![root * velocity_m_s],
        }
    }

    /// A body with these modes, undeformed and at rest.
    pub fn at_rest(modes: Vec<BodyMode>) -> Body {
        let zeros = vec![0.0; modes.len()];
        Body { amplitude: zeros.clone(), rate: zeros, modes }
    }
}

/// One side of a contact.
#[derive(Debug, Clone, PartialEq)]
pub enum Point {
    /// The ground, which does not move.
    Ground,
    /// A point of a body, by the mass-normalised shapes of the body's modes there (kg^-1/2).
    OfBody {
        /// Index of the body in [`Assembly::bodies`], from 0.
        body: usize,
        /// `phi_k` at the point (kg^-1/2), one value for each mode.
        shape: Vec<f64>,
    },
}

/// A contact of two points along `x`. The first lies on the side of greater `x`; the force pushes it along `+x` and the
/// second along `-x`.
#[derive(Debug, Clone, PartialEq)]
pub struct Contact<L> {
    /// The two points.
    pub sides: [Point; 2],
    /// Distance of the two surfaces when both bodies are undeformed and in place (m); negative for an interference.
    pub gap_m: f64,
    /// The force-compression law.
    pub law: L,
}

/// A force as a function of time.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Force {
    /// Constant from the start.
    Constant {
        /// The force (N).
        force_n: f64,
    },
    /// `force_n sin(omega_rad_s t + phase_rad)`.
    Harmonic {
        /// Amplitude (N).
        force_n: f64,
        /// Circular frequency (rad/s), positive.
        omega_rad_s: f64,
        /// Phase at the start (rad).
        phase_rad: f64,
    },
    /// Piecewise linear between measured or stated values; zero before the first and after the last.
    Sampled {
        /// Times (s), ascending; equal neighbours make a jump.
        times_s: Vec<f64>,
        /// Forces at these times (N).
        forces_n: Vec<f64>,
    },
}

/// A load on a body.
#[derive(Debug, Clone, PartialEq)]
pub struct Load {
    /// Index of the body in [`Assembly::bodies`], from 0.
    pub body: usize,
    /// Modal force per unit of [`Load::force`]: the shapes at the loaded point (kg^-1/2) for a force in N; the modes'
    /// participation `int m phi_k dx` (kg^1/2) for an acceleration field, whose "force" is then in m/s^2.
    pub shape: Vec<f64>,
    /// The force, positive along `+x`.
    pub force: Force,
}

/// Bodies, contacts and loads.
#[derive(Debug, Clone, PartialEq)]
pub struct Assembly<L> {
    /// The bodies.
    pub bodies: Vec<Body>,
    /// The contacts between them.
    pub contacts: Vec<Contact<L>>,
    /// The loads on them.
    pub loads: Vec<Load>,
}

/// Accuracy and end of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Time at which the run ends (s); infinity only with `stop_when_over`.
    pub end_s: f64,
    /// Allowed error of the impulse on a step, relative to the largest momentum exchanged by its contact so far: 1e-13 to 0.1.
    /// Default 1e-9.
    pub tolerance: f64,
    /// Stop after this many steps, of contacts and flights together. Default 2,000,000,000.
    pub max_steps: u64,
    /// Stop after this many intervals of contact. Default 100,000,000.
    pub max_intervals: u64,
    /// End the run, [`super::Outcome::Rest`], once it is certain that no contact opens or closes any more. Default true.
    pub stop_at_rest: bool,
    /// Without loads: end the run, [`super::Outcome::Parted`], once all contacts are open and none can ever close again,
    /// at the time at which the last one opened, or, as at rest, once the energy of the remaining motion is below the error that
    /// the tolerance allows for a contact. Default false.
    pub stop_when_over: bool,
    /// With that, one contact, and constant loads that press its first side onto the second, as a ball is by its weight: end the run in
    /// the same way at the first separation after which this side turns round where it is displaced by more than this (m), which
    /// may be negative. A run that waits for it does not end during the first interval of contact, or before four times its duration
    /// have passed since; if the side rises and turns down again within that interval, this counts in its place. Default infinity.
    pub over_above_m: f64,
    /// Rest is not checked before this time (s). Default 0.
    pub rest_from_s: f64,
    /// Statistics of the contacts cover the motion from this time on (s), less than `end_s`. Default 0, the whole run.
    pub statistics_from_s: f64,
}

impl Settings {
    /// The defaults, for a run that ends at `end_s`.
    pub fn until(end_s: f64) -> Settings {
        Settings {
            end_s,
            tolerance: 1e-9,
            max_steps: 2_000_000_000,
            max_intervals: 100_000_000,
            stop_at_rest: true,
            stop_when_over: false,
            over_above_m: f64::INFINITY,
            rest_from_s: 0.0,
            statistics_from_s: 0.0,
        }
    }

    pub(crate) fn check(&self) -> Result<(), InvalidInput> {
        let endless = self.stop_when_over && self.end_s == f64::INFINITY;
        let within = (0.0..=1e12).contains(&self.end_s) && self.end_s > 0.0;
        InvalidInput::unless(within || endless, "end_s", self.end_s, "a positive number of at most 1e12 s")?;
        let from = (0.0..=SCALE_MAX).contains(&self.rest_from_s);
        InvalidInput::unless(
            from,
            "rest_from_s",
            self.rest_from_s,
            "0 or a positive number of seconds, and at most 1e30",
        )?;
        InvalidInput::unless(!self.over_above_m.is_nan(), "over_above_m", self.over_above_m, "a number, or infinity")?;
        let before_end = self.statistics_from_s >= 0.0 && self.statistics_from_s < self.end_s;
        let allowed = "0 or a positive number of seconds, and less than end_s";
        InvalidInput::unless(before_end, "statistics_from_s", self.statistics_from_s, allowed)?;
        InvalidInput::unless(
            (FINEST_TOLERANCE..=0.1).contains(&self.tolerance),
            "tolerance",
            self.tolerance,
            "a number from 1e-13 to 0.1",
        )?;
        InvalidInput::unless(self.max_steps > 0, "max_steps", self.max_steps, "at least 1")?;
        InvalidInput::unless(self.max_intervals > 0, "max_intervals", self.max_intervals, "at least 1")
    }
}

const FINITE: &str = "a finite number of at most 1e30 in size";

fn is_finite(value: f64) -> bool {
    value.abs() <= SCALE_MAX
}

/// Checks that there are so many values, and that all lie in the range of the solver.
pub(crate) fn require_all_finite(values: &[f64], count: usize, field: &'static str) -> Result<(), InvalidInput> {
    InvalidInput::unless(
        values.len() == count,
        field,
        format!("{} values", values.len()),
        "a list with one value for each mode",
    )?;
    let wrong = values.iter().position(|value| !is_finite(*value));
    wrong.map_or(Ok(()), |k| Err(InvalidInput::new((field, k), values[k], FINITE)))
}

/// An assembly with laws of any type by reference, so that the engine is compiled only once.
pub(crate) struct Posed<'a> {
    pub bodies: &'a [Body],
    /// The two sides of every contact.
    pub sides: Vec<&'a [Point; 2]>,
    pub gaps_m: Vec<f64>,
    pub laws: Vec<&'a dyn ContactLaw>,
    pub loads: &'a [Load],
}

impl<L: ContactLaw> Assembly<L> {
    pub(crate) fn posed(&self) -> Posed<'_> {
        self.with_laws(self.contacts.iter().map(|contact| &contact.law as &dyn ContactLaw).collect())
    }
}

impl<L> Assembly<L> {
    /// With other laws, one for each contact.
    pub(crate) fn with_laws<'a>(&'a self, laws: Vec<&'a dyn ContactLaw>) -> Posed<'a> {
        Posed {
            bodies: &self.bodies,
            sides: self.contacts.iter().map(|contact| &contact.sides).collect(),
            gaps_m: self.contacts.iter().map(|contact| contact.gap_m).collect(),
            laws,
            loads: &self.loads,
        }
    }

    /// Checks all numbers.
    ///
    /// # Errors
    /// The first field out of range, with its value and what would be allowed.
    pub fn check(&self) -> Result<(), InvalidInput> {
        for (i, body) in self.bodies.iter().enumerate() {
            body.check().map_err(|fault| fault.at(i).within("bodies"))?;
        }
        for (i, contact) in self.contacts.iter().enumerate() {
            let gap = is_finite(contact.gap_m);
            InvalidInput::unless(gap, ("contacts", i, "gap_m"), contact.gap_m, FINITE)?;
            for (side, point) in contact.sides.iter().enumerate() {
                if let Point::OfBody { body, shape } = point {
                    self.require_shape(*body, shape).map_err(|fault| fault.within(("contacts", i, ("sides", side))))?;
                }
            }
        }
        for (i, load) in self.loads.iter().enumerate() {
            self.check_load(load).map_err(|fault| fault.at(i).within("loads"))?;
        }
        Ok(())
    }

    /// A shape of a body that there is, with one value for each mode.
    fn require_shape(&self, body: usize, shape: &[f64]) -> Result<(), InvalidInput> {
        let found = self.bodies.get(body).map(|body| body.modes.len());
        let modes = found.ok_or_else(|| InvalidInput::new("body", body, "the index of a body, counted from 0"))?;
        require_all_finite(shape, modes, "shape")
    }

    fn check_load(&self, load: &Load) -> Result<(), InvalidInput> {
        self.require_shape(load.body, &load.shape)?;
        load.force.check().map_err(|fault| fault.within("force"))?;
        match load.force {
            Force::Harmonic { force_n, omega_rad_s, .. } => {
                self.require_no_resonance(load, omega_rad_s)?;
                self.require_no_drift(load, force_n, omega_rad_s)
            }
            _ => Ok(()),
        }
    }

    /// Rejects loads so slow that the steady motion of a rigid mode, `f/omega^2`, carries a contact far beyond any motion of interest,
    /// which is then lost in the rounding of the difference from it.
    fn require_no_drift(&self, load: &Load, force_n: f64, omega_rad_s: f64) -> Result<(), InvalidInput> {
        let carried_m = |shape: &[f64]| {
            let modes = self.bodies[load.body].modes.iter().zip(load.shape.iter().zip(shape));
            let rigid = modes.filter(|(mode, _)| mode.is_rigid());
            rigid.map(|(_, (loaded, psi))| (force_n * loaded * psi).abs() / omega_rad_s.powi(2)).fold(0.0, f64::max)
        };
        let far = self.contacts.iter().flat_map(|contact| &contact.sides).any(|side| match side {
            Point::OfBody { body, shape } => *body == load.body && carried_m(shape) > STEADY_MAX_M,
            Point::Ground => false,
        });
        let allowed = "so large that the steady motion of the free body, force/(mass omega^2), is at most 1e6 m; a slower load can be \
                       stated by its values at some times";
        InvalidInput::unless(!far, ["force", "omega_rad_s"], omega_rad_s, allowed)
    }

    /// Rejects loads at the frequency of an undamped mode, whose motion would grow without bound.
    fn require_no_resonance(&self, load: &Load, omega_rad_s: f64) -> Result<(), InvalidInput> {
        let modes = self.bodies[load.body].modes.iter().zip(&load.shape);
        let resonant = modes.filter(|(_, shape)| **shape != 0.0).any(|(mode, _)| {
            mode.damping_ratio < RESONANCE && (mode.omega_rad_s - omega_rad_s).abs() <= RESONANCE * omega_rad_s
        });
        InvalidInput::unless(
            !resonant,
            ["force", "omega_rad_s"],
            omega_rad_s,
            "other than the frequency of every undamped mode that the load excites; damping of that mode removes the resonance",
        )
    }
}

/// Whether a mode may have this frequency (rad/s).
pub(crate) fn is_frequency(omega_rad_s: f64) -> bool {
    omega_rad_s == 0.0 || (OMEGA_MIN_RAD_S..=OMEGA_MAX_RAD_S).contains(&omega_rad_s)
}

impl Body {
    fn check(&self) -> Result<(), InvalidInput> {
        for (k, mode) in self.modes.iter().enumerate() {
            let of = |quantity| ("modes", k, quantity);
            let omega = mode.omega_rad_s;
            InvalidInput::unless(is_frequency(omega), of("omega_rad_s"), omega, OMEGA_ALLOWED)?;
            let zeta = mode.damping_ratio;
            InvalidInput::unless((0.0..=1e6).contains(&zeta), of("damping_ratio"), zeta, "a number from 0 to 1e6")?;
        }
        require_all_finite(&self.amplitude, self.modes.len(), "amplitude")?;
        require_all_finite(&self.rate, self.modes.len(), "rate")
    }
}

impl Force {
    /// The largest it ever is, in size (N).
    pub(crate) fn largest(&self) -> f64 {
        match self {
            Force::Constant { force_n } | Force::Harmonic { force_n, .. } => force_n.abs(),
            Force::Sampled { forces_n, .. } => forces_n.iter().fold(0.0, |most, force| most.max(force.abs())),
        }
    }

    fn check(&self) -> Result<(), InvalidInput> {
        match self {
            Force::Constant { force_n } => InvalidInput::unless(is_finite(*force_n), "force_n", *force_n, FINITE),
            Force::Harmonic { force_n, omega_rad_s, phase_rad } => {
                InvalidInput::unless(is_finite(*force_n), "force_n", *force_n, FINITE)?;
                InvalidInput::unless(is_finite(*phase_rad), "phase_rad", *phase_rad, FINITE)?;
                let allowed = "a positive number of at most 1e15 rad/s";
                let within = *omega_rad_s > 0.0 && *omega_rad_s <= OMEGA_MAX_RAD_S;
                InvalidInput::unless(within, "omega_rad_s", *omega_rad_s, allowed)
            }
            Force::Sampled { times_s, forces_n } => {
                require_all_finite(times_s, times_s.len(), "times_s")?;
                let count = format!("{} values", forces_n.len());
                let equal = forces_n.len() == times_s.len();
                InvalidInput::unless(equal, "forces_n", count, "a list with one value for each time")?;
                require_all_finite(forces_n, times_s.len(), "forces_n")?;
                let wrong = (1..times_s.len()).find(|&i| times_s[i] < times_s[i - 1]);
                if let Some(i) = wrong {
                    return Err(InvalidInput::new(("times_s", i), times_s[i], "not less than the time before"));
                }
                let slope = |i: usize| (forces_n[i] - forces_n[i - 1]) / (times_s[i] - times_s[i - 1]);
                let steep = (1..times_s.len()).find(|&i| times_s[i] > times_s[i - 1] && slope(i).abs() > SLOPE_MAX_N_S);
                steep.map_or(Ok(()), |i| {
                    let allowed = "equal to the time before, for a jump, or so much later that the force changes by at most 1e60 N/s";
                    Err(InvalidInput::new(("times_s", i), times_s[i], allowed))
                })
            }
        }
    }
}
