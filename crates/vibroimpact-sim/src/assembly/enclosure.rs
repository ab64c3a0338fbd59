//! Bounds on the overlap of a contact.
//!
//! - On a panel: the error of the polynomial through the start and the nodes. Under a polynomial force a mode moves along a
//!   polynomial, about `-psi F/omega^2` for a fast one, and vibrates freely about it with an amplitude that follows from its
//!   state. `interpolation.rs` bounds the interpolation error of this vibration.
//! - In free flight: a time before which no contact can begin. The modes above any `K` move the overlap by at most
//!   `H = sum |psi_k| A_k`, `A_k^2 = a_k^2 + (b_k/omega_k)^2`, and of the rest `|g''| <= B = sum (1 + 2 zeta_k) omega_k^2
//!   |psi_k| A_k`. So the separation is at least `u_K - H + u_K' t - B t^2/2`, and the best of these parabolas over `K`
//!   holds.

use super::interpolation::{FOLLOWED, Missed, ORDERS, OVERDAMPED, interpolation};
use super::load::Loads;
use super::system::{Link, Span, System};
use super::terminal::value;
use crate::panel::legendre::TAYLOR;
use crate::panel::vector::{change_each, sum_over, vectorized};
use std::ops::Range;

/// A contact force at the start of a panel, its rate, and the modes on which it acts.
pub(crate) struct ContactForce<'a> {
    pub link: &'a Link,
    pub force_n: f64,
    pub rate_n_s: f64,
}

/// Quasi-static displacement of the modes of a body under linearly growing contact forces, and its rate; reused memory.
#[derive(Default)]
pub(crate) struct QuasiStatic {
    at: Vec<f64>,
    rate: Vec<f64>,
}

impl QuasiStatic {
    /// For the modes of a body from the `from`-th on, whose `1/omega` are given.
    fn update(&mut self, body: &Range<usize>, from: usize, inverse: &[f64], forces: &[ContactForce]) {
        for row in [&mut self.at, &mut self.rate] {
            row.clear();
            row.resize(inverse.len(), 0.0);
        }
        for force in forces {
            let Some(partner) = force.link.span(body) else { continue };
            vectorized(
                #[inline(always)]
                || {
                    change_each(
                        [&mut self.at, &mut self.rate],
                        [&partner.psi[from..], inverse],
                        #[inline(always)]
                        |[at, rate], [psi, inverse]| {
                            let compliance = psi * inverse * inverse;
                            [at - compliance * force.force_n, rate - compliance * force.rate_n_s]
                        },
                    );
                },
            );
        }
    }
}

