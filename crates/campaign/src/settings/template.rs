//! `windfall new KIND DIR`: a commented template of a campaign or a scene.

use crate::settings::kind::CAMPAIGN_FILE;
use std::path::{Path, PathBuf};
use windfall_files::error::Error;
use windfall_files::scratch::NewDirectory;

/// Rig of a template.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TemplateKind {
    /// Pendulum with encoder and force sensor.
    Pendulum,
    /// Body on a line with force sensor and position.
    Carriage,
    /// Testing machine that compresses fruit slowly.
    Compression,
    /// Testing machine that compresses fruit and holds them.
    Relaxation,
    /// Microphone that records taps.
    Acoustic,
    /// Drops repeated on one spot.
    Repeats,
    /// Fruit that fall on a plate over a load cell.
    Drop,
}

/// Words for the templates of campaigns.
pub const TEMPLATES: [(&str, TemplateKind); 7] = [
    ("pendulum", TemplateKind::Pendulum),
    ("carriage", TemplateKind::Carriage),
    ("drop", TemplateKind::Drop),
    ("compression", TemplateKind::Compression),
    ("relaxation", TemplateKind::Relaxation),
    ("acoustic", TemplateKind::Acoustic),
    ("repeats", TemplateKind::Repeats),
];

/// Table of specimens of a template.
const SPECIMENS: &str = "id,variety,mass_g\nfruit-1,Golden,182\nfruit-2,Golden,175\n";

/// Table of impacts of a template.
const IMPACTS: &str = "id,specimen,file,level\nfruit-1-a,fruit-1,fruit-1-a.csv,1\n\
                       fruit-1-b,fruit-1,fruit-1-b.csv,1\nfruit-2-a,fruit-2,fruit-2-a.csv,1\n";

/// Specimens of slow compressions: radii where the plates touch.
const COMPRESSED: &str = "id,variety,radius_mm,radius_2_mm\nfruit-1,Golden,38,36\n\
                          fruit-2,Golden,37,37\n";

/// Recordings of taps: two places of each fruit.
const TAPPED: &str = "id,specimen,file,orientation\nfruit-1-a,fruit-1,fruit-1-a.wav,stem up\n\
                      fruit-1-b,fruit-1,fruit-1-b.wav,quarter turn\n\
                      fruit-2-a,fruit-2,fruit-2-a.wav,stem up\n\
                      fruit-2-b,fruit-2,fruit-2-b.wav,quarter turn\n";
/// Specimens of repeated impacts, with the reference.
const STRUCK: &str =
    "id,role,variety\nball,reference,\nfruit-1,fruit,Golden\nfruit-2,fruit,Golden\n";

/// Repeated impacts.
const DROPS: &str = "id,specimen,file,spot,repeat,drop_height_m\n\
                     ball-1,ball,ball-1.csv,1,1,0.05\nball-2,ball,ball-2.csv,1,2,0.05\n\
                     fruit-1-a,fruit-1,fruit-1-a.csv,1,1,0.05\nfruit-1-b,fruit-1,fruit-1-b.csv,1,2,0.05\n\
                     fruit-2-a,fruit-2,fruit-2-a.csv,1,1,0.05\nfruit-2-b,fruit-2,fruit-2-b.csv,1,2,0.05\n";

/// Fruit that are dropped.
const FRUIT: &str = "id,variety,mass_g\nfruit-1,Nongda 4,4.82\nfruit-2,Nongda 4,4.76\n";

/// Drops from several heights, of a fresh fruit each.
const HEIGHTS: &str = "id,specimen,file,drop_height_mm\n\
                       c-100-1,fruit-1,c-100-1.csv,100\n\
                       c-500-1,fruit-2,c-500-1.csv,500\n";

/// Before a line of campaign.toml that a person has to write; behind it stands an example.
pub const UNWRITTEN: &str = "# WRITE YOURS: ";

/// Whether a file is an unchanged table of a template, whose examples may give way. Those of
/// specimens.csv may not once impacts.csv has rows that a person wrote: they may name them.
pub fn is_template_file(path: &Path) -> bool {
    let impacts = path.with_file_name("impacts.csv");
    has_template_text(path) && has_template_text(&impacts)
}

