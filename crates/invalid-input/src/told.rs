//! The parts of an input that a message repeats: short, and without characters that control a terminal.

use core::fmt::{self, Display, Formatter, Write};

/// Longest piece of a value that a message repeats (characters).
pub const LONGEST_VALUE: usize = 60;
const DOTS: &str = "...";

/// A text that cannot control a terminal: control characters other than line breaks and tabs, and characters that change the
/// direction of writing, are shown by their number.
///
/// ```
/// assert_eq!(invalid_input::printable("a\u{1b}[2J").to_string(), "a\\u{1b}[2J");
/// ```
pub fn printable(text: impl Display) -> impl Display {
    Printable(text)
}

/// A text truncated to at most this many characters. Truncating it again changes nothing.
///
/// ```
/// assert_eq!(invalid_input::cut("0.123456789", 8).to_string(), "0.123...");
/// ```
pub fn cut(text: impl Display, most: usize) -> impl Display {
    Cut(text, most)
}

struct Printable<T>(T);

impl<T: Display> Display for Printable<T> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(Escape(f), "{}", self.0)
    }
}

struct Cut<T>(T, usize);

impl<T: Display> Display for Cut<T> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        if count(&self.0) <= self.1 {
            return write!(f, "{}", self.0);
        }
        write!(First { out: f, left: self.1.saturating_sub(DOTS.len()) }, "{}", self.0)?;
        f.write_str(DOTS)
    }
}

/// Number of characters of a text.
pub(crate) fn count(text: impl Display) -> usize {
    let mut count = Count(0);
    // Counting cannot fail; a `Display` that fails has written the characters that are counted.
    let _ = write!(count, "{text}");
    count.0
}

struct Count(usize);

impl Write for Count {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        self.0 += text.chars().count();
        Ok(())
    }
}

/// Passes on the first characters and drops the rest.
struct First<'a, 'b> {
    out: &'a mut Formatter<'b>,
    left: usize,
}

impl Write for First<'_, '_> {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        for c in text.chars().take(self.left) {
            self.left -= 1;
            self.out.write_char(c)?;
        }
        Ok(())
    }
}

struct Escape<'a, 'b>(&'a mut Formatter<'b>);

impl Write for Escape<'_, '_> {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        let steers = |c: char| {
            (c.is_control() && c != '\n' && c != '\t') || matches!(c, '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
        };
        for c in text.chars() {
            if steers(c) { write!(self.0, "{}", c.escape_unicode())? } else { self.0.write_char(c)? }
        }
        Ok(())
    }
}
