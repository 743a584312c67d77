//! The library of LAMMPS and the MPI that it was built with, opened while the program runs:
//! windfall is linked with neither.
//!
//! This is the only crate that calls foreign functions. What it hands out is safe: atoms as
//! slices that end with a call back, messages between ranks as bytes. On systems other than Unix
//! no library is opened, and whoever asks is told so.
#![allow(unsafe_code)]

#[cfg_attr(unix, path = "loaded.rs")]
#[cfg_attr(not(unix), path = "loaded_nowhere.rs")]
mod loaded;
pub mod mpi;
pub mod run;
