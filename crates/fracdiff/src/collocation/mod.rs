//! Spectral collocation on mapped panels.
//!
//! On a segment that starts at `t0`, panels are intervals of `x = (t - t0)^(1/q)`. With `q` such that `q` times
//! every order is an integer, solution and density are analytic in `x` up to the start. On each panel both are
//! polynomials through Gauss-Legendre nodes; the equations at the nodes are solved by Newton's method. The panel is
//! accepted when the last two Legendre coefficients are negligible. Otherwise it is halved, and divided by four at each further
//! rejection in a row.

mod history;
mod panel;

use crate::dense::{Dense, PanelValues};
use crate::implicit::{self, Block, Stage};
use crate::problem::Volterra;
use crate::quadrature::{Interpolation, Rule};
use crate::recorder::Recorder;
use crate::solution::{Counts, Solution, Stop};
use crate::system::{Fault, Segment, System};
use history::History;
use invalid_input::InvalidInput;
use panel::{LocalRules, Panel};

/// Largest dense Newton system of a panel.
const MOST_EQUATIONS: usize = 8000;

/// Multiple of the rounding of the forcing below which the unresolved part of a panel cannot be distinguished from it.
const ROUNDINGS: f64 = 50.0;

/// Settings of the collocation method.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
pub struct Collocation {
    /// Error allowed for a panel, relative to the largest magnitude that each component of the solution has had so far, but not
    /// below some roundings of the forcing, which the memory may cancel. From 1e-14 to 0.1; default 1e-12.
    pub tolerance: f64,
    /// Nodes per panel, 4 to 64; default 16.
    pub nodes: usize,
    /// Exponent `q` of the mapping `t - t0 = x^q`, 1 to 12; by default the smallest that makes every order
    /// of the problem times `q` an integer, and 4 if there is none up to 10.
    pub mapping: Option<u32>,
    /// Length of the first panel tried after each break; by default a thousandth of the segment.
    pub first_panel: Option<f64>,
    /// Longest panel; by default as long as accuracy allows.
    pub longest_panel: Option<f64>,
    /// Largest number of panels; default 2000.
    pub most_panels: usize,
}

impl Default for Collocation {
    fn default() -> Self {
        Collocation {
            tolerance: 1e-12,
            nodes: 16,
            mapping: None,
            first_panel: None,
            longest_panel: None,
            most_panels: 2000,
        }
    }
}

impl Collocation {
    fn check(&self) -> Result<(), InvalidInput> {
        let tolerance_ok = self.tolerance >= 1e-14 && self.tolerance <= 0.1;
        InvalidInput::unless(tolerance_ok, "tolerance", self.tolerance, "a number from 1e-14 to 0.1")?;
        InvalidInput::unless((4..=64).contains(&self.nodes), "nodes", self.nodes, "a number from 4 to 64")?;
        if let Some(q) = self.mapping {
            InvalidInput::unless((1..=12).contains(&q), "mapping", q, "a number from 1 to 12")?;
        }
        for (field, length) in [("first_panel", self.first_panel), ("longest_panel", self.longest_panel)] {
            if let Some(length) = length {
                InvalidInput::require_positive(field, length)?;
            }
        }
        let panels_ok = (1..=1_000_000).contains(&self.most_panels);
        InvalidInput::unless(panels_ok, "most_panels", self.most_panels, "a number from 1 to 1000000")?;
        Ok(())
    }

    /// The `q` of the settings, or the smallest that makes every order times `q` an integer.
    fn mapping_for(&self, orders: &[f64]) -> u32 {
        let is_integer = |v: f64| (v - v.round()).abs() < 1e-9;
        let smallest = || (1..=10).find(|&q| orders.iter().all(|&order| is_integer(order * f64::from(q))));
        self.mapping.or_else(smallest).unwrap_or(4)
    }

    pub(crate) fn run(&self, problem: &Volterra<'_>, t_end: f64) -> Result<Solution, InvalidInput> {
        self.check()?;
        let system = System::new(problem, t_end)?;
        let size = self.nodes * system.unknowns;
        InvalidInput::unless(
            size <= MOST_EQUATIONS,
            "unknowns * nodes",
            size,
            "at most 8000, the largest number of equations in a panel",
        )?;
        let rule = Rule::legendre(self.nodes);
        let interpolation = Interpolation::new(&rule);
        let dense = Dense::panels(system.unknowns, interpolation.clone());
        let mut march = March {
            settings: self,
            mapping: self.mapping_for(&system.orders),
            local: LocalRules::new(&system.orders, self.nodes),
            history: History::new(&system.orders, &rule, &interpolation, system.densities),
            largest: vec![0.0; system.unknowns],
            recorder: Recorder::new(problem, dense),
            interpolation,
            system,
            counts: Counts::default(),
        };
        let stop = march.run().err().unwrap_or(Stop::EndReached);
        let counts = Counts { history_values: march.history.len() as u64, ..march.counts };
        Ok(march.recorder.finish(stop, &march.system, counts))
    }
}

