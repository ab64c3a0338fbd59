//! An independent solution of impacts in 32 digits: Taylor series of all unknowns, step by step.
//!
//! ```text
//! a_k'' + 2 zeta_k omega_k a_k' + omega_k^2 a_k = -psi_k F,      xi = sum psi_k a_k - gap,      F = F(xi, xi')
//! ```
//!
//! with the striker as an additional mode without frequency. The coefficients of a step follow from each other, order by order;
//! powers of the compression by the recurrence `n u_0 p_n = sum (alpha j - (n - j)) u_j p_(n-j)` of `p = u^alpha`. If a
//! function of compression and rate changes its sign, the step ends there and the next formula of the law applies. Only the
//! equations are common to this code and the solver.

use super::double::Double;
use contact_models::Law;
use pulp::Arch;

/// Degree of the series.
const DEGREE: usize = 40;
/// Relative truncation error of a step.
const PART: f64 = 1e-27;
/// Partial sums over the modes.
const LANES: usize = 8;
/// Number of points of a step at which the event functions are evaluated.
const PLACES: usize = 16;

/// An impact in numbers of 32 digits. The striker is mode 0.
#[derive(Clone)]
pub struct Impact {
    pub omega: Vec<Double>,
    pub damping_ratio: Vec<Double>,
    pub psi: Vec<Double>,
    /// Amplitudes and rates at the start.
    pub amplitude: Vec<Double>,
    pub rate: Vec<Double>,
    pub gap: Double,
    pub law: Law,
    /// Factor of the force of the law.
    pub times: Double,
}

/// The result.
pub struct Followed {
    /// Start, end and impulse of each interval of contact.
    pub intervals: Vec<[Double; 3]>,
    /// The striker's velocity after the last of them, away from the structure.
    pub velocity: Double,
}

/// The state of the law.
#[derive(Debug, Clone, Copy)]
enum Phase {
    Open,
    Pushing,
    Slack,
    /// For the hysteretic law: compression at the start of the branch, and its variable there.
    Loading([Double; 2]),
    Unloading([Double; 2]),
    /// For the elastic-plastic law: indentation and largest compression so far.
    Elastic([Double; 2]),
    Plastic,
}

/// A force `constant + per_xi xi + per_rate xi' + u^(3/2) (power + per_rate_power xi' + excess (xi + eps)^exponent)` with
/// `u = xi - anchor`.
#[derive(Default)]
struct Formula {
    constant: Double,
    per_xi: Double,
    per_rate: Double,
    power: Double,
    power_rate: Double,
    anchor: Double,
    excess: Double,
    eps: Double,
    exponent: f64,
}

impl Formula {
    fn has_power(&self) -> bool {
        [self.power, self.power_rate, self.excess].iter().any(|factor| factor.near != 0.0)
    }
}

fn number(value: f64) -> Double {
    Double::from(value)
}

/// `pi` in 32 digits.
const PI: Double = Double { near: std::f64::consts::PI, rest: 1.224_646_799_147_353_2e-16 };

/// First yield of the elastic-plastic law: compression, force, slope beyond.
fn yielding(law: &contact_models::Thornton) -> [Double; 3] {
    let [modulus, radius, pressure] =
        [law.effective_modulus_pa, law.effective_radius_m, law.yield_pressure_pa].map(number);
    let root = PI * pressure / (number(2.0) * modulus);
    let xi = root * root * radius;
    [xi, number(4.0) / number(3.0) * modulus * (radius * xi).sqrt() * xi, PI * pressure * radius]
}

/// The force of the elastic-plastic law on the loading line.
fn plastic_force(law: &contact_models::Thornton, xi: Double) -> Double {
    let [first, force, slope] = yielding(law);
    force + slope * (xi - first)
}