/// Bounds on the difference of the overlap of a contact, and its first two derivatives along a panel of `h`, from the polynomial
/// through start and nodes. `forces` are the contact forces at its start.
pub(crate) fn of_panel(
    system: &System,
    missed: &Missed,
    loads: &Loads,
    contact: usize,
    h: f64,
    (amplitude, rate): (&[f64], &[f64]),
    (forces, quasi_static): (&[ContactForce], &mut QuasiStatic),
) -> [f64; ORDERS] {
    let mut rho = [0.0; ORDERS];
    for span in &system.links[contact].spans {
        // by increasing frequency: the first modes are interpolated to rounding
        let omega = &system.omega[span.modes.clone()];
        let from = omega.partition_point(|omega| omega * h * (1.0 + system.most_damping) < FOLLOWED);
        let modes = span.modes.start + from..span.modes.end;
        if modes.is_empty() {
            continue;
        }
        let [values, slopes, bends] = missed.0.each_ref().map(|row| &row[modes.clone()]);
        let [inverse, a, b] = [&system.inverse, amplitude, rate].map(|row| &row[modes.clone()]);
        let psi = &span.psi[from..];
        // the displacement under a single force needs no memory
        let alone = match forces {
            [force] if system.most_damping <= OVERDAMPED => {
                force.link.span(&span.modes).map(|partner| (force, partner))
            }
            _ => None,
        };
        let by_span = if let Some((force, partner)) = alone {
            let rows = [psi, a, b, &partner.psi[from..], inverse, values, slopes, bends];
            let (force, growth) = (force.force_n, force.rate_n_s);
            vectorized(
                #[inline(always)]
                || {
                    sum_over(
                        rows,
                        #[inline(always)]
                        |[psi, a, b, partner, inverse, value, slope, bend]| {
                            let compliance = partner * inverse * inverse;
                            let vibrates = [a + compliance * force, b + compliance * growth];
                            missed_by(psi, vibrates, inverse, [value, slope, bend])
                        },
                    )
                },
            )
        } else {
            quasi_static.update(&span.modes, from, inverse, forces);
            let rows = [psi, a, b, &quasi_static.at, &quasi_static.rate, inverse, values, slopes, bends];
            vectorized(
                #[inline(always)]
                || {
                    sum_over(
                        rows,
                        #[inline(always)]
                        |[psi, a, b, at, rate, inverse, value, slope, bend]| {
                            missed_by(psi, [a - at, b - rate], inverse, [value, slope, bend])
                        },
                    )
                },
            )
        };
        (0..ORDERS).for_each(|r| rho[r] += by_span[r]);
        if system.most_damping <= OVERDAMPED {
            continue;
        }
        for (i, k) in modes.enumerate().filter(|(_, k)| system.modes[*k].damping_ratio > OVERDAMPED) {
            let (zeta, omega, square) = (system.modes[k].damping_ratio, system.omega[k], system.square[k]);
            let split = omega * ((zeta - 1.0) * (zeta + 1.0)).sqrt();
            let fast = zeta * omega + split;
            let slow = square / fast;
            for (root, other) in [(fast, slow), (slow, fast)] {
                let decaying = b[i] + other * a[i] - square * (quasi_static.at[i] - quasi_static.rate[i] / root) / root;
                add(&mut rho, psi[i].abs() * decaying.abs() / (2.0 * split), root * h);
            }
        }
    }
    for harmonic in &loads.harmonics {
        add(&mut rho, harmonic.contacts[contact].norm(), harmonic.omega_rad_s * h);
    }
    rho
}

/// What interpolation misses of a mode that vibrates with this amplitude and rate.
#[inline(always)]
fn missed_by(psi: f64, [a, b]: [f64; 2], inverse: f64, [value, slope, bend]: [f64; ORDERS]) -> [f64; ORDERS] {
    let size = psi.abs() * (a.abs() + b.abs() * inverse);
    [size * value, size * slope, size * bend]
}

/// Adds the bound for a vibration of this amplitude that turns by `theta`.
fn add(rho: &mut [f64; ORDERS], amplitude: f64, theta: f64) {
    let missed = interpolation(theta);
    for r in 0..ORDERS {
        rho[r] += amplitude * missed[r];
    }
}

/// Amplitude bounds of the modes that move an open contact, summed up beyond some of them. They hold as long as the
/// contact's bodies move freely, since no free vibration grows.
#[derive(Debug, Clone)]
pub(crate) struct FlightBounds {
    /// How many of the slowest modes a parabola follows, `H` of the others, `B` of these.
    cuts: Vec<(usize, f64, f64)>,
    /// Number of uses: as vibrations are damped, better bounds become possible.
    uses: u32,
}

/// The next number of modes after this one that a parabola follows: every one up to 4, then in ratios of about 4/3, with the
/// powers of two.
fn next_cut(cut: usize) -> usize {
    if cut < 4 {
        return cut + 1;
    }
    let step = 2 * cut.ilog2() as usize;
    (cut / step + 1).saturating_mul(step).min((cut + 1).next_power_of_two())
}

/// Number of uses after which new bounds are computed.
const USES: u32 = 16;

