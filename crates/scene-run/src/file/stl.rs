//! Reads triangles from binary and text STL files.
//!
//! Coordinates of text files keep double precision, and faults are located by byte or
//! line and triangle; `stl_io` does neither.

use crate::file_error::access;
use std::path::Path;
use windfall_files::error::Error;
use windfall_files::inputs::{check_regular, protect};
use windfall_scene::vector::Vector;

/// Why a file is not a valid STL file.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum StlProblem {
    /// Truncated before the first facet.
    #[error("it is no STL file: it has {bytes} bytes, and the shortest has 134")]
    Short {
        /// Length of the file.
        bytes: usize,
    },
    /// No triangles.
    #[error("there is no triangle in it")]
    Empty,
    /// A binary file is shorter than its count of triangles requires.
    #[error(
        "it says (at byte 80) that it has {said} triangles, which take {needed} bytes, but it has \
         {bytes}: it was cut off after triangle {whole}, or is no binary STL file"
    )]
    Cut {
        /// Declared number of triangles.
        said: u32,
        /// Bytes they take.
        needed: u64,
        /// Length of the file; bytes.
        bytes: usize,
        /// Complete triangles in the file.
        whole: usize,
    },
    /// A binary file is longer than its count of triangles requires.
    #[error(
        "it says (at byte 80) that it has {said} triangles, which end at byte {needed}, but it has \
         {bytes} bytes, room for {whole}: write it anew"
    )]
    Beyond {
        /// Declared number of triangles.
        said: u32,
        /// Bytes they take.
        needed: u64,
        /// Length of the file; bytes.
        bytes: usize,
        /// Triangles that would fit.
        whole: usize,
    },
    /// A coordinate of a binary file is not finite.
    #[error("triangle {triangle} (at byte {byte}): a coordinate is {value}")]
    NotFinite {
        /// Counted from 1.
        triangle: usize,
        /// Offset of the coordinate.
        byte: usize,
        value: f32,
    },
    /// Unexpected word in a text file.
    #[error("line {line}, triangle {triangle}: expected {expected}, found {found}")]
    Word {
        /// Counted from 1.
        line: usize,
        /// Counted from 1.
        triangle: usize,
        /// Expected word.
        expected: &'static str,
        /// Word found.
        found: String,
    },
}

/// Reads the triangles of an STL file, in the unit of the file.
///
/// # Errors
/// The file cannot be read; the inner error says that it is not a complete STL file.
pub fn read_stl(path: &Path) -> Result<Result<Vec<[Vector; 3]>, StlProblem>, Error> {
    check_regular(path)?;
    protect(path);
    let bytes = std::fs::read(path).map_err(|source| match source.kind() {
        std::io::ErrorKind::NotFound => Error::FileAbsent {
            path: path.to_path_buf(),
            advice: "`mesh = { file = … }` names an STL file beside the scene".to_owned(),
        },
        _ => access(path, "read")(source),
    })?;
    Ok(triangles_of(&bytes))
}

/// Header of a binary file: a text and the number of triangles; bytes.
const HEAD: usize = 84;
/// Triangle of a binary file: normal, three corners, two more bytes; bytes.
const TRIANGLE: usize = 50;

/// Parses the triangles of an STL file.
///
/// Text files begin with `solid`; so do some binary ones, recognised by their length.
/// Normals are ignored, as walls act on both sides.
///
/// # Errors
/// It is not a complete STL file; the problem says where.
///
/// # Source
/// 3D Systems (1989), StereoLithography Interface Specification.
pub fn triangles_of(bytes: &[u8]) -> Result<Vec<[Vector; 3]>, StlProblem> {
    let said = bytes.get(80..HEAD).map(|own| {
        let own = [own[0], own[1], own[2], own[3]];
        u32::from_le_bytes(own)
    });
    let needed = said.map(|said| HEAD as u64 + TRIANGLE as u64 * u64::from(said));
    let binary = needed == Some(bytes.len() as u64);
    let text = !binary && is_text(bytes);
    let triangles = match (text, said.zip(needed)) {
        (true, _) => of_text(bytes)?,
        (false, None) => return Err(StlProblem::Short { bytes: bytes.len() }),
        (false, Some((said, needed))) => of_binary(bytes, said, needed)?,
    };
    match triangles.is_empty() {
        true => Err(StlProblem::Empty),
        false => Ok(triangles),
    }
}

/// Whether the first word is `solid` and the rest is text.
fn is_text(bytes: &[u8]) -> bool {
    let from = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let from = from.trim_ascii_start();
    let named = from
        .get(..5)
        .is_some_and(|word| word.eq_ignore_ascii_case(b"solid"));
    // Names may be in any language, but text contains no zero bytes.
    named && !from.iter().take(1024).any(|&byte| byte == 0)
}

