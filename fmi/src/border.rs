//! The functions of FMI 3.0's header, and the only place where a pointer of C is followed.
//!
//! An instance, and a state that it keeps, are numbers that only look like pointers. One that was freed, or never was, is found out and
//! refused. Of the other pointers null and alignment are checked, and the counts beside them. That they lead to the caller's own memory,
//! as long as is said, is the caller's part of each function.
#![allow(unsafe_code)]
#![allow(non_snake_case, reason = "these are FMI's names")]
#![allow(clippy::too_many_arguments, reason = "these are FMI's functions")]

use std::collections::BTreeMap;
use std::ffi::{CStr, CString, c_char, c_void};
use std::fs::File;
use std::io::Read as _;
use std::path::Path;
use std::ptr;
use std::slice;
use std::sync::{Arc, Mutex, PoisonError};

use crate::config::LONGEST;
use crate::description::token;
use crate::instance::{CATEGORIES, Instance, Status};
use crate::variables::Value;

/// FMI's `fmi3LogMessageCallback`.
pub type LogMessage = Option<extern "C" fn(*mut c_void, i32, *const c_char, *const c_char)>;
/// Another callback; none is ever called.
pub type Callback = Option<extern "C" fn()>;

/// The most entries that an array of one call has, and the most bytes that a binary value has.
const MOST: usize = 1 << 16;

/// Where the messages of an instance go.
#[derive(Clone, Copy)]
struct Log {
    call: LogMessage,
    environment: *mut c_void,
}

// SAFETY: the environment is never followed here, only handed back to the callback, on the thread that makes the call.
unsafe impl Send for Log {}

