//! Where the values of a TOML file stand.

use std::collections::BTreeMap;
use std::ops::Range;

use atc_layout::{LineColumn, Source};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// A TOML text with the place of every value, by its path: `signal.life_ms`, `block[1].sections_m[0]`.
#[derive(Clone, Debug, Default)]
pub struct Places {
    source: Source,
    spans: BTreeMap<String, Range<usize>>,
}

impl Places {
    /// The places of a text that is TOML; none if it is not. `name` is the file, as the user named it.
    pub fn of(name: &str, text: &str) -> Self {
        let mut spans = BTreeMap::new();
        if let Ok(root) = DeTable::parse(text) {
            table("", root.get_ref(), &mut spans);
        }
        Self { source: Source { name: name.to_owned(), text: text.to_owned() }, spans }
    }

    /// File, line and column of a value; of what it would stand in if it is not there; the file alone for its top.
    pub fn at(&self, path: &str) -> String {
        let mut path = path;
        loop {
            if let Some(span) = self.spans.get(path) {
                return self.span(span);
            }
            let Some(end) = path.rfind(['.', '[']) else { return self.source.name.clone() };
            path = &path[..end];
        }
    }

    /// File, line and column of some bytes.
    pub fn span(&self, span: &Range<usize>) -> String {
        place(&self.source, span)
    }

    /// The file, as the user named it.
    pub fn name(&self) -> &str {
        &self.source.name
    }

    /// Whether the file has such a value.
    pub fn has(&self, path: &str) -> bool {
        self.spans.contains_key(path)
    }
}

/// File, line and column of some bytes of a text; the file alone where they are none.
pub fn place(source: &Source, span: &Range<usize>) -> String {
    match source.place(span) {
        Some(LineColumn { line, column }) => format!("{}:{line}:{column}", source.name),
        None => source.name.clone(),
    }
}

fn table(path: &str, table: &DeTable<'_>, spans: &mut BTreeMap<String, Range<usize>>) {
    for (key, one) in table {
        let name = key.get_ref();
        let path = if path.is_empty() { name.to_string() } else { format!("{path}.{name}") };
        // The span of a table that has a head is that of the head or empty: its key says better where it is.
        if matches!(one.get_ref(), DeValue::Table(_)) {
            spans.insert(path.clone(), key.span());
        }
        value(&path, one, spans);
    }
}

fn value(path: &str, one: &Spanned<DeValue<'_>>, spans: &mut BTreeMap<String, Range<usize>>) {
    spans.entry(path.to_owned()).or_insert_with(|| one.span());
    match one.get_ref() {
        DeValue::Table(inner) => table(path, inner, spans),
        DeValue::Array(list) => {
            for (place, one) in list.iter().enumerate() {
                value(&format!("{path}[{place}]"), one, spans);
            }
        }
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use super::Places;

    #[test]
    fn a_value_that_is_not_there_is_placed_where_it_would_stand() {
        let places = Places::of("l.toml", "name = \"é\"; x\n");
        assert_eq!(places.at("name"), "l.toml", "no TOML, no places");
        let places = Places::of("l.toml", "name = \"L\"\n\n[times]\n a = 1\n\n[[block]]\nsections_m = [1, 22]\n");
        assert_eq!(places.at("times.a"), "l.toml:4:6");
        assert_eq!(places.at("times.b"), "l.toml:3:2");
        assert_eq!(places.at("block[0].sections_m[1]"), "l.toml:7:18");
        assert_eq!(places.at("block[0].sections_m[2]"), "l.toml:7:14");
        assert_eq!(places.at("signal.life_ms"), "l.toml");
        assert!(places.has("block[0]") && !places.has("block[1]"));
    }
}
