//! The problem: a structure with its modes, a striker, and the initial motion.

use crate::assembly::BodyMode;
use crate::assembly::problem::{OMEGA_ALLOWED, SCALE_MAX, is_frequency, require_all_finite};
use beam_modes::PointMode;
use invalid_input::InvalidInput;

/// The least mass (kg), the reciprocal of the largest: wide enough for any unit system, narrow enough that no product overflows.
pub(super) const SCALE_MIN: f64 = 1e-30;
/// The least speed of approach (m/s): energies of slower motions are lost to underflow, and with them the proof that the impact is
/// over.
pub(super) const SPEED_MIN: f64 = 1e-60;
/// A mode that moves less than this (kg^-1/2) at the contact is not moved by it.
const SHAPE_FLOOR: f64 = 1e-30;
/// A mode is not excited whose share of every response at the contact is less than this. Shapes at their nodes have such shares,
/// from rounding.
const UNEXCITED: f64 = 1e-24;

/// One mode of the structure, as seen from the point of contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mode {
    /// Undamped circular frequency `omega_k` (rad/s); 0 for a rigid-body mode.
    pub omega_rad_s: f64,
    /// Damping ratio `zeta_k`; the modal equation contains `2 zeta_k omega_k`.
    pub damping_ratio: f64,
    /// Mass-normalised shape at the contact, `phi_k(b)` (kg^-1/2).
    pub shape: f64,
}

impl Mode {
    /// The mode without its shape.
    pub(crate) fn of_body(&self) -> BodyMode {
        BodyMode { omega_rad_s: self.omega_rad_s, damping_ratio: self.damping_ratio }
    }

    /// Whether the mode is a rigid-body motion.
    pub(crate) fn is_rigid(&self) -> bool {
        self.omega_rad_s == 0.0
    }

    /// Whether a force at the contact moves the mode at all.
    pub(crate) fn is_moved(&self) -> bool {
        self.shape.abs() > SHAPE_FLOOR
    }

    /// Speed and displacement of the contact after a unit impulse, and its displacement under a unit force, each at most.
    fn responses(&self) -> [f64; 3] {
        let square = self.shape * self.shape;
        [square, square / self.omega_rad_s, square / self.omega_rad_s / self.omega_rad_s]
    }
}

/// Indices of the modes that move the contact: those that it excites, and those that move it before the impact.
pub(crate) fn moved(modes: &[Mode], start: Option<&Start>) -> Vec<usize> {
    let mut total = [0.0; 3];
    for mode in modes.iter().filter(|mode| mode.is_moved() && !mode.is_rigid()) {
        total.iter_mut().zip(mode.responses()).for_each(|(total, response)| *total += response);
    }
    let excited = |mode: &Mode| mode.responses().iter().zip(total).any(|(response, all)| *response >= UNEXCITED * all);
    let moves = |k: usize| {
        let of = |values: &[f64]| values.get(k).is_some_and(|value| *value != 0.0);
        start.is_some_and(|start| of(&start.amplitude) || of(&start.rate))
    };
    let counts = |k: usize, mode: &Mode| mode.is_moved() && (mode.is_rigid() || excited(mode) || moves(k));
    modes.iter().enumerate().filter(|(k, mode)| counts(*k, mode)).map(|(k, _)| k).collect()
}

/// Motion of the contact by the rigid-body modes, from a number for each mode.
pub(crate) fn rigid_motion(modes: &[Mode], of_modes: &[f64]) -> f64 {
    modes.iter().zip(of_modes).filter(|(mode, _)| mode.is_rigid()).map(|(mode, value)| mode.shape * value).sum()
}

/// As [`Structure::mobility_per_kg`].
pub(crate) fn mobility(modes: &[Mode], striker: &Striker) -> f64 {
    let rigid = modes.iter().filter(|mode| mode.is_rigid());
    striker.mass_kg.recip() + rigid.map(|mode| mode.shape * mode.shape).sum::<f64>()
}

/// As [`Structure::approach_m_s`].
pub(crate) fn approach(modes: &[Mode], striker: &Striker, start: &Start) -> f64 {
    striker.speed_m_s + rigid_motion(modes, &start.rate)
}

/// Height of the striker above the undeflected structure at the start (m).
pub(crate) fn height_m(modes: &[Mode], start: &Start) -> f64 {
    let deflection: f64 = modes.iter().zip(&start.amplitude).map(|(mode, amplitude)| mode.shape * amplitude).sum();
    start.gap_m + deflection
}

