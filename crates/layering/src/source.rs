//! Rust source as tokens: which paths it names, and which of its lines are
//! tests.
//!
//! Tokens rather than lines, so that comments and strings cannot mislead, nested
//! `use` lists are seen whole, and the inside of macro calls counts too.

use crate::error::Error;
use proc_macro2::{Delimiter, Group, TokenStream, TokenTree};
use std::path::{Path, PathBuf};

/// What a target of a package a source file belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// Under `src/`: ships in the library or program.
    Shipped,
    /// Under `tests/`, `benches/` or `examples/`: free to open files.
    Outside,
}

/// One source file of the workspace.
#[derive(Clone, Debug)]
pub struct SourceFile {
    /// Path relative to the workspace.
    pub path: PathBuf,
    /// Package that it belongs to.
    pub package: String,
    /// Module path inside the crate; empty for the root (`lib.rs`, `main.rs`).
    pub module: Vec<String>,
    /// Where in the package it lies.
    pub role: Role,
    /// Paths named outside test code, in order.
    pub paths: Vec<NamedPath>,
    /// Macros called outside test code, in order.
    pub macros: Vec<MacroCall>,
    /// Functions with a body outside test code.
    pub functions: Vec<Function>,
    /// Lines outside test code.
    pub lines: usize,
}

impl SourceFile {
    /// `path:line`.
    pub(crate) fn place(&self, line: usize) -> String {
        format!("{}:{line}", self.path.display())
    }
}

/// A function with a body.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Function {
    /// Its name.
    pub name: String,
    /// Line, from 1.
    pub line: usize,
    /// Lines from `fn` to the closing brace.
    pub lines: usize,
}

/// A path such as `crate::rig::Rig`, with `use` lists written out.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NamedPath {
    /// Segments; a glob import ends in `*`.
    pub segments: Vec<String>,
    /// Line, from 1.
    pub line: usize,
    /// How it is named.
    pub mention: Mention,
    /// Whether it has another name from here on (`use std::fs as disk`).
    pub renamed: bool,
}

/// How a path is named.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mention {
    /// In an expression, type or attribute.
    Inline,
    /// In a private `use`.
    Imported,
    /// In a `pub use`.
    Exported,
    /// Perhaps, by a macro of this file that writes `crate::$module`: a word
    /// of its arguments, which may be a module or not.
    Spliced,
}

/// A macro call such as `println!(…)`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MacroCall {
    /// Name without the exclamation mark.
    pub name: String,
    /// Line, from 1.
    pub line: usize,
}

/// Reads one source file from its text.
///
/// * `path`: relative to the workspace
/// * `within`: the same path relative to its package
///
/// # Errors
/// [`Error::Source`] if the text is not made of Rust tokens.
pub fn read_source(
    path: &Path,
    within: &Path,
    package: &str,
    text: &str,
) -> Result<SourceFile, Error> {
    let tokens = tokens_of(path, text)?;
    let mut test_lines = 0;
    let shipped = without_tests(tokens, &mut test_lines);
    let mut paths = Vec::new();
    collect_paths(&shipped, &mut paths);
    paths.extend(spliced_words(&shipped));
    let mut macros = Vec::new();
    collect_macros(&shipped, &mut macros);
    let mut functions = Vec::new();
    collect_functions(&shipped, &mut functions);
    Ok(SourceFile {
        path: path.to_path_buf(),
        package: package.to_owned(),
        module: module_of(within),
        role: role_of(within),
        paths,
        macros,
        functions,
        lines: text.lines().count() - test_lines,
    })
}

/// The tokens of a source text.
///
/// # Errors
/// [`Error::Source`] if the text is not made of Rust tokens.
pub fn tokens_of(path: &Path, text: &str) -> Result<TokenStream, Error> {
    text.parse()
        .map_err(|error: proc_macro2::LexError| Error::Source {
            path: path.to_path_buf(),
            line: error.span().start().line,
            message: error.to_string(),
        })
}

fn role_of(within: &Path) -> Role {
    if within.starts_with("src") && within.file_name().is_none_or(|name| name != "tests.rs") {
        Role::Shipped
    } else {
        Role::Outside
    }
}

fn module_of(within: &Path) -> Vec<String> {
    let mut module: Vec<String> = within
        .with_extension("")
        .iter()
        .skip(1)
        .map(|part| part.to_string_lossy().into_owned())
        .collect();
    if matches!(
        module.last().map(String::as_str),
        Some("lib" | "main" | "mod")
    ) {
        module.pop();
    }
    module
}