impl FlightBounds {
    pub fn new(system: &System, contact: usize, (amplitude, rate): (&[f64], &[f64])) -> FlightBounds {
        let link = &system.links[contact];
        let n = link.elastic.len();
        let bound = |psi: f64, a: f64, b: f64, inverse: f64| {
            let speed = b * inverse;
            psi.abs() * (a * a + speed * speed).sqrt()
        };
        let mut bounds = vec![0.0; n];
        match &link.in_a_row {
            Some(Span { modes, psi }) => {
                let [a, b, inverse] = [amplitude, rate, &system.inverse].map(|row| &row[modes.clone()]);
                vectorized(
                    #[inline(always)]
                    || {
                        let rows = psi.iter().zip(a).zip(b).zip(inverse);
                        for (of, (((psi, a), b), inverse)) in bounds.iter_mut().zip(rows) {
                            *of = bound(*psi, *a, *b, *inverse);
                        }
                    },
                );
            }
            None => {
                for (of, &(k, psi)) in bounds.iter_mut().zip(&link.elastic) {
                    *of = bound(psi, amplitude[k], rate[k], system.inverse[k]);
                }
            }
        }
        let total: f64 = bounds.iter().sum();
        // room for the cuts of a hundred modes
        let (mut cuts, mut below, mut curvature, mut cut) = (Vec::with_capacity(24), 0.0, 0.0, 0);
        while cut < n {
            cuts.push((cut, (total - below).max(0.0) * (1.0 + 1e-12), curvature));
            let next = next_cut(cut).min(n);
            for ((k, _), bound) in link.elastic[cut..next].iter().zip(&bounds[cut..next]) {
                below += bound;
                curvature += (1.0 + 2.0 * system.modes[*k].damping_ratio) * system.square[*k] * bound;
            }
            cut = next;
        }
        cuts.push((n, 0.0, curvature));
        FlightBounds { cuts, uses: 0 }
    }

    /// Whether newer bounds may be better.
    pub fn are_worn(&mut self) -> bool {
        self.uses += 1;
        self.uses > USES
    }

    /// Bound on the overlap's second derivative in free motion without loads (m/s^2).
    pub fn curvature(&self) -> f64 {
        self.cuts.last().map_or(0.0, |cut| cut.2)
    }

    /// A time (s) before which an open contact cannot close, infinite if it never can. `overlap` and `rate` are those of all but
    /// the elastic modes, relative to the overlap of touch. `bend` bounds the second derivative by the loads (m/s^2), and `rounding`
    /// is the rounding of the overlap (m) and of its rate (m/s): bodies that approach no faster than that without vibrating move
    /// along together.
    #[inline(always)]
    pub fn safe_time(
        &self,
        link: &Link,
        (mut overlap, mut rate): (f64, f64),
        bend: f64,
        rounding: impl Fn() -> (f64, f64),
        (amplitude, mode_rate): (&[f64], &[f64]),
    ) -> f64 {
        let (mut next, mut best, mut known) = (0, 0.0f64, None);
        let row = link.in_a_row.as_ref().map(|Span { modes, psi }| {
            let (a, b) = (&amplitude[modes.clone()], &mode_rate[modes.clone()]);
            (psi.as_slice(), a, b)
        });
        for &(cut, above, curvature) in &self.cuts {
            let [moved, speed] = match row {
                Some((psi, a, b)) => sum_over(
                    [&psi[next..cut], &a[next..cut], &b[next..cut]],
                    #[inline(always)]
                    |[psi, a, b]| [psi * a, psi * b],
                ),
                None => link.elastic[next..cut].iter().fold([0.0; 2], |[moved, speed], &(k, psi)| {
                    [moved + psi * amplitude[k], speed + psi * mode_rate[k]]
                }),
            };
            (overlap, rate, next) = (overlap + moved, rate + speed, cut);
            let curvature = curvature + bend;
            let mut separation = -overlap - above;
            // surfaces that have just parted overlap by rounding, within which the modes above may move, too
            if separation < 0.0 && (above == 0.0 || self.uses == 0) {
                let (rounding, _) = *known.get_or_insert_with(&rounding);
                if above <= rounding && separation >= -rounding {
                    separation = 0.0;
                }
            }
            if above == 0.0 && curvature == 0.0 && separation >= 0.0 && rate > 0.0 {
                let (_, rate_rounding) = *known.get_or_insert_with(&rounding);
                if rate <= rate_rounding {
                    return f64::INFINITY;
                }
            }
            // a parabola that is still above zero at the best time yet has its root beyond it
            let at_best = separation - best * (rate + 0.5 * curvature * best);
            if at_best > 0.0 && separation >= 0.0 || (separation == 0.0 && rate <= 0.0 && best == 0.0) {
                best = first_root_of_parabola(separation, -rate, curvature);
                if best == f64::INFINITY {
                    break;
                }
            }
        }
        best
    }
}

