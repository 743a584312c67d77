//! A scene as a deck for LIGGGHTS.

use crate::engine_deck::{Deck, Task};

/// A deck for LIGGGHTS.
///
/// # Errors
/// What the engine cannot represent, each with its reason.
pub fn liggghts_deck(task: &Task) -> Result<Deck, Vec<String>> {
    let _ = task;
    Err(vec!["not yet".to_owned()])
}
