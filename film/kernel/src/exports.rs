//! What the page calls. Words go through one buffer in the module's memory: its address is asked for once.

use std::cell::RefCell;

use crate::device::{Device, OUTPUT};
use crate::words::INPUT;

/// Room for a plan of the greatest size, or for the words of a cycle.
const ROOM: usize = 8192;

thread_local! {
    static DEVICE: RefCell<Option<Device>> = const { RefCell::new(None) };
    static BUFFER: RefCell<Box<[u64]>> = RefCell::new(vec![0; ROOM].into_boxed_slice());
}

/// Where the buffer is, in bytes.
#[unsafe(no_mangle)]
extern "C" fn buffer() -> usize {
    BUFFER.with_borrow(|buffer| buffer.as_ptr() as usize)
}

/// How many words have room in it.
#[unsafe(no_mangle)]
extern "C" fn room() -> usize {
    ROOM
}

/// Starts the device of the plan whose words stand in the buffer. 1 if it has started, 0 if the plan is no layout.
#[unsafe(no_mangle)]
extern "C" fn start() -> u32 {
    let device = BUFFER.with_borrow(|buffer| Device::new(buffer));
    let started = u32::from(device.is_some());
    DEVICE.set(device);
    started
}

/// Starts the device anew.
#[unsafe(no_mangle)]
extern "C" fn restart() {
    DEVICE.with_borrow_mut(|device| {
        if let Some(device) = device {
            device.restart();
        }
    });
}

/// One cycle: the input stands in the buffer, and then what is to be shown. The number of words; 0 without a device.
#[unsafe(no_mangle)]
extern "C" fn step() -> usize {
    DEVICE.with_borrow_mut(|device| {
        let Some(device) = device else { return 0 };
        BUFFER.with_borrow_mut(|buffer| {
            let shown = device.step(&buffer[..INPUT]);
            buffer[..OUTPUT].copy_from_slice(&shown);
        });
        OUTPUT
    })
}
