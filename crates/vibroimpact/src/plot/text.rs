//! Widths of texts, and numbers as text.

use crate::text::filled;

/// Width of `text` (px) at a font size, estimated from the widths of a wide sans-serif font, so
/// that a margin made from it is rather too large than too small.
pub(super) fn width_px(text: &str, size_px: f64) -> f64 {
    let em: f64 = text
        .chars()
        .map(|c| match c {
            'i' | 'j' | 'l' | '.' | ',' | ':' | ';' | '\'' | '|' | '!' | ' ' => 0.33,
            'f' | 't' | 'r' | '(' | ')' | '[' | ']' | '/' | '-' => 0.42,
            '⁰'..='⁹' | '²' | '³' | '¹' | '⁻' | '₀'..='₉' => 0.42,
            'm' | 'w' | 'M' | 'W' => 0.97,
            'A'..='Z' => 0.72,
            '\u{2212}' | '+' | '=' | '×' | '<' | '>' => 0.84,
            _ => 0.63,
        })
        .sum();
    em * size_px
}

/// A text in lines no wider than `room_px`, as far as its words allow; its own line breaks stay. The lines of a paragraph are
/// as equally long as a narrower room makes them, so that no single word is left for the last one.
pub(super) fn wrapped(text: &str, size_px: f64, room_px: f64) -> Vec<String> {
    let paragraph = |text: &str| {
        let within = |room_px: f64| filled(text, |line| width_px(line, size_px) <= room_px);
        let lines = within(room_px);
        let narrower = (1..20).map(|i| within(room_px * (1.0 - 0.025 * f64::from(i))));
        narrower.take_while(|found| found.len() == lines.len()).last().unwrap_or(lines)
    };
    text.lines().flat_map(paragraph).collect()
}

/// Text without the characters that XML does not allow.
pub(super) fn printable(text: &str) -> String {
    text.chars().filter(|c| !c.is_control() && !matches!(c, '\u{fffe}' | '\u{ffff}')).collect()
}

/// A number with a fixed count of decimals, a proper minus sign, and no negative zero.
pub(super) fn fixed(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(digits) if digits.bytes().all(|b| b == b'0' || b == b'.') => digits.to_string(),
        Some(digits) => format!("\u{2212}{digits}"),
        None => text,
    }
}
