//! Later effects of past forces: panels as impulses, and the free motion after impulses.

use super::free::Free;
use super::history::{History, Impulse};
use super::kernel::Kernel;
use super::problem::NODES;
use super::root_sum::RootSum;
use super::rule::{Kind, Tables, series};

/// The force on a panel that is solved.
#[derive(Debug, Clone)]
pub(super) struct Solved {
    pub kind: Kind,
    /// Its end, from the origin of time.
    pub end: f64,
    pub h: f64,
    /// Force at the nodes, and its series.
    pub force: Vec<f64>,
    pub f_series: Vec<f64>,
    /// The integral of a middle panel against the square root, where that is the whole after-effect.
    root: Option<RootSum>,
}

/// Part of the impulse of a panel below which its last piece is not divided any more.
const NEGLIGIBLE: f64 = 1e-17;
/// Digits of the impulse of a panel that impulses keep, and those that each node of a piece gives, which is at least its own length
/// away from the singularity of the kernel: `2 log10(3 + sqrt(8))`.
const DIGITS: f64 = 16.0;
const DIGITS_PER_NODE: f64 = 1.53;

impl Solved {
    pub fn new(kernel: &Kernel, kind: Kind, end: f64, h: f64, force: Vec<f64>, f_series: Vec<f64>) -> Solved {
        let root = (kind == Kind::Middle && kernel.root().is_some()).then(|| RootSum::new(&f_series));
        Solved { kind, end, h, force, f_series, root }
    }

    /// Adds the after-effect of the panel on compression and rate, at times `after` a moment that lies `behind` its end, to
    /// their sums; `slope` is empty if the rate is not asked for.
    pub fn add_after_effect(&self, kernel: &Kernel, behind: f64, after: &[f64], memory: &mut [f64], slope: &mut [f64]) {
        let half = 0.5 * self.h;
        match (kernel.root(), &self.root) {
            (Some(c), Some(root)) => {
                // the variable of the closed form is 1 at the panel's end, and grows by 1 in half its length
                let beyond: Vec<f64> = after.iter().map(|tau| behind + tau).collect();
                root.add(c * half * half.sqrt(), half.recip(), &beyond, memory);
                root.add_slope(c * half.sqrt(), half.recip(), &beyond, slope);
            }
            (Some(c), None) if self.kind == Kind::Start && slope.is_empty() => {
                let factor = c * self.h * self.h.sqrt();
                for (sum, tau) in memory.iter_mut().zip(after) {
                    *sum += factor * self.root_of_start(kernel.tables, (behind + tau) / self.h);
                }
            }
            _ => {
                let gap = behind + after.iter().copied().fold(f64::INFINITY, f64::min);
                for impulse in self.impulses(kernel.tables, behind, gap) {
                    kernel.add_after_effect(impulse, after, memory, slope);
                }
            }
        }
    }

    /// `int_0^1 sqrt(1 + later - s) f ds` over a start panel in units of its length.
    fn root_of_start(&self, tables: &Tables, later: f64) -> f64 {
        if later >= 1.0 {
            let rule = tables.rule(Kind::Start);
            let points = rule.mass.iter().zip(&self.force).zip(&rule.remaining);
            return points.map(|((mass, f), remaining)| mass * f * (remaining + later).sqrt()).sum();
        }
        // sqrt(z^2 - s^2) = sqrt(z - s) sqrt(z + s); the second factor is smooth
        let z = (1.0 + later).sqrt();
        let mut smooth = [0.0; *NODES.end()];
        for ((smooth, s), f) in smooth.iter_mut().zip(&tables.sigma).zip(&self.force) {
            *smooth = 2.0 * s * f * (z + s).sqrt();
        }
        let root = RootSum::new(&tables.coefficients(&smooth[..tables.p]));
        let mut sum = [0.0];
        root.add(0.125_f64.sqrt(), 2.0, &[later / (z + 1.0)], &mut sum);
        sum[0]
    }

