//! A signaller who keeps traffic going, so that there is something to attack: the routes that trains want next, the lines that these lead
//! to, and the routes that nobody comes for.

use super::device::Ask;
use super::dice::Dice;
use super::ground::{Ground, bit};
use super::moves::Move;
use super::train::Train;
use super::world::World;

/// How many pieces ahead of a train its next signal may stand.
const SIGHT: usize = 6;

/// The routes that begin at the next signal ahead of the train, as the points lie.
pub fn wanted(world: &World, train: &Train) -> Vec<usize> {
    let ground = world.ground;
    let (mut piece, mut joint) = (train.front().piece, train.front().exit);
    for _ in 0..SIGHT {
        let circuit = ground.pieces[piece].circuit;
        let begins = |route: &usize| ground.routes[*route].start == joint && ground.routes[*route].entry == circuit;
        let routes: Vec<usize> = (0..ground.routes.len()).filter(begins).collect();
        if !routes.is_empty() {
            return routes;
        }
        let Some(next) = ground.across(joint, piece) else { break };
        let reverse = ground.pieces[next].point.is_some_and(|point| world.points.lies(point));
        (joint, piece) = (ground.leave(next, joint, reverse).0, next);
    }
    Vec::new()
}

/// A route that was asked for, and that no train runs on or comes near to: those there are stand, and are not told that they may run.
fn unused(world: &World, dice: &mut Dice) -> Option<usize> {
    let runs = world.trains.iter().filter(|train| train.speed > 0 || train.authority != 0);
    let under = runs.fold(0, |all, train| all | train.under);
    let is_unused = |route: &usize| {
        let it = &world.ground.routes[*route];
        world.truth.asked[*route].0 && (it.mask | it.approach | it.entry_mask()) & under == 0
    };
    let routes: Vec<usize> = (0..world.ground.routes.len()).filter(is_unused).collect();
    dice.pick(&routes)
}

/// What he does next. `sends` says of a line whether this station is to send.
pub fn dispatch(world: &World, dice: &mut Dice, sends: &dyn Fn(usize) -> bool, moves: &mut Vec<Move>) {
    let ground = world.ground;
    if dice.once_in(12) {
        moves.push(Move::Ask(Ask::Set(dice.below(ground.routes.len()))));
        return;
    }
    if dice.once_in(6)
        && let Some(route) = unused(world, dice)
    {
        moves.push(Move::Ask(Ask::Withdraw(route)));
        return;
    }
    let Some(train) = world.trains.get(dice.below(world.trains.len())) else { return };
    let Some(route) = dice.pick(&wanted(world, train)) else { return };
    match ground.routes[route].lines[1] {
        Some(line) if sends(line) && dice.once_in(2) => {
            moves.push(Move::Consent(line, true));
            moves.push(Move::Ask(Ask::Turn(line, true)));
        }
        _ => moves.push(Move::Ask(Ask::Set(route))),
    }
}

/// Whether nothing moves, and no train is told that it may.
pub fn is_at_rest(world: &World) -> bool {
    world.trains.iter().all(|train| train.speed == 0 && train.authority == 0)
}

/// The lines with a train on the station's part of them.
pub fn busy_lines(world: &World, ground: &Ground) -> Vec<usize> {
    let under = world.trains.iter().fold(0, |all, train| all | train.under);
    let seen = bit(ground.seen) - 1;
    (0..ground.lines.len()).filter(|line| ground.lines[*line].mask & seen & under != 0).collect()
}
