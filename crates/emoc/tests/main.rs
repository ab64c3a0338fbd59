//! Tests of the closed form and the quadratic programs, a module for each subject. One program takes less time to build than one for each file, and keeps
//! every core busy until its last test.

mod agreement;
mod common;
mod complementarity;
mod derivatives;
mod general;
mod hard;
mod header;
mod moving;
mod scatter;
