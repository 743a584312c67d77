//! Text tables of numbers: CSV in all its dialects.

use crate::contents::{ChannelContents, Contents, Format, Note, TimeBase};
use crate::names::Names;
use crate::reader::{Reader, Sink};
use crate::text::dialect::find_dialect;
use crate::text::encoding::{Encoding, tell_encoding};
use crate::text::ending::ending;
use crate::text::lines::Lines;
use crate::text::missing::MissingWords;
use crate::text::number::number;
use crate::text::options::{Dialect, TextOptions};
use crate::text::rows::{ColumnKind, RowPlan, Separator};
use crate::text::table::{Found, Table, read_table, read_whole_table, shortened};
use windfall_source::error::Error;
use windfall_source::source::Source;

/// Bytes used to detect the dialect.
const HEAD: u64 = 1 << 16;

/// Most lines used to detect the dialect.
const LINES: usize = 300;

/// A text table of numbers.
#[derive(Debug)]
pub struct TextReader {
    source: Source,
    contents: Contents,
    table: Table,
    /// File column of each channel.
    columns: Vec<usize>,
    /// Whether names stand above most columns, and no numbers.
    pub(crate) headed: bool,
}

impl TextReader {
    /// Detects the dialect of a file.
    pub fn open(source: Source, options: &TextOptions) -> Result<Self, Error> {
        let head = source.head(HEAD)?;
        let (told, mark) = tell_encoding(&head);
        let encoding = options.encoding.unwrap_or(told);
        let newline = match head.contains(&b'\n') {
            true => b'\n',
            false => b'\r',
        };
        let ending = ending(&source, encoding, newline, options.footer)?;
        let head = &head[..head.len().min(ending.rows_end as usize)];
        let text = encoding.decode(&head[mark.min(head.len())..]);
        if text.trim().is_empty() {
            return Err(Error::Empty {
                path: source.path().to_path_buf(),
                expected: "a header line with column names, then one line per sample",
            });
        }
        check_text(&source, &text)?;
        let mut lines: Vec<&str> = text.split(char::from(newline)).take(LINES).collect();
        // The last line may be incomplete, or empty after the last line break.
        if lines.len() > 1
            && (ending.rows_end > HEAD || lines.len() == LINES || lines[lines.len() - 1].is_empty())
        {
            lines.pop();
        }
        let plain: Vec<&str> = lines
            .iter()
            .map(|line| line.trim_end_matches('\r'))
            .collect();
        check_header_line(&source, options, plain.len())?;
        let dialect = find_dialect(&plain, options)
            .map_err(|at| no_table(&source, &plain, at, options.lines_above))?;

        let before: usize = lines[..dialect.first_row]
            .iter()
            .map(|l| encoded_length(l, encoding))
            .sum();
        let breaks = dialect.first_row * encoding.unit();
        let lines = Lines {
            start: (mark + before + breaks) as u64,
            end: ending.rows_end,
            encoding,
            newline,
        };
        let headed = is_headed(&dialect);
        let (mut contents, columns, names) = contents(&dialect, encoding);
        contents.notes.extend(ending.notes);
        let table = Table {
            plan: RowPlan {
                separator: dialect.separator,
                marks: dialect.marks,
                encoding,
                newline,
                comments: dialect.comments,
                columns: dialect.kinds,
                missing: MissingWords::new(&options.missing),
                short_rows: false,
            },
            lines,
            first_line: options.lines_above + dialect.first_row as u64 + 1,
            names,
        };
        Ok(Self {
            source,
            contents,
            table,
            columns,
            headed,
        })
    }

    /// Number of columns of the file, also of those that are left out.
    pub(crate) fn columns(&self) -> usize {
        self.table.names.len()
    }
}

/// Length of a line in the file; bytes.
fn encoded_length(line: &str, encoding: Encoding) -> usize {
    match encoding {
        Encoding::Utf8 => line.len(),
        Encoding::Windows1252 => line.chars().count(),
        Encoding::Utf16Le | Encoding::Utf16Be => 2 * line.encode_utf16().count(),
    }
}

