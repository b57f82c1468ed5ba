//! The functions that this unit has nothing for: each is an error, and a message.

use std::ffi::{c_char, c_void};

use super::instances::with;
use crate::instance::Status;

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
