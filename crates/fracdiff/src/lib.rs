//! fracdiff
