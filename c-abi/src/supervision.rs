//! Speed supervision behind the border: [`atc_kernel::supervision`].

use atc_kernel::speed::{KmhTenths, RawKmhTenths};
use atc_kernel::supervision::{self, Brake, Speeds, Supervision, SupervisionError};

use crate::memory::{Machine, Reader, Writer};
use crate::{atc_status, flag};

/// The size of a speed supervision in bytes.
pub const ATC_SUPERVISION_SIZE: usize = 40;
/// The alignment of a speed supervision in bytes.
pub const ATC_SUPERVISION_ALIGN: usize = 8;

/// No braking by this device.
pub const ATC_BRAKE_RELEASE: u32 = 0;
/// Service brake.
pub const ATC_BRAKE_SERVICE: u32 = 1;
/// Emergency brake.
pub const ATC_BRAKE_EMERGENCY: u32 = 2;

/// A speed supervision with its state. Its bytes are the library's; it may be moved and copied as a whole.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct atc_supervision {
    /// Not to be read or written.
    pub opaque: [u64; 5],
}

/// The parameters of the supervision, in tenths of km/h.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct atc_supervision_config {
    /// The highest plausible speed, above 0. A measured speed above it is implausible.
    pub maximum: u16,
    /// How far below the permitted speed the train must be before a brake that is on is released: 0 to `maximum`.
    pub margin: u16,
}

/// One logic cycle's input. Any speed is an input, plausible or not.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct atc_supervision_input {
    /// The measured speed in tenths of km/h. Not looked at if `has_measured` is 0.
    pub measured: i32,
    /// The permitted speed in tenths of km/h. Not looked at if `has_permitted` is 0.
    pub permitted: i32,
    /// 1: there is a measured speed. 0: there is none, and that is the emergency brake.
    pub has_measured: u8,
    /// 1: there is a permitted speed. 0: nothing is displayed, and that is the emergency brake.
    pub has_permitted: u8,
}

/// One logic cycle's output. The safe one is the emergency brake.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct atc_supervision_output {
    /// The brake command from the end of the cycle on: `ATC_BRAKE_RELEASE`, `ATC_BRAKE_SERVICE` or
    /// `ATC_BRAKE_EMERGENCY`.
    pub brake: u32,
}

pub(crate) struct Supervised;

/// The kernel's parameters of a configuration.
pub(crate) fn parameters(config: &atc_supervision_config) -> Result<Supervision, atc_status> {
    Supervision::new(KmhTenths(config.maximum), KmhTenths(config.margin)).map_err(|error| match error {
        SupervisionError::NoMaximum => atc_status::NoMaximum,
        SupervisionError::MarginAboveMaximum => atc_status::MarginAboveMaximum,
    })
}

pub(crate) const fn number(brake: Brake) -> u32 {
    match brake {
        Brake::Release => ATC_BRAKE_RELEASE,
        Brake::Service => ATC_BRAKE_SERVICE,
        Brake::Emergency => ATC_BRAKE_EMERGENCY,
    }
}

impl Machine for Supervised {
    const TAG: [u8; 4] = *b"SUPV";
    const PARAMETERS: usize = 8;
    type Parameters = Supervision;
    type State = Brake;
    type Input = atc_supervision_input;
    type Output = atc_supervision_output;
    const SAFE: Self::Output = atc_supervision_output { brake: number(<Supervision as atc_kernel::Machine>::SAFE) };

    fn initial(parameters: &Supervision) -> Brake {
        atc_kernel::Machine::initial(parameters)
    }

    fn put_parameters(parameters: &Supervision, to: &mut Writer<'_>) {
        to.u16(parameters.maximum().0);
        to.u16(parameters.margin().0);
    }

    fn take_parameters(from: &mut Reader<'_>) -> Option<Supervision> {
        Supervision::new(KmhTenths(from.u16()?), KmhTenths(from.u16()?)).ok()
    }

    fn put_state(state: &Brake, to: &mut Writer<'_>) {
        to.u32(number(*state));
    }

    fn take_state(_: &Supervision, from: &mut Reader<'_>) -> Option<Brake> {
        match from.u32()? {
            ATC_BRAKE_RELEASE => Some(Brake::Release),
            ATC_BRAKE_SERVICE => Some(Brake::Service),
            ATC_BRAKE_EMERGENCY => Some(Brake::Emergency),
            _ => None,
        }
    }

    fn step(
        parameters: &Supervision,
        previous: Brake,
        input: &atc_supervision_input,
    ) -> Result<(Brake, atc_supervision_output), atc_status> {
        let speeds = Speeds {
            measured: flag(input.has_measured)?.then_some(RawKmhTenths(input.measured)),
            permitted: flag(input.has_permitted)?.then_some(RawKmhTenths(input.permitted)),
        };
        let brake = supervision::step(*parameters, previous, speeds);
        Ok((brake, atc_supervision_output { brake: number(brake) }))
    }
}
