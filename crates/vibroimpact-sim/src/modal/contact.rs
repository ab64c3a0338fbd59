//! One interval of contact: from first touch to separation.

use super::behind::Behind;
use super::ladder::{J_MAX, J_MIN, Ladder, level_within, step_s};
use super::landing::{self, Approach, Landed, REACH};
use super::legendre::{BASIS, Nodal, Q, evaluate};
use super::motion::{ContactPiece, Motion, Piece};
use super::rest::Pressed;
use super::solution::{Counts, SubImpact};
use super::step::{BLUR, Collocated, Given, collocate, first_crossing, truncation};
use crate::StopReason;
use contact_models::{After, Boundary, Branch, ContactLaw, LARGEST, Memory};

/// How a contact ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum ContactEnd {
    /// The surfaces parted, leaving this memory.
    Released(Memory),
    /// The surfaces do not part any more.
    Lasts,
    /// The contact was given up.
    Stopped(StopReason),
}

/// The impact as seen by one contact.
pub(crate) struct Setting<'a, L> {
    pub law: &'a L,
    /// Inverse mass of striker and rigid-body modes together (1/kg).
    pub mu: f64,
    pub residual_compliance: f64,
    /// Impulse that a step may get wrong (N s).
    pub impulse_tolerance: f64,
    /// Energy below which the impact counts as died down (J).
    pub rest_energy: f64,
    pub max_steps: u64,
    /// A contact that lasts is followed up to this time (s).
    pub until_s: f64,
}

/// Whether a contact lasts is looked at once in this many steps.
const REST_CHECK: u64 = 8;
/// A step is doubled when its error is this many times below the tolerance.
const GROWTH: f64 = 250.0;
/// Part of the tolerated error that the nodal forces may have.
const NEWTON_SHARE: f64 = 1e-2;
/// By how much the law may be missed at the end of a step, where the polynomial is extrapolated: in tolerances.
const DEFECT: f64 = 1.0;
/// A mode that turns by no more than this (rad) in a step is followed by the polynomial through the nodes.
const RESOLVED: f64 = 2.0;
/// Part of the way to the expected end of a branch that one step may take.
const SHARE: f64 = 0.85;
/// The error of a landing grows with this power of its length at least, where the force ends as `(t - end)^(3/2)`.
const LANDING: f64 = 2.5;

pub(crate) struct Contact<'a, L> {
    setting: &'a Setting<'a, L>,
    ladder: &'a mut Ladder,
    motion: &'a mut Motion,
    /// The motion before the step that is being tried.
    before: Motion,
    counts: &'a mut Counts,
    record: &'a mut Option<Vec<Piece>>,
    branch: Branch,
    needs_rate: bool,
    level: i32,
    /// Legendre coefficients of the last step's force, and its length.
    previous: Option<(Nodal, f64)>,
    /// Compression, its rate, and the gap now. The gap is summed up as it changes: as the difference of where the bodies
    /// are it would carry the rounding of the way from their places, which a stiff contact turns into force.
    compression: f64,
    rate: f64,
    gap: f64,
    /// Where the branch is expected to end: which boundary, and when.
    horizon: Option<(usize, f64)>,
    /// Longest landing that accuracy allows, as far as landings of this branch have shown (s).
    landing: f64,
    peak_force: Peak,
    peak_compression: Peak,
}

impl<'a, L: ContactLaw> Contact<'a, L> {
    /// Follows the contact that begins now, and says how it ended.
    pub fn run(
        setting: &'a Setting<'a, L>,
        ladder: &'a mut Ladder,
        motion: &'a mut Motion,
        memory: &Memory,
        counts: &'a mut Counts,
        record: &'a mut Option<Vec<Piece>>,
    ) -> (SubImpact, ContactEnd) {
        // the surfaces touch: remove the rounding of the search for this moment
        motion.drift += memory.touch_m - motion.gap();
        let rate = motion.gap_rate().max(0.0);
        let (start_s, impulse_before) = (motion.time, motion.impulse);
        let mut contact = Contact {
            setting,
            ladder,
            before: motion.clone(),
            motion,
            counts,
            record,
            branch: setting.law.touch(memory, rate),
            needs_rate: false,
            level: J_MIN,
            previous: None,
            compression: memory.touch_m,
            rate,
            gap: memory.touch_m,
            horizon: None,
            landing: f64::INFINITY,
            peak_force: Peak::NONE,
            peak_compression: Peak::NONE,
        };
        contact.enter(contact.branch);
        contact.level = contact.first_level();
        let end = contact.follow();
        contact.motion.drift += contact.gap - contact.motion.gap();
        let found = SubImpact {
            start_s,
            end_s: contact.motion.time,
            impulse_n_s: contact.motion.impulse - impulse_before,
            peak_force_n: contact.peak_force.value(),
            peak_compression_m: contact.peak_compression.value(),
        };
        (found, end)
    }

