//! Phase speeds of bending waves by both theories, compared with elasticity in two dimensions.

use super::{Coefficient, coefficients};
use crate::chapters::chapter3::Case;
use crate::chapters::material::Material;
use crate::chapters::statement::Statement;
use crate::chapters::study::Study;
use serde::Serialize;
use std::f64::consts::PI;
use tasks::Failure;
use vibroimpact::plot::{Axis, Colour, Figure, Panel, Series};
use vibroimpact::report::significant;

/// Number of modes of chapter 3's beam that are considered.
const MODES: usize = 200;
/// Modes of the table.
const TOLD: [usize; 6] = [6, 15, 40, 80, 120, 200];

/// `X` of Eq. (1) at `g = (kh)^2/12`.
fn euler_bernoulli(g: f64, nu: f64) -> f64 {
    2.0 * (1.0 + nu) * g
}

/// `X` of Eq. (2).
fn timoshenko(g: f64, nu: f64, kappa: f64) -> f64 {
    let (a, b, c) = (g / kappa, 1.0 + g * (1.0 + 2.0 * (1.0 + nu) / kappa), 2.0 * (1.0 + nu) * g);
    2.0 * c / (b + (b * b - 4.0 * a * c).sqrt())
}

/// `X` of Eq. (3) at `kh`: the left side is below the right one between zero and the root, above it from there to one.
fn elasticity(kh: f64, nu: f64) -> f64 {
    let half = 0.5 * kh;
    let excess = |x: f64| {
        let (a, b) = ((1.0 - 0.5 * x * (1.0 - nu)).sqrt(), (1.0 - x).sqrt());
        (2.0 - x).powi(2) * (a * half).tanh() - 4.0 * a * b * (b * half).tanh()
    };
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        *(if excess(middle) < 0.0 { &mut low } else { &mut high }) = middle;
    }
    0.5 * (low + high)
}

/// Phase speeds (m/s) of one mode of a pinned beam, and the relative errors of both theories compared with elasticity.
#[derive(Serialize)]
struct Speeds {
    mode: usize,
    half_wave_over_thickness: f64,
    elasticity_m_s: f64,
    euler_bernoulli: f64,
    reissner: f64,
    cowper: f64,
    kaneko: f64,
    hutchinson: f64,
}

impl Speeds {
    fn new(mode: usize, thickness_over_length: f64, material: &Material) -> Speeds {
        let nu = material.poissons_ratio;
        let kh = mode as f64 * PI * thickness_over_length;
        let g = kh * kh / 12.0;
        let exact = elasticity(kh, nu);
        let shear_speed = (0.5 * material.youngs_modulus_pa / ((1.0 + nu) * material.density_kg_m3)).sqrt();
        let error = |x: f64| (x / exact).sqrt() - 1.0;
        let [reissner, cowper, kaneko, hutchinson] =
            coefficients(material).map(|Coefficient { value, .. }| error(timoshenko(g, nu, value)));
        Speeds {
            mode,
            half_wave_over_thickness: PI / kh,
            elasticity_m_s: shear_speed * exact.sqrt(),
            euler_bernoulli: error(euler_bernoulli(g, nu)),
            reissner,
            cowper,
            kaneko,
            hutchinson,
        }
    }

    fn errors(&self) -> [f64; 5] {
        [self.euler_bernoulli, self.reissner, self.cowper, self.kaneko, self.hutchinson]
    }
}

pub(super) fn run(study: &mut Study, case: &Case) -> Result<(), Failure> {
    study.section("Phase speeds compared with elasticity");
    let material = &case.parameters.material;
    let slender = case.parameters.beam.side_m / case.parameters.beam.length_m;
    let all: Vec<Speeds> = (1..=MODES).map(|mode| Speeds::new(mode, slender, material)).collect();
    study.csv("phase-speeds.csv", &all)?;

    let percent = |error: f64| format!("{} %", significant(100.0 * error, 2));
    let line = |s: &Speeds| {
        let waves = [s.mode.to_string(), significant(s.half_wave_over_thickness, 2), significant(s.elasticity_m_s, 4)];
        waves.into_iter().chain(s.errors().map(percent)).collect()
    };
    let lines: Vec<Vec<String>> = TOLD.iter().map(|mode| line(&all[mode - 1])).collect();
    let names: Vec<String> =
        coefficients(material).iter().map(|c| format!("κ = {} ({})", significant(c.value, 4), c.name)).collect();
    let headers: Vec<&str> = ["mode", "half wave / thickness", "elasticity (m/s)", "Euler-Bernoulli"]
        .into_iter()
        .chain(names.iter().map(String::as_str))
        .collect();
    study.tabled("phase-speeds-printed", &headers, &lines)?;
    study.text(
        "The table has the deviation of the phase speed from elasticity in two dimensions, for modes of the beam of \
         chapter 3.",
    );
    picture(study, &all, &names)?;

    let largest = |of: fn(&Speeds) -> f64| all.iter().map(|s| of(s).abs()).fold(0.0, f64::max);
    let claim = |quantity: &str, stated: &str, limits: (f64, f64), ours: f64| {
        Statement::self_check(
            format!("phase speed against elasticity, {quantity}"),
            ["Rayleigh, Lamb", stated, "half a unit of the last digit"],
            limits,
            ours,
        )
    };
    study.state(claim(
        "Kaneko's coefficient, largest error of 200 modes",
        "0.4 %",
        (0.0035, 0.0045),
        largest(|s| s.kaneko),
    ));
    study.state(claim(
        "Cowper's coefficient, largest error of 200 modes",
        "1.2 %",
        (0.0115, 0.0125),
        largest(|s| s.cowper),
    ));
    for (mode, stated, limits) in
        [(6, "1 %", (0.005, 0.015)), (15, "5 %", (0.045, 0.055)), (40, "27 %", (0.265, 0.275))]
    {
        let quantity = format!("Euler-Bernoulli, error of mode {mode}");
        study.state(claim(&quantity, stated, limits, all[mode - 1].euler_bernoulli));
    }
    Ok(())
}

