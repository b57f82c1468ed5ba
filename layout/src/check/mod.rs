//! The rules that need names, geometry and times: what the kernel's plan cannot show.

mod ends;
mod routes;
mod station;

pub use station::lines;

use crate::form::Station;
use crate::model::Model;
use crate::problem::Problem;

/// Every rule of engineering that `model` breaks; `station` is the file it was made from.
pub fn check(station: &Station, model: &Model, problems: &mut Vec<Problem>) {
    station::check(station, model, problems);
    for (number, route) in model.routes.iter().enumerate() {
        if route.is_sound() {
            routes::check(&station.routes[number], model, route, problems);
            ends::check(&station.routes[number], model, route, problems);
        }
    }
}
