//! What can be wrong with a file of columns.

use std::io::Error as IoError;
use std::path::Path;
use windfall_files::error::Error;

/// That a file of columns could not be written.
pub(crate) fn unwritable(
    path: &Path,
    source: impl std::error::Error + Send + Sync + 'static,
) -> Error {
    Error::access(path, "write", IoError::other(source))
}
