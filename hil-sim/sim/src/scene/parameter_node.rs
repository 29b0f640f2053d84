//! A tree of numbers, each with its position in the file.

use std::fmt;

use serde::de::{self, Deserialize, Deserializer, MapAccess, Visitor};
use toml::Spanned;

/// A number as it is written.
#[derive(Clone, Copy)]
pub(super) enum NodeNumber {
    /// A whole number, kept exact because it may be a seed.
    Whole(i64),
    Real(f64),
}

impl<'de> Deserialize<'de> for NodeNumber {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        match ParameterNode::deserialize(deserializer)? {
            ParameterNode::Number(number) => Ok(number),
            ParameterNode::Table(_) => Err(de::Error::custom("a table, expected a number")),
        }
    }
}

impl NodeNumber {
    pub fn real(self) -> f64 {
        match self {
            Self::Whole(value) => value as f64,
            Self::Real(value) => value,
        }
    }
}

/// A number, or a table of nodes.
pub(super) enum ParameterNode {
    Number(NodeNumber),
    Table(Vec<(Spanned<String>, Spanned<ParameterNode>)>),
}

impl<'de> Deserialize<'de> for ParameterNode {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(Reader)
    }
}

struct Reader;

impl<'de> Visitor<'de> for Reader {
    type Value = ParameterNode;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a number or a table of them")
    }

    fn visit_i64<E: de::Error>(self, value: i64) -> Result<ParameterNode, E> {
        Ok(ParameterNode::Number(NodeNumber::Whole(value)))
    }

    fn visit_f64<E: de::Error>(self, value: f64) -> Result<ParameterNode, E> {
        Ok(ParameterNode::Number(NodeNumber::Real(value)))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<ParameterNode, A::Error> {
        let mut table = Vec::new();
        while let Some(entry) = map.next_entry()? {
            table.push(entry);
        }
        Ok(ParameterNode::Table(table))
    }
}
