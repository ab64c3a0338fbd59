//! Later effects of past forces: panels as impulses, and the free motion after impulses.

use super::kernel::Kernel;
use crate::infinite::free::Free;
use crate::infinite::history::{History, Impulse};
use crate::infinite::panel::RootSum;
use crate::infinite::rule::{Kind, Tables, series};

/// The force on a panel that is solved.
#[derive(Debug, Clone)]
pub(super) struct Solved {
    pub kind: Kind,
    pub h: f64,
    /// Time from the panel's end to the present.
    pub behind: f64,
    pub f_series: Vec<f64>,
    /// Its integral against the square root, where that has a closed form.
    root: Option<RootSum>,
}

impl Solved {
    /// A panel that ends at present.
    pub fn new(kernel: &Kernel, kind: Kind, h: f64, f_series: Vec<f64>) -> Solved {
        let root = (kind == Kind::Middle && kernel.root().is_some()).then(|| RootSum::new(&f_series));
        Solved { kind, h, behind: 0.0, f_series, root }
    }

    /// Adds the after-effect of the panel on compression and rate at times `after` the present to their sums.
    pub fn add_after_effect(&self, kernel: &Kernel, after: &[f64], memory: &mut [f64], slope: &mut [f64]) {
        if let (Some(c), Some(root)) = (kernel.root(), &self.root) {
            // the variable of the closed form is 1 at the panel's end, and grows by 1 in half its length
            let half = 0.5 * self.h;
            let beyond: Vec<f64> = after.iter().map(|tau| self.behind + tau).collect();
            root.add(c * half * half.sqrt(), half.recip(), &beyond, memory);
            return root.add_slope(c * half.sqrt(), half.recip(), &beyond, slope);
        }
        let gap = self.behind + after.iter().copied().fold(f64::INFINITY, f64::min);
        for impulse in self.impulses(kernel.tables, gap) {
            kernel.add_after_effect(impulse, after, memory, slope);
        }
    }

    /// The panel as impulses with their ages at present, for times not closer to the panel's end than `gap`: in pieces
    /// of the panel's variable that grow in proportion to their distance from there.
    pub fn impulses(&self, tables: &Tables, gap: f64) -> Vec<Impulse> {
        // distance in the panel's variable from its end to the nearest singularity of the kernel
        let reach = match self.kind {
            Kind::Start => 0.5 * gap / self.h,
            Kind::Middle => gap / self.h,
            Kind::End => (gap / self.h).sqrt(),
        };
        let (mut impulses, mut high) = (Vec::new(), 1.0);
        while high > 0.0 {
            let low = if high <= reach || high < 1e-13 { 0.0 } else { 0.5 * high };
            for (y, w) in tables.sigma.iter().zip(&tables.weight) {
                let u = low + (high - low) * y;
                let (s, remaining, rate) = match self.kind {
                    Kind::Start => (1.0 - u, u * (2.0 - u), 2.0 * (1.0 - u)),
                    Kind::Middle => (1.0 - u, u, 1.0),
                    Kind::End => (u, u * u, 2.0 * u),
                };
                let weight = self.h * rate * (high - low) * w * series(&self.f_series, s);
                // the polynomial of a vanishing force may fall below zero by its rounding
                if weight > 0.0 {
                    impulses.push(Impulse { age: self.behind + self.h * remaining, weight });
                }
            }
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
pub(in crate::infinite) struct FreeMotion {
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

    /// The bend and its rate.
    pub fn bend(&self, tau: f64) -> (f64, f64) {
        let (bend, rate) = sum(&self.near, tau);
        let (far_bend, far_rate) = self.far.as_ref().map_or((0.0, 0.0), |far| far.bend(tau));
        (bend + far_bend, rate + far_rate)
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
            let (bend, rate) = sum(&terms, tau);
            (bend / (tau * tau), rate / tau)
        };
        let (of_bend, of_rate): (Vec<f64>, Vec<f64>) = kernel.tables.sigma.iter().map(sample).unzip();
        let series = [of_bend, of_rate].map(|values| kernel.tables.coefficients(&values));
        Far { terms, reach, series }
    }

    /// The bend and its rate.
    fn bend(&self, tau: f64) -> (f64, f64) {
        if tau > self.reach {
            return sum(&self.terms, tau);
        }
        let [of_bend, of_rate] = self.series.each_ref().map(|of| series(of, tau / self.reach));
        (tau * tau * of_bend, tau * of_rate)
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

/// The bend by all of them and its rate.
fn sum(terms: &[Bend], tau: f64) -> (f64, f64) {
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
    use crate::infinite::problem::Structure;
    use crate::infinite::receptance::{Receptance, Scale, Term};
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
                let ((a, a_rate), (b, b_rate)) = (all.bend(tau), during.bend(tau));
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
            let (exact, a, b) = (root.bend(tau), below.bend(tau), above.bend(tau));
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
        let mut panel = Solved::new(&kernel, Kind::Middle, 0.7, kernel.tables.coefficients(&f));
        for behind in [0.0, 1e-3, 0.5, 40.0] {
            panel.behind = behind;
            let after = [3e-3, 0.05, 0.3, 2.0];
            let sums = |panel: &Solved| {
                let (mut memory, mut slope) = ([0.0; 4], [0.0; 4]);
                panel.add_after_effect(&kernel, &after, &mut memory, &mut slope);
                [memory, slope]
            };
            let (closed, impulses) = (sums(&panel), sums(&Solved { root: None, ..panel.clone() }));
            assert!(panel.root.is_some());
            for (a, b) in closed.iter().flatten().zip(impulses.iter().flatten()) {
                assert!((a / b - 1.0).abs() < 1e-13, "{behind}: {a} {b}");
            }
        }
    }

    /// The memory of a force `t^2` on a middle panel, `t` on a start panel and the remaining time on an end panel, close
    /// to its end and far from it, against beta-like closed forms evaluated by many-node quadrature.
    #[test]
    fn impulses_stand_for_a_panel() {
        let tables = Tables::get(Structure::Beam, 20);
        for kind in [Kind::Start, Kind::Middle, Kind::End] {
            let rule = tables.rule(kind);
            let shape = |t: f64| if kind == Kind::End { 1.0 - t } else { t };
            let f: Vec<f64> = rule.elapsed[..20].iter().map(|&t| shape(t)).collect();
            let panel = Solved { kind, h: 1.0, behind: 0.0, f_series: tables.coefficients(&f), root: None };
            for gap in [1e-6_f64, 1e-3, 0.1, 1.0, 30.0] {
                let sum = |power: f64| -> f64 {
                    panel.impulses(tables, gap).iter().map(|i| i.weight * (i.age + gap).powf(power)).sum()
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
