//! Description of the interface (OpenAPI 3.1).

use crate::api::events::CampaignChanged;
use crate::problem::Problem;
use axum::Json;
use utoipa::openapi::schema::{AdditionalProperties, Object, Schema, SchemaType, Type};
use utoipa::openapi::security::{Http, HttpAuthScheme, SecurityScheme};
use utoipa::openapi::{OpenApi as Description, Ref, RefOr};
use utoipa::{Modify, OpenApi};
use windfall_workspace::workspace::Detail;

/// The interface.
#[derive(OpenApi)]
#[openapi(
    info(
        title = "windfall",
        description = "What the page of `windfall serve` uses. All numbers are SI. Results have \
                       the keys of the commands' JSON. Requests that change something need the \
                       header X-Windfall; changes to a campaign need its version in If-Match. \
                       The token is in the address that `windfall serve` prints.",
    ),
    security(("token" = [])),
    paths(
        crate::about::about,
        crate::about::findings,
        crate::api::campaigns::campaigns,
        crate::api::campaigns::create,
        crate::api::campaigns::campaign,
        crate::api::campaigns::rigs,
        crate::api::campaigns::momentum,
        crate::api::campaigns::results,
        crate::api::campaigns::measured,
        crate::api::recordings::recordings,
        crate::api::recordings::recording,
        crate::api::recordings::outline,
        crate::api::recordings::upload_recording,
        crate::api::recordings::upload_table,
        crate::api::live::refit,
        crate::api::live::figure,
        crate::api::changes::text,
        crate::api::changes::window,
        crate::api::changes::exclusion,
        crate::api::changes::note,
        crate::api::changes::undo,
        crate::api::changes::undone,
        crate::api::changes::options,
        crate::api::changes::rig,
        crate::api::changes::channels,
        crate::api::changes::impacts,
        crate::api::jobs::start,
        crate::api::jobs::jobs,
        crate::api::jobs::job,
        crate::api::jobs::cancel,
        crate::api::jobs::kept,
        crate::api::events::job_events,
        crate::api::events::campaign_events,
        crate::api::tables::table,
        crate::api::tables::regression,
        crate::api::tables::surfaces,
        crate::api::tables::contours,
        crate::api::files::card,
        crate::api::files::report,
        crate::api::scenes::scenes,
        crate::api::scenes::scene,
        crate::api::scenes::frames,
        crate::api::scenes::hardest,
        crate::api::scenes::history,
        crate::api::scenes::totals,
    ),
    components(schemas(Problem, CampaignChanged, Detail)),
    modifiers(&NamedValues, &KeysOfAnswers, &Token)
)]
pub(crate) struct Interface;

/// How programs send the token.
struct Token;

impl Modify for Token {
    fn modify(&self, description: &mut Description) {
        if let Some(components) = description.components.as_mut() {
            let bearer = SecurityScheme::Http(Http::new(HttpAuthScheme::Bearer));
            components.add_security_scheme("token", bearer);
        }
    }
}

/// Replaces the value schemas that utoipa inlines into maps by references.
struct NamedValues;

impl Modify for NamedValues {
    fn modify(&self, description: &mut Description) {
        let Some(components) = description.components.as_mut() else {
            return;
        };
        let mut values = Vec::new();
        for (name, schema) in &mut components.schemas {
            let (Some(of), RefOr::T(Schema::Object(map))) = (name.strip_prefix("Named_"), schema)
            else {
                continue;
            };
            let Some(further) = map.additional_properties.as_deref_mut() else {
                continue;
            };
            if let AdditionalProperties::RefOr(RefOr::T(Schema::Object(value))) = further
                && !value.properties.is_empty()
            {
                values.push((of.to_owned(), RefOr::T(Schema::Object(value.clone()))));
                *further = AdditionalProperties::RefOr(Ref::from_schema_name(of).into());
            }
        }
        for (name, schema) in values {
            components.schemas.entry(name).or_insert(schema);
        }
    }
}

/// Marks keys of answers that may be null as required: the key of a missing value is written.
/// What is left out where it is empty is neither null nor required.
struct KeysOfAnswers;

impl Modify for KeysOfAnswers {
    fn modify(&self, description: &mut Description) {
        let components = description.components.iter_mut();
        for schema in components.flat_map(|all| all.schemas.values_mut()) {
            require(schema);
        }
    }
}

fn require(schema: &mut RefOr<Schema>) {
    let RefOr::T(schema) = schema else { return };
    match schema {
        Schema::Object(object) if !is_request(object) => {
            let keys = object.properties.iter();
            let always =
                keys.filter(|(key, own)| object.required.contains(key) || is_nullable(own));
            object.required = always.map(|(key, _)| key.clone()).collect();
        }
        Schema::AllOf(all) => all.items.iter_mut().for_each(require),
        Schema::OneOf(one) => one.items.iter_mut().for_each(require),
        _ => {}
    }
}

fn is_nullable(schema: &RefOr<Schema>) -> bool {
    match schema {
        RefOr::T(Schema::Object(own)) => match &own.schema_type {
            SchemaType::Type(own) => *own == Type::Null,
            SchemaType::Array(any) => any.contains(&Type::Null),
            SchemaType::AnyValue => true,
        },
        RefOr::T(Schema::Array(own)) => match &own.schema_type {
            SchemaType::Array(any) => any.contains(&Type::Null),
            _ => false,
        },
        RefOr::T(Schema::OneOf(one)) => one.items.iter().any(is_nullable),
        _ => false,
    }
}

/// Requests reject unknown keys.
fn is_request(object: &Object) -> bool {
    let further = object.additional_properties.as_deref();
    matches!(further, Some(AdditionalProperties::FreeForm(false)))
}

/// The description itself.
pub(crate) async fn openapi() -> Json<Description> {
    Json(Interface::openapi())
}
