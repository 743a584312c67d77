//! A run of LAMMPS in this process, which tells where the atoms are every few steps.

use crate::loaded::Loaded;
use crate::mpi::Ranks;
use std::ffi::{CStr, CString, c_char, c_double, c_int, c_void};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

/// Atoms of a rank at a step: its own, and behind them those of other ranks near its border.
#[derive(Clone, Copy, Debug)]
pub struct Atoms<'a> {
    /// The step.
    pub step: u64,
    /// How many are its own.
    pub local: usize,
    /// The values of a per-atom property of whole numbers.
    pub numbers: &'a [i32],
    /// Where; in the units of the run.
    pub place: &'a [[f64; 3]],
    /// Velocity, half a step before.
    pub velocity: &'a [[f64; 3]],
    /// Angular velocity, half a step before.
    pub spin: &'a [[f64; 3]],
}

type Handle = *mut c_void;
type CallBack = unsafe extern "C" fn(
    *mut c_void,
    i64,
    c_int,
    *mut c_int,
    *mut *mut c_double,
    *mut *mut c_double,
);

/// The library of LAMMPS.
#[derive(Clone, Copy)]
pub struct Library {
    loaded: Loaded,
    open: unsafe extern "C" fn(c_int, *mut *mut c_char, *mut Handle) -> Handle,
    close: unsafe extern "C" fn(Handle),
    finalize: unsafe extern "C" fn(),
    version: unsafe extern "C" fn(Handle) -> c_int,
    commands: unsafe extern "C" fn(Handle, *const c_char),
    setting: unsafe extern "C" fn(Handle, *const c_char) -> c_int,
    atoms: unsafe extern "C" fn(Handle, *const c_char) -> *mut c_void,
    has_mpi: unsafe extern "C" fn() -> c_int,
    has_error: unsafe extern "C" fn(Handle) -> c_int,
    error: unsafe extern "C" fn(Handle, *mut c_char, c_int) -> c_int,
    call_back: unsafe extern "C" fn(Handle, *const c_char, CallBack, *mut c_void),
    variable: unsafe extern "C" fn(Handle, *const c_char, *const c_char) -> *mut c_void,
    free: unsafe extern "C" fn(*mut c_void),
}

impl Library {
    /// Opens the library, by its path or by a name that the system looks for.
    ///
    /// # Errors
    /// It is absent, or no library of LAMMPS, or one of before 2020.
    pub fn open(path: &Path) -> Result<Self, String> {
        let loaded = Loaded::open(path)?;
        // SAFETY: these are the types of LAMMPS's `library.h`.
        unsafe {
            Ok(Self {
                loaded,
                open: loaded.function(c"lammps_open_no_mpi")?,
                close: loaded.function(c"lammps_close")?,
                finalize: loaded.function(c"lammps_mpi_finalize")?,
                version: loaded.function(c"lammps_version")?,
                commands: loaded.function(c"lammps_commands_string")?,
                setting: loaded.function(c"lammps_extract_setting")?,
                atoms: loaded.function(c"lammps_extract_atom")?,
                has_mpi: loaded.function(c"lammps_config_has_mpi_support")?,
                has_error: loaded.function(c"lammps_has_error")?,
                error: loaded.function(c"lammps_get_last_error_message")?,
                call_back: loaded.function(c"lammps_set_fix_external_callback")?,
                variable: loaded.function(c"lammps_extract_variable")?,
                free: loaded.function(c"lammps_free")?,
            })
        }
    }
}

/// A LAMMPS that runs in this process, on this rank.
pub struct Lammps {
    library: Library,
    handle: Handle,
    /// The ranks of the run.
    pub ranks: Ranks,
}

impl Lammps {
    /// Begins LAMMPS, and MPI where no one has.
    ///
    /// # Errors
    /// It does not begin; its numbers are of other sizes than this crate knows.
    pub fn begin(library: Library, arguments: &[&str]) -> Result<Self, String> {
        let words = ["windfall"].iter().chain(arguments);
        let words: Result<Vec<CString>, _> = words.map(|own| CString::new(*own)).collect();
        let words = words.map_err(|_| "an argument has a zero byte".to_owned())?;
        let mut pointers: Vec<*mut c_char> =
            words.iter().map(|own| own.as_ptr().cast_mut()).collect();
        let count = pointers.len() as c_int;
        pointers.push(std::ptr::null_mut());
        // SAFETY: as many C strings as it is told, which live during the call and which it copies.
        let handle = unsafe { (library.open)(count, pointers.as_mut_ptr(), std::ptr::null_mut()) };
        if handle.is_null() {
            return Err("it does not begin".to_owned());
        }
        // SAFETY: it takes nothing.
        let ranks = match unsafe { (library.has_mpi)() } {
            0 => Ranks::alone(),
            _ => Ranks::of(&library.loaded)?,
        };
        let own = Self {
            library,
            handle,
            ranks,
        };
        match [own.setting(c"bigint"), own.setting(c"tagint")] {
            [8, 4] => Ok(own),
            [big, tag] => Err(format!(
                "it counts steps with {big} bytes and atoms with {tag}, where 8 and 4 are usual (a build with -DLAMMPS_SMALLBIG has them)"
            )),
        }
    }

    /// Its version as year, month and day in one number.
    pub fn version(&self) -> u32 {
        // SAFETY: the handle is open.
        let version = unsafe { (self.library.version)(self.handle) };
        version.unsigned_abs()
    }

    fn setting(&self, name: &CStr) -> c_int {
        // SAFETY: the handle is open, the name a C string.
        unsafe { (self.library.setting)(self.handle, name.as_ptr()) }
    }