/// The tokens without items that exist only in tests; adds the number of lines
/// left out to `test_lines`.
fn without_tests(tokens: TokenStream, test_lines: &mut usize) -> Vec<TokenTree> {
    let tokens: Vec<TokenTree> = tokens.into_iter().collect();
    let mut kept = Vec::new();
    let mut i = 0;
    while i < tokens.len() {
        if is_inner_test_attribute(&tokens[i..]) {
            *test_lines += lines_between(&tokens[0], &tokens[tokens.len() - 1]);
            return Vec::new();
        }
        if is_test_attribute(&tokens[i..]) {
            let end = end_of_item(&tokens, i + 2);
            *test_lines += lines_between(&tokens[i], &tokens[end - 1]);
            i = end;
            continue;
        }
        kept.push(match &tokens[i] {
            TokenTree::Group(group) => TokenTree::Group(group_without_tests(group, test_lines)),
            other => other.clone(),
        });
        i += 1;
    }
    kept
}

fn group_without_tests(group: &Group, test_lines: &mut usize) -> Group {
    let inside = without_tests(group.stream(), test_lines);
    let mut rebuilt = Group::new(group.delimiter(), inside.into_iter().collect());
    rebuilt.set_span(group.span());
    rebuilt
}

fn lines_between(first: &TokenTree, last: &TokenTree) -> usize {
    last.span().end().line - first.span().start().line + 1
}

/// `#[test]` or `#[cfg(test)]`.
fn is_test_attribute(tokens: &[TokenTree]) -> bool {
    is_punct(tokens.first(), '#')
        && matches!(tokens.get(1), Some(TokenTree::Group(g)) if means_test(g))
}

/// `#![cfg(test)]`.
fn is_inner_test_attribute(tokens: &[TokenTree]) -> bool {
    is_punct(tokens.first(), '#')
        && is_punct(tokens.get(1), '!')
        && matches!(tokens.get(2), Some(TokenTree::Group(g)) if means_test(g))
}

fn means_test(attribute: &Group) -> bool {
    let text: String = attribute
        .stream()
        .to_string()
        .split_whitespace()
        .collect::<String>();
    text == "test" || text == "cfg(test)" || text.starts_with("cfg(all(test,")
}

/// Index after the item whose attributes begin at `start`: past its first
/// brace group or semicolon.
fn end_of_item(tokens: &[TokenTree], start: usize) -> usize {
    let ends = |token: &TokenTree| match token {
        TokenTree::Group(group) => group.delimiter() == Delimiter::Brace,
        TokenTree::Punct(punct) => punct.as_char() == ';',
        _ => false,
    };
    tokens[start..]
        .iter()
        .position(ends)
        .map_or(tokens.len(), |offset| start + offset + 1)
}

pub(crate) fn is_punct(token: Option<&TokenTree>, sign: char) -> bool {
    matches!(token, Some(TokenTree::Punct(p)) if p.as_char() == sign)
}

fn is_double_colon(tokens: &[TokenTree], at: usize) -> bool {
    is_punct(tokens.get(at), ':') && is_punct(tokens.get(at + 1), ':')
}

fn ident(token: Option<&TokenTree>) -> Option<String> {
    match token {
        Some(TokenTree::Ident(ident)) => Some(ident.to_string()),
        _ => None,
    }
}

fn collect_paths(tokens: &[TokenTree], found: &mut Vec<NamedPath>) {
    let mut i = 0;
    while i < tokens.len() {
        match &tokens[i] {
            TokenTree::Ident(word) if word == "use" => {
                let mention = if exported(&tokens[..i]) {
                    Mention::Exported
                } else {
                    Mention::Imported
                };
                let end = end_of_use(tokens, i + 1);
                use_tree(&tokens[i + 1..end], &[], mention, found);
                i = end;
            }
            TokenTree::Ident(word) => {
                let line = word.span().start().line;
                let (segments, next) = path_from(tokens, i);
                if segments.len() > 1 {
                    let mention = Mention::Inline;
                    found.push(NamedPath {
                        segments,
                        line,
                        mention,
                        renamed: false,
                    });
                }
                i = next;
            }
            TokenTree::Group(group) => {
                let inside: Vec<TokenTree> = group.stream().into_iter().collect();
                collect_paths(&inside, found);
                i += 1;
            }
            _ => i += 1,
        }
    }
}

