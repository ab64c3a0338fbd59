//! Common parts of the tests of the modal impact: the thesis's beam, and a plain Runge-Kutta integration.
#![allow(dead_code, reason = "examples use a part of it")]

pub mod random;

use beam_modes::{Beam, End, RectangularSegment, Segment};
use contact_models::{After, Boundary, Branch, ContactLaw, Force, Hertz, Law, Memory, boundaries};
use std::f64::consts::PI;
use vibroimpact_sim::assembly::{Interval, Observer};
use vibroimpact_sim::modal::{Mode, Parameter, Posing, Settings, Solution, Solver, Start, Striker, Structure};

/// Collects the intervals of all contacts, each with the number of its contact, and requests the energy ledger.
#[derive(Default)]
pub struct Intervals(pub Vec<(usize, Interval)>);

impl Observer for Intervals {
    fn interval(&mut self, contact: usize, interval: &Interval) {
        self.0.push((contact, *interval));
    }

    fn wants_energy(&self) -> bool {
        true
    }
}

/// Hertz's law with further boundaries before its own, which must never be reached.
pub struct Bounded {
    pub hertz: Hertz,
    pub further: Vec<Boundary>,
}

impl ContactLaw for Bounded {
    fn touch(&self, memory: &Memory, approach_speed_m_s: f64) -> Branch {
        self.hertz.touch(memory, approach_speed_m_s)
    }

    fn force(&self, branch: &Branch, compression_m: f64, rate_m_s: f64) -> Force {
        self.hertz.force(branch, compression_m, rate_m_s)
    }

    fn stored_energy_j(&self, branch: &Branch, compression_m: f64) -> f64 {
        self.hertz.stored_energy_j(branch, compression_m)
    }

    fn boundary(&self, branch: &Branch, which: usize) -> Option<Boundary> {
        match which.checked_sub(self.further.len()) {
            Some(own) => self.hertz.boundary(branch, own),
            None => Some(self.further[which]),
        }
    }

    fn cross(&self, branch: &Branch, which: usize, compression_m: f64, rate_m_s: f64) -> After {
        self.hertz.cross(branch, which.saturating_sub(self.further.len()), compression_m, rate_m_s)
    }
}

/// (sqrt 5 - 1) / 2, the thesis's second location on the unit beam (m).
pub const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// The pinned-pinned beam of thesis chapter 3 in its first `n` modes, struck at `b` (m).
pub fn pinned(n: usize, damping_ratio: f64, b: f64) -> Structure {
    let side: f64 = 0.011323;
    let (mass, rigidity) = (7800.0 * side * side, 2e11 * side.powi(4) / 12.0);
    let mode = |k: usize| {
        let q = k as f64 * PI;
        Mode {
            omega_rad_s: q * q * (rigidity / mass).sqrt(),
            damping_ratio,
            shape: (2.0 / mass).sqrt() * (q * b).sin(),
        }
    };
    Structure { modes: (1..=n).map(mode).collect() }
}

/// Differences of four neighbouring values of a parameter from the value.
pub const OFFSETS: [f64; 4] = [-2e-5, -1e-5, 1e-5, 2e-5];

/// That beam at neighbouring values of its damping, and at neighbouring places.
pub fn near_pinned(n: usize) -> [[Structure; 4]; 2] {
    [OFFSETS.map(|by| pinned(n, 0.02 + by, GOLDEN)), OFFSETS.map(|by| pinned(n, 0.02, GOLDEN + by))]
}

/// Ten parameters that change these structures in turn.
pub fn ten_parameters<'a>(
    near: &'a [[Structure; 4]; 2],
    striker: &'a Striker,
    law: &'a Law,
    start: &'a Start,
) -> Vec<Parameter<'a>> {
    let of = |near: &'a [Structure; 4]| Parameter {
        offsets: OFFSETS,
        neighbours: near.each_ref().map(|structure| Posing { structure, striker, law, start, gravity_m_s2: 0.0 }),
        changes_law: false,
    };
    near.iter().cycle().take(10).map(of).collect()
}

