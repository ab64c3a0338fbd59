//! Tests of methods for fractional and weakly singular equations, a module for each subject. One program takes less time to build than one for each file, and keeps
//! every core busy until its last test.

mod convergence;
mod das_chatterjee;
mod events;
mod hard_uncertainty;
mod robustness;
mod systems;
