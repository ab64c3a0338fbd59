//! The assembly in the form for time integration: all modes in one list, each contact as a row of weights over them.

use super::problem::{Point, Posed};
use crate::panel::oscillator::BodyMode;
use crate::panel::vector::sum_over;
use std::ops::Range;

/// Weights `psi_k` over the modes of one body: the overlap of a contact for unit amplitudes of the modes.
#[derive(Debug, Clone)]
pub(crate) struct Span {
    pub modes: Range<usize>,
    pub psi: Vec<f64>,
}

impl Span {
    /// `sum psi_k values_k`.
    pub fn sum(&self, values: &[f64]) -> f64 {
        let [sum] = sum_over([&self.psi, &values[self.modes.clone()]], |[psi, value]| [psi * value]);
        sum
    }

    /// `sum |psi_k values_k|`, to which the rounding of the sum is relative.
    pub fn size(&self, values: &[f64]) -> f64 {
        let [size] = sum_over([&self.psi, &values[self.modes.clone()]], |[psi, value]| [(psi * value).abs()]);
        size
    }
}

/// One contact, `xi = u_B - u_A - gap`, over the modes of the one or two bodies that it joins.
#[derive(Debug, Clone)]
pub(crate) struct Link {
    pub spans: Vec<Span>,
    /// Weights of the displacement of either side; none for the ground.
    pub sides: [Option<Span>; 2],
    /// Elastic modes that move it, by increasing frequency: number and `psi`.
    pub elastic: Vec<(usize, f64)>,
    /// The same, if they follow each other in the list of all modes.
    pub in_a_row: Option<Span>,
    /// Rigid modes that move it: number and `psi`.
    pub rigid: Vec<(usize, f64)>,
    /// `sum psi_k^2` over all modes (1/kg): the change of its rate by a unit impulse. Zero if nothing moves it, as between the
    /// ground and the held end of a beam.
    pub mobility: f64,
}

impl Link {
    /// `sum psi_k values_k` over all modes.
    pub fn sum(&self, values: &[f64]) -> f64 {
        self.spans.iter().map(|span| span.sum(values)).sum()
    }

    /// `sum |psi_k values_k|` over all modes.
    pub fn size(&self, values: &[f64]) -> f64 {
        self.spans.iter().map(|span| span.size(values)).sum()
    }

    /// Its weights over the modes of this body.
    pub fn span(&self, body: &Range<usize>) -> Option<&Span> {
        self.spans.iter().find(|span| span.modes == *body)
    }

    /// `psi_k`.
    pub fn weight(&self, k: usize) -> f64 {
        let span = self.spans.iter().find(|span| span.modes.contains(&k));
        span.map_or(0.0, |span| span.psi[k - span.modes.start])
    }

    /// Modes that this link and another both move, with the product of their weights.
    pub fn shared<'a>(&'a self, other: &'a Link) -> impl Iterator<Item = (usize, f64)> + 'a {
        self.spans.iter().flat_map(move |span| {
            other.span(&span.modes).into_iter().flat_map(move |partner| {
                span.modes.clone().zip(span.psi.iter().zip(&partner.psi)).map(|(k, (one, two))| (k, one * two))
            })
        })
    }

    /// Inverse mass of the rigid modes that this link and another both move (1/kg).
    pub fn shared_rigid(&self, other: &Link) -> f64 {
        self.rigid.iter().map(|(k, psi)| psi * other.weight(*k)).sum()
    }

    /// Whether both join the same body.
    pub fn shares_body_with(&self, other: &Link) -> bool {
        self.spans.iter().any(|span| other.span(&span.modes).is_some())
    }
}

/// All modes and contacts.
#[derive(Debug, Clone)]
pub(crate) struct System {
    /// The modes, body by body, each by increasing frequency.
    pub modes: Vec<BodyMode>,
    /// `omega_k` (rad/s), `2 zeta_k omega_k` (1/s), `omega_k^2` (1/s^2), and `1/omega_k` (s), which is infinite for rigid modes.
    pub omega: Vec<f64>,
    pub drag: Vec<f64>,
    pub square: Vec<f64>,
    pub inverse: Vec<f64>,
    /// The fastest motion of the modes up to this one of the same body (rad/s).
    pub turning: Vec<f64>,
    /// The largest damping ratio.
    pub most_damping: f64,
    /// The modes of each body.
    pub bodies: Vec<Range<usize>>,
    /// Position in this list of each mode of each body in the user's order.
    pub place: Vec<Vec<usize>>,
    pub links: Vec<Link>,
    /// The contacts that share a body with a contact, itself included.
    pub neighbours: Vec<Vec<usize>>,
}

