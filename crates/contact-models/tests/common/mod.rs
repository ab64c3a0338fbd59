//! A plain striker at a wall, integrated step by step through the contract of a law.

use contact_models::{After, Boundary, Branch, ContactLaw, Memory, boundaries};
use contact_models::{Felt, Flores, Hertz, HuntCrossley, Hysteretic, KelvinVoigt, LankaraniNikravesh};
use contact_models::{Law, LinearSpring, Power, Thornton, Viscous};
use proptest::prelude::*;

pub const BALL_MASS_KG: f64 = 0.11027;
pub const K_H: f64 = 1.7945e10;

/// Speed ratio of a rigid striker after its contact with a wall, by the classical Runge-Kutta method with steps of
/// `duration_s / 20000` that end on every boundary.
pub fn rebound(law: &impl ContactLaw, mass_kg: f64, speed_m_s: f64, duration_s: f64) -> f64 {
    let mut branch = law.touch(&Memory::default(), speed_m_s);
    let mut state = (0.0, speed_m_s);
    let h = duration_s / 20000.0;
    for _ in 0..10_000_000 {
        let full = step(law, &branch, mass_kg, state, h);
        let ends: Vec<Boundary> = boundaries(law, &branch).collect();
        let margin = |which: usize, (xi, rate): (f64, f64)| ends[which].margin(xi, rate);
        let Some(which) = (0..ends.len()).find(|&which| margin(which, full) < 0.0) else {
            state = full;
            continue;
        };
        let (mut inside, mut beyond) = (0.0, h);
        for _ in 0..60 {
            let middle = 0.5 * (inside + beyond);
            *(if margin(which, step(law, &branch, mass_kg, state, middle)) < 0.0 {
                &mut beyond
            } else {
                &mut inside
            }) = middle;
        }
        state = step(law, &branch, mass_kg, state, beyond);
        match law.cross(&branch, which, state.0, state.1) {
            After::Continue(next) => branch = next,
            After::Release(_) => return -state.1 / speed_m_s,
        }
    }
    panic!("the contact does not end");
}

fn step(law: &impl ContactLaw, branch: &Branch, mass_kg: f64, (xi, v): (f64, f64), h: f64) -> (f64, f64) {
    let slope = |xi: f64, v: f64| (v, -law.force(branch, xi, v).force_n / mass_kg);
    let k1 = slope(xi, v);
    let k2 = slope(xi + 0.5 * h * k1.0, v + 0.5 * h * k1.1);
    let k3 = slope(xi + 0.5 * h * k2.0, v + 0.5 * h * k2.1);
    let k4 = slope(xi + h * k3.0, v + h * k3.1);
    (xi + h / 6.0 * (k1.0 + 2.0 * k2.0 + 2.0 * k3.0 + k4.0), v + h / 6.0 * (k1.1 + 2.0 * k2.1 + 2.0 * k3.1 + k4.1))
}

/// A motion with a piecewise linear rate: compression and rate at integer times.
#[derive(Debug, Clone)]
pub struct Motion {
    rates: Vec<f64>,
    compressions: Vec<f64>,
}

impl Motion {
    /// Starts at first touch with these rates, and continues until the bodies are separate.
    fn new(mut rates: Vec<f64>) -> Motion {
        let mut compressions = vec![0.0];
        let mut i = 0;
        while compressions[i] > -0.2 || i + 1 < rates.len() {
            if i + 1 == rates.len() {
                rates.push(-1.0);
            }
            compressions.push(compressions[i] + 0.5 * (rates[i] + rates[i + 1]));
            i += 1;
        }
        Motion { rates, compressions }
    }

    pub fn times(&self) -> Vec<f64> {
        (0..=50 * (self.rates.len() as u32 - 1)).map(|i| f64::from(i) / 50.0).collect()
    }

    pub fn at(&self, t: f64) -> (f64, f64) {
        let i = (t as usize).min(self.rates.len() - 2);
        let (s, v, dv) = (t - i as f64, self.rates[i], self.rates[i + 1] - self.rates[i]);
        (self.compressions[i] + s * (v + 0.5 * s * dv), v + s * dv)
    }
}

pub fn motions() -> impl Strategy<Value = Motion> {
    (0.05..2.0, prop::collection::vec(-2.0..2.0, 2..10)).prop_map(|(first, mut rates)| {
        rates.insert(0, first);
        Motion::new(rates)
    })
}

