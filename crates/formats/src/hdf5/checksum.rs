//! Checksums of metadata and of chunks.
//!
//! # Source
//! B. Jenkins (2006), lookup3.c, `hashlittle`; J. Fletcher (1982), "An arithmetic
//! checksum for serial transmissions", IEEE Trans. Commun. 30(1), 247-252, in the
//! form of HDF5 (`H5_checksum_fletcher32`).

/// Jenkins' lookup3 with initial value 0.
pub(crate) fn lookup3(bytes: &[u8]) -> u32 {
    let begin = 0xdead_beef_u32.wrapping_add(bytes.len() as u32);
    let [mut a, mut b, mut c] = [begin; 3];
    let word = |bytes: &[u8], at: usize| {
        (0..4).fold(0, |word, i| {
            word | u32::from(bytes.get(at + i).copied().unwrap_or(0)) << (8 * i)
        })
    };
    let mut rest = bytes;
    while rest.len() > 12 {
        a = a.wrapping_add(word(rest, 0));
        b = b.wrapping_add(word(rest, 4));
        c = c.wrapping_add(word(rest, 8));
        for (shift, turn) in [4, 6, 8, 16, 19, 4].into_iter().enumerate() {
            let (x, y, z) = match shift % 3 {
                0 => (&mut a, &mut b, &mut c),
                1 => (&mut b, &mut c, &mut a),
                _ => (&mut c, &mut a, &mut b),
            };
            *x = x.wrapping_sub(*z) ^ z.rotate_left(turn);
            *z = z.wrapping_add(*y);
        }
        rest = &rest[12..];
    }
    if rest.is_empty() {
        return c;
    }
    a = a.wrapping_add(word(rest, 0));
    b = b.wrapping_add(word(rest, 4));
    c = c.wrapping_add(word(rest, 8));
    for (x, y, turn) in [
        (2, 1, 14),
        (0, 2, 11),
        (1, 0, 25),
        (2, 1, 16),
        (0, 2, 4),
        (1, 0, 14),
        (2, 1, 24),
    ] {
        let words = [a, b, c];
        let mixed = (words[x] ^ words[y]).wrapping_sub(words[y].rotate_left(turn));
        match x {
            0 => a = mixed,
            1 => b = mixed,
            _ => c = mixed,
        }
    }
    c
}

/// Fletcher-32 as stored behind chunks.
pub(crate) fn fletcher32(bytes: &[u8]) -> u32 {
    let (mut first, mut second) = (0_u32, 0_u32);
    let fold = |sum: u32| (sum & 0xffff) + (sum >> 16);
    let (pairs, last) = bytes.as_chunks::<2>();
    // At most 360 pairs keep the sums below 2³².
    for pairs in pairs.chunks(360) {
        for pair in pairs {
            first += u32::from(u16::from_be_bytes(*pair));
            second += first;
        }
        (first, second) = (fold(first), fold(second));
    }
    if let [last] = last {
        first += u32::from(*last) << 8;
        second += first;
        (first, second) = (fold(first), fold(second));
    }
    fold(second) << 16 | fold(first)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reference_lookup3() {
        // lookup3.c, driver5: hashlittle with the initial value 0.
        assert_eq!(lookup3(b""), 0xdead_beef);
        assert_eq!(lookup3(b"Four score and seven years ago"), 0x1777_0551);
    }
}
