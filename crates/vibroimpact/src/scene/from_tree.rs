//! From a tree of JSON to typed values, by a reader whose faults are data. (Those of `serde_json` are sentences.)

use std::fmt::{self, Display};

use serde::de::value::{MapAccessDeserializer, MapDeserializer, SeqDeserializer};
use serde::de::{DeserializeOwned, Deserializer, Error, Expected, IntoDeserializer, MapAccess, Unexpected, Visitor};
use serde::forward_to_deserialize_any;
use serde_json::{Map, Value};

/// What is wrong with a value.
#[derive(Debug)]
pub(super) enum Fault {
    /// Its object lacks this field.
    Missing(&'static str),
    /// Its object has no field of this name, but those that are known.
    Unknown { name: String, known: &'static [&'static str] },
    /// It is not what is allowed here.
    NotAllowed { allowed: String },
}

impl Fault {
    fn unless(expected: &dyn Display) -> Fault {
        Fault::NotAllowed { allowed: expected.to_string() }
    }
}

impl Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Fault::Missing(name) => write!(f, "{name} is missing"),
            Fault::Unknown { name, .. } => write!(f, "{name} is unknown"),
            Fault::NotAllowed { allowed } => f.write_str(allowed),
        }
    }
}

impl std::error::Error for Fault {}

impl Error for Fault {
    fn custom<T: Display>(message: T) -> Fault {
        Fault::unless(&message)
    }

    fn invalid_type(_: Unexpected, expected: &dyn Expected) -> Fault {
        Fault::unless(&expected)
    }

    fn invalid_value(_: Unexpected, expected: &dyn Expected) -> Fault {
        Fault::unless(&expected)
    }

    fn invalid_length(_: usize, expected: &dyn Expected) -> Fault {
        Fault::unless(&expected)
    }

    fn unknown_variant(_: &str, known: &'static [&'static str]) -> Fault {
        Fault::NotAllowed { allowed: format!("one of {}", known.join(", ")) }
    }

    fn unknown_field(name: &str, known: &'static [&'static str]) -> Fault {
        Fault::Unknown { name: name.to_owned(), known }
    }

    fn missing_field(name: &'static str) -> Fault {
        Fault::Missing(name)
    }
}

/// Reads a `T`; a fault carries the path within the tree.
pub(super) fn from_tree<T: DeserializeOwned>(tree: &Value) -> Result<T, serde_path_to_error::Error<Fault>> {
    serde_path_to_error::deserialize(Reader(tree))
}

/// The whole number that is written as this one; none if it has a fraction or is not exact.
pub(super) fn whole(number: f64) -> Option<u64> {
    const EXACT: f64 = (1u64 << 53) as f64;
    (number.fract() == 0.0 && (0.0..=EXACT).contains(&number)).then_some(number as u64)
}

/// A tree as a source of values, as `&Value` is, but for the faults.
#[derive(Clone, Copy)]
struct Reader<'a>(&'a Value);

impl<'de> IntoDeserializer<'de, Fault> for Reader<'de> {
    type Deserializer = Reader<'de>;

    fn into_deserializer(self) -> Reader<'de> {
        self
    }
}

fn fields(map: &Map<String, Value>) -> impl MapAccess<'_, Error = Fault> {
    MapDeserializer::new(map.iter().map(|(key, value)| (key.as_str(), Reader(value))))
}

impl<'de> Deserializer<'de> for Reader<'de> {
    type Error = Fault;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Fault> {
        match self.0 {
            Value::Null => visitor.visit_unit(),
            Value::Bool(value) => visitor.visit_bool(*value),
            Value::Number(number) => match (number.as_u64(), number.as_i64(), number.as_f64()) {
                (Some(number), _, _) => visitor.visit_u64(number),
                (_, Some(number), _) => visitor.visit_i64(number),
                (_, _, Some(number)) => visitor.visit_f64(number),
                _ => Err(Fault::unless(&"a finite number")),
            },
            Value::String(text) => visitor.visit_borrowed_str(text),
            Value::Array(items) => {
                let mut left = items.iter().map(Reader);
                let read = visitor.visit_seq(SeqDeserializer::new(left.by_ref()))?;
                if left.len() == 0 { Ok(read) } else { Err(Fault::unless(&"fewer elements in the list")) }
            }
            Value::Object(map) => visitor.visit_map(fields(map)),
        }
    }

    /// In JSON 40.0 is a whole number too.
    fn deserialize_u64<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Fault> {
        match self.0.as_u64().or_else(|| self.0.as_f64().and_then(whole)) {
            Some(number) => visitor.visit_u64(number),
            None => self.deserialize_any(visitor),
        }
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Fault> {
        match self.0 {
            Value::Null => visitor.visit_none(),
            _ => visitor.visit_some(self),
        }
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _name: &'static str,
        _variants: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Fault> {
        match self.0 {
            Value::String(word) => visitor.visit_enum(IntoDeserializer::<Fault>::into_deserializer(word.as_str())),
            Value::Object(map) if map.len() == 1 => visitor.visit_enum(MapAccessDeserializer::new(fields(map))),
            _ => Err(Fault::unless(&"a text, or an object with one field")),
        }
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(self, _name: &'static str, visitor: V) -> Result<V::Value, Fault> {
        visitor.visit_newtype_struct(self)
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u128 f32 f64 char str string bytes byte_buf unit unit_struct seq tuple
        tuple_struct map struct identifier ignored_any
    }
}
