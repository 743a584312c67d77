//! Arrays of NumPy: single (.npy) and in archives (.npz).

mod data_type;
mod header;
pub mod read;
