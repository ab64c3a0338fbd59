//! Tests of the solvers of impacts, a module for each subject. One program takes less time to build than one for each file, and keeps
//! every core busy until its last test.

mod assembly_differentiate;
mod assembly_energy;
mod assembly_hard;
mod assembly_long;
mod assembly_orbit;
mod assembly_physics;
mod assembly_random;
mod assembly_single;
mod common;
mod differentiate;
mod dropped_rod;
mod fall;
mod hard_infinite;
mod hard_modal;
mod hard_uncertainty;
mod infinite_laws;
mod infinite_reference;
mod infinite_regimes;
mod metamorphic;
mod modal_accuracy;
mod modal_physics;
mod own_laws;
mod plastic_contact;
mod remainder;
mod stops;
mod turning;
