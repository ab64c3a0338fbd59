//! The state that is passed from panel to panel: the motion of the contacts, and its derivatives.

use super::expansion::Expansions;
use crate::assembly::change::Change;
use crate::assembly::collocate::Blocks;
use crate::assembly::load::Loads;
use crate::assembly::load_change::LoadChange;
use crate::assembly::no_derivative::NoDerivative;
use crate::assembly::problem::Posed;
use crate::assembly::system::{Span, System};
use crate::panel::legendre::Nodal;
use contact_models::{Branch, Internal, Memory};
use std::array;

/// Step of finite differences of a law's functions, relative to the size of a variable.
pub(super) const LAW_STEP: f64 = 1e-6;

/// Derivatives of an interval of contact.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct IntervalChange {
    pub contact: usize,
    pub start_s: f64,
    pub end_s: f64,
    pub impulse_n_s: f64,
    pub peak_force_n: f64,
    pub peak_compression_m: f64,
    pub approach_speed_m_s: f64,
    pub separation_speed_m_s: f64,
}

/// Derivatives of a motion with respect to one parameter.
#[derive(Clone)]
pub(crate) struct Tangent {
    /// Derivatives of the modal amplitudes in the order of [`System`]: of the relative motion, and of the whole motion at the end
    /// of the record. Those of their rates and of the time follow.
    pub amplitude: Vec<f64>,
    pub rate: Vec<f64>,
    pub time_s: f64,
    pub intervals: Vec<IntervalChange>,
    pub(super) contacts: Vec<Carried>,
    /// The first reason why there is none; the numbers have no meaning from then on.
    pub(super) refused: Option<NoDerivative>,
}

/// Derivatives of the state of a contact, which is passed from panel to panel.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Carried {
    /// Derivative of the part of its overlap that does not come from the modes (m).
    pub reference: f64,
    /// Derivatives of the numbers of its branch.
    pub branch: Numbers,
    /// Derivatives of the memory of an open contact.
    pub memory: Numbers,
}

/// The numbers that determine a branch or a memory: the compression at which it began or touches (m), and the internal variables.
pub(super) type Numbers = [f64; NUMBERS];
pub(super) const NUMBERS: usize = 1 + Internal::MOST;

pub(super) fn numbers(at_m: f64, internal: Internal) -> Numbers {
    let internal: [f64; Internal::MOST] = internal.into();
    array::from_fn(|i| if i == 0 { at_m } else { internal[i - 1] })
}

/// The internal variables among the numbers.
pub(super) fn internal(numbers: &[f64]) -> Internal {
    array::from_fn::<f64, { Internal::MOST }, _>(|i| numbers[i + 1]).into()
}

/// A contact along the record itself.
#[derive(Debug, Clone, Copy)]
pub(super) struct Followed {
    pub branch: Option<Branch>,
    pub memory: Memory,
    pub overlap: f64,
    pub rate: f64,
    /// Sizes of overlap and rate so far.
    pub sizes: [f64; 2],
    /// The present interval, when it began (s), its largest force and compression.
    pub interval: usize,
    pub since_s: f64,
    pub peaks: [f64; 2],
}

/// Derivatives with respect to one parameter on one panel.
#[derive(Default)]
pub(super) struct Moved {
    pub amplitude: Vec<f64>,
    pub rate: Vec<f64>,
    /// By the panel's closed contacts: change of the law's force at the nodes, which move with the end of the panel; of the polynomial
    /// that moves the modes and of the overlap, at unchanged times.
    pub law: Vec<Nodal>,
    pub force: Vec<Nodal>,
    pub overlap: Vec<Nodal>,
}

pub(super) struct Walk<'a> {
    pub posed: &'a Posed<'a>,
    pub system: &'a System,
    pub changes: &'a [Change<'a>],
    /// A weight of -1 for each mode that moves a contact, and whether any parameter changes frequencies or dampings.
    pub units: Vec<Vec<Span>>,
    pub modes_move: bool,
    /// The loads on the panel at hand, and how they change.
    pub loads: Loads,
    pub load_changes: Vec<Option<LoadChange>>,
    pub expansions: &'a mut Expansions,
    /// Relative error of the numbers that the laws compute at events, which the derivatives of a branch contain.
    pub rounded: f64,
    pub blocks: Blocks,
    pub contacts: Vec<Followed>,
    pub tangents: Vec<Tangent>,
    /// Memory for each parameter's derivatives on a panel.
    pub moved: Vec<Moved>,
    /// Intervals begun so far, and the lowest and the highest speed at which a contact closed.
    pub begun: usize,
    pub closing_speeds_m_s: [f64; 2],
}

