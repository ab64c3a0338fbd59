//! The Python package `vibroimpact`.
//!
//! Input arrives as JSON text or the name of a file, and is read by the library, so that its errors are those of the command
//! line. Results are returned as the JSON that the command line prints, and as columns of numbers.

mod bodies;
mod emoc;
mod errors;
mod identify;
mod impact;
mod input;
mod law;
mod output;
mod sweep;

use pyo3::prelude::*;

/// The part of the package that is compiled.
#[pymodule]
mod _vibroimpact {
    #[pymodule_export]
    use super::bodies::orbit;
    #[pymodule_export]
    use super::emoc::{emoc, emoc_restitution, fit};
    #[pymodule_export]
    use super::identify::identify;
    #[pymodule_export]
    use super::impact::{compare, infinite_beam, modes, plan, sensitivity, simulate, turning_points};
    #[pymodule_export]
    use super::law::law;
    #[pymodule_export]
    use super::sweep::sweep;
    use super::*;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
