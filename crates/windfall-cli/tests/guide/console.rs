//! Blocks of commands: what is typed, and what is shown for it.

use super::page::{Block, Page, source};
use std::path::Path;
use std::process::Command;

/// Stands for what is left out: part of a line, or lines.
const LEFT_OUT: char = '…';

/// A command with the lines that follow it on the page.
struct Typed {
    command: String,
    shown: Vec<String>,
    /// Line of the page at which `shown` begins, from 0.
    begin: usize,
}

/// Does on an empty folder what a reader of the page does: saves the files that it
/// links to, writes those that it shows, types its commands, and compares what they
/// print and draw.
///
/// Returns the number of commands.
pub fn follow(page: &Page) -> usize {
    let folder = tempfile::tempdir().unwrap();
    let mut count = 0;
    let mut lines: Vec<String> = page.text.lines().map(str::to_owned).collect();
    save_files(page, folder.path());
    for block in &page.blocks {
        let place = format!("docs/guide/src/{}, line {}", page.name, block.line);
        match block.kind() {
            "console" => {
                let status = block.value("status").map_or(0, |s| s.parse().unwrap());
                for typed in typed(block, &place) {
                    let shown = run(&typed, status, folder.path(), &place);
                    lines[typed.begin..][..shown.len()].clone_from_slice(&shown);
                    count += 1;
                }
            }
            _ => write_file(block, folder.path(), page, &place),
        }
    }
    if writes() {
        std::fs::write(source().join(&page.name), lines.join("\n") + "\n").unwrap();
    }
    compare_pictures(page, folder.path());
    count
}

/// Whether pages are to be changed to what their commands print and draw.
fn writes() -> bool {
    std::env::var("WINDFALL_GUIDE").is_ok_and(|wish| wish == "write")
}

fn typed(block: &Block, place: &str) -> Vec<Typed> {
    let mut all: Vec<Typed> = Vec::new();
    let mut goes_on = false;
    for (index, line) in block.lines.iter().enumerate() {
        let begin = block.line + index + 1;
        let command = line.strip_prefix("$ ");
        match (command, goes_on) {
            (Some(command), _) => all.push(Typed {
                command: command.to_owned(),
                shown: Vec::new(),
                begin,
            }),
            (None, true) => {
                let last = all.last_mut().unwrap();
                last.begin = begin;
                last.command += "\n";
                last.command += line;
            }
            (None, false) => match all.last_mut() {
                Some(last) => last.shown.push(line.trim_end().to_owned()),
                None => assert!(line.starts_with("# "), "{place}: begins with no command"),
            },
        }
        goes_on = (command.is_some() || goes_on) && line.ends_with('\\');
    }
    assert!(!all.is_empty(), "{place}: no command");
    all
}

/// Returns what the page is to show.
fn run(typed: &Typed, status: i32, folder: &Path, place: &str) -> Vec<String> {
    let binary = Path::new(env!("CARGO_BIN_EXE_windfall"));
    let mut paths = vec![binary.parent().unwrap().to_path_buf()];
    paths.extend(std::env::split_paths(&std::env::var_os("PATH").unwrap()));
    let output = Command::new("sh")
        .arg("-c")
        .arg(format!("{{ {}\n}} 2>&1", typed.command))
        .current_dir(folder)
        .env("PATH", std::env::join_paths(paths).unwrap())
        .output()
        .unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    assert_eq!(
        output.status.code(),
        Some(status),
        "{place}: exit status of\n$ {}\n{text}",
        typed.command
    );
    let printed: Vec<&str> = text.lines().map(str::trim_end).collect();
    if typed.shown.iter().any(|line| !line.is_empty()) {
        let shown: Vec<&str> = typed.shown.iter().map(String::as_str).collect();
        let matches = lines_match(trimmed(&shown), trimmed(&printed));
        if !matches && writes() {
            let now = mended(&shown, trimmed(&printed));
            let lines: Vec<&str> = now.iter().map(String::as_str).collect();
            assert!(
                lines_match(trimmed(&lines), trimmed(&printed)),
                "{place}: other lines are printed than the page has; edit it by hand:\n{text}"
            );
            return now;
        }
        assert!(
            matches,
            "{place}: the page does not show what is printed by\n$ {}\n{text}",
            typed.command
        );
    }
    typed.shown.clone()
}

/// Shown lines with the numbers that are printed now; what is left out stays so.
fn mended(shown: &[&str], printed: &[&str]) -> Vec<String> {
    let skeleton = |line: &str| line.replace(|c: char| !c.is_alphabetic(), "");
    let mut lines = Vec::new();
    let mut from = 0;
    for (index, part) in shown.split(|line| line.trim() == "…").enumerate() {
        let alike = |begin: &usize| {
            let there = printed[*begin..].iter().zip(part);
            there.filter(|(a, b)| skeleton(a) == skeleton(b)).count()
        };
        // The first of those that are most alike.
        let begin = (from..printed.len()).rev().max_by_key(alike);
        let now = &printed[begin.unwrap_or(from)..];
        lines.extend((index > 0).then(|| "…".to_owned()));
        for (place, line) in part.iter().enumerate() {
            let now = now.get(place).filter(|now| !line_matches(line, now));
            lines.push(now.map_or_else(|| (*line).to_owned(), |now| abridged(line, now)));
        }
        from = begin.unwrap_or(from) + part.len().min(now.len());
    }
    lines
}

