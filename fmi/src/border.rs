//! The functions of FMI 3.0's header, and the only place where a pointer of C is followed.
//!
//! An instance, and a state that it keeps, are numbers that only look like pointers. One that was freed, or never was, is found out and
//! refused. Of the other pointers null and alignment are checked, and the counts beside them. That they lead to the caller's own memory,
//! as long as is said, is the caller's part of each function.
#![allow(unsafe_code)]
#![allow(non_snake_case, reason = "these are FMI's names")]
#![allow(clippy::too_many_arguments, reason = "these are FMI's functions")]

use std::ffi::{c_char, c_void};
use std::fs::File;
use std::io::Read as _;
use std::path::Path;
use std::ptr;

use crate::config::LONGEST;
use crate::description::token;
use crate::instance::{CATEGORIES, Instance, Status};
use instances::{Log, add, remove, with};
use pointer::{array, text, usable};

mod instances;
mod pointer;
mod unsupported;
mod values;

pub use instances::LogMessage;
pub use unsupported::*;
pub use values::*;

/// Another callback; none is ever called.
pub type Callback = Option<extern "C" fn()>;

/// FMI's version.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3GetVersion() -> *const c_char {
    c"3.0".as_ptr()
}

/// There are no debug messages: what is refused is always told. The categories must be those of the XML.
///
/// # Safety
/// `categories` leads to as many texts as is said.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetDebugLogging(
    instance: *mut c_void,
    _on: u8,
    count: usize,
    categories: *const *const c_char,
) -> Status {
    with(instance, |instance| {
        // SAFETY: the caller keeps the contract.
        let names = unsafe { array(categories, count, "categories") };
        let unknown = names.and_then(|names| {
            for name in names {
                // SAFETY: the caller keeps the contract.
                let name = unsafe { text(*name, "a category") }?;
                if !CATEGORIES.iter().any(|(known, _)| *known == name) {
                    let known = CATEGORIES.map(|(known, _)| known).join(", ");
                    return Err(format!("there is no category {name:?}; there are {known}"));
                }
            }
            Ok(())
        });
        unknown.map_or_else(|what| instance.wrong(what), |()| Status::Ok)
    })
}

/// Reads the configuration among the resources, and holds the token against it.
fn read(resources: &str, given: &str) -> Result<Vec<u8>, String> {
    let path = Path::new(resources).join("config.json");
    let said = |what: String| format!("{}: {what}", path.display());
    let mut config = Vec::new();
    let file = File::open(&path).map_err(|error| said(error.to_string()))?;
    file.take(LONGEST + 1).read_to_end(&mut config).map_err(|error| said(error.to_string()))?;
    if config.len() as u64 > LONGEST {
        return Err(said(format!("it is longer than {LONGEST} bytes")));
    }
    let right = token(&config);
    if given == right {
        return Ok(config);
    }
    Err(format!(
        "instantiationToken is {given:?}, and of this library with {} it is {right:?}: XML, library and config are not of one unit",
        path.display()
    ))
}

/// Makes an instance, or gives null and says why.
///
/// # Safety
/// The texts end with a zero. `logMessage` is null or FMI's callback.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3InstantiateCoSimulation(
    instanceName: *const c_char,
    instantiationToken: *const c_char,
    resourcePath: *const c_char,
    _visible: u8,
    _loggingOn: u8,
    eventModeUsed: u8,
    _earlyReturnAllowed: u8,
    _requiredIntermediateVariables: *const u32,
    _nRequiredIntermediateVariables: usize,
    instanceEnvironment: *mut c_void,
    logMessage: LogMessage,
    _intermediateUpdate: Callback,
) -> *mut c_void {
    let log = Log { call: logMessage, environment: instanceEnvironment };
    let make = || {
        // SAFETY: the caller keeps the contract, here and below.
        let name = unsafe { text(instanceName, "instanceName") }?;
        // SAFETY: as above.
        let token = unsafe { text(instantiationToken, "instantiationToken") }?;
        // SAFETY: as above.
        let resources = unsafe { text(resourcePath, "resourcePath") }?;
        if eventModeUsed != 0 {
            return Err("eventModeUsed is true; this unit has no event mode".to_owned());
        }
        Instance::new(name, &read(resources, token)?)
    };
    match make() {
        Ok(instance) => add(instance, log),
        Err(what) => {
            log.say(Status::Error, &what);
            ptr::null_mut()
        }
    }
}

/// Null, and a message that the unit has no such interface.
fn no_instance(call: LogMessage, environment: *mut c_void, interface: &str) -> *mut c_void {
    let log = Log { call, environment };
    log.say(Status::Error, &format!("this unit has no {interface}; it is for co-simulation"));
    ptr::null_mut()
}