/// The same with two remainder modes for all higher modes.
pub fn pinned_with_remainder(n: usize, damping_ratio: f64, b: f64) -> Structure {
    let beam = Beam {
        segments: vec![Segment::from(RectangularSegment {
            length_m: 1.0,
            youngs_modulus_pa: 2e11,
            density_kg_m3: 7800.0,
            width_m: 0.011323,
            thickness_m: 0.011323,
        })],
        ends: [End::Pinned; 2],
    };
    let mut structure = pinned(n, damping_ratio, b);
    structure.modes.extend(Structure::from_modes(beam.remainder(b, n, 2).unwrap(), damping_ratio).modes);
    structure
}

/// Modes of a beam at a location, all with one damping ratio.
pub fn seen_from(beam: &Beam, x_m: f64, count: usize, damping_ratio: f64) -> Structure {
    Structure::from_modes(beam.modes(count).unwrap().seen_from(x_m).unwrap(), damping_ratio)
}

/// Hertz contact of the thesis's 3 cm ball.
pub fn hertz() -> Law {
    Law::Hertz(Hertz::new(1.7945e10).unwrap())
}

/// The thesis's 3 cm steel ball at 1 m/s.
pub fn ball() -> Striker {
    Striker { mass_kg: 0.11027, speed_m_s: 1.0 }
}

pub fn settings(tolerance: f64) -> Settings {
    Settings { tolerance, ..Settings::default() }
}

pub fn solve(structure: &Structure, tolerance: f64) -> Solution {
    Solver::new(structure).unwrap().solve(&ball(), &hertz(), None, &settings(tolerance)).unwrap()
}

/// The striker's velocity at `end_s`, away from the structure, by [`second_method`].
pub fn runge_kutta(structure: &Structure, striker: &Striker, law: &Law, end_s: f64, tolerance: f64) -> f64 {
    second_method(structure, striker, law, end_s, tolerance).velocity_m_s
}

/// The result of the second method.
pub struct Found {
    pub displacement_m: f64,
    pub velocity_m_s: f64,
    /// Starts of contacts (s).
    pub touches_s: Vec<f64>,
}

/// The same equations in one vector, by an adaptive Dormand-Prince 5(4) pair: displacement and velocity of the striker and of
/// every mode, for a structure at rest that the striker touches. Flights are integrated as well; every end of a branch of the
/// law, every release and every touch is located, and the integration restarts after it.
pub fn second_method(
    structure: &Structure,
    striker: &Striker,
    law: &dyn ContactLaw,
    end_s: f64,
    tolerance: f64,
) -> Found {
    second_method_under(0.0, structure, striker, law, end_s, tolerance)
}

/// The same with gravity on the striker (m/s^2).
pub fn second_method_under(
    gravity_m_s2: f64,
    structure: &Structure,
    striker: &Striker,
    law: &dyn ContactLaw,
    end_s: f64,
    tolerance: f64,
) -> Found {
    let n = structure.modes.len();
    // Compression and its rate.
    let seen = |y: &[f64]| {
        let modes = structure.modes.iter().zip(y[2..].chunks_exact(2));
        modes.fold((-y[0], -y[1]), |(xi, rate), (mode, y)| (xi + mode.shape * y[0], rate + mode.shape * y[1]))
    };
    let slope = |branch: Option<&Branch>, y: &[f64], dy: &mut [f64]| {
        let (xi, rate) = seen(y);
        let force = branch.map_or(0.0, |branch| law.force(branch, xi, rate).force_n);
        (dy[0], dy[1]) = (y[1], force / striker.mass_kg - gravity_m_s2);
        for (k, mode) in structure.modes.iter().enumerate() {
            let (a, v) = (y[2 + 2 * k], y[3 + 2 * k]);
            dy[2 + 2 * k] = v;
            dy[3 + 2 * k] =
                -2.0 * mode.damping_ratio * mode.omega_rad_s * v - mode.omega_rad_s.powi(2) * a - mode.shape * force;
        }
    };
    // Scales of the error: velocities by the approach speed, displacements by the distance it covers in the fastest period.
    let fastest = structure.modes.iter().map(|mode| mode.omega_rad_s).fold(1e4, f64::max);
    let scale = |i: usize| striker.speed_m_s * if i.is_multiple_of(2) { 1.0 / fastest } else { 1.0 };
    let mut y = vec![0.0; 2 * n + 2];
    y[1] = -striker.speed_m_s;
    let (mut time_s, mut memory, mut touches_s) = (0.0, Memory::default(), vec![0.0]);
    let mut branch = Some(law.touch(&memory, striker.speed_m_s));
    while time_s < end_s {
        let margins = |y: &[f64]| {
            let (xi, rate) = seen(y);
            match &branch {
                Some(branch) => boundaries(law, branch).map(|boundary| boundary.margin(xi, rate)).collect(),
                None => vec![memory.touch_m - xi],
            }
        };
        let met = |y: &[f64]| margins(y).iter().any(|margin| *margin < 0.0);
        let span = (time_s, end_s, 1e-3 / fastest);
        time_s = dormand_prince_until(|_, y, dy| slope(branch.as_ref(), y, dy), scale, &mut y, span, tolerance, met);
        let (xi, rate) = seen(&y);
        let which = margins(&y).iter().position(|margin| *margin < 0.0);
        branch = match (branch, which) {
            (same, None) => same,
            (None, Some(_)) => {
                touches_s.push(time_s);
                Some(law.touch(&memory, rate.max(0.0)))
            }
            (Some(branch), Some(which)) => match law.cross(&branch, which, xi, rate) {
                After::Continue(next) => Some(next),
                After::Release(left) => {
                    memory = left;
                    None
                }
            },
        };
    }
    Found { displacement_m: y[0], velocity_m_s: y[1], touches_s }
}

