//! Chapter 6: the forms of the law agree, its solution is unique, and the energy never grows.

/// The reference solver of the tests of `emoc`: a quadratic program solved by trying every set of active rows.
#[path = "../../../../crates/emoc/tests/common/enumeration.rs"]
mod enumeration;
mod resolved;

use crate::chapters::statement::Statement;
use crate::chapters::study::Study;
use emoc::{Coefficients, Rebound, SingleImpact};
use serde::Serialize;
use tasks::{Failure, Random};
use vibroimpact::plot::{Axis, Colour, Figure, Marker, Panel, Series};
use vibroimpact::report::significant;

const INTRODUCTION: &str = "Problem P₀ (least kinetic energy under the inequalities 6.5 to 6.7) is solved in four \
forms: in closed form (proof in `docs/emoc-closed-form.md`); as the quadratic program P₁ of section 6.3 in 2N+1 \
variables; in its reduced form in two variables; and, for few modes, with all 2ᴺ choices of signs that section 6.4 \
uses for its proof of uniqueness, by enumeration of all sets of active rows. The cases are random and degenerate ones, \
all from one seed. The inequalities are then compared with impacts of chapter 4 that are resolved in time.";

fn one_in(random: &mut Random, n: f64) -> bool {
    random.range(0.0, n) < 1.0
}

/// Uniform on an interval, with each end drawn with probability 0.1.
fn with_ends(random: &mut Random, low: f64, high: f64) -> f64 {
    match random.range(0.0, 10.0) {
        r if r < 1.0 => low,
        r if r < 2.0 => high,
        _ => random.range(low, high),
    }
}

/// A problem P₀ with speed of approach 1.
#[derive(Debug, Clone)]
struct Case {
    kind: &'static str,
    mass_kg: f64,
    phi: Vec<f64>,
    coefficients: Coefficients<f64>,
}

impl Case {
    fn random(random: &mut Random, modes: usize) -> Case {
        let phi = (0..modes).map(|_| random.range(0.0, 2.0)).collect();
        let beta0 = if one_in(random, 5.0) { random.range(1.0, 30.0) } else { with_ends(random, 0.0, 1.0) };
        let coefficients =
            Coefficients { ebar: with_ends(random, 0.0, 1.0), beta0, beta1: with_ends(random, 0.0, 1.0) };
        Case { kind: "random", mass_kg: 10f64.powf(random.range(-3.0, 2.0)), phi, coefficients }
    }

    /// Degenerate cases: vanishing shapes, vanishing and huge masses, coefficients at their limits, and the kink to the last digit.
    fn degenerate() -> Vec<Case> {
        let mut cases = Vec::new();
        for (ebar, beta0, beta1) in
            [(1.0, 0.0, 0.0), (1.0, 0.5, 0.5), (0.0, 0.5, 0.5), (1.0, 0.0, 1.0), (1.0, 1.0, 0.0), (1e-6, 0.3, 0.3)]
        {
            let coefficients = Coefficients { ebar, beta0, beta1 };
            let shapes: [&[f64]; 4] = [&[1.0], &[0.0, 1.0, 0.0], &[1.0, 1e-9, 1e-3], &[0.7; 50]];
            for phi in shapes {
                let sum: f64 = phi.iter().map(|p| p * p).sum();
                let kink = (1.0 - beta1) / f64::max(beta0 + beta1, 1e-9);
                for z in [1e-12, 1e-3, 1.0, kink.max(1e-12), 1e3, 1e9] {
                    let mass_kg = z / sum;
                    cases.push(Case { kind: "degenerate", mass_kg, phi: phi.to_vec(), coefficients });
                }
            }
            cases.push(Case { kind: "degenerate", mass_kg: 1.0, phi: vec![0.0; 3], coefficients });
        }
        cases
    }

    fn z(&self) -> f64 {
        self.mass_kg * self.phi.iter().map(|phi| phi * phi).sum::<f64>()
    }

    /// The energy after the impact over that before it.
    fn energy(&self, v: f64, rates: &[f64]) -> f64 {
        v * v + rates.iter().map(|a| a * a).sum::<f64>() / self.mass_kg
    }

