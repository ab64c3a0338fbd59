//! beam-modes
