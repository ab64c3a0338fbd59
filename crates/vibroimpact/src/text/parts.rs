//! Numbers and phrases that every text is made of.

use vibroimpact_sim::StopReason;

pub use crate::scene::told::{counted, printable, shorten};

/// The words of a text in lines as long as `fits` allows; a word that is too long has a line of its own.
pub(crate) fn filled(text: &str, fits: impl Fn(&str) -> bool) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        if let Some(line) = lines.last_mut() {
            let length = line.len();
            line.extend([" ", word]);
            if fits(line) {
                continue;
            }
            line.truncate(length);
        }
        lines.push(word.to_owned());
    }
    lines
}

/// A number with so many significant digits, trailing zeros left out, and a power of ten where
/// it would otherwise grow long.
pub fn significant(value: f64, digits: usize) -> String {
    if !value.is_finite() {
        return "not a number".into();
    }
    if value == 0.0 {
        return "0".into();
    }
    let digits = digits.clamp(1, 17);
    let scientific = format!("{:.*e}", digits - 1, value);
    let (mantissa, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    let trim = |text: &str| match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_string(),
        false => text.to_string(),
    };
    let text = if (-4..digits.max(6) as i32).contains(&exponent) {
        let decimals = (digits as i32 - 1 - exponent).max(0) as usize;
        trim(&format!("{value:.decimals$}"))
    } else {
        format!("{}×10{}", trim(mantissa), superscript(exponent))
    };
    text.replace('-', "\u{2212}")
}

/// A number with two significant digits.
pub(crate) fn small(value: f64) -> String {
    significant(value, 2)
}

/// A whole number in superscript digits.
pub(crate) fn superscript(number: i32) -> String {
    number
        .to_string()
        .chars()
        .map(|c| match c {
            '-' => '⁻',
            '1' => '¹',
            '2' => '²',
            '3' => '³',
            digit => char::from_u32(0x2070 + digit.to_digit(10).unwrap_or(0)).unwrap_or(digit),
        })
        .collect()
}

/// A number with four significant digits and its unit, with an SI prefix: `1.235 ms`.
pub fn quantity(value: f64, unit: &str) -> String {
    with_digits(value, unit, QUANTITY_DIGITS)
}

/// As [`quantity`], with two significant digits and a sign; `?` if it is not known.
pub(crate) fn plus_minus(uncertainty: Option<f64>, unit: &str) -> String {
    uncertainty.map_or("?".to_owned(), |uncertainty| format!("± {}", with_digits(uncertainty, unit, 2)))
}

/// As [`quantity`], with so many digits that two values this far apart differ in the last two of them.
pub(crate) fn quantity_apart(value: f64, unit: &str, distance: f64) -> String {
    let needed = 2.0 + value.abs().log10().floor() - distance.abs().log10().floor();
    let most = f64::DIGITS as usize + 2;
    // infinite for a distance of 0
    let digits =
        if needed.is_nan() { QUANTITY_DIGITS } else { (needed.max(0.0) as usize).clamp(QUANTITY_DIGITS, most) };
    with_digits(value, unit, digits)
}

/// Significant digits of a quantity.
const QUANTITY_DIGITS: usize = 4;

fn with_digits(value: f64, unit: &str, digits: usize) -> String {
    const PREFIXES: [&str; 11] = ["f", "p", "n", "µ", "m", "", "k", "M", "G", "T", "P"];
    if value == 0.0 {
        return format!("0 {unit}");
    }
    let after_first = digits.saturating_sub(1);
    // through the decimal form, so that 999.96 becomes 1.000 k
    let scientific = format!("{value:.after_first$e}");
    let exponent: i32 = scientific.split_once('e').and_then(|(_, e)| e.parse().ok()).unwrap_or(0);
    let group = exponent.div_euclid(3);
    match usize::try_from(group + 5).ok().and_then(|i| PREFIXES.get(i)) {
        Some(prefix) if value.is_finite() => {
            let decimals = after_first.saturating_sub(usize::try_from(exponent.rem_euclid(3)).unwrap_or(0));
            format!("{:.decimals$} {prefix}{unit}", value / 1000f64.powi(group))
        }
        _ => format!("{scientific} {unit}"),
    }
}

/// The restitution with as many digits as can be trusted, and its uncertainty.
pub(crate) fn restitution(value: f64, uncertainty: Option<f64>) -> String {
    match uncertainty {
        Some(error) if error > 0.0 => {
            let decimals = (-error.log10()).ceil().clamp(1.0, 12.0) as usize;
            // Up to four decimals are read more easily than an exponent.
            match decimals {
                ..=4 => format!("{value:.decimals$} ± {error:.decimals$}"),
                _ => format!("{value:.decimals$} ± {error:.0e}"),
            }
        }
        _ => format!("{value:.6}"),
    }
}

/// The outcome of a computation that stopped before the impact had ended: why, and what to do.
pub(crate) fn stopped(reason: Option<StopReason>) -> Option<String> {
    reason.map(|reason| format!("stopped before the impact ended ({}): {}", reason.as_str(), reason.advice()))
}

/// What a body does at the end of an impact: it leaves the other only in a rebound.
pub(crate) fn leaves(outcome: &str) -> &'static str {
    if outcome == "rebound" { "leaves" } else { "moves" }
}

/// A residual of energies, of which only the size matters.
pub(crate) fn residual(energy_j: f64) -> String {
    if energy_j == 0.0 { "0 J".to_owned() } else { format!("{energy_j:.0e} J") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_residual_has_one_digit_or_is_zero() {
        assert_eq!([0.0, -0.0, -1.3e-14].map(residual), ["0 J", "0 J", "-1e-14 J"]);
    }

    #[test]
    fn quantities_carry_si_prefixes() {
        for (value, text) in [
            (0.0, "0 s"),
            (1.0, "1.000 s"),
            (-0.0123456, "-12.35 ms"),
            (999.96, "1.000 ks"),
            (2.5e-16, "2.500e-16 s"),
            (3e18, "3.000e18 s"),
            (f64::NAN, "NaN s"),
        ] {
            assert_eq!(quantity(value, "s"), text);
        }
    }

    #[test]
    fn a_restitution_shows_the_digits_it_has() {
        assert_eq!(restitution(0.17738912345, Some(3e-6)), "0.177389 ± 3e-6");
        assert_eq!(restitution(0.2, Some(0.3)), "0.2 ± 0.3");
        assert_eq!(restitution(0.17738912345, Some(0.055)), "0.18 ± 0.06");
        assert_eq!(restitution(0.2, None), "0.200000");
    }
}