    /// The least `v_f` that the inequalities 6.5 to 6.7 allow with these modal speeds.
    fn least_velocity(&self, rates: &[f64]) -> f64 {
        let Coefficients { ebar, beta0, beta1 } = self.coefficients;
        let (mut sum, mut sizes, mut bound) = (0.0, 0.0, f64::NEG_INFINITY);
        for (phi, a) in self.phi.iter().zip(rates) {
            sum += phi * a;
            sizes += phi * a.abs();
            if *a != 0.0 {
                bound = f64::max(bound, a.abs() / (phi * self.mass_kg) - 1.0);
            }
        }
        (ebar + sum).max(beta1 * ebar + beta0 * sizes).max(bound)
    }

    /// P₀ with one row for each choice of signs (6.14); gives `v_f`.
    fn all_signs(&self) -> Result<f64, Failure> {
        let n = self.phi.len();
        let Coefficients { ebar, beta0, beta1 } = self.coefficients;
        let row = |first: f64, modal: &dyn Fn(usize) -> f64| [vec![first], (0..n).map(modal).collect()].concat();
        let mut rows = vec![(row(1.0, &|k| -self.phi[k]), ebar)];
        for signs in 0..1usize << n {
            let sign = |k: usize| if (signs >> k) & 1 == 1 { 1.0 } else { -1.0 };
            rows.push((row(1.0, &|k| -beta0 * sign(k) * self.phi[k]), beta1 * ebar));
        }
        for k in 0..n {
            let bound = self.phi[k] * self.mass_kg;
            for sign in [1.0, -1.0] {
                rows.push((row(bound, &|j| if j == k { sign } else { 0.0 }), -bound));
            }
        }
        let hessian: Vec<f64> = std::iter::once(self.mass_kg).chain(vec![1.0; n]).collect();
        let x = enumeration::minimise(&hessian, &rows).ok_or("P0 has no solution by enumeration")?;
        x.first().copied().ok_or_else(|| "no unknown".into())
    }
}

/// Solves one case in all forms.
#[derive(Serialize)]
struct AgreementRow {
    kind: &'static str,
    modes: usize,
    mass_kg: f64,
    ebar: f64,
    beta0: f64,
    beta1: f64,
    z: f64,
    branch: &'static str,
    restitution: f64,
    difference_p1: f64,
    difference_reduced: f64,
    difference_all_signs: Option<f64>,
    energy_ratio: f64,
    /// Least of `(E - E*) / |x - x*|^2` over random feasible points, in the norm of the energy; at least 1 where the
    /// minimum is unique.
    least_growth: f64,
}

impl AgreementRow {
    fn new(case: &Case, seed: u64) -> Result<AgreementRow, Failure> {
        let z = case.z();
        let closed = case.coefficients.rebound(z)?;
        let impact = SingleImpact { mass_kg: case.mass_kg, phi: &case.phi, coefficients: case.coefficients };
        let e = closed.restitution;
        let few = case.phi.len() <= 3 && case.kind == "random";
        Ok(AgreementRow {
            kind: case.kind,
            modes: case.phi.len(),
            mass_kg: case.mass_kg,
            ebar: case.coefficients.ebar,
            beta0: case.coefficients.beta0,
            beta1: case.coefficients.beta1,
            z,
            branch: closed.branch.as_str(),
            restitution: e,
            difference_p1: (impact.solve_full()?.restitution - e).abs(),
            difference_reduced: (impact.solve_reduced()?.restitution - e).abs(),
            difference_all_signs: few.then(|| case.all_signs()).transpose()?.map(|v| (v - e).abs()),
            energy_ratio: e * e + closed.modal_energy_fraction(z),
            least_growth: least_growth(case, &closed, seed)?,
        })
    }
}

/// Feasible points tried around each solution.
const TRIALS: usize = 40;

/// A point `x*` of a convex set is its only minimum of `|x|^2` if `|x|^2 - |x*|^2 >= |x - x*|^2` on all of it. Gives the
/// least ratio of the two sides over random feasible points, near and far.
fn least_growth(case: &Case, closed: &Rebound, seed: u64) -> Result<f64, Failure> {
    let mut random = Random::new(seed);
    let mut solution = vec![0.0; case.phi.len()];
    closed.modal_rates(1.0, &case.phi, &mut solution)?;
    let least = case.energy(closed.restitution, &solution);
    let mut growth = f64::INFINITY;
    for _ in 0..TRIALS {
        let reach = 10f64.powf(random.range(-2.0, 1.0)) * case.mass_kg.sqrt();
        let rates: Vec<f64> = solution
            .iter()
            .zip(&case.phi)
            .map(|(a, phi)| if *phi > 0.0 { a + reach * random.range(-1.0, 1.0) } else { 0.0 })
            .collect();
        let extra = if one_in(&mut random, 2.0) { 0.0 } else { random.range(0.0, 0.3) };
        let v = case.least_velocity(&rates) + extra;
        let steps: Vec<f64> = rates.iter().zip(&solution).map(|(a, b)| a - b).collect();
        let distance = case.energy(v - closed.restitution, &steps);
        // rounding dominates at closer points
        if distance > 1e-6 * least.max(1e-6) {
            growth = growth.min((case.energy(v, &rates) - least) / distance);
        }
    }
    Ok(growth)
}

