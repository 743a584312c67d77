//! How far the work of a command has come.

use crate::caller::watch;
use crate::saying::{Saying, saying};
use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal;
use std::ops::ControlFlow;
use windfall_files::progress::Progress;

/// Does work under a progress bar on a terminal, where Ctrl-C interrupts the program; or under
/// the eyes of a program that called.
pub(crate) fn with_bar<T>(work: impl FnOnce(Progress) -> T) -> T {
    if let Some(watch) = watch() {
        return work(&*watch);
    }
    let mut bar = ProgressBar::hidden();
    let style = ProgressStyle::with_template("{bar:40} {pos}/{len} recordings, {eta} left");
    if std::io::stderr().is_terminal() && saying() != Saying::Little {
        bar = ProgressBar::new(0);
        if let Ok(style) = style {
            bar.set_style(style);
        }
    }
    let done = work(&|done, all| {
        bar.set_length(all as u64);
        bar.set_position(done as u64);
        ControlFlow::Continue(())
    });
    bar.finish_and_clear();
    done
}
