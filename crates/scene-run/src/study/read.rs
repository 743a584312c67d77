//! A study's file → the scenes of its variants.

use crate::file::change::{move_named, set_value};
use crate::file::key::Section;
use crate::file::scene::SceneFile;
use crate::study::file::{LevelFile, StudyFile, VaryFile};
use serde::Serialize;
use std::path::{Path, PathBuf};
use toml_edit::DocumentMut;
use windfall_campaign::settings::files::check_format;
use windfall_files::confined::named_beside;
use windfall_files::error::Error;
use windfall_files::text::spanned::Spanned;
use windfall_files::text::toml_source::{
    TomlSource, invalid, parse_source, read_piped_source, read_source, refused,
};

/// A study, ready to run.
#[derive(Clone, Debug)]
pub struct StudyPlan {
    pub title: String,
    /// The scene's file.
    pub scene: PathBuf,
    /// How often each variant is run.
    pub replicates: usize,
    /// What is varied, and its levels.
    pub factors: Vec<Factor>,
    /// Every combination of levels.
    pub variants: Vec<VariantPlan>,
}

/// What is varied.
#[derive(Clone, Debug, Serialize, utoipa::ToSchema)]
pub struct Factor {
    /// What it is called.
    pub name: String,
    /// Names of its levels.
    pub levels: Vec<String>,
}

/// One combination of levels.
#[derive(Clone, Debug)]
pub struct VariantPlan {
    /// Its name: those of its levels.
    pub name: String,
    /// Level of each factor.
    pub levels: Vec<usize>,
    /// Text of its scene.
    pub text: String,
}

const TABLE: &str = "[[vary]]";
/// Replicates where the file does not say.
const REPLICATES: usize = 4;
/// More variants than this are a mistake.
const MOST: usize = 1000;
/// More replicates than this are one too.
const MOST_REPLICATES: usize = 10_000;

/// Reads a study and makes its variants.
///
/// # Errors
/// The file cannot be read, or a change cannot be made in its scene.
pub fn read_study(path: &Path) -> Result<StudyPlan, Error> {
    let source = read_piped_source(path, "`windfall new scene-study DIR` writes an example")?;
    let file: StudyFile = parse_source(&source)?;
    check_format(&source, file.format.as_ref())?;
    let (name, span) = (file.scene.get_ref(), file.scene.span());
    let scene = named_beside(path, name)
        .map_err(|problem| invalid(&source, &span, ("the file", "scene"), name, problem))?;
    if !scene.exists() {
        let problem = "there is no such file beside the study".to_owned();
        return Err(invalid(
            &source,
            &span,
            ("the file", "scene"),
            name,
            problem,
        ));
    }
    let base = read_source(&scene, "`scene` in the study names it, beside the study")?;
    // What is wrong in its own file is told there.
    let _: SceneFile = parse_source(&base)?;
    let document: DocumentMut = base.text.parse().map_err(|error: toml_edit::TomlError| {
        let problem = error.message().to_owned();
        let key = ("the file", "scene");
        let name = file.scene.get_ref();
        invalid(&source, &file.scene.span(), key, name, problem)
    })?;
    let replicates = match &file.replicates {
        Some(own) if !(1..=MOST_REPLICATES).contains(own.get_ref()) => {
            let problem = format!("each variant runs 1 to {MOST_REPLICATES} times");
            let key = ("the file", "replicates");
            return Err(refused(&source, own, key, problem));
        }
        own => own.as_ref().map_or(REPLICATES, |own| *own.get_ref()),
    };
    let factors = factors_of(&source, &file.vary)?;
    let all = factors.iter().map(|own| own.levels.len());
    let count = all.fold(1_usize, usize::saturating_mul);
    if count > MOST {
        let problem = format!("{count} combinations of levels are more than {MOST}");
        let at = file.vary.first().map_or(0..0, Spanned::span);
        return Err(invalid(&source, &at, (TABLE, "levels"), "", problem));
    }
    let variants = (0..count).map(|number| variant_of(&source, &file.vary, &document, number));
    Ok(StudyPlan {
        title: file
            .title
            .clone()
            .unwrap_or_else(|| path.display().to_string()),
        scene,
        replicates,
        factors,
        variants: variants.collect::<Result<_, _>>()?,
    })
}

fn factors_of(source: &TomlSource, vary: &[Spanned<VaryFile>]) -> Result<Vec<Factor>, Error> {
    let mut factors = Vec::new();
    for own in vary {
        let file = own.get_ref();
        let table = Section {
            source,
            name: TABLE,
            at: own.span(),
        };
        if file.levels.is_empty() {
            let example =
                "levels = [{ name = \"steel\", set = { \"walls.pad.material\" = \"steel\" } }]";
            return Err(table.lacks("levels", "at least one level", example));
        }
        let mut levels: Vec<String> = Vec::new();
        for level in &file.levels {
            let name = &level.get_ref().name;
            if levels.contains(name) {
                let problem = "this level stands there twice";
                return Err(table.refused(&level.span(), "levels name", name, problem));
            }
            levels.push(name.clone());
        }
        let name = file.name.get_ref().clone();
        factors.push(Factor { name, levels });
    }
    Ok(factors)
}

/// The last factor changes fastest.
fn variant_of(
    source: &TomlSource,
    vary: &[Spanned<VaryFile>],
    base: &DocumentMut,
    number: usize,
) -> Result<VariantPlan, Error> {
    let mut rest = number;
    let mut levels = vec![0; vary.len()];
    for (place, own) in vary.iter().enumerate().rev() {
        let count = own.get_ref().levels.len();
        (levels[place], rest) = (rest % count, rest / count);
    }
    let mut document = base.clone();
    let mut names = Vec::new();
    for (own, &level) in vary.iter().zip(&levels) {
        let level = &own.get_ref().levels[level];
        change(source, &mut document, level)?;
        names.push(level.get_ref().name.clone());
    }
    Ok(VariantPlan {
        name: match names.is_empty() {
            true => "as it is".to_owned(),
            false => names.join(", "),
        },
        levels,
        text: document.to_string(),
    })
}

fn change(
    source: &TomlSource,
    document: &mut DocumentMut,
    level: &Spanned<LevelFile>,
) -> Result<(), Error> {
    let file = level.get_ref();
    for (path, value) in &file.set {
        set_value(document, path, value.get_ref())
            .map_err(|problem| invalid(source, &value.span(), (TABLE, "set"), path, problem))?;
    }
    if let Some(shift) = &file.shift {
        for name in &shift.get_ref().names {
            move_named(document, name, shift.get_ref().by).map_err(|problem| {
                invalid(source, &shift.span(), (TABLE, "move"), name, problem)
            })?;
        }
    }
    Ok(())
}