    /// The panel as impulses with their ages at a moment that lies `behind` its end, for times not closer to its end than
    /// `gap`: in pieces of the panel's variable that grow in proportion to their distance from there.
    pub fn impulses(&self, tables: &Tables, behind: f64, gap: f64) -> Vec<Impulse> {
        // distance in the panel's variable from its end to the nearest singularity of the kernel
        let reach = match self.kind {
            Kind::Start => 0.5 * gap / self.h,
            Kind::Middle => gap / self.h,
            Kind::End => (gap / self.h).sqrt(),
        };
        let (mut impulses, mut high, mut total, mut last) = (Vec::new(), 1.0, 0.0, f64::INFINITY);
        while high > 0.0 {
            let low = if high <= reach || last <= NEGLIGIBLE * total { 0.0 } else { 0.5 * high };
            let digits = DIGITS + f64::min(last / total, 1.0).log10();
            let nodes = if last.is_finite() { (digits / DIGITS_PER_NODE) as usize + 2 } else { tables.p };
            last = 0.0;
            for &(y, w) in &tables.gauss[nodes.min(tables.p)] {
                let u = low + (high - low) * y;
                let (s, remaining, rate) = match self.kind {
                    Kind::Start => (1.0 - u, u * (2.0 - u), 2.0 * (1.0 - u)),
                    Kind::Middle => (1.0 - u, u, 1.0),
                    Kind::End => (u, u * u, 2.0 * u),
                };
                let weight = self.h * rate * (high - low) * w * series(&self.f_series, s);
                // the polynomial of a vanishing force may fall below zero by its rounding
                if weight > 0.0 {
                    impulses.push(Impulse { age: behind + self.h * remaining, weight });
                    last += weight;
                }
            }
            total += last;
            high = low;
        }
        impulses
    }
}

/// Free motion of the compression after impulses, with its value and rate at the origin of time taken out:
///
/// ```text
/// x(tau) = x_0 + r tau + bend(tau),   bend = sum_j w_j sum_k c_k [age^p + p age^(p-1) tau - (age + tau)^p].
/// ```
///
/// As `0 <= p < 1`, every term of the bend is positive and convex.
///
/// During a contact, impulses that are much older than it lasts act as a smooth function, sampled once.
#[derive(Debug, Clone)]
pub(super) struct FreeMotion {
    near: Vec<Bend>,
    far: Option<Far>,
}

/// The bend by far impulses.
#[derive(Debug, Clone)]
struct Far {
    terms: Vec<Bend>,
    /// End of the time for which there are series.
    reach: f64,
    /// Legendre series of `bend / tau^2` and of its rate over `tau`.
    series: [Vec<f64>; 2],
}

/// What one term of the kernel, one that bends, makes of the impulses.
#[derive(Debug, Clone)]
enum Bend {
    /// Of a beam: the coefficient, and the impulses.
    Root(f64, Free),
    /// The power, then ages and `w c age^p`.
    Power(f64, Vec<(f64, f64)>),
}

impl FreeMotion {
    pub fn new(kernel: &Kernel, history: &History) -> FreeMotion {
        FreeMotion { near: bends(kernel, history.impulses()), far: None }
    }

    /// The same for a contact, most of which happens up to `reach`.
    pub fn during_contact(kernel: &Kernel, history: &History, reach: f64) -> FreeMotion {
        let is_far = |impulse: &Impulse| impulse.age >= 2.0 * reach;
        let near = bends(kernel, history.impulses().filter(|impulse| !is_far(impulse)));
        FreeMotion { near, far: Some(Far::new(kernel, bends(kernel, history.impulses().filter(is_far)), reach)) }
    }

    /// The bend.
    pub fn bend(&self, tau: f64) -> f64 {
        bend(&self.near, tau) + self.far.as_ref().map_or(0.0, |far| far.bend(tau))
    }

    /// The bend and its rate.
    pub fn bend_and_gain(&self, tau: f64) -> (f64, f64) {
        let (bend, gain) = bend_and_gain(&self.near, tau);
        let (far_bend, far_gain) = self.far.as_ref().map_or((0.0, 0.0), |far| far.bend_and_gain(tau));
        (bend + far_bend, gain + far_gain)
    }

    /// Speed of the struck point at the origin of time.
    pub fn structure_speed(&self) -> f64 {
        let speed = |term: &Bend| match term {
            Bend::Root(c, free) => c * free.structure_speed(),
            Bend::Power(power, impulses) => impulses.iter().map(|(age, size)| power * size / age).sum(),
        };
        let far = self.far.iter().flat_map(|far| &far.terms);
        self.near.iter().chain(far).map(speed).sum()
    }
}

impl Far {
    fn new(kernel: &Kernel, terms: Vec<Bend>, reach: f64) -> Far {
        let sample = |s: &f64| {
            let tau = reach * s;
            let (bend, gain) = bend_and_gain(&terms, tau);
            (bend / (tau * tau), gain / tau)
        };
        let (of_bend, of_gain): (Vec<f64>, Vec<f64>) = kernel.tables.sigma.iter().map(sample).unzip();
        let series = [of_bend, of_gain].map(|values| kernel.tables.coefficients(&values));
        Far { terms, reach, series }
    }

