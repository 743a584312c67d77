//! LZF decompression, for files of h5py.
//!
//! # Source
//! M. A. Lehmann, LibLZF block format: a control byte n < 32 precedes n + 1 literals;
//! otherwise its upper three bits give the length of a match minus two, its lower
//! five the high bits of the distance minus one.

/// Unpacks at most `most` bytes; `None` if the data are damaged or longer.
pub(crate) fn unpack_lzf(packed: &[u8], most: usize) -> Option<Vec<u8>> {
    let mut unpacked: Vec<u8> = Vec::new();
    let mut rest = packed;
    while let Some((control, behind)) = rest.split_first() {
        let control = usize::from(*control);
        rest = behind;
        if control < 32 {
            let (literals, behind) = rest.split_at_checked(control + 1)?;
            unpacked.extend_from_slice(literals);
            rest = behind;
        } else {
            let mut length = (control >> 5) + 2;
            if length == 9 {
                let (more, behind) = rest.split_first()?;
                length += usize::from(*more);
                rest = behind;
            }
            let (low, behind) = rest.split_first()?;
            rest = behind;
            let distance = ((control & 31) << 8) + usize::from(*low) + 1;
            let from = unpacked.len().checked_sub(distance)?;
            for i in from..from + length {
                unpacked.push(unpacked[i]);
            }
        }
        if unpacked.len() > most {
            return None;
        }
    }
    Some(unpacked)
}
