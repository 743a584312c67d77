//! The LZF compression of h5py.
//!
//! # Source
//! M. A. Lehmann, LibLZF, format of its blocks: a control byte below 32 announces
//! that many literals and one more; any other holds in three bits the length of a
//! repetition, less two, and in five the high bits of its distance, less one.

/// Unpacks a block to at most `most` bytes; `None` if it is damaged or longer.
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
