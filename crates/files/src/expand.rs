//! Names of files with wildcards, where no shell has expanded them.

use crate::error::Error;
use crate::option_value::unusable;
use std::path::{Path, PathBuf};

/// Files by their names or wildcards (`*`, `?`, `[…]`, `**`), in the order of the names.
///
/// A file whose own name has such characters is taken as it is.
///
/// # Errors
/// A pattern is malformed or matches no file; a directory cannot be read.
pub fn expanded(names: &[PathBuf]) -> Result<Vec<PathBuf>, Error> {
    let mut files = Vec::new();
    for name in names {
        files.extend(expanded_name(name)?);
    }
    Ok(files)
}

fn expanded_name(name: &Path) -> Result<Vec<PathBuf>, Error> {
    let as_it_is = || Ok(vec![name.to_path_buf()]);
    let Some(pattern) = name.to_str().filter(|text| text.contains(['*', '?', '['])) else {
        return as_it_is();
    };
    if name.exists() {
        return as_it_is();
    }
    let paths = glob::glob(pattern).map_err(|error| {
        let problem = format!(
            "the wildcards cannot be read: {} at character {}",
            error.msg,
            error.pos + 1
        );
        unusable(pattern, problem)
    })?;
    let found: Vec<PathBuf> = paths
        .collect::<Result<_, _>>()
        .map_err(|error| Error::access(Path::new(pattern), "read", error.into()))?;
    match found.is_empty() {
        true => Err(unusable(
            pattern,
            "no file has such a name; check the directory",
        )),
        false => Ok(found),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_wildcards_names_with_brackets_and_no_match() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        for name in ["b.csv", "a.csv", "a[1].csv", "c.txt"] {
            std::fs::write(path(name), "1").unwrap();
        }
        let found = expanded(&[path("*.csv"), path("c.txt")]).unwrap();
        assert_eq!(found, ["a.csv", "a[1].csv", "b.csv", "c.txt"].map(path));
        assert_eq!(expanded(&[path("a[1].csv")]).unwrap(), [path("a[1].csv")]);
        assert_eq!(
            expanded(&[path("[bc].*")]).unwrap(),
            ["b.csv", "c.txt"].map(path)
        );
        // Plain names are left to the reader, which says that there is no such file.
        assert_eq!(expanded(&[path("absent")]).unwrap(), [path("absent")]);
        for (name, told) in [
            ("*.wav", "no file has such a name"),
            ("a[", "cannot be read"),
        ] {
            let error = expanded(&[path(name)]).unwrap_err().to_string();
            assert!(error.contains(told), "{error}");
        }
    }
}
