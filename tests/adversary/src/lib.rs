//! An adversary: a closed loop of the device with trains, points and people on the ground that tries to cause an accident by legal
//! input, and judges it on the ground.
//!
//! * [`ground`], [`train`], [`point`], [`driver`], [`neighbour`]: the truth, on millimetres, from the tracks of the layout file.
//! * [`device`]: the only file that knows the kernel.
//! * [`moves`], [`arsenal`], [`attacker`]: what the adversary may do, and how it draws that from a seed. [`dispatcher`]: what
//!   keeps traffic going meanwhile.
//! * [`world`]: a cycle of all of it. [`judge`]: what an accident is. [`conditions`]: whether the numbered conditions held.
//! * [`hunt`]: episodes, replay, and scenarios made small. [`words`]: a scenario in the words of the railway.
//!   [`trace`]: the same for `oracle explore`, which makes a film of it.
//! * [`joined`], [`pair`], [`between`], [`sliding`]: two stations with a line between them, as one ground and one device, for the program `two_stations`.
//! * [`altered`]: stations whose files were altered at random, and still break no rule.
//! * [`stations`]: where it hunts. [`known`]: the faults that it must find while they are there.
//!
//! # In the house
//!
//! Uses `atc-kernel`, `atc-layout`, `atc-oracle`, `atc-protocol`. Used by no other crate of the house. Begin with
//! [`hunt`].

pub mod altered;
pub mod arsenal;
pub mod attacker;
pub mod between;
pub mod conditions;
pub mod device;
pub mod dice;
pub mod dispatcher;
pub mod driver;
pub mod ground;
pub mod hunt;
pub mod joined;
pub mod judge;
pub mod known;
pub mod moves;
pub mod neighbour;
pub mod pair;
pub mod point;
pub mod sliding;
pub mod stations;
pub mod trace;
pub mod train;
pub mod words;
pub mod world;