    fn enter(&mut self, branch: Branch) {
        self.branch = branch;
        self.horizon = None;
        self.landing = f64::INFINITY;
        self.needs_rate = self.setting.law.depends_on_rate()
            || self.setting.law.boundaries(&branch).iter().any(|b| b.per_rate != 0.0);
    }

    /// The coarsest level on which the force, begun at first touch, is still small against the tolerance, and which
    /// resolves the modes that could part the surfaces at once.
    fn first_level(&self) -> i32 {
        let state = &self.motion.vibration;
        let mut acceleration = 0.0;
        for ((mode, a), b) in self.ladder.modes.iter().zip(&state.alpha).zip(&state.beta) {
            acceleration -= mode.omega_rad_s * (2.0 * mode.damping_ratio * b + mode.omega_rad_s * a);
        }
        // a polynomial through Q nodes follows t^1.5 to about this fraction of its size
        const SINGULAR: f64 = 1e-4;
        let small = |j: i32| {
            let h = step_s(j);
            let compression = self.compression + h * (self.rate + 0.5 * h * acceleration.max(0.0));
            let force = self.setting.law.force(&self.branch, compression, self.rate).force_n;
            SINGULAR * force * h <= self.setting.impulse_tolerance
        };
        // the force at the end of a step grows with the step
        let (mut coarse, mut fine) = (J_MIN, J_MAX);
        while coarse < fine {
            let middle = coarse + (fine - coarse) / 2;
            if small(middle) { fine = middle } else { coarse = middle + 1 }
        }
        fine.max(self.level_of_reversal())
    }

    /// The coarsest level that resolves all modes but the fastest, as far as these together are slower than half the rate
    /// of compression: the surfaces then do not part within the step unseen, nor in the following ones of twice its length.
    fn level_of_reversal(&self) -> i32 {
        let state = &self.motion.vibration;
        let mut rate = 0.5 * self.rate;
        for (k, mode) in self.ladder.modes.iter().enumerate().rev() {
            rate -= state.beta[k].hypot(mode.omega_rad_s * state.alpha[k]);
            if rate < 0.0 {
                return level_within(RESOLVED / mode.omega_rad_s);
            }
        }
        J_MIN
    }

    fn follow(&mut self) -> ContactEnd {
        let mut lasts = false;
        loop {
            let steps = self.counts.contact_steps + self.counts.rejected_steps;
            if !lasts && steps % REST_CHECK == REST_CHECK - 1 {
                lasts = self.lasts();
            }
            if lasts && self.motion.time >= self.setting.until_s {
                return ContactEnd::Lasts;
            }
            if let Some(reason) = self.limit(steps) {
                return if lasts { ContactEnd::Lasts } else { ContactEnd::Stopped(reason) };
            }
            if let Some(end) = self.advance() {
                return end;
            }
        }
    }

    fn limit(&self, steps: u64) -> Option<StopReason> {
        if steps >= self.setting.max_steps {
            Some(StopReason::Steps)
        } else if self.level > J_MAX {
            Some(StopReason::FinestStep)
        } else if self.is_beyond_the_law() {
            Some(StopReason::LawRange)
        } else {
            None
        }
    }

    fn lasts(&self) -> bool {
        let pressed = Pressed {
            law: self.setting.law,
            branch: &self.branch,
            compression: self.compression,
            rate: self.rate,
            mu: self.setting.mu,
            residual_compliance: self.setting.residual_compliance,
        };
        pressed.lasts(self.ladder, self.motion, self.setting.rest_energy)
    }

    /// Whether the law has been asked for more than it knows.
    fn is_beyond_the_law(&self) -> bool {
        self.compression.abs().max(self.peak_compression.largest).max(self.rate.abs()) > LARGEST
    }