pub(super) fn sum(spans: &[Span], values: &[f64]) -> f64 {
    spans.iter().map(|span| span.sum(values)).sum()
}

impl<'a> Walk<'a> {
    pub fn new(
        posed: &'a Posed<'a>,
        system: &'a System,
        changes: &'a [Change<'a>],
        expansions: &'a mut Expansions,
        rounded: f64,
    ) -> Walk<'a> {
        let unit = |span: &Span| Span { modes: span.modes.clone(), psi: vec![-1.0; span.psi.len()] };
        let followed = |gap: &f64| Followed {
            branch: None,
            memory: Memory::default(),
            overlap: -gap,
            rate: 0.0,
            sizes: [0.0; 2],
            interval: 0,
            since_s: 0.0,
            peaks: [0.0; 2],
        };
        let loads = Loads::new(posed.loads, system);
        let splits = |change: &Change| change.loads.as_ref().is_some_and(|change| change.splits(&loads));
        let tangent = |change: &Change| Tangent {
            amplitude: change.amplitude.clone(),
            rate: change.rate.clone(),
            time_s: 0.0,
            intervals: Vec::new(),
            contacts: change.gap_m.iter().map(|gap| Carried { reference: -gap, ..Carried::default() }).collect(),
            refused: splits(change).then_some(NoDerivative::Split),
        };
        let tangents = changes.iter().map(tangent).collect();
        Walk {
            posed,
            system,
            changes,
            units: system.links.iter().map(|link| link.spans.iter().map(unit).collect()).collect(),
            modes_move: changes.iter().any(|change| change.moves_modes),
            loads,
            load_changes: changes.iter().map(|change| change.loads.clone()).collect(),
            expansions,
            rounded,
            blocks: Blocks::default(),
            contacts: posed.gaps_m.iter().map(followed).collect(),
            tangents,
            moved: changes.iter().map(|_| Moved::default()).collect(),
            begun: 0,
            closing_speeds_m_s: [f64::INFINITY, 0.0],
        }
    }

    /// The value, or zero if there is none, which leaves this parameter without a derivative.
    pub fn or_refuse<T: Default>(&mut self, d: usize, found: Result<T, NoDerivative>) -> T {
        found.unwrap_or_else(|why| {
            self.tangents[d].refused.get_or_insert(why);
            T::default()
        })
    }

    /// Change of an overlap and its rate at a time, for a state and its change.
    pub fn overlap(&self, d: usize, c: usize, time_s: f64, state: [&[f64]; 2], change: [&[f64]; 2]) -> [f64; 2] {
        let (link, psi) = (&self.system.links[c], &self.changes[d].psi[c]);
        let beyond = self.beyond(d, c, time_s);
        array::from_fn(|i| sum(psi, state[i]) + link.sum(change[i]) + beyond[i])
    }

    /// The part that does not come from the relative motion of the modes.
    pub fn beyond(&self, d: usize, c: usize, time_s: f64) -> [f64; 2] {
        let mut found = [self.tangents[d].contacts[c].reference, 0.0];
        if !self.loads.is_empty() {
            let later = self.tangents[d].time_s;
            found[0] += later * self.loads.overlap(c, time_s).1;
            found[1] += later * self.loads.bend(c, time_s);
        }
        if let Some(loads) = &self.load_changes[d] {
            let by_loads = loads.overlap(c, time_s);
            (0..2).for_each(|i| found[i] += by_loads[i]);
        }
        found
    }
}

/// The step of finite differences for a number of a branch.
pub(super) fn size_of(branch: &Branch, which: usize, followed: &Followed) -> f64 {
    match (numbers(branch.anchor_m, branch.internal)[which], which) {
        (0.0, 0) => followed.sizes[0],
        (0.0, _) => 1.0,
        (value, _) => value.abs(),
    }
}

pub(super) fn shifted(branch: &Branch, which: usize, by: f64) -> Branch {
    let mut shifted = numbers(branch.anchor_m, branch.internal);
    shifted[which] += by;
    Branch { anchor_m: shifted[0], internal: internal(&shifted), ..*branch }
}
