//! Pages of the guide: what stands in a Markdown file.

use std::path::{Path, PathBuf};

/// One page of the guide.
pub struct Page {
    /// Its file, from the folder of the sources.
    pub name: String,
    /// All of its text.
    pub text: String,
    /// Its fenced blocks, in their order.
    pub blocks: Vec<Block>,
    /// Its text without fenced blocks, and the line that each begins at.
    pub prose: Vec<(usize, String)>,
}

/// A fenced block.
pub struct Block {
    /// What stands behind the opening fence.
    pub info: String,
    /// Line of the opening fence, from 1.
    pub line: usize,
    /// The lines between the fences.
    pub lines: Vec<String>,
}

impl Block {
    /// First word behind the fence: what the block is.
    pub fn kind(&self) -> &str {
        self.info.split_whitespace().next().unwrap_or_default()
    }

    /// Value of `NAME=VALUE` behind the fence.
    pub fn value(&self, name: &str) -> Option<&str> {
        let words = self.info.split_whitespace();
        words
            .filter_map(|word| word.split_once('='))
            .find_map(|(key, value)| (key == name).then_some(value))
    }
}

/// Folder of the guide's sources.
pub fn source() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/guide/src")
}

/// The pages that SUMMARY.md lists, in its order.
pub fn pages() -> Vec<Page> {
    let summary = std::fs::read_to_string(source().join("SUMMARY.md")).unwrap();
    let targets = links(&summary);
    let pages: Vec<Page> = targets.iter().map(|target| page(target)).collect();
    assert!(pages.len() > 20, "SUMMARY.md lists the pages");
    pages
}

/// One page.
pub fn page(name: &str) -> Page {
    let text = std::fs::read_to_string(source().join(name))
        .unwrap_or_else(|error| panic!("{name}: {error}"));
    let (mut blocks, mut prose) = (Vec::new(), Vec::new());
    let mut open: Option<Block> = None;
    for (index, line) in text.lines().enumerate() {
        let fence = line.strip_prefix("```");
        open = match (open.take(), fence) {
            (None, Some(info)) => Some(Block {
                info: info.to_owned(),
                line: index + 1,
                lines: Vec::new(),
            }),
            (None, None) => {
                prose.push((index + 1, line.to_owned()));
                None
            }
            (Some(block), Some(_)) => {
                blocks.push(block);
                None
            }
            (Some(mut block), None) => {
                block.lines.push(line.to_owned());
                Some(block)
            }
        };
    }
    assert!(open.is_none(), "{name}: a fence is not closed");
    Page {
        name: name.to_owned(),
        text,
        blocks,
        prose,
    }
}

/// Targets of the links and pictures of a text.
pub fn links(text: &str) -> Vec<String> {
    let parts = text.split("](").skip(1);
    parts
        .filter_map(|part| part.split_once(')'))
        .map(|(target, _)| target.to_owned())
        .collect()
}

/// Spans of code in a line of prose.
pub fn code_spans(line: &str) -> Vec<&str> {
    line.split('`').skip(1).step_by(2).collect()
}