/// A printed line with the omissions of the one shown: a number loses the same last digits.
fn abridged(shown: &str, printed: &str) -> String {
    let mut rest = printed.chars().peekable();
    let mut line = String::new();
    let mut shown = shown.chars().peekable();
    while let Some(c) = shown.next() {
        if c == LEFT_OUT {
            line.push(c);
            while rest.next_if(|next| shown.peek() != Some(next)).is_some() {}
        } else {
            line.extend(rest.next());
        }
    }
    line.extend(rest);
    line
}

/// Without empty lines at both ends.
fn trimmed<'a, 'b>(lines: &'a [&'b str]) -> &'a [&'b str] {
    let full = |line: &&str| !line.is_empty();
    let first = lines.iter().position(full).unwrap_or(lines.len());
    let last = lines.iter().rposition(full).map_or(first, |last| last + 1);
    &lines[first..last]
}

/// Whether printed lines are those shown; a line that is "…" stands for any
/// number of lines.
pub fn lines_match(shown: &[&str], printed: &[&str]) -> bool {
    match shown.split_first() {
        None => printed.is_empty(),
        Some((line, rest)) if line.trim() == "…" => {
            (0..=printed.len()).any(|skipped| lines_match(rest, &printed[skipped..]))
        }
        Some((line, rest)) => printed
            .split_first()
            .is_some_and(|(first, others)| line_matches(line, first) && lines_match(rest, others)),
    }
}

/// Whether a printed line is the one shown; "…" stands for any characters.
pub fn line_matches(shown: &str, printed: &str) -> bool {
    let mut parts = shown.split(LEFT_OUT);
    let Some(mut rest) = parts.next().and_then(|first| printed.strip_prefix(first)) else {
        return false;
    };
    let parts: Vec<&str> = parts.collect();
    let Some((last, middle)) = parts.split_last() else {
        return rest.is_empty();
    };
    for part in middle {
        match rest.find(part) {
            Some(place) => rest = &rest[place + part.len()..],
            None => return false,
        }
    }
    rest.ends_with(last)
}

/// Saves the scenes, parts and scripts that the page links to, all in one folder.
fn save_files(page: &Page, folder: &Path) {
    for target in super::page::links(&page.text) {
        let path = Path::new(&target);
        let ending = path.extension().and_then(|ending| ending.to_str());
        if target.starts_with("https://") || !matches!(ending, Some("toml" | "stl" | "py")) {
            continue;
        }
        let kept = source().join(&page.name).parent().unwrap().join(path);
        let name = path.file_name().unwrap();
        std::fs::copy(&kept, folder.join(name))
            .unwrap_or_else(|error| panic!("{}: {target}: {error}", page.name));
    }
}

/// A block with `file=NAME` is that file, one with `append=NAME` is its end, and one
/// with `part=NAME` stands in it.
fn write_file(block: &Block, folder: &Path, page: &Page, place: &str) {
    let mut text = block.lines.join("\n");
    text.push('\n');
    if let Some(name) = block.value("part") {
        let whole = std::fs::read_to_string(folder.join(name));
        let whole = whole.unwrap_or_else(|error| panic!("{place}: {name}: {error}"));
        assert!(whole.contains(&text), "{place}: this is not in {name}");
        return;
    }
    let (name, text) = match (block.value("file"), block.value("append")) {
        (Some(name), None) => (name, text),
        (None, Some(name)) => {
            let before = std::fs::read_to_string(folder.join(name));
            let before = before.unwrap_or_else(|error| panic!("{place}: {name}: {error}"));
            (name, before + &text)
        }
        _ => return,
    };
    assert!(
        page.text.contains(&format!("`{name}`")),
        "{place}: the page does not say that this is `{name}`"
    );
    std::fs::write(folder.join(name), text).unwrap();
}

/// Pictures of the page that its commands draw are those in the book.
/// With `WINDFALL_GUIDE=write` in the environment they are put there.
fn compare_pictures(page: &Page, folder: &Path) {
    for target in super::page::links(&page.text) {
        let path = Path::new(&target);
        if path.extension().is_none_or(|ending| ending != "svg") {
            continue;
        }
        let page_folder = source().join(&page.name).parent().unwrap().to_path_buf();
        let kept = page_folder.join(path);
        let drawn = std::fs::read(folder.join(path.file_name().unwrap()));
        let drawn = drawn.unwrap_or_else(|_| panic!("{}: no command draws {target}", page.name));
        if writes() {
            std::fs::write(&kept, &drawn).unwrap();
        }
        assert!(
            std::fs::read(&kept).is_ok_and(|kept| kept == drawn),
            "{}: {target} is not what the page's command draws; WINDFALL_GUIDE=write puts it there",
            page.name
        );
    }
}