impl Impact {
    /// The formulas that apply in a phase.
    fn formula(&self, phase: Phase) -> Formula {
        let none = Formula::default();
        let mut formula = match (phase, self.law) {
            (Phase::Pushing, Law::Hertz(law)) => Formula { power: number(law.stiffness_n_m1_5), ..none },
            (Phase::Pushing, Law::LinearSpring(law)) => Formula { per_xi: number(law.stiffness_n_m), ..none },
            (Phase::Pushing, Law::KelvinVoigt(law)) => {
                Formula { per_xi: number(law.stiffness_n_m), per_rate: number(law.damping_n_s_m), ..none }
            }
            (Phase::Pushing, Law::Viscous(law)) => {
                let power = number(law.stiffness_n_m1_5);
                Formula { power, power_rate: power * number(law.damping_s_m), ..none }
            }
            (Phase::Pushing, Law::HuntCrossley(law)) if law.exponent == 1.5 => {
                let power = number(law.stiffness_n_m_n);
                Formula { power, power_rate: power * number(law.damping_s_m), ..none }
            }
            (Phase::Loading([anchor, theta]) | Phase::Unloading([anchor, theta]), Law::Hysteretic(law)) => {
                assert_eq!(law.k_bar, 0.4);
                let loads = matches!(phase, Phase::Loading(_));
                let goal = number(law.theta_m) + number(if loads { law.beta } else { -law.beta });
                let stiffness = number(law.stiffness_n_m1_5);
                let start = (anchor + number(law.epsilon_m)).two_fifths();
                let excess = stiffness * (theta - goal) * if loads { start } else { number(1.0) / start };
                Formula {
                    power: stiffness * (number(1.0) + goal),
                    excess,
                    eps: number(law.epsilon_m),
                    exponent: if loads { -0.4 } else { 0.4 },
                    ..none
                }
            }
            (Phase::Elastic([anchor, largest]), Law::Thornton(law)) => {
                let span = largest - anchor;
                Formula { power: plastic_force(&law, largest) / (span * span.sqrt()), anchor, ..none }
            }
            (Phase::Plastic, Law::Thornton(law)) => {
                let [xi, force, slope] = yielding(&law);
                Formula { constant: force - slope * xi, per_xi: slope, ..none }
            }
            (Phase::Open | Phase::Slack, _) => none,
            other => panic!("no formula for {other:?}"),
        };
        for factor in [
            &mut formula.constant,
            &mut formula.per_xi,
            &mut formula.per_rate,
            &mut formula.power,
            &mut formula.power_rate,
            &mut formula.excess,
        ] {
            *factor = *factor * self.times;
        }
        formula
    }

    /// Functions of compression and rate that are positive in a phase, which ends where one of them decreases to zero.
    fn margins(&self, phase: Phase, touch: Double, xi: Double, rate: Double) -> [Double; 2] {
        let never = number(1.0);
        // Positive where a damped law has a force.
        let pushes = match self.law {
            Law::KelvinVoigt(law) => Some(number(law.stiffness_n_m) * xi + number(law.damping_n_s_m) * rate),
            Law::Viscous(law) => Some(number(1.0) + number(law.damping_s_m) * rate),
            Law::HuntCrossley(law) => Some(number(1.0) + number(law.damping_s_m) * rate),
            _ => None,
        };
        match phase {
            Phase::Open => [touch - xi, never],
            // The force of a spring with a dashpot ends before the compression does.
            Phase::Pushing if matches!(self.law, Law::KelvinVoigt(_)) => [never, pushes.unwrap_or(never)],
            Phase::Pushing => [xi, pushes.unwrap_or(never)],
            Phase::Slack => [xi, pushes.map_or(never, |pushes| -pushes)],
            Phase::Loading(_) | Phase::Plastic => [rate, never],
            Phase::Unloading(_) => [xi, -rate],
            Phase::Elastic([indentation, largest]) => [xi - indentation, largest - xi],
        }
    }

