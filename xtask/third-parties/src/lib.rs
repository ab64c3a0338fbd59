//! Nothing but dependencies: those of the workspace that turn on features of third parties below them.
//!
//! A package that has other features in the lints of the libraries, in all lints, or in the tests has to be compiled for each of
//! them, with everything above it. As ordinary dependencies of a member of the workspace, which is checked beside the libraries,
//! these make its features the same everywhere.
