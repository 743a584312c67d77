//! How far work has come, and whether it is to go on.

use crate::error::Error;
use rayon::prelude::*;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// Called from any thread with the items done and all items; tells whether to continue.
pub type Progress<'a> = &'a (dyn Fn(usize, usize) -> ControlFlow<()> + Sync);

/// No-op progress; never cancels.
pub fn quiet(_done: usize, _all: usize) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

/// Does `work` for each number below `all`, on all cores; results are in order.
///
/// # Errors
/// [`Error::Cancelled`] when `progress` does not go on; items that are being worked
/// on are finished first.
pub fn for_each<T: Send>(
    progress: Progress,
    all: usize,
    work: impl Fn(usize) -> T + Sync,
) -> Result<Vec<T>, Error> {
    let (done, stopped) = (AtomicUsize::new(0), AtomicBool::new(false));
    let tell = |done: usize| {
        if progress(done, all).is_break() {
            stopped.store(true, Ordering::Relaxed);
        }
    };
    tell(0);
    let results: Option<Vec<T>> = (0..all)
        .into_par_iter()
        .map(|item| {
            if stopped.load(Ordering::Relaxed) {
                return None;
            }
            let result = work(item);
            tell(done.fetch_add(1, Ordering::Relaxed) + 1);
            Some(result)
        })
        .collect();
    match (results, stopped.into_inner()) {
        (Some(results), false) => Ok(results),
        _ => Err(Error::Cancelled),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn repeats_the_order_of_the_items() {
        let squares = for_each(&quiet, 1000, |i| i * i).unwrap();
        assert!(squares.iter().enumerate().all(|(i, s)| *s == i * i));
    }

    #[test]
    fn rejects_items_after_the_work_was_stopped() {
        let worked = AtomicUsize::new(0);
        let stop = |done: usize, _all: usize| match done < 3 {
            true => ControlFlow::Continue(()),
            false => ControlFlow::Break(()),
        };
        let found = for_each(&stop, 1000, |_| worked.fetch_add(1, Ordering::Relaxed));
        assert!(matches!(found, Err(Error::Cancelled)));
        assert!(worked.into_inner() < 100);
    }
}
