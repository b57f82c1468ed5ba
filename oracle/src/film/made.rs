//! Lays out a film: what all machines have in common, then what one adds.

use atc_film::{Clock, Film};

use super::take::Take;
use super::{lanes, plain, words};
use crate::chart::scene::Scene;
use crate::drawn::machine::Drawn;

/// Lays out a film: what all machines have in common, then what `M` adds.
///
/// # Errors
/// A sentence: why the layout does not fit.
pub(crate) fn made<M: Drawn>(take: &Take<'_, M>) -> Result<Film, String> {
    let scene: Scene = M::chart(take.config, take.cycles);
    let frames = u32::try_from(take.cycles.len()).map_err(|_| "the case has 2^32 steps or more".to_owned())?;
    let clock = Clock { unit: scene.unit.name.to_owned(), per_frame: scene.unit.per_cycle.max(1), last: None };
    let title = take.setting.title.clone().unwrap_or_else(|| scene.machine.to_owned());
    let mut film = Film::new(&title, clock, frames);
    film.notes.clone_from(&scene.notes);
    lanes::put(&mut film, &scene);
    let shown = M::film(take, &mut film)?;
    if !shown {
        if take.setting.kernel.is_some() {
            return Err(format!(
                "the kernel can be put into films of an interlocking; this session is of {}",
                scene.machine
            ));
        }
        plain::values(&mut film, take);
    }
    words::put(&mut film, &take.setting.words);
    plain::differences(&mut film, take);
    film.sort_events();
    Ok(film)
}
