//! Whether somebody has said what the rig of a campaign is: nothing is calculated with the
//! example of a template.

use crate::error::CampaignError;
use crate::settings::template::{TEMPLATES, TemplateKind, template};
use windfall_files::error::{Error, Place};
use windfall_files::text::toml_source::TomlSource;

/// Kinds of rig without whose values results would be those of an example.
///
/// Not asked are relaxation, which has none; taps, whose masses are those of specimens.csv; and
/// compressions, whose radii are those of specimens.csv too: both ends of a fruit deformed
/// between plates, and a Poisson ratio of 0.3, are the convention, which the methods of every
/// report name.
pub const ASKED: [TemplateKind; 4] = [
    TemplateKind::Pendulum,
    TemplateKind::Carriage,
    TemplateKind::Drop,
    TemplateKind::Repeats,
];

/// A rig that nobody has given: `[rig]` is word for word that of a template.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RigAsked {
    /// `[rig]` in campaign.toml.
    pub place: Place,
    /// What is missing, and how it is said.
    pub problem: String,
}

impl RigAsked {
    /// The error of who would calculate with it.
    pub fn error(&self) -> Error {
        Error::from(CampaignError::RigNotGiven {
            place: self.place.clone(),
            problem: self.problem.clone(),
        })
    }
}

/// Why the rig of a campaign is not one to calculate with; `None` once somebody has written
/// into `[rig]`. A remark that was taken away is enough: the values of the template may be
/// those of the bench.
pub fn rig_asked(source: &TomlSource) -> Option<RigAsked> {
    let text = source.text.replace("\r\n", "\n");
    let own = rig_section(&text).trim_end();
    let (word, kind) = TEMPLATES
        .iter()
        .filter(|(_, kind)| ASKED.contains(kind))
        .find(|(_, kind)| own == rig_section(template(*kind)).trim_end())?;
    let lines = rig_section(template(*kind)).lines();
    let values = lines
        .filter_map(KeyLine::of)
        .filter(|line| line.given && line.key != "kind");
    let values: Vec<String> = values
        .map(|line| format!("{} = {}", line.key, line.value))
        .collect();
    let line = text.lines().position(|line| line == "[rig]");
    Some(RigAsked {
        place: Place::at(&source.path, line.map_or(0, |line| line + 1)),
        problem: format!(
            "the rig is still the example that `windfall new {word}` writes ({}); say what yours \
             is (if these values are yours, remove the comments after them)",
            values.join(", ")
        ),
    })
}

/// The lines below `[rig]`, up to the next table.
pub fn rig_section(text: &str) -> &str {
    let Some(begin) = text.find("\n[rig]") else {
        return "";
    };
    let rest = &text[begin + 1..];
    let end = rest[1..].find("\n[").map_or(rest.len(), |end| end + 1);
    &rest[..end]
}

/// A line of `[rig]` of a template.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct KeyLine<'a> {
    /// The key.
    pub key: &'a str,
    /// Its value, without quotes.
    pub value: &'a str,
    /// Whether it is more than a comment.
    pub given: bool,
}

impl<'a> KeyLine<'a> {
    /// The key and the value of a line, where it has them.
    pub fn of(line: &'a str) -> Option<Self> {
        let given = !line.starts_with('#');
        let (key, rest) = line.trim_start_matches(['#', ' ']).split_once(" = ")?;
        let value = match rest.strip_prefix('"') {
            Some(text) => text.split('"').next()?,
            None => rest.split_whitespace().next()?,
        };
        let is_key = !key.is_empty() && key.chars().all(|c| c.is_ascii_lowercase() || c == '_');
        is_key.then_some(Self { key, value, given })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn asked(text: &str) -> Option<RigAsked> {
        rig_asked(&TomlSource {
            path: "campaign.toml".into(),
            text: text.to_owned(),
        })
    }

    #[test]
    fn rejects_the_rig_of_the_template_until_a_value_is_given() {
        for (word, kind) in TEMPLATES {
            let told = asked(template(kind));
            assert_eq!(told.is_some(), ASKED.contains(&kind), "{word}");
        }
        let text = template(TemplateKind::Carriage);
        let told = asked(text).unwrap().error().to_string();
        assert!(
            told.starts_with("campaign.toml, line 12: [rig]: "),
            "{told}"
        );
        assert!(told.contains("mass = 0.5 kg, mass_sd = 0.5 g"), "{told}");
        // As an editor of another system saves it.
        assert!(asked(&text.replace('\n', "\r\n")).is_some());
        // The same mass, by somebody who says so.
        assert_eq!(asked(&text.replace("\"0.5 kg\"  ", "\"500 g\"  ")), None);
        let (before, after) = text.split_once("# or \"from impulse\"").unwrap();
        let (_, after) = after.split_once('\n').unwrap();
        assert_eq!(asked(&format!("{}\n{after}", before.trim_end())), None);
        // Elsewhere, nothing is said of the rig.
        assert!(asked(&text.replace("My carriage", "Our")).is_some());
    }
}