/// Speed with which a striker would arrive at the undeflected structure, from its speed and height (m/s).
pub(crate) fn arrives_m_s(gravity_m_s2: f64, speed_m_s: f64, height_m: f64) -> f64 {
    (speed_m_s.powi(2) + 2.0 * gravity_m_s2 * height_m).max(0.0).sqrt()
}

/// A linear structure, as seen from the contact. Truncated modes are best represented by remainder modes
/// ([`beam_modes::remainder_modes`]), which are modes like any other.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Structure {
    /// The modes, in any order. An empty list is a rigid, immovable structure.
    pub modes: Vec<Mode>,
}

impl Structure {
    /// The structure of these modes, all with one damping ratio: natural modes and, for the truncated ones, remainder modes.
    ///
    /// ```
    /// use beam_modes::{Beam, End, Segment};
    /// use vibroimpact_sim::modal::Structure;
    ///
    /// let segment = Segment { length_m: 1.0, flexural_rigidity_n_m2: 275.0, mass_per_length_kg_m: 1.0 };
    /// let beam = Beam { segments: vec![segment], ends: [End::Pinned, End::Pinned] };
    /// let kept = beam.modes(40)?.seen_from(0.4)?;
    /// let remainder = beam.remainder(0.4, 40, 2)?;
    /// let structure = Structure::from_modes(kept.into_iter().chain(remainder), 0.02);
    /// assert!(structure.modes.len() == 42 && structure.modes[41].damping_ratio == 0.02);
    /// # Ok::<(), vibroimpact_sim::InvalidInput>(())
    /// ```
    pub fn from_modes(modes: impl IntoIterator<Item = PointMode>, damping_ratio: f64) -> Structure {
        let damped = |PointMode { omega_rad_s, shape }| Mode { omega_rad_s, damping_ratio, shape };
        Structure { modes: modes.into_iter().map(damped).collect() }
    }

    /// Relative velocity of the rigid-body motions of structure and striker per impulse between them (1/kg): `1/m + sum phi^2`.
    pub fn mobility_per_kg(&self, striker: &Striker) -> f64 {
        mobility(&self.modes, striker)
    }

    /// Velocity with which these motions approach each other (m/s). Under gravity (m/s^2) it is that with which the striker would arrive
    /// at the undeflected structure.
    pub fn approach_m_s(&self, striker: &Striker, start: &Start, gravity_m_s2: f64) -> f64 {
        if gravity_m_s2 == 0.0 {
            approach(&self.modes, striker, start)
        } else {
            arrives_m_s(gravity_m_s2, striker.speed_m_s, height_m(&self.modes, start))
        }
    }

    /// Checks that every number lies in the range of the solver.
    ///
    /// # Errors
    /// Names the field, its value and what would be allowed.
    pub fn check(&self) -> Result<(), InvalidInput> {
        for (k, mode) in self.modes.iter().enumerate() {
            let fault = |field, value: f64, allowed| Err(InvalidInput::new(("modes", k, field), value, allowed));
            if !is_frequency(mode.omega_rad_s) {
                return fault("omega_rad_s", mode.omega_rad_s, OMEGA_ALLOWED);
            }
            if !(0.0..=1e6).contains(&mode.damping_ratio) {
                return fault("damping_ratio", mode.damping_ratio, "a number from 0 to 1e6");
            }
            if mode.shape.is_nan() || mode.shape.abs() > SCALE_MAX {
                return fault("shape", mode.shape, "a finite number of at most 1e30 in size");
            }
        }
        Ok(())
    }
}

/// The compact body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Striker {
    /// Mass (kg); `f64::INFINITY` makes it an immovable stop.
    pub mass_kg: f64,
    /// Speed towards the structure (m/s); negative when it moves away.
    pub speed_m_s: f64,
}

