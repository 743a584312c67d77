//! Size and colour of the noise of a channel.

pub mod colour;
pub mod estimate;
pub mod gaussian;