/// Runs the chapter and returns the text that introduces its report.
pub(super) fn run(study: &mut Study) -> Result<&'static str, Failure> {
    study.section("The forms agree");
    let mut random = Random::new(6);
    let (many, few) = if study.quick { (60, 60) } else { (1500, 1000) };
    let mut cases: Vec<Case> =
        (0..many).map(|i| Case::random(&mut random, if i % 10 == 0 { 50 } else { 1 + i % 12 })).collect();
    cases.extend((0..few).map(|i| Case::random(&mut random, if i % 20 == 0 { 3 } else { 1 + i % 2 })));
    cases.extend(Case::degenerate());
    let numbered: Vec<(u64, Case)> = (0..).zip(cases).collect();
    let rows = study.sweep(&numbered, 1, |(seed, case)| AgreementRow::new(case, *seed))?;
    study.csv("agreement.csv", &rows)?;
    agreement(study, &rows)?;
    uniqueness_and_energy(study, &rows)?;
    shape(study)?;
    resolved::run(study)?;
    Ok(INTRODUCTION)
}

/// Groups of cases with different accuracy of the numerical solutions.
const GROUPS: [&str; 3] = ["random, β₁ < 1", "random, β₁ = 1", "degenerate"];

fn group(row: &AgreementRow) -> &'static str {
    GROUPS[if row.kind == "degenerate" { 2 } else { usize::from(row.beta1 == 1.0) }]
}

fn agreement(study: &mut Study, rows: &[AgreementRow]) -> Result<(), Failure> {
    let mut panel =
        Panel::new(Axis::new("moderated mass ratio Z").log(), Axis::new("difference of e").log().limits(1e-17, 1e-5));
    panel.height_px = 260.0;
    type Difference = fn(&AgreementRow) -> Option<f64>;
    let forms: [(&str, Difference, Marker); 3] = [
        ("P₁, quadratic program in 2N+1 variables", |row| Some(row.difference_p1), Marker::Plus),
        ("reduced form, two variables", |row| Some(row.difference_reduced), Marker::Circle),
        ("all 2ᴺ inequalities, enumeration", |row| row.difference_all_signs, Marker::Triangle),
    ];
    let mut lines = Vec::new();
    for (name, difference, marker) in forms {
        // differences of exactly zero are drawn at the lower edge, where few points suffice
        let all = rows.iter().filter_map(|row| Some((row.z, difference(row)?.max(1.5e-17))));
        let (z, shown): (Vec<f64>, Vec<f64>) =
            all.enumerate().filter(|(i, (_, d))| *d > 1e-14 || i.is_multiple_of(8)).map(|(_, point)| point).unzip();
        panel = panel.with(Series::points(&z, &shown, marker).label(name));
        for name_of_group in GROUPS {
            let found: Vec<f64> =
                rows.iter().filter(|row| group(row) == name_of_group).filter_map(difference).collect();
            if found.is_empty() {
                continue;
            }
            let largest = found.iter().copied().fold(0.0, f64::max);
            lines.push(vec![name.into(), name_of_group.into(), found.len().to_string(), significant(largest, 2)]);
            study.state(Statement::identity(
                format!("largest difference of e between closed form and {name}; {name_of_group}"),
                ["6.4", "P₀ and P₁ are equivalent", "rounding"],
                (0.0, 1e-10),
                largest,
            ));
        }
    }
    study.table(&["form compared with the closed one", "cases", "number", "largest difference of e"], &lines);
    study.text(
        "With β₁ = 1 more rows are active at the minimum than there are unknowns. At the kink a multiplier vanishes, \
         and with shapes of 1e-9 P₁ is nearly singular. The active rows prove the result of the interior-point method \
         in these cases too, and complete its digits.",
    );
    study.figure(
        "agreement",
        &Figure::new("Difference of the restitution from the closed form").row([panel]),
        "The figure shows every case that differs by more than 10⁻¹⁴ and one in eight of the others. Cases that agree \
         to the last bit are drawn at 1.5×10⁻¹⁷.",
    )
}