fn of_binary(bytes: &[u8], said: u32, needed: u64) -> Result<Vec<[Vector; 3]>, StlProblem> {
    let whole = (bytes.len() - HEAD) / TRIANGLE;
    let own = bytes.len();
    if (own as u64) < needed {
        return Err(StlProblem::Cut {
            said,
            needed,
            bytes: own,
            whole,
        });
    }
    if own as u64 > needed {
        return Err(StlProblem::Beyond {
            said,
            needed,
            bytes: own,
            whole,
        });
    }
    let mut triangles = Vec::with_capacity(whole);
    for (number, record) in bytes[HEAD..].chunks_exact(TRIANGLE).enumerate() {
        let mut corners = [[0.0; 3]; 3];
        for (place, value) in corners.as_flattened_mut().iter_mut().enumerate() {
            let at = 12 + 4 * place;
            let own = [record[at], record[at + 1], record[at + 2], record[at + 3]];
            let own = f32::from_le_bytes(own);
            if !own.is_finite() {
                return Err(StlProblem::NotFinite {
                    triangle: number + 1,
                    byte: HEAD + TRIANGLE * number + at,
                    value: own,
                });
            }
            *value = f64::from(own);
        }
        triangles.push(corners);
    }
    Ok(triangles)
}

/// Words of a text file, with line numbers.
struct Words<'a> {
    words: std::iter::Peekable<Box<dyn Iterator<Item = (usize, &'a str)> + 'a>>,
    line: usize,
    triangle: usize,
}

impl<'a> Words<'a> {
    /// Checks that these words come next.
    fn require(&mut self, expected: &'static str) -> Result<(), StlProblem> {
        for word in expected.split(' ') {
            let found = self.words.next();
            if !found.is_some_and(|(_, own)| own.eq_ignore_ascii_case(word)) {
                return Err(self.unlike(expected, found));
            }
            self.line = found.map_or(self.line, |(line, _)| line);
        }
        Ok(())
    }

    fn number(&mut self) -> Result<f64, StlProblem> {
        let found = self.words.next();
        let number = found.and_then(|(_, own)| own.parse::<f64>().ok());
        let number = number.filter(|own| own.is_finite());
        self.line = found.map_or(self.line, |(line, _)| line);
        number.ok_or_else(|| self.unlike("a number", found))
    }

    fn unlike(&self, expected: &'static str, found: Option<(usize, &'a str)>) -> StlProblem {
        StlProblem::Word {
            line: found.map_or(self.line, |(line, _)| line),
            triangle: self.triangle,
            expected,
            found: found.map_or("the end of the file".to_owned(), |(_, own)| {
                let own: String = own.chars().take(40).collect();
                format!("\"{own}\"")
            }),
        }
    }
}

