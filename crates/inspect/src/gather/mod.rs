//! A folder of recordings → a campaign: both tables filled from the names of the files, the
//! channels from what the files hold.

pub mod add;
pub mod channels;
mod folder;
pub mod names;
pub mod new;
pub mod preset;
mod rows;
pub mod text;
pub mod watch;
