//! Description of the combinations of parameters that the data do not determine.

use fitting::{Direction, Information, Parameter, Range};

use super::summary::Undetermined;
use crate::text::significant;

/// Largest standard deviation of the coordinates, mostly logarithms, along a direction that counts as determined.
const OPEN: f64 = 0.5;
/// A direction with at least this share of one parameter is described by this parameter alone.
const ALONE: f64 = 0.95;
/// Entries of a direction below this value are not mentioned.
const TOLD: f64 = 0.1;
/// The relative change of the first parameter in an example.
const EXAMPLE: f64 = 0.1;
/// Largest change of a coordinate in an example.
const FURTHEST: f64 = 300.0;

/// The combinations that are not determined, the worst first.
pub(super) fn undetermined(information: &Information, coordinates: &[Parameter], values: &[f64]) -> Vec<Undetermined> {
    let open = |direction: &Direction| direction.standard_deviation > OPEN;
    let told = |direction: Direction| {
        let entries = direction.vector.iter().zip(coordinates).filter(|(entry, _)| entry.abs() >= TOLD);
        Undetermined {
            direction: entries.map(|(entry, coordinate)| (coordinate.name.clone(), *entry)).collect(),
            standard_deviation: Some(direction.standard_deviation).filter(|sd| sd.is_finite()),
            text: words(&direction, coordinates, values),
        }
    };
    information.directions().into_iter().filter(open).map(told).collect()
}

fn words(direction: &Direction, coordinates: &[Parameter], values: &[f64]) -> String {
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

    #[test]
    fn a_product_is_told_as_one() {
        // two readings, accurate to 1 %, of the product of two parameters
        let information = Information::of(&[100.0, 100.0, 100.0, 100.0], 2).unwrap();
        let found = undetermined(&information, &["a", "b"].map(positive), &[1.0, 1.0]);
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
        let found = undetermined(&information, &["a", "b"].map(positive), &[1.0, 1.0]);
        assert_eq!(found[0].text, "The data contain no information about b.");
    }

    #[test]
    fn a_parameter_between_limits_is_told_by_its_values() {
        let between = |low: f64, high: f64| Parameter {
            range: fitting::Range::Between { low, high },
            ..Parameter::free("c", 0.5, (0.1, 0.9))
        };
        // logistic coordinates: from 0.5 by one standard deviation of 2 to 1/(1 + e^-2)
        let weak = Information::of(&[0.5], 1).unwrap();
        let found = undetermined(&weak, &[between(0.0, 1.0)], &[0.5]);
        assert!(found[0].text.ends_with("one standard deviation either way is 0.119 to 0.881."), "{}", found[0].text);
        let sum = Information::of(&[100.0, 100.0, 100.0, 100.0, 100.0, 100.0], 3).unwrap();
        let coordinates = [between(-1.0, 1.0), positive("a"), positive("b")];
        for one in undetermined(&sum, &coordinates, &[0.0, 1.0, 1.0]) {
            assert!(one.text.starts_with("The data leave a combination open: "), "{}", one.text);
            assert_eq!(one.text.contains("c from 0"), one.direction.contains_key("c"), "{}", one.text);
        }
    }

    fn positive(name: &str) -> Parameter {
        Parameter::positive(name, 1.0, (0.1, 10.0))
    }
}
