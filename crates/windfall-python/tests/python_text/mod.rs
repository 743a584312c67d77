//! Text of a program in Python.

/// Words that name nothing in Python.
const KEYWORDS: &[&str] = &["from", "in", "is", "lambda", "global", "class", "with"];
/// Width of docstrings.
const WIDTH: usize = 94;

/// A name of Python for a command or an option.
pub fn name(text: &str) -> String {
    let name = text.replace([' ', '-'], "_");
    match KEYWORDS.contains(&name.as_str()) {
        true => name + "_",
        false => name,
    }
}

/// A string of Python.
pub fn quoted(text: &str) -> String {
    format!("\"{}\"", text.replace('\\', "\\\\").replace('"', "\\\""))
}

/// The type of one of some strings.
pub fn literal<'a>(values: impl Iterator<Item = &'a str>) -> String {
    let values: Vec<String> = values.map(quoted).collect();
    format!("Literal[{}]", values.join(", "))
}

/// A docstring of paragraphs; those that begin with `*` are items of a list.
pub fn docstring(paragraphs: &[String]) -> String {
    let mut text = String::from("    \"\"\"");
    let mut item = false;
    for (i, paragraph) in paragraphs.iter().enumerate() {
        let list = paragraph.starts_with("* ");
        if i > 0 {
            text += if item && list { "\n" } else { "\n\n" };
        }
        item = list;
        let paragraph = paragraph
            .replace('\\', "\\\\")
            .replace("\"\"\"", "\\\"\\\"\\\"");
        let lines = wrapped(&paragraph);
        for (j, line) in lines.iter().enumerate() {
            match (i, j) {
                (0, 0) => text += line,
                (_, 0) => text += &format!("    {line}"),
                _ if list => text += &format!("\n      {line}"),
                _ => text += &format!("\n    {line}"),
            }
        }
    }
    text + "\n    \"\"\"\n"
}

fn wrapped(text: &str) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if line.is_empty() => *line += word,
            Some(line) if line.chars().count() + 1 + word.chars().count() <= WIDTH => {
                *line += " ";
                *line += word;
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}