fn has_template_text(path: &Path) -> bool {
    let tables = [
        SPECIMENS, IMPACTS, COMPRESSED, TAPPED, STRUCK, DROPS, FRUIT, HEIGHTS,
    ];
    std::fs::read_to_string(path).is_ok_and(|text| tables.contains(&text.as_str()))
}

/// The tables of specimens and of recordings of a rig.
fn tables(kind: TemplateKind) -> (&'static str, &'static str) {
    match kind {
        TemplateKind::Pendulum | TemplateKind::Carriage | TemplateKind::Relaxation => {
            (SPECIMENS, IMPACTS)
        }
        TemplateKind::Compression => (COMPRESSED, IMPACTS),
        TemplateKind::Acoustic => (SPECIMENS, TAPPED),
        TemplateKind::Repeats => (STRUCK, DROPS),
        TemplateKind::Drop => (FRUIT, HEIGHTS),
    }
}

/// The commented campaign.toml of a rig.
pub fn template(kind: TemplateKind) -> &'static str {
    match kind {
        TemplateKind::Pendulum => include_str!("../../templates/pendulum.toml"),
        TemplateKind::Carriage => include_str!("../../templates/carriage.toml"),
        TemplateKind::Compression => include_str!("../../templates/compression.toml"),
        TemplateKind::Relaxation => include_str!("../../templates/relaxation.toml"),
        TemplateKind::Acoustic => include_str!("../../templates/acoustic.toml"),
        TemplateKind::Repeats => include_str!("../../templates/repeats.toml"),
        TemplateKind::Drop => include_str!("../../templates/drop.toml"),
    }
}

/// Writes a template into a directory that does not exist yet, or is empty.
///
/// Returns the files written.
///
/// # Errors
/// There is something in the directory already, or it cannot be written.
pub fn write_template(kind: TemplateKind, directory: &Path) -> Result<Vec<PathBuf>, Error> {
    let (specimens, impacts) = tables(kind);
    let new = NewDirectory::begin(directory)?;
    let files = [
        (CAMPAIGN_FILE, template(kind)),
        ("specimens.csv", specimens),
        ("impacts.csv", impacts),
    ];
    let mut written = write_files(&new, files)?;
    written.push(new.make_folder("raw")?);
    new.end(CAMPAIGN_FILE)?;
    Ok(written)
}

/// Writes the template of a scene into a directory that does not exist yet, or is empty.
///
/// # Errors
/// There is something in the directory already, or it cannot be written.
pub fn write_scene_template(directory: &Path) -> Result<Vec<PathBuf>, Error> {
    let scene = include_str!("../../templates/scene.toml");
    let new = NewDirectory::begin(directory)?;
    let written = write_files(&new, [("scene.toml", scene)])?;
    new.end("scene.toml")?;
    Ok(written)
}

/// Writes the example of a study into a directory that does not exist yet, or is empty: the
/// study, its scene, law cards and a regression of bruises.
///
/// # Errors
/// There is something in the directory already, or it cannot be written.
pub fn write_study_template(directory: &Path) -> Result<Vec<PathBuf>, Error> {
    let study = include_str!("../../templates/study/study.toml");
    let scene = include_str!("../../templates/study/scene.toml");
    let bruise = include_str!("../../templates/study/bruise.toml");
    let apples = include_str!("../../templates/study/apple-apple.toml");
    let steel = include_str!("../../templates/study/apple-steel.toml");
    let files = [
        ("study.toml", study),
        ("scene.toml", scene),
        ("bruise.toml", bruise),
        ("apple-apple.toml", apples),
        ("apple-steel.toml", steel),
    ];
    let new = NewDirectory::begin(directory)?;
    let written = write_files(&new, files)?;
    new.end("study.toml")?;
    Ok(written)
}

fn write_files<const N: usize>(
    new: &NewDirectory,
    files: [(&str, &str); N],
) -> Result<Vec<PathBuf>, Error> {
    let write = |(name, text): (&str, &str)| new.write(name, text.as_bytes());
    files.into_iter().map(write).collect()
}