struct March<'s, 'p, 'a> {
    settings: &'s Collocation,
    system: System<'p, 'a>,
    mapping: u32,
    interpolation: Interpolation,
    local: LocalRules,
    history: History,
    /// Largest magnitude of each unknown so far.
    largest: Vec<f64>,
    recorder: Recorder<'p, 'a>,
    counts: Counts,
}

/// Why a panel was not accepted.
enum Rejection {
    Unresolved,
    Fault(Fault),
}

impl March<'_, '_, '_> {
    fn run(&mut self) -> Result<(), Stop> {
        for segment in self.system.segments.clone() {
            self.segment(segment)?;
        }
        Ok(())
    }

    fn segment(&mut self, segment: Segment) -> Result<(), Stop> {
        let longest = self.settings.longest_panel.unwrap_or(f64::INFINITY);
        let mut length = self.settings.first_panel.unwrap_or(1e-3 * segment.length()).min(longest);
        // Distance of the current panel's start from the start of the segment.
        let mut reached = 0.0;
        let start = self.recorder.start_value(&mut self.system, &segment)?;
        let mut guess = start.clone();
        // The last fault met. If it lies ahead, it is more informative than the reason why the shortest panel failed.
        let mut fault: Option<Fault> = None;
        let mut rejected_before = false;
        while reached < segment.length() {
            if self.counts.steps >= self.settings.most_panels as u64 {
                return Err(Stop::PanelLimit { t: segment.start + reached });
            }
            let left = segment.length() - reached;
            // The rest is halved if the last panel would otherwise be much shorter than its neighbour.
            let step = if length >= left { left } else { length.min(0.5 * left) };
            let end = if step == left { segment.length() } else { reached + step };
            let panel = Panel::new(segment, self.mapping, [reached, end], &self.interpolation.nodes);
            match self.try_panel(&panel, &guess, segment.length()) {
                Ok((stage, growth)) => {
                    guess.copy_from_slice(&stage.y[stage.y.len() - self.system.unknowns..]);
                    self.accept(&panel, stage, (reached == 0.0).then_some(&start))?;
                    reached = end;
                    rejected_before = false;
                    length = (step * growth).min(longest);
                }
                Err(rejection) => {
                    self.counts.rejected += 1;
                    if let Rejection::Fault(found) = rejection {
                        fault = Some(found);
                    }
                    length = if rejected_before { 0.25 } else { 0.5 } * step;
                    rejected_before = true;
                    // Next to the start of a segment a panel is too short only at underflow, elsewhere at the rounding of t.
                    let smallest = if reached == 0.0 { 1e-200 * segment.length() } else { 1e-13 * reached };
                    // both are 0 on a segment whose parts underflow
                    if length <= smallest {
                        let unresolved = Stop::Unresolved { t: segment.start + reached };
                        let ahead = fault.filter(|f| f.time() >= segment.start + reached);
                        return Err(ahead.map_or(unresolved, Stop::from));
                    }
                }
            }
        }
        Ok(())
    }

    /// Solves a panel; on success it returns the factor by which the next may be longer.
    fn try_panel(&mut self, panel: &Panel, guess: &[f64], length: f64) -> Result<(Stage, f64), Rejection> {
        let (d, m, n) = (self.system.unknowns, self.system.densities, panel.times.len());
        let mut rhs = vec![0.0; n * d];
        for (i, &t) in panel.times.iter().enumerate() {
            self.system.forcing(t, &mut rhs[i * d..(i + 1) * d]).map_err(Rejection::Fault)?;
        }
        let forcing = rhs.clone();
        self.history.add_to(&self.system.pairs, panel, d, &mut rhs);
        let by_order = self.local.weights(panel, &self.interpolation);
        let weights: Vec<Vec<f64>> =
            self.system.pairs.iter().map(|p| (0..n * n).map(|e| p.combine(|o| by_order[o][e])).collect()).collect();
        let mut stage = Stage { y: guess.repeat(n), f: vec![0.0; n * m] };
        let block = Block { times: &panel.times, rhs: &rhs, weights: &weights };
        implicit::solve(&mut self.system, &block, &mut stage).map_err(Rejection::Fault)?;

        let worst = self.unresolved(panel, &stage, &forcing, length);
        if worst > 1.0 || worst.is_nan() {
            return Err(Rejection::Unresolved);
        }
        // Noise near the bound does not decrease with the panel, so the next panel may always be somewhat longer.
        let growth = (0.5 / worst.max(1e-300)).powf(1.0 / n as f64);
        Ok((stage, growth.clamp(1.2, 3.0)))
    }

    /// The unresolved part of solution and density: its effect on the solution relative to what is allowed.
    fn unresolved(&mut self, panel: &Panel, stage: &Stage, forcing: &[f64], length: f64) -> f64 {
        let (d, m, n) = (self.system.unknowns, self.system.densities, panel.times.len());
        let y = |c: usize| (0..n).map(move |i| stage.y[i * d + c]);
        // The memory may cancel against the forcing, whose rounding is then the limit of resolution.
        let largest = |c: usize| (0..n).fold(0.0_f64, |a, i| a.max(forcing[i * d + c].abs()));
        let noise: Vec<f64> = (0..d).map(|c| ROUNDINGS * f64::EPSILON * largest(c)).collect();
        let allowed = |c: usize| {
            let here = y(c).fold(0.0, |a: f64, v| a.max(v.abs()));
            let expected = self.expected_variation(panel, length, range(y(c)));
            let scale = self.largest[c].max(here).max(expected).max(f64::MIN_POSITIVE);
            (scale * self.settings.tolerance).max(noise[c])
        };
        let allowed: Vec<f64> = (0..d).map(allowed).collect();
        let solution =
            (0..d).fold(0.0, |a: f64, c| a.max(self.interpolation.tail(|i| stage.y[i * d + c]) / allowed[c]));
        let tails: Vec<f64> = (0..m).map(|k| self.interpolation.tail(|i| stage.f[i * m + k])).collect();
        // The effect of each density on an unknown.
        let power = |o: usize| panel.length().powf(self.system.orders[o]) / self.system.orders[o];
        let effects: Vec<(usize, usize, f64)> =
            self.system.pairs.iter().map(|pair| (pair.unknown, pair.density, pair.combine(power).abs())).collect();
        let worst = |passed_on: &[f64]| {
            let parts = effects.iter().map(|&(c, k, effect)| effect * tails[k] / allowed[c].max(effect * passed_on[k]));
            parts.fold(solution, f64::max)
        };
        let found = worst(&vec![0.0; m]);
        // What the rounding of the unknowns explains is evaluated only where a panel would be rejected without it.
        if found <= 1.0 || solution > 1.0 { found } else { worst(&self.passed_on(panel, stage, &noise)) }
    }

    /// The largest change of each density at the nodes of a panel by the rounding of one unknown.
    fn passed_on(&mut self, panel: &Panel, stage: &Stage, noise: &[f64]) -> Vec<f64> {
        let (d, m) = (self.system.unknowns, self.system.densities);
        let (mut largest, mut f) = (vec![0.0_f64; m], vec![0.0; m]);
        for (i, &t) in panel.times.iter().enumerate() {
            for (c, noise) in noise.iter().enumerate() {
                let mut moved = stage.y[i * d..(i + 1) * d].to_vec();
                moved[c] += noise;
                // Beyond the domain of the density nothing is passed on.
                if self.system.density(t, &moved, &mut f).is_ok() {
                    let changes = f.iter().zip(&stage.f[i * m..]).map(|(f, before)| (f - before).abs());
                    largest.iter_mut().zip(changes).for_each(|(largest, change)| *largest = largest.max(change));
                }
            }
        }
        largest
    }

    /// The expected magnitude of a component on a segment of this length, from the first panel.
    ///
    /// A solution that starts from 0 like a power that the mapping does not make smooth looks the same on every first panel,
    /// however short. The part that such a panel misses is estimated from the value that the least power of the problem would
    /// reach.
    fn expected_variation(&self, panel: &Panel, length: f64, variation: f64) -> f64 {
        let ratio = length / panel.length();
        if panel.x[0] > 0.0 || ratio < 1e8 {
            return 0.0;
        }
        let least = self.system.orders.iter().copied().fold(1.0, f64::min);
        variation * ratio.powf(least)
    }

    fn accept(&mut self, panel: &Panel, stage: Stage, start: Option<&Vec<f64>>) -> Result<(), Stop> {
        let d = self.system.unknowns;
        for row in stage.y.chunks_exact(d) {
            for (largest, v) in self.largest.iter_mut().zip(row) {
                *largest = largest.max(v.abs());
            }
        }
        self.history.push(panel, &stage.f);
        let values = PanelValues { origin: panel.origin, mapping: panel.mapping, x: panel.x, y: stage.y };
        self.recorder.dense.push_panel(panel.t, start.map(Vec::as_slice), values);
        self.counts.steps += 1;
        let first = start.map(|_| panel.t[0]);
        let inner = panel.times.iter().copied();
        self.recorder.scan(first.into_iter().chain(inner).chain([panel.t[1]]))
    }
}

/// Difference between the largest and the smallest value.
fn range(values: impl Iterator<Item = f64>) -> f64 {
    let [low, high] = values.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], v| [a.min(v), b.max(v)]);
    high - low
}