fn collect_functions(tokens: &[TokenTree], found: &mut Vec<Function>) {
    for (i, token) in tokens.iter().enumerate() {
        match token {
            TokenTree::Ident(word) if word == "fn" => {
                let end = end_of_item(tokens, i);
                if let (Some(name), TokenTree::Group(_)) =
                    (ident(tokens.get(i + 1)), &tokens[end - 1])
                {
                    found.push(Function {
                        name,
                        line: word.span().start().line,
                        lines: lines_between(token, &tokens[end - 1]),
                    });
                }
            }
            TokenTree::Group(group) => {
                let inside: Vec<TokenTree> = group.stream().into_iter().collect();
                collect_functions(&inside, found);
            }
            _ => {}
        }
    }
}

/// Words that macros of this file may splice into `crate::$module`.
fn spliced_words(tokens: &[TokenTree]) -> Vec<NamedPath> {
    let mut found = Vec::new();
    for definition in tokens.windows(4) {
        let [
            TokenTree::Ident(word),
            _,
            TokenTree::Ident(name),
            TokenTree::Group(body),
        ] = definition
        else {
            continue;
        };
        if word == "macro_rules" && splices_modules(body) {
            for arguments in calls_of(&name.to_string(), tokens) {
                collect_words(arguments, &mut found);
            }
        }
    }
    found
}

/// Whether a macro's body writes `crate::$…`.
fn splices_modules(body: &Group) -> bool {
    let tokens: Vec<TokenTree> = body.stream().into_iter().collect();
    tokens.iter().enumerate().any(|(i, token)| match token {
        TokenTree::Ident(word) => {
            word == "crate" && is_double_colon(&tokens, i + 1) && is_punct(tokens.get(i + 3), '$')
        }
        TokenTree::Group(group) => splices_modules(group),
        _ => false,
    })
}

/// Arguments of the calls of a macro beside its definition.
fn calls_of<'a>(name: &str, tokens: &'a [TokenTree]) -> impl Iterator<Item = &'a Group> {
    tokens.windows(3).filter_map(move |call| match call {
        [TokenTree::Ident(word), sign, TokenTree::Group(arguments)]
            if word == name && is_punct(Some(sign), '!') =>
        {
            Some(arguments)
        }
        _ => None,
    })
}

fn collect_words(group: &Group, found: &mut Vec<NamedPath>) {
    for token in group.stream() {
        match token {
            TokenTree::Ident(word) => found.push(NamedPath {
                segments: vec!["crate".to_owned(), word.to_string()],
                line: word.span().start().line,
                mention: Mention::Spliced,
                renamed: false,
            }),
            TokenTree::Group(inside) => collect_words(&inside, found),
            _ => {}
        }
    }
}

/// Whether the tokens before `use` make it visible outside its module.
fn exported(before: &[TokenTree]) -> bool {
    let mut last = before.iter().rev();
    match last.next() {
        Some(TokenTree::Ident(word)) => word == "pub",
        Some(TokenTree::Group(group)) if group.delimiter() == Delimiter::Parenthesis => {
            ident(last.next()).is_some_and(|word| word == "pub")
        }
        _ => false,
    }
}

fn end_of_use(tokens: &[TokenTree], start: usize) -> usize {
    tokens[start..]
        .iter()
        .position(|token| is_punct(Some(token), ';'))
        .map_or(tokens.len(), |offset| start + offset)
}

/// Segments joined by `::` from `start`, and the index after them.
fn path_from(tokens: &[TokenTree], start: usize) -> (Vec<String>, usize) {
    let mut segments = Vec::new();
    let mut i = start;
    while let Some(segment) = ident(tokens.get(i)) {
        segments.push(segment);
        i += 1;
        if !(is_double_colon(tokens, i) && ident(tokens.get(i + 2)).is_some()) {
            break;
        }
        i += 2;
    }
    (segments, i)
}