/// Any law, on a scale on which compressions and rates are near 1.
pub fn laws() -> impl Strategy<Value = Law> {
    let (k, e) = (0.2..5.0, 0.05..1.0);
    prop_oneof![
        k.clone().prop_map(|k| Hertz::new(k).unwrap().into()),
        k.clone().prop_map(|k| LinearSpring::new(k).unwrap().into()),
        (k.clone(), 0.0..2.0).prop_map(|(k, c)| Viscous::new(k, c).unwrap().into()),
        (k.clone(), 0.2..3.0, 0.0..1.0, 0.05..8.0, prop_oneof![Just(0.0), 1e-6..0.1]).prop_map(
            |(k, theta_m, share, k_bar, eps)| {
                Hysteretic { stiffness_n_m1_5: k, theta_m, beta: share * (1.0 + theta_m), k_bar, epsilon_m: eps }
                    .validated()
                    .unwrap()
                    .into()
            }
        ),
        (k.clone(), 0.01..3.0).prop_map(|(k, c)| KelvinVoigt::new(k, c).unwrap().into()),
        (k.clone(), 1.0..4.0).prop_map(|(k, n)| Power::new(k, n).unwrap().into()),
        (k.clone(), 2.0..5.0, 0.01..2.0).prop_map(|(k, p, a)| Felt::new(k, p, a).unwrap().into()),
        (k.clone(), 1.0..4.0, 0.0..2.0).prop_map(|(k, n, d)| HuntCrossley::new(k, n, d).unwrap().into()),
        (k.clone(), e.clone()).prop_map(|(k, e)| LankaraniNikravesh::new(k, e).unwrap().into()),
        (k.clone(), e).prop_map(|(k, e)| Flores::new(k, e).unwrap().into()),
        (k, 0.5..3.0, 0.1..1.0).prop_map(|(modulus, r, p)| Thornton::new(modulus, r, p * modulus).unwrap().into()),
    ]
}

/// A state inside a branch.
#[derive(Debug, Clone, Copy)]
pub struct Visit {
    pub branch: Branch,
    pub compression_m: f64,
}

/// A change of branch, or a release.
#[derive(Debug, Clone, Copy)]
pub struct Crossing {
    pub branch_before: Branch,
    pub compression_m: f64,
    pub rate_m_s: f64,
}

#[derive(Debug, Default)]
pub struct Walk {
    pub states: Vec<Visit>,
    pub crossings: Vec<Crossing>,
}

/// Follows a motion from branch to branch, and locates every boundary to rounding.
pub fn walk(law: &Law, motion: &Motion) -> Walk {
    let mut walk = Walk::default();
    let mut memory = Memory::default();
    let mut contact: Option<Branch> = None;
    let times = motion.times();
    for pair in times.windows(2) {
        let (mut from, to) = (pair[0], motion.at(pair[1]));
        for _ in 0..8 {
            let ends = match &contact {
                None => vec![Boundary::compression_rises_to(memory.touch_m)],
                Some(branch) => boundaries(law, branch).collect(),
            };
            let landing = |boundary: &Boundary| {
                let beyond = |t: f64| boundary.margin(motion.at(t).0, motion.at(t).1) < 0.0;
                let (mut low, mut high) = (from, pair[1]);
                for _ in 0..60 {
                    let middle = 0.5 * (low + high);
                    *(if beyond(middle) { &mut high } else { &mut low }) = middle;
                }
                beyond(pair[1]).then_some(high)
            };
            let landings = ends.iter().map(landing).enumerate();
            let met = landings.filter_map(|(which, t)| Some((t?, which))).min_by(|a, b| a.0.total_cmp(&b.0));
            let Some((time, which)) = met else { break };
            from = time;
            let land = motion.at(time);
            let Some(before) = contact else {
                contact = Some(law.touch(&memory, land.1.max(0.0)));
                continue;
            };
            match law.cross(&before, which, land.0, land.1) {
                After::Release(left) => (contact, memory) = (None, left),
                After::Continue(next) => contact = Some(next),
            }
            walk.crossings.push(Crossing { branch_before: before, compression_m: land.0, rate_m_s: land.1 });
        }
        if let Some(branch) = contact {
            walk.states.push(Visit { branch, compression_m: to.0 });
        }
    }
    walk
}

/// The compression at which the branch releases, or zero if it does not state one.
pub fn release_level(law: &Law, branch: &Branch) -> f64 {
    boundaries(law, branch).fold(0.0, |level, boundary| match boundary {
        Boundary { per_compression: 1.0, per_rate: 0.0, level: end } => level.max(end),
        _ => level,
    })
}

/// Work returned if the contact is unloaded from this state at a constant slow rate, by the trapezoidal rule on a grid that is
/// refined towards the release.
pub fn unload(law: &Law, state: &Visit, rate: f64) -> f64 {
    let mut branch = state.branch;
    settle_on(law, &mut branch, state.compression_m, rate); // The branch of unloading, which determines the release.
    let release = release_level(law, &branch);
    let n = 1000;
    let grid = |i: i32| release + (state.compression_m - release) * (f64::from(n - i) / f64::from(n)).powi(2);
    let mut settle = |xi: f64| settle_on(law, &mut branch, xi, rate);
    (0..n).map(|i| 0.5 * (settle(grid(i)) + settle(grid(i + 1))) * (grid(i) - grid(i + 1))).sum()
}

/// Force at this compression on the branch that is valid there while the contact is unloaded.
fn settle_on(law: &Law, branch: &mut Branch, xi: f64, rate: f64) -> f64 {
    for _ in 0..4 {
        let met = boundaries(law, branch).position(|boundary| boundary.margin(xi, -rate) < 0.0);
        match met.map(|which| law.cross(branch, which, xi, -rate)) {
            None => break,
            Some(After::Continue(next)) => *branch = next,
            Some(After::Release(_)) => return 0.0,
        }
    }
    law.force(branch, xi, -rate).force_n
}
