//! Tests of the laws of contact, a module for each subject. One program takes less time to build than one for each file, and keeps
//! every core busy until its last test.

mod broken;
mod common;
mod contract;
mod input;
mod plasticity;
mod restitution;
mod thesis;
mod wanted;
