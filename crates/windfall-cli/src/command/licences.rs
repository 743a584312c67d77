//! `windfall licences`

use crate::args::common::LicencesArguments;
use crate::args::format::Format;
use crate::show::{write_json, write_result};
use serde::Serialize;
use windfall_files::table::write::csv_text;
use windfall_files::text::table::table_text;

/// Parts of the program, a line each: name, version, licence, kind, and the only build that holds
/// it. `tests/licences.rs` compares both files with what is built.
const PARTS: &str = include_str!("../../licences/parts.csv");

/// The texts, each below the parts that it belongs to.
const TEXTS: &str = include_str!("../../licences/texts.txt");

/// Line above each text.
const RULE: &str = "\n================================\n";

#[derive(Serialize)]
struct Part {
    name: &'static str,
    version: &'static str,
    licence: &'static str,
    kind: &'static str,
    only: &'static str,
}

#[derive(Serialize)]
struct Text {
    parts: &'static str,
    text: &'static str,
}

/// Shows the parts of the program with their licences.
pub fn run(arguments: &LicencesArguments) -> anyhow::Result<()> {
    match (arguments.format, arguments.texts) {
        (Format::Text, false) => write_result(&text_of_parts()),
        (Format::Text, true) => write_result(&format!("{}{RULE}{TEXTS}", text_of_parts())),
        (Format::Csv, false) => write_result(PARTS),
        (Format::Csv, true) => {
            let rows = texts().map(|own| vec![own.parts.to_owned(), own.text.to_owned()]);
            write_result(&csv_text(&["parts", "text"], rows)?)
        }
        (Format::Json, false) => write_json(&serde_json::json!({ "parts": all_parts() })),
        (Format::Json, true) => {
            let texts: Vec<Text> = texts().collect();
            write_json(&serde_json::json!({ "parts": all_parts(), "texts": texts }))
        }
    }
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

fn texts() -> impl Iterator<Item = Text> {
    TEXTS.split(RULE).map(|own| {
        let (parts, text) = own.split_once("\n\n").unwrap_or((own, ""));
        Text { parts, text }
    })
}
