//! The train control signal as a waveform, and the track that it crosses; floating point, outside the verified kernel
//! (JP4845985B2, JP4045174B2).
//!
//! Two carriers, *main* and *sub*, are each keyed by a stream of telegrams (MSK); that wave is amplitude-modulated by a
//! code frequency; both are added. A conventional train hears the codes, a new one the codes and the telegrams, the track
//! circuit whether its own signal arrives at all. What is heard goes to the kernel's machines, which alone decide what it
//! means: [`Deframer`](atc_kernel::telegram::Deframer) for bits, [`CodeTable`](atc_kernel::code::CodeTable) for codes.
//!
//! | module | part |
//! |---|---|
//! | [`config`], [`units`] | what is sent, checked |
//! | [`generator`], [`transmitter`] | samples from bits and codes; from telegrams and codes |
//! | [`channel`] | noise, traction current, crosstalk, interruptions, and any filter, such as that of [`rail`] |
//! | [`receiver`] | conventional, on board, track circuit |
//! | [`wav`] | files |
//! | [`measure`] | bit errors, detection times, false codes, throughput, spectrum |
//! | [`rail`], [`calibration`], `position_*` | the track as a line, and the train's position from levels |
//! | [`plot`], `plot_*` | pictures |
//!
//! Everything streams: signals are made, changed and heard block by block, without an allocation in the loop, and the lengths of
//! the blocks change nothing.
//!
//! # From telegrams to samples and back
//!
//! ```
//! use atc_kernel::aspect::AspectId;
//! use atc_kernel::distance::Metres;
//! use atc_kernel::telegram::{Counter, Gradient, Length, Main, Route, SectionId, Sub};
//! use atc_waveform::channel::{Channel, Noise, Stage};
//! use atc_waveform::config::{Codes, TransmitterConfig};
//! use atc_waveform::receiver::{Heard, OnBoard, example_code_table};
//! use atc_waveform::transmitter::Transmitter;
//! use atc_waveform::units::{Decibels, Hertz, Seed};
//!
//! // The ground: what is sent in section 17.
//! let (section, counter) = (SectionId(17), Counter(0));
//! let speed = AspectId::new(5).expect("under 16");
//! let main = Main { section, counter, route: Route::OpenFor(Metres(850)), speed };
//! let length = Length::new(Metres(240)).expect("not 0");
//! let sub = Sub { section, counter, length, gradient: Gradient(-12), curve: speed, restriction: speed };
//!
//! let config = TransmitterConfig::default();
//! let codes = Codes::new(Some(Hertz(29.0)), Some(Hertz(27.0)))?;
//! let mut transmitter = Transmitter::new(&config, codes, main, sub);
//! let mut channel = Channel::new().with(Noise::signal_to_noise(&config, codes, Decibels(12.0), Seed(1)));
//! let mut receiver = OnBoard::new(&config, example_code_table().expect("the example is right"));
//!
//! let mut block = [0.0; 800]; // 0.1 s
//! for _ in 0..20 {
//!     transmitter.fill(&mut block);
//!     channel.apply(&mut block);
//!     receiver.process(&block, |event| match event.heard {
//!         Heard::Main(heard) => {
//!             let time = event.at.time(config.sample_rate());
//!             println!("{:.2} s: {heard:?}", time.0);
//!             assert_eq!(Main { counter, ..heard }, main);
//!         }
//!         Heard::Speed(Some(speed)) => assert_eq!(speed.0, 550), // tenths of km/h
//!         _ => (),
//!     });
//! }
//! # Ok::<(), atc_waveform::config::ConfigError>(())
//! ```
//!
//! # In the house
//!
//! Uses `atc-files`, `atc-kernel`. Used by `atc-oracle`, `atc-simulation`. Begin with [`transmitter`] and
//! [`receiver`].
#![forbid(unsafe_code)]

pub mod calibration;
pub mod channel;
pub mod config;
mod filter;
pub mod generator;
pub mod measure;
pub mod plot;
pub mod plot_signal;
pub mod position_measure;
pub mod position_meter;
pub mod position_plot;
pub mod position_run;
pub mod rail;
pub mod receiver;
pub mod transmitter;
pub mod units;
pub mod wav;
