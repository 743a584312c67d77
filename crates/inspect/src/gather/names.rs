//! Patterns of file names: `{variety}_f{fruit}_{height_mm}mm_{rep}.csv`.

use std::collections::BTreeMap;
use windfall_files::error::Error;
use windfall_files::option_value::unusable;

/// Placeholders that end the name of a specimen.
const SPECIMENS: [&str; 4] = ["specimen", "fruit", "sample", "id"];

/// A pattern of file names.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NamePattern {
    text: String,
    parts: Vec<Part>,
}

#[derive(Clone, Debug, PartialEq, Eq)]
enum Part {
    Text(String),
    Placeholder(String),
}

/// What a file name says.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NamedRecording {
    /// Id of the impact: the name without its ending.
    pub id: String,
    /// Id of the specimen.
    pub specimen: String,
    /// What is known of the specimen besides its id.
    pub of_specimen: Vec<(String, String)>,
    /// What is known of the impact.
    pub of_impact: Vec<(String, String)>,
}

impl NamePattern {
    /// Reads a pattern.
    ///
    /// # Errors
    /// A brace is not closed, a placeholder has no name, stands twice or next to another, is
    /// called as a column that every table has, or there is none.
    pub fn parse(text: &str) -> Result<Self, Error> {
        let wrong = |problem: &str| unusable(format!("--names {text}"), problem.to_owned());
        let mut parts: Vec<Part> = Vec::new();
        let mut rest = text;
        while let Some((before, after)) = rest.split_once('{') {
            let (name, behind) = after
                .split_once('}')
                .ok_or_else(|| wrong("a \"{\" is not closed by \"}\""))?;
            let plain = |c: char| c.is_alphanumeric() || c == '_';
            if name.is_empty() || !name.chars().all(plain) {
                return Err(wrong(
                    "a placeholder is a name of letters, digits and \"_\"",
                ));
            }
            if ["file", "from_s", "to_s"].contains(&name) {
                return Err(wrong(&format!(
                    "{{{name}}} is a column that windfall fills itself"
                )));
            }
            let twice = |part: &Part| matches!(part, Part::Placeholder(own) if own == name);
            if parts.iter().any(twice) {
                return Err(wrong(&format!("{{{name}}} stands twice")));
            }
            if before.is_empty() && matches!(parts.last(), Some(Part::Placeholder(_))) {
                return Err(wrong(
                    "two placeholders stand next to each other: nothing says where one ends",
                ));
            }
            if !before.is_empty() {
                parts.push(Part::Text(before.to_owned()));
            }
            parts.push(Part::Placeholder(name.to_owned()));
            rest = behind;
        }
        if parts.is_empty() {
            return Err(wrong(
                "there is no placeholder; write one for each part that varies, as in \
                 '{variety}_f{fruit}_{rep}.csv'",
            ));
        }
        if !rest.is_empty() {
            parts.push(Part::Text(rest.to_owned()));
        }
        let text = text.to_owned();
        Ok(Self { text, parts })
    }

    /// The pattern as it was written.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// What a file name says; `None` where it is not of this pattern.
    ///
    /// A placeholder takes as few characters as the rest allows. All placeholders up to
    /// `{specimen}`, `{fruit}` or `{sample}` together name the specimen; without one of them
    /// each file has a specimen of its own.
    pub fn read(&self, name: &str) -> Option<NamedRecording> {
        let values = matched(&self.parts, name)?;
        let stem = name.rsplit_once('.').map_or(name, |(stem, _)| stem);
        let names = self.parts.iter().filter_map(|part| match part {
            Part::Placeholder(name) => Some(name.clone()),
            Part::Text(_) => None,
        });
        let named: Vec<(String, String)> = names.zip(values).collect();
        let last = named
            .iter()
            .rposition(|(name, _)| SPECIMENS.contains(&name.as_str()));
        let (of_specimen, of_impact) = named.split_at(last.map_or(0, |last| last + 1));
        let parts: Vec<&str> = match of_specimen.last() {
            // An id is unique by itself.
            Some((name, value)) if name == "specimen" || name == "id" => vec![value.as_str()],
            Some(_) => of_specimen
                .iter()
                .map(|(_, value)| value.as_str())
                .collect(),
            None => vec![stem],
        };
        let kept = |(name, _): &&(String, String)| name != "specimen" && name != "id";
        Some(NamedRecording {
            id: stem.to_owned(),
            specimen: parts.join("-"),
            of_specimen: of_specimen.iter().filter(kept).cloned().collect(),
            of_impact: of_impact.to_vec(),
        })
    }
}

/// Specimens by the file names that were read so far.
#[derive(Default)]
pub(crate) struct KnownSpecimens(BTreeMap<String, (String, NamedRecording)>);

