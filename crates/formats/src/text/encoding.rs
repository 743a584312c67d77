//! Text encodings.

use std::borrow::Cow;

/// Text encodings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Encoding {
    /// UTF-8, including ASCII.
    Utf8,
    /// Windows-1252, nearly a superset of ISO 8859-1.
    Windows1252,
    /// UTF-16, little-endian.
    Utf16Le,
    /// UTF-16, big-endian.
    Utf16Be,
}

/// Characters 0x80 to 0x9f of Windows-1252; the others match Unicode.
///
/// # Source
/// WHATWG, Encoding Standard, index windows-1252.
const WINDOWS_1252: [char; 32] = [
    '€', '\u{81}', '‚', 'ƒ', '„', '…', '†', '‡', 'ˆ', '‰', 'Š', '‹', 'Œ', '\u{8d}', 'Ž', '\u{8f}',
    '\u{90}', '‘', '’', '“', '”', '•', '–', '—', '˜', '™', 'š', '›', 'œ', '\u{9d}', 'ž', 'Ÿ',
];

impl Encoding {
    /// Bytes per code unit, and so per line break.
    pub(crate) fn unit(self) -> usize {
        match self {
            Self::Utf8 | Self::Windows1252 => 1,
            Self::Utf16Le | Self::Utf16Be => 2,
        }
    }

    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Utf8 => "UTF-8",
            Self::Windows1252 => "Windows-1252",
            Self::Utf16Le => "UTF-16LE",
            Self::Utf16Be => "UTF-16BE",
        }
    }

    /// Decodes bytes; invalid sequences become "\u{fffd}".
    pub fn decode(self, bytes: &[u8]) -> Cow<'_, str> {
        match self {
            Self::Utf8 => match std::str::from_utf8(bytes) {
                Ok(text) => Cow::Borrowed(text),
                Err(_) => String::from_utf8_lossy(bytes),
            },
            Self::Windows1252 => match std::str::from_utf8(bytes) {
                Ok(text) if bytes.is_ascii() => Cow::Borrowed(text),
                _ => bytes.iter().map(|&byte| windows_1252(byte)).collect(),
            },
            Self::Utf16Le => utf16(bytes, u16::from_le_bytes),
            Self::Utf16Be => utf16(bytes, u16::from_be_bytes),
        }
    }
}

fn windows_1252(byte: u8) -> char {
    match byte {
        0x80..=0x9f => WINDOWS_1252[usize::from(byte - 0x80)],
        other => char::from(other),
    }
}

fn utf16(bytes: &[u8], unit: fn([u8; 2]) -> u16) -> Cow<'static, str> {
    let units = bytes.chunks_exact(2).map(|pair| unit([pair[0], pair[1]]));
    char::decode_utf16(units)
        .map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER))
        .collect()
}

/// Detects the encoding from the first bytes; also the length of the byte order mark.
pub fn tell_encoding(head: &[u8]) -> (Encoding, usize) {
    if head.starts_with(b"\xef\xbb\xbf") {
        return (Encoding::Utf8, 3);
    }
    if head.starts_with(b"\xff\xfe") {
        return (Encoding::Utf16Le, 2);
    }
    if head.starts_with(b"\xfe\xff") {
        return (Encoding::Utf16Be, 2);
    }
    if head.is_ascii() && !head.contains(&0) {
        return (Encoding::Utf8, 0);
    }
    // Tables are nearly all ASCII, so in UTF-16 every other byte is zero.
    let every_other = |odd: usize| head.iter().skip(odd).step_by(2);
    let zeros = |odd: usize| every_other(odd).filter(|b| **b == 0).count();
    let half = head.len() / 2;
    if half > 1 && zeros(1) * 10 > half * 9 && zeros(0) == 0 {
        return (Encoding::Utf16Le, 0);
    }
    if half > 1 && zeros(0) * 10 > half * 9 && zeros(1) == 0 {
        return (Encoding::Utf16Be, 0);
    }
    match std::str::from_utf8(head) {
        Ok(_) => (Encoding::Utf8, 0),
        // The sample ends within a character.
        Err(error) if error.error_len().is_none() => (Encoding::Utf8, 0),
        Err(_) => (Encoding::Windows1252, 0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_encodings_are_told_and_decoded() {
        let text = "Zeit (s);Kraft (N);Temp (°C)\n0,5;1,25;20\n";
        let utf16 = |f: fn(u16) -> [u8; 2]| text.encode_utf16().flat_map(f).collect::<Vec<u8>>();
        let latin: Vec<u8> = text.chars().map(|c| c as u32 as u8).collect();
        let mut marked = b"\xff\xfe".to_vec();
        marked.extend(utf16(u16::to_le_bytes));
        for (bytes, encoding, mark) in [
            (text.as_bytes().to_vec(), Encoding::Utf8, 0),
            (latin, Encoding::Windows1252, 0),
            (utf16(u16::to_le_bytes), Encoding::Utf16Le, 0),
            (utf16(u16::to_be_bytes), Encoding::Utf16Be, 0),
            (marked, Encoding::Utf16Le, 2),
        ] {
            assert_eq!(tell_encoding(&bytes), (encoding, mark));
            assert_eq!(encoding.decode(&bytes[mark..]), text);
        }
        assert_eq!(Encoding::Windows1252.decode(b"\x80\x96"), "€–");
    }
}
