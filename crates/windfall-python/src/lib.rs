//! windfall in Python: commands, as the package `windfall` calls them.
//!
//! Everything goes in as words of a command line, and comes out as JSON; `python/windfall` makes
//! objects of it. Nothing is calculated here or there.

mod command;
mod work;

/// The extension module.
#[pyo3::pymodule]
mod _native {
    #[pymodule_export]
    use crate::command::{call, main};
}
