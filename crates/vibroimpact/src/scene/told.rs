//! Input that is repeated in messages: shortened, without control characters, and with the name that was probably meant.

use invalid_input::LONGEST_VALUE;
use serde_json::{Number, Value};

/// Longest name that is compared with those that are allowed (characters).
const LONGEST_NAME: usize = 60;
/// Smallest Jaro similarity of two names that may be confused.
const ALIKE: f64 = 0.75;
/// Smallest length of a part of a name that identifies the whole name.
const SHORTEST_PIECE: usize = 3;

/// A number with a noun: `1 entry`, `2 entries`.
pub fn counted(count: u64, one: &str, more: &str) -> String {
    format!("{count} {}", if count == 1 { one } else { more })
}

/// A text shortened for a message. Shortening it again does not change it.
pub fn shorten(text: &str) -> String {
    invalid_input::cut(text, LONGEST_VALUE).to_string()
}

/// A value as the text of a message.
pub(crate) fn quote(value: &Value) -> String {
    shorten(&value.to_string())
}

/// A number as the text of a message.
pub(crate) fn number(value: f64) -> String {
    Number::from_f64(value).map_or_else(|| value.to_string(), |number| number.to_string())
}

/// A text that cannot control a terminal: control characters other than line breaks and tabs, and characters that change the
/// direction of writing, are shown by their numbers.
///
/// ```
/// assert_eq!(vibroimpact::text::printable("a\u{1b}[2J"), "a\\u{1b}[2J");
/// ```
pub fn printable(text: &str) -> String {
    invalid_input::printable(text).to_string()
}

/// `; did you mean ...?` if one of the names is similar to the word, otherwise nothing. Of equally similar names the first is
/// used.
pub(crate) fn did_you_mean<'a>(word: &str, names: impl IntoIterator<Item = &'a str>) -> String {
    if word.chars().count() > LONGEST_NAME {
        return String::new();
    }
    let (given, word) = (word, word.to_lowercase());
    let likeness = |name: &str| {
        let name = name.to_lowercase();
        let is_piece = word.chars().count() >= SHORTEST_PIECE && name.contains(&word);
        // a part of a name is closer than a similar word
        strsim::jaro(&word, &name) + if is_piece { 1.0 } else { 0.0 }
    };
    let mut nearest: Option<(f64, &str)> = None;
    for name in names {
        let alike = likeness(name);
        if alike >= ALIKE && nearest.is_none_or(|(best, _)| alike > best) {
            nearest = Some((alike, name));
        }
    }
    // a word that is in the list is wrong for another reason
    let nearest = nearest.filter(|(_, name)| *name != given);
    nearest.map_or_else(String::new, |(_, name)| format!("; did you mean {name}?"))
}

/// As [`did_you_mean`], with the names that a message lists after `one of`.
pub(crate) fn did_you_mean_one_of(word: &str, allowed: &str) -> String {
    let listed = allowed.split_once("one of ").map_or("", |(_, listed)| listed);
    did_you_mean(
        word,
        listed.split(", ").map(|name| name.split(' ').next().unwrap_or_default().trim_matches(['"', '`'])),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slips_find_the_name_that_was_meant() {
        let kinds = "one of beam, modal, modes-file, infinite-beam, infinite-plate, dropped-rod";
        for (word, meant) in [
            ("bem", "beam"),
            ("Beam", "beam"),
            ("plate", "infinite-plate"),
            ("dropped_rod", "dropped-rod"),
            ("modes_file", "modes-file"),
        ] {
            assert_eq!(did_you_mean_one_of(word, kinds), format!("; did you mean {meant}?"), "{word}");
        }
        for word in ["", "xyzzy", "steel", "modal", &"beam".repeat(100)] {
            assert_eq!(did_you_mean_one_of(word, kinds), "", "{word}");
        }
        let fields = ["mass_kg", "speed_m_s", "length_m", "density_kg_m3"];
        for (word, meant) in [("mass", "mass_kg"), ("lenght_m", "length_m"), ("velocity", "")] {
            let told = if meant.is_empty() { String::new() } else { format!("; did you mean {meant}?") };
            assert_eq!(did_you_mean(word, fields), told, "{word}");
        }
    }

    #[test]
    fn what_is_cut_stays_as_it_is() {
        let long = "9".repeat(400);
        assert_eq!(shorten(&long).chars().count(), LONGEST_VALUE);
        assert_eq!(shorten(&shorten(&long)), shorten(&long));
        assert_eq!(shorten("short"), "short");
    }
}
