//! windfall in Python: commands, recordings and fits, as the package `windfall` calls them.
//!
//! Everything goes in as words of a command line, text or bytes, and comes out as JSON or
//! bytes; `python/windfall` makes objects of it. Nothing is calculated here or there.

mod arrays;
mod columns;
mod command;
mod fit;
mod recording;
mod request;
mod work;

/// The extension module.
#[pyo3::pymodule]
mod _native {
    #[pymodule_export]
    use crate::columns::arrow_stream;
    #[pymodule_export]
    use crate::command::{call, main};
    #[pymodule_export]
    use crate::fit::{FitRequest, Fitted, fit};
    #[pymodule_export]
    use crate::recording::{Recording, read};
}