impl KnownSpecimens {
    /// Takes up a file name; what is wrong where it makes another fruit of a known specimen.
    pub fn take(&mut self, name: &str, read: &NamedRecording) -> Option<String> {
        let new = || (name.to_owned(), read.clone());
        let (first, seen) = self.0.entry(read.specimen.clone()).or_insert_with(new);
        let mut pairs = seen.of_specimen.iter().zip(&read.of_specimen);
        let (one, other) = pairs.find(|(one, other)| one.1 != other.1)?;
        Some(format!(
            "the specimen \"{}\" has the {} \"{}\" by {first} and \"{}\" by {name}: these are two \
             fruit with one id. In the pattern, call the number of the fruit {{fruit}} or {{sample}}; \
             all placeholders up to it then form the id",
            read.specimen, one.0, one.1, other.1
        ))
    }
}

/// What is wrong with a file name in a table, where spaces at either end are lost.
pub(crate) fn unfit_name(name: &str) -> Option<String> {
    let blank = name.trim() != name;
    blank.then(|| format!("{name:?}: the name begins or ends with a space; rename the file"))
}

/// Values of the placeholders, each as short as the rest allows.
fn matched(parts: &[Part], name: &str) -> Option<Vec<String>> {
    let Some((first, rest)) = parts.split_first() else {
        return name.is_empty().then(Vec::new);
    };
    match first {
        Part::Text(text) => matched(rest, name.strip_prefix(text.as_str())?),
        Part::Placeholder(_) => {
            let ends = name.char_indices().map(|(at, c)| at + c.len_utf8());
            ends.into_iter().find_map(|end| {
                let mut values = matched(rest, &name[end..])?;
                values.insert(0, name[..end].to_owned());
                Some(values)
            })
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_names_of_a_laboratory() {
        let pattern = NamePattern::parse("{variety}_f{fruit}_{height_mm}mm_{rep}.csv").unwrap();
        let read = pattern.read("Golden_f07_50mm_2.csv").unwrap();
        assert_eq!(
            (read.id.as_str(), read.specimen.as_str()),
            ("Golden_f07_50mm_2", "Golden-07")
        );
        let own = |pairs: &[(&str, &str)]| -> Vec<(String, String)> {
            let pairs = pairs.iter();
            pairs
                .map(|(a, b)| ((*a).to_owned(), (*b).to_owned()))
                .collect()
        };
        assert_eq!(
            read.of_specimen,
            own(&[("variety", "Golden"), ("fruit", "07")])
        );
        assert_eq!(read.of_impact, own(&[("height_mm", "50"), ("rep", "2")]));
        for other in [
            "Golden_07_50mm_2.csv",
            "Golden_f07_50mm_2.txt",
            "_f07_50mm_2.csv",
            "",
        ] {
            assert_eq!(pattern.read(other), None, "{other}");
        }
        let plain = NamePattern::parse("{specimen}.lvm")
            .unwrap()
            .read("apple 1.lvm")
            .unwrap();
        assert_eq!(
            (plain.id.as_str(), plain.specimen.as_str()),
            ("apple 1", "apple 1")
        );
        assert!(plain.of_specimen.is_empty() && plain.of_impact.is_empty());
        // Without a specimen each file has one of its own.
        let each = NamePattern::parse("run{run}.tdms")
            .unwrap()
            .read("run12.tdms")
            .unwrap();
        assert_eq!((each.specimen.as_str(), each.of_impact.len()), ("run12", 1));
    }

    #[test]
    fn rejects_two_fruit_under_one_id() {
        let check = |pattern: &str, names: [&str; 2]| {
            let pattern = NamePattern::parse(pattern).unwrap();
            let mut known = KnownSpecimens::default();
            let [first, second] = names.map(|name| known.take(name, &pattern.read(name).unwrap()));
            assert_eq!(first, None);
            second
        };
        let by_sample = "{variety}_f{sample}_{rep}.csv";
        let by_id = "{variety}_f{specimen}_{rep}.csv";
        let names = ["Gala_f1_1.csv", "Elstar_f1_1.csv"];
        assert_eq!(check(by_sample, names), None);
        let told = check(by_id, names).unwrap();
        assert!(told.contains("Gala") && told.contains("{sample}"), "{told}");
        // The hyphen that joins the parts of an id may also stand in them.
        assert!(check(by_sample, ["A-1_f2_1.csv", "A_f1-2_1.csv"]).is_some());
        assert!(unfit_name(" a.csv").is_some() && unfit_name("a b.csv").is_none());
    }

    #[test]
    fn rejects_patterns_that_say_nothing() {
        for text in [
            "plain.csv",
            "{a}{b}.csv",
            "{a.csv",
            "{}.csv",
            "{a}_{a}.csv",
            "{file}.csv",
        ] {
            let told = NamePattern::parse(text).unwrap_err().to_string();
            assert!(told.contains(text), "{told}");
        }
    }
}
