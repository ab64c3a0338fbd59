//! The parameters: fields of the scene that are free.

use fitting::{Parameter, Range};
use invalid_input::InvalidInput;
use serde_json::Value;

use crate::scene::FieldPath;
use crate::scene::json::{number, quote};
use crate::scene::told::did_you_mean;

/// The time constant of the gauge, which is not a field of the scene.
pub(super) const TIME_CONSTANT: &str = "gauge.time_constant_s";
/// Without stated limits the search covers this factor on either side of the value in the scene.
const FACTOR: f64 = 3.0;
const WAY: &str =
    "a field of the scene that is a number, alone or as field=low..high with two finite numbers and low < high";

/// A free field, and the interval of its search.
#[derive(Debug, Clone, PartialEq)]
pub struct Free {
    /// Its path in the scene, or `gauge.time_constant_s`.
    pub field: String,
    /// The interval of the search, if it is stated.
    pub search: Option<(f64, f64)>,
}

impl Free {
    /// Reads `field` or `field=low..high`.
    ///
    /// # Errors
    /// Limits that are not two ascending numbers, or an empty name.
    ///
    /// ```
    /// let free = vibroimpact::identify::Free::parse("striker.mass_kg=0.1..0.5").unwrap();
    /// assert_eq!((free.field.as_str(), free.search), ("striker.mass_kg", Some((0.1, 0.5))));
    /// ```
    pub fn parse(text: &str) -> Result<Free, InvalidInput> {
        let fault = || InvalidInput::new("--free", quote(&Value::from(text)), WAY);
        let (field, limits) = text.split_once('=').map_or((text, None), |(field, limits)| (field, Some(limits)));
        FieldPath::parse(field).ok_or_else(fault)?;
        let end = |text: &str| text.trim().parse().ok().filter(|value: &f64| value.is_finite());
        let search = match limits {
            None => None,
            Some(limits) => {
                let ends = limits.split_once("..").and_then(|(low, high)| Some((end(low)?, end(high)?)));
                Some(ends.filter(|(low, high)| low < high).ok_or_else(fault)?)
            }
        };
        Ok(Free { field: field.to_owned(), search })
    }

    /// The parameter of the search: logarithmic if start and limits are positive, otherwise between the limits.
    pub(super) fn parameter(&self, tree: &Value) -> Result<Parameter, InvalidInput> {
        let name = format!("--free {}", self.field);
        let start = self.start(tree, &name)?;
        let (low, high) = match (self.search, start) {
            (Some(limits), _) => limits,
            (None, start) if start > 0.0 => (start / FACTOR, start * FACTOR),
            (None, start) => {
                let allowed = "greater than 0 in the scene, or have limits of the search, as in field=low..high";
                return Err(InvalidInput::new(name, number(start), allowed));
            }
        };
        let range = if low > 0.0 { Range::Positive } else { Range::Between { low, high } };
        // a start on a limit, such as zero damping, has no logistic coordinate
        let inside = match range {
            Range::Between { low, high } => low + (high - low) / 64.0,
            _ => low,
        };
        let outside = match range {
            Range::Between { low, high } => high - (high - low) / 64.0,
            _ => high,
        };
        let start = if self.search.is_some() { start.clamp(inside, outside) } else { start };
        let parameter = Parameter { name: self.field.clone(), start, range, search: (inside, outside) };
        parameter.validate().map_err(|fault| fault.under(name))?;
        Ok(parameter)
    }

    fn start(&self, tree: &Value, name: &str) -> Result<f64, InvalidInput> {
        if self.is_of_gauge() {
            let (low, high) = self.search.filter(|(low, _)| *low > 0.0).ok_or_else(|| {
                let allowed = "an interval with limits greater than 0, as in gauge.time_constant_s=1e-6..1e-3, because the scene does not state the field";
                InvalidInput::missing(format!("{name}=low..high"), allowed)
            })?;
            return Ok((low * high).sqrt());
        }
        let path = FieldPath::parse(&self.field);
        let is_setting = path.as_ref().is_some_and(FieldPath::is_setting);
        match path.and_then(|path| path.get(tree).cloned()) {
            Some(value) if is_setting => {
                let allowed = "a field that can vary continuously, because it is to be estimated";
                Err(InvalidInput::new(name, quote(&value), allowed))
            }
            None => {
                let allowed = "a field that the scene states, as a number".to_owned() + &self.meant(tree);
                Err(InvalidInput::missing(name, allowed))
            }
            Some(value) => {
                let allowed = "a field of the scene that is a finite number";
                value.as_f64().ok_or_else(|| InvalidInput::new(name, quote(&value), allowed))
            }
        }
    }

    /// The field beside which this one would be, if one there has a similar name.
    fn meant(&self, tree: &Value) -> String {
        let (holder, name) = self.field.rsplit_once('.').unwrap_or(("", &self.field));
        let beside =
            if holder.is_empty() { Some(tree) } else { FieldPath::parse(holder).and_then(|path| path.get(tree)) };
        let names = beside.and_then(Value::as_object).into_iter().flatten().map(|(name, _)| name.as_str());
        did_you_mean(name, names)
    }

    pub(super) fn is_of_gauge(&self) -> bool {
        self.field == TIME_CONSTANT
    }
}
