//! How much a command says beside its result.

use std::cell::Cell;

/// How much a command says beside its result.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Saying {
    /// What went wrong.
    Little,
    /// Also what was written, and whence results come.
    #[default]
    Usual,
    /// Also which files it read and wrote, and how long it took.
    Much,
}

thread_local! {
    /// As the command that runs on this thread was asked.
    static SAYING: Cell<Saying> = const { Cell::new(Saying::Usual) };
}

/// From now on, the command on this thread says so much.
pub fn say(saying: Saying) {
    SAYING.set(saying);
}

/// How much the command on this thread says.
pub fn saying() -> Saying {
    SAYING.get()
}