    fn bend(&self, tau: f64) -> f64 {
        if tau > self.reach { bend(&self.terms, tau) } else { tau * tau * series(&self.series[0], tau / self.reach) }
    }

    fn bend_and_gain(&self, tau: f64) -> (f64, f64) {
        if tau > self.reach {
            return bend_and_gain(&self.terms, tau);
        }
        let [of_bend, of_gain] = self.series.each_ref().map(|of| series(of, tau / self.reach));
        (tau * tau * of_bend, tau * of_gain)
    }
}

/// What the terms of a kernel make of impulses; a term with power 0 does not contribute.
fn bends(kernel: &Kernel, impulses: impl Iterator<Item = Impulse> + Clone) -> Vec<Bend> {
    let bend = |&(c, power): &(f64, f64)| match power {
        0.5 => Bend::Root(c, Free::of(impulses.clone())),
        _ => {
            let size = |impulse: Impulse| (impulse.age, impulse.weight * c * impulse.age.powf(power));
            Bend::Power(power, impulses.clone().map(size).collect())
        }
    };
    kernel.terms.iter().filter(|term| term.1 > 0.0).map(bend).collect()
}

/// The bend by all of them.
fn bend(terms: &[Bend], tau: f64) -> f64 {
    let of = |term: &Bend| match term {
        Bend::Root(c, free) => c * (tau * tau * free.bend(tau)),
        Bend::Power(power, impulses) => impulses.iter().map(|(age, size)| size * excess(*power, tau / age)).sum(),
    };
    terms.iter().map(of).sum()
}

/// The bend by all of them and its rate.
fn bend_and_gain(terms: &[Bend], tau: f64) -> (f64, f64) {
    let mut sums = (0.0, 0.0);
    for term in terms {
        match term {
            Bend::Root(c, free) => {
                let (bend, gain) = free.bend_and_gain(tau);
                sums.0 += c * (tau * tau * bend);
                sums.1 += c * gain;
            }
            Bend::Power(power, impulses) => {
                for (age, size) in impulses {
                    let y = tau / age;
                    sums.0 += size * excess(*power, y);
                    sums.1 += size * power / age * -((power - 1.0) * y.ln_1p()).exp_m1();
                }
            }
        }
    }
    sums
}

