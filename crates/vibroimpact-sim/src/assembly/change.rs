//! How the numbers of an assembly change with a parameter, from four assemblies nearby.
//!
//! Whoever poses an assembly computes its modes, shapes, masses and laws from numbers of his own. How these depend on a
//! parameter is known by posing it at four neighbouring values: central differences of fourth order. Unlike the motion,
//! what poses it is smooth and exact to rounding, so that little is lost.

use super::problem::Posed;
use super::system::{Link, Span, System};
use contact_models::ContactLaw;

/// Places of the neighbours, in steps from the value itself.
pub(crate) const NEIGHBOURS: [f64; 4] = [-2.0, -1.0, 1.0, 2.0];

/// Derivative from the values at [`NEIGHBOURS`].
pub(crate) fn slope([far_below, below, above, far_above]: [f64; 4], step: f64) -> f64 {
    (8.0 * (above - below) - (far_above - far_below)) / (12.0 * step)
}

/// What a unit of a parameter changes, by modes in the order of [`System`].
pub(crate) struct Change<'a> {
    /// Where the modes start, and how fast (per unit of the parameter, as everything here).
    pub amplitude: Vec<f64>,
    pub rate: Vec<f64>,
    /// Of each contact: its gap, and its weights `psi`.
    pub gap_m: Vec<f64>,
    pub psi: Vec<Vec<Span>>,
    /// `c_1` and `c_2` of each mode, see [`super::tangent`].
    pub fade: Vec<f64>,
    pub stretch: Vec<f64>,
    /// The law of each contact at the neighbours, where it changes.
    pub laws: Option<Vec<[&'a dyn ContactLaw; 4]>>,
    pub step: f64,
}

impl<'a> Change<'a> {
    /// From the assembly at [`NEIGHBOURS`], whose modes are those of the system in the same order of their bodies.
    pub fn new(system: &System, posed: [&Posed<'a>; 4], laws_change: bool, step: f64) -> Change<'a> {
        let n = system.modes.len();
        let mut change = Change {
            amplitude: vec![0.0; n],
            rate: vec![0.0; n],
            gap_m: (0..system.links.len()).map(|c| slope(posed.map(|posed| posed.gaps_m[c]), step)).collect(),
            psi: Vec::new(),
            fade: vec![0.0; n],
            stretch: vec![0.0; n],
            laws: laws_change.then(|| (0..system.links.len()).map(|c| posed.map(|posed| posed.laws[c])).collect()),
            step,
        };
        for (body, places) in system.place.iter().enumerate() {
            let bodies = posed.map(|posed| &posed.bodies[body]);
            for (k, &place) in places.iter().enumerate() {
                change.amplitude[place] = slope(bodies.map(|body| body.amplitude[k]), step);
                change.rate[place] = slope(bodies.map(|body| body.rate[k]), step);
                let mode = system.modes[place];
                if !mode.is_rigid() {
                    let zeta = mode.damping_ratio;
                    let by_omega = slope(bodies.map(|body| body.modes[k].omega_rad_s), step) / mode.omega_rad_s;
                    let by_zeta = slope(bodies.map(|body| body.modes[k].damping_ratio), step);
                    let by_zeta = if by_zeta == 0.0 { 0.0 } else { by_zeta / ((1.0 - zeta) * (1.0 + zeta)) };
                    change.fade[place] = mode.omega_rad_s * by_zeta;
                    change.stretch[place] = by_omega - zeta * by_zeta;
                }
            }
        }
        for (c, link) in system.links.iter().enumerate() {
            let links = posed.map(|posed| system.link(posed.sides[c]));
            change.psi.push(difference(link, &links, step));
        }
        change
    }

    /// Whether the frequencies or dampings change.
    pub fn moves_modes(&self) -> bool {
        self.fade.iter().chain(&self.stretch).any(|value| *value != 0.0)
    }
}

fn difference(link: &Link, neighbours: &[Link; 4], step: f64) -> Vec<Span> {
    let of = |(i, span): (usize, &Span)| {
        let psi = |k| slope(neighbours.each_ref().map(|link| link.spans[i].psi[k]), step);
        Span { modes: span.modes.clone(), psi: (0..span.psi.len()).map(psi).collect() }
    };
    link.spans.iter().enumerate().map(of).collect()
}
