//! emoc
