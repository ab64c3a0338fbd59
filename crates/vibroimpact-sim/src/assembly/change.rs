//! Derivatives of the numbers that define an assembly with respect to a parameter, from four neighbouring assemblies.
//!
//! The caller computes the modes, shapes, masses and laws of an assembly from parameters that this crate does not know. Their
//! derivatives follow from four neighbouring values of the parameter, as the slope of the polynomial through them. Unlike the
//! motion, these numbers are smooth and exact to rounding, so that few digits are lost.

use super::load_change::LoadChange;
use super::problem::Posed;
use super::stencil::Stencil;
use super::system::{Link, Span, System, joined};
use contact_models::ContactLaw;

/// Limit of `|1 - zeta^2|`. Closer to critical damping `c_1` and `c_2` would magnify the panels' error of the force times the time.
const CRITICAL: f64 = 0.1;

/// Derivatives with respect to a parameter; modes are in the order of [`System`].
pub(crate) struct Change<'a> {
    /// Amplitudes and rates at the start, relative to the steady motion (per unit of the parameter, as everything here).
    pub amplitude: Vec<f64>,
    pub rate: Vec<f64>,
    /// Gap of each contact, and its weights `psi`.
    pub gap_m: Vec<f64>,
    pub psi: Vec<Vec<Span>>,
    /// `c_1` and `c_2` of each mode, see [`super::tangent`].
    pub fade: Vec<f64>,
    pub stretch: Vec<f64>,
    /// The law of each contact at the neighbours, where it changes.
    pub laws: Option<Vec<[&'a dyn ContactLaw; 4]>>,
    /// The loads at the neighbours; `None` if there are none.
    pub loads: Option<LoadChange>,
    pub stencil: Stencil<4>,
    /// Whether frequencies or dampings change.
    pub moves_modes: bool,
    /// Derivatives of the damping ratios of modes near critical damping, which `c_1` and `c_2` do not include.
    pub critical: Vec<(usize, f64)>,
}

impl<'a> Change<'a> {
    /// Computes the derivatives from the neighbouring assemblies, whose modes have the same order within their bodies.
    /// The laws of each contact at these neighbours are needed only if they change.
    pub fn new(
        system: &System,
        posed: [&Posed; 4],
        laws: Option<Vec<[&'a dyn ContactLaw; 4]>>,
        stencil: Stencil<4>,
    ) -> Change<'a> {
        let n = system.modes.len();
        let psi = |(c, link): (usize, &Link)| {
            let spans = posed.map(|posed| joined(&system.sides(posed.sides[c])));
            difference(&link.spans, &spans, &stencil)
        };
        let psi: Vec<Vec<Span>> = system.links.iter().enumerate().map(psi).collect();
        let mut change = Change {
            amplitude: vec![0.0; n],
            rate: vec![0.0; n],
            gap_m: (0..system.links.len()).map(|c| stencil.slope(posed.map(|posed| posed.gaps_m[c]))).collect(),
            loads: LoadChange::new(system, &psi, posed, stencil),
            psi,
            fade: vec![0.0; n],
            stretch: vec![0.0; n],
            laws,
            stencil,
            moves_modes: false,
            critical: Vec::new(),
        };
        for (body, places) in system.place.iter().enumerate() {
            let bodies = posed.map(|posed| &posed.bodies[body]);
            for (k, &place) in places.iter().enumerate() {
                change.amplitude[place] = stencil.slope(bodies.map(|body| body.amplitude[k]));
                change.rate[place] = stencil.slope(bodies.map(|body| body.rate[k]));
                let mode = system.modes[place];
                if !mode.is_rigid() {
                    let zeta = mode.damping_ratio;
                    let by_omega = stencil.slope(bodies.map(|body| body.modes[k].omega_rad_s)) / mode.omega_rad_s;
                    let by_zeta = stencil.slope(bodies.map(|body| body.modes[k].damping_ratio));
                    let to_critical = (1.0 - zeta) * (1.0 + zeta);
                    change.stretch[place] = by_omega;
                    if by_zeta != 0.0 && to_critical.abs() < CRITICAL {
                        change.critical.push((place, by_zeta));
                    } else if by_zeta != 0.0 {
                        change.fade[place] = mode.omega_rad_s * by_zeta / to_critical;
                        change.stretch[place] -= zeta * by_zeta / to_critical;
                    }
                }
            }
        }
        if let Some(loads) = &change.loads {
            let (amplitude, rate) = loads.steady(system, 0.0);
            change.amplitude.iter_mut().zip(&amplitude).for_each(|(change, steady)| *change -= steady);
            change.rate.iter_mut().zip(&rate).for_each(|(change, steady)| *change -= steady);
        }
        change.moves_modes = change.fade.iter().chain(&change.stretch).any(|value| *value != 0.0);
        change
    }

    /// A change of one amplitude or rate at the start alone.
    pub fn of_start(system: &System, place: usize, of_rate: bool) -> Change<'a> {
        let n = system.modes.len();
        let zeros = || vec![0.0; n];
        let still = |span: &Span| Span { modes: span.modes.clone(), psi: vec![0.0; span.psi.len()] };
        let mut change = Change {
            amplitude: zeros(),
            rate: zeros(),
            gap_m: vec![0.0; system.links.len()],
            psi: system.links.iter().map(|link| link.spans.iter().map(still).collect()).collect(),
            fade: zeros(),
            stretch: zeros(),
            laws: None,
            loads: None,
            stencil: Stencil::central(1.0),
            moves_modes: false,
            critical: Vec::new(),
        };
        let started = if of_rate { &mut change.rate } else { &mut change.amplitude };
        started[place] = 1.0;
        change
    }
}

fn difference(spans: &[Span], neighbours: &[Vec<Span>; 4], stencil: &Stencil<4>) -> Vec<Span> {
    let of = |(i, span): (usize, &Span)| {
        let psi = |k| stencil.slope(neighbours.each_ref().map(|spans| spans[i].psi[k]));
        Span { modes: span.modes.clone(), psi: (0..span.psi.len()).map(psi).collect() }
    };
    spans.iter().enumerate().map(of).collect()
}
