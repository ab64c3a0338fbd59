//! Description of the combinations of parameters that the data do not determine, and of those that they do.

use fitting::{Direction, Information, Parameter, Range};

use super::summary::{Combination, Undetermined};
use crate::text::significant;

/// Largest standard deviation of the coordinates, mostly logarithms, along a direction that counts as determined.
const OPEN: f64 = 0.5;
/// A direction with at least this share of one parameter is described by this parameter alone.
const ALONE: f64 = 0.95;
/// Entries of a direction below this value are not mentioned.
const TOLD: f64 = 0.1;
/// Exponents below this value are rounding.
const NO_POWER: f64 = 1e-4;
/// The relative change of the first parameter in an example.
const EXAMPLE: f64 = 0.1;
/// Largest change of a coordinate in an example.
const FURTHEST: f64 = 300.0;

/// The combinations that are not determined, the worst first. `ends` are those of the profiles.
pub(super) fn undetermined(
    information: &Information,
    coordinates: &[Parameter],
    values: &[f64],
    ends: &[[Option<f64>; 2]],
) -> Vec<Undetermined> {
    let open = |direction: &Direction| direction.standard_deviation > OPEN;
    let told = |direction: Direction| {
        let entries = direction.vector.iter().zip(coordinates).filter(|(entry, _)| entry.abs() >= TOLD);
        Undetermined {
            direction: entries.map(|(entry, coordinate)| (coordinate.name.clone(), *entry)).collect(),
            standard_deviation: Some(direction.standard_deviation).filter(|sd| sd.is_finite()),
            text: words(&direction, coordinates, values, ends),
        }
    };
    information.directions().into_iter().filter(open).map(told).collect()
}

/// The products of powers of these parameters that the data determine, although they leave other combinations of them open.
/// `z` holds the quantiles of the parameters.
pub(super) fn combinations(
    information: &Information,
    coordinates: &[Parameter],
    values: &[f64],
    members: &[usize],
    z: &[f64],
) -> Vec<Combination> {
    let known = |direction: &Direction| direction.standard_deviation <= OPEN;
    let told = |direction: Direction| {
        let lead = direction.vector.iter().copied().fold(0.0, f64::max);
        let powers: Vec<(usize, f64)> = members.iter().zip(&direction.vector).map(|(j, v)| (*j, v / lead)).collect();
        let powers: Vec<(usize, f64)> = powers.into_iter().filter(|(_, power)| power.abs() >= NO_POWER).collect();
        // other coordinates than logarithms make no product
        if powers.len() < 2 || powers.iter().any(|(j, _)| coordinates[*j].range != Range::Positive) {
            return None;
        }
        let logarithm: f64 = powers.iter().map(|(j, power)| power * values[*j].ln()).sum();
        let quantile = powers.iter().map(|(j, _)| z[*j]).fold(0.0, f64::max);
        let half = quantile * direction.standard_deviation / lead;
        let named = |(j, power): &(usize, f64)| (coordinates[*j].name.clone(), *power);
        Some(Combination {
            product: product(coordinates, &powers),
            exponents: powers.iter().map(named).collect(),
            value: logarithm.exp(),
            interval: [-half, half].map(|by| (logarithm + by).exp()),
        })
    };
    let directions = information.about(members).map_or_else(Vec::new, |found| found.directions());
    directions.into_iter().filter(known).filter_map(told).collect()
}

/// A product of powers, the positive ones first.
fn product(coordinates: &[Parameter], powers: &[(usize, f64)]) -> String {
    let factor = |(j, power): &(usize, f64)| match significant(power.abs(), 4).as_str() {
        "1" => coordinates[*j].name.clone(),
        power => format!("{}^{power}", coordinates[*j].name),
    };
    let of_sign = |positive: bool| powers.iter().filter(move |(_, power)| (*power > 0.0) == positive).map(factor);
    let over: String = of_sign(false).map(|factor| format!(" / {factor}")).collect();
    of_sign(true).collect::<Vec<_>>().join(" · ") + &over
}

