//! Derivatives of the effect of loads with respect to a parameter.
//!
//! The motion under loads has a closed form ([`super::load`]), so its derivative at a fixed time is the slope through four
//! neighbouring values of the parameter. If the time itself is shifted, the rate of that motion times the shift has to be added;
//! the caller does so.

use super::load::Loads;
use super::problem::Posed;
use super::stencil::Stencil;
use super::system::System;
use std::array;

/// The loads at four neighbouring values of a parameter.
#[derive(Clone)]
pub(crate) struct LoadChange {
    neighbours: [(System, Loads); 4],
    stencil: Stencil<4>,
}

impl LoadChange {
    /// `None` if there are no loads.
    pub fn new(posed: [&Posed; 4], stencil: Stencil<4>) -> Option<LoadChange> {
        if posed.iter().all(|posed| posed.loads.is_empty()) {
            return None;
        }
        let neighbours = posed.map(|posed| {
            let system = System::new(posed);
            let loads = Loads::new(posed.loads, &system);
            (system, loads)
        });
        Some(LoadChange { neighbours, stencil })
    }

    fn slope(&self, of: impl Fn(&System, &Loads) -> f64) -> f64 {
        self.stencil.slope(self.neighbours.each_ref().map(|(system, loads)| of(system, loads)))
    }

    /// Whether breaks of the loads at hand coincide, or lie at the start, and do not at neighbouring values.
    pub fn splits(&self, loads: &Loads) -> bool {
        self.neighbours.iter().any(|(_, near)| near.break_count() != loads.break_count())
    }

    /// The changes of motions of all modes, in the order of a system with the same modes.
    fn of_modes(&self, system: &System, motions: &[(Vec<f64>, Vec<f64>); 4]) -> (Vec<f64>, Vec<f64>) {
        let [mut amplitude, mut rate] = [(); 2].map(|()| vec![0.0; system.modes.len()]);
        for (body, places) in system.place.iter().enumerate() {
            for (k, &place) in places.iter().enumerate() {
                let own: [usize; 4] = array::from_fn(|i| self.neighbours[i].0.place[body][k]);
                amplitude[place] = self.stencil.slope(array::from_fn(|i| motions[i].0[own[i]]));
                rate[place] = self.stencil.slope(array::from_fn(|i| motions[i].1[own[i]]));
            }
        }
        (amplitude, rate)
    }

    /// Changes of the steady motion.
    pub fn steady(&self, system: &System, time_s: f64) -> (Vec<f64>, Vec<f64>) {
        let motions = self.neighbours.each_ref().map(|(system, loads)| {
            let [mut amplitude, mut rate] = [(); 2].map(|()| vec![0.0; system.modes.len()]);
            loads.shift_modes(system, time_s, 1.0, &mut amplitude, &mut rate);
            (amplitude, rate)
        });
        self.of_modes(system, &motions)
    }

    /// Change of [`Loads::overlap`].
    pub fn overlap(&self, contact: usize, time_s: f64) -> [f64; 2] {
        let of = |part: fn((f64, f64)) -> f64| self.slope(|_, loads| part(loads.overlap(contact, time_s)));
        [of(|pair| pair.0), of(|pair| pair.1)]
    }

    /// Change of [`Loads::moved`].
    pub fn moved(&self, contact: usize, time_s: f64, h: f64) -> (f64, f64) {
        let of = |part: fn((f64, f64)) -> f64| self.slope(|_, loads| part(loads.moved(contact, time_s, h)));
        (of(|pair| pair.0), of(|pair| pair.1))
    }

    /// Change of the piecewise linear force on a rigid mode at `time_s`, and of its slope.
    pub fn line(&self, k: usize, system: &System, time_s: f64) -> (f64, f64) {
        let body = system.bodies.iter().position(|modes| modes.contains(&k)).unwrap_or_default();
        let number = system.place[body].iter().position(|place| *place == k).unwrap_or_default();
        let of = |part: fn((f64, f64)) -> f64| {
            self.slope(|system, loads| part(loads.line(system.place[body][number], time_s)))
        };
        (of(|pair| pair.0), of(|pair| pair.1))
    }

    /// Change of the time of the next break.
    pub fn next_break_s(&self) -> f64 {
        self.slope(|_, loads| loads.next_break_s())
    }

    /// Passes the break: the derivative of the jump of the relative motion.
    pub fn pass_break(&mut self, system: &System) -> (Vec<f64>, Vec<f64>) {
        let motions = self.neighbours.each_mut().map(|(system, loads)| {
            let [mut amplitude, mut rate] = [(); 2].map(|()| vec![0.0; system.modes.len()]);
            loads.pass_break(system, loads.next_break_s(), &mut amplitude, &mut rate);
            (amplitude, rate)
        });
        self.of_modes(system, &motions)
    }
}
