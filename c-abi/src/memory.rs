//! The bytes of a state in the caller's memory: a tag, two check words, the parameters, the state.
//!
//! Nothing here trusts the bytes. A state is read back through the kernel's own constructors and its `is_valid`.

use crate::atc_status;

/// The version of the border and of the states behind it. `atc_version` returns it.
pub const ATC_VERSION: u32 = 2;

/// The bytes before the parameters: the tag and the two check words.
pub(crate) const HEADER: usize = 24;

/// A machine behind the border: how its parameters and its state become bytes, and how it steps on a C input.
pub(crate) trait Machine {
    /// Four letters that tell its states from those of other machines.
    const TAG: [u8; 4];
    /// How many bytes its parameters take: a multiple of 8.
    const PARAMETERS: usize;
    /// The kernel's checked parameters.
    type Parameters;
    /// The kernel's state.
    type State;
    /// A step's input, in C's form.
    type Input;
    /// A step's output, in C's form.
    type Output;
    /// The kernel's safe output: what a call that fails puts out.
    const SAFE: Self::Output;

    /// The kernel's initial state.
    fn initial(parameters: &Self::Parameters) -> Self::State;
    /// Writes the parameters.
    fn put_parameters(parameters: &Self::Parameters, to: &mut Writer<'_>);
    /// Reads the parameters through the kernel's constructors; `None` if they are none.
    fn take_parameters(from: &mut Reader<'_>) -> Option<Self::Parameters>;
    /// Writes the state.
    fn put_state(state: &Self::State, to: &mut Writer<'_>);
    /// Reads the state; `None` if it is none, or not valid.
    fn take_state(parameters: &Self::Parameters, from: &mut Reader<'_>) -> Option<Self::State>;
    /// One logic cycle.
    ///
    /// # Errors
    /// What in the input has no meaning for these parameters.
    fn step(
        parameters: &Self::Parameters,
        state: Self::State,
        input: &Self::Input,
    ) -> Result<(Self::State, Self::Output), atc_status>;
}

/// Puts the machine's initial state into `memory`.
pub(crate) fn start<M: Machine>(memory: &mut [u8], parameters: &M::Parameters) {
    memory.fill(0);
    let Some((header, rest)) = memory.split_first_chunk_mut::<HEADER>() else { return };
    let (kept, state) = rest.split_at_mut(M::PARAMETERS.min(rest.len()));
    M::put_parameters(parameters, &mut Writer(kept));
    M::put_state(&M::initial(parameters), &mut Writer(state));
    let sum = check(tag::<M>(), kept);
    let words = [tag::<M>(), sum, check(sum, state)];
    for (place, word) in header.chunks_exact_mut(8).zip(words) {
        place.copy_from_slice(&word.to_le_bytes());
    }
}

/// Makes `memory` hold no state.
pub(crate) fn forget(memory: &mut [u8]) {
    let most = HEADER.min(memory.len());
    if let Some(header) = memory.get_mut(..most) {
        header.fill(0);
    }
}

/// One logic cycle on the state in `memory`.
///
/// # Errors
/// [`atc_status::NotStarted`] if no state of this machine was put there, [`atc_status::Damaged`] if it has changed
/// since, and what the machine says of the input.
pub(crate) fn step<M: Machine>(memory: &mut [u8], input: &M::Input) -> Result<M::Output, atc_status> {
    let (header, rest) = memory.split_first_chunk_mut::<HEADER>().ok_or(atc_status::TooSmall)?;
    let mut words = Reader(header);
    if words.u64() != Some(tag::<M>()) {
        return Err(atc_status::NotStarted);
    }
    let (kept, place) = rest.split_at_mut_checked(M::PARAMETERS).ok_or(atc_status::TooSmall)?;
    let sum = check(tag::<M>(), kept);
    if words.u64() != Some(sum) || words.u64() != Some(check(sum, place)) {
        return Err(atc_status::Damaged);
    }
    // Where they are: those of a large station are not moved once more.
    let Some(parameters) = &M::take_parameters(&mut Reader(kept)) else { return Err(atc_status::Damaged) };
    let state = M::take_state(parameters, &mut Reader(place)).ok_or(atc_status::Damaged)?;
    let (state, output) = M::step(parameters, state, input)?;
    M::put_state(&state, &mut Writer(place));
    // The check word of the state stands behind the tag and that of the parameters, which it begins with.
    header[16..].copy_from_slice(&check(sum, place).to_le_bytes());
    Ok(output)
}

/// The first word of a state: the machine and the version.
fn tag<M: Machine>() -> u64 {
    u64::from(u32::from_le_bytes(M::TAG)) | u64::from(ATC_VERSION) << 32
}

/// The number that stands in 8 bytes.
fn word(bytes: &[u8]) -> u64 {
    u64::from_le_bytes(bytes.try_into().unwrap_or_default())
}

/// A check word over `bytes`, a multiple of 8. Each round is one-to-one in what is read and in what came before: a
/// change
/// within one word of 8 bytes always shows. Any other change is overlooked once in 2^64.
fn check(seed: u64, bytes: &[u8]) -> u64 {
    bytes
        .chunks_exact(8)
        .map(word)
        .fold(seed, |sum, word| (sum ^ word).wrapping_mul(0x9E37_79B9_7F4A_7C15).rotate_left(29))
}

/// Writes numbers one after the other, the lowest byte first. What does not fit is left out: then the state is not
/// read back,
/// and a test of every size shows it.
pub(crate) struct Writer<'a>(pub(crate) &'a mut [u8]);

/// Reads what a [`Writer`] wrote; `None` at the end.
pub(crate) struct Reader<'a>(pub(crate) &'a [u8]);

impl Writer<'_> {
    fn put<const N: usize>(&mut self, bytes: [u8; N]) {
        if let Some((place, rest)) = core::mem::take(&mut self.0).split_first_chunk_mut::<N>() {
            *place = bytes;
            self.0 = rest;
        }
    }

    pub(crate) fn u8(&mut self, number: u8) {
        self.put([number]);
    }

    pub(crate) fn i8(&mut self, number: i8) {
        self.put(number.to_le_bytes());
    }

    pub(crate) fn flag(&mut self, flag: bool) {
        self.put([u8::from(flag)]);
    }

    pub(crate) fn u16(&mut self, number: u16) {
        self.put(number.to_le_bytes());
    }

    pub(crate) fn i16(&mut self, number: i16) {
        self.put(number.to_le_bytes());
    }

    pub(crate) fn u32(&mut self, number: u32) {
        self.put(number.to_le_bytes());
    }

    pub(crate) fn u64(&mut self, number: u64) {
        self.put(number.to_le_bytes());
    }

    pub(crate) fn u128(&mut self, number: u128) {
        self.put(number.to_le_bytes());
    }
}

impl Reader<'_> {
    fn take<const N: usize>(&mut self) -> Option<[u8; N]> {
        let (bytes, rest) = self.0.split_first_chunk::<N>()?;
        self.0 = rest;
        Some(*bytes)
    }

    pub(crate) fn u8(&mut self) -> Option<u8> {
        self.take().map(|[byte]| byte)
    }

    pub(crate) fn i8(&mut self) -> Option<i8> {
        self.take().map(i8::from_le_bytes)
    }

    pub(crate) fn flag(&mut self) -> Option<bool> {
        match self.u8()? {
            0 => Some(false),
            1 => Some(true),
            _ => None,
        }
    }

    pub(crate) fn u16(&mut self) -> Option<u16> {
        self.take().map(u16::from_le_bytes)
    }

    pub(crate) fn i16(&mut self) -> Option<i16> {
        self.take().map(i16::from_le_bytes)
    }

    pub(crate) fn u32(&mut self) -> Option<u32> {
        self.take().map(u32::from_le_bytes)
    }

    pub(crate) fn u64(&mut self) -> Option<u64> {
        self.take().map(u64::from_le_bytes)
    }

    pub(crate) fn u128(&mut self) -> Option<u128> {
        self.take().map(u128::from_le_bytes)
    }
}
