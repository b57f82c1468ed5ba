//! Sessions that once ended in an accident, or would have: each with legal input, on `layouts/passing-loop.toml`. What must hold instead is
//! said of the train that is drawn beside the kernel: nothing moves in front of it or under it, and nobody else is let in.

mod border;
mod heading;
mod line;
mod points;
mod release;
mod session;
mod start;
mod throat;
