//! JSON Schema of a TOML file, from which editors complete.

use schemars::generate::SchemaSettings;
use schemars::transform::{RecursiveTransform, Transform};
use schemars::{JsonSchema, Schema};
use serde_json::{Value, json};

/// What a TOML file may say, as JSON Schema (draft 7, which editors of TOML know).
#[derive(Clone, Debug)]
pub struct FileSchema {
    schema: Schema,
    missing: Vec<String>,
}

/// The schema of a file that is read into `T`; comments on its fields are what editors show.
///
/// * `title`: what the file is
pub fn file_schema<T: JsonSchema>(title: &str) -> FileSchema {
    let settings = SchemaSettings::draft07();
    let mut schema = settings.into_generator().into_root_schema_for::<T>();
    schema.insert("title".to_owned(), title.into());
    schema.remove("description");
    RecursiveTransform(without_null).transform(&mut schema);
    FileSchema {
        schema,
        missing: Vec::new(),
    }
}

/// TOML has no null: a key that may be left out is left out.
fn without_null(schema: &mut Schema) {
    if let Some(Value::Array(types)) = schema.get_mut("type") {
        types.retain(|name| name != "null");
        if let [only] = types.as_slice() {
            let only = only.clone();
            schema.insert("type".to_owned(), only);
        }
    }
    if let Some(Value::Array(any)) = schema.get_mut("anyOf") {
        any.retain(|one| *one != json!({ "type": "null" }));
    }
    if schema.get("default").is_some_and(Value::is_null) {
        schema.remove("default");
    }
}

impl FileSchema {
    /// Says which words a key takes.
    ///
    /// * `table`: the type of its table
    /// * `choices`: what [`choice`](crate::text::toml_source::choice) chooses from
    #[must_use]
    pub fn words<T>(mut self, (table, key): (&str, &str), choices: &[(&str, T)]) -> Self {
        let place = format!("/definitions/{table}/properties/{key}");
        let words: Vec<&str> = choices.iter().map(|(word, _)| *word).collect();
        match self.schema.pointer_mut(&place).map(with_items) {
            Some(Value::Object(value)) => drop(value.insert("enum".to_owned(), json!(words))),
            _ => self.missing.push(place),
        }
        self
    }

    /// What a key of a table of the file means; `None` where there is no such key.
    pub fn described(&self, table: &str, key: &str) -> Option<&str> {
        let root = self.schema.as_value();
        // A table that may be left out is one of several.
        let own = root.pointer(&format!("/properties/{table}"))?;
        let any = ["anyOf", "allOf"].iter().find_map(|of| own.get(of)?.get(0));
        let place = any.unwrap_or(own).get("$ref")?.as_str()?;
        let meaning = format!("{}/properties/{key}/description", place.strip_prefix('#')?);
        root.pointer(&meaning)?.as_str()
    }

    /// Keys that [`Self::words`] was given and the file does not have; a schema without a
    /// mistake has none.
    pub fn missing(&self) -> &[String] {
        &self.missing
    }

    /// Its text, indented.
    ///
    /// # Errors
    /// It cannot be written as JSON.
    pub fn text(&self) -> serde_json::Result<String> {
        Ok(serde_json::to_string_pretty(&self.schema)? + "\n")
    }
}

/// A value, or the values of a list.
fn with_items(value: &mut Value) -> &mut Value {
    match value.get("items").is_some() {
        true => &mut value["items"],
        false => value,
    }
}
