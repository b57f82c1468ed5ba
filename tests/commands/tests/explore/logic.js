"use strict";
const assert = require("assert");
const fs = require("fs");
const path = require("path");
const Logic = require(path.resolve(process.argv[2]));
const read = (name) => JSON.parse(fs.readFileSync(name, "utf8"));

for (const name of ["film", "random"]) {
  const film = read(`${name}.json`);
  const reel = Logic.open(film);
  read(`${name}.said.json`).forEach((words, frame) =>
    film.channels.forEach((one, place) => assert.strictEqual(Logic.word(reel, one.kind, one.name, one.what, frame), words[place])),
  );
  // Events forward and back: each one is met, in both directions.
  const stops = [...new Set(film.events.filter((event) => event.class !== "input").map((event) => event.at))];
  let frame = 0;
  const met = [];
  for (;;) {
    const next = Logic.nextEvent(reel, frame);
    if (next === frame || !stops.includes(next)) break;
    met.push((frame = next));
  }
  assert.deepStrictEqual(met, stops.filter((stop) => stop > 0));
  frame = Logic.last(reel);
  const back = [];
  while (frame > 0) {
    frame = Logic.eventBefore(reel, frame);
    if (frame > 0) back.unshift(frame);
  }
  assert.deepStrictEqual(back, stops.filter((stop) => stop > 0 && stop < Logic.last(reel)));
  // Playing ends at the end, at any speed.
  assert.deepStrictEqual(Logic.advance(reel, 0, 1000, 5), { place: 5, ended: false });
  assert.deepStrictEqual(Logic.advance(reel, Logic.last(reel) - 1, 1000, 5), { place: Logic.last(reel), ended: true });
  assert.deepStrictEqual([-5, 1.4, 1e9].map((at) => Logic.clamp(reel, at)), [0, 1, Logic.last(reel)]);
  for (const table of film.tables) for (let at = 0; at < reel.frames; at += 17) Logic.rows(reel, table, at);
}

const reel = Logic.open({ ...read("film.json"), frames: 10, clock: { unit: "ms", per_frame: 500, last: 4321 } });
assert.deepStrictEqual([0, 1, 3, 9].map((at) => Logic.timeText(reel, at)), ["0 s", "0.5 s", "1.5 s", "4321 ms"]);
reel.film.clock = { unit: "ms", per_frame: 1000, last: null };
assert.deepStrictEqual([59, 119, 120, 605].map((at) => Logic.timeText(reel, at)), ["59 s", "119 s", "2 min 00 s", "10 min 05 s"]);
assert.deepStrictEqual(["ArrowRight", " ", "Home", "x"].map(Logic.ofKey), ["on", "play", "first", null]);

// Parts of lines, and trains on pieces.
const line = [[0, 0], [10, 0], [10, 10]];
assert.deepStrictEqual(Logic.part(line, 0, 1), [[0, 0], [10, 0], [10, 10]]);
assert.deepStrictEqual(Logic.part(line, 0.25, 0.75), [[5, 0], [10, 0], [10, 5]]);
assert.deepStrictEqual(Logic.part(line, 0.5, 0.5)[0], [10, 0]);
assert.deepStrictEqual(Logic.covered("3+ 4r- 5+", 0.25, 0.5), [
  { piece: 3, reverse: false, forward: true, from: 0.5, to: 1 },
  { piece: 4, reverse: true, forward: false, from: 0, to: 1 },
  { piece: 5, reverse: false, forward: true, from: 0, to: 0.25 },
]);
assert.deepStrictEqual(Logic.covered("7-", 0.75, 0.25), [{ piece: 7, reverse: false, forward: false, from: 0.25, to: 0.75 }]);
assert.deepStrictEqual(Logic.pieces(""), []);

// Numbers: as they are stored, with gaps.
const numbers = Logic.open({
  frames: 4, words: [""], channels: [], events: [], clock: { unit: "ms", per_frame: 1, last: null },
  curves: [{ kind: "train", name: "0", what: "speed", unit: "km/h", per: 10, by: [100, null, -25, 5] }],
});
assert.deepStrictEqual([0, 1, 2, 3].map((at) => Logic.told(numbers, "train", "0", "speed", at)), ["10.0 km/h", "", "7.5 km/h", "8.0 km/h"]);
assert.ok(Number.isNaN(Logic.number(numbers, "train", "0", "speed", 99)));

// The list of events: what is shown is around the frame.
const events = Array.from({ length: 1000 }, (_, at) => ({ at }));
const around = Logic.around(events, 500, 100);
assert.deepStrictEqual([around.from, around.shown.length, around.shown[0].at], [450, 100, 450]);
assert.deepStrictEqual([Logic.around(events, 0, 100).from, Logic.around(events, 5000, 100).from], [0, 900]);
assert.deepStrictEqual(Logic.around([{ at: 3 }], 9, 100), { from: 0, shown: [{ at: 3 }] });
console.log("all is right");
