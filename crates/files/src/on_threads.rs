//! Work on a given number of threads.

use crate::error::Error;
use crate::option_value::unusable;

/// Does `work` on that many threads; on all cores when `None`.
///
/// # Errors
/// No threads can be had, and those of `work`.
pub fn on_threads<T: Send>(
    threads: Option<usize>,
    work: impl FnOnce() -> Result<T, Error> + Send,
) -> Result<T, Error> {
    let threads = threads.unwrap_or(0);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    let pool = pool.map_err(|error| unusable(format!("--threads {threads}"), error.to_string()))?;
    pool.install(work)
}