fn picture(study: &mut Study, all: &[Speeds], names: &[String]) -> Result<(), Failure> {
    let modes: Vec<f64> = all.iter().map(|s| s.mode as f64).collect();
    let speed = |of: fn(&Speeds) -> f64| -> Vec<f64> { all.iter().map(|s| s.elasticity_m_s * (1.0 + of(s))).collect() };
    let x = Axis::new("mode").limits(0.0, MODES as f64);
    let speeds = Panel::new(x.clone(), Axis::new("phase speed").unit("m/s").limits(0.0, 5000.0))
        .title("phase speed")
        .height(230.0)
        .with(Series::line(&modes, &speed(|s| s.euler_bernoulli)).colour(Colour::Vermilion).label("Euler-Bernoulli"))
        .with(Series::line(&modes, &speed(|s| s.kaneko)).colour(Colour::Blue).label("Timoshenko, Kaneko's κ"))
        .with(Series::line(&modes, &speed(|_| 0.0)).colour(Colour::Black).dashed().label("elasticity"));
    let mut errors = Panel::new(x, Axis::new("error of the phase speed").unit("%").limits(-1.5, 1.5))
        .title("error compared with elasticity")
        .height(230.0);
    let percent = |i: usize| -> Vec<f64> { all.iter().map(|s| 100.0 * s.errors()[i]).collect() };
    errors = errors.with(Series::line(&modes, &percent(0)).colour(Colour::Vermilion).label("Euler-Bernoulli"));
    for (i, (name, colour)) in names.iter().zip([Colour::Grey, Colour::Green, Colour::Blue, Colour::Orange]).enumerate()
    {
        errors = errors.with(Series::line(&modes, &percent(i + 1)).colour(colour).label(name));
    }
    study.figure(
        "phase-speeds",
        &Figure::new("Bending waves on the beam of chapter 3").row([speeds, errors]).width(960.0),
        "The lowest antisymmetric branch of Rayleigh and Lamb (plane stress) is compared with both theories of \
         bending.",
    )
}

#[cfg(test)]
mod tests {
    use super::super::kaneko;
    use super::*;

    const STEEL: Material = Material { youngs_modulus_pa: 2e11, poissons_ratio: 0.3, density_kg_m3: 7800.0 };

    /// Kaneko's is the only coefficient for which Timoshenko's theory agrees with elasticity to the next order in `g`.
    #[test]
    fn kanekos_coefficient_agrees_with_elasticity_to_the_next_order() {
        let nu = 0.3;
        let error = |kh: f64, kappa: f64| timoshenko(kh * kh / 12.0, nu, kappa) / elasticity(kh, nu) - 1.0;
        let order = |kappa: f64| (error(0.2, kappa) / error(0.1, kappa)).abs().log2();
        assert!((order(kaneko(&STEEL)) - 4.0).abs() < 0.1, "{}", order(kaneko(&STEEL)));
        assert!((order(5.0 / 6.0) - 2.0).abs() < 0.1, "{}", order(5.0 / 6.0));
        let slender = euler_bernoulli(0.01 / 12.0, nu) / elasticity(0.1, nu) - 1.0;
        assert!((slender / (0.01 / 12.0 * (1.0 + 2.6 / kaneko(&STEEL))) - 1.0).abs() < 0.01, "{slender}");
    }

    /// Short waves become Rayleigh waves along either face: `(2 - X)^2 = 4 a b`, here as the cubic of Rayleigh (1885).
    #[test]
    fn short_waves_are_rayleighs() {
        for nu in [0.0, 0.2, 0.3, 0.45] {
            let x = elasticity(200.0, nu);
            let share = 0.5 * (1.0 - nu);
            let cubic = x.powi(3) - 8.0 * x * x + (24.0 - 16.0 * share) * x - 16.0 * (1.0 - share);
            assert!(cubic.abs() < 1e-11, "{nu}: {cubic}");
        }
    }
}
