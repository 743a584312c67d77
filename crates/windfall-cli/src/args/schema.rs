//! Arguments of `windfall schema`.

use crate::args::kind::NewKind;
use crate::outcome::{RESULTS, ResultKind};
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::{Args, ValueEnum, ValueHint};
use std::path::PathBuf;

/// `windfall schema`
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  windfall schema pendulum --out my-campaign/campaign.schema.json
      and as the first line of campaign.toml: #:schema ./campaign.schema.json
  windfall schema regress
      keys of `windfall regress --format json`, whose \"schema\" is \"regress/1\"")]
pub struct SchemaArguments {
    /// What to describe: a file, by the kind of rig, as a scene or as a study of scenes; or the
    /// JSON of a command, by the name in its key "schema", with or without the number
    #[arg(value_parser = described())]
    pub kind: Described,
    /// Write it into this file
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub out: Option<PathBuf>,
}

/// What has a schema.
#[derive(Clone, Copy, Debug)]
pub enum Described {
    /// A file that is read.
    File(NewKind),
    /// JSON that a command shows.
    Result(&'static ResultKind),
}

impl Described {
    /// What is called so. A study of scenes is a file, and its result is called by its number too.
    fn of(word: &str) -> Option<Self> {
        if let Ok(kind) = NewKind::from_str(word, false) {
            return Some(Self::File(kind));
        }
        let mut results = RESULTS.iter();
        results
            .find(|own| [own.schema, own.name()].contains(&word))
            .map(Self::Result)
    }
}

fn described() -> impl TypedValueParser<Value = Described> {
    let kinds = NewKind::value_variants().iter();
    let files = kinds.filter_map(ValueEnum::to_possible_value);
    let results = RESULTS.iter().map(result_word);
    PossibleValuesParser::new(files.chain(results))
        .try_map(|word| Described::of(&word).ok_or("there is no such schema"))
}

/// A result among the words of the command.
fn result_word(kind: &ResultKind) -> PossibleValue {
    let word = match Described::of(kind.name()) {
        Some(Described::File(_)) => PossibleValue::new(kind.schema),
        _ => PossibleValue::new(kind.name()).alias(kind.schema),
    };
    word.help(kind.title)
}