/// Writes out one branch of a `use` tree.
fn use_tree(tokens: &[TokenTree], prefix: &[String], mention: Mention, found: &mut Vec<NamedPath>) {
    for branch in tokens.split(|token| is_punct(Some(token), ',')) {
        // A leading `::` means a crate, as does a name without one.
        let branch = if is_double_colon(branch, 0) {
            &branch[2..]
        } else {
            branch
        };
        let Some(first) = branch.first() else {
            continue;
        };
        let line = first.span().start().line;
        let (rest, next) = path_from(branch, 0);
        let mut segments = prefix.to_vec();
        segments.extend(rest);
        let tail = if is_double_colon(branch, next) {
            next + 2
        } else {
            next
        };
        match branch.get(tail) {
            Some(TokenTree::Group(group)) => {
                let inside: Vec<TokenTree> = group.stream().into_iter().collect();
                use_tree(&inside, &segments, mention, found);
                continue;
            }
            Some(TokenTree::Punct(star)) if star.as_char() == '*' => segments.push("*".to_owned()),
            _ => {}
        }
        // `use rig::{self}` names `rig`.
        if segments.len() > 1 && segments.last().is_some_and(|last| last == "self") {
            segments.pop();
        }
        found.push(NamedPath {
            segments,
            line,
            mention,
            renamed: ident(branch.get(tail)).is_some_and(|word| word == "as"),
        });
    }
}

fn collect_macros(tokens: &[TokenTree], found: &mut Vec<MacroCall>) {
    for (i, token) in tokens.iter().enumerate() {
        match token {
            TokenTree::Ident(word)
                if is_punct(tokens.get(i + 1), '!')
                    && matches!(tokens.get(i + 2), Some(TokenTree::Group(_))) =>
            {
                found.push(MacroCall {
                    name: word.to_string(),
                    line: word.span().start().line,
                });
            }
            TokenTree::Group(group) => {
                let inside: Vec<TokenTree> = group.stream().into_iter().collect();
                collect_macros(&inside, found);
            }
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> SourceFile {
        read_source(
            Path::new("crates/a/src/b.rs"),
            Path::new("src/b.rs"),
            "windfall-a",
            text,
        )
        .unwrap()
    }

    fn joined(file: &SourceFile) -> Vec<String> {
        file.paths.iter().map(|p| p.segments.join("::")).collect()
    }

    #[test]
    fn closed_form_use_lists_are_written_out() {
        let file =
            read("use crate::{law, rig::{self, Rig as R}, unit::*};\npub(crate) use ::std::fs;");
        let expected = [
            "crate::law",
            "crate::rig",
            "crate::rig::Rig",
            "crate::unit::*",
            "std::fs",
        ];
        assert_eq!(joined(&file), expected);
        assert_eq!(file.paths[0].mention, Mention::Imported);
        assert_eq!(file.paths[4].mention, Mention::Exported);
        assert_eq!(file.paths[4].line, 2);
    }

    #[test]
    fn closed_form_paths_in_bodies_types_and_macros_are_seen() {
        let file = read(
            "fn f(r: &crate::rig::Rig) -> Vec<f64> {\n  assert!(std::env::var(\"A\").is_ok());\n  Vec::<f64>::new()\n}",
        );
        assert_eq!(joined(&file), ["crate::rig::Rig", "std::env::var"]);
        assert_eq!(file.paths[1].line, 2);
        assert_eq!(
            file.macros,
            [MacroCall {
                name: "assert".to_owned(),
                line: 2
            }]
        );
    }

    #[test]
    fn closed_form_comments_strings_and_tests_are_left_out() {
        let file = read(
            "// std::fs::read\n/// `std::fs::read`\nconst A: &str = \"std::fs::read\";\n\
             #[cfg(test)]\nmod tests {\n  use std::fs;\n}\nconst B: f64 = std::f64::consts::PI;\n",
        );
        assert_eq!(joined(&file), ["std::f64::consts::PI"]);
        assert_eq!(file.lines, 4);
    }

    #[test]
    fn closed_form_code_for_more_than_tests_is_kept() {
        let file = read("#[cfg(not(test))]\nuse std::fs;\n#[cfg(any(test, unix))]\nuse std::env;");
        assert_eq!(joined(&file), ["std::fs", "std::env"]);
    }

    #[test]
    fn closed_form_module_follows_from_the_path() {
        let module = |path: &str| module_of(Path::new(path)).join("::");
        assert_eq!(module("src/lib.rs"), "");
        assert_eq!(module("src/fit.rs"), "fit");
        assert_eq!(module("src/fit/mod.rs"), "fit");
        assert_eq!(module("src/fit/step.rs"), "fit::step");
    }

    #[test]
    fn rejects_text_that_is_not_rust() {
        let error = tokens_of(Path::new("a.rs"), "fn f() {\n  )\n}").unwrap_err();
        assert!(
            error.to_string().starts_with("a.rs:2: not valid Rust"),
            "{error}"
        );
    }
}
