//! Frequencies and shapes of the modes, their derivatives, and the effect of their errors on other derivatives.
//!
//! The neighbours magnify the errors of the modes by the inverse of their distance. These errors are rounding for a beam, and a
//! hundred times larger for a plate by Ritz's method, so they are taken from the neighbours themselves.

use vibroimpact_sim::modal::Derivative;

use super::neighbours::{Neighbours, roughness};
use crate::same_modes::Seen;

/// Number of modes, from the lowest, whose frequencies and shapes are differentiated too.
pub(super) const MODES: usize = 10;

/// Least error of a frequency relative to itself, and of a shape relative to the largest one.
const LEAST: f64 = 2e-13;
/// Number of draws of the signs of the errors, for each of which their effect is computed.
const DRAWS: usize = 3;
/// Relative change of a frequency or shape by which the effect is computed.
const CHANGE: f64 = 1e-6;
/// Factor from the root mean square of the effects to the uncertainty.
const TIMES: f64 = 2.0;

/// The modes of a scene, body by body, their neighbours for each field, and their errors.
pub(super) struct Modes {
    here: Vec<Vec<Seen>>,
    near: Vec<Neighbours<Vec<Vec<Seen>>>>,
    /// The kind of each field; `None` for a field that does not change the modes.
    kinds: Vec<Option<Kind>>,
    /// By kind.
    errors: [Errors; 3],
}

/// The errors of the modes depend on the field: a plate's shapes do not change with its thickness, but are computed anew if its
/// length changes.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Kind {
    /// The same modes are seen at another point.
    Place = 0,
    /// The modes change, and their errors are those of rounding.
    Smooth = 1,
    /// Their errors are larger.
    Rough = 2,
}

/// Largest relative error of the middle mode by rounding. The last modes are often remainder modes, whose errors are larger in any
/// case.
const SMOOTH: f64 = 10.0 * LEAST;

/// Errors of the modes at the neighbours of the fields of one kind.
struct Errors {
    bodies: Vec<Vec<Seen>>,
    /// The largest error, relative to a frequency or to the largest shape at a point.
    largest: f64,
    /// The same of the middle mode of a body.
    middle: f64,
    /// Whether there is such a field.
    needed: bool,
}

impl Modes {
    pub fn new(here: Vec<Vec<Seen>>, near: Vec<Neighbours<Vec<Vec<Seen>>>>) -> Modes {
        let kind = |near: &Neighbours<Vec<Vec<Seen>>>| {
            let omegas =
                |bodies: &[Vec<Seen>]| -> Vec<f64> { bodies.iter().flatten().map(|mode| mode.omega_rad_s).collect() };
            if near.at.iter().all(|bodies| *bodies == here) {
                None
            } else if near.at.iter().all(|bodies| omegas(bodies) == omegas(&here)) {
                Some(Kind::Place)
            } else if Errors::new(&here, &[near]).middle <= SMOOTH {
                Some(Kind::Smooth)
            } else {
                Some(Kind::Rough)
            }
        };
        let kinds: Vec<Option<Kind>> = near.iter().map(kind).collect();
        let errors = [Kind::Place, Kind::Smooth, Kind::Rough].map(|which| {
            let alike = near.iter().zip(&kinds).filter(|(_, kind)| **kind == Some(which));
            Errors::new(&here, &alike.map(|(near, _)| near).collect::<Vec<_>>())
        });
        Modes { here, near, kinds, errors }
    }

    /// The problem with errors of random signs, whose size is treated like a field: the true size is 1. `with` adds errors to the
    /// modes of each body.
    pub fn draws<T>(&self, with: impl Fn(&[Vec<Seen>]) -> T) -> Vec<Neighbours<T>> {
        let of_draw = |errors: &Errors, draw| {
            let offsets = [-2.0, -1.0, 1.0, 2.0].map(|place| place * CHANGE / errors.largest);
            Neighbours::of_size(offsets, |size| with(&errors.signed(draw, size)))
        };
        let needed = self.errors.iter().filter(|errors| errors.needed);
        needed.flat_map(|errors| (1..=DRAWS as u64).map(move |draw| of_draw(errors, draw))).collect()
    }