    /// One try: a step forward, a return to a finer level, or the end of the contact.
    fn advance(&mut self) -> Option<ContactEnd> {
        if let Some((which, at)) = self.horizon
            && at - self.motion.time <= self.reach()
        {
            self.horizon = None;
            return self.approach(which, (at - self.motion.time).max(0.0), self.reach());
        }
        let level = self.level_now();
        let h = step_s(level);
        let Some((step, force)) = self.attempt(level) else {
            return self.refine(level + 1);
        };
        let boundaries = self.setting.law.boundaries(&self.branch);
        let start = (self.compression, self.rate);
        if let Some((which, place)) = first_crossing(&boundaries, &step, start, None, h, || self.noise(&step, h)) {
            return self.approach(which, place * h, h);
        }
        if step.force == [0.0; Q] && !self.resolves(&boundaries, &step, h) {
            return self.refine(level + 1);
        }
        let tolerance = self.setting.impulse_tolerance;
        let error = truncation(&force) * h;
        if error > tolerance {
            // the error falls at least like h^5, but for the first steps of a contact, which are begun short enough
            let finer = ((error / tolerance).log2() / 5.0) as i32;
            return self.refine(level + finer.clamp(1, 4));
        }
        self.before.copy_from(self.motion);
        let moved = self.ladder.advance(level, &mut self.motion.vibration, &force);
        let gap = self.gap + (moved + self.motion.advance_drift(h, &force, self.setting.mu));
        let end = self.end_of_step(gap, &step, &force, h);
        let outside = boundaries.iter().any(|boundary| boundary.margin(end.0, end.1) < 0.0);
        if outside
            && let Some((which, place)) =
                first_crossing(&boundaries, &step, start, Some(end), h, || self.noise(&step, h))
        {
            std::mem::swap(self.motion, &mut self.before);
            return self.approach(which, place * h, h);
        }
        // modes that turn several times within the step escape the coefficients, but not the law at its end
        if self.defect(end, &force) * h > DEFECT * tolerance || error * self.answer(end, h) > tolerance {
            std::mem::swap(self.motion, &mut self.before);
            return self.refine(level + 1);
        }
        self.note(h, &step, &force);
        (self.compression, self.rate) = end;
        self.gap = gap;
        self.previous = Some((force, h));
        if level == self.level && error * GROWTH < tolerance {
            self.level = (level - 1).max(J_MIN);
        }
        None
    }

    /// The level of the next step: what accuracy allows, and no nearer to the expected end of the branch than a share of
    /// the way.
    fn level_now(&self) -> i32 {
        let towards = |(_, at): (usize, f64)| level_within(SHARE * (at - self.motion.time));
        self.horizon.map_or(self.level, |horizon| self.level.max(towards(horizon)))
    }

    /// By how much the force misses the law at the end of a step (N).
    fn defect(&mut self, end: (f64, f64), force: &Nodal) -> f64 {
        self.counts.law_evaluations += 1;
        (self.setting.law.force(&self.branch, end.0, end.1).force_n - evaluate(force, 1.0)).abs()
    }

    /// How many times over the compliance answers an error of the force, which moves the gap: of a contact that lags behind
    /// it, whose own stiffness does not hold the compression down.
    fn answer(&self, end: (f64, f64), h: f64) -> f64 {
        let compliance = self.setting.residual_compliance;
        if compliance > 0.0 && self.behind().lags(end.0, end.1, h) {
            1.0 + (self.setting.mu + self.ladder.kernel[1]) * h * h / compliance
        } else {
            1.0
        }
    }

