//! Every Rust snippet of the book as a documentation test. There is nothing else in here: `build.rs` collects the
//! snippets from the Markdown files under `docs`, so that a new page needs no entry anywhere.

include!(concat!(env!("OUT_DIR"), "/snippets.rs"));
