//! What the user allows one command, and no other that runs in the same program.

use crate::confined::also_read;
use crate::written::{forget_lists, replace_files_of_others};
use std::path::PathBuf;
use std::sync::{PoisonError, RwLock, RwLockReadGuard, RwLockWriteGuard};
use windfall_source::stream::forget_streams;

/// What a command may do that others may not.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Allowed {
    /// Replace files that windfall did not write, or that were changed since.
    pub force: bool,
    /// Directories in which files may be named, besides those where the naming files lie.
    pub also_read: Vec<PathBuf>,
}

/// Held by each command that runs: by all together, or by one that is allowed more.
static TURN: RwLock<()> = RwLock::new(());

/// What a command is allowed, as long as this lives.
pub struct Allowance {
    _turn: Turn,
}

enum Turn {
    Shared {
        _held: RwLockReadGuard<'static, ()>,
    },
    Alone {
        _held: RwLockWriteGuard<'static, ()>,
    },
}

/// Begins a command: waits until those have ended that are allowed something else.
///
/// What is allowed is seen by all threads of the program. So a command that is allowed
/// anything runs alone, and one that is not never at the same time.
///
/// What was remembered for an earlier command is forgotten: lists of written files, which are
/// read again, and streams, unless a command that may have read them still runs.
#[must_use]
pub fn allow(allowed: Allowed) -> Allowance {
    forget_lists();
    if let Ok(_nobody) = TURN.try_write() {
        forget_streams();
    }
    if allowed == Allowed::default() {
        let held = TURN.read().unwrap_or_else(PoisonError::into_inner);
        return Allowance {
            _turn: Turn::Shared { _held: held },
        };
    }
    let held = TURN.write().unwrap_or_else(PoisonError::into_inner);
    replace_files_of_others(allowed.force);
    also_read(allowed.also_read);
    Allowance {
        _turn: Turn::Alone { _held: held },
    }
}

impl Drop for Turn {
    fn drop(&mut self) {
        if let Self::Alone { .. } = self {
            replace_files_of_others(false);
            also_read(Vec::new());
        }
    }
}
