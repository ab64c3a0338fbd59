//! Description of the combinations of parameters that the data do not determine.

use std::collections::BTreeMap;

use fitting::{Direction, Information};

use super::summary::Undetermined;
use crate::text::significant;

/// Largest standard deviation of the coordinates, mostly logarithms, along a direction that counts as determined.
const OPEN: f64 = 0.5;
/// A direction with at least this share of one parameter is described by this parameter alone.
const ALONE: f64 = 0.95;
/// Entries of a direction below this value are not mentioned.
const TOLD: f64 = 0.1;
/// The change of the first parameter in an example.
const EXAMPLE: f64 = 0.1;

/// The combinations that are not determined, the worst first.
pub(super) fn undetermined(information: &Information, fields: &[String]) -> Vec<Undetermined> {
    let open = |direction: &Direction| direction.standard_deviation > OPEN;
    let told = |direction: Direction| {
        let entries = direction.vector.iter().zip(fields).filter(|(entry, _)| entry.abs() >= TOLD);
        Undetermined {
            direction: entries.map(|(entry, field)| (field.clone(), *entry)).collect::<BTreeMap<_, _>>(),
            standard_deviation: Some(direction.standard_deviation).filter(|sd| sd.is_finite()),
            text: words(&direction, fields),
        }
    };
    information.directions().into_iter().filter(open).map(told).collect()
}

fn words(direction: &Direction, fields: &[String]) -> String {
    let mut parts: Vec<(f64, &str)> =
        direction.vector.iter().zip(fields).map(|(entry, field)| (*entry, field.as_str())).collect();
    parts.retain(|(entry, _)| entry.abs() >= TOLD);
    parts.sort_by(|a, b| b.0.abs().total_cmp(&a.0.abs()));
    let Some((&(lead, first), others)) = parts.split_first() else { return String::new() };
    let sd = direction.standard_deviation;
    if lead * lead >= ALONE {
        return if sd.is_infinite() {
            format!("The data contain no information about {first}.")
        } else {
            format!(
                "The data do not determine {first}: its standard deviation is a factor of {}.",
                significant(sd.min(300.0).exp(), 2)
            )
        };
    }
    // along the direction, for +10 % of the first
    let along = EXAMPLE.ln_1p() / lead;
    let change = |(entry, field): &(f64, &str)| {
        let by = (entry * along).exp_m1() * 100.0;
        let verb = if by < 0.0 { "lowering" } else { "raising" };
        format!("{verb} {field} by {} %", significant(by.abs(), 2))
    };
    let others: Vec<String> = others.iter().map(change).collect();
    format!(
        "The data determine only a combination: raising {first} by 10 % and {} changes all predictions together by {} of their \
         noise.",
        others.join(" and "),
        significant(along.abs() / sd, 1)
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_product_is_told_as_one() {
        // two readings, accurate to 1 %, of the product of two parameters
        let information = Information::of(&[100.0, 100.0, 100.0, 100.0], 2).unwrap();
        let fields = ["a".to_owned(), "b".to_owned()];
        let found = undetermined(&information, &fields);
        assert_eq!(found.len(), 1);
        assert!(
            found[0].text.contains("raising a by 10 % and lowering b by 9.1 %")
                || found[0].text.contains("raising b by 10 %")
        );
        assert_eq!(found[0].standard_deviation, None);
    }

    #[test]
    fn a_parameter_without_effect_is_named() {
        let information = Information::of(&[100.0, 0.0], 2).unwrap();
        let found = undetermined(&information, &["a".to_owned(), "b".to_owned()]);
        assert_eq!(found[0].text, "The data contain no information about b.");
    }
}
