//! Tests of modes of beams, rods, strings and plates, a module for each subject. One program takes less time to build than one for each file, and keeps
//! every core busy until its last test.

mod common;
mod compliance;
mod finite_elements;
mod fittings;
mod hard;
mod hard_uncertainty;
mod invariance;
mod participation;
mod plates;
mod remainder;
mod rods;
mod standing;
mod stepped;
mod strings;
mod timoshenko;
mod uniform;
