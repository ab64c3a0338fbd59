//! The error for input that cannot be solved.

/// A field that the solvers cannot work with: which, its value, and what is allowed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{field} = {value} is not allowed: {allowed}")]
pub struct InvalidInput {
    /// Name of the field, as in the public structs.
    pub field: String,
    /// The value given, as text.
    pub value: String,
    /// What would be allowed.
    pub allowed: &'static str,
}

impl InvalidInput {
    /// Accepts the field if `ok` holds, and reports it otherwise.
    pub(crate) fn unless(
        ok: bool,
        field: impl Into<String>,
        value: impl ToString,
        allowed: &'static str,
    ) -> Result<(), InvalidInput> {
        if ok { Ok(()) } else { Err(InvalidInput { field: field.into(), value: value.to_string(), allowed }) }
    }
}

impl From<beam_modes::InvalidInput> for InvalidInput {
    fn from(error: beam_modes::InvalidInput) -> InvalidInput {
        InvalidInput { field: error.field, value: error.value, allowed: error.allowed }
    }
}

impl From<contact_models::InvalidInput> for InvalidInput {
    fn from(error: contact_models::InvalidInput) -> InvalidInput {
        InvalidInput { field: error.field, value: error.value, allowed: error.allowed }
    }
}
