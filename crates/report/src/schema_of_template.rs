//! What campaign.toml of each kind of campaign may say.

use windfall_campaign::settings::schema::impacts_schema;
use windfall_campaign::settings::template::TemplateKind;
use windfall_drop::schema::drop_schema;
use windfall_files::text::file_schema::FileSchema;
use windfall_measure::schema::{
    acoustic_schema, compression_schema, relaxation_schema, repeats_schema,
};

/// Of the kind that a template is for.
pub fn schema_of_template(kind: TemplateKind) -> FileSchema {
    match kind {
        TemplateKind::Pendulum | TemplateKind::Carriage => impacts_schema(),
        TemplateKind::Compression => compression_schema(),
        TemplateKind::Relaxation => relaxation_schema(),
        TemplateKind::Acoustic => acoustic_schema(),
        TemplateKind::Repeats => repeats_schema(),
        TemplateKind::Drop => drop_schema(),
    }
}
