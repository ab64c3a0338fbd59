//! Time stepping through one segment, with a history summed by transforms.

use super::fft::{Spectrum, Transform};
use super::past::Past;
use super::scheme::Scheme;
use super::weights::{Weights, start_exponents};
use crate::implicit::{self, Block, Stage};
use crate::recorder::Recorder;
use crate::solution::Stop;
use crate::system::{Segment, System};
use rustfft::num_complex::Complex;
use std::collections::HashMap;

/// Blocks up to this length are summed directly.
const DIRECT: usize = 64;

pub(crate) struct March<'m, 'p, 'a> {
    system: &'m mut System<'p, 'a>,
    recorder: &'m mut Recorder<'p, 'a>,
    past: &'m Past,
    segment: Segment,
    steps: usize,
    /// Weights for each pair of the system, scaled by the step.
    weights: Vec<Weights>,
    /// Number of values that have corrections (0 without corrections).
    corrected: usize,
    /// Density at the points so far, `points x densities`.
    f: Vec<f64>,
    /// Effect of finished blocks on each point, `points x unknowns`.
    known: Vec<f64>,
    /// Last solution value, the guess for the next.
    guess: Vec<f64>,
    /// For each length of a block: its transform, and the spectrum of each pair's weights.
    spectra: HashMap<usize, (Transform, Vec<Spectrum>)>,
}

impl<'m, 'p, 'a> March<'m, 'p, 'a> {
    pub fn new(
        system: &'m mut System<'p, 'a>,
        recorder: &'m mut Recorder<'p, 'a>,
        past: &'m Past,
        scheme: Scheme,
        segment: Segment,
        steps: usize,
    ) -> Self {
        let exponents = start_exponents(&system.orders);
        // Too few steps leave no room for the starting block.
        let exponents = if steps + 1 >= exponents.len() { exponents } else { Vec::new() };
        let h = segment.length() / steps as f64;
        let by_order: Vec<Weights> = system
            .orders
            .iter()
            .map(|&order| scaled(scheme.weights(order, steps, &exponents), h.powf(order)))
            .collect();
        let combined = |pair: &crate::system::Pair| {
            let sum = |part: fn(&Weights) -> &Vec<f64>| -> Vec<f64> {
                let length = pair.kernel.iter().map(|&(o, _)| part(&by_order[o]).len()).max().unwrap_or(0);
                (0..length).map(|i| pair.combine(|o| part(&by_order[o])[i])).collect()
            };
            Weights { start: sum(|w| &w.start), lag: sum(|w| &w.lag), corrections: sum(|w| &w.corrections) }
        };
        let weights: Vec<Weights> = system.pairs.iter().map(combined).collect();
        let corrected = if weights.iter().any(|w| !w.corrections.is_empty()) { exponents.len() } else { 0 };
        let (d, m) = (system.unknowns, system.densities);
        March {
            f: Vec::with_capacity((steps + 1) * m),
            known: vec![0.0; (steps + 1) * d],
            guess: vec![0.0; d],
            spectra: HashMap::new(),
            system,
            recorder,
            past,
            segment,
            steps,
            weights,
            corrected,
        }
    }

    /// Runs to the end of the segment; returns what stopped it and the density at the points reached.
    pub fn run(mut self) -> (Result<(), Stop>, Vec<f64>) {
        let outcome = self.start().and_then(|()| self.advance(0, self.steps + 1));
        (outcome, self.f)
    }

    fn time(&self, n: usize) -> f64 {
        if n == self.steps {
            self.segment.end
        } else {
            self.segment.start + self.segment.length() * (n as f64 / self.steps as f64)
        }
    }

    /// Forcing and earlier segments at point `n`.
    fn outside(&mut self, n: usize, out: &mut [f64]) -> Result<f64, Stop> {
        let t = self.segment.inside(self.time(n));
        self.system.forcing(t, out)?;
        self.past.add_to(&self.system.pairs, t, out);
        Ok(t)
    }

