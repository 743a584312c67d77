//! Files of columns as streams that other languages read.

use crate::error::Error;
use crate::read::MAGICS;
use arrow_array::RecordBatchReader;
use arrow_array::ffi_stream::FFI_ArrowArrayStream;
use arrow_ipc::reader::FileReader;
use parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder;
use std::fs::File;
use std::io::{BufReader, Read, Seek};
use std::path::Path;

/// The rows of a Parquet or Arrow file, through Arrow's interface of C (Apache Arrow
/// specification, "C stream interface").
///
/// # Errors
/// The file cannot be read or is damaged.
pub fn arrow_stream_of(path: &Path) -> Result<FFI_ArrowArrayStream, Error> {
    let mut file = File::open(path)?;
    let mut start = [0; 4];
    file.read_exact(&mut start)?;
    file.rewind()?;
    let batches: Box<dyn RecordBatchReader + Send> = match start == *MAGICS[0] {
        true => Box::new(ParquetRecordBatchReaderBuilder::try_new(file)?.build()?),
        false => Box::new(FileReader::try_new(BufReader::new(file), None)?),
    };
    Ok(FFI_ArrowArrayStream::new(batches))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rejects_what_is_no_file_of_columns() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("table.arrow");
        assert!(arrow_stream_of(&path).is_err());
        std::fs::write(&path, "a,b\n1,2\n").unwrap();
        assert!(arrow_stream_of(&path).is_err());
    }
}