    fn behind(&self) -> Behind<'_, L> {
        Behind { law: self.setting.law, branch: &self.branch, compliance: self.setting.residual_compliance }
    }

    /// Longest step for a landing (s).
    fn reach(&self) -> f64 {
        let slowest = if self.level < J_MIN { step_s(J_MIN) } else { step_s(self.level) * 2.0 };
        let reach = slowest.min(self.landing);
        if self.ladder.fastest_rad_s > 0.0 { reach.min(REACH / self.ladder.fastest_rad_s) } else { reach }
    }

    fn refine(&mut self, level: i32) -> Option<ContactEnd> {
        self.counts.rejected_steps += 1;
        self.level = level;
        None
    }

    /// Goes towards the end of the branch, expected after `expected` seconds of a step of `h`: lands there if it is
    /// near, or takes shorter steps.
    fn approach(&mut self, which: usize, expected: f64, h: f64) -> Option<ContactEnd> {
        let reach = self.reach().min(h);
        if expected <= reach {
            let series = landing::taylor_of_free_motion(self.ladder, &self.motion.vibration, reach);
            let mut approach = Approach {
                law: self.setting.law,
                branch: &self.branch,
                which,
                needs_rate: self.needs_rate,
                accuracy: NEWTON_SHARE * self.setting.impulse_tolerance,
                start_compression: self.compression,
                gap: series,
                kernel: self.ladder.kernel,
                residual_compliance: self.setting.residual_compliance,
            };
            approach.gap[0] = self.gap;
            approach.gap[1] += self.motion.drift_rate;
            approach.kernel[1] += self.setting.mu;
            let landed = approach.land(expected, reach, self.counts);
            match landed.map(|landed| (landed, self.excess(&landed))) {
                Some((landed, excess)) if excess <= 1.0 => {
                    // the branch may have ended before, in a dip that this landing passed over
                    let boundaries = self.setting.law.boundaries(&self.branch);
                    let start = (self.compression, self.rate);
                    let noise = || self.noise(&landed.step, landed.length);
                    match first_crossing(&boundaries, &landed.step, start, None, landed.length, noise) {
                        None => return self.cross(which, landed),
                        Some((earlier, place)) => {
                            self.horizon = Some((earlier, self.motion.time + place * landed.length));
                            return self.refine(self.level + 1);
                        }
                    }
                }
                // too long for its accuracy
                Some((landed, excess)) => {
                    self.landing = 0.9 * landed.length * excess.powf(-1.0 / LANDING).max(1e-3);
                    self.horizon = Some((which, self.motion.time + landed.length));
                    return self.refine(self.level + 1);
                }
                // not so near after all: go on, until a step meets the boundary again
                None => return self.refine((self.level + 1).max(level_within(reach))),
            }
        }
        self.horizon = Some((which, self.motion.time + expected));
        self.refine(self.level)
    }

    /// By how much the force of a landing is less well known than that of a step must be. How it misses the law at the
    /// end matters only behind a compliance, where it is a part of the compression there.
    fn excess(&mut self, landed: &Landed) -> f64 {
        let mut error = truncation(&landed.force);
        if self.setting.residual_compliance > 0.0 {
            error = error.max(self.defect((landed.compression, landed.rate), &landed.force) / DEFECT);
        }
        error * landed.length / self.setting.impulse_tolerance
    }

    /// Commits a landing and asks the law what follows.
    fn cross(&mut self, which: usize, landed: Landed) -> Option<ContactEnd> {
        self.before.copy_from(self.motion);
        landing::advance(self.ladder, &mut self.motion.vibration, landed.length, &landed.step.force);
        self.motion.advance_drift(landed.length, &landed.force, self.setting.mu);
        self.note(landed.length, &landed.step, &landed.force);
        (self.compression, self.rate, self.gap) = (landed.compression, landed.rate, landed.gap);
        self.previous = Some((landed.force, landed.length));
        match self.setting.law.cross(&self.branch, which, landed.compression, landed.rate) {
            After::Release(memory) => Some(ContactEnd::Released(memory)),
            After::Continue(branch) => {
                self.enter(branch);
                None
            }
        }
    }

    /// Solves one ladder step of the present level: its nodal values, and the force's Legendre coefficients.
    fn attempt(&mut self, level: i32) -> Option<(Collocated, Nodal)> {
        let (basis, h) = (&*BASIS, step_s(level));
        let (mut free, structure) = self.ladder.at_nodes(level, &self.motion.vibration);
        let mut response = *structure;
        let inertia = self.setting.mu * h * h;
        for i in 0..Q {
            free[i] = self.gap + (free[i] + self.motion.drift_rate * basis.nodes[i] * h);
            for j in 0..Q {
                response[i][j] -= inertia * basis.power[1][i][j];
            }
        }
        let mut guess = [0.0; Q];
        if let Some((coefficients, length)) = &self.previous {
            for i in 0..Q {
                guess[i] = evaluate(coefficients, 1.0 + basis.nodes[i] * h / length).max(0.0);
            }
        }
        let given = Given {
            h,
            start_compression: self.compression,
            start_gap: self.gap,
            free,
            response: &response,
            residual_compliance: self.setting.residual_compliance,
            needs_rate: self.needs_rate,
            accuracy: NEWTON_SHARE * self.setting.impulse_tolerance / h,
        };
        let step = collocate(self.setting.law, &self.branch, &given, guess, self.counts)?;
        Some((step, basis.coefficients(&step.force)))
    }

    /// Whether a step in a pause of the law ([`contact_models::Stage::Slack`]), in which there is no force to be resolved,
    /// resolves the modes that could bring about the pause's end: all but the fastest, as far as these together move no
    /// boundary by half its distance. A free mode exceeds neither the displacement nor the velocity of its energy.
    fn resolves(&self, boundaries: &[Boundary; 2], step: &Collocated, h: f64) -> bool {
        let state = &self.motion.vibration;
        boundaries.iter().filter(|boundary| **boundary != Boundary::NEVER).all(|boundary| {
            let margins = step.compression.iter().zip(&step.rate).map(|(xi, rate)| boundary.margin(*xi, *rate));
            let least = margins.fold(f64::INFINITY, f64::min);
            let mut moved = 0.0;
            for (k, mode) in self.ladder.modes.iter().enumerate().rev() {
                if mode.omega_rad_s * h <= RESOLVED {
                    break;
                }
                let speed = state.beta[k].hypot(mode.omega_rad_s * state.alpha[k]);
                moved += speed * (boundary.per_compression.abs() / mode.omega_rad_s + boundary.per_rate.abs());
                if moved > 0.5 * least {
                    return false;
                }
            }
            true
        })
    }

    /// How exact the compression of a step of `h` is (m): it is the small difference of how far a drift and many modes
    /// move, and behind a compliance that of a force as well.
    fn noise(&self, step: &Collocated, h: f64) -> f64 {
        let state = &self.motion.vibration;
        let modes = self.ladder.modes.iter().zip(&state.alpha).zip(&state.beta);
        let moved = modes.map(|((mode, a), b)| (mode.omega_rad_s * h).min(1.0) * a.abs() + h * b.abs());
        let moved = moved.sum::<f64>() + h * self.motion.drift_rate.abs();
        let gap = 4.0 * f64::EPSILON * (moved + self.gap.abs() + self.compression.abs());
        let pressed = step.force.iter().fold(0.0f64, |a, b| a.max(b.abs())) * self.setting.residual_compliance;
        gap + BLUR * pressed
    }

    /// Compression and rate at the end of a step that the motion has just made.
    fn end_of_step(&self, gap: f64, step: &Collocated, force: &Nodal, h: f64) -> (f64, f64) {
        self.behind().end_of_step((gap, self.motion.gap_rate()), self.compression, step, force, h)
    }

    /// Books a step that has been made: peaks, counts, record.
    fn note(&mut self, h: f64, step: &Collocated, force: &Nodal) {
        self.counts.contact_steps += 1;
        self.peak_force.note(&step.force);
        self.peak_compression.note(&step.compression);
        if let Some(pieces) = self.record.as_mut() {
            let contact = ContactPiece { length: h, force: *force, branch: self.branch };
            pieces.push(Piece { start: self.before.clone(), contact: Some(contact) });
        }
    }
}