fn uniqueness_and_energy(study: &mut Study, rows: &[AgreementRow]) -> Result<(), Failure> {
    study.section("The solution is unique, and the energy never grows");
    let least = rows.iter().map(|row| row.least_growth).fold(f64::INFINITY, f64::min);
    study.state(Statement::identity(
        "least of (E − E*)/|x − x*|² over random feasible points",
        ["6.4", "it therefore has a unique solution (≥ 1)", "rounding"],
        (1.0 - 1e-9, f64::INFINITY),
        least,
    ));
    let excess = rows.iter().map(|row| row.energy_ratio - row.ebar.powi(2)).fold(f64::NEG_INFINITY, f64::max);
    study.state(Statement::identity(
        "largest of E/E₀ − ē²",
        ["6.2, item 4", "KE increases will never be predicted", "rounding"],
        (-1.0, 1e-15),
        excess,
    ));
    let lowest = rows.iter().map(|row| row.restitution).fold(f64::INFINITY, f64::min);
    study.state(Statement::identity("least restitution", ["6.2, item 3", "v_f ≥ 0", "as stated"], (0.0, 1.0), lowest));
    study.text(&format!(
        "A solution is the only minimum if the energy of every other feasible point exceeds its energy by at least the \
         squared distance in the norm of the energy. At a minimum over a convex set this must hold, and {TRIALS} \
         random feasible points per case, near and far, confirm it. The feasible point v_f = ē, a_k' = 0 shows that at \
         most the share ē² of the energy is left."
    ));
    let mut panel = Panel::new(Axis::new("moderated mass ratio Z").log().limits(1e-4, 1e6), Axis::new("E/E₀ over ē²"));
    panel.height_px = 200.0;
    for (branch, marker) in [("basic", Marker::Circle), ("outward", Marker::Cross)] {
        let of_branch = rows.iter().filter(|row| row.branch == branch && row.ebar > 1e-3 && row.kind == "random");
        let (z, energy): (Vec<f64>, Vec<f64>) =
            of_branch.step_by(3).map(|row| (row.z, row.energy_ratio / row.ebar.powi(2))).unzip();
        panel = panel.with(Series::points(&z, &energy, marker).label(branch));
    }
    study.figure(
        "energy",
        &Figure::new("Energy left, as a share of its bound").row([panel]),
        "The figure shows one in three of the random cases. Colours distinguish the active term of the maximum.",
    )
}

/// Plots the closed form.
fn shape(study: &mut Study) -> Result<(), Failure> {
    study.section("The closed form");
    let z: Vec<f64> = (0..=240).map(|i| 10f64.powf(-2.0 + f64::from(i) / 40.0)).collect();
    let mut left = Panel::new(Axis::new("Z").log(), Axis::new("e / ē").limits(-0.02, 1.02)).height(220.0);
    let mut right = Panel::new(Axis::new("Z").log(), Axis::new("energy in the modes / (ē² E₀)")).height(220.0);
    for (beta0, beta1, colour) in
        [(0.0, 0.0, Colour::Black), (0.1, 0.1, Colour::Blue), (0.4, 0.1, Colour::Vermilion), (0.4, 0.4, Colour::Green)]
    {
        let coefficients = Coefficients { ebar: 1.0, beta0, beta1 };
        let rebounds = z.iter().map(|&z| coefficients.rebound(z)).collect::<Result<Vec<Rebound>, _>>()?;
        let e: Vec<f64> = rebounds.iter().map(|r| r.restitution).collect();
        let modal: Vec<f64> = rebounds.iter().zip(&z).map(|(r, z)| r.modal_energy_fraction(*z)).collect();
        left = left.with(Series::line(&z, &e).colour(colour).label(format!("β₀ = {beta0}, β₁ = {beta1}")));
        right = right.with(Series::line(&z, &modal).colour(colour));
    }
    study.main_figure(
        "closed-form",
        &Figure::new("e = ē max(1/(1+Z), (β₀+β₁)/(1+β₀))").row([left, right]).width(900.0),
        "The outward inequality is a lower limit to the restitution. Without it the modes would take up all the energy \
         of a heavy striker.",
    )
}