    /// The value of a variable of the style equal; none where there is no such variable.
    pub fn variable(&self, name: &CStr) -> Option<f64> {
        // SAFETY: the handle is open, the name a C string; without a group it is a single number.
        let found =
            unsafe { (self.library.variable)(self.handle, name.as_ptr(), std::ptr::null()) };
        let found: *mut c_double = found.cast();
        if found.is_null() {
            return None;
        }
        // SAFETY: it is the address of a number that was made for this call, and is given back once.
        unsafe {
            let value = *found;
            (self.library.free)(found.cast());
            Some(value)
        }
    }

    /// Carries out commands, one a line.
    ///
    /// # Errors
    /// What LAMMPS says, where it does not end the program itself.
    pub fn commands(&self, text: &str) -> Result<(), String> {
        let text = CString::new(text).map_err(|_| "a command has a zero byte".to_owned())?;
        // SAFETY: the handle is open; the text is a C string that lives during the call.
        unsafe { (self.library.commands)(self.handle, text.as_ptr()) };
        // SAFETY: the handle is open.
        if unsafe { (self.library.has_error)(self.handle) } == 0 {
            return Ok(());
        }
        let mut said = vec![0_u8; 4096];
        // SAFETY: it writes so many bytes at most, with a zero behind them.
        unsafe {
            (self.library.error)(
                self.handle,
                said.as_mut_ptr().cast(),
                said.len() as c_int - 1,
            )
        };
        let end = said.iter().position(|own| *own == 0).unwrap_or(said.len());
        Err(String::from_utf8_lossy(&said[..end]).trim().to_owned())
    }

    /// Carries out commands in which `fix external` of the style pf/callback has been made, and
    /// calls back as often as it says.
    ///
    /// * `fix`: its name
    /// * `numbers`: the per-atom property that goes along, with its `i_`
    ///
    /// # Errors
    /// What LAMMPS says, where it does not end the program itself.
    pub fn run(
        &self,
        text: &str,
        (fix, numbers): (&str, &str),
        told: &mut dyn FnMut(Atoms),
    ) -> Result<(), String> {
        let zero = |_| "a name has a zero byte".to_owned();
        let fix = CString::new(fix).map_err(zero)?;
        let numbers = CString::new(numbers).map_err(zero)?;
        let mut hook = Hook {
            own: self,
            numbers: &numbers,
            told,
        };
        let pointer: *mut Hook = &raw mut hook;
        // SAFETY: the hook lives until the commands are done, and nothing else touches it until
        // then; LAMMPS calls back on this thread alone.
        unsafe {
            (self.library.call_back)(self.handle, fix.as_ptr(), called_back, pointer.cast());
        }
        let done = self.commands(text);
        // The fix must not call back what is gone.
        let unfix = format!("unfix {}", fix.to_string_lossy());
        match done {
            Ok(()) => self.commands(&unfix),
            Err(problem) => Err(problem),
        }
    }

    /// Ends LAMMPS and MPI.
    pub fn end(self) {
        // SAFETY: the handle is open and not used again.
        unsafe {
            (self.library.close)(self.handle);
            (self.library.finalize)();
        }
    }
}

/// What is called back.
struct Hook<'a> {
    own: &'a Lammps,
    numbers: &'a CStr,
    told: &'a mut dyn FnMut(Atoms),
}

unsafe extern "C" fn called_back(
    hook: *mut c_void,
    step: i64,
    _: c_int,
    _: *mut c_int,
    _: *mut *mut c_double,
    _: *mut *mut c_double,
) {
    // SAFETY: `Lammps::run` gave this address, and waits there.
    let hook = unsafe { &mut *hook.cast::<Hook>() };
    // Nothing may unwind through LAMMPS.
    let done = catch_unwind(AssertUnwindSafe(|| {
        let own = hook.own;
        let count = |name: &CStr| own.setting(name).max(0) as usize;
        let local = count(c"nlocal");
        let all = local + count(c"nghost");
        // SAFETY: LAMMPS keeps these per-atom arrays with at least `nlocal + nghost` entries, the
        // vectors of three numbers in one block, and does not touch them during the call.
        let atoms = unsafe {
            Atoms {
                step: step.max(0) as u64,
                local,
                numbers: own.scalars(hook.numbers, all),
                place: own.vectors(c"x", all),
                velocity: own.vectors(c"v", all),
                spin: own.vectors(c"omega", all),
            }
        };
        (hook.told)(atoms);
    }));
    if done.is_err() {
        hook.own.ranks.abort(1);
    }
}

impl Lammps {
    /// # Safety
    /// The per-atom array of whole numbers of this name, if there is one, has so many entries that
    /// stay as they are.
    unsafe fn scalars<'a>(&self, name: &CStr, count: usize) -> &'a [i32] {
        // SAFETY: the handle is open, the name a C string.
        let found = unsafe { (self.library.atoms)(self.handle, name.as_ptr()) };
        match found.is_null() || count == 0 {
            true => &[],
            // SAFETY: the caller says so.
            false => unsafe { std::slice::from_raw_parts(found.cast(), count) },
        }
    }

    /// # Safety
    /// The per-atom array of vectors of this name, if there is one, is one block with so many
    /// entries that stay as they are.
    unsafe fn vectors<'a>(&self, name: &CStr, count: usize) -> &'a [[f64; 3]] {
        // SAFETY: the handle is open, the name a C string.
        let rows = unsafe { (self.library.atoms)(self.handle, name.as_ptr()) };
        if rows.is_null() || count == 0 {
            return &[];
        }
        // SAFETY: an array of vectors is a list of addresses, the first of which is that of the block.
        let block = unsafe { *rows.cast::<*const [f64; 3]>() };
        match block.is_null() {
            true => &[],
            // SAFETY: the caller says so.
            false => unsafe { std::slice::from_raw_parts(block, count) },
        }
    }
}
