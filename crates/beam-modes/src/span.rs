//! The dimensionless chain of uniform spans that beams and rods share.
//!
//! Lengths are measured in the total length, rigidity and mass per length in those of the first segment.

use crate::error::InvalidInput;

/// One uniform stretch, dimensionless.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Span {
    /// Where it starts.
    pub start: f64,
    pub length: f64,
    /// `EI` or `EA`.
    pub rigidity: f64,
    /// Mass per length.
    pub mass: f64,
}

/// What turns dimensionless results back to SI.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Units {
    pub length_m: f64,
    /// `EI` (N m^2) or `EA` (N) of the first segment.
    pub rigidity: f64,
    pub mass_per_length_kg_m: f64,
}

/// Largest ratio between the segments' lengths, rigidities or masses per length.
const MAX_CONTRAST: f64 = 1e12;
const CONTRAST: &str = "within a factor 1e12 of the same property of every other segment";
const SCALE: &str = "between 1e-60 and 1e60";

/// Checks raw segments `[length, rigidity, mass per length]` and makes them dimensionless.
///
/// Equal neighbours are merged: a uniform beam is one span, however it was cut.
pub(crate) fn nondimensional(raw: &[[f64; 3]], names: [&str; 3]) -> Result<(Vec<Span>, Units), InvalidInput> {
    let Some(first) = raw.first() else {
        return Err(InvalidInput::new("segments", "[]", "at least one segment"));
    };
    for (property, name) in names.iter().enumerate() {
        let (mut low, mut high) = (first[property], first[property]);
        for (i, segment) in raw.iter().enumerate() {
            let value = InvalidInput::require_positive(format!("segments[{i}].{name}"), segment[property])?;
            if !(1e-60..=1e60).contains(&value) {
                return Err(InvalidInput::new(format!("segments[{i}].{name}"), value, SCALE));
            }
            (low, high) = (low.min(value), high.max(value));
            if high / low > MAX_CONTRAST {
                return Err(InvalidInput::new(format!("segments[{i}].{name}"), value, CONTRAST));
            }
        }
    }
    let length_m: f64 = raw.iter().map(|s| s[0]).sum();
    let mut spans: Vec<Span> = Vec::with_capacity(raw.len());
    let mut start_m = 0.0;
    let mut i = 0;
    while i < raw.len() {
        let run = raw[i..].iter().take_while(|s| s[1..] == raw[i][1..]).count();
        let run_m: f64 = raw[i..i + run].iter().map(|s| s[0]).sum();
        spans.push(Span {
            start: start_m / length_m,
            length: run_m / length_m,
            rigidity: raw[i][1] / first[1],
            mass: raw[i][2] / first[2],
        });
        start_m += run_m;
        i += run;
    }
    Ok((spans, Units { length_m, rigidity: first[1], mass_per_length_kg_m: first[2] }))
}

/// The span that contains the dimensionless place `x`, and the place within it.
pub(crate) fn locate(spans: &[Span], x: f64) -> (usize, f64) {
    let i = spans.partition_point(|span| span.start <= x).saturating_sub(1);
    (i, (x - spans[i].start).clamp(0.0, spans[i].length))
}
