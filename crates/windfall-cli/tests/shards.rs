//! `windfall fit --shard`: parts of a campaign that are one table together.

#![allow(clippy::unwrap_used)]

use assert_cmd::Command;
use std::collections::BTreeMap;
use std::path::Path;

fn windfall(folder: &Path, words: &str) -> std::process::Output {
    let mut command = Command::cargo_bin("windfall").unwrap();
    let words = words.split(' ').map(|word| word.replace('_', " "));
    command.args(words).current_dir(folder).output().unwrap()
}

fn run(folder: &Path, words: &str) -> String {
    let output = windfall(folder, words);
    let told = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{words}: {told}");
    String::from_utf8(output.stdout).unwrap()
}

/// What a command that is refused says.
fn refused(folder: &Path, words: &str) -> String {
    let output = windfall(folder, words);
    assert!(!output.status.success(), "{words}");
    String::from_utf8(output.stderr).unwrap()
}

/// Rows by the names of their columns, without blank cells.
fn rows(file: &Path) -> Vec<BTreeMap<String, String>> {
    let mut reader = csv::Reader::from_path(file).unwrap();
    let header = reader.headers().unwrap().clone();
    let rows = reader.records().map(|row| {
        let row = row.unwrap();
        let cells = header.iter().zip(&row).filter(|(_, cell)| !cell.is_empty());
        cells
            .map(|(name, cell)| (name.to_owned(), cell.to_owned()))
            .collect()
    });
    rows.collect()
}

const SIMULATE: &str = "simulate pendulum --law kuwabara-kono(k=753599,_c=1524) --spread k=133165 \
                        --specimens 7 --repeats 2 --recordings study";
const LAWS: &str = "--law kuwabara-kono --law tsuji";

#[test]
fn repeats_the_rows_of_the_whole_campaign() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    run(folder, SIMULATE);
    std::fs::create_dir(folder.join("parts")).unwrap();
    let mut parts = Vec::new();
    for part in 1..=3 {
        let fit = format!("fit study {LAWS} --shard {part}/3 --out");
        run(folder, &format!("{fit} {part}.csv"));
        parts.extend(rows(&folder.join(format!("{part}.csv"))));
        run(folder, &format!("{fit} parts/{part}.parquet --threads 1"));
    }
    assert!(!folder.join("study/results.sqlite").exists());
    run(folder, &format!("fit study {LAWS} --out whole.csv"));
    let whole = rows(&folder.join("whole.csv"));
    assert_eq!(whole.len(), 28);
    assert_eq!(parts, whole);
    // The same as one table of columns.
    let summary = "--value k --by law --format csv";
    let found = run(folder, &format!("summary parts {summary}"));
    assert_eq!(found, run(folder, &format!("summary whole.csv {summary}")));

    // A law of the user that has become another gives the same columns.
    let law = |formula: &str| {
        let parameter = "parameters.k = { unit = \"N/m^1.5\", start = 4e5 }";
        format!("[laws.mine]\nforce = \"{formula}\"\n{parameter}\n")
    };
    std::fs::create_dir(folder.join("mine")).unwrap();
    for (part, formula) in [(1, "k*x^1.5"), (2, "1.1*k*x^1.5")] {
        std::fs::write(folder.join("mine.toml"), law(formula)).unwrap();
        let fit = format!("fit study --laws mine.toml --law mine --shard {part}/2");
        run(folder, &format!("{fit} --out mine/{part}.parquet"));
    }
    let told = refused(folder, "summary mine --value k");
    assert!(
        told.contains("2.parquet was made with other options"),
        "{told}"
    );

    // So does another option.
    let other = format!("fit study {LAWS} --onset fixed --shard 2/3 --out parts/2.parquet");
    run(folder, &other);
    let told = refused(folder, &format!("summary parts {summary}"));
    assert!(
        told.contains("2.parquet was made with other options"),
        "{told}"
    );
}

#[test]
fn a_list_names_impacts_by_id_recording_and_path() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    run(folder, SIMULATE);
    run(folder, &format!("fit study {LAWS} --out whole.csv"));
    let table = rows(&folder.join("study/impacts.csv"));
    let cell = |row: usize, column: &str| table[row][column].clone();
    // Out of order, one twice, with blank lines and Windows' ends of lines.
    let list = format!(
        "study/raw/{}\r\n\n{}\n  {}\n{}",
        cell(9, "file").trim_start_matches("raw/"),
        cell(4, "file"),
        cell(0, "id"),
        cell(4, "id")
    );
    let whole = rows(&folder.join("whole.csv"));
    let ids = [0, 4, 9].map(|row| cell(row, "id"));
    let expected: Vec<_> = whole
        .iter()
        .filter(|row| ids.contains(&row["id"]))
        .collect();
    assert_eq!(expected.len(), 6);
    std::fs::write(folder.join("list.txt"), &list).unwrap();
    run(
        folder,
        &format!("fit study {LAWS} --only list.txt --out some.csv"),
    );
    assert_eq!(
        rows(&folder.join("some.csv")).iter().collect::<Vec<_>>(),
        expected
    );
    let mut piped = Command::cargo_bin("windfall").unwrap();
    let words = format!("fit study {LAWS} --only - --out piped.csv");
    piped
        .args(words.split(' '))
        .current_dir(folder)
        .write_stdin(list);
    piped.assert().success();
    let found = std::fs::read(folder.join("piped.csv")).unwrap();
    assert_eq!(found, std::fs::read(folder.join("some.csv")).unwrap());

    for (list, told) in [
        ("\n\n", "names no impact"),
        (
            "\nnobody\n",
            "line 2: no impact has the id or recording \"nobody\"; there are",
        ),
    ] {
        std::fs::write(folder.join("list.txt"), list).unwrap();
        let found = refused(folder, "fit study --only list.txt --out a.csv");
        assert!(found.contains(told), "{found}");
    }
    std::fs::write(folder.join("list.csv"), &ids[0]).unwrap();
    for (words, told) in [
        ("fit study --only absent.txt --out a.csv", "absent.txt"),
        ("fit study --only list.txt", "--out"),
        ("fit study --only list.txt --out list.txt", ".parquet"),
        (
            "fit study --only list.csv --out list.csv --force",
            "an input",
        ),
        (
            "fit study --only list.txt --shard 1/2 --out a.csv",
            "cannot be used",
        ),
    ] {
        let found = refused(folder, words);
        assert!(found.contains(told), "{words}: {found}");
    }
    assert!(!folder.join("a.csv").exists());
}

#[test]
fn rejects_parts_that_cannot_be() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    run(folder, SIMULATE);
    run(folder, "simulate tap taps --fruit 2");
    for (words, told) in [
        ("fit study --shard 0/3 --out a.csv", "counted from 1 to 3"),
        ("fit study --shard 4/3 --out a.csv", "counted from 1 to 3"),
        ("fit study --shard third --out a.csv", "such as 3/64"),
        ("fit study --shard 1/3", "--out"),
        ("fit study --shard 1/3 --out a.xls", ".parquet"),
        ("fit study --shard 1/3 --out study/impacts.csv", "an input"),
        (
            "fit study --shard 1/3 --out a.csv --joint",
            "cannot be used",
        ),
        ("fit taps --shard 1/3 --out a.csv", "single impacts"),
        (
            "fit study/raw/specimen-01-1.csv --shard 1/3 --out a.csv",
            "campaign.toml",
        ),
        ("fit study --shard 90/99 --out a.csv --onset never", "onset"),
    ] {
        let found = refused(folder, words);
        assert!(found.contains(told), "{words}: {found}");
        assert!(!folder.join("a.csv").exists(), "{words}");
    }
}
