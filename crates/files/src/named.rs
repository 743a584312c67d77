//! Values under names, in the order they were given; an object in JSON.

use crate::name::Name;
use serde::de::{MapAccess, Visitor};
use serde::ser::SerializeMap;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::collections::HashMap;
use std::hash::Hash;
use std::marker::PhantomData;

/// Values under names, in the order they were given.
#[derive(Clone, Debug, PartialEq, utoipa::ToSchema)]
#[schema(value_type = std::collections::BTreeMap<String, T>)]
pub struct Named<T>(pub Vec<(Name, T)>);

impl<T> Default for Named<T> {
    fn default() -> Self {
        Self(Vec::new())
    }
}

impl<N: Into<Name>, T> FromIterator<(N, T)> for Named<T> {
    fn from_iter<I: IntoIterator<Item = (N, T)>>(pairs: I) -> Self {
        let pairs = pairs.into_iter();
        let mut named: Vec<_> = pairs.map(|(name, value)| (name.into(), value)).collect();
        // Thousands of results are held at once.
        named.shrink_to_fit();
        Self(named)
    }
}

/// Values under keys, keys in the order of their first appearance.
pub fn grouped<K, T>(pairs: impl IntoIterator<Item = (K, T)>) -> Vec<(K, Vec<T>)>
where
    K: Clone + Eq + Hash,
{
    let mut groups: Vec<(K, Vec<T>)> = Vec::new();
    let mut places: HashMap<K, usize> = HashMap::new();
    for (key, value) in pairs {
        match places.get(&key) {
            Some(place) => groups[*place].1.push(value),
            None => {
                places.insert(key.clone(), groups.len());
                groups.push((key, vec![value]));
            }
        }
    }
    groups
}

impl<T> Named<T> {
    /// Values under the names of an array.
    pub fn of<const N: usize>(pairs: [(&str, T); N]) -> Self {
        pairs.into_iter().collect()
    }

    /// Adds a value behind the others.
    pub fn push(&mut self, name: impl Into<Name>, value: T) {
        self.0.push((name.into(), value));
    }

    /// The names, in order.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.0.iter().map(|(name, _)| &**name)
    }

    /// The value of that name.
    pub fn get(&self, name: &str) -> Option<&T> {
        self.0
            .iter()
            .find(|(key, _)| key == name)
            .map(|(_, value)| value)
    }
}

impl<T: Serialize> Serialize for Named<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(self.0.len()))?;
        for (name, value) in &self.0 {
            map.serialize_entry(name, value)?;
        }
        map.end()
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Named<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Entries<T>(PhantomData<T>);
        impl<'de, T: Deserialize<'de>> Visitor<'de> for Entries<T> {
            type Value = Named<T>;
            fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str("an object")
            }
            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Named<T>, A::Error> {
                let mut entries = Vec::new();
                while let Some(entry) = map.next_entry()? {
                    entries.push(entry);
                }
                entries.shrink_to_fit();
                Ok(Named(entries))
            }
        }
        deserializer.deserialize_map(Entries(PhantomData))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_order_survives_json() {
        let named = Named(vec![("k".into(), 0.1 + 0.2), ("c".into(), 1e-300)]);
        let text = serde_json::to_string(&named).unwrap();
        assert_eq!(text, "{\"k\":0.30000000000000004,\"c\":1e-300}");
        assert_eq!(serde_json::from_str::<Named<f64>>(&text).unwrap(), named);
    }
}
