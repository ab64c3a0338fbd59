//! Time stepping on a graded mesh with exponentially decaying memory.
//!
//! The states of the kernel `t^m sum_l w_l exp(-r_l t)` are `Q_li = int_0^t (t-s)^i exp(-r_l (t-s)) f(s) ds`, `i = 0 ... m`. A
//! step of length `h` updates them exactly for a density that is linear on the step: `Q_i <- exp(-r h) sum_k binomial(i, k)
//! h^(i-k) Q_k + h^(i+1) (f_b M_i - (f_b - f_a) M_(i+1))`, with the moments `M_i = int_0^1 u^i exp(-r h u) du`.

use super::sum::{ExponentialSum, moments};
use crate::dense::Dense;
use crate::implicit::{self, Block, Stage};
use crate::recorder::Recorder;
use crate::solution::{Counts, Solution, Stop};
use crate::system::{Segment, System};
use invalid_input::InvalidInput;

/// Kernel `t^(order-1) = t^whole sum(t)`.
pub(crate) struct Kernel {
    pub order: f64,
    pub whole: usize,
    pub sum: ExponentialSum,
    /// Whether the power itself is used on the current step (the sum is accurate beyond it only).
    pub local_exact: bool,
}

/// Steps of each segment.
pub(crate) struct Mesh {
    segments: Vec<(Segment, usize)>,
    grading: f64,
}

impl Mesh {
    pub fn new(segments: &[Segment], steps: usize, grading: f64) -> Result<Mesh, InvalidInput> {
        InvalidInput::unless((1.0..=8.0).contains(&grading), "grading", grading, "a number from 1 to 8")?;
        let total: f64 = segments.iter().map(Segment::length).sum();
        let least = if segments.len() == 1 { 1 } else { 8 };
        let share = |s: &Segment| ((steps as f64 * (s.length() / total)).round() as usize).max(least);
        let segments: Vec<_> = segments.iter().map(|s| (*s, share(s))).collect();
        Ok(Mesh { segments, grading })
    }

    pub fn shortest_step(&self) -> f64 {
        // The first steps are the shortest, and rounding of t limits them.
        let first = |(s, n): &(Segment, usize)| s.length() * (*n as f64).powf(-self.grading);
        self.segments.iter().map(first).fold(f64::INFINITY, f64::min) * (1.0 - 1e-6)
    }

    /// End of step `n` of `steps`, as distance from the start of the segment.
    fn reached(&self, segment: &Segment, n: usize, steps: usize) -> f64 {
        if n == steps { segment.length() } else { segment.length() * (n as f64 / steps as f64).powf(self.grading) }
    }
}

/// States of one kernel.
struct Memory<'k> {
    kernel: &'k Kernel,
    /// `terms x (whole + 1) x densities`.
    q: Vec<f64>,
    /// For the current step: `exp(-r h)` for each term, and `whole + 2` moments for each term.
    decay: Vec<f64>,
    moments: Vec<f64>,
    h: f64,
}

impl<'k> Memory<'k> {
    fn new(kernel: &'k Kernel, densities: usize) -> Self {
        let (terms, powers) = (kernel.sum.rates.len(), kernel.whole + 1);
        Memory {
            kernel,
            q: vec![0.0; terms * powers * densities],
            decay: vec![0.0; terms],
            moments: vec![0.0; terms * (powers + 1)],
            h: 0.0,
        }
    }

    fn prepare(&mut self, h: f64) {
        self.h = h;
        let count = self.kernel.whole + 2;
        for ((decay, moment), r) in
            self.decay.iter_mut().zip(self.moments.chunks_exact_mut(count)).zip(&self.kernel.sum.rates)
        {
            *decay = moments(r * h, moment);
        }
    }

    /// `(t+h-s)^i` from the states at `t`, without the decay.
    fn carried(&self, term: usize, i: usize, k: usize, densities: usize) -> f64 {
        let base = term * (self.kernel.whole + 1) * densities;
        let (mut sum, mut factor) = (0.0, 1.0);
        for j in (0..=i).rev() {
            // binomial(i, j) h^(i-j)
            sum += factor * self.q[base + j * densities + k];
            factor *= self.h * j as f64 / (i - j + 1) as f64;
        }
        sum
    }

    /// The integral of the kernel and the past before this step, for density `k`.
    fn past(&self, k: usize, densities: usize) -> f64 {
        let terms = self.kernel.sum.weights.iter().zip(&self.decay).enumerate();
        terms.map(|(l, (w, decay))| w * decay * self.carried(l, self.kernel.whole, k, densities)).sum()
    }

