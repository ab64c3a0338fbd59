//! Nothing but dependencies: those of the workspace that turn on features of third parties below them.
//!
//! A third party is compiled again, with everything above it, wherever it has other features. As ordinary dependencies of this
//! package the ones listed here give every check the same features: all lints, the documentation and the tests of the workspace, and
//! the lints of the libraries, which are run beside this package.
