//! Interruption of the program.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Exit status of a program that was interrupted, as shells have it.
const INTERRUPTED: i32 = 130;

/// Resolves when the user interrupts the program or the system asks it to end.
pub(crate) async fn interrupted() {
    #[cfg(unix)]
    {
        use tokio::signal::unix::{SignalKind, signal};
        if let Ok(mut asked) = signal(SignalKind::terminate()) {
            tokio::select! {
                _ = tokio::signal::ctrl_c() => {}
                _ = asked.recv() => {}
            }
            return;
        }
    }
    let _ = tokio::signal::ctrl_c().await;
}

/// A flag set by the first interruption; a second one ends the program at once.
///
/// Where the system gives no thread or no signal the flag stays as it is, and an interruption
/// ends the program at once.
pub fn interruption() -> Arc<AtomicBool> {
    let flag = Arc::new(AtomicBool::new(false));
    let set = Arc::clone(&flag);
    let watch = move || {
        let runtime = tokio::runtime::Builder::new_current_thread()
            .enable_io()
            .build();
        if let Ok(runtime) = runtime {
            runtime.block_on(interrupted());
            set.store(true, Ordering::Relaxed);
            // A second request means now.
            runtime.block_on(interrupted());
            std::process::exit(INTERRUPTED);
        }
    };
    // The caller carries on without it.
    let _ = std::thread::Builder::new()
        .name("interruption".into())
        .spawn(watch);
    flag
}