/// Not supported: null, and a message.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3InstantiateModelExchange(
    _instanceName: *const c_char,
    _instantiationToken: *const c_char,
    _resourcePath: *const c_char,
    _visible: u8,
    _loggingOn: u8,
    instanceEnvironment: *mut c_void,
    logMessage: LogMessage,
) -> *mut c_void {
    no_instance(logMessage, instanceEnvironment, "model exchange")
}

/// Not supported: null, and a message.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3InstantiateScheduledExecution(
    _instanceName: *const c_char,
    _instantiationToken: *const c_char,
    _resourcePath: *const c_char,
    _visible: u8,
    _loggingOn: u8,
    instanceEnvironment: *mut c_void,
    logMessage: LogMessage,
    _clockUpdate: Callback,
    _lockPreemption: Callback,
    _unlockPreemption: Callback,
) -> *mut c_void {
    no_instance(logMessage, instanceEnvironment, "scheduled execution")
}

/// Frees an instance and the states that it keeps. Null, and what is no instance, is passed over.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3FreeInstance(instance: *mut c_void) {
    remove(instance);
}

/// The start time counts; a tolerance and a stop time change nothing here.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3EnterInitializationMode(
    instance: *mut c_void,
    _toleranceDefined: u8,
    _tolerance: f64,
    startTime: f64,
    _stopTimeDefined: u8,
    _stopTime: f64,
) -> Status {
    with(instance, |instance| instance.enter_initialization(startTime))
}

/// From here on the instance takes steps.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3ExitInitializationMode(instance: *mut c_void) -> Status {
    with(instance, Instance::exit_initialization)
}

/// From here on the instance takes no step.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3Terminate(instance: *mut c_void) -> Status {
    with(instance, Instance::terminate)
}

/// The instance is as it was made.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3Reset(instance: *mut c_void) -> Status {
    with(instance, Instance::reset)
}

/// Keeps the state of the instance: its mode, values, time and device.
///
/// # Safety
/// `FMUState` leads to a state of this instance, or to null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetFMUState(instance: *mut c_void, FMUState: *mut *mut c_void) -> Status {
    with(instance, |instance| {
        if let Err(what) = usable(FMUState, "FMUState") {
            return instance.wrong(what);
        }
        // SAFETY: not null, aligned, and by the contract the caller's.
        let old = unsafe { FMUState.read() }.addr();
        match instance.keep(old) {
            Ok(number) => {
                // SAFETY: as above.
                unsafe { FMUState.write(ptr::without_provenance_mut(number)) };
                Status::Ok
            }
            Err(status) => status,
        }
    })
}

/// Puts a state back, as often as one likes.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3SetFMUState(instance: *mut c_void, FMUState: *mut c_void) -> Status {
    with(instance, |instance| instance.put_back(FMUState.addr()))
}

/// Forgets a state, and makes the pointer null.
///
/// # Safety
/// `FMUState` leads to a state of this instance, or to null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3FreeFMUState(instance: *mut c_void, FMUState: *mut *mut c_void) -> Status {
    with(instance, |instance| {
        if let Err(what) = usable(FMUState, "FMUState") {
            return instance.wrong(what);
        }
        // SAFETY: not null, aligned, and by the contract the caller's.
        let status = instance.forget(unsafe { FMUState.read() }.addr());
        if status == Status::Ok {
            // SAFETY: as above.
            unsafe { FMUState.write(ptr::null_mut()) };
        }
        status
    })
}

/// One logic cycle. If it is refused, the device has not stepped, and the outputs are the safe ones.
///
/// # Safety
/// The pointers lead to what they say, of the caller's. Nobody else uses it during the call.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3DoStep(
    instance: *mut c_void,
    currentCommunicationPoint: f64,
    communicationStepSize: f64,
    _noSetFMUStatePriorToCurrentPoint: u8,
    eventHandlingNeeded: *mut u8,
    terminateSimulation: *mut u8,
    earlyReturn: *mut u8,
    lastSuccessfulTime: *mut f64,
) -> Status {
    with(instance, |instance| {
        let usable = usable(eventHandlingNeeded, "eventHandlingNeeded")
            .and_then(|()| usable(terminateSimulation, "terminateSimulation"))
            .and_then(|()| usable(earlyReturn, "earlyReturn"))
            .and_then(|()| usable(lastSuccessfulTime, "lastSuccessfulTime"));
        if let Err(what) = usable {
            return instance.refuse(Status::Error, what);
        }
        let status = instance.step(currentCommunicationPoint, communicationStepSize);
        // SAFETY: not null, aligned, and by the contract the caller's.
        unsafe {
            eventHandlingNeeded.write(0);
            terminateSimulation.write(0);
            earlyReturn.write(0);
            lastSuccessfulTime.write(instance.time());
        }
        status
    })
}