    /// Weights of the density at the start and the end of this step in the kernel's integral over it.
    fn local(&self) -> (f64, f64) {
        let Kernel { order, whole, sum, local_exact } = self.kernel;
        if *local_exact {
            let power = self.h.powf(*order);
            return (power / (order + 1.0), power * (1.0 / order - 1.0 / (order + 1.0)));
        }
        let (mut whole_step, mut first) = (0.0, 0.0);
        for (moment, w) in self.moments.chunks_exact(whole + 2).zip(&sum.weights) {
            whole_step += w * moment[*whole];
            first += w * moment[whole + 1];
        }
        let power = self.h.powi(*whole as i32 + 1);
        (power * first, power * (whole_step - first))
    }

    fn advance(&mut self, before: &[f64], after: &[f64]) {
        let (m, powers) = (before.len(), self.kernel.whole + 1);
        for l in 0..self.decay.len() {
            for i in (0..powers).rev() {
                let moment = &self.moments[l * (powers + 1)..];
                let power = self.h.powi(i as i32 + 1);
                let (zeroth, first) = (power * moment[i], power * moment[i + 1]);
                for k in 0..m {
                    let carried = self.decay[l] * self.carried(l, i, k, m);
                    self.q[(l * powers + i) * m + k] = carried + after[k] * zeroth - (after[k] - before[k]) * first;
                }
            }
        }
    }
}

pub(crate) fn run(system: &mut System<'_, '_>, mesh: &Mesh, kernels: &[Kernel]) -> Solution {
    let mut recorder = Recorder::new(system.problem, Dense::grid(system.unknowns, 3));
    let mut memories: Vec<Memory<'_>> = kernels.iter().map(|k| Memory::new(k, system.densities)).collect();
    let mut counts = Counts::default();
    let mut stop = Stop::EndReached;
    for &(segment, steps) in &mesh.segments {
        if let Err(reason) = march(system, mesh, segment, steps, &mut memories, &mut recorder, &mut counts) {
            stop = reason;
            break;
        }
    }
    counts.history_values = memories.iter().map(|m| m.q.len() as u64).sum();
    recorder.finish(stop, system, counts)
}

fn march(
    system: &mut System<'_, '_>,
    mesh: &Mesh,
    segment: Segment,
    steps: usize,
    memories: &mut [Memory<'_>],
    recorder: &mut Recorder<'_, '_>,
    counts: &mut Counts,
) -> Result<(), Stop> {
    let (d, m) = (system.unknowns, system.densities);
    // At its start no time has passed since the last segment, and sums of exponentials are not accurate for so short a time.
    let (mut y, mut f) = (recorder.start_value(system, &segment)?, vec![0.0; m]);
    system.density(segment.inside(segment.start), &y, &mut f)?;
    recorder.dense.begin_segment();
    recorder.dense.push(segment.start, &y);
    recorder.scan([segment.start])?;
    let mut reached = 0.0;
    let mut weights: Vec<Vec<f64>> = vec![vec![0.0]; system.pairs.len()];
    for n in 1..=steps {
        let end = mesh.reached(&segment, n, steps);
        let time = if n == steps { segment.end } else { segment.start + end };
        // A step that is below the rounding of t is merged with the next one.
        if n < steps && time - (segment.start + reached) <= 16.0 * f64::EPSILON * time {
            continue;
        }
        let t = segment.inside(time);
        memories.iter_mut().for_each(|memory| memory.prepare(end - reached));
        let local: Vec<(f64, f64)> = memories.iter().map(Memory::local).collect();
        let mut rhs = vec![0.0; d];
        system.forcing(t, &mut rhs)?;
        for (pair, weight) in system.pairs.iter().zip(&mut weights) {
            rhs[pair.unknown] += pair.combine(|o| memories[o].past(pair.density, m) + local[o].0 * f[pair.density]);
            weight[0] = pair.combine(|o| local[o].1);
        }
        let mut stage = Stage { y: y.clone(), f: vec![0.0; m] };
        implicit::solve(system, &Block { times: &[t], rhs: &rhs, weights: &weights }, &mut stage)?;
        memories.iter_mut().for_each(|memory| memory.advance(&f, &stage.f));
        (y, f, reached) = (stage.y, stage.f, end);
        recorder.dense.push(time, &y);
        counts.steps += 1;
        recorder.scan([time])?;
    }
    Ok(())
}