/// Integrates `y' = f(t, y)` between these times, with a given first step, by an adaptive Dormand-Prince 5(4) pair: the error
/// of a step in component `i` is kept below `tolerance * scale(i)`.
pub fn dormand_prince(
    slope: impl Fn(f64, &[f64], &mut [f64]),
    scale: impl Fn(usize) -> f64,
    y: &mut Vec<f64>,
    span_s: (f64, f64, f64),
    tolerance: f64,
) {
    dormand_prince_until(slope, scale, y, span_s, tolerance, |_| false);
}

/// The same until `met` is true for the first time, which is located to the last few digits. Returns that time, or the end.
pub fn dormand_prince_until(
    slope: impl Fn(f64, &[f64], &mut [f64]),
    scale: impl Fn(usize) -> f64,
    y: &mut Vec<f64>,
    (start_s, end_s, first_s): (f64, f64, f64),
    tolerance: f64,
    met: impl Fn(&[f64]) -> bool,
) -> f64 {
    const A: [[f64; 6]; 6] = [
        [1.0 / 5.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [3.0 / 40.0, 9.0 / 40.0, 0.0, 0.0, 0.0, 0.0],
        [44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0, 0.0, 0.0, 0.0],
        [19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0, 0.0, 0.0],
        [9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0, 0.0],
        [35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0],
    ];
    const E: [f64; 7] =
        [71.0 / 57600.0, 0.0, -71.0 / 16695.0, 71.0 / 1920.0, -17253.0 / 339200.0, 22.0 / 525.0, -1.0 / 40.0];
    const C: [f64; 6] = [0.2, 0.3, 0.8, 8.0 / 9.0, 1.0, 1.0];
    // A step as short as this has located the condition.
    const LAST: f64 = 1e-15;
    let size = y.len();
    let mut k = vec![vec![0.0; size]; 7];
    slope(start_s, y, &mut k[0]);
    let (mut t, mut h, mut longest) = (start_s, first_s, f64::INFINITY);
    while t < end_s {
        h = h.min(end_s - t);
        let mut trial = y.clone();
        for stage in 0..6 {
            for i in 0..size {
                trial[i] = y[i] + h * (0..=stage).map(|s| A[stage][s] * k[s][i]).sum::<f64>();
            }
            let mut next = std::mem::take(&mut k[stage + 1]);
            slope(t + C[stage] * h, &trial, &mut next);
            k[stage + 1] = next;
        }
        let error =
            (0..size).map(|i| (h * (0..7).map(|s| E[s] * k[s][i]).sum::<f64>()).abs() / scale(i)).fold(0.0, f64::max);
        if error <= tolerance {
            if met(&trial) {
                if h <= LAST * t.max(first_s) {
                    *y = trial;
                    return t + h;
                }
                // From here the steps are halved, up to the event and not beyond.
                longest = 0.5 * h;
                h = longest;
                continue;
            }
            t += h;
            *y = trial;
            k.swap(0, 6);
        }
        h = longest.min(h * (0.9 * (tolerance / error.max(1e-300)).powf(0.2)).clamp(0.2, 5.0));
    }
    t
}