    /// The phase after an event function has decreased to zero, and at the start of the next contact.
    fn next(&self, phase: Phase, which: usize, touch: Double, xi: Double, memory: &mut [Double; 2]) -> (Phase, Double) {
        let goes_on = |phase| (phase, touch);
        match (phase, which, self.law) {
            (Phase::Open, _, Law::Hysteretic(law)) => {
                goes_on(Phase::Loading([number(0.0), number(law.theta_m) + number(law.beta)]))
            }
            (Phase::Open, _, Law::Thornton(_)) => goes_on(Phase::Elastic(*memory)),
            (Phase::Open, ..) => goes_on(Phase::Pushing),
            (Phase::Pushing, 1, _) => goes_on(Phase::Slack),
            (Phase::Slack, 1, _) => goes_on(Phase::Pushing),
            (Phase::Loading([anchor, theta]), _, Law::Hysteretic(law)) => {
                let ratio = ((anchor + number(law.epsilon_m)) / (xi + number(law.epsilon_m))).two_fifths();
                let goal = number(law.theta_m) + number(law.beta);
                goes_on(Phase::Unloading([xi, goal + (theta - goal) * ratio]))
            }
            (Phase::Unloading([anchor, theta]), 1, Law::Hysteretic(law)) => {
                let ratio = ((xi + number(law.epsilon_m)) / (anchor + number(law.epsilon_m))).two_fifths();
                let goal = number(law.theta_m) - number(law.beta);
                goes_on(Phase::Loading([xi, goal + (theta - goal) * ratio]))
            }
            (Phase::Plastic, _, Law::Thornton(law)) => {
                let [modulus, pressure] = [law.effective_modulus_pa, law.yield_pressure_pa].map(number);
                let force = plastic_force(&law, xi);
                let square = (number(2.0) * force + yielding(&law)[1]) / (number(2.0) * PI * pressure);
                let recovered = number(0.75) * force / (modulus * square.sqrt());
                *memory = [xi - recovered, xi];
                goes_on(Phase::Elastic(*memory))
            }
            (Phase::Elastic(_), 1, _) => goes_on(Phase::Plastic),
            (Phase::Elastic([indentation, _]), ..) => (Phase::Open, indentation),
            _ => (Phase::Open, number(0.0)),
        }
    }

    /// Computes the motion through this number of intervals of contact; `None` if they do not occur before the time
    /// `longest_s`.
    pub fn follow(&self, count: usize, longest_s: f64) -> Option<Followed> {
        let mut series = Series::new(self);
        let mut memory = match &self.law {
            Law::Thornton(law) => [number(0.0), yielding(law)[0]],
            _ => [number(0.0); 2],
        };
        let (mut phase, mut touch, mut time) = (Phase::Open, number(0.0), number(0.0));
        let mut intervals = Vec::new();
        let (mut started, mut before) = (time, self.rate[0]);
        // The striker's velocity from its rate in the mode.
        let velocity = |rate: Double| -(rate * self.psi[0]);
        let mass = number(1.0) / (self.psi[0] * self.psi[0]);
        while time.near < longest_s {
            let formula = self.formula(phase);
            let (xi, rate) = series.contact(self);
            let open = matches!(phase, Phase::Open);
            let entering = open && (xi - touch).near >= 0.0 && rate.near > 0.0;
            if open && series.glide(self, (touch - xi).near, &mut time) {
                continue;
            }
            let met = if entering { Some(0) } else { series.step(self, &formula, phase, touch, &mut time) };
            let Some(which) = met else { continue };
            let (xi, _) = series.contact(self);
            let was_open = matches!(phase, Phase::Open);
            (phase, touch) = self.next(phase, which, touch, xi, &mut memory);
            if was_open {
                (started, before) = (time, series.rate[0].at(0));
            } else if matches!(phase, Phase::Open) {
                let gained = velocity(series.rate[0].at(0)) - velocity(before);
                intervals.push([started, time, mass * gained]);
                if intervals.len() == count {
                    return Some(Followed { intervals, velocity: velocity(series.rate[0].at(0)) });
                }
            }
        }
        None
    }
}

/// Numbers side by side, for vector units.
#[derive(Clone)]
struct Row {
    near: Vec<f64>,
    rest: Vec<f64>,
}

impl Row {
    fn new(count: usize, of: impl Fn(usize) -> Double) -> Row {
        let near = (0..count).map(|k| of(k).near).collect();
        Row { near, rest: (0..count).map(|k| of(k).rest).collect() }
    }

    #[inline(always)]
    fn at(&self, k: usize) -> Double {
        Double { near: self.near[k], rest: self.rest[k] }
    }

    #[inline(always)]
    fn set(&mut self, k: usize, value: Double) {
        (self.near[k], self.rest[k]) = (value.near, value.rest);
    }
}

/// The series of a step: coefficients of order `i` of all amplitudes and all rates.
#[derive(Clone)]
struct Series {
    amplitude: Vec<Row>,
    rate: Vec<Row>,
    /// `-2 zeta omega`, `-omega^2`, `-psi`.
    factors: [Row; 3],
    psi: Row,
    fastest: f64,
    /// Free motion over the longest step, once it is needed: amplitude and rate at its end, after a unit amplitude and after a
    /// unit rate.
    free: Option<[[Row; 2]; 2]>,
    arch: Arch,
}

