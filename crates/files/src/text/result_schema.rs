//! JSON Schema of a result, by which programs that read it know its keys.

use schemars::Schema;
use serde_json::{Map, Value, json};
use utoipa::ToSchema;

/// Keys of a result as JSON Schema (2020-12). Further keys are allowed everywhere: they may come
/// with a later version of windfall.
#[derive(Clone, Debug)]
pub struct ResultSchema {
    schema: Schema,
    clashes: Vec<String>,
}

/// The schema of a result that is written as `T`; comments on its fields describe its keys.
///
/// * `name`: what the key `schema` of the result says, such as "regress/1"
/// * `title`: what the result is
pub fn result_schema<T: ToSchema>(name: &str, title: &str) -> ResultSchema {
    let mut clashes = Vec::new();
    let mut parts = Vec::new();
    T::schemas(&mut parts);
    let mut definitions = Map::new();
    for (part, schema) in parts {
        let schema = described(json!(schema));
        match definitions.get(&part) {
            Some(known) if *known != schema => clashes.push(part),
            Some(_) => {}
            None => drop(definitions.insert(part, schema)),
        }
    }
    name_values(&mut definitions);
    let schema = with_head(described(json!(T::schema())), name, title, definitions);
    ResultSchema { schema, clashes }
}

/// Gives what stands under names in an object its own definition.
fn name_values(definitions: &mut Map<String, Value>) {
    let mut values = Vec::new();
    for (name, schema) in definitions.iter_mut() {
        let value = schema.get_mut("additionalProperties");
        let (Some(of), Some(value)) = (name.strip_prefix("Named_"), value) else {
            continue;
        };
        if value.get("properties").is_some() {
            values.push((of.to_owned(), value.take()));
            *value = json!({ "$ref": format!("#/$defs/{of}") });
        }
    }
    for (name, value) in values {
        definitions.entry(name).or_insert(value);
    }
}

impl ResultSchema {
    /// Names that two different types have; a schema without a mistake has none.
    pub fn clashes(&self) -> &[String] {
        &self.clashes
    }

    /// Its text, indented.
    ///
    /// # Errors
    /// It cannot be written as JSON.
    pub fn text(&self) -> serde_json::Result<String> {
        Ok(serde_json::to_string_pretty(&self.schema)? + "\n")
    }
}

/// What says which result it is, before the schema's own keys, and definitions after them.
fn with_head(root: Value, name: &str, title: &str, definitions: Map<String, Value>) -> Schema {
    let mut root = match root {
        Value::Object(root) => root,
        _ => Map::new(),
    };
    let mut own = |key: &str| root.remove(key);
    let (description, properties, required) =
        (own("description"), own("properties"), own("required"));
    let mut keys = Map::new();
    let version = "Version of windfall that wrote it.";
    keys.insert(
        "windfall".to_owned(),
        json!({ "type": "string", "description": version }),
    );
    let shape = "Name of this schema, and a number that is raised when a key goes or changes its \
                 meaning.";
    keys.insert(
        "schema".to_owned(),
        json!({ "const": name, "description": shape }),
    );
    let mut always = vec![json!("windfall"), json!("schema")];
    if let Some(Value::Object(own)) = properties {
        keys.extend(own);
    }
    if let Some(Value::Array(own)) = required {
        always.extend(own.into_iter().filter(|key| key != "windfall"));
    }
    let mut schema = Map::new();
    for (key, value) in [
        (
            "$schema",
            json!("https://json-schema.org/draft/2020-12/schema"),
        ),
        ("title", json!(title)),
        ("description", description.unwrap_or_default()),
        ("type", json!("object")),
        ("properties", Value::Object(keys)),
        ("required", Value::Array(always)),
    ] {
        schema.insert(key.to_owned(), value);
    }
    schema.extend(root);
    schema.insert("$defs".to_owned(), Value::Object(definitions));
    schema.into()
}

/// A schema of OpenAPI as one of JSON Schema.
fn described(mut schema: Value) -> Value {
    tidy(&mut schema);
    schema
}

fn tidy(schema: &mut Value) {
    let Value::Object(schema) = schema else {
        return;
    };
    tidy_object(schema);
    for (key, part) in schema {
        match (key.as_str(), part) {
            // Names of keys are not words of a schema.
            ("properties", Value::Object(keys)) => keys.values_mut().for_each(tidy),
            ("anyOf" | "allOf" | "prefixItems", Value::Array(parts)) => {
                parts.iter_mut().for_each(tidy);
            }
            ("items" | "additionalProperties", part) => tidy(part),
            _ => {}
        }
    }
}

