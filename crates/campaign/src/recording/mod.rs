//! From a file of any format to a recording in SI units, and to one impact.

pub mod channel;
pub mod digests;
pub mod extract;
pub mod find_channel;
pub mod parts;
pub mod pendulum_angles;
pub mod read;
pub mod request;
