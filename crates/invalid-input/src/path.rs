//! The path of an input.

use core::fmt::{self, Display, Formatter, Write};

use crate::value::Text;

/// One step from the outermost object to an input.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum Step {
    /// A field of an object, by name.
    Field(Text),
    /// An entry of a list, from 0.
    Index(usize),
    /// A place outside of any object, such as a file.
    Place(Text),
    /// A line of a file or table, from 1.
    Line(u64),
}

impl Step {
    fn is_place(&self) -> bool {
        matches!(self, Step::Place(_) | Step::Line(_))
    }
}

#[cfg(feature = "alloc")]
type Steps = alloc::vec::Vec<Step>;
#[cfg(not(feature = "alloc"))]
type Steps = inline::Steps;

/// The path of an input, from the outermost object inwards, as in `structure.segments[0].length_m`.
///
/// It can be made from a name, from a name and an index, from these and a name within the entry, or from a list of names, and
/// it equals the text that it is displayed as:
///
/// ```
/// use invalid_input::Path;
///
/// assert_eq!(Path::from("mass_kg"), "mass_kg");
/// assert_eq!(Path::from(("gaps_m", 3)), "gaps_m[3]");
/// assert_eq!(Path::from(("modes", 3, "shape")), "modes[3].shape");
/// assert_eq!(Path::from(["structure", "kind"]), "structure.kind");
/// ```
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Path(Steps);

impl Path {
    /// The steps, outermost first.
    pub fn steps(&self) -> &[Step] {
        &self.0
    }

    /// Whether the path is empty: the whole input is meant.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Name of the outermost field; `None` if an index or a place comes first.
    pub fn first(&self) -> Option<&str> {
        match self.0.first() {
            Some(Step::Field(name)) => Some(name),
            _ => None,
        }
    }

    /// Name of the innermost field; `None` if an index or a place comes last.
    pub fn last(&self) -> Option<&str> {
        match self.0.last() {
            Some(Step::Field(name)) => Some(name),
            _ => None,
        }
    }

    /// Whether the path goes through a file or a table.
    pub fn has_place(&self) -> bool {
        self.0.iter().any(Step::is_place)
    }

    /// This path, for an object that contains its object at `parent`.
    #[must_use]
    pub fn within(&self, parent: impl Into<Path>) -> Path {
        parent.into().0.iter().chain(self.0.iter()).cloned().collect()
    }
}

impl Display for Path {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let mut before: Option<&Step> = None;
        for step in self.steps() {
            match (before, step) {
                (None, _) | (Some(_), Step::Index(_)) => {}
                (Some(before), _) if before.is_place() || step.is_place() => f.write_str(", ")?,
                _ => f.write_str(".")?,
            }
            match step {
                Step::Field(name) | Step::Place(name) => f.write_str(name)?,
                Step::Index(index) => write!(f, "[{index}]")?,
                Step::Line(line) => write!(f, "line {line}")?,
            }
            before = Some(step);
        }
        Ok(())
    }
}

impl PartialEq<str> for Path {
    fn eq(&self, text: &str) -> bool {
        let mut rest = Rest(text);
        write!(rest, "{self}").is_ok() && rest.0.is_empty()
    }
}

impl PartialEq<&str> for Path {
    fn eq(&self, text: &&str) -> bool {
        *self == **text
    }
}

#[cfg(feature = "alloc")]
impl PartialEq<alloc::string::String> for Path {
    fn eq(&self, text: &alloc::string::String) -> bool {
        *self == **text
    }
}

/// The part of a text that has not been matched yet.
struct Rest<'a>(&'a str);

impl Write for Rest<'_> {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        self.0 = self.0.strip_prefix(text).ok_or(fmt::Error)?;
        Ok(())
    }
}

impl FromIterator<Step> for Path {
    fn from_iter<I: IntoIterator<Item = Step>>(steps: I) -> Path {
        Path(steps.into_iter().collect())
    }
}

impl From<&[Step]> for Path {
    fn from(steps: &[Step]) -> Path {
        steps.iter().cloned().collect()
    }
}

impl From<Step> for Path {
    fn from(step: Step) -> Path {
        Path::from_iter([step])
    }
}

impl From<Text> for Path {
    fn from(name: Text) -> Path {
        Step::Field(name).into()
    }
}

#[cfg(feature = "alloc")]
impl From<&str> for Path {
    fn from(name: &str) -> Path {
        Step::Field(name.into()).into()
    }
}

#[cfg(feature = "alloc")]
impl<const N: usize> From<[&str; N]> for Path {
    fn from(names: [&str; N]) -> Path {
        names.into_iter().map(|name| Step::Field(name.into())).collect()
    }
}

#[cfg(not(feature = "alloc"))]
impl<const N: usize> From<[Text; N]> for Path {
    fn from(names: [Text; N]) -> Path {
        names.into_iter().map(Step::Field).collect()
    }
}

impl<T: Into<Path>> From<(T, usize)> for Path {
    fn from((list, index): (T, usize)) -> Path {
        Path::from(Step::Index(index)).within(list)
    }
}

impl<T: Into<Path>, U: Into<Path>> From<(T, usize, U)> for Path {
    fn from((list, index, field): (T, usize, U)) -> Path {
        field.into().within((list, index))
    }
}

/// The steps of a path without an allocator.
#[cfg(not(feature = "alloc"))]
mod inline {
    use super::Step;

    /// A name, an index in it, and a name in that; a longer path loses its outermost steps.
    const MOST: usize = 3;
    const NOTHING: Step = Step::Index(0);

    #[derive(Debug, Clone, PartialEq, Eq)]
    pub struct Steps {
        steps: [Step; MOST],
        count: usize,
    }

    impl Default for Steps {
        fn default() -> Steps {
            Steps { steps: [NOTHING; MOST], count: 0 }
        }
    }

    impl core::ops::Deref for Steps {
        type Target = [Step];

        fn deref(&self) -> &[Step] {
            &self.steps[..self.count]
        }
    }

    impl FromIterator<Step> for Steps {
        fn from_iter<I: IntoIterator<Item = Step>>(steps: I) -> Steps {
            let mut kept = Steps::default();
            for step in steps {
                if kept.count == MOST {
                    kept.steps.rotate_left(1);
                    kept.count -= 1;
                }
                kept.steps[kept.count] = step;
                kept.count += 1;
            }
            kept
        }
    }
}
