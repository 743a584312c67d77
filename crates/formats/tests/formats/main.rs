//! Readers of every format against other programs, by hand and damaged.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

mod channels;
mod crashes;
mod damage;
mod damage_arrays;
mod damage_members;
mod read_hdf5;
mod read_lvm;
mod read_mat;
mod read_npy;
mod read_sheets;
mod read_sigrok;
mod read_tdms;
mod read_text;
mod read_uff58;
mod read_wav;
mod read_zip;
mod seeds;
