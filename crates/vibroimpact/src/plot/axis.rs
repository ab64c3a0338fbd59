//! Axes: limits, ticks and their labels.

use super::text::{fixed, width_px};
use crate::text::superscript;

/// Description of an axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// Name of the quantity, without its unit.
    pub label: String,
    /// Unit, empty for a dimensionless quantity.
    pub unit: String,
    /// Whether the axis is logarithmic; values that are not positive are then left out.
    pub logarithmic: bool,
    /// Whether only whole numbers are meaningful on this axis.
    pub integers: bool,
    /// Whether tick labels and the axis label are drawn; false where a panel below repeats them.
    pub labelled: bool,
    /// Fixed limits; `None` takes them from the data.
    pub limits: Option<(f64, f64)>,
    /// Ticks at given places with given texts; empty for automatic ones.
    pub named_ticks: Vec<(f64, String)>,
}

impl Axis {
    /// A linear axis for a dimensionless quantity, with limits taken from the data.
    pub fn new(label: impl Into<String>) -> Axis {
        Axis {
            label: label.into(),
            unit: String::new(),
            logarithmic: false,
            integers: false,
            labelled: true,
            limits: None,
            named_ticks: Vec::new(),
        }
    }

    /// Sets the unit.
    #[must_use]
    pub fn unit(mut self, unit: impl Into<String>) -> Axis {
        self.unit = unit.into();
        self
    }

    /// Makes the axis logarithmic.
    #[must_use]
    pub fn log(mut self) -> Axis {
        self.logarithmic = true;
        self
    }

    /// Restricts ticks to whole numbers.
    #[must_use]
    pub fn integers(mut self) -> Axis {
        self.integers = true;
        self
    }

    /// Leaves out tick labels and axis label.
    #[must_use]
    pub fn unlabelled(mut self) -> Axis {
        self.labelled = false;
        self
    }

    /// Fixes the limits.
    #[must_use]
    pub fn limits(mut self, low: f64, high: f64) -> Axis {
        self.limits = Some((low, high));
        self
    }

    /// Sets ticks at given places with given texts.
    #[must_use]
    pub fn ticks_at(mut self, ticks: impl IntoIterator<Item = (f64, String)>) -> Axis {
        self.named_ticks = ticks.into_iter().collect();
        self
    }
}

/// The ticks that the axis names, or the automatic ones with their exponent.
pub(super) fn named_or(axis: &Axis, automatic: (Vec<Tick>, i32)) -> (Vec<Tick>, i32) {
    if axis.named_ticks.is_empty() { automatic } else { (axis.named_ticks.clone(), 0) }
}

/// Whether a value can be drawn on an axis; the largest doubles would overflow a difference.
pub(super) fn drawable(value: f64, logarithmic: bool) -> bool {
    value.abs() < 1e300 && (!logarithmic || value > 1e-300)
}

/// An axis with its final limits, in the measure of the axis (the logarithm, if logarithmic).
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Scale {
    low: f64,
    high: f64,
    logarithmic: bool,
    integers: bool,
    /// Whether the power of ten becomes an SI prefix of the unit.
    prefixed: bool,
}

/// A tick: place in the axis's own measure and text, empty for a minor tick.
pub(super) type Tick = (f64, String);

impl Scale {
    /// Limits from the axis or else from the data's extent (`None`: no data). `pad` is the
    /// fraction of the extent left free at either end; `flush` lets an axis of values that are
    /// never negative begin at zero rather than below.
    pub(super) fn new(axis: &Axis, extent: Option<(f64, f64)>, pad: f64, flush: bool) -> Scale {
        let measure = |v: f64| if axis.logarithmic { v.log10() } else { v };
        let usable = |v: &(f64, f64)| drawable(v.0, axis.logarithmic) && drawable(v.1, axis.logarithmic) && (v.0 < v.1);
        let (mut low, mut high) = match (axis.limits.filter(usable), extent) {
            (Some((low, high)), _) => (measure(low), measure(high)),
            (None, Some((low, high))) => {
                let (low, high) = (measure(low), measure(high));
                let margin = pad * (high - low);
                let floor = if flush && !axis.logarithmic && low >= 0.0 { 0.0 } else { f64::NEG_INFINITY };
                ((low - margin).max(floor), high + margin)
            }
            (None, None) => (0.0, 1.0),
        };
        // a width below the digits of a double cannot be divided into ticks
        let least = 1e-9 * low.abs().max(high.abs()).max(1e-290);
        if high - low < least {
            let half = if low == 0.0 && high == 0.0 { 1.0 } else { 0.1 * low.abs().max(high.abs()).max(1e-280) };
            let half = if axis.logarithmic { half.max(0.5) } else { half };
            (low, high) = (low - half, high + half);
        }
        Scale {
            low,
            high,
            logarithmic: axis.logarithmic,
            integers: axis.integers,
            prefixed: prefix(&axis.unit, 3).is_some(),
        }
    }

    /// Place of a value along the axis: 0 at the low end, 1 at the high end.
    pub(super) fn fraction(&self, value: f64) -> f64 {
        self.fraction_of_measure(if self.logarithmic { value.log10() } else { value })
    }

    /// Same, for a place in the axis's own measure.
    pub(super) fn fraction_of_measure(&self, measure: f64) -> f64 {
        (measure - self.low) / (self.high - self.low)
    }

