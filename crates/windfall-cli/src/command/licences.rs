//! `windfall licences`

use crate::args::common::LicencesArguments;
use crate::outcome::{LicenceText, Licences, Part};
use crate::show::show;
use windfall_files::error::Error;
use windfall_files::table::write::csv_text;
use windfall_files::text::table::table_text;

/// Parts of the program, a line each: name, version, licence, kind, and the only build that holds
/// it. `tests/licences.rs` compares both files with what is built.
const PARTS: &str = include_str!("../../licences/parts.csv");

/// The texts, each below the parts that it belongs to.
const TEXTS: &str = include_str!("../../licences/texts.txt");

/// Line above each text.
const RULE: &str = "\n================================\n";

/// Shows the parts of the program with their licences.
pub fn run(arguments: &LicencesArguments) -> anyhow::Result<()> {
    let work = || {
        Ok::<_, Error>(Licences {
            parts: all_parts(),
            texts: arguments.texts.then(|| texts().collect()),
        })
    };
    let text = |own: &Licences| match own.texts {
        None => text_of_parts(),
        Some(_) => format!("{}{RULE}{TEXTS}", text_of_parts()),
    };
    show(&arguments.shown, work, text, csv_of_licences)?;
    Ok(())
}

fn csv_of_licences(licences: &Licences) -> Result<String, Error> {
    let Some(texts) = &licences.texts else {
        return Ok(PARTS.to_owned());
    };
    let rows = texts
        .iter()
        .map(|own| vec![own.parts.to_owned(), own.text.to_owned()]);
    csv_text(&["parts", "text"], rows)
}

fn all_parts() -> Vec<Part> {
    let cells = rows().map(|row| row.splitn(5, ','));
    let part = |mut cells: std::str::SplitN<'static, char>| {
        let mut cell = || cells.next().unwrap_or_default();
        Part {
            name: cell(),
            version: cell(),
            licence: cell(),
            kind: cell(),
            only: cell(),
        }
    };
    cells.map(part).collect()
}

fn rows() -> impl Iterator<Item = &'static str> {
    PARTS.lines().skip(1)
}

fn text_of_parts() -> String {
    let header = ["part", "version", "licence", "kind", "only in"].map(str::to_owned);
    let rows = all_parts().into_iter().map(|own| {
        [own.name, own.version, own.licence, own.kind, own.only]
            .map(str::to_owned)
            .to_vec()
    });
    table_text(&header, rows, &[0, 1, 2, 3, 4]) + "\n"
}

fn texts() -> impl Iterator<Item = LicenceText> {
    TEXTS.split(RULE).map(|own| {
        let (parts, text) = own.split_once("\n\n").unwrap_or((own, ""));
        LicenceText { parts, text }
    })
}
