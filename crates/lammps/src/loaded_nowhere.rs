//! Systems on which no shared library is opened.

use std::ffi::{CStr, c_void};
use std::path::Path;

/// A shared library, of which there is none here.
#[derive(Clone, Copy)]
pub(crate) enum Loaded {}

impl Loaded {
    /// Opens nothing.
    ///
    /// # Errors
    /// Always.
    pub(crate) fn open(_: &Path) -> Result<Self, String> {
        Err("on this system windfall does not open the library of LAMMPS".to_owned())
    }

    /// Address of a symbol.
    pub(crate) fn address(&self, _: &CStr) -> Option<*mut c_void> {
        match *self {}
    }

    /// A function.
    ///
    /// # Errors
    /// None: there is no library to ask.
    ///
    /// # Safety
    /// It is never called.
    pub(crate) unsafe fn function<F: Copy>(&self, _: &CStr) -> Result<F, String> {
        match *self {}
    }
}
