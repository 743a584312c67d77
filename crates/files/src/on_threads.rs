//! Work on a given number of threads.

use crate::error::Error;

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
    let pool = pool.map_err(|error| Error::OptionInvalid {
        option: format!("--threads {threads}"),
        problem: error.to_string(),
    })?;
    pool.install(work)
}
