//! What a terminal is told of its own: lines no wider than it is, headings and findings that
//! stand out.

use std::io::IsTerminal;

/// Bold, faint and coloured letters, and an end of each.
const BOLD: &str = "\x1b[1m";
const FAINT: &str = "\x1b[2m";
const YELLOW: &str = "\x1b[33m";
const RED: &str = "\x1b[31m";
const END: &str = "\x1b[0m";

/// Width of the terminal to which results go; none where they go elsewhere. `COLUMNS` says it
/// better where it is set; characters.
pub fn width() -> Option<usize> {
    if !std::io::stdout().is_terminal() {
        return None;
    }
    let told = std::env::var("COLUMNS").ok();
    let told = told.and_then(|told| told.trim().parse().ok());
    let own = || terminal_size::terminal_size_of(std::io::stdout());
    let own = || own().map(|(terminal_size::Width(own), _)| usize::from(own));
    told.filter(|told| *told > 0).or_else(own)
}

/// Whether what goes to standard output, or to standard error, has colours: on a terminal that
/// knows them, without `NO_COLOR` (<https://no-color.org>).
fn colours(stream: &impl IsTerminal) -> bool {
    let set = |name| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    let dumb = std::env::var_os("TERM").is_some_and(|term| term == "dumb");
    stream.is_terminal() && !set("NO_COLOR") && !dumb
}

/// A result for people as standard output shows it.
pub fn shown(text: &str) -> String {
    match colours(&std::io::stdout()) {
        true => coloured(text),
        false => text.to_owned(),
    }
}

/// A message as standard error shows it: its first word is red where it is an error.
pub fn message_shown(text: &str) -> String {
    match text.strip_prefix("error:") {
        Some(rest) if colours(&std::io::stderr()) => format!("{RED}{BOLD}error:{END}{rest}"),
        _ => text.to_owned(),
    }
}

/// Heads of tables bold, the lines below them faint, findings in the colour of their severity.
fn coloured(text: &str) -> String {
    let is_rule = |line: &str| !line.is_empty() && line.chars().all(|c| c == '─');
    let lines: Vec<&str> = text.split('\n').collect();
    let mut found = false;
    let dressed = lines.iter().enumerate().map(|(place, line)| {
        let heads = lines.get(place + 1).is_some_and(|next| is_rule(next));
        found = match *line {
            "Findings:" => true,
            line => found && line.starts_with("  "),
        };
        let code = line
            .strip_prefix("  ")
            .filter(|rest| !rest.starts_with(' '));
        match code.and_then(|rest| rest.split_once(':')) {
            _ if *line == "Findings:" || heads => format!("{BOLD}{line}{END}"),
            _ if is_rule(line) => format!("{FAINT}{line}{END}"),
            Some((code, rest)) if found => format!("  {}{code}{END}:{rest}", colour_of(code)),
            _ => (*line).to_owned(),
        }
    });
    dressed.collect::<Vec<_>>().join("\n")
}

/// Colour of a finding that begins with its severity: "[wrong] clipped".
fn colour_of(code: &str) -> &'static str {
    match code {
        code if code.starts_with("[wrong]") => RED,
        code if code.starts_with("[note]") => FAINT,
        _ => YELLOW,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_heads_and_findings_stand_out() {
        let text = "apples\n\nid   k\n──────\na   12\n\nFindings:\n  [wrong] clipped: it is\n  [doubtful] misfit: too large\n    more\n\nNext:\n  fit: it\n";
        let expected = "apples\n\n\x1b[1mid   k\x1b[0m\n\x1b[2m──────\x1b[0m\na   12\n\n\
                        \x1b[1mFindings:\x1b[0m\n  \x1b[31m[wrong] clipped\x1b[0m: it is\n  \x1b[33m[doubtful] misfit\x1b[0m: too large\n    more\n\n\
                        Next:\n  fit: it\n";
        assert_eq!(coloured(text), expected);
        // Tests have no terminal.
        assert_eq!(shown(text), text);
    }
}