/// Rejects files with many control characters.
fn check_text(source: &Source, text: &str) -> Result<(), Error> {
    let control = |c: &char| c.is_control() && !c.is_whitespace();
    let (all, strange) = match text.is_ascii() {
        true => {
            let strange = |b: &u8| u8::from((*b < 32 || *b == 127) && !(9..=13).contains(b));
            // Counts of so few bytes fit into bytes.
            let parts = text.as_bytes().chunks(255);
            let counts = parts.map(|part| usize::from(part.iter().map(strange).sum::<u8>()));
            (text.len(), counts.sum())
        }
        false => (text.chars().count(), text.chars().filter(control).count()),
    };
    if 50 * strange <= all {
        return Ok(());
    }
    Err(source.unknown(
        "this is a binary file of an unknown format",
        "export the recording as CSV, TDMS, MAT, HDF5, WAV or UFF58",
    ))
}

fn check_header_line(source: &Source, options: &TextOptions, lines: usize) -> Result<(), Error> {
    match options.header_line {
        Some(line) if line > lines as u64 => Err(Error::Setting {
            path: source.path().to_path_buf(),
            option: format!("header_line = {line}"),
            problem: format!("the beginning of the file has {lines} lines"),
        }),
        _ => Ok(()),
    }
}

fn no_table(source: &Source, lines: &[&str], at: usize, above: u64) -> Error {
    let line = lines.get(at).copied().unwrap_or_default();
    source.unknown(
        format!(
            "no table of numbers found (line {} reads \"{}\")",
            at as u64 + 1 + above,
            shortened(line.trim())
        ),
        "expected lines of numbers with commas, semicolons, tabs or blanks between them; \
                 the settings separator, decimal and header_line say how to read an unusual one",
    )
}

fn is_headed(dialect: &Dialect) -> bool {
    let named = dialect.names.iter().filter(|name| !name.is_empty());
    let numbers = |name: &String| number(name, dialect.marks).is_some();
    2 * named.clone().count() > dialect.names.len() && !dialect.names.iter().any(numbers)
}

fn contents(dialect: &Dialect, encoding: Encoding) -> (Contents, Vec<usize>, Vec<String>) {
    let mut notes = dialect.notes.clone();
    let names = unique_names(dialect, &mut notes);
    let mut columns = Vec::new();
    for (column, kind) in dialect.kinds.iter().enumerate() {
        match kind {
            ColumnKind::Text => notes.push(Note::LeftOut {
                what: format!("column \"{}\"", names[column]),
                why: "it holds text".to_owned(),
            }),
            _ => columns.push(column),
        }
    }
    let is_time = |column: usize| {
        is_time_name(&names[column]) || matches!(dialect.kinds[column], ColumnKind::Moments(_))
    };
    let mut time = columns.iter().position(|&column| is_time(column));
    if time.is_none() && dialect.rising_first {
        time = Some(0);
        notes.push(Note::Assumed(format!(
            "\"{}\" rises evenly and is taken as the time in seconds",
            names[columns[0]]
        )));
    }
    let mut channels = Vec::new();
    for (place, &column) in columns.iter().enumerate() {
        // A time column applies to those on its right, up to the next one.
        if is_time(column) {
            time = Some(place);
        }
        let moments = matches!(dialect.kinds[column], ColumnKind::Moments(_));
        channels.push(ChannelContents {
            name: names[column].clone(),
            unit: match moments {
                true => Some("s".to_owned()),
                false => dialect.units[column].clone(),
            },
            length: None,
            time: match time {
                Some(at) if at != place => TimeBase::Channel(at),
                _ => TimeBase::Unknown,
            },
            stored_as: if moments { "date and time" } else { "text" }.to_owned(),
            properties: Vec::new(),
        });
        if moments {
            notes.push(Note::Assumed(format!(
                "\"{}\" holds dates or times of day; it is read as seconds since the first row",
                names[column]
            )));
        }
    }
    let separator = match dialect.separator {
        Separator::Blanks => "blanks",
        Separator::Mark(b'\t') => "tabs",
        Separator::Mark(b';') => "semicolons",
        Separator::Mark(b',') => "commas",
        Separator::Mark(b'|') => "bars",
        Separator::Mark(_) => "other marks",
    };
    let decimal = match dialect.marks.decimal {
        b',' => ", decimal comma",
        _ => "",
    };
    let contents = Contents {
        format: Format::Text,
        variant: format!("with {separator}{decimal}, {}", encoding.name()),
        channels,
        properties: dialect.preamble.clone(),
        notes,
    };
    (contents, columns, names)
}

