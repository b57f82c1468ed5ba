//! Interlocking and ATC behind the border: [`atc_kernel::interlocking`], for stations of either size.

mod bytes;
mod forms;
mod input;
mod output;
mod plan;
mod sets;

pub use forms::*;
pub(crate) use input::Plan;
pub(crate) use plan::{Arrays, ConfigOf, ElementOf, Fault, RouteOf, SegmentOf, layout};
pub(crate) use sets::InC;

use core::marker::PhantomData;

use atc_kernel::Machine as _;
use atc_kernel::interlocking::{Combined, Large, Memory, Small};

use crate::atc_status;
use crate::memory::{Machine, Reader, Writer};
use input::InputOf;
use output::OutputOf;

/// The machine for a size of station.
pub(crate) struct Interlocked<const R: usize, const P: usize, const N: usize, const S: usize, Z>(PhantomData<Z>);

/// A station of up to 64 circuits and routes.
pub(crate) type SmallStation = Interlocked<64, 16, 32, 8, Small>;

/// A station of up to 256 circuits and routes.
pub(crate) type LargeStation = Interlocked<256, 32, 128, 32, Large>;

const _: () = assert!(bytes::size::<64, 16, 32, 8, Small>() == ATC_INTERLOCKING_SIZE);
const _: () = assert!(bytes::size::<256, 32, 128, 32, Large>() == ATC_LARGE_INTERLOCKING_SIZE);

impl<const R: usize, const P: usize, const N: usize, const S: usize, Z: InC> Machine for Interlocked<R, P, N, S, Z> {
    // No state of the one size is one of the other.
    const TAG: [u8; 4] = if R > 64 { *b"ILCL" } else { *b"ILCK" };
    const PARAMETERS: usize = bytes::parameters::<R, P, N, S, Z>();
    type Parameters = Plan<R, P, N, S, Z>;
    type State = Memory<R, S, Z>;
    type Input = InputOf<Z>;
    type Output = OutputOf<R, Z>;
    const SAFE: Self::Output = output::safe::<R, Z>();

    fn initial(_: &Self::Parameters) -> Self::State {
        Memory::INITIAL
    }

    fn put_parameters(plan: &Self::Parameters, to: &mut Writer<'_>) {
        bytes::put_plan(plan, to);
    }

    fn take_parameters(from: &mut Reader<'_>) -> Option<Self::Parameters> {
        bytes::take_plan(from)
    }

    fn put_state(memory: &Self::State, to: &mut Writer<'_>) {
        bytes::put_memory(memory, to);
    }

    fn take_state(plan: &Self::Parameters, from: &mut Reader<'_>) -> Option<Self::State> {
        bytes::take_memory(from).filter(|memory| memory.is_valid(&plan.layout))
    }

    fn step(
        plan: &Self::Parameters,
        memory: Self::State,
        input: &Self::Input,
    ) -> Result<(Self::State, Self::Output), atc_status> {
        let input = plan.there.input(input)?;
        let (memory, commands) = Combined(&plan.layout).step(memory, input);
        let output = output::output(plan.there, &memory, &commands);
        Ok((memory, output))
    }
}