impl Series {
    fn new(impact: &Impact) -> Series {
        let n = impact.omega.len();
        let row = |of: &dyn Fn(usize) -> Double| Row::new(n, of);
        Series {
            amplitude: vec![row(&|k| impact.amplitude[k]); DEGREE + 1],
            rate: vec![row(&|k| impact.rate[k]); DEGREE + 1],
            factors: [
                row(&|k| -(number(2.0) * impact.damping_ratio[k] * impact.omega[k])),
                row(&|k| -(impact.omega[k] * impact.omega[k])),
                row(&|k| -impact.psi[k]),
            ],
            psi: row(&|k| impact.psi[k]),
            fastest: impact.omega.iter().map(|omega| omega.near).fold(0.0, f64::max),
            free: None,
            arch: Arch::new(),
        }
    }

    /// Compression and its rate.
    fn contact(&self, impact: &Impact) -> (Double, Double) {
        (self.seen(&self.amplitude[0]) - impact.gap, self.seen(&self.rate[0]))
    }

    /// The sum over the modes of their weights times these coefficients.
    fn seen(&self, row: &Row) -> Double {
        let psi = &self.psi;
        self.arch.dispatch(
            #[inline(always)]
            || {
                let (mut near, mut rest) = ([0.0; LANES], [0.0; LANES]);
                let n = row.near.len();
                for first in (0..n - n % LANES).step_by(LANES) {
                    for l in 0..LANES {
                        let sum = Double { near: near[l], rest: rest[l] } + psi.at(first + l) * row.at(first + l);
                        (near[l], rest[l]) = (sum.near, sum.rest);
                    }
                }
                let last = (n - n % LANES..n).map(|k| psi.at(k) * row.at(k));
                (0..LANES).map(|l| Double { near: near[l], rest: rest[l] }).chain(last).sum()
            },
        )
    }

    /// The coefficients of order `i + 1` from those of order `i` and the force's, in this unit of time.
    fn raise(&mut self, i: usize, unit_s: f64, force: Double) {
        let order = number(unit_s) / number((i + 1) as f64);
        let [fade, pull, push] = &self.factors;
        let (amplitude, next_amplitude) = self.amplitude.split_at_mut(i + 1);
        let (rate, next_rate) = self.rate.split_at_mut(i + 1);
        let (a, b, to_a, to_b) = (&amplitude[i], &rate[i], &mut next_amplitude[0], &mut next_rate[0]);
        self.arch.dispatch(
            #[inline(always)]
            || {
                for k in 0..a.near.len() {
                    let pulled = fade.at(k) * b.at(k) + pull.at(k) * a.at(k);
                    to_b.set(k, order * (pulled + push.at(k) * force));
                    to_a.set(k, order * b.at(k));
                }
            },
        );
    }

    /// The state at this time of the step.
    fn move_to(&mut self, time: Double) {
        for rows in [&mut self.amplitude, &mut self.rate] {
            let mut sum = rows[DEGREE].clone();
            for row in rows[..DEGREE].iter().rev() {
                self.arch.dispatch(
                    #[inline(always)]
                    || {
                        for k in 0..row.near.len() {
                            sum.set(k, sum.at(k) * time + row.at(k));
                        }
                    },
                );
            }
            rows[0] = sum;
        }
    }

    /// The longest step for free motion (s).
    fn longest_s(&self) -> f64 {
        3.5 / self.fastest.max(1e-3)
    }