/// `1 + p y - (1 + y)^p` for `y >= 0`, without cancellation near zero.
fn excess(p: f64, y: f64) -> f64 {
    if y > 0.1 {
        return 1.0 + p * y - (1.0 + y).powf(p);
    }
    // binomial series from the second power on
    let (mut sum, mut term) = (0.0, p * y);
    for n in 2..20 {
        term *= (p - f64::from(n - 1)) / f64::from(n) * y;
        sum -= term;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::infinite::receptance::{Receptance, Scale, Term};
    use crate::infinite::rule::dot;
    use crate::modal::Striker;

    #[test]
    fn excess_joins() {
        for p in [0.1, 0.5, 0.9] {
            let (a, b) = (excess(p, 0.1), excess(p, 0.1 * (1.0 + 1e-12)));
            assert!((a / b - 1.0).abs() < 1e-11, "{p}: {a} {b}");
            assert!((excess(p, 1e-8) / (0.5 * p * (1.0 - p) * 1e-16) - 1.0).abs() < 1e-7);
        }
    }

    /// Where old impulses are a series, the motion is that of all impulses.
    #[test]
    fn old_impulses_act_as_a_series() {
        let mut history = History::default();
        let impulses = (1..40).map(|i| Impulse { age: 0.1 * f64::from(i * i), weight: 1.0 / f64::from(i) });
        history.push(impulses.collect(), 0.1, 160.0);
        for powers in [vec![0.5], vec![0.0, 0.3, 0.5]] {
            let terms: Vec<Term> = powers.iter().map(|&power| Term { coefficient: 1.5, power }).collect();
            let structure = Receptance::new(&terms).unwrap();
            let scale = structure.scale(&Striker { mass_kg: 1.0, speed_m_s: 1.0 }).unwrap();
            let kernel = Kernel::new(&structure, &scale, 20);
            let (all, during) =
                (FreeMotion::new(&kernel, &history), FreeMotion::during_contact(&kernel, &history, 3.0));
            for tau in [1e-9, 1e-3, 0.7, 2.9, 3.0, 3.1, 50.0] {
                let ((a, a_rate), (b, b_rate)) = (all.bend_and_gain(tau), during.bend_and_gain(tau));
                assert!((b / a - 1.0).abs() < 1e-13 && (b_rate / a_rate - 1.0).abs() < 1e-13, "{tau}: {a} {b}");
            }
        }
    }

    /// The motion after impulses on a beam, which has sums of its own, lies between those of two neighbouring powers.
    #[test]
    fn a_square_root_bends_like_its_neighbours() {
        let mut history = History::default();
        history.push(vec![Impulse { age: 0.3, weight: 2.0 }, Impulse { age: 7.0, weight: 0.5 }], 0.3, 7.0);
        let motion = |power: f64| {
            let structure = Receptance::new(&[Term { coefficient: 1.5, power }]).unwrap();
            let striker = Striker { mass_kg: 1.0, speed_m_s: 1.0 };
            let scale = Scale { time_s: 1.0, ..structure.scale(&striker).unwrap() };
            FreeMotion::new(&Kernel::new(&structure, &scale, 8), &history)
        };
        let (root, below, above) = (motion(0.5), motion(0.5 - 1e-5), motion(0.5 + 1e-5));
        let near =
            |exact: f64, a: f64, b: f64| assert!((0.5 * (a + b) - exact).abs() <= 1e-7 * exact, "{exact} {a} {b}");
        near(root.structure_speed(), below.structure_speed(), above.structure_speed());
        for tau in [0.0, 1e-6, 1e-3, 0.1, 1.0, 40.0, 1e4] {
            let (exact, a, b) = (root.bend_and_gain(tau), below.bend_and_gain(tau), above.bend_and_gain(tau));
            near(exact.0, a.0, b.0);
            near(exact.1, a.1, b.1);
        }
    }

    /// The closed form for a middle panel on a beam against the impulses that represent it.
    #[test]
    fn closed_form_and_impulses_agree() {
        let beam = Receptance::new(&[Term { coefficient: 1.5, power: 0.5 }]).unwrap();
        let scale = beam.scale(&Striker { mass_kg: 1.0, speed_m_s: 1.0 }).unwrap();
        let kernel = Kernel::new(&beam, &scale, 20);
        let f: Vec<f64> = kernel.tables.sigma.iter().map(|s| (3.0 * s).sin() + 0.5).collect();
        let f_series = kernel.tables.coefficients(&f);
        let panel = Solved::new(&kernel, Kind::Middle, 0.0, 0.7, f, f_series);
        for behind in [0.0, 1e-3, 0.5, 40.0] {
            let after = [3e-3, 0.05, 0.3, 2.0];
            let sums = |panel: &Solved| {
                let (mut memory, mut slope) = ([0.0; 4], [0.0; 4]);
                panel.add_after_effect(&kernel, behind, &after, &mut memory, &mut slope);
                [memory, slope]
            };
            let (closed, impulses) = (sums(&panel), sums(&Solved { root: None, ..panel.clone() }));
            assert!(panel.root.is_some());
            for (a, b) in closed.iter().flatten().zip(impulses.iter().flatten()) {
                assert!((a / b - 1.0).abs() < 1e-13, "{behind}: {a} {b}");
            }
        }
    }

    /// A contact with the force `(t (1 - t))^(3/2)`: its effect on the beam during and after it
    /// (hypergeometric closed forms, values in 50-digit arithmetic).
    #[test]
    fn manufactured_contact() {
        let beam = Receptance::new(&[Term { coefficient: 1.0, power: 0.5 }]).unwrap();
        let scale = beam.scale(&Striker { mass_kg: 1.0, speed_m_s: 1.0 }).unwrap();
        for p in [16, 20, 28] {
            let kernel = Kernel::new(&beam, &scale, p);
            let panel = |kind, start: f64| {
                let rule = kernel.tables.rule(kind);
                let x = |j: usize| (start + 0.5 * rule.elapsed[j]) * (0.5 - start + 0.5 * rule.remaining[j]);
                let f: Vec<f64> = (0..p).map(|j| x(j).powf(1.5)).collect();
                let f_series = kernel.tables.coefficients(&f);
                Solved::new(&kernel, kind, 0.0, 0.5, f, f_series)
            };
            let (first, second) = (panel(Kind::Start, 0.0), panel(Kind::End, 0.5));
            let own = |panel: &Solved| {
                let mut weights = Vec::new();
                kernel.weigh_compression(panel.kind, 0.5, &mut weights);
                // without the motion of the body, which is that under the power 1
                dot(&weights[p * p..], &panel.force) - 0.25 * dot(kernel.totals(panel.kind).1, &panel.force)
            };
            let later = |panel: &Solved, after: f64| {
                let mut sum = [0.0];
                panel.add_after_effect(&kernel, 0.0, &[after], &mut sum, &mut []);
                sum[0]
            };
            let after = |t: f64| later(&first, t - 0.5) + later(&second, t - 1.0);
            let found = [own(&first), later(&first, 0.5) + own(&second), after(10.0), after(1e6)];
            let exact = [0.014120218079899651, 16.0 / 315.0, 0.22693312224317404, 73.63105941073864];
            for (found, exact) in found.iter().zip(exact) {
                assert!((found / exact - 1.0).abs() < 1e-12, "{p}: {found} {exact}");
            }
            // `int (1/2 - t) f dt` over the first half
            assert!((0.25 * dot(kernel.totals(Kind::Start).1, &first.force) / 0.00625 - 1.0).abs() < 1e-12);
        }
    }

    /// The later effect of the force `t^(3/2) (1 - t)` on a start panel, next to it and far away, against many-node quadrature
    /// in `sqrt(t)`.
    #[test]
    fn closed_form_of_a_start_panel() {
        let beam = Receptance::new(&[Term { coefficient: 1.0, power: 0.5 }]).unwrap();
        let scale = beam.scale(&Striker { mass_kg: 1.0, speed_m_s: 1.0 }).unwrap();
        let kernel = Kernel::new(&beam, &scale, 20);
        let f: Vec<f64> = kernel.tables.sigma.iter().map(|s| s.powi(3) * (1.0 - s * s)).collect();
        let f_series = kernel.tables.coefficients(&f);
        let panel = Solved::new(&kernel, Kind::Start, 0.0, 1.0, f, f_series);
        for after in [0.0, 1e-9, 1e-3, 0.3, 1.0, 10.0, 1e4] {
            let z: f64 = (1.0_f64 + after).sqrt();
            let range = (1.0 / z).asin();
            let part = |&(y, w): &(f64, f64)| {
                let (sin, cos) = (range * y).sin_cos();
                let s = z * sin;
                range * w * z * cos * 2.0 * s * s.powi(3) * (1.0 - s * s) * z * cos
            };
            let exact: f64 = crate::infinite::rule::gauss(60).iter().map(part).sum();
            let mut sum = [0.0];
            panel.add_after_effect(&kernel, 0.0, &[after], &mut sum, &mut []);
            assert!((sum[0] / exact - 1.0).abs() < 2e-14, "{after}: {} {exact}", sum[0]);
        }
    }

    /// The memory of a force `t^2` on a middle panel, `t` on a start panel and the remaining time on an end panel, close
    /// to its end and far from it, against beta-like closed forms evaluated by many-node quadrature.
    #[test]
    fn impulses_stand_for_a_panel() {
        let tables = Tables::get(20);
        for kind in [Kind::Start, Kind::Middle, Kind::End] {
            let rule = tables.rule(kind);
            let shape = |t: f64| if kind == Kind::End { 1.0 - t } else { t };
            let f: Vec<f64> = rule.elapsed[..20].iter().map(|&t| shape(t)).collect();
            let f_series = tables.coefficients(&f);
            let panel = Solved { kind, end: 0.0, h: 1.0, force: f, f_series, root: None };
            for gap in [1e-6_f64, 1e-3, 0.1, 1.0, 30.0] {
                let sum = |power: f64| -> f64 {
                    panel.impulses(tables, 0.0, gap).iter().map(|i| i.weight * (i.age + gap).powf(power)).sum()
                };
                for power in [0.5_f64, -0.5, 0.3, -0.7] {
                    // int_0^1 (1 + gap - t)^power f(t) dt with f = t, or 1 - t
                    let moment = |z: f64| z.powf(power + 1.0) / (power + 1.0);
                    let second = |z: f64| z.powf(power + 2.0) / ((power + 1.0) * (power + 2.0));
                    let exact = match kind {
                        Kind::End => moment(1.0 + gap) - second(1.0 + gap) + second(gap),
                        _ => second(1.0 + gap) - second(gap) - moment(gap),
                    };
                    let loss = 1e-15 * (1.0 + gap).powi(2);
                    let error = (sum(power) / exact - 1.0).abs();
                    assert!(error < 1e-10 + loss, "{kind:?} {gap} {power}: {error:e}");
                }
            }
        }
    }
}
