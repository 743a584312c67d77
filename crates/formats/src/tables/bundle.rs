//! Tables that are read as one file.

use crate::contents::{ChannelContents, Contents, Format, Note, TimeBase};
use crate::names::Names;
use crate::reader::{Reader, Sink};
use crate::text::read::TextReader;
use windfall_source::error::Error;

/// A table of a file.
#[derive(Debug)]
pub struct Part {
    /// What stands before the names of its channels: "sheet/", or nothing.
    pub before: String,
    /// What stands behind them: " (segment 2)", or nothing.
    pub behind: String,
    pub reader: TextReader,
}

impl Part {
    fn named(&self, name: &str) -> String {
        format!("{}{name}{}", self.before, self.behind)
    }

    /// A note of this table, as one of the whole file.
    fn noted(&self, note: &Note) -> Note {
        let label = format!("{}{}", self.before.trim_end_matches('/'), self.behind);
        let told = |text: &String| match label.trim() {
            "" => text.clone(),
            label => format!("{}: {text}", label.trim_matches(['(', ')'])),
        };
        match note {
            Note::LeftOut { what, why } => Note::LeftOut {
                what: told(what),
                why: why.clone(),
            },
            Note::Missing {
                column,
                count,
                line,
                word,
            } => Note::Missing {
                column: self.named(column),
                count: *count,
                line: *line,
                word: word.clone(),
            },
            Note::CutOff(text) => Note::CutOff(told(text)),
            Note::Assumed(text) => Note::Assumed(told(text)),
            Note::DecimalOrThousands(text) => Note::DecimalOrThousands(told(text)),
            Note::Odd(text) => Note::Odd(told(text)),
        }
    }
}

/// Tables that are read as one file.
#[derive(Debug)]
pub struct Bundle {
    parts: Vec<Part>,
    /// Table of each channel, and its place there.
    places: Vec<(usize, usize)>,
    contents: Contents,
}

impl Bundle {
    /// * `notes`: notes of the whole file
    pub fn new(format: Format, variant: String, parts: Vec<Part>, notes: Vec<Note>) -> Self {
        let mut contents = Contents {
            format,
            variant,
            channels: Vec::new(),
            properties: Vec::new(),
            notes,
        };
        let mut names = Names::default();
        let mut places = Vec::new();
        for (index, part) in parts.iter().enumerate() {
            let first = contents.channels.len();
            let own = part.reader.contents();
            for (place, channel) in own.channels.iter().enumerate() {
                contents.channels.push(ChannelContents {
                    name: names.unique(&part.named(&channel.name)),
                    time: match channel.time {
                        TimeBase::Channel(at) => TimeBase::Channel(first + at),
                        time => time,
                    },
                    ..channel.clone()
                });
                places.push((index, place));
            }
            let properties = own.properties.iter();
            let properties = properties.map(|(name, value)| (part.named(name), value.clone()));
            contents.properties.extend(properties);
            contents
                .notes
                .extend(own.notes.iter().map(|note| part.noted(note)));
        }
        Self {
            parts,
            places,
            contents,
        }
    }

    /// For each table, its wanted channels and their positions among all that are wanted.
    fn wanted(&self, wanted: &[usize]) -> Vec<(Vec<usize>, Vec<usize>)> {
        let of = |part: usize| {
            let all = wanted.iter().enumerate();
            all.filter(|(_, channel)| self.places[**channel].0 == part)
                .map(|(position, channel)| (self.places[*channel].1, position))
                .unzip()
        };
        (0..self.parts.len()).map(of).collect()
    }

    /// Takes over what a table has noted while it was read.
    fn note(&mut self, part: usize) {
        let part = &self.parts[part];
        for note in &part.reader.contents().notes {
            let note = part.noted(note);
            if !self.contents.notes.contains(&note) {
                self.contents.notes.push(note);
            }
        }
    }
}

/// Passes samples of one table on to the sink of the whole file.
struct Onwards<'a> {
    positions: Vec<usize>,
    sink: &'a mut dyn Sink,
}

impl Sink for Onwards<'_> {
    fn take(&mut self, position: usize, samples: &[f64]) -> Result<(), Error> {
        self.sink.take(self.positions[position], samples)
    }

    fn fault(&mut self, fault: Error) -> Result<(), Error> {
        self.sink.fault(fault)
    }
}

impl Reader for Bundle {
    fn contents(&self) -> &Contents {
        &self.contents
    }

    fn read(&mut self, wanted: &[usize], sink: &mut dyn Sink) -> Result<(), Error> {
        for (part, (channels, positions)) in self.wanted(wanted).into_iter().enumerate() {
            if !channels.is_empty() {
                let mut onwards = Onwards { positions, sink };
                self.parts[part].reader.read(&channels, &mut onwards)?;
                self.note(part);
            }
        }
        Ok(())
    }

    fn read_whole(&mut self, wanted: &[usize]) -> Result<Vec<Vec<f64>>, Error> {
        let mut all = vec![Vec::new(); wanted.len()];
        for (part, (channels, positions)) in self.wanted(wanted).into_iter().enumerate() {
            if !channels.is_empty() {
                let read = self.parts[part].reader.read_whole(&channels)?;
                for (position, samples) in positions.into_iter().zip(read) {
                    all[position] = samples;
                }
                self.note(part);
            }
        }
        Ok(all)
    }
}