    /// Makes the longest step of free motion if the surfaces, which are this far apart, cannot touch within it: free motion from
    /// `a` and `a'` displaces a mode by at most `min(omega h, 2) |a| + h |a'|`.
    fn glide(&mut self, impact: &Impact, separation_m: f64, time: &mut Double) -> bool {
        let h = self.longest_s();
        let (a, b) = (&self.amplitude[0].near, &self.rate[0].near);
        let moved =
            |k: usize| impact.psi[k].near.abs() * ((impact.omega[k].near * h).min(2.0) * a[k].abs() + h * b[k].abs());
        if separation_m <= 1.001 * (0..a.len()).map(moved).sum::<f64>() {
            return false;
        }
        let free = self.free.take().unwrap_or_else(|| [(1.0, 0.0), (0.0, 1.0)].map(|start| self.free_motion(start)));
        let [after_amplitude, after_rate] = &free;
        let (arch, amplitude, rate) = (self.arch, &mut self.amplitude[0], &mut self.rate[0]);
        arch.dispatch(
            #[inline(always)]
            || {
                for k in 0..amplitude.near.len() {
                    let (a, b) = (amplitude.at(k), rate.at(k));
                    amplitude.set(k, after_amplitude[0].at(k) * a + after_rate[0].at(k) * b);
                    rate.set(k, after_amplitude[1].at(k) * a + after_rate[1].at(k) * b);
                }
            },
        );
        self.free = Some(free);
        *time = *time + number(h);
        true
    }

    /// Amplitude and rate of every mode after the longest step, from these.
    fn free_motion(&self, (amplitude, rate): (f64, f64)) -> [Row; 2] {
        let (mut series, n) = (self.clone(), self.amplitude[0].near.len());
        series.amplitude[0] = Row::new(n, |_| number(amplitude));
        series.rate[0] = Row::new(n, |_| number(rate));
        let unit_s = 1.0 / self.fastest.max(1e-3);
        (0..DEGREE).for_each(|i| series.raise(i, unit_s, number(0.0)));
        series.move_to(number(self.longest_s()) / number(unit_s));
        [series.amplitude.swap_remove(0), series.rate.swap_remove(0)]
    }

