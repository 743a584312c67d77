//! What ranks tell each other, through the MPI that LAMMPS has begun.

use crate::loaded::Loaded;
use std::ffi::{c_int, c_void};

/// The ranks of a run.
pub struct Ranks {
    calls: Option<Calls>,
    /// The own number.
    pub rank: usize,
    /// How many there are.
    pub size: usize,
}

/// MPI has two forms of handles: addresses in Open MPI, numbers in MPICH and all that keep to
/// its binary interface, such as Intel MPI and Cray MPICH.
enum Calls {
    Open(Functions<*mut c_void>),
    Mpich(Functions<c_int>),
}

type Gather<H> = unsafe extern "C" fn(*const c_void, c_int, H, *mut c_void, c_int, H, H) -> c_int;
type GatherParts<H> = unsafe extern "C" fn(
    *const c_void,
    c_int,
    H,
    *mut c_void,
    *const c_int,
    *const c_int,
    H,
    H,
) -> c_int;

struct Functions<H> {
    /// All ranks, and the types of numbers and bytes.
    world: H,
    int: H,
    byte: H,
    gather: Gather<H>,
    gather_parts: GatherParts<H>,
    abort: unsafe extern "C" fn(H, c_int) -> c_int,
}

/// Handles of MPICH's binary interface: all ranks, `MPI_INT`, `MPI_BYTE`.
///
/// # Source
/// MPICH ABI Compatibility Initiative; MPICH 3 and 4, `mpi.h`.
const MPICH: [c_int; 3] = [0x4400_0000, 0x4c00_0405, 0x4c00_010d];

impl Ranks {
    /// One rank without MPI.
    pub(crate) fn alone() -> Self {
        Self {
            calls: None,
            rank: 0,
            size: 1,
        }
    }

    /// The ranks that a launcher started; MPI has begun.
    ///
    /// # Errors
    /// It is an MPI of another interface.
    pub(crate) fn of(library: &Loaded) -> Result<Self, String> {
        let data = [c"ompi_mpi_comm_world", c"ompi_mpi_int", c"ompi_mpi_byte"];
        let data = data.map(|name| library.address(name));
        if let [Some(world), Some(int), Some(byte)] = data {
            let functions = Functions::of(library, [world, int, byte])?;
            // SAFETY: these are the functions of Open MPI, whose handles are addresses.
            return unsafe { Self::counted(library, functions, Calls::Open) };
        }
        let functions = Functions::of(library, MPICH)?;
        // SAFETY: an MPI without Open MPI's symbols has numbers as handles.
        unsafe { Self::counted(library, functions, Calls::Mpich) }
    }

    /// # Safety
    /// Handles of this MPI are of type `H`.
    unsafe fn counted<H: Copy>(
        library: &Loaded,
        functions: Functions<H>,
        calls: impl FnOnce(Functions<H>) -> Calls,
    ) -> Result<Self, String> {
        type Count<H> = unsafe extern "C" fn(H, *mut c_int) -> c_int;
        let mut counts = [0; 2];
        for (count, name) in counts.iter_mut().zip([c"MPI_Comm_rank", c"MPI_Comm_size"]) {
            // SAFETY: this is the type of both.
            let own = unsafe { library.function::<Count<H>>(name)? };
            // SAFETY: MPI has begun; it writes one number.
            unsafe { own(functions.world, count) };
        }
        let [rank, size] = counts;
        if size < 1 || !(0..size).contains(&rank) {
            return Err(format!("its MPI says rank {rank} of {size}"));
        }
        Ok(Self {
            calls: Some(calls(functions)),
            rank: rank as usize,
            size: size as usize,
        })
    }

    /// The bytes of each rank, by its number; every rank must call it.
    ///
    /// # Errors
    /// MPI fails; all messages together are too long for it.
    pub fn gather(&self, own: &[u8]) -> Result<Vec<Vec<u8>>, String> {
        match &self.calls {
            Some(Calls::Open(calls)) if self.size > 1 => calls.gather(own, self.size),
            Some(Calls::Mpich(calls)) if self.size > 1 => calls.gather(own, self.size),
            _ => Ok(vec![own.to_vec()]),
        }
    }

    /// Ends all ranks with a status.
    pub fn abort(&self, status: i32) -> ! {
        // SAFETY: MPI has begun; the call does not come back.
        match &self.calls {
            Some(Calls::Open(calls)) => unsafe { (calls.abort)(calls.world, status) },
            Some(Calls::Mpich(calls)) => unsafe { (calls.abort)(calls.world, status) },
            None => status,
        };
        std::process::exit(status)
    }
}

impl<H: Copy> Functions<H> {
    fn of(library: &Loaded, [world, int, byte]: [H; 3]) -> Result<Self, String> {
        // SAFETY: these are the types that the MPI standard gives them, with its handles.
        unsafe {
            Ok(Self {
                world,
                int,
                byte,
                gather: library.function(c"MPI_Allgather")?,
                gather_parts: library.function(c"MPI_Allgatherv")?,
                abort: library.function(c"MPI_Abort")?,
            })
        }
    }

    fn gather(&self, own: &[u8], size: usize) -> Result<Vec<Vec<u8>>, String> {
        let long = |_| "what ranks tell each other is too long for MPI".to_owned();
        let length = c_int::try_from(own.len()).map_err(long)?;
        let mut lengths = vec![0 as c_int; size];
        // SAFETY: one number goes out, and there is room for one of each rank.
        let status = unsafe {
            (self.gather)(
                (&raw const length).cast(),
                1,
                self.int,
                lengths.as_mut_ptr().cast(),
                1,
                self.int,
                self.world,
            )
        };
        done(status)?;
        if lengths.iter().all(|own| *own == 0) {
            return Ok(vec![Vec::new(); size]);
        }
        let mut starts = Vec::with_capacity(size);
        let mut all = 0 as c_int;
        for own in &lengths {
            starts.push(all);
            all = all
                .checked_add(*own)
                .ok_or_else(|| "what ranks tell each other is too long for MPI".to_owned())?;
        }
        let mut bytes = vec![0_u8; all as usize];
        // SAFETY: each rank sends as many bytes as it has said, and there is room for them
        // where they are put.
        let status = unsafe {
            (self.gather_parts)(
                own.as_ptr().cast(),
                length,
                self.byte,
                bytes.as_mut_ptr().cast(),
                lengths.as_ptr(),
                starts.as_ptr(),
                self.byte,
                self.world,
            )
        };
        done(status)?;
        let parts = starts.iter().zip(&lengths);
        let part = |(start, length): (&c_int, &c_int)| {
            bytes[*start as usize..(start + length) as usize].to_vec()
        };
        Ok(parts.map(part).collect())
    }
}

fn done(status: c_int) -> Result<(), String> {
    match status {
        0 => Ok(()),
        _ => Err(format!("MPI fails with {status}")),
    }
}