/// First positive root of `u + u' t - b t^2/2` with `u >= 0`, `b >= 0`; infinite if there is none.
fn first_root_of_parabola(u: f64, slope: f64, b: f64) -> f64 {
    let root = (slope * slope + 2.0 * b * u).sqrt();
    if slope >= 0.0 { if b == 0.0 { f64::INFINITY } else { (slope + root) / b } } else { 2.0 * u / (root - slope) }
}

/// The first time in `[0, window]` at which an overlap with this power series, approached from below, rises to zero, and
/// `true`; or a time up to which it does not, and `false`. Its second derivative is at most `curvature`. Overlaps within
/// `rounding`, and within the rounding of the series, count as zero, and so do rates within `rate_rounding`.
pub(crate) fn first_closing(
    series: &[f64; TAYLOR],
    curvature: f64,
    window: f64,
    (rounding, rate_rounding): (f64, f64),
) -> (f64, bool) {
    const ITERATIONS_MAX: usize = 10_000;
    // after a grazing touch the surfaces separate so soon that the overlap never exceeds rounding
    let least = if curvature > 0.0 { (rounding / curvature).sqrt() } else { 0.0 };
    let mut t = 0.0;
    if series[0] >= -rounding && series[1].abs() <= rate_rounding {
        match first_difference(series, window, (rounding, rate_rounding)) {
            None => return (window, false),
            Some((parted, overlap)) if overlap < 0.0 => t = parted,
            Some((closed, _)) => return (closed, true),
        }
    }
    for _ in 0..ITERATIONS_MAX {
        let [overlap, rate, bend] = value(series, t);
        let size = series.iter().rev().fold(0.0, |sum, term| sum * t + term.abs());
        let rounding = rounding + 4.0 * f64::EPSILON * size;
        let meets = overlap >= -rounding && rate > 0.0;
        let grazes = meets && rate * rate <= -2.0 * rounding * bend;
        if meets && !grazes {
            return (t, true);
        }
        let step = first_root_of_parabola((-overlap).max(0.0), -rate, curvature);
        let step = match (grazes, rate > 0.0) {
            (true, _) => (-2.0 * rate / bend).max(least),
            (false, true) => step,
            (false, false) => step.max(least),
        };
        let next = (t + step).max(t * (1.0 + f64::EPSILON));
        if next >= window {
            return (window, false);
        }
        if next == t {
            // in contact and at rest relative to each other: the law decides
            return (t, true);
        }
        t = next;
    }
    (t, false)
}

/// The first time within `window` at which the overlap of touching surfaces exceeds rounding, and that overlap. Within the reach
/// of its series an overlap does not vibrate, so it is enough to check times that double.
pub(crate) fn first_difference(
    series: &[f64; TAYLOR],
    window: f64,
    (rounding, rate_rounding): (f64, f64),
) -> Option<(f64, f64)> {
    let at = |k: u32| {
        let t = window * 0.5f64.powi(k as i32);
        (t, value(series, t)[0])
    };
    (0..f64::MANTISSA_DIGITS).rev().map(at).find(|(t, overlap)| overlap.abs() > rounding + rate_rounding * t)
}

/// Bound on the second derivative of the overlap of a contact by the loads within `lasting_s` (m/s^2).
pub(crate) fn bend_of_loads(loads: &Loads, contact: usize, time_s: f64, lasting_s: f64) -> f64 {
    if loads.is_empty() {
        return 0.0;
    }
    let lasting_s = if lasting_s.is_finite() { lasting_s } else { 0.0 };
    let lines = loads.acceleration(contact, time_s).max(loads.acceleration(contact, time_s + lasting_s)).max(0.0);
    let harmonics = loads.harmonics.iter().map(|h| h.omega_rad_s.powi(2) * h.contacts[contact].norm());
    lines + harmonics.sum::<f64>()
}
