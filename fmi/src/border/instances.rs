//! Every instance, by the number that its pointer is, and where its messages go.

use std::collections::BTreeMap;
use std::ffi::{CString, c_char, c_void};
use std::ptr;
use std::sync::{Arc, Mutex, PoisonError};

use crate::instance::{Instance, Status};

/// FMI's `fmi3LogMessageCallback`.
pub type LogMessage = Option<extern "C" fn(*mut c_void, i32, *const c_char, *const c_char)>;
/// Where the messages of an instance go.
#[derive(Clone, Copy)]
pub(super) struct Log {
    pub call: LogMessage,
    pub environment: *mut c_void,
}

// SAFETY: the environment is never followed here, only handed back to the callback, on the thread that makes the call.
unsafe impl Send for Log {}

impl Log {
    pub fn say(self, status: Status, message: &str) {
        let Some(call) = self.call else { return };
        let text = |text: &str| CString::new(text.replace('\0', " ")).unwrap_or_default();
        let (category, message) = (text(status.category()), text(message));
        call(self.environment, status as i32, category.as_ptr(), message.as_ptr());
    }
}

struct Held {
    instance: Instance,
    log: Log,
}

/// Every instance, by the number that its pointer is.
struct Instances {
    /// The last number that was given. Numbers are not used again.
    last: usize,
    held: BTreeMap<usize, Arc<Mutex<Held>>>,
}

static INSTANCES: Mutex<Instances> = Mutex::new(Instances { last: 0, held: BTreeMap::new() });

/// Calls an instance, and says its messages when it is free again.
pub(super) fn with(instance: *mut c_void, act: impl FnOnce(&mut Instance) -> Status) -> Status {
    let held = INSTANCES.lock().unwrap_or_else(PoisonError::into_inner).held.get(&instance.addr()).cloned();
    let Some(held) = held else { return Status::Error };
    // It is in use when a callback, or another thread, calls it during a call. Waiting could be for ever.
    let Ok(mut held) = held.try_lock() else { return Status::Error };
    let status = act(&mut held.instance);
    let (messages, log) = (held.instance.messages(), held.log);
    drop(held);
    for (status, message) in messages {
        log.say(status, &message);
    }
    status
}

/// Keeps a new instance, and gives the pointer that it is known by.
pub(super) fn add(instance: Instance, log: Log) -> *mut c_void {
    let mut instances = INSTANCES.lock().unwrap_or_else(PoisonError::into_inner);
    instances.last = instances.last.saturating_add(1);
    let number = instances.last;
    instances.held.insert(number, Arc::new(Mutex::new(Held { instance, log })));
    ptr::without_provenance_mut(number)
}

/// Frees an instance; what is none is passed over.
pub(super) fn remove(instance: *mut c_void) {
    let freed = INSTANCES.lock().unwrap_or_else(PoisonError::into_inner).held.remove(&instance.addr());
    drop(freed);
}
