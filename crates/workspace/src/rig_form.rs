//! What a form asks of the rig of each kind of campaign.
//!
//! Keys and their meanings are those of the schema of campaign.toml, their order and typical
//! values those of the commented template.

use crate::campaign_files::check_campaign;
use serde::Serialize;
use std::io::Write;
use std::path::Path;
use windfall_campaign::impacts::mass::mass_by_impulse;
use windfall_campaign::result::outcome::MassOutcome;
use windfall_campaign::settings::kind::{CAMPAIGN_FILE, CampaignKind, campaign_kind};
use windfall_campaign::settings::read::read_campaign;
use windfall_campaign::settings::rig_given::{ASKED, KeyLine, rig_section};
use windfall_campaign::settings::template::{TEMPLATES, TemplateKind, template, write_template};
use windfall_files::error::Error;
use windfall_files::scratch::Scratch;
use windfall_files::write_file::replace_file;
use windfall_numerics::unit::quantity::parse_as;
use windfall_report::schema_of_template::schema_of_template;

/// Units that a form offers, the SI unit first.
const UNITS: [&[&str]; 9] = [
    &["kg m^2", "kg cm^2", "g m^2", "g cm^2"],
    &["kg", "g", "mg"],
    &["m", "cm", "mm"],
    &["m/s^2", "g0"],
    &["N/m", "N/mm", "kN/m"],
    &["N s/m", "N s/mm"],
    &["kg/m^3", "g/cm^3"],
    &["s", "ms"],
    &["Pa", "kPa", "MPa"],
];

/// Impacts from which a form reads the mass; more change it little.
const LOOKED_AT: usize = 20;

/// What a form asks of one key of `[rig]`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, utoipa::ToSchema)]
pub struct RigKey {
    /// The key.
    pub key: String,
    /// What it means.
    pub meaning: String,
    /// Units that it may have, the SI unit first; none of a number alone.
    pub units: Vec<String>,
    /// Words that may stand in place of a number.
    pub words: Vec<String>,
    /// A value as it may be, with its unit.
    pub typical: String,
    /// Whether a campaign cannot be read without it.
    pub needed: bool,
}

/// The rig of a kind of campaign.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, utoipa::ToSchema)]
pub struct RigForm {
    /// Kind, as `windfall new` calls it.
    pub kind: String,
    /// Whether nothing is calculated with the values of the template.
    pub asked: bool,
    /// Its keys, in the order of the template.
    pub keys: Vec<RigKey>,
}

/// What the recordings of a campaign say of the mass that its contacts feel.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct MomentumView {
    /// Impulse of the force over change of velocity, ∫F dt = m (v₁ + v₂ + a T), where
    /// recordings show both; kg.
    pub mass: Option<MassOutcome>,
    /// The mass at the contact that the rig makes: of a pendulum, inertia over arm squared; kg.
    pub of_rig: Option<f64>,
}

/// Forms of all kinds.
///
/// # Errors
/// The folder for temporary files cannot be written.
pub fn rig_forms() -> Result<Vec<RigForm>, Error> {
    let forms = TEMPLATES.iter().map(|(word, kind)| {
        Ok(RigForm {
            kind: (*word).to_owned(),
            asked: ASKED.contains(kind),
            keys: rig_keys(*kind)?,
        })
    });
    forms.collect()
}

fn rig_keys(kind: TemplateKind) -> Result<Vec<RigKey>, Error> {
    let schema = schema_of_template(kind);
    let scratch = Scratch::temporary()?;
    let lines = rig_section(template(kind)).lines().filter_map(KeyLine::of);
    let mut keys = Vec::new();
    for line in lines.filter(|line| line.key != "kind") {
        let meaning = schema.described("rig", line.key).unwrap_or_default();
        let units = UNITS.iter().find(|units| {
            let has_unit = line.value.contains(|c: char| c.is_ascii_alphabetic());
            has_unit && parse_as(line.value, units[0]).is_ok()
        });
        let units = units.copied().unwrap_or_default();
        keys.push(RigKey {
            key: line.key.to_owned(),
            words: quoted(meaning).map(str::to_owned).collect(),
            meaning: meaning.to_owned(),
            units: units.iter().map(|unit| (*unit).to_owned()).collect(),
            typical: line.value.to_owned(),
            needed: line.given && !reads_without(kind, &scratch, line.key)?,
        });
    }
    keep_readable_words(kind, &scratch, &mut keys)?;
    Ok(keys)
}