    /// Ticks for a horizontal axis of this length, as many as fit beside each other.
    pub(super) fn ticks_along(&self, length_px: f64, size_px: f64) -> (Vec<Tick>, i32) {
        let room = |count: usize| {
            let (ticks, exponent) = self.ticks(count);
            let labels = ticks.iter().filter(|t| !t.1.is_empty());
            let widest = labels.clone().map(|t| width_px(&t.1, size_px)).fold(0.0, f64::max);
            let fits = labels.count() as f64 * (widest + 1.2 * size_px) <= length_px + widest;
            fits.then_some((ticks, exponent))
        };
        (2..=8).rev().find_map(room).unwrap_or_else(|| self.ticks(1))
    }

    /// Ticks for a vertical axis of this height.
    pub(super) fn ticks_up(&self, height_px: f64, size_px: f64) -> (Vec<Tick>, i32) {
        self.ticks(((height_px / (2.6 * size_px)) as usize).clamp(1, 8))
    }

    /// At most about `count` labelled ticks, and the power of ten by which labels are divided.
    fn ticks(&self, count: usize) -> (Vec<Tick>, i32) {
        if !self.logarithmic {
            return self.linear_ticks(count);
        }
        let ticks = self.log_ticks(count);
        // a part of a decade too short for two logarithmic ticks has those of a linear axis
        if count < 2 || ticks.iter().filter(|tick| !tick.1.is_empty()).count() > 1 {
            return (ticks, 0);
        }
        let linear = Scale { low: 10f64.powf(self.low), high: 10f64.powf(self.high), logarithmic: false, ..*self };
        let (ticks, exponent) = linear.linear_ticks(count.min(4));
        let positive = ticks.into_iter().filter(|tick| tick.0 > 0.0);
        (positive.map(|(value, text)| (value.log10(), text)).collect(), exponent)
    }

    fn linear_ticks(&self, count: usize) -> (Vec<Tick>, i32) {
        let raw = (self.high - self.low) / count.max(1) as f64;
        let mut power = raw.log10().floor() as i32;
        let mut digit = match raw / 10f64.powi(power) {
            r if r <= 1.25 => 1.0,
            r if r <= 2.5 => 2.0,
            r if r <= 6.0 => 5.0,
            _ => {
                power += 1;
                1.0
            }
        };
        if self.integers && power < 0 {
            (power, digit) = (0, 1.0);
        }
        let step = digit * 10f64.powi(power);
        let largest = self.low.abs().max(self.high.abs()).log10().floor() as i32;
        let plain = if self.prefixed { -1..3 } else { -2..5 };
        let exponent = if plain.contains(&largest) { 0 } else { 3 * largest.div_euclid(3) };
        let decimals = (exponent - power).clamp(0, 12) as usize;
        let first = (self.low / step - 1e-6).ceil();
        let last = (self.high / step + 1e-6).floor();
        let places = (0..=((last - first).clamp(0.0, 50.0) as usize)).map(|i| (first + i as f64) * step);
        let ticks = places.map(|v| (v, fixed(v / 10f64.powi(exponent), decimals))).collect();
        (ticks, exponent)
    }

    fn log_ticks(&self, count: usize) -> Vec<Tick> {
        let (first, last) = ((self.low - 1e-6).ceil() as i32, (self.high + 1e-6).floor() as i32);
        let stride = (last - first) / (count.max(1) as i32) + 1;
        let few = last - first < 2;
        let plain = last - first <= 4 && first >= -3 && last <= 4;
        let mut ticks = Vec::new();
        for decade in first - 1..=last {
            for digit in 1..10 {
                let place = f64::from(decade) + f64::from(digit).log10();
                let labelled = match digit {
                    1 => decade.rem_euclid(stride) == 0,
                    2 | 5 => few && count >= 3,
                    _ => false,
                };
                // small ticks are omitted if decades are skipped
                let drawn = labelled || digit == 1 || stride == 1;
                if place >= self.low - 1e-9 && place <= self.high + 1e-9 && drawn {
                    ticks.push((place, if labelled { log_label(decade, digit, plain) } else { String::new() }));
                }
            }
        }
        ticks
    }
}

fn log_label(decade: i32, digit: i32, plain: bool) -> String {
    match (plain, digit) {
        (true, _) => fixed(f64::from(digit) * 10f64.powi(decade), (-decade).max(0) as usize),
        (false, 1) => format!("10{}", superscript(decade)),
        (false, _) => format!("{digit}×10{}", superscript(decade)),
    }
}

/// Units that can have an SI prefix.
const PREFIXABLE: [&str; 11] = ["s", "m", "N", "J", "W", "Pa", "Hz", "m/s", "N/m", "m/N", "N s"];
/// SI prefixes of the powers of a thousand from 10^-18.
const PREFIXES: [&str; 13] = ["a", "f", "p", "n", "µ", "m", "", "k", "M", "G", "T", "P", "E"];

/// The prefix of a unit for a power of ten, if there is one.
fn prefix(unit: &str, exponent: i32) -> Option<&'static str> {
    let place = usize::try_from(exponent.div_euclid(3) + 6).ok()?;
    PREFIXES.get(place).copied().filter(|_| exponent % 3 == 0 && PREFIXABLE.contains(&unit))
}

/// Axis label with its unit and the power of ten taken out of the tick labels: as a prefix, or before the unit.
pub(super) fn full_label(axis: &Axis, exponent: i32) -> String {
    let scale = match prefix(&axis.unit, exponent) {
        Some(prefix) => format!("{prefix}{}", axis.unit),
        None if exponent == 0 => axis.unit.clone(),
        None => format!("10{} {}", superscript(exponent), axis.unit).trim_end().to_owned(),
    };
    match (axis.label.is_empty(), scale.is_empty()) {
        (_, true) => axis.label.clone(),
        (true, false) => format!("({scale})"),
        (false, false) => format!("{} ({scale})", axis.label),
    }
}