fn tidy_object(schema: &mut Map<String, Value>) {
    if let Some(Value::String(target)) = schema.get_mut("$ref") {
        *target = target.replace("#/components/schemas/", "#/$defs/");
    }
    // Widths of numbers, which JSON does not have.
    schema.remove("format");
    if schema.get("propertyNames") == Some(&json!({ "type": "string" })) {
        schema.remove("propertyNames");
    }
    if schema.get("additionalProperties") == Some(&json!(false)) {
        schema.remove("additionalProperties");
    }
    // With further keys, a value may be of several types.
    if let Some(Value::Array(mut any)) = schema.remove("oneOf") {
        describe_whole(schema, &mut any);
        schema.insert("anyOf".to_owned(), any.into());
    }
    if let Some(Value::String(description)) = schema.get_mut("description") {
        *description = words_of_json(description);
    }
    require(schema);
}

/// A comment of Rust in the words of JSON: what is missing is null there, and nothing is linked.
fn words_of_json(comment: &str) -> String {
    let mut text = String::new();
    let mut rest = comment;
    while let Some((before, (name, after))) = rest
        .split_once("[`")
        .and_then(|(before, link)| Some((before, link.split_once("`]")?)))
    {
        text += &format!("{before}`{name}`");
        rest = match after.strip_prefix('(').and_then(|own| own.split_once(')')) {
            Some((_, after)) => after,
            None => after,
        };
    }
    text += rest;
    // Lines are broken for the width of the source.
    let paragraphs = text.split("\n\n").map(|own| own.replace('\n', " "));
    let text = paragraphs.collect::<Vec<_>>().join("\n\n");
    let of_rust = ["`None`", "NaN", "not a number"];
    of_rust
        .iter()
        .fold(text, |text, word| text.replace(word, "null"))
}

/// What is said of a value or null belongs to both.
fn describe_whole(schema: &mut Map<String, Value>, any: &mut [Value]) {
    let null = json!({ "type": "null" });
    let mut values = any.iter_mut().filter(|own| **own != null);
    if let (Some(Value::Object(value)), None) = (values.next(), values.next())
        && let Some(description) = value.remove("description")
    {
        schema.insert("description".to_owned(), description);
    }
}

/// Marks keys that may be null as required: the key of a missing value is written. What is left
/// out where it is empty is neither null nor required.
fn require(schema: &mut Map<String, Value>) {
    let listed = schema.get("required").and_then(Value::as_array).cloned();
    let listed = listed.unwrap_or_default();
    let Some(Value::Object(properties)) = schema.get("properties") else {
        return;
    };
    let always = properties
        .iter()
        .filter(|(key, value)| listed.contains(&json!(key)) || is_nullable(value))
        .map(|(key, _)| json!(key));
    let always: Vec<Value> = always.collect();
    schema.insert("required".to_owned(), Value::Array(always));
}

fn is_nullable(schema: &Value) -> bool {
    let has_null = |list: &Value| {
        let list = list.as_array();
        list.is_some_and(|all| all.iter().any(|own| own == "null" || own["type"] == "null"))
    };
    ["type", "oneOf", "anyOf"]
        .iter()
        .any(|key| has_null(&schema[*key]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::named::Named;

    /// A value.
    #[derive(ToSchema)]
    #[allow(dead_code)]
    struct Part {
        /// Its value; m.
        value: f64,
        /// Its scatter, as of [`Whole`](Self); `None` where it is not known; m.
        sd: Option<f64>,
        /// Left out where there is none.
        #[serde(skip_serializing_if = "Option::is_none")]
        #[schema(nullable = false)]
        unit: Option<String>,
        /// Left out where there are none.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        notes: Vec<String>,
    }

    /// A result.
    #[derive(ToSchema)]
    #[allow(dead_code)]
    struct Whole {
        /// Values by name.
        values: Named<Part>,
        /// The best of them.
        best: Option<Part>,
    }

    #[test]
    fn keys_of_missing_values_are_required() {
        let schema = result_schema::<Whole>("whole/1", "whole");
        assert_eq!(schema.clashes(), &[] as &[String]);
        let schema: Value = serde_json::from_str(&schema.text().unwrap()).unwrap();
        assert_eq!(
            schema["required"],
            json!(["windfall", "schema", "best", "values"])
        );
        assert_eq!(schema["properties"]["schema"]["const"], "whole/1");
        let part = &schema["$defs"]["Part"];
        assert_eq!(part["required"], json!(["sd", "value"]));
        assert_eq!(part["properties"]["sd"]["type"], json!(["number", "null"]));
        assert_eq!(
            part["properties"]["sd"]["description"],
            "Its scatter, as of `Whole`; null where it is not known; m."
        );
        assert_eq!(part["properties"]["unit"]["type"], "string");
        let best = &schema["properties"]["best"];
        assert_eq!(best["description"], "The best of them.");
        assert_eq!(
            best["anyOf"],
            json!([{ "$ref": "#/$defs/Part" }, { "type": "null" }])
        );
        let values = &schema["$defs"]["Named_Part"]["additionalProperties"];
        assert_eq!(*values, json!({ "$ref": "#/$defs/Part" }));
    }
}