/// Unique names; unnamed columns are numbered.
fn unique_names(dialect: &Dialect, notes: &mut Vec<Note>) -> Vec<String> {
    let mut names = Names::default();
    let mut named = Vec::new();
    for (column, name) in dialect.names.iter().enumerate() {
        let wanted = match name.as_str() {
            "" => format!("column_{}", column + 1),
            name => name.to_owned(),
        };
        let unique = names.unique(&wanted);
        if unique != wanted {
            notes.push(Note::Odd(format!(
                    "the name \"{wanted}\" stands above several columns; column {} is called \"{unique}\"",
                    column + 1
                )));
        }
        named.push(unique);
    }
    named
}

/// Words in the names of time columns.
const TIME_WORDS: [&str; 10] = [
    "time",
    "zeit",
    "temps",
    "tiempo",
    "tempo",
    "tijd",
    "timestamp",
    "datum",
    "elapsed",
    "x_value",
];

/// Whether a column name suggests times.
pub fn is_time_name(name: &str) -> bool {
    let lower = name.to_lowercase();
    // In "Run 1: Time (s)", only the part after the last colon counts.
    let part = lower.rsplit(':').next().unwrap_or(&lower).trim();
    let bare = part
        .split(['(', '[', '_', '/'])
        .next()
        .unwrap_or(part)
        .trim();
    // "time_s", "Zeit (ms)" and "Prüfzeit" match, "Temperatur" does not.
    let words = |text: &str| {
        TIME_WORDS.iter().any(|word| {
            text.split(|c: char| !c.is_alphanumeric() && c != '_')
                .any(|w| {
                    w == *word
                        || (*word == "zeit" && w.ends_with(word))
                        || w.strip_prefix(word)
                            .is_some_and(|rest| rest.starts_with('_'))
                })
        })
    };
    bare == "t" || words(part)
}

impl Reader for TextReader {
    fn contents(&self) -> &Contents {
        &self.contents
    }

    fn read(&mut self, wanted: &[usize], sink: &mut dyn Sink) -> Result<(), Error> {
        let columns = wanted.iter().map(|&channel| self.columns[channel]);
        let wanted: Vec<(usize, usize)> = columns.zip(0..).collect();
        let found = read_table(&self.source, &self.table, &wanted, sink)?;
        self.note(found);
        Ok(())
    }

    fn read_whole(&mut self, wanted: &[usize]) -> Result<Vec<Vec<f64>>, Error> {
        let wanted: Vec<usize> = wanted
            .iter()
            .map(|&channel| self.columns[channel])
            .collect();
        let (columns, found) = read_whole_table(&self.source, &self.table, &wanted)?;
        self.note(found);
        Ok(columns)
    }
}

impl TextReader {
    fn note(&mut self, found: Found) {
        let expected = self.table.plan.columns.len();
        let mut notes = found.notes(&self.table.names);
        notes.extend(found.cut_off.map(|cut| {
            Note::CutOff(format!(
                "its last line, {}, has {} of {expected} cells and is left out",
                cut.line, cut.found
            ))
        }));
        notes.retain(|note| !self.contents.notes.contains(note));
        self.contents.notes.extend(notes);
    }
}