    /// Point 0 is known; the points that corrections act on are solved together.
    fn start(&mut self) -> Result<(), Stop> {
        let (d, m) = (self.system.unknowns, self.system.densities);
        let y = self.recorder.start_value(self.system, &self.segment)?;
        let t = self.segment.inside(self.segment.start);
        let mut f0 = vec![0.0; m];
        self.system.density(t, &y, &mut f0)?;
        self.f.extend_from_slice(&f0);
        self.guess.copy_from_slice(&y);
        self.recorder.dense.begin_segment();
        self.recorder.dense.push(self.segment.start, &y);
        self.recorder.scan([self.segment.start])?;
        if self.corrected < 2 {
            return Ok(());
        }
        let points = self.corrected - 1;
        let mut times = vec![0.0; points];
        let mut rhs = vec![0.0; points * d];
        for i in 0..points {
            times[i] = self.outside(i + 1, &mut rhs[i * d..(i + 1) * d])?;
            for (pair, w) in self.system.pairs.iter().zip(&self.weights) {
                rhs[i * d + pair.unknown] +=
                    (w.start[i + 1] + correction(w, i + 1, 0, self.corrected)) * f0[pair.density];
            }
        }
        let weights: Vec<Vec<f64>> = self
            .weights
            .iter()
            .map(|w| {
                let entry = |i: usize, j: usize| {
                    let direct = if j <= i { w.lag[i - j] } else { 0.0 };
                    direct + correction(w, i + 1, j + 1, self.corrected)
                };
                (0..points * points).map(|e| entry(e / points, e % points)).collect()
            })
            .collect();
        let mut stage = Stage { y: self.guess.repeat(points), f: vec![0.0; points * m] };
        implicit::solve(self.system, &Block { times: &times, rhs: &rhs, weights: &weights }, &mut stage)?;
        for i in 0..points {
            self.take(i + 1, &stage.y[i * d..(i + 1) * d], &stage.f[i * m..(i + 1) * m])?;
        }
        Ok(())
    }

    fn take(&mut self, n: usize, y: &[f64], f: &[f64]) -> Result<(), Stop> {
        self.f.extend_from_slice(f);
        self.guess.copy_from_slice(y);
        let t = self.time(n);
        self.recorder.dense.push(t, y);
        self.recorder.scan([t])
    }

    /// Solves points `low..high`, if `known` contains the effect of all points before `low`.
    fn advance(&mut self, low: usize, high: usize) -> Result<(), Stop> {
        if high - low > DIRECT {
            // Blocks are halves of a power of two, so that few lengths of transforms occur.
            let half = (high - low).next_power_of_two() / 2;
            self.advance(low, low + half)?;
            self.contribute(low, half, high);
            return self.advance(low + half, high);
        }
        let (d, m) = (self.system.unknowns, self.system.densities);
        let mut rhs = vec![0.0; d];
        let done = self.f.len() / m;
        for n in low.max(done)..high {
            let t = self.outside(n, &mut rhs)?;
            for (sum, known) in rhs.iter_mut().zip(&self.known[n * d..]) {
                *sum += known;
            }
            let mut implicit_weights = Vec::with_capacity(self.weights.len());
            for (pair, w) in self.system.pairs.iter().zip(&self.weights) {
                let value = |j: usize| self.f[j * m + pair.density];
                let mut sum = w.start[n] * value(0);
                for j in low.max(1)..n {
                    sum += w.lag[n - j] * value(j);
                }
                for l in 0..self.corrected {
                    sum += correction(w, n, l, self.corrected) * value(l);
                }
                rhs[pair.unknown] += sum;
                implicit_weights.push(vec![w.lag[0]]);
            }
            let mut stage = Stage { y: self.guess.clone(), f: vec![0.0; m] };
            let block = Block { times: &[t], rhs: &rhs, weights: &implicit_weights };
            implicit::solve(self.system, &block, &mut stage)?;
            self.take(n, &stage.y, &stage.f)?;
        }
        Ok(())
    }

    /// Adds the effect of points `low..low+half` to `known` at `low+half..high`.
    fn contribute(&mut self, low: usize, half: usize, high: usize) {
        let (d, m) = (self.system.unknowns, self.system.densities);
        let length = 2 * half;
        let weights = &self.weights;
        let (transform, spectra) = self.spectra.entry(length).or_insert_with(|| {
            let transform = Transform::new(length);
            let spectra = weights.iter().map(|w| transform.spectrum(&w.lag[..w.lag.len().min(length)])).collect();
            (transform, spectra)
        });
        let densities: Vec<Spectrum> = (0..m)
            .map(|k| {
                // The weight of point 0 is not a function of the distance and is in `start`.
                let block: Vec<f64> = (low..low + half).map(|j| if j == 0 { 0.0 } else { self.f[j * m + k] }).collect();
                transform.spectrum(&block)
            })
            .collect();
        for c in 0..d {
            let mut total = vec![Complex::new(0.0, 0.0); length];
            let mut any = false;
            for (pair, spectrum) in self.system.pairs.iter().zip(spectra.iter()).filter(|(p, _)| p.unknown == c) {
                any = true;
                for ((sum, w), f) in total.iter_mut().zip(spectrum).zip(&densities[pair.density]) {
                    *sum += w * f;
                }
            }
            if any {
                // Cyclic wrap-around affects only the first half, which is not used.
                let values = transform.values(total);
                for n in low + half..high {
                    self.known[n * d + c] += values[n - low];
                }
            }
        }
    }
}

fn correction(w: &Weights, n: usize, l: usize, points: usize) -> f64 {
    w.corrections.get(n * points + l).copied().unwrap_or(0.0)
}

fn scaled(mut weights: Weights, factor: f64) -> Weights {
    let Weights { start, lag, corrections } = &mut weights;
    start.iter_mut().chain(lag).chain(corrections).for_each(|w| *w *= factor);
    weights
}
