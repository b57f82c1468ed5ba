//! `wayside`: [`atc_kernel::wayside`], the ground's device as one machine, behind the protocol.

mod config;
mod device;
mod forms;

pub use config::{CircuitSignals, Config, CountedBlock, CountedLine, Direction, FacingSignals, Signals};
pub use forms::{Detection, Feed, Framed, LineReport, Message, Output, Permission, Stamp, Step, Transmission};

use std::collections::{BTreeMap, BTreeSet};

use atc_kernel::block::Block;
use atc_kernel::code::{Code, CodeFrequencies};
use atc_kernel::interlocking::{CircuitSet, Large, Size, Small};
use atc_kernel::telegram::{self, Frame, decode};
use atc_kernel::wayside as kernel;

use super::contract::Machine;
use super::interlocking::{self, Interlocked};
use super::sizes;
use crate::decimal::Hertz;
use device::{Device, Done, Read, device};

/// The machine with its state, on a layout of one size.
pub struct Ground<const R: usize = 64, const P: usize = 16, const N: usize = 32, const S: usize = 8, Z: Size = Small> {
    /// The layout, and what interlocking and ATC remember.
    station: Interlocked<R, P, N, S, Z>,
    blocks: Vec<Block>,
    codes: (CodeFrequencies, CodeFrequencies),
    device: Box<dyn Device<R, P, N, S, Z>>,
}

/// The ground's device of a station of either size.
pub type Sizes =
    sizes::Sizes<Ground, Ground<{ sizes::ROUTES }, { sizes::PLACES }, { sizes::POINTS }, { sizes::SEGMENTS }, Large>>;

impl<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size> Ground<R, P, N, S, Z> {
    /// The layout, its names, and what interlocking and ATC remember.
    pub fn station(&self) -> &Interlocked<R, P, N, S, Z> {
        &self.station
    }

    fn read(&self, step: &Step) -> Result<Read<S, Z>, String> {
        // Read as the interlocking reads it, which has the sentences.
        let told = self.station.input(&interlocking::Step {
            occupied: step.occupied.clone(),
            detected: step.detected.clone(),
            request: step.request.clone(),
            orders: step.orders.clone(),
            consent: Vec::new(),
            all_telegrams: false,
        })?;
        if step.blocks.len() != self.blocks.len() {
            return Err(format!("blocks has {} blocks; the counted line has {}", step.blocks.len(), self.blocks.len()));
        }
        let mut blocks = Vec::with_capacity(self.blocks.len());
        for (number, (detection, block)) in step.blocks.iter().zip(&self.blocks).enumerate() {
            blocks.push(detection.kernel(&format!("blocks[{number}]"), *block)?);
        }
        let mut messages = [None; S];
        for (name, message) in &step.messages.0 {
            let number = usize::from(self.station.segment(name, "messages")?.number());
            if let Some(place) = messages.get_mut(number) {
                *place = Some(message.kernel(&format!("messages.{name}"))?);
            }
        }
        let taken = |list: &Option<Vec<String>>, field: &str| match list {
            None => Ok(CircuitSet::ALL),
            Some(list) => self.station.circuits_named(list, field),
        };
        let (main, sub) = (taken(&step.framed.main, "framed.main")?, taken(&step.framed.sub, "framed.sub")?);
        Ok(Read {
            blocks,
            occupied: told.occupied,
            detected: told.detected,
            request: told.request,
            orders: told.orders,
            messages,
            framed: kernel::Framed { main, sub },
        })
    }

    fn feed(&self, feed: kernel::Feed) -> Option<Feed> {
        let of = |frame: Frame| decode(frame).ok();
        let (Some(telegram::Telegram::Main(main)), Some(telegram::Telegram::Sub(sub))) = (of(feed.main), of(feed.sub))
        else {
            return None;
        };
        let hz = |codes: &CodeFrequencies, code: Code| {
            codes.nominal().get(usize::from(code.place())).map(|code| Hertz(code.0.into()))
        };
        let (main_hz, sub_hz) = (hz(&self.codes.0, feed.codes.main)?, hz(&self.codes.1, feed.codes.sub)?);
        Some(Feed { main: main.into(), sub: sub.into(), main_hz, sub_hz })
    }

