//! The machines of the protocol for a host that shares nothing but memory with this module: a browser, Node.js.
//!
//! A host writes a request into the memory of the module and reads the reply there. It needs no import. Sessions are numbered; each is a
//! conversation of its own, as on the pipe of `oracle serve`.
//!
//! | export | what |
//! |---|---|
//! | `open()` | the number of a new session |
//! | `close(session)` | forgets it |
//! | `room(bytes)` | where a request of that many bytes is to be written |
//! | `answer(session)` | answers it; the number of bytes of the reply, 0 if there is no such session |
//! | `schema()` | puts the JSON Schema in the place of a reply; its number of bytes |
//! | `machines()` | the names of the machines, one a line, in the place of a reply; their number of bytes |
//! | `reply()` | where the reply is; it stays there until the next call |
//!
//! What a host passes is never trusted: a number that is no session has no answer, and a request is bytes that need not be text.
//!
//! # In the house
//!
//! Uses `atc-protocol`. Used by no other crate of the house. Begin with `wasm/index.js`.

use std::cell::RefCell;

use atc_protocol::machine::KINDS;
use atc_protocol::{Session, schema as schema_of};

#[derive(Default)]
struct Host {
    sessions: Vec<Option<Session>>,
    request: Vec<u8>,
    reply: Vec<u8>,
}

thread_local! {
    static HOST: RefCell<Host> = RefCell::default();
}

fn with<T>(action: impl FnOnce(&mut Host) -> T) -> T {
    HOST.with_borrow_mut(action)
}

/// Puts a text in the place of a reply.
fn say(text: &str) -> usize {
    with(|host| {
        text.as_bytes().clone_into(&mut host.reply);
        host.reply.len()
    })
}

/// The number of a new session: the least that is free.
#[unsafe(no_mangle)]
pub extern "C" fn open() -> usize {
    with(|host| {
        let free = host.sessions.iter().position(Option::is_none).unwrap_or(host.sessions.len());
        host.sessions.resize_with(host.sessions.len().max(free + 1), || None);
        host.sessions[free] = Some(Session::new());
        free
    })
}

/// Forgets a session.
#[unsafe(no_mangle)]
pub extern "C" fn close(session: usize) {
    with(|host| {
        if let Some(open) = host.sessions.get_mut(session) {
            *open = None;
        }
    });
}

/// Where a request of so many bytes is to be written.
#[unsafe(no_mangle)]
pub extern "C" fn room(bytes: usize) -> *mut u8 {
    with(|host| {
        host.request.clear();
        host.request.resize(bytes, b' ');
        host.request.as_mut_ptr()
    })
}

/// Answers the request in a session: the number of bytes of the reply, without a newline at its end.
#[unsafe(no_mangle)]
pub extern "C" fn answer(session: usize) -> usize {
    with(|host| {
        let Host { sessions, request, reply } = host;
        reply.clear();
        let Some(Some(open)) = sessions.get_mut(session) else { return 0 };
        open.answer(request, reply);
        reply.pop();
        reply.len()
    })
}

/// Where the reply is.
#[unsafe(no_mangle)]
pub extern "C" fn reply() -> *const u8 {
    with(|host| host.reply.as_ptr())
}

/// Puts the JSON Schema of the protocol in the place of a reply: its number of bytes.
#[unsafe(no_mangle)]
pub extern "C" fn schema() -> usize {
    say(&schema_of::text())
}

/// Puts the names of the machines in the place of a reply, one a line: their number of bytes.
#[unsafe(no_mangle)]
pub extern "C" fn machines() -> usize {
    say(&KINDS.iter().map(|kind| kind.name).collect::<Vec<_>>().join("\n"))
}
