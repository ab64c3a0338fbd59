//! Random impacts for property tests. The seed is fixed, so that a run is the same everywhere.

use contact_models::{
    Felt, Flores, Hertz, HuntCrossley, Hysteretic, KelvinVoigt, LankaraniNikravesh, Law, LinearSpring, Power, Thornton,
    Viscous,
};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use std::f64::consts::PI;
use vibroimpact_sim::modal::{Mode, Settings, Solution, Solver, Start, Striker, Structure};

/// This number of cases, times the environment variable `VIBROIMPACT_CASES` if it is set.
pub fn cases(count: u32) -> u32 {
    let factor = std::env::var("VIBROIMPACT_CASES").ok().and_then(|text| text.parse().ok()).unwrap_or(1);
    count.saturating_mul(factor)
}

pub fn config(count: u32) -> ProptestConfig {
    ProptestConfig {
        cases: cases(count),
        rng_seed: RngSeed::Fixed(2019),
        failure_persistence: None,
        ..ProptestConfig::default()
    }
}

/// Numbers distributed evenly over the decades `10^from .. 10^to`.
pub fn decades(from: f64, to: f64) -> impl Strategy<Value = f64> {
    (from..to).prop_map(|x| 10f64.powf(x))
}

/// Any law, over many decades.
pub fn any_law() -> impl Strategy<Value = Law> {
    let stiffness = || decades(2.0, 14.0);
    prop_oneof![
        stiffness().prop_map(|k| Hertz::new(k).unwrap().into()),
        (stiffness(), decades(-4.0, 2.0)).prop_map(|(k, c)| Viscous::new(k, c).unwrap().into()),
        (stiffness(), decades(-10.0, -3.0)).prop_map(|(k, epsilon)| Hysteretic {
            stiffness_n_m1_5: k,
            theta_m: 1.6,
            beta: 1.4,
            k_bar: 0.4,
            epsilon_m: epsilon
        }
        .validated()
        .unwrap()
        .into()),
        stiffness().prop_map(|k| LinearSpring::new(k).unwrap().into()),
        (stiffness(), 1.0..5.0).prop_map(|(k, n)| Power::new(k, n).unwrap().into()),
        (stiffness(), 2.0..5.0, decades(-6.0, -1.0)).prop_map(|(k, p, a)| Felt::new(k, p, a).unwrap().into()),
        (stiffness(), decades(-3.0, 5.0)).prop_map(|(k, c)| KelvinVoigt::new(k, c).unwrap().into()),
        (stiffness(), 1.0..3.0, decades(-3.0, 2.0)).prop_map(|(k, n, d)| HuntCrossley::new(k, n, d).unwrap().into()),
        (stiffness(), 0.01..1.0).prop_map(|(k, e)| LankaraniNikravesh::new(k, e).unwrap().into()),
        (stiffness(), 0.05..1.0).prop_map(|(k, e)| Flores::new(k, e).unwrap().into()),
        (decades(6.0, 12.0), decades(-3.0, 0.0), decades(5.0, 10.0))
            .prop_map(|(modulus, radius, yields)| Thornton::new(modulus, radius, yields).unwrap().into()),
    ]
}

/// Any structure, over many decades, with and without rigid-body modes and a fast mode that responds like a spring.
pub fn any_structure() -> impl Strategy<Value = Structure> {
    let damping = prop_oneof![Just(0.0), decades(-4.0, 1.0)];
    let compliance = prop_oneof![4 => Just(None), 1 => decades(-12.0, -6.0).prop_map(Some)];
    let rigid = prop_oneof![2 => Just(None), 1 => decades(-2.0, 1.0).prop_map(Some)];
    (0usize..30, decades(0.0, 5.0), 1i32..3, damping, 0.0..1.0f64, compliance, rigid).prop_map(
        |(n, first, power, damping_ratio, place, compliance, rigid)| {
            let elastic = (1..=n).map(|k| Mode {
                omega_rad_s: first * (k as f64).powi(power),
                damping_ratio,
                shape: 1.4 * (PI * k as f64 * place).sin(),
            });
            let rigid = rigid.map(|shape| Mode { omega_rad_s: 0.0, damping_ratio: 0.0, shape });
            let spring = compliance.map(|compliance| {
                let omega_rad_s = 3.0 * first * (n.max(1) as f64).powi(power);
                Mode { omega_rad_s, damping_ratio, shape: omega_rad_s * compliance.sqrt() }
            });
            Structure { modes: elastic.chain(spring).chain(rigid).collect() }
        },
    )
}

/// An impact as an engineer might define it: within two decades of the impact of the thesis.
#[derive(Debug, Clone)]
pub struct Impact {
    pub structure: Structure,
    pub striker: Striker,
    pub law: Law,
}

impl Impact {
    /// At rest and touching, at this tolerance.
    pub fn solve(&self, tolerance: f64) -> Solution {
        let solver = Solver::new(&self.structure).unwrap();
        solver.solve(&self.striker, &self.law, None, &super::settings(tolerance)).unwrap()
    }
}

