//! The pointers of C: what is checked of each, and the reading and writing through it.

use std::ffi::{CStr, c_char};
use std::slice;

/// The most entries that an array of one call has, and the most bytes that a binary value has.
const MOST: usize = 1 << 16;

/// What can be told of a pointer.
pub(super) fn usable<T>(pointer: *const T, name: &str) -> Result<(), String> {
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
pub(super) unsafe fn array<'a, T: Copy>(pointer: *const T, count: usize, name: &str) -> Result<&'a [T], String> {
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
pub(super) unsafe fn put<T>(pointer: *mut T, entries: Vec<T>, name: &str) -> Result<(), String> {
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
pub(super) unsafe fn text<'a>(pointer: *const c_char, name: &str) -> Result<&'a str, String> {
    usable(pointer, name)?;
    // SAFETY: not null, and by the contract of this function it ends with a zero.
    let text = unsafe { CStr::from_ptr(pointer) };
    text.to_str().map_err(|_| format!("{name} is no UTF-8 text"))
}