fn words(direction: &Direction, coordinates: &[Parameter], values: &[f64], ends: &[[Option<f64>; 2]]) -> String {
    let lone = (0..coordinates.len()).find(|j| direction.vector[*j].powi(2) >= ALONE);
    // without information where the search stopped, there may be some further away
    let limit = |kind: &str, j: usize| format!("The data determine only {kind} limit of {}.", coordinates[j].name);
    match lone.map(|j| (j, ends[j])) {
        Some((j, [None, Some(_)])) => return limit("an upper", j),
        Some((j, [Some(_), None])) => return limit("a lower", j),
        _ => {}
    }
    let mut parts: Vec<(f64, &Parameter, f64)> = direction
        .vector
        .iter()
        .zip(coordinates)
        .zip(values)
        .map(|((entry, coordinate), value)| (*entry, coordinate, *value))
        .filter(|(entry, ..)| entry.abs() >= TOLD)
        .collect();
    parts.sort_by(|a, b| b.0.abs().total_cmp(&a.0.abs()));
    let Some(&(lead, first, value)) = parts.first() else { return String::new() };
    let moved = |parameter: &Parameter, value: f64, by: f64| parameter.outward(parameter.inward(value) + by);
    let sd = direction.standard_deviation;
    if lead * lead >= ALONE {
        let name = &first.name;
        return match first.range {
            _ if sd.is_infinite() => format!("The data contain no information about {name}."),
            Range::Positive => {
                let factor = significant(sd.min(FURTHEST).exp(), 2);
                format!("The data do not determine {name}: its standard deviation is a factor of {factor}.")
            }
            _ => {
                let [low, high] =
                    [-sd, sd].map(|by| significant(moved(first, value, by.clamp(-FURTHEST, FURTHEST)), 3));
                format!("The data do not determine {name}: one standard deviation either way is {low} to {high}.")
            }
        };
    }
    // along the direction, so that the first parameter changes by 10 % if its coordinate is the logarithm
    let along = EXAMPLE.ln_1p() / lead;
    let change = |(entry, parameter, value): &(f64, &Parameter, f64)| {
        let by = entry * along;
        let verb = if by < 0.0 { "lowering" } else { "raising" };
        let name = &parameter.name;
        match parameter.range {
            Range::Positive => format!("{verb} {name} by {} %", significant(100.0 * by.exp_m1().abs(), 2)),
            _ => {
                let [from, to] = [*value, moved(parameter, *value, by)].map(|value| significant(value, 3));
                format!("{verb} {name} from {from} to {to}")
            }
        }
    };
    let mut changes: Vec<String> = parts.iter().map(change).collect();
    let last = changes.pop().unwrap_or_default();
    let effect = if sd.is_infinite() {
        "leaves all predictions as they are".to_owned()
    } else {
        format!("changes all predictions together by {} of their noise", significant(along.abs() / sd, 1))
    };
    format!("The data leave a combination open: {} and {last} {effect}.", changes.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    const OPEN_ENDS: [[Option<f64>; 2]; 3] = [[None; 2]; 3];

    #[test]
    fn a_product_is_told_as_one() {
        // two readings, accurate to 1 %, of the product of two parameters
        let information = Information::of(&[100.0, 100.0, 100.0, 100.0], 2).unwrap();
        let found = undetermined(&information, &["a", "b"].map(positive), &[1.0, 1.0], &OPEN_ENDS);
        assert_eq!(found.len(), 1);
        assert!(
            found[0].text.contains("raising a by 10 % and lowering b by 9.1 %")
                || found[0].text.contains("raising b by 10 %")
        );
        assert!(found[0].text.ends_with("leaves all predictions as they are."), "{}", found[0].text);
        assert_eq!(found[0].standard_deviation, None);
    }

    #[test]
    fn a_parameter_without_effect_is_named() {
        let information = Information::of(&[100.0, 0.0], 2).unwrap();
        let found = undetermined(&information, &["a", "b"].map(positive), &[1.0, 1.0], &OPEN_ENDS);
        assert_eq!(found[0].text, "The data contain no information about b.");
        for (ends, kind) in [([None, Some(2.0)], "an upper"), ([Some(0.1), None], "a lower")] {
            let ends = [[Some(0.9), Some(1.1)], ends];
            let found = undetermined(&information, &["a", "b"].map(positive), &[1.0, 1.0], &ends);
            assert_eq!(found[0].text, format!("The data determine only {kind} limit of b."));
        }
    }

    #[test]
    fn a_parameter_between_limits_is_told_by_its_values() {
        let between = |low: f64, high: f64| Parameter {
            range: fitting::Range::Between { low, high },
            ..Parameter::free("c", 0.5, (0.1, 0.9))
        };
        // logistic coordinates: from 0.5 by one standard deviation of 2 to 1/(1 + e^-2)
        let weak = Information::of(&[0.5], 1).unwrap();
        let found = undetermined(&weak, &[between(0.0, 1.0)], &[0.5], &OPEN_ENDS);
        assert!(found[0].text.ends_with("one standard deviation either way is 0.119 to 0.881."), "{}", found[0].text);
        let sum = Information::of(&[100.0, 100.0, 100.0, 100.0, 100.0, 100.0], 3).unwrap();
        let coordinates = [between(-1.0, 1.0), positive("a"), positive("b")];
        for one in undetermined(&sum, &coordinates, &[0.0, 1.0, 1.0], &OPEN_ENDS) {
            assert!(one.text.starts_with("The data leave a combination open: "), "{}", one.text);
            assert_eq!(one.text.contains("c from 0"), one.direction.contains_key("c"), "{}", one.text);
        }
    }

    /// Two readings of the ratio of `a` and `b`, accurate to 1 %, of which one contains an unknown factor `c^2` as well.
    #[test]
    fn a_ratio_is_determined_without_the_other_parameters() {
        let information = Information::of(&[100.0, -100.0, 0.0, 100.0, -100.0, 200.0], 3).unwrap();
        let coordinates = ["a", "b", "c"].map(positive);
        let found = combinations(&information, &coordinates, &[6.0, 2.0, 5.0], &[0, 1], &[2.0, 3.0, 9.0]);
        assert_eq!(found.len(), 1);
        let one = &found[0];
        assert!(one.product == "a / b" || one.product == "b / a", "{}", one.product);
        let ratio = if one.product == "a / b" { 3.0 } else { 1.0 / 3.0 };
        assert!((one.value / ratio - 1.0).abs() < 1e-9, "{}", one.value);
        // the first reading alone, by the larger of the two quantiles
        for (end, sign) in one.interval.into_iter().zip([-1.0, 1.0]) {
            assert!(((end / one.value).ln() - sign * 3.0 * 0.01).abs() < 1e-9, "{end}");
        }
        assert!(combinations(&information, &coordinates, &[6.0, 2.0, 5.0], &[0], &[2.0, 3.0, 9.0]).is_empty());
    }

    #[test]
    fn products_are_written_with_their_powers() {
        let coordinates = ["a", "b", "c"].map(positive);
        let written = product(&coordinates, &[(0, 1.0), (1, -0.500_001), (2, 0.25)]);
        assert_eq!(written, "a · c^0.25 / b^0.5");
    }

    fn positive(name: &str) -> Parameter {
        Parameter::positive(name, 1.0, (0.1, 10.0))
    }
}
