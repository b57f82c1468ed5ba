"use strict";
// What the page knows and decides, without a document: tested by itself.
const Logic = (() => {
  // Distances from one to the next, as places.
  const summed = (steps) => {
    let at = 0;
    return steps.map((step) => (at += step));
  };

  const key = (kind, name, what) => `${kind}\n${name}\n${what}`;

  // A film as it is played: changes with their frames, everything found by its name.
  const open = (film) => {
    const channels = new Map();
    for (const one of film.channels) channels.set(key(one.kind, one.name, one.what), { at: summed(one.at), is: one.is });
    const curves = new Map();
    for (const one of film.curves) {
      let last = 0;
      const numbers = Float64Array.from(one.by, (by) => (by === null ? NaN : (last += by)));
      curves.set(key(one.kind, one.name, one.what), { numbers, unit: one.unit, per: one.per });
    }
    const names = new Map();
    for (const one of [...film.channels, ...film.curves]) {
      if (!names.has(one.kind)) names.set(one.kind, new Set());
      names.get(one.kind).add(one.name);
    }
    const stops = [...new Set(film.events.filter((event) => event.class !== "input").map((event) => event.at))];
    return { film, frames: film.frames, channels, curves, names, stops: stops.sort((a, b) => a - b), live: null };
  };

  // How many of the sorted numbers are at most `most`.
  const upTo = (sorted, most) => {
    let low = 0;
    let high = sorted.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (sorted[middle] <= most) low = middle + 1;
      else high = middle;
    }
    return low;
  };

  // The word of a thing in a frame; empty if nothing is said of it.
  const word = (reel, kind, name, what, frame) => {
    const live = reel.live;
    if (live && frame >= live.from) {
      const said = live.frames[frame - live.from];
      return (said && said.get(key(kind, name, what))) || "";
    }
    const channel = reel.channels.get(key(kind, name, what));
    if (!channel) return "";
    const place = upTo(channel.at, frame) - 1;
    return place < 0 ? "" : reel.film.words[channel.is[place]];
  };

  // The number of a thing in a frame, in its unit; NaN if there is none.
  const number = (reel, kind, name, what, frame) => {
    const curve = reel.curves.get(key(kind, name, what));
    return curve && frame < curve.numbers.length ? curve.numbers[frame] / curve.per : NaN;
  };

  // What a cell of a table says.
  const told = (reel, kind, name, what, frame) => {
    const curve = reel.curves.get(key(kind, name, what));
    if (!curve) return word(reel, kind, name, what, frame);
    const value = number(reel, kind, name, what, frame);
    if (Number.isNaN(value)) return "";
    const digits = curve.per >= 10 ? Math.ceil(Math.log10(curve.per)) : 0;
    return `${value.toFixed(digits)} ${curve.unit}`.trim();
  };

  // A row of a table: a name and its cells, each with whether it has changed in this frame.
  const rows = (reel, table, frame) => {
    const list = [];
    for (const name of reel.names.get(table.kind) || []) {
      const cells = table.columns.map(([what]) => {
        const text = told(reel, table.kind, name, what, frame);
        const before = frame > 0 ? told(reel, table.kind, name, what, frame - 1) : text;
        return { what, text, changed: text !== before, isNumber: reel.curves.has(key(table.kind, name, what)) };
      });
      if (!table.sparse || cells.some((cell) => cell.text !== "" || cell.changed)) list.push({ name, cells });
    }
    return list;
  };

  const last = (reel) => (reel.live ? reel.live.from + reel.live.frames.length - 1 : reel.frames - 1);
  const clamp = (reel, frame) => Math.max(0, Math.min(last(reel), Math.round(frame)));

  // The frame of the next event, or of the one before; where there is none, the last frame or the first.
  const nextEvent = (reel, frame) => {
    const stops = reel.live ? reel.live.stops : reel.stops;
    const place = upTo(stops, frame);
    return place < stops.length ? stops[place] : last(reel);
  };
  const eventBefore = (reel, frame) => {
    const stops = reel.live ? reel.live.stops : reel.stops;
    const place = upTo(stops, frame - 1);
    return place > 0 ? stops[place - 1] : 0;
  };

  // When a frame is, in the unit of the clock.
  const time = (reel, frame) => {
    const clock = reel.film.clock;
    const end = clock.last !== null && frame === reel.frames - 1 && !reel.live;
    return end ? clock.last : frame * clock.per_frame;
  };
  const timeText = (reel, frame) => {
    const unit = reel.film.clock.unit;
    const at = time(reel, frame);
    if (unit !== "ms") return `${at} ${unit}`;
    if (at < 10000 && at % 100 !== 0) return `${at} ms`;
    const seconds = at / 1000;
    const exact = Number.isInteger(seconds) ? 0 : at % 100 === 0 ? 1 : 3;
    if (seconds < 120) return `${seconds.toFixed(exact)} s`;
    const minutes = Math.floor(seconds / 60);
    return `${minutes} min ${(seconds - 60 * minutes).toFixed(exact).padStart(exact ? 3 + exact : 2, "0")} s`;
  };

  // Where playing has come to: `place` is a frame with a fraction. It ends at the last frame.
  const advance = (reel, place, milliseconds, speed) => {
    const next = place + (milliseconds / 1000) * speed;
    return next >= last(reel) ? { place: last(reel), ended: true } : { place: next, ended: false };
  };

  // What a key does.
  const ofKey = (name) =>
    ({
      " ": "play", ArrowLeft: "back", ArrowRight: "on", Home: "first", End: "last", ArrowUp: "event-back",
      ArrowDown: "event-on",
    })[name] || null;

  // The events around a frame: at most so many, and where the ones of the frame begin.
  const around = (events, frame, most) => {
    let low = 0;
    while (low < events.length && events[low].at < frame) low += 1;
    const from = Math.max(0, Math.min(low - (most >> 1), events.length - most));
    return { from, shown: events.slice(from, from + most) };
  };

  const length = (a, b) => Math.hypot(b[0] - a[0], b[1] - a[1]);

  // The part of a line of corners between two shares of its length, 0 to 1.
  const part = (corners, from, to) => {
    const total = corners.slice(1).reduce((sum, corner, place) => sum + length(corners[place], corner), 0);
    const [begin, end] = [Math.max(0, from) * total, Math.min(1, to) * total];
    const found = [];
    let at = 0;
    for (let place = 1; place < corners.length; place += 1) {
      const [a, b] = [corners[place - 1], corners[place]];
      const long = length(a, b);
      const point = (where) => {
        const share = long === 0 ? 0 : Math.max(0, Math.min(1, (where - at) / long));
        return [a[0] + (b[0] - a[0]) * share, a[1] + (b[1] - a[1]) * share];
      };
      if (end >= at && begin <= at + long) {
        if (found.length === 0) found.push(point(begin));
        found.push(point(end));
      }
      at += long;
    }
    return found;
  };

  // The pieces under a train, from the tail to the front: "12+ 13r-" are piece 12, and the reverse leg of 13 backwards.
  const pieces = (text) =>
    text.split(" ").filter(Boolean).map((one) => {
      const [, piece, leg, way] = /^(\d+)(r?)([+-])$/.exec(one) || [null, "0", "", "+"];
      return { piece: Number(piece), reverse: leg === "r", forward: way === "+" };
    });

  // The same with the shares of each piece, from its first joint, that the train covers. `front` and `tail` are shares
  // along its travel.
  const covered = (text, front, tail) => {
    const list = pieces(text);
    return list.map((one, place) => {
      const from = place === 0 ? tail : 0;
      const to = place === list.length - 1 ? front : 1;
      return { ...one, from: one.forward ? from : 1 - to, to: one.forward ? to : 1 - from };
    });
  };

  // What a circuit of the plan is: whether occupied, who holds it, whether it is blocked.
  const circuit = (reel, name, frame) => {
    const of = (what) => word(reel, "circuit", name, what, frame);
    const [reported, counted] = [of("reported") !== "", of("counted") !== ""];
    const track = reported ? "occupied" : counted ? "waiting" : "free";
    return { track, held: of("phase"), by: of("held"), blocked: of("block"), told: of("told") };
  };

  return { open, key, upTo, word, number, told, rows, last, clamp, nextEvent, eventBefore, time, timeText, advance, ofKey, around, part,
    pieces, covered, circuit };
})();
if (typeof module !== "undefined") module.exports = Logic;
