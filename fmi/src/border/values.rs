//! The functions that get and set values.

use std::ffi::c_void;

use super::instances::with;
use super::pointer::{array, put, usable};
use crate::instance::Status;
use crate::variables::Value;

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
