//! The published schema, and that what is printed follows it.

use crate::folder::{Folder, json};
use serde_json::Value;

const SCHEMA: &str = include_str!("../../src/output/schema.json");

/// Fails when the schema does not allow `value`.
pub(crate) fn check(value: &Value) {
    let schema: Value = serde_json::from_str(SCHEMA).expect("JSON");
    if let Err(why) = (Validator { root: &schema }).check(&schema, value, "$") {
        panic!("{why}\n{value:#}");
    }
}

/// A validator for the keywords that the schema uses; it refuses all others.
struct Validator<'a> {
    root: &'a Value,
}

impl Validator<'_> {
    fn check(&self, schema: &Value, value: &Value, at: &str) -> Result<(), String> {
        let keywords = schema.as_object().ok_or("a schema is an object")?;
        for (keyword, rule) in keywords {
            let good = match &**keyword {
                "$schema" | "$defs" | "title" | "description" => true,
                "$ref" => {
                    let pointer =
                        rule.as_str().and_then(|r| r.strip_prefix('#')).ok_or("an inner reference")?;
                    let target = self.root.pointer(pointer).ok_or(format!("no {pointer}"))?;
                    self.check(target, value, at)?;
                    true
                }
                "anyOf" => {
                    let options = rule.as_array().ok_or("a list")?;
                    let tried: Vec<String> =
                        options.iter().filter_map(|one| self.check(one, value, at).err()).collect();
                    if tried.len() == options.len() {
                        return Err(format!("{at}: none of\n  {}", tried.join("\n  ")));
                    }
                    true
                }
                "type" => match rule {
                    Value::Array(types) => types.iter().any(|one| is_a(one, value)),
                    one => is_a(one, value),
                },
                "enum" => rule.as_array().ok_or("a list")?.contains(value),
                "required" => {
                    let names = rule.as_array().ok_or("a list")?.iter().filter_map(Value::as_str);
                    names.clone().all(|name| value.get(name).is_some())
                }
                "additionalProperties" if rule == &Value::Bool(false) => {
                    let known = &keywords["properties"];
                    value.as_object().is_none_or(|object| object.keys().all(|key| known.get(key).is_some()))
                }
                "properties" => {
                    for (key, inner) in rule.as_object().ok_or("an object")? {
                        if let Some(member) = value.get(key) {
                            self.check(inner, member, &format!("{at}.{key}"))?;
                        }
                    }
                    true
                }
                "items" => {
                    for (i, item) in value.as_array().into_iter().flatten().enumerate() {
                        self.check(rule, item, &format!("{at}[{i}]"))?;
                    }
                    true
                }
                "maxItems" => value.as_array().is_none_or(|list| Some(list.len() as u64) <= rule.as_u64()),
                "minItems" => value.as_array().is_none_or(|list| Some(list.len() as u64) >= rule.as_u64()),
                "minimum" => value.as_f64().is_none_or(|x| Some(x) >= rule.as_f64()),
                "exclusiveMinimum" => value.as_f64().is_none_or(|x| Some(x) > rule.as_f64()),
                other => {
                    return Err(format!("the schema uses `{other}`, which this validator does not know"));
                }
            };
            if !good {
                return Err(format!("{at}: against `{keyword}: {rule}`"));
            }
        }
        Ok(())
    }
}

fn is_a(name: &Value, value: &Value) -> bool {
    match name.as_str() {
        Some("object") => value.is_object(),
        Some("array") => value.is_array(),
        Some("string") => value.is_string(),
        Some("number") => value.is_number(),
        Some("integer") => value.is_u64() || value.is_i64(),
        Some("boolean") => value.is_boolean(),
        Some("null") => value.is_null(),
        _ => false,
    }
}

#[test]
fn the_program_prints_the_schema() {
    let folder = Folder::new("schema");
    assert_eq!(folder.done(&["schema"]), SCHEMA);
    assert_eq!(folder.done(&["schema", "--json"]), SCHEMA);
}

/// A validator that lets everything pass would prove nothing.
#[test]
fn objects_that_are_not_as_documented_are_found() {
    let folder = Folder::new("schema-wrong");
    let good = json(&folder.run(&["--json"]));
    let schema: Value = serde_json::from_str(SCHEMA).expect("JSON");
    let allows = |value: &Value| Validator { root: &schema }.check(&schema, value, "$").is_ok();
    assert!(allows(&good));
    let pointers =
        ["/ts", "/case", "/controllers/0/total/iae", "/controllers/0/events/0/kind", "/warnings", "/files"];
    for pointer in pointers {
        let mut wrong = good.clone();
        *wrong.pointer_mut(pointer).expect("it is there") = Value::Bool(true);
        assert!(!allows(&wrong), "{pointer}");
    }
    for key in good.as_object().expect("an object").keys() {
        let mut wrong = good.clone();
        wrong.as_object_mut().expect("an object").remove(key);
        assert!(!allows(&wrong), "without {key}");
    }
    let mut wrong = good;
    wrong["controllers"][0]["extra"] = Value::Null;
    assert!(!allows(&wrong), "with another key");
}
