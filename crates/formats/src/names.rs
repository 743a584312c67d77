//! Unique names of channels.

use std::collections::{BTreeMap, BTreeSet};

/// Makes names unique: "x", "x (2)", "x (3)".
#[derive(Debug, Default)]
pub(crate) struct Names {
    taken: BTreeSet<String>,
    times: BTreeMap<String, usize>,
}

impl Names {
    /// The name, numbered if it was used before.
    pub fn unique(&mut self, name: &str) -> String {
        let times = self.times.entry(name.to_owned()).or_default();
        loop {
            *times += 1;
            let unique = match *times {
                1 => name.to_owned(),
                times => format!("{name} ({times})"),
            };
            if self.taken.insert(unique.clone()) {
                return unique;
            }
        }
    }
}