impl System {
    pub fn new(posed: &Posed) -> System {
        let count = posed.bodies.iter().map(|body| body.modes.len()).sum();
        let mut modes = Vec::with_capacity(count);
        let (mut bodies, mut place) = (Vec::new(), Vec::new());
        for body in posed.bodies {
            let first = modes.len();
            let mut order: Vec<usize> = (0..body.modes.len()).collect();
            order.sort_by(|&i, &j| body.modes[i].omega_rad_s.total_cmp(&body.modes[j].omega_rad_s));
            let mut places = vec![0; order.len()];
            for (i, &k) in order.iter().enumerate() {
                places[k] = first + i;
                let mode = body.modes[k];
                modes.push(mode);
            }
            bodies.push(first..modes.len());
            place.push(places);
        }
        let omega: Vec<f64> = modes.iter().map(|mode| mode.omega_rad_s).collect();
        let most_damping = modes.iter().map(|mode| mode.damping_ratio).fold(0.0, f64::max);
        let drag: Vec<f64> = modes.iter().map(|mode| 2.0 * mode.damping_ratio * mode.omega_rad_s).collect();
        let square = modes.iter().map(|mode| mode.omega_rad_s * mode.omega_rad_s).collect();
        let inverse = omega.iter().map(|omega| omega.recip()).collect();
        let mut turning = Vec::with_capacity(modes.len());
        for body in &bodies {
            let mut fastest = 0.0f64;
            for k in Range::clone(body) {
                fastest = fastest.max(modes[k].omega_rad_s + drag[k]);
                turning.push(fastest);
            }
        }
        let (links, neighbours) = (Vec::new(), Vec::new());
        let mut system =
            System { modes, omega, drag, square, inverse, turning, most_damping, bodies, place, links, neighbours };
        system.links = posed.sides.iter().map(|sides| system.link(sides)).collect();
        let links = &system.links;
        let sharing = |one: &Link| (0..links.len()).filter(|&c| one.shares_body_with(&links[c])).collect();
        system.neighbours = links.iter().map(sharing).collect();
        system
    }

    /// Whether some elastic mode moves both of two contacts.
    pub fn share_elastic_modes(&self, one: usize, other: usize) -> bool {
        let (one, other) = (&self.links[one], &self.links[other]);
        !other.elastic.is_empty() && one.elastic.iter().any(|(k, _)| other.weight(*k) != 0.0)
    }

    /// Products of the weights of two contacts, mode by mode; zero where they do not share a body.
    pub fn shared(&self, one: usize, other: usize) -> Vec<f64> {
        let mut products = vec![0.0; self.modes.len()];
        self.links[one].shared(&self.links[other]).for_each(|(k, product)| products[k] = product);
        products
    }

    /// Values given in the user's order, as a span over the modes of that body.
    pub fn span(&self, body: usize, values: &[f64]) -> Span {
        let modes = self.bodies[body].clone();
        let mut psi = vec![0.0; modes.len()];
        for (place, value) in self.place[body].iter().zip(values) {
            psi[place - modes.start] = *value;
        }
        Span { modes, psi }
    }

    /// The weights of the modes in the motion of each side of a contact.
    pub fn sides(&self, points: &[Point; 2]) -> [Option<Span>; 2] {
        points.each_ref().map(|point| match point {
            Point::Ground => None,
            Point::OfBody { body, shape } => Some(self.span(*body, shape)),
        })
    }

    fn link(&self, points: &[Point; 2]) -> Link {
        let sides = self.sides(points);
        let spans = joined(&sides);
        let weights = spans.iter().flat_map(|span| span.modes.clone().zip(span.psi.iter().copied()));
        let moving = weights.filter(|(_, psi)| *psi != 0.0);
        let (rigid, mut elastic): (Vec<_>, Vec<_>) = moving.partition(|(k, _)| self.modes[*k].is_rigid());
        elastic.sort_by(|a, b| self.modes[a.0].omega_rad_s.total_cmp(&self.modes[b.0].omega_rad_s));
        let mobility = rigid.iter().chain(&elastic).map(|(_, psi)| psi * psi).sum();
        let first = elastic.first().map_or(0, |(k, _)| *k);
        let row = || Span { modes: first..first + elastic.len(), psi: elastic.iter().map(|(_, psi)| *psi).collect() };
        let in_a_row = elastic.iter().enumerate().all(|(i, (k, _))| *k == first + i).then(row);
        Link { spans, sides, elastic, in_a_row, rigid, mobility }
    }

    /// Inverse effective mass at a contact (1/kg): that of the rigid modes, or of all modes if there is no rigid one.
    pub fn inverse_mass(&self, contact: usize) -> f64 {
        let link = &self.links[contact];
        let of = |modes: &[(usize, f64)]| modes.iter().map(|(_, psi)| psi * psi).sum::<f64>();
        if link.rigid.is_empty() { of(&link.elastic) } else { of(&link.rigid) }
    }
}

/// The weights of the modes in the overlap of a contact: those of its second side less those of its first.
pub(crate) fn joined(sides: &[Option<Span>; 2]) -> Vec<Span> {
    let mut spans: Vec<Span> = Vec::with_capacity(2);
    for (side, sign) in sides.iter().zip([-1.0, 1.0]) {
        let Some(side) = side else { continue };
        if let Some(same) = spans.iter_mut().find(|span| span.modes == side.modes) {
            same.psi.iter_mut().zip(&side.psi).for_each(|(psi, value)| *psi += sign * value);
        } else {
            let psi = side.psi.iter().map(|value| sign * value).collect();
            spans.push(Span { modes: side.modes.clone(), psi });
        }
    }
    spans
}