/// The largest value of a quantity over the steps of a contact: the step with the largest nodal value is kept, and its
/// polynomial searched once the contact is over.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Peak {
    largest: f64,
    nodal: Nodal,
}

impl Peak {
    pub const NONE: Peak = Peak { largest: 0.0, nodal: [0.0; Q] };

    pub fn note(&mut self, nodal: &Nodal) {
        let largest = nodal.iter().fold(0.0, |a: f64, b| a.max(*b));
        if largest > self.largest {
            *self = Peak { largest, nodal: *nodal };
        }
    }

    pub fn value(&self) -> f64 {
        let coefficients = BASIS.coefficients(&self.nodal);
        let value = |at: f64| evaluate(&coefficients, at);
        // the best of a grid, then twice the vertex of the parabola through it and its neighbours
        let grid = 2 * Q;
        let (mut at, mut best) = (0.0, value(0.0));
        for i in 1..=grid {
            let place = i as f64 / grid as f64;
            let here = value(place);
            if here > best {
                (at, best) = (place, here);
            }
        }
        let mut spacing = 1.0 / grid as f64;
        for _ in 0..2 {
            let (before, after) = (value(at - spacing), value(at + spacing));
            let bend = before - 2.0 * best + after;
            let vertex = at + 0.5 * spacing * (before - after) / bend;
            if !(bend < 0.0 && (0.0..=1.0).contains(&vertex)) {
                break;
            }
            let here = value(vertex);
            if here > best {
                (at, best) = (vertex, here);
            }
            spacing *= 0.1;
        }
        self.largest.max(best)
    }
}