/// Texts in quotes.
fn quoted(text: &str) -> impl Iterator<Item = &str> {
    text.split('"').skip(1).step_by(2)
}

/// Whether the template can be read with some of the lines of its rig.
///
/// * `name`: a name of its own for the attempt
fn reads(
    kind: TemplateKind,
    (scratch, name): (&Scratch, &str),
    line: impl Fn(&str) -> Option<String>,
) -> Result<bool, Error> {
    let rig = rig_section(template(kind));
    let kept: String = rig.split_inclusive('\n').filter_map(line).collect();
    let text = template(kind).replace(rig, &kept);
    let directory = scratch.path().join(name);
    write_template(kind, &directory)?;
    replace_file(&directory.join(CAMPAIGN_FILE), |file| {
        file.write_all(text.as_bytes())
    })?;
    Ok(check_campaign(&directory).is_ok())
}

/// Whether the template can be read without a key.
fn reads_without(kind: TemplateKind, scratch: &Scratch, key: &str) -> Result<bool, Error> {
    let begins = format!("{key} = ");
    let others = |line: &str| (!line.starts_with(&begins)).then(|| line.to_owned());
    reads(kind, (scratch, key), others)
}

/// Removes the words that the reader does not take for a key: a key may mean something else on
/// another rig. Beside it stands what is needed, and no more.
fn keep_readable_words(
    kind: TemplateKind,
    scratch: &Scratch,
    keys: &mut [RigKey],
) -> Result<(), Error> {
    let needed: Vec<String> = keys
        .iter()
        .filter(|own| own.needed)
        .map(|own| format!("{} = ", own.key))
        .chain(["[rig]".to_owned(), "kind = ".to_owned()])
        .collect();
    for key in keys {
        let mut words = Vec::new();
        for (number, word) in std::mem::take(&mut key.words).into_iter().enumerate() {
            let begins = format!("{} = ", key.key);
            let line = |line: &str| match line.starts_with(&begins) {
                true => Some(format!("{begins}\"{word}\"\n")),
                false => {
                    let kept = needed.iter().any(|needed| line.starts_with(needed));
                    kept.then(|| line.to_owned())
                }
            };
            let name = format!("{}-{number}", key.key);
            if reads(kind, (scratch, &name), line)? {
                words.push(word);
            }
        }
        key.words = words;
    }
    Ok(())
}

/// What impulse and momentum of the first recordings of a campaign say of its mass.
///
/// # Errors
/// The campaign cannot be read.
pub fn momentum_view(directory: &Path) -> Result<MomentumView, Error> {
    if campaign_kind(directory)? != CampaignKind::Impacts {
        return Ok(MomentumView {
            mass: None,
            of_rig: None,
        });
    }
    let mut campaign = read_campaign(directory)?;
    campaign.shared.entries.truncate(LOOKED_AT);
    Ok(MomentumView {
        mass: mass_by_impulse(&campaign),
        of_rig: campaign.rig.given_mass(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Keys, units, words and what is needed follow from schema, template and reader.
    #[test]
    fn closed_form_forms_ask_what_the_template_and_the_reader_need() {
        let forms = rig_forms().unwrap();
        let keys = |kind: &str| {
            let form = forms.iter().find(|form| form.kind == kind).unwrap();
            form.keys.clone()
        };
        let carriage = keys("carriage");
        let told: Vec<(&str, bool)> = carriage
            .iter()
            .map(|key| (key.key.as_str(), key.needed))
            .collect();
        assert_eq!(
            told,
            [
                ("mass", true),
                ("mass_sd", false),
                ("driving_acceleration", true)
            ]
        );
        assert_eq!(carriage[0].words, ["from impulse"]);
        assert_eq!(carriage[0].units, ["kg", "g", "mg"]);
        assert_eq!(carriage[0].typical, "0.5 kg");
        let pendulum = keys("pendulum");
        assert_eq!(pendulum.len(), 5);
        assert!(pendulum.iter().all(|key| key.words.is_empty()));
        assert!(
            pendulum
                .iter()
                .all(|key| key.needed == (key.key != "gravity"))
        );
        for form in &forms {
            for key in &form.keys {
                assert!(!key.meaning.is_empty(), "{} {}", form.kind, key.key);
                for unit in &key.units {
                    assert!(
                        parse_as(&format!("1 {unit}"), &key.units[0]).is_ok(),
                        "{unit}"
                    );
                }
            }
        }
        assert!(keys("compression").iter().any(|key| key.units.is_empty()));
        assert_eq!(keys("relaxation"), []);
    }
}
