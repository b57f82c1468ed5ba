//! What the neighbours of a ground's device say: permissions that come and go, with echoes about as old as their life, or of another start.

use serde_json::{Value, json};

use crate::conform::random::Random;

/// The neighbours, one a line.
pub(super) struct Neighbours {
    /// The lines.
    names: Vec<String>,
    /// What the device has told each of them so far.
    heard: Vec<Vec<Value>>,
    permits: Vec<bool>,
    /// The life of a permission, in cycles.
    life: i64,
    /// How late they answer, in cycles.
    late: i64,
    sent: i64,
    /// By how much rarer something changes or goes wrong than on a plan with times of a few cycles.
    pace: u64,
}

impl Neighbours {
    pub(super) fn new(names: Vec<String>, life: i64, pace: u64, random: &mut Random) -> Self {
        Self {
            heard: names.iter().map(|_| Vec::new()).collect(),
            permits: names.iter().map(|_| !random.one_in(6)).collect(),
            names,
            life,
            // A neighbour answers at once, or about as late as the life.
            late: random.one_of(&[1, 1, 1, life - 1, life, life + 1]).max(1),
            sent: 0,
            pace,
        }
    }

    /// Hears what the device has put out.
    pub(super) fn hear(&mut self, last: Option<&Value>) {
        for (name, heard) in self.names.iter().zip(&mut self.heard) {
            if let Some(stamp) = last.and_then(|last| last["messages"].get(name)).map(|message| &message["sent"]) {
                heard.push(stamp.clone());
            }
        }
    }

    /// What they say in this cycle to a device whose start has this number.
    pub(super) fn say(&mut self, session: i64, random: &mut Random) -> Value {
        let mut messages = json!({});
        self.sent += 1;
        for (number, name) in self.names.iter().enumerate() {
            if random.one_in(12 * self.pace) {
                self.permits[number] = !self.permits[number];
            }
            if random.one_in(24 * self.pace) {
                self.late = random.one_of(&[1, 1, self.life - 1, self.life, self.life + 1]).max(1);
            }
            if random.one_in(8) {
                continue;
            }
            let late = if random.one_in(6 * self.pace) { random.between(1, self.life + 3) } else { self.late };
            let heard = &self.heard[number];
            let back = usize::try_from(late).ok().and_then(|late| heard.len().checked_sub(late));
            let mut echo = back.map_or(Value::Null, |back| heard[back].clone());
            match random.number() % (30 * self.pace) {
                0 => echo = Value::Null,
                1 => echo["session"] = json!((session + 1) % 65536),
                2 => echo = json!({"session": session, "cycle": 4_294_967_295_u32}),
                _ => {}
            }
            if echo.is_object() && !echo["cycle"].is_u64() {
                echo = Value::Null;
            }
            let permission = if self.permits[number] { "granted" } else { "withheld" };
            let sent = json!({"session": 40 + number, "cycle": self.sent});
            messages[name] = json!({"permission": permission, "sent": sent, "echo": echo});
        }
        messages
    }
}
