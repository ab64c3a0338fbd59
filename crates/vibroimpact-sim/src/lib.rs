//! vibroimpact-sim
