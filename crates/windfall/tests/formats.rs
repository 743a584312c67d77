//! A recording fits the same in every format that it is written in.

#![allow(clippy::unwrap_used)]

use std::path::Path;
use windfall_campaign::impacts::run::fit_campaign;
use windfall_campaign::pipeline::request::FitRequest;
use windfall_campaign::result::outcome::CampaignOutcome;

const FIXTURE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/fixtures/no_contact");

/// Fits the good recording of a fixture, written as `file` with `bytes`.
fn fit(file: &str, bytes: &[u8], files: &str) -> CampaignOutcome {
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path();
    std::fs::create_dir(folder.join("raw")).unwrap();
    std::fs::copy(
        Path::new(FIXTURE).join("specimens.csv"),
        folder.join("specimens.csv"),
    )
    .unwrap();
    std::fs::write(folder.join("raw").join(file), bytes).unwrap();
    std::fs::write(
        folder.join("impacts.csv"),
        format!("id,specimen,file\ngood,fruit,{file}\n"),
    )
    .unwrap();
    let campaign = std::fs::read_to_string(Path::new(FIXTURE).join("campaign.toml")).unwrap();
    std::fs::write(
        folder.join("campaign.toml"),
        campaign.replace("time = \"time_s\"", files),
    )
    .unwrap();
    let outcome = fit_campaign(
        folder,
        &FitRequest::default(),
        &windfall_files::progress::quiet,
    )
    .unwrap();
    assert!(outcome.failed.is_empty(), "{file}: {:?}", outcome.failed);
    outcome
}

fn columns(text: &str) -> (Vec<&str>, Vec<Vec<f64>>) {
    let mut lines = text.lines();
    let names: Vec<&str> = lines.next().unwrap().split(',').collect();
    let mut columns = vec![Vec::new(); names.len()];
    for line in lines {
        for (column, cell) in columns.iter_mut().zip(line.split(',')) {
            column.push(cell.parse().unwrap());
        }
    }
    (names, columns)
}

/// A MATLAB file of version 4 with one vector for each column.
fn matlab(names: &[&str], columns: &[Vec<f64>]) -> Vec<u8> {
    let mut bytes = Vec::new();
    for (name, column) in names.iter().zip(columns) {
        for word in [0, column.len() as u32, 1, 0, name.len() as u32 + 1] {
            bytes.extend(word.to_le_bytes());
        }
        bytes.extend(name.as_bytes());
        bytes.push(0);
        bytes.extend(column.iter().flat_map(|value| value.to_le_bytes()));
    }
    bytes
}

#[test]
fn repeats_the_fit_in_other_formats() {
    let text = std::fs::read_to_string(Path::new(FIXTURE).join("raw/good.csv")).unwrap();
    let expected = fit("good.csv", text.as_bytes(), "time = \"time_s\"")
        .impacts
        .remove(0);
    let german = text.replace(',', ";").replace('.', ",");
    let utf16: Vec<u8> = german.encode_utf16().flat_map(u16::to_le_bytes).collect();
    let (names, columns) = columns(&text);
    for (file, bytes, files) in [
        ("semicolons.csv", german.as_bytes(), "time = \"time_s\""),
        (
            "said.txt",
            german.as_bytes(),
            "separator = \"semicolon\"\ndecimal = \"comma\"",
        ),
        ("utf16.csv", &utf16, ""),
        ("vectors.mat", &matlab(&names, &columns), ""),
    ] {
        let found = fit(file, bytes, files).impacts.remove(0);
        assert_eq!(found.parameters, expected.parameters, "{file}");
        assert_eq!(found.cost.to_bits(), expected.cost.to_bits(), "{file}");
    }
}

#[test]
fn rejects_a_setting_that_is_none() {
    let text = std::fs::read_to_string(Path::new(FIXTURE).join("raw/good.csv")).unwrap();
    let found = std::panic::catch_unwind(|| fit("a.csv", text.as_bytes(), "separator = \"comas\""));
    let message = *found.unwrap_err().downcast::<String>().unwrap();
    assert!(
        message.contains("separator") && message.contains("comma"),
        "{message}"
    );
}