    fn output(&self, done: &Done<R, S, Z>, all_telegrams: bool) -> Result<Output, String> {
        let names = self.station.names();
        let (mut transmissions, mut silent) = (BTreeMap::new(), BTreeSet::new());
        for (name, sent) in names.circuits.iter().zip(done.transmissions.iter()) {
            let Some(sent) = sent else {
                silent.insert(name.clone());
                continue;
            };
            let feeds = self.feed(sent.left).zip(self.feed(sent.right));
            // What was encoded is decoded (T-TEL-1).
            let (left, right) = feeds.ok_or_else(|| format!("what is sent in {name} is no telegram"))?;
            let open = left.main.beyond_exit_m.is_some() || right.main.beyond_exit_m.is_some();
            if open || all_telegrams {
                transmissions.insert(name.clone(), Transmission { left, right });
            }
        }
        let told = names.segments.iter().zip(&done.messages);
        let line = done.line.as_ref().map(|(blocks, hold)| LineReport {
            blocks: blocks.iter().map(|block| (*block).into()).collect(),
            before_hold_sections: hold.sections(),
        });
        Ok(Output {
            routes: self.station.phases(),
            proceed: self.station.routes_of(done.proceed),
            drives: self.station.sides(done.drives),
            confirmed: self.station.circuits_of(done.confirmed),
            answer: self.station.answer(done.told, self.station.counted(), done.answer),
            messages: told.filter_map(|(name, message)| Some((name.clone(), (*message)?.into()))).collect(),
            line,
            transmissions,
            silent,
        })
    }

    /// The circuits that the interlocking is told to be occupied in a cycle, and those of segments that it is permitted to send trains to, by name.
    ///
    /// # Errors
    /// As [`Machine::step`].
    pub fn told(&mut self, step: &Step) -> Result<(Output, BTreeSet<String>, BTreeSet<String>), String> {
        let done = self.run(step)?;
        let consent = self.station.names().segments.iter().enumerate();
        let consent = consent.filter(|(number, _)| done.told.consent.has_number(*number));
        let consent = consent.map(|(_, name)| name.clone()).collect();
        let occupied = self.station.circuits_of(done.told.occupied);
        Ok((self.output(&done, step.all_telegrams)?, occupied, consent))
    }

    fn run(&mut self, step: &Step) -> Result<Done<R, S, Z>, String> {
        let read = self.read(step)?;
        let restart = step.restart.map(|number| config::session("restart", number)).transpose()?;
        let layout = self.station.layout();
        // What was accepted at the start is accepted again.
        let again = |error: kernel::WaysideError| format!("the device is no longer accepted: {error:?}");
        if let Some(session) = restart {
            self.device.restart(layout, session).map_err(again)?;
        }
        let done = self.device.step(layout, &read).map_err(again)?;
        self.station.remember(&done.memory);
        Ok(done)
    }
}

/// Makes the device of as many blocks as there are.
macro_rules! with_blocks {
    ($config:ident, $station:ident, $parts:ident: $($number:literal)*) => {
        match $parts.blocks.len() {
            $($number => {
                let equipment = $config.equipment::<$number, R, P, N, S, Z>(&$station, &$parts)?;
                device($station.layout(), equipment).map_err(|error| $config.explain(&$station, error))
            })*
            many => Err(format!("counted.blocks has {many} blocks; a line has 1 to 8")),
        }
    };
}

impl<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size> Machine for Ground<R, P, N, S, Z> {
    const NAME: &'static str = "wayside";
    const STEP: &'static str = r#"{"occupied":["1T"],"detected":{"P1":"normal"},"blocks":[{"low_check":false,"high_check":false,"present":[0],"reset":null}],"request":{"set":"W-1"},"messages":{"West":{"permission":"granted","sent":{"session":1,"cycle":9},"echo":{"session":0,"cycle":8}}}}"#;
    const CONFIG: &'static str = r#"{"layout":{…},"counted":{"segment":"West","travel":"toward","direction":"up","train_m":200,"blocks":[{"circuits":["W2","W1"],"max_trains":1,"tail_hold_sections":1}]},"signals":{"speeds_km_h":[0,45],"codes":{"pairs":[…]},"circuits":{"1T":{…}}},"life_ms":1000,"session":1}, with a layout of `interlocking`"#;

    type Config = Config;
    type Step = Step;
    type Output = Output;

    fn open(config: &Config) -> Result<Self, String> {
        let station = Interlocked::open(&config.layout).map_err(|what| format!("layout: {what}"))?;
        let parts = config.parts(&station)?;
        if let (Some(_), true) = (&config.counted, parts.blocks.is_empty()) {
            return Err("counted.blocks is empty; a line has 1 to 8 blocks".to_owned());
        }
        let device = with_blocks!(config, station, parts: 0 1 2 3 4 5 6 7 8)?;
        let codes = (*parts.signals.codes.main(), *parts.signals.codes.sub());
        Ok(Self { station, blocks: parts.blocks, codes, device })
    }

    fn step(&mut self, step: &Step) -> Result<Output, String> {
        let done = self.run(step)?;
        self.output(&done, step.all_telegrams)
    }

    fn cycles(&self) -> Vec<(&'static str, u16)> {
        let mut cycles = self.station.cycles();
        cycles.push(("life", self.device.oldest().0));
        cycles
    }
}