/// Laws with and without dissipation, for a striker of the order of 0.1 kg at 1 m/s.
pub fn ordinary_law() -> impl Strategy<Value = Law> {
    let stiffness = || decades(8.0, 11.0);
    prop_oneof![
        3 => conservative_law(),
        1 => (stiffness(), decades(-3.0, -0.5)).prop_map(|(k, c)| Viscous::new(k, c).unwrap().into()),
        1 => stiffness().prop_map(|k| Hysteretic { stiffness_n_m1_5: k, theta_m: 1.6, beta: 1.4, k_bar: 0.4, epsilon_m: 5e-8 }.validated().unwrap().into()),
        1 => (decades(5.0, 8.0), decades(0.0, 3.0)).prop_map(|(k, c)| KelvinVoigt::new(k, c).unwrap().into()),
        1 => (stiffness(), decades(-3.0, -0.5)).prop_map(|(k, d)| HuntCrossley::new(k, 1.5, d).unwrap().into()),
        1 => (decades(10.0, 11.3), decades(-2.5, -1.5), decades(8.0, 10.0))
            .prop_map(|(modulus, radius, yields)| Thornton::new(modulus, radius, yields).unwrap().into()),
    ]
}

/// Laws without dissipation.
pub fn conservative_law() -> impl Strategy<Value = Law> {
    prop_oneof![
        2 => decades(8.0, 11.0).prop_map(|k| Law::from(Hertz::new(k).unwrap())),
        1 => decades(5.0, 8.0).prop_map(|k| Law::from(LinearSpring::new(k).unwrap())),
    ]
}

/// A pinned beam in its first modes, struck anywhere, with or without remainder modes.
pub fn ordinary_structure(damping: impl Strategy<Value = f64>) -> impl Strategy<Value = Structure> {
    (1usize..50, damping, 0.02..0.98f64, any::<bool>()).prop_map(|(n, damping_ratio, b, residual)| match residual {
        true => super::pinned_with_remainder(n, damping_ratio, b),
        false => super::pinned(n, damping_ratio, b),
    })
}

pub fn ordinary_striker() -> impl Strategy<Value = Striker> {
    (decades(-2.5, 0.5), decades(-1.0, 1.0)).prop_map(|(mass_kg, speed_m_s)| Striker { mass_kg, speed_m_s })
}

/// With or without damping.
pub fn ordinary_damping() -> impl Strategy<Value = f64> {
    prop_oneof![1 => Just(0.0), 4 => decades(-3.0, -1.0)]
}

pub fn ordinary_impact() -> impl Strategy<Value = Impact> {
    (ordinary_structure(ordinary_damping()), ordinary_striker(), ordinary_law())
        .prop_map(|(structure, striker, law)| Impact { structure, striker, law })
}

/// An impact at the limits of what an engineer might define: near supports and free ends, many modes without damping, every
/// law, free structures that move towards a stop.
#[derive(Debug, Clone)]
pub struct EdgeImpact {
    pub structure: Structure,
    pub striker: Striker,
    pub law: Law,
    pub start: Option<Start>,
}

impl EdgeImpact {
    pub fn solve(&self, settings: &Settings) -> Solution {
        let solver = Solver::new(&self.structure).unwrap();
        solver.solve(&self.striker, &self.law, self.start.as_ref(), settings).unwrap()
    }
}

/// Laws of every kind, for a striker of the order of 0.1 kg at 1 m/s.
fn edge_law() -> impl Strategy<Value = Law> {
    let stiffness = || decades(8.0, 11.0);
    prop_oneof![
        4 => ordinary_law(),
        1 => (stiffness(), 0.1..1.0).prop_map(|(k, e)| LankaraniNikravesh::new(k, e).unwrap().into()),
        1 => (stiffness(), 0.1..1.0).prop_map(|(k, e)| Flores::new(k, e).unwrap().into()),
    ]
}

/// A pinned beam near its support, a cantilever-like list of modes at its tip, or many modes.
fn edge_structure() -> impl Strategy<Value = Structure> {
    let place = prop_oneof![2 => decades(-3.0, -1.3), 1 => Just(0.5), 2 => 0.02..0.98f64];
    let number = prop_oneof![2 => 1usize..50, 1 => 50usize..120];
    let damping = prop_oneof![1 => Just(0.0), 2 => decades(-4.0, -1.0)];
    (number, damping, place, any::<bool>(), any::<bool>()).prop_map(|(n, damping_ratio, b, residual, tip)| {
        if residual {
            return super::pinned_with_remainder(n, damping_ratio, b);
        }
        let mut structure = super::pinned(n, damping_ratio, b);
        if tip {
            // All shapes of one size, as at a free end.
            for (k, mode) in structure.modes.iter_mut().enumerate() {
                mode.omega_rad_s *= ((k as f64 + 0.5) / (k as f64 + 1.0)).powi(2);
                mode.shape = 2.0;
            }
        }
        structure
    })
}

pub fn edge_impact() -> impl Strategy<Value = EdgeImpact> {
    let striker = (edge_structure(), ordinary_striker(), edge_law()).prop_map(|(structure, striker, law)| EdgeImpact {
        structure,
        striker,
        law,
        start: None,
    });
    let stop = (edge_structure(), decades(-1.0, 0.5), decades(-1.0, 1.0), -0.3..0.3f64, edge_law()).prop_map(
        |(mut structure, shape, speed, swing, law)| {
            // A structure that moves as a rigid body, vibrating in its lowest mode.
            structure.modes.insert(0, Mode { omega_rad_s: 0.0, damping_ratio: 0.0, shape });
            let mut start = Start::at_rest(structure.modes.len());
            start.rate[0] = speed / shape;
            start.rate[1] = swing * speed / structure.modes[1].shape.abs().max(0.1);
            start.gap_m = 1e-3;
            EdgeImpact {
                structure,
                striker: Striker { mass_kg: f64::INFINITY, speed_m_s: 0.0 },
                law,
                start: Some(start),
            }
        },
    );
    prop_oneof![4 => striker, 1 => stop]
}
