//! The library of LAMMPS and the MPI that it was built with, opened while the program runs:
//! windfall is linked with neither.
//!
//! This is the only crate that calls foreign functions. What it hands out is safe: atoms as
//! slices that end with a call back, messages between ranks as bytes.
#![allow(unsafe_code)]

#[cfg(unix)]
mod loaded;
#[cfg(unix)]
pub mod mpi;
#[cfg(unix)]
pub mod run;
