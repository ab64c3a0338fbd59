//! The figure of a branch: frequency response or bifurcation diagram, with stable and unstable parts.

use super::summary::{BranchOrbit, BranchSummary};
use crate::plot::{Axis, Colour, Figure, Marker, Panel, Series};

/// Amplitude and range of motion of the moving sides over the field, and the size of the largest multiplier.
pub fn picture(title: &str, branch: &BranchSummary) -> Figure {
    let values = || branch.orbits.iter().map(|orbit| orbit.value);
    let (low, high) = (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max));
    // the panels share their abscissa
    let axis = || {
        let axis = Axis::new(branch.field.as_str());
        if low < high { axis.limits(low, high) } else { axis }
    };
    let mut amplitude = Panel::new(axis().unlabelled(), Axis::new("first harmonic").unit("m")).height(170.0);
    let mut range = Panel::new(axis().unlabelled(), Axis::new("largest and least").unit("m")).height(170.0);
    let mut size = Panel::new(axis(), Axis::new("largest multiplier")).height(110.0);
    let points = branch.orbits.first().map_or(0, |first| first.orbit.points.len());
    let moving = (0..points).filter(|&i| {
        branch
            .orbits
            .iter()
            .any(|orbit| orbit.orbit.points[i].displacement_max_m != orbit.orbit.points[i].displacement_min_m)
    });
    for (number, i) in moving.enumerate() {
        let colour = Colour::of_series(number);
        let point = &branch.orbits[0].orbit.points[i];
        let name = format!("{}, side {}", point.contact, point.side);
        for (first, (part, stable)) in parts(&branch.orbits).into_iter().enumerate() {
            let x: Vec<f64> = part.iter().map(|orbit| orbit.value).collect();
            let of = |value: fn(&super::PointMotion) -> f64| -> Vec<f64> {
                part.iter().map(|orbit| value(&orbit.orbit.points[i])).collect()
            };
            let draw = |y: Vec<f64>| {
                let line = Series::line(&x, &y).colour(colour);
                if stable { line } else { line.dashed() }
            };
            let line = draw(of(|point| point.displacement_first_harmonic_m));
            amplitude = amplitude.with(if first == 0 { line.label(&name) } else { line });
            range = range.with(draw(of(|point| point.displacement_max_m)));
            range = range.with(draw(of(|point| point.displacement_min_m)));
        }
    }
    let x: Vec<f64> = branch.orbits.iter().map(|orbit| orbit.value).collect();
    let largest = |orbit: &BranchOrbit| orbit.orbit.floquet_multipliers.first().map_or(0.0, |m| m[0].hypot(m[1]));
    let y: Vec<f64> = branch.orbits.iter().map(largest).collect();
    size = size.with(Series::line(&x, &y)).with(Series::horizontal_rule(1.0));
    let at: Vec<f64> = branch.special_points.iter().map(|point| point.value).collect();
    let one = vec![1.0; at.len()];
    let names: Vec<String> = branch.special_points.iter().map(|point| point.kind.to_owned()).collect();
    size = size.with(Series::points(&at, &one, Marker::Dot)).with(Series::labels(&at, &one, names));
    Figure::new(title).row([amplitude]).row([range]).row([size])
}

/// Sections of a branch that are entirely stable or unstable; neighbours share an orbit, so that no gap is drawn.
fn parts(orbits: &[BranchOrbit]) -> Vec<(&[BranchOrbit], bool)> {
    let mut parts = Vec::new();
    let mut from = 0;
    for i in 1..=orbits.len() {
        if i == orbits.len() || orbits[i].orbit.stable != orbits[from].orbit.stable {
            parts.push((&orbits[from..(i + 1).min(orbits.len())], orbits[from].orbit.stable));
            from = i;
        }
    }
    parts
}
