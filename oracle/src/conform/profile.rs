//! A profile: what is compared of an implementation, and in what it is known to differ.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::fields::{Difference, Level, TABLES};
use atc_protocol::machine::KINDS;

/// What a profile file (TOML) says.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Profile {
    /// The name of the implementation, for the reports.
    pub implementation: Option<String>,
    /// How much of a reply is compared.
    pub level: Option<Level>,
    /// Machines that are not compared.
    pub skip: Vec<Skip>,
    /// Fields that are not compared.
    pub ignore: Vec<Known>,
    /// Differences that are known. A run in which one of them does not show fails: then it is gone.
    pub known: Vec<Known>,
}

/// A machine that is not compared.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Skip {
    /// The machine.
    pub machine: String,
    /// Why.
    pub reason: String,
}

/// A field of a machine.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Known {
    /// The machine.
    pub machine: String,
    /// The field, as a report names it, without the entry below a map: `display_km_h`, `fault`, `start`, `cycles`; or a word alone: `fault name`.
    pub field: String,
    /// Why.
    pub reason: String,
}

impl Profile {
    /// Reads a profile.
    ///
    /// # Errors
    /// What is wrong with it: its form, a machine or a field that does not exist, a reason that is empty.
    pub fn parse(text: &str) -> Result<Self, String> {
        let profile: Self = toml::from_str(text).map_err(|error| error.to_string().trim_end().to_owned())?;
        let names: Vec<_> = KINDS.iter().map(|kind| kind.name).collect();
        let listed = profile.ignore.iter().chain(&profile.known);
        let skipped = profile.skip.iter().map(|skip| (&skip.machine, &skip.reason));
        for (machine, reason) in skipped.chain(listed.clone().map(|known| (&known.machine, &known.reason))) {
            if !names.contains(&machine.as_str()) {
                return Err(format!("there is no machine {machine:?}; there are {}", names.join(", ")));
            }
            if reason.trim().is_empty() {
                return Err(format!("an entry for {machine} has no reason; each says why"));
            }
        }
        for known in listed {
            let Some(table) = TABLES.iter().find(|table| table.machine == known.machine) else { continue };
            let base = |name: &'static str| name.split(' ').next().unwrap_or_default();
            let mut fields: Vec<_> = table.fields.iter().flat_map(|field| [base(field.name), field.name]).collect();
            fields.extend(["start", "cycles"]);
            fields.dedup();
            if !fields.contains(&known.field.as_str()) {
                let fields = fields.join(", ");
                return Err(format!("{} has no field {:?}; it has {fields}", known.machine, known.field));
            }
        }
        Ok(profile)
    }

    /// Why a machine is not compared, if it is not.
    pub fn skips(&self, machine: &str) -> Option<&str> {
        self.skip.iter().find(|skip| skip.machine == machine).map(|skip| skip.reason.as_str())
    }

    /// Takes out what is not compared.
    pub fn without_ignored(&self, machine: &str, differences: &mut Vec<Difference>) {
        differences.retain(|difference| !self.ignore.iter().any(|known| known.is(machine, difference)));
    }

    /// Takes out what is known; returns the places of the known differences that showed.
    pub fn take_known(&self, machine: &str, differences: &mut Vec<Difference>) -> Vec<usize> {
        let mut shown = Vec::new();
        differences.retain(|difference| {
            let place = self.known.iter().position(|known| known.is(machine, difference));
            shown.extend(place);
            place.is_none()
        });
        shown
    }
}

impl Known {
    fn is(&self, machine: &str, difference: &Difference) -> bool {
        let whole = difference.field.split('/').next();
        self.machine == machine && (self.field == difference.base() || Some(self.field.as_str()) == whole)
    }
}

#[cfg(test)]
mod tests {
    use super::Profile;

    #[test]
    fn a_profile_names_what_there_is_and_says_why() {
        let good = "level = \"output\"\n[[known]]\nmachine = \"block-count\"\nfield = \"fault\"\nreason = \"words of our own\"\n";
        assert_eq!(Profile::parse(good).expect("a profile").known.len(), 1);
        for (text, fragment) in [
            (good.replace("block-count", "block"), "there is no machine \"block\"; there are aspect-acceptance"),
            (good.replace("\"fault\"", "\"faults\""), "block-count has no field \"faults\"; it has occupied"),
            (good.replace("words of our own", " "), "has no reason"),
            (good.replace("reason", "why"), "unknown field `why`"),
            ("level = \"all\"".to_owned(), "unknown variant `all`"),
        ] {
            let error = Profile::parse(&text).expect_err("a wrong profile");
            assert!(error.contains(fragment), "{error}, without {fragment}");
        }
    }
}
