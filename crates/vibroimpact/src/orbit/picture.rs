//! The figure of a branch: frequency response and bifurcation diagram, with stable and unstable parts.

use vibroimpact_sim::assembly::Special;

use super::PointMotion;
use super::summary::{BranchOrbit, BranchPart, BranchSummary, OrbitSummary};
use crate::plot::{Axis, Colour, Figure, Marker, Panel, Series};

/// Largest number of sides that are drawn, one for each colour.
const DRAWN: usize = 6;

/// Over the field: amplitude of the moving sides, their displacement once in each period of the loads (the bifurcation diagram),
/// their range of motion, and the size of the largest multiplier.
pub fn picture(title: &str, branch: &BranchSummary) -> Figure {
    let values = || orbits(branch).map(|orbit| orbit.value);
    let (low, high) = (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max));
    // the panels share their abscissa
    let axis = || {
        let axis = Axis::new(branch.field.as_str());
        if low < high { axis.limits(low, high) } else { axis }
    };
    let panel = |label: &str| Panel::new(axis().unlabelled(), Axis::new(label).unit("m"));
    let mut amplitude = panel("first harmonic").height(170.0);
    let mut section = panel("once in each period").height(170.0);
    let mut range = panel("largest and least").height(150.0);
    let mut size = Panel::new(axis(), Axis::new("largest multiplier").log()).height(110.0);
    let (drawn, moving) = drawn_sides(branch);
    for (number, &i) in drawn.iter().enumerate() {
        let colour = Colour::of_series(number);
        let mut name = side_name(branch, i);
        for part in branch.all() {
            for (motions, stable) in stretches(part) {
                let curve = |of: &dyn Fn(&PointMotion) -> f64| {
                    let (x, y): (Vec<f64>, Vec<f64>) =
                        motions.iter().map(|(value, motion)| (*value, of(&motion.points[i]))).unzip();
                    let line = Series::line(&x, &y).colour(colour);
                    if stable { line } else { line.dashed() }
                };
                // the first stretch has the entry of the legend
                let response = curve(&|point| point.displacement_first_harmonic_m).label(std::mem::take(&mut name));
                amplitude = amplitude.with(response);
                for period in 0..motions[0].1.forcing_periods as usize {
                    let at =
                        |point: &PointMotion| point.displacement_section_m.get(period).copied().unwrap_or(f64::NAN);
                    section = section.with(curve(&at));
                }
                range = range.with(curve(&|point| point.displacement_max_m));
                range = range.with(curve(&|point| point.displacement_min_m));
            }
        }
    }
    for part in branch.all() {
        let points = part.orbits.iter().map(|orbit| (orbit.value, orbit.orbit.largest_multiplier()));
        let (x, y): (Vec<f64>, Vec<f64>) = points.unzip();
        size = size.with(Series::line(&x, &y).colour(Colour::Blue));
    }
    size = size.with(Series::horizontal_rule(1.0));
    for (kind, marker) in [
        (Special::Fold, Marker::Square),
        (Special::Pitchfork, Marker::Plus),
        (Special::PeriodDoubling, Marker::Triangle),
        (Special::NeimarkSacker, Marker::Cross),
        (Special::Grazing, Marker::Circle),
    ] {
        let found = || branch.all().flat_map(|part| &part.special_points).filter(|at| at.kind == kind.as_str());
        if found().next().is_none() {
            continue;
        }
        let marks = |of: &dyn Fn(&OrbitSummary) -> Vec<f64>| {
            let at = found().flat_map(|point| of(&point.orbit).into_iter().map(|y| (point.value, y)));
            let (x, y): (Vec<f64>, Vec<f64>) = at.unzip();
            Series::points(&x, &y, marker).colour(Colour::Black)
        };
        let of_sides = |of: fn(&PointMotion) -> Vec<f64>| {
            marks(&|orbit| drawn.iter().flat_map(|&i| of(&orbit.points[i])).collect())
        };
        let response = of_sides(|point| vec![point.displacement_first_harmonic_m]);
        amplitude = amplitude.with(response.label(kind.as_str()));
        section = section.with(of_sides(|point| point.displacement_section_m.clone()));
        range = range.with(of_sides(|point| vec![point.displacement_max_m, point.displacement_min_m]));
        size = size.with(marks(&|orbit| vec![orbit.largest_multiplier()]));
    }
    let mut lines = vec![title.to_owned()];
    if moving > drawn.len() {
        lines.push(format!("the {DRAWN} of {moving} moving sides with the largest motion"));
    }
    if orbits(branch).any(|orbit| !orbit.orbit.stable) {
        lines.push("dashed: unstable motion".to_owned());
    }
    Figure::new(lines.join("\n")).row([amplitude]).row([section]).row([range]).row([size])
}

fn orbits(branch: &BranchSummary) -> impl Iterator<Item = &BranchOrbit> {
    branch.all().flat_map(|part| &part.orbits)
}

fn side_name(branch: &BranchSummary, i: usize) -> String {
    let point = branch.main.orbits.first().map(|first| &first.orbit.points[i]);
    point.map_or_else(String::new, |point| format!("{}, side {}", point.contact, point.side))
}

/// The numbers of the sides that are drawn, and how many move. Sides that move alike, such as those of the two contacts of a
/// two-sided stop, are drawn once.
fn drawn_sides(branch: &BranchSummary) -> (Vec<usize>, usize) {
    let points = branch.main.orbits.first().map_or(0, |first| first.orbit.points.len());
    let motion = |i: usize| -> Vec<[f64; 3]> {
        let of = |point: &PointMotion| {
            [point.displacement_first_harmonic_m, point.displacement_max_m, point.displacement_min_m]
        };
        orbits(branch).map(|orbit| of(&orbit.orbit.points[i])).collect()
    };
    let mut moving: Vec<(usize, Vec<[f64; 3]>)> = Vec::new();
    for i in 0..points {
        let motion = motion(i);
        if motion.iter().any(|[_, max, min]| max != min) && moving.iter().all(|(_, other)| *other != motion) {
            moving.push((i, motion));
        }
    }
    let count = moving.len();
    let largest = |motion: &[[f64; 3]]| motion.iter().map(|[_, max, min]| max - min).fold(0.0, f64::max);
    moving.sort_by(|(_, one), (_, other)| largest(other).total_cmp(&largest(one)));
    moving.truncate(DRAWN);
    let mut drawn: Vec<usize> = moving.into_iter().map(|(i, _)| i).collect();
    drawn.sort_unstable();
    (drawn, count)
}

/// Stretches of a branch that are entirely stable or unstable: the motions over the field, special points included. Neighbours share
/// the special point between them, or else an orbit, so that no gap is drawn.
fn stretches(branch: &BranchPart) -> Vec<(Vec<(f64, &OrbitSummary)>, bool)> {
    let mut stretches = Vec::new();
    let mut here: Vec<(f64, &OrbitSummary)> = Vec::new();
    for (i, orbit) in branch.orbits.iter().enumerate() {
        let between = branch.special_points.iter().filter(|point| point.before_orbit == i);
        here.extend(between.map(|point| (point.value, &point.orbit)));
        let before = branch.orbits[i.saturating_sub(1)].orbit.stable;
        if orbit.orbit.stable != before {
            let last = here.last().copied();
            stretches.push((std::mem::take(&mut here), before));
            here.extend(last);
        }
        here.push((orbit.value, &orbit.orbit));
    }
    if let Some(last) = branch.orbits.last() {
        stretches.push((here, last.orbit.stable));
    }
    stretches
}
