//! Lines of LabVIEW measurement files.

/// Start of the last blank line in `bytes`, and of the header after it.
pub fn header_begin(bytes: &[u8], separator: char) -> (usize, usize) {
    let blank = |line: &[u8]| {
        line.iter()
            .all(|b| b.is_ascii_whitespace() || *b == separator as u8)
    };
    let mut end = bytes.len();
    // The last line is that of the marker itself.
    while let Some(newline) = memchr::memrchr(b'\n', &bytes[..end]) {
        let line_begin = memchr::memrchr(b'\n', &bytes[..newline]).map_or(0, |at| at + 1);
        if blank(&bytes[line_begin..newline]) {
            return (line_begin, newline + 1);
        }
        end = newline;
    }
    (0, 0)
}

/// Cells of every line, without blanks around them.
pub fn split_lines(text: &str, separator: char) -> Vec<Vec<String>> {
    let cells = |line: &str| line.split(separator).map(|c| c.trim().to_owned()).collect();
    text.lines().map(cells).collect()
}