    /// A derivative with respect to a field with the possible effect of errors of the modes, from the changes of the output for
    /// each draw; no digit is certain if one of them is not known.
    pub fn widened(&self, field: usize, derivative: Derivative, changes: &[Option<f64>]) -> Derivative {
        let Some(kind) = self.kinds[field] else { return derivative };
        let first = DRAWS * self.errors[..kind as usize].iter().filter(|errors| errors.needed).count();
        let squares = changes.iter().skip(first).take(DRAWS).map(|change| change.map(|change| change * change));
        let mean = squares.sum::<Option<f64>>().map(|sum| sum / DRAWS as f64);
        let own = derivative.uncertainty.zip(mean);
        let uncertainty = own.map(|(own, mean)| own + TIMES * self.near[field].magnification() * mean.sqrt());
        Derivative { uncertainty, ..derivative }
    }

    /// Derivative of the frequency of a mode.
    pub fn omega_rad_s(&self, field: usize, body: usize, mode: usize) -> Derivative {
        self.derivative(field, |bodies| bodies[body][mode].omega_rad_s)
    }

    /// Derivative of the shape of a mode of the first body at its first point.
    pub fn shape(&self, field: usize, mode: usize) -> Derivative {
        self.derivative(field, |bodies| bodies[0][mode].shapes[0])
    }

    fn derivative(&self, field: usize, of: impl Fn(&Vec<Vec<Seen>>) -> f64) -> Derivative {
        let error = self.kinds[field].map_or(0.0, |kind| TIMES * of(&self.errors[kind as usize].bodies));
        self.near[field].derivative(of(&self.here), of, error)
    }
}

impl Errors {
    fn new(here: &[Vec<Seen>], near: &[&Neighbours<Vec<Vec<Seen>>>]) -> Errors {
        let mut all = Errors { bodies: Vec::new(), largest: LEAST, middle: LEAST, needed: !near.is_empty() };
        for (body, modes) in here.iter().enumerate() {
            let points = modes.first().map_or(0, |mode| mode.shapes.len());
            let size = |j: usize| modes.iter().map(|mode| mode.shapes[j].abs()).fold(f64::MIN_POSITIVE, f64::max);
            let sizes: Vec<f64> = (0..points).map(size).collect();
            // they grow from mode to mode, and a single one may be small by chance
            let mut relative = vec![LEAST; 1 + points];
            let mut errors = Vec::with_capacity(modes.len());
            for (k, mode) in modes.iter().enumerate() {
                for near in near {
                    let omega = near.in_order(mode.omega_rad_s, |bodies| bodies[body][k].omega_rad_s);
                    relative[0] = relative[0].max(roughness(omega, mode.omega_rad_s));
                    for (j, size) in sizes.iter().enumerate() {
                        let shape = near.in_order(mode.shapes[j], |bodies| bodies[body][k].shapes[j]);
                        relative[1 + j] = relative[1 + j].max(roughness(shape, *size));
                    }
                }
                if 2 * k < modes.len() {
                    all.middle = relative.iter().copied().fold(all.middle, f64::max);
                }
                let shapes = relative[1..].iter().zip(&sizes).map(|(error, size)| error * size).collect();
                errors.push(Seen { omega_rad_s: relative[0] * mode.omega_rad_s, shapes });
            }
            all.largest = relative.iter().copied().fold(all.largest, f64::max);
            all.bodies.push(errors);
        }
        all
    }

    fn signed(&self, draw: u64, size: f64) -> Vec<Vec<Seen>> {
        // a linear congruential generator is random enough for signs
        let mut random = 2019 * draw;
        let mut sign = |error: &mut f64| {
            random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            *error *= if random >> 63 == 0 { size } else { -size };
        };
        let mut errors = self.bodies.clone();
        for mode in errors.iter_mut().flatten() {
            sign(&mut mode.omega_rad_s);
            mode.shapes.iter_mut().for_each(&mut sign);
        }
        errors
    }
}
