//! A shared library and its functions by name.

use std::ffi::{CStr, CString, c_void};
use std::path::Path;

/// A shared library. It stays loaded until the program ends: MPI cannot be taken out again.
#[derive(Clone, Copy)]
pub(crate) struct Loaded(*mut c_void);

impl Loaded {
    /// Opens a library, by its path or by a name that the system looks for.
    ///
    /// # Errors
    /// What the system says.
    pub(crate) fn open(path: &Path) -> Result<Self, String> {
        let name = CString::new(path.as_os_str().as_encoded_bytes())
            .map_err(|_| "its name has a zero byte".to_owned())?;
        // Parts of MPI look for the symbols of the whole: they must be visible to all.
        // SAFETY: the name is a C string that lives during the call.
        let handle = unsafe { libc::dlopen(name.as_ptr(), libc::RTLD_NOW | libc::RTLD_GLOBAL) };
        match handle.is_null() {
            false => Ok(Self(handle)),
            true => Err(last_problem()),
        }
    }

    /// Address of a symbol, in the library or in what it is linked with.
    pub(crate) fn address(&self, name: &CStr) -> Option<*mut c_void> {
        // SAFETY: the handle is of a library that is never closed; the name is a C string.
        let found = unsafe { libc::dlsym(self.0, name.as_ptr()) };
        (!found.is_null()).then_some(found)
    }

    /// A function.
    ///
    /// # Errors
    /// There is none of that name.
    ///
    /// # Safety
    /// `F` is the type of a C function pointer, and that of the function of this name.
    pub(crate) unsafe fn function<F: Copy>(&self, name: &CStr) -> Result<F, String> {
        let address = self.address(name);
        let address = address.ok_or_else(|| format!("it has no {}", name.to_string_lossy()))?;
        assert_eq!(size_of::<F>(), size_of::<*mut c_void>());
        // SAFETY: both are one address, and the caller says of what it is.
        Ok(unsafe { std::mem::transmute_copy::<*mut c_void, F>(&address) })
    }
}

fn last_problem() -> String {
    // SAFETY: it answers a C string that is valid until the next call, or null.
    let said = unsafe { libc::dlerror() };
    match said.is_null() {
        true => "it cannot be opened".to_owned(),
        // SAFETY: it is not null, and copied at once.
        false => unsafe { CStr::from_ptr(said) }
            .to_string_lossy()
            .into_owned(),
    }
}