impl Log {
    fn say(self, status: Status, message: &str) {
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
fn with(instance: *mut c_void, act: impl FnOnce(&mut Instance) -> Status) -> Status {
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

/// What can be told of a pointer.
fn usable<T>(pointer: *const T, name: &str) -> Result<(), String> {
    match (pointer.is_null(), pointer.is_aligned()) {
        (true, _) => Err(format!("{name} is a null pointer")),
        (false, false) => Err(format!("{name} is not aligned to {} bytes", align_of::<T>())),
        (false, true) => Ok(()),
    }
}

/// An array of C. It may be null if it has no entry.
///
/// # Safety
/// A pointer that is not null and is aligned leads to `count` entries of the caller's, which nobody writes during `'a`. Whatever bytes stand
/// there are a `T`.
unsafe fn array<'a, T: Copy>(pointer: *const T, count: usize, name: &str) -> Result<&'a [T], String> {
    if count > MOST {
        return Err(format!("{name} has {count} entries; it may have {MOST}"));
    }
    if count == 0 {
        return Ok(&[]);
    }
    usable(pointer, name)?;
    // SAFETY: not null, aligned, at most 65536 entries, and by the contract of this function the caller's.
    Ok(unsafe { slice::from_raw_parts(pointer, count) })
}

/// Writes an entry of each place of an array of C.
///
/// # Safety
/// A pointer that is not null and is aligned leads to as many entries of the caller's, which nobody else uses meanwhile.
unsafe fn put<T>(pointer: *mut T, entries: Vec<T>, name: &str) -> Result<(), String> {
    if entries.is_empty() {
        return Ok(());
    }
    usable(pointer, name)?;
    for (place, entry) in entries.into_iter().enumerate() {
        // SAFETY: not null, aligned, and by the contract of this function within the caller's array.
        unsafe { pointer.add(place).write(entry) };
    }
    Ok(())
}

/// A text of C.
///
/// # Safety
/// A pointer that is not null leads to bytes of the caller's that end with a zero, which nobody writes during `'a`.
unsafe fn text<'a>(pointer: *const c_char, name: &str) -> Result<&'a str, String> {
    usable(pointer, name)?;
    // SAFETY: not null, and by the contract of this function it ends with a zero.
    let text = unsafe { CStr::from_ptr(pointer) };
    text.to_str().map_err(|_| format!("{name} is no UTF-8 text"))
}

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
        Ok(instance) => {
            let mut instances = INSTANCES.lock().unwrap_or_else(PoisonError::into_inner);
            instances.last = instances.last.saturating_add(1);
            let number = instances.last;
            instances.held.insert(number, Arc::new(Mutex::new(Held { instance, log })));
            ptr::without_provenance_mut(number)
        }
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
    let freed = INSTANCES.lock().unwrap_or_else(PoisonError::into_inner).held.remove(&instance.addr());
    drop(freed);
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

/// As many values as references, which all are scalars.
fn as_many(references: usize, values: usize) -> Result<(), String> {
    if references == values {
        return Ok(());
    }
    Err(format!("nValues is {values} for {references} value references; each variable has one value"))
}

/// Gets values of one type.
///
/// # Safety
/// The arrays are as long as is said.
unsafe fn get<T>(
    instance: *mut c_void,
    references: *const u32,
    count: usize,
    values: *mut T,
    value_count: usize,
    of: impl Fn(&Value) -> Option<T>,
) -> Status {
    with(instance, |instance| {
        let done = as_many(count, value_count).and_then(|()| {
            // SAFETY: the caller keeps the contract.
            let references = unsafe { array(references, count, "valueReferences") }?;
            let found = references.iter().map(|reference| {
                let value = instance.get(*reference)?;
                of(value)
                    .ok_or_else(|| format!("value reference {reference} is got as another type than it has: {value:?}"))
            });
            let found = found.collect::<Result<Vec<T>, String>>()?;
            // SAFETY: as many as references, which is what the caller's array has.
            unsafe { put(values, found, "values") }
        });
        done.map_or_else(|what| instance.wrong(what), |()| Status::Ok)
    })
}

/// Sets values of one type.
///
/// # Safety
/// The arrays are as long as is said, and whatever bytes stand there are a `T`.
unsafe fn set<T: Copy>(
    instance: *mut c_void,
    references: *const u32,
    count: usize,
    values: *const T,
    value_count: usize,
    of: impl Fn(T) -> Result<Value, String>,
) -> Status {
    with(instance, |instance| {
        let given = as_many(count, value_count).and_then(|()| {
            // SAFETY: the caller keeps the contract.
            let references = unsafe { array(references, count, "valueReferences") }?;
            // SAFETY: the caller keeps the contract.
            let values = unsafe { array(values, count, "values") }?;
            references.iter().zip(values).map(|(reference, value)| Ok((*reference, of(*value)?))).collect()
        });
        instance.set(given)
    })
}

/// A C `bool` that came as a byte.
fn flag(byte: u8) -> Result<Value, String> {
    match byte {
        0 => Ok(Value::Boolean(false)),
        1 => Ok(Value::Boolean(true)),
        other => Err(format!("a Boolean is the byte {other}; it must be 0 or 1")),
    }
}

macro_rules! typed {
    ($($get:ident $set:ident $type:ty, $value:ident, $from:expr, $to:expr;)*) => {
        $(
            /// Gets values of this type.
            ///
            /// # Safety
            /// The arrays are as long as is said. Nobody else uses them during the call.
            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn $get(
                instance: *mut c_void,
                valueReferences: *const u32,
                nValueReferences: usize,
                values: *mut $type,
                nValues: usize,
            ) -> Status {
                let of = |value: &Value| if let Value::$value(value) = value { Some($from(*value)) } else { None };
                // SAFETY: the caller keeps the contract.
                unsafe { get(instance, valueReferences, nValueReferences, values, nValues, of) }
            }

            /// Sets inputs of this type: all, or none if anything is wrong with the call. Values are judged in the step.
            ///
            /// # Safety
            /// The arrays are as long as is said. Nobody else uses them during the call.
            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn $set(
                instance: *mut c_void,
                valueReferences: *const u32,
                nValueReferences: usize,
                values: *const $type,
                nValues: usize,
            ) -> Status {
                // SAFETY: the caller keeps the contract; any bytes are a number.
                unsafe { set(instance, valueReferences, nValueReferences, values, nValues, $to) }
            }
        )*
    };
}

typed! {
    fmi3GetFloat64 fmi3SetFloat64 f64, Float64, f64::from, |value| Ok(Value::Float64(value));
    fmi3GetInt8 fmi3SetInt8 i8, Int8, i8::from, |value| Ok(Value::Int8(value));
    fmi3GetUInt8 fmi3SetUInt8 u8, UInt8, u8::from, |value| Ok(Value::UInt8(value));
    fmi3GetUInt16 fmi3SetUInt16 u16, UInt16, u16::from, |value| Ok(Value::UInt16(value));
    fmi3GetInt64 fmi3SetInt64 i64, Enumeration, i64::from, |value| Ok(Value::Enumeration(value));
    fmi3GetBoolean fmi3SetBoolean u8, Boolean, u8::from, flag;
}

/// Gets frames. What the pointers lead to stays until the next call of this instance.
///
/// # Safety
/// The arrays are as long as is said. Nobody else uses them during the call.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetBinary(
    instance: *mut c_void,
    valueReferences: *const u32,
    nValueReferences: usize,
    valueSizes: *mut usize,
    values: *mut *const u8,
    nValues: usize,
) -> Status {
    static NOTHING: [u8; 1] = [0];
    if nValueReferences != 0
        && let Err(what) = usable(valueSizes, "valueSizes")
    {
        return with(instance, |instance| instance.wrong(what));
    }
    let sizes = std::cell::RefCell::new(Vec::new());
    let of = |value: &Value| {
        let Value::Binary(bytes) = value else { return None };
        sizes.borrow_mut().push(bytes.len());
        Some(if bytes.is_empty() { NOTHING.as_ptr() } else { bytes.as_ptr() })
    };
    // SAFETY: the caller keeps the contract.
    let status = unsafe { get(instance, valueReferences, nValueReferences, values, nValues, of) };
    if status != Status::Ok {
        return status;
    }
    // SAFETY: found usable above, with as many entries as there are references.
    match unsafe { put(valueSizes, sizes.into_inner(), "valueSizes") } {
        Ok(()) => Status::Ok,
        Err(what) => with(instance, |instance| instance.wrong(what)),
    }
}

/// Sets frames: all, or none if anything is wrong with the call. They are judged in the step.
///
/// # Safety
/// The arrays are as long as is said, and so is each value. Nobody else uses them during the call.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetBinary(
    instance: *mut c_void,
    valueReferences: *const u32,
    nValueReferences: usize,
    valueSizes: *const usize,
    values: *const *const u8,
    nValues: usize,
) -> Status {
    with(instance, |instance| {
        let given = as_many(nValueReferences, nValues).and_then(|()| {
            // SAFETY: the caller keeps the contract, here and below.
            let references = unsafe { array(valueReferences, nValueReferences, "valueReferences") }?;
            // SAFETY: as above.
            let sizes = unsafe { array(valueSizes, nValues, "valueSizes") }?;
            // SAFETY: as above.
            let values = unsafe { array(values, nValues, "values") }?;
            let bytes = sizes.iter().zip(values).map(|(size, value)| {
                // SAFETY: as above; any bytes are bytes.
                unsafe { array(*value, *size, "a binary value") }.map(<[u8]>::to_vec)
            });
            references.iter().zip(bytes).map(|(reference, bytes)| Ok((*reference, Value::Binary(bytes?)))).collect()
        });
        instance.set(given)
    })
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

macro_rules! unsupported {
    ($act:ident: $($name:ident($($type:ty),*) $why:literal;)*) => {
        $(
            /// Not supported: an error, and a message.
            #[unsafe(no_mangle)]
            pub extern "C" fn $name(instance: *mut c_void, $(_: $type),*) -> Status {
                with(instance, |instance| instance.$act(concat!(stringify!($name), ": ", $why)))
            }
        )*
    };
}

type References = *const u32;

// What is set in vain is an input that the simulation thinks is set.
unsupported! {
    not_set:
    fmi3SetFloat32(References, usize, *const f32, usize) "no variable is of this type";
    fmi3SetInt16(References, usize, *const i16, usize) "no variable is of this type";
    fmi3SetInt32(References, usize, *const i32, usize) "no variable is of this type";
    fmi3SetUInt32(References, usize, *const u32, usize) "no variable is of this type";
    fmi3SetUInt64(References, usize, *const u64, usize) "no variable is of this type";
    fmi3SetString(References, usize, *const *const c_char, usize) "no variable is of this type";
    fmi3SetClock(References, usize, *const u8) "no variable is of this type";
}

unsupported! {
    wrong:
    fmi3EnterEventMode() "this unit has no event mode";
    fmi3EnterStepMode() "this unit has no event mode";
    fmi3EnterConfigurationMode() "this unit has no structural parameter";
    fmi3ExitConfigurationMode() "this unit has no structural parameter";
    fmi3GetFloat32(References, usize, *mut f32, usize) "no variable is of this type";
    fmi3GetInt16(References, usize, *mut i16, usize) "no variable is of this type";
    fmi3GetInt32(References, usize, *mut i32, usize) "no variable is of this type";
    fmi3GetUInt32(References, usize, *mut u32, usize) "no variable is of this type";
    fmi3GetUInt64(References, usize, *mut u64, usize) "no variable is of this type";
    fmi3GetString(References, usize, *mut *const c_char, usize) "no variable is of this type";
    fmi3GetClock(References, usize, *mut u8) "no variable is of this type";
    fmi3GetNumberOfVariableDependencies(u32, *mut usize) "dependencies stand in the XML and do not change";
    fmi3GetVariableDependencies(u32, *mut usize, *mut u32, *mut usize, *mut i32, usize)
        "dependencies stand in the XML and do not change";
    fmi3SerializedFMUStateSize(*mut c_void, *mut usize) "states are not serialized";
    fmi3SerializeFMUState(*mut c_void, *mut u8, usize) "states are not serialized";
    fmi3DeserializeFMUState(*const u8, usize, *mut *mut c_void) "states are not serialized";
    fmi3GetDirectionalDerivative(References, usize, References, usize, *const f64, usize, *mut f64, usize)
        "this unit has no derivatives";
    fmi3GetAdjointDerivative(References, usize, References, usize, *const f64, usize, *mut f64, usize)
        "this unit has no derivatives";
    fmi3GetOutputDerivatives(References, usize, *const i32, *mut f64, usize) "this unit has no derivatives";
    fmi3GetIntervalDecimal(References, usize, *mut f64, *mut i32) "this unit has no clock";
    fmi3GetIntervalFraction(References, usize, *mut u64, *mut u64, *mut i32) "this unit has no clock";
    fmi3GetShiftDecimal(References, usize, *mut f64) "this unit has no clock";
    fmi3GetShiftFraction(References, usize, *mut u64, *mut u64) "this unit has no clock";
    fmi3SetIntervalDecimal(References, usize, *const f64) "this unit has no clock";
    fmi3SetIntervalFraction(References, usize, *const u64, *const u64) "this unit has no clock";
    fmi3SetShiftDecimal(References, usize, *const f64) "this unit has no clock";
    fmi3SetShiftFraction(References, usize, *const u64, *const u64) "this unit has no clock";
    fmi3EvaluateDiscreteStates() "this unit has no event mode";
    fmi3UpdateDiscreteStates(*mut u8, *mut u8, *mut u8, *mut u8, *mut u8, *mut f64) "this unit has no event mode";
    fmi3EnterContinuousTimeMode() "this unit has no model exchange";
    fmi3CompletedIntegratorStep(u8, *mut u8, *mut u8) "this unit has no model exchange";
    fmi3SetTime(f64) "this unit has no model exchange";
    fmi3SetContinuousStates(*const f64, usize) "this unit has no model exchange";
    fmi3GetContinuousStateDerivatives(*mut f64, usize) "this unit has no model exchange";
    fmi3GetEventIndicators(*mut f64, usize) "this unit has no model exchange";
    fmi3GetContinuousStates(*mut f64, usize) "this unit has no model exchange";
    fmi3GetNominalsOfContinuousStates(*mut f64, usize) "this unit has no model exchange";
    fmi3GetNumberOfEventIndicators(*mut usize) "this unit has no model exchange";
    fmi3GetNumberOfContinuousStates(*mut usize) "this unit has no model exchange";
    fmi3ActivateModelPartition(u32, f64) "this unit has no scheduled execution";
}