    /// One step, up to the first event in it, if there is one; returns its number.
    fn step(
        &mut self,
        impact: &Impact,
        formula: &Formula,
        phase: Phase,
        touch: Double,
        time: &mut Double,
    ) -> Option<usize> {
        let (mut xi, mut rate) = (vec![Double::default(); DEGREE + 1], vec![Double::default(); DEGREE + 1]);
        let (mut u, mut p) = (xi.clone(), xi.clone());
        let (mut v, mut q, mut g, mut force) = (xi.clone(), xi.clone(), xi.clone(), xi.clone());
        let (xi_m, rate_m_s) = self.contact(impact);
        let fastest_s = 1.0 / self.fastest.max(1e-3);
        // Coefficients in the time scale on which the compression changes do not overflow.
        let own_s = ((xi_m - formula.anchor).near / rate_m_s.near).abs();
        let unit_s = if formula.has_power() && own_s > 0.0 { own_s.min(fastest_s) } else { fastest_s };
        let mut longest = self.longest_s() / unit_s;
        let mut has_power = formula.has_power();
        for i in 0..=DEGREE {
            xi[i] = self.seen(&self.amplitude[i]) - if i == 0 { impact.gap } else { Double::default() };
            rate[i] = self.seen(&self.rate[i]);
            force[i] = formula.per_xi * xi[i] + formula.per_rate * rate[i];
            if i == 0 {
                force[0] = force[0] + formula.constant;
                (u[0], v[0]) = (xi[0] - formula.anchor, xi[0] + formula.eps);
                if has_power {
                    // Near its start and its end the power has no effect for a time.
                    let speed = rate[0].near.abs().max(1e-300);
                    let own: f64 = impact.psi.iter().map(|psi| psi.near * psi.near).sum();
                    let stiffness = own * (formula.power.near.abs() + formula.excess.near.abs());
                    // The time in which it changes the rate by a given fraction: stiffness (speed t)^1.5 t = fraction speed.
                    let idle = (PART * speed / (stiffness * speed.powf(1.5))).powf(0.4);
                    if u[0].near <= 0.5 * speed * idle {
                        has_power = false;
                        longest = longest.min(idle / unit_s);
                    } else {
                        p[0] = u[0] * u[0].sqrt();
                        if formula.excess.near != 0.0 {
                            let power = v[0].two_fifths();
                            q[0] = if formula.exponent > 0.0 { power } else { number(1.0) / power };
                        }
                    }
                }
            } else {
                (u[i], v[i]) = (xi[i], xi[i]);
            }
            if has_power {
                if i > 0 {
                    p[i] = raised(&u, &p, i, 1.5);
                    if formula.excess.near != 0.0 {
                        q[i] = raised(&v, &q, i, formula.exponent);
                    }
                }
                g[i] = formula.power_rate * rate[i] + formula.excess * q[i];
                if i == 0 {
                    g[0] = g[0] + formula.power;
                }
                let is_constant = formula.power_rate.near == 0.0 && formula.excess.near == 0.0;
                force[i] = force[i] + if is_constant { p[i] * g[0] } else { (0..=i).map(|j| p[j] * g[i - j]).sum() };
            }
            if i < DEGREE {
                self.raise(i, unit_s, force[i]);
            }
        }
        // The step length that the last coefficients of force and compression allow.
        let reach = |values: &[Double], size: f64| {
            let of = |i: usize| (PART * size / values[i].near.abs()).powf(1.0 / i as f64);
            of(DEGREE - 1).min(of(DEGREE))
        };
        if has_power {
            let size = force[0].near.abs();
            longest = longest.min(reach(&force, size));
        }
        // Relative to the largest term at the step length itself: if the contact is much faster than all modes, the terms at the longest
        // step are so large that they allow a step over the whole contact.
        let most = |length: f64| {
            xi.iter().enumerate().map(|(i, value)| value.near.abs() * length.powi(i as i32)).fold(0.0, f64::max)
        };
        let length = number((0..8).fold(longest, |length, _| length.min(reach(&xi, most(length)))));
        let at = |values: &[Double], t: Double| values.iter().rev().fold(Double::default(), |sum, x| sum * t + *x);
        let margins = |t: Double| impact.margins(phase, touch, at(&xi, t), at(&rate, t));
        // The first point where an event function that was positive is not.
        let mut end = length;
        let mut met = None;
        let mut before = margins(number(0.0));
        // Bound on the change of compression and rate.
        let [most_xi, most_rate] = [&xi, &rate]
            .map(|values| (1..=DEGREE).rev().fold(0.0, |sum, i| (sum + values[i].near.abs()) * length.near));
        let corners = [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)];
        let stays = corners.iter().all(|(to_xi, to_rate)| {
            let there = (xi[0] + number(to_xi * most_xi), rate[0] + number(to_rate * most_rate));
            impact.margins(phase, touch, there.0, there.1).iter().all(|margin| margin.near > 0.0)
        });
        for place in 1..=if stays { 0 } else { PLACES } {
            let t = length * number(place as f64 / PLACES as f64);
            let after = margins(t);
            for which in 0..2 {
                if before[which].near > 0.0 && after[which].near <= 0.0 {
                    let from = length * number((place - 1) as f64 / PLACES as f64);
                    let root = bisect(from, t, |t| margins(t)[which]);
                    if met.is_none() || (root - end).near < 0.0 {
                        (end, met) = (root, Some(which));
                    }
                }
            }
            if met.is_some() {
                break;
            }
            before = after;
        }
        self.move_to(end);
        *time = *time + number(unit_s) * end;
        met
    }
}

/// The coefficient of order `i` of `u^alpha`.
fn raised(u: &[Double], p: &[Double], i: usize, alpha: f64) -> Double {
    let terms = (1..=i).map(|j| number(alpha * j as f64 - (i - j) as f64) * u[j] * p[i - j]);
    terms.sum::<Double>() / (number(i as f64) * u[0])
}

/// The time between two others at which a function decreases to zero.
fn bisect(mut low: Double, mut high: Double, margin: impl Fn(Double) -> Double) -> Double {
    let (mut above, mut below) = (margin(low), margin(high));
    let mut side = 0;
    for _ in 0..200 {
        if (high - low).near <= 1e-31 * high.near {
            break;
        }
        // The secant rule; the value at the retained end is halved (Illinois).
        let middle = low + (high - low) * (above / (above - below));
        let inside = (middle - low).near > 0.0 && (high - middle).near > 0.0;
        let middle = if inside { middle } else { (low + high) * number(0.5) };
        let value = margin(middle);
        if value.near == 0.0 {
            return middle;
        } else if value.near > 0.0 {
            if side == 1 {
                below = below * number(0.5);
            }
            (low, above, side) = (middle, value, 1);
        } else {
            if side == -1 {
                above = above * number(0.5);
            }
            (high, below, side) = (middle, value, -1);
        }
    }
    high
}