fn of_text(bytes: &[u8]) -> Result<Vec<[Vector; 3]>, StlProblem> {
    let text = String::from_utf8_lossy(bytes);
    let mut triangles = Vec::new();
    // After `solid` and `endsolid`, the rest of the line is an arbitrary name.
    let named = |line: &str, word: &str| {
        let first = line.split_whitespace().next().unwrap_or_default();
        first.eq_ignore_ascii_case(word)
    };
    let lines = text.trim_start_matches('\u{feff}').lines().enumerate();
    let words = lines.flat_map(move |(number, line)| {
        let only = named(line, "solid") || named(line, "endsolid");
        let most = if only { 1 } else { usize::MAX };
        let words = line.split_whitespace().take(most);
        words.map(move |word| (number + 1, word))
    });
    let words: Box<dyn Iterator<Item = (usize, &str)>> = Box::new(words);
    let mut words = Words {
        words: words.peekable(),
        line: 1,
        triangle: 1,
    };
    // Some files contain several bodies.
    while words.words.peek().is_some() {
        words.require("solid")?;
        let ends = |own: Option<&(usize, &str)>| {
            own.is_some_and(|(_, own)| own.eq_ignore_ascii_case("endsolid"))
        };
        while !ends(words.words.peek()) {
            words.triangle = triangles.len() + 1;
            if !words
                .words
                .peek()
                .is_some_and(|(_, own)| own.eq_ignore_ascii_case("facet"))
            {
                let found = words.words.next();
                return Err(words.unlike("facet or endsolid", found));
            }
            words.require("facet normal")?;
            // Skip its three numbers: they are not used, and some programs write nan.
            for _ in 0..3 {
                words.words.next();
            }
            words.require("outer loop")?;
            let mut corners = [[0.0; 3]; 3];
            for corner in &mut corners {
                words.require("vertex")?;
                for value in corner {
                    *value = words.number()?;
                }
            }
            words.require("endloop")?;
            words.require("endfacet")?;
            triangles.push(corners);
        }
        words.require("endsolid")?;
    }
    Ok(triangles)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn binary(head: &[u8], triangles: &[[[f32; 3]; 3]]) -> Vec<u8> {
        let mut bytes = head.to_vec();
        bytes.resize(80, b' ');
        bytes.extend((triangles.len() as u32).to_le_bytes());
        for own in triangles {
            bytes.extend([0; 12]);
            for value in own.as_flattened() {
                bytes.extend(value.to_le_bytes());
            }
            bytes.extend([0; 2]);
        }
        bytes
    }

    const TWO: [[[f32; 3]; 3]; 2] = [
        [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.5, 0.25]],
        [[0.0, 0.0, 0.0], [0.0, 1.5, 0.25], [-1.0, 0.0, 0.0]],
    ];

    const TEXT: &str = "solid Trichter für Äpfel\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   \
        vertex 1 0 0\n   vertex 0 1.5 2.5e-1\n  endloop\n endfacet\n FACET NORMAL nan nan nan\n  outer loop\n   \
        vertex 0 0 0\n   vertex 0 1.5 0.25\n   vertex -1 0 0\n  endloop\n endfacet\nendsolid Trichter\n";

    #[test]
    fn binary_and_text_hold_the_same() {
        let wanted = TWO.map(|own| own.map(|corner| corner.map(f64::from)));
        assert_eq!(
            triangles_of(&binary(b"made by hand", &TWO)).unwrap(),
            wanted
        );
        // Some programs begin binary files like text.
        assert_eq!(
            triangles_of(&binary(b"solid hopper", &TWO)).unwrap(),
            wanted
        );
        assert_eq!(triangles_of(TEXT.as_bytes()).unwrap(), wanted);
        assert_eq!(
            triangles_of(TEXT.replace('\n', "\r\n").as_bytes()).unwrap(),
            wanted
        );
        let marked = format!("\u{feff}\n\n{}", TEXT.to_uppercase());
        assert_eq!(triangles_of(marked.as_bytes()).unwrap(), wanted);
        // Names in an old encoding, two bodies.
        let mut old = TEXT.replace("für", "f?r").into_bytes();
        let at = old.iter().position(|&byte| byte == b'?').unwrap();
        old[at] = 0xfc;
        assert_eq!(triangles_of(&[old.clone(), old].concat()).unwrap().len(), 4);
    }

    #[test]
    fn rejects_binary_files_that_are_not_whole() {
        let whole = binary(b"solid", &TWO);
        for length in 0..whole.len() {
            let problem = triangles_of(&whole[..length]).unwrap_err().to_string();
            assert!(!problem.is_empty());
        }
        let problem = triangles_of(&whole[..150]).unwrap_err().to_string();
        assert!(
            problem.contains("2 triangles") && problem.contains("after triangle 1"),
            "{problem}"
        );
        let mut more = whole.clone();
        more.extend([0; 50]);
        let problem = triangles_of(&more).unwrap_err().to_string();
        assert!(problem.contains("room for 3"), "{problem}");
        let mut wrong = whole;
        wrong[80..84].copy_from_slice(&u32::MAX.to_le_bytes());
        let problem = triangles_of(&wrong).unwrap_err().to_string();
        assert!(problem.contains("4294967295 triangles"), "{problem}");
        let mut nan = TWO;
        nan[1][2][1] = f32::NAN;
        let problem = triangles_of(&binary(b"", &nan)).unwrap_err().to_string();
        assert!(problem.contains("triangle 2 (at byte 174)"), "{problem}");
        assert_eq!(triangles_of(&binary(b"", &[])), Err(StlProblem::Empty));
    }

    #[test]
    fn rejects_text_files_with_the_line() {
        for (old, new, words) in [
            (
                "vertex 1 0 0",
                "vertex 1 0 zero",
                "line 5, triangle 1: expected a number, found \"zero\"",
            ),
            (
                "vertex 1 0 0",
                "vertex 1 0 nan",
                "line 5, triangle 1: expected a number",
            ),
            ("vertex 1 0 0", "vertex 1 0 1e999", "line 5"),
            (
                "vertex 1 0 0",
                "vertex 1 0",
                "line 6, triangle 1: expected a number, found \"vertex\"",
            ),
            (
                "vertex 1 0 0\n",
                "",
                "line 6, triangle 1: expected vertex, found \"endloop\"",
            ),
            (
                "-1 0 0\n  endloop",
                "-1 0 0\n vertex 1 1 1\n endloop",
                "triangle 2: expected endloop",
            ),
            (
                "endsolid Trichter\n",
                "",
                "line 15, triangle 3: expected facet or endsolid, found the end",
            ),
            (
                "endfacet\nendsolid Trichter\n",
                "endfac",
                "expected endfacet, found \"endfac\"",
            ),
        ] {
            assert!(TEXT.contains(old), "{old}");
            let problem = triangles_of(TEXT.replace(old, new).as_bytes()).unwrap_err();
            let problem = problem.to_string();
            assert!(problem.contains(words), "{new}: {problem}");
        }
        assert_eq!(
            triangles_of(b"solid nothing\nendsolid nothing\n"),
            Err(StlProblem::Empty)
        );
        assert!(
            triangles_of(b"")
                .unwrap_err()
                .to_string()
                .contains("0 bytes")
        );
        let page = triangles_of(&[b'<'; 400]).unwrap_err().to_string();
        assert!(page.contains("no binary STL file"), "{page}");
    }
}
