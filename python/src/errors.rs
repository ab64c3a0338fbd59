//! Errors of the library as exceptions with the same text.

use std::io;

use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use vibroimpact::export::Failure;
use vibroimpact::sweep::SweepError;
use vibroimpact::{InvalidInput, SceneError};

mod python {
    pyo3::import_exception!(vibroimpact._errors, InvalidInput);
    pyo3::import_exception!(vibroimpact._errors, Interrupted);
}

/// The exception after Ctrl-C, with the result so far.
pub fn interrupted(py: Python<'_>, signal: PyErr, result: Bound<'_, PyDict>) -> PyErr {
    let exception = python::Interrupted::new_err((result.unbind(),));
    exception.set_cause(py, Some(signal));
    exception
}

/// An exception to be raised.
pub struct Fault(pub PyErr);

impl From<Fault> for PyErr {
    fn from(fault: Fault) -> PyErr {
        fault.0
    }
}

impl From<InvalidInput> for Fault {
    fn from(fault: InvalidInput) -> Fault {
        let value = fault.value.as_ref().map(ToString::to_string);
        Fault(python::InvalidInput::new_err((fault.to_string(), fault.field.to_string(), value, fault.allowed)))
    }
}

impl From<SceneError> for Fault {
    fn from(fault: SceneError) -> Fault {
        let said = fault.to_string();
        match fault {
            SceneError::Invalid(fault) => fault.into(),
            SceneError::Syntax { field, reason, .. } => {
                Fault(python::InvalidInput::new_err((said, field.to_string(), None::<String>, reason)))
            }
            SceneError::Read { source, .. } => of_system(source, said),
        }
    }
}

impl From<SweepError> for Fault {
    fn from(fault: SweepError) -> Fault {
        let said = fault.to_string();
        match fault {
            SweepError::File(fault) => fault.into(),
            SweepError::Invalid(fault) => fault.into(),
            SweepError::Io { source, .. } => of_system(source, said),
            SweepError::Refused(_) | SweepError::Stopped { .. } => Fault(PyRuntimeError::new_err(said)),
        }
    }
}

impl From<Failure> for Fault {
    fn from(fault: Failure) -> Fault {
        match fault.downcast::<InvalidInput>() {
            Ok(fault) => (*fault).into(),
            Err(other) => Fault(PyRuntimeError::new_err(other.to_string())),
        }
    }
}

/// `FileNotFoundError` and similar exceptions.
fn of_system(source: io::Error, said: String) -> Fault {
    Fault(io::Error::new(source.kind(), said).into())
}