impl Striker {
    /// Checks that mass and speed lie in the range of the solver.
    ///
    /// # Errors
    /// Names the field, its value and what would be allowed.
    ///
    /// ```
    /// use vibroimpact_sim::modal::Striker;
    ///
    /// let error = Striker { mass_kg: 0.0, speed_m_s: 1.0 }.check().unwrap_err();
    /// assert!(error.to_string().contains("mass_kg"));
    /// ```
    pub fn check(&self) -> Result<(), InvalidInput> {
        let mass = self.mass_kg;
        InvalidInput::unless(
            (SCALE_MIN..=SCALE_MAX).contains(&mass) || mass == f64::INFINITY,
            "mass_kg",
            mass,
            "a positive number from 1e-30 to 1e30, or infinity for an immovable stop",
        )?;
        InvalidInput::unless(
            self.speed_m_s == 0.0 || (SPEED_MIN..=SCALE_MAX).contains(&self.speed_m_s.abs()),
            "speed_m_s",
            self.speed_m_s,
            "0, or a number from 1e-60 to 1e30 in size",
        )
    }
}

/// Motion of the structure at the start, and initial distance of the striker.
#[derive(Debug, Clone, PartialEq)]
pub struct Start {
    /// Modal amplitudes `a_k` (m kg^1/2), one for each mode.
    pub amplitude: Vec<f64>,
    /// Their rates (m kg^1/2 / s), one for each mode.
    pub rate: Vec<f64>,
    /// Distance from the striker to the structure's deflected surface (m); 0 is touching.
    pub gap_m: f64,
}

impl Start {
    /// A structure of `modes` modes at rest, touched by the striker.
    pub fn at_rest(modes: usize) -> Start {
        Start { amplitude: vec![0.0; modes], rate: vec![0.0; modes], gap_m: 0.0 }
    }

    /// Checks that there is one value for each of so many modes, and that all lie in the range of the solver.
    ///
    /// # Errors
    /// Names the field, its value and what would be allowed.
    pub fn check(&self, modes: usize) -> Result<(), InvalidInput> {
        require_all_finite(&self.amplitude, modes, "amplitude")?;
        require_all_finite(&self.rate, modes, "rate")?;
        InvalidInput::unless(
            (0.0..=SCALE_MAX).contains(&self.gap_m),
            "gap_m",
            self.gap_m,
            "0, if the bodies touch, or a positive finite number",
        )
    }
}

/// Accuracy and extent of the solution.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Requested accuracy of the impulse of each contact, relative to the striker's momentum: 1e-13 to 0.1. Default 1e-9.
    /// The result of an impact that amplifies errors is less accurate; see `Solution::restitution_uncertainty`.
    pub tolerance: f64,
    /// Solve again, more coarsely, to estimate the uncertainty of the restitution. Default true.
    pub estimate_uncertainty: bool,
    /// Solve these coarser problems in a thread beside the impact. The result is the same to the last bit, a single impact takes
    /// less time, and many impacts in parallel take a little more. Default false.
    pub concurrent: bool,
    /// Stop after this many contacts ([`StopReason::SubImpacts`](crate::StopReason)). Default 10,000.
    pub max_sub_impacts: usize,
    /// Stop after this many steps in contact ([`StopReason::Steps`](crate::StopReason)), or in the search for contacts
    /// ([`StopReason::Flight`](crate::StopReason)). Default 200,000; an ordinary impact needs hundreds.
    pub max_steps: u64,
    /// Compute a sustained contact at least up to this time (s), for the history of a recorded impact. After a rebound the history
    /// is known for all times. Default 0: up to the time at which the contact is known to last.
    pub until_s: f64,
}

impl Default for Settings {
    fn default() -> Settings {
        Settings {
            tolerance: 1e-9,
            estimate_uncertainty: true,
            concurrent: false,
            max_sub_impacts: 10_000,
            max_steps: 200_000,
            until_s: 0.0,
        }
    }
}

impl Settings {
    /// Checks that every setting lies in the range of the solver.
    ///
    /// # Errors
    /// Names the field, its value and what would be allowed.
    pub fn check(&self) -> Result<(), InvalidInput> {
        InvalidInput::unless(
            (1e-13..=0.1).contains(&self.tolerance),
            "tolerance",
            self.tolerance,
            "a number from 1e-13 to 0.1",
        )?;
        InvalidInput::unless(self.max_sub_impacts > 0, "max_sub_impacts", self.max_sub_impacts, "at least 1")?;
        InvalidInput::unless(self.max_steps > 0, "max_steps", self.max_steps, "at least 1")?;
        let until = (0.0..=SCALE_MAX).contains(&self.until_s);
        InvalidInput::unless(until, "until_s", self.until_s, "0 or a positive number of seconds, and at most 1e30")
    }
}
