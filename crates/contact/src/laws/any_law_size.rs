//! How many parameters a law can have.

/// Parameters that a law can have at most: a user's law; built-in ones have up
/// to four.
pub const LARGEST_PARAMETERS: usize = 6;
