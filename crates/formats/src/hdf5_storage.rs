//! The bytes of a file for the HDF5 decoder, and its limits.

use crate::error::{Error, Place};
use crate::hdf5_lzf::unpack_lzf;
use crate::source::Source;
use hdf5_reader::error::Error as Fault;
use hdf5_reader::{FilterRegistry, Hdf5File, OpenOptions, Storage, StorageBuffer};
use std::path::Path;
use std::sync::Arc;

/// Largest chunk that is unpacked; bytes. Programs write some MB.
pub(crate) const LARGEST_CHUNK: usize = 256 << 20;

/// Largest part of a dataset that is decoded at once; bytes.
const LARGEST_READ: usize = 256 << 20;

/// Largest header of a group or dataset; bytes.
const LARGEST_HEADER: usize = 16 << 20;

/// Unpacked chunks that are kept; bytes.
const KEPT_CHUNKS: usize = 64 << 20;

/// What to do with a file that cannot be decoded.
const ADVICE: &str =
    "the file is damaged or was not closed: copy it again from where it was recorded";

/// What to do with what is not decoded.
const EXPORT: &str = "save it without that, for example with h5repack or as CSV";

/// The filter of h5py's "lzf".
const LZF: u16 = 32000;

struct SourceStorage(Arc<Source>);

impl Storage for SourceStorage {
    fn len(&self) -> u64 {
        self.0.length()
    }

    fn read_range(&self, offset: u64, len: usize) -> Result<StorageBuffer, Fault> {
        let eof = || Fault::UnexpectedEof {
            offset,
            needed: len as u64,
            available: self.0.length().saturating_sub(offset),
        };
        match self.0.bytes_at(offset, len as u64) {
            Ok(bytes) => Ok(StorageBuffer::from_vec(bytes)),
            Err(Error::Access { source, .. }) => Err(Fault::Io(source)),
            Err(_) => Err(eof()),
        }
    }
}

/// Opens a file with bounds for what it may make the decoder allocate.
///
/// # Errors
/// It is no HDF5 file, or its beginning is damaged.
pub(crate) fn open_file(source: Arc<Source>) -> Result<Hdf5File, Error> {
    let mut filters = FilterRegistry::new();
    filters.register(
        LZF,
        Box::new(|filter, bytes, _| {
            let declared = filter
                .client_data
                .get(2)
                .map_or(LARGEST_CHUNK, |n| *n as usize);
            unpack_lzf(bytes, declared.min(LARGEST_CHUNK))
                .ok_or_else(|| Fault::DecompressionError("LZF data are damaged".to_owned()))
        }),
    );
    let options = OpenOptions {
        chunk_cache_bytes: KEPT_CHUNKS,
        filter_registry: Some(filters),
        max_chunk_bytes: LARGEST_CHUNK,
        max_read_bytes: LARGEST_READ,
        max_object_header_bytes: LARGEST_HEADER,
        ..OpenOptions::default()
    };
    let path = source.path().to_path_buf();
    Hdf5File::from_storage_with_options(Arc::new(SourceStorage(source)), options)
        .map_err(|fault| error_of(&path, Place::File, fault))
}

/// What a fault of the decoder means for a user.
pub(crate) fn error_of(path: &Path, place: Place, fault: Fault) -> Error {
    let path = path.to_path_buf();
    match fault {
        Fault::Context { source, .. } => error_of(&path, place, *source),
        Fault::Io(source) => Error::Access { path, source },
        Fault::UnexpectedEof {
            offset,
            needed,
            available,
        } => Error::Truncated {
            path,
            place: Place::Byte(offset),
            what: match place {
                Place::Object(name) => format!("what \"{name}\" declares here"),
                _ => "what is declared here".to_owned(),
            },
            needed,
            left: available,
        },
        Fault::ResourceLimit(what) => Error::Unsupported {
            path,
            place,
            what: format!("parts that large ({what})"),
            advice: EXPORT.to_owned(),
        },
        fault if is_unsupported(&fault) => Error::Unsupported {
            path,
            place,
            what: reason(&fault),
            advice: EXPORT.to_owned(),
        },
        fault => Error::Malformed {
            path,
            place,
            problem: fault.to_string(),
            advice: ADVICE.to_owned(),
        },
    }
}

/// Whether a fault says that the decoder lacks something, not the file.
fn is_unsupported(fault: &Fault) -> bool {
    matches!(
        fault,
        Fault::UnsupportedFilter(_)
            | Fault::UnsupportedEncoding(_)
            | Fault::UnsupportedDatatypeClass(_)
            | Fault::UnsupportedLayoutClass(_)
            | Fault::UnsupportedLayoutVersion(_)
            | Fault::UnsupportedChunkIndexType(_)
            | Fault::UnsupportedLinkType(_)
    )
}

/// A fault as the reason why something is left out.
pub(crate) fn reason(fault: &Fault) -> String {
    match fault {
        Fault::Context { source, .. } => reason(source),
        fault => fault.to_string(),
    }
}
