"use strict";
// What is drawn on canvases: the rows over time, trains over time and distance, the ticks of events below the slider.
const Rows = (() => {
  // Fill, edge and ink of each tone, as the charts have them.
  const PAINT = {
    signal: ["#e4e8ee", "#111", "#111"], operate: ["#a9cdec", "#1f5f99", "#111"], detected: ["#a9cdec", "#1f5f99", "#111"],
    shortened: ["#ffc48a", "#b35900", "#111"], service: ["#ffc48a", "#b35900", "#111"], recovery: ["#b5dfae", "#2f7d32", "#111"],
    held: ["#b5dfae", "#2f7d32", "#111"], mask: ["#fff0a8", "#9a7d00", "#111"], pending: ["#fff0a8", "#9a7d00", "#111"],
    dropped: ["#cfcfcf", "#555", "#111"], all: ["#f7c8c2", "#a01b10", "#111"], emergency: ["#f2a39b", "#a01b10", "#111"],
    limit: ["#fff", "#a01b10", "#111"], code: ["#fff", "#1f5f99", "#111"], blank: ["#fff", "#777", "#444"],
    difference: ["#d7191c", "#7a0000", "#fff"],
  };
  const paint = (tone) => PAINT[tone] || PAINT.blank;
  const TRAINS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#7a5c00", "#56b4e9", "#a01b10", "#4b2d8f"];
  const colour = (train) => TRAINS[train % TRAINS.length];

  // A canvas of this height at the screen's own resolution; `size` is the size of a letter in pixels.
  const sheet = (canvas, high) => {
    const size = parseFloat(getComputedStyle(document.documentElement).fontSize);
    const wide = canvas.clientWidth;
    const tall = high(size);
    const dense = window.devicePixelRatio || 1;
    canvas.style.height = `${tall}px`;
    if (canvas.width !== Math.round(wide * dense)) canvas.width = Math.round(wide * dense);
    if (canvas.height !== Math.round(tall * dense)) canvas.height = Math.round(tall * dense);
    const ink = canvas.getContext("2d");
    ink.setTransform(dense, 0, 0, dense, 0, 0);
    ink.clearRect(0, 0, wide, tall);
    ink.font = `${Math.max(12, size * 0.86)}px system-ui, sans-serif`;
    ink.textBaseline = "middle";
    return { ink, wide, tall, size };
  };

  // Round distances of an axis, some `most` of them in `range`.
  const round = (range, most) => {
    const least = range / most;
    const ten = 10 ** Math.floor(Math.log10(Math.max(least, 1e-9)));
    return [1, 2, 5, 10].map((step) => step * ten).find((step) => step >= least);
  };

  const fitted = (ink, text, room) => {
    if (ink.measureText(text).width <= room) return text;
    let short = text;
    while (short.length > 1 && ink.measureText(`${short}…`).width > room) short = short.slice(0, -1);
    return short.length > 1 ? `${short}…` : "";
  };

  // The frames that are shown: `count` of them around the frame, or all.
  const shown = (reel, frame, count) => {
    const all = reel.frames + 1;
    if (count === 0 || count >= all) return [0, all];
    const from = Math.max(0, Math.min(frame - (count >> 1), all - count));
    return [from, from + count];
  };

  const mark = (draw, lane, one) => {
    const { ink, x, from, to, top, tall } = draw;
    const bottom = top + tall;
    const seen = (begin, end) => end > from && begin < to;
    const [kind, body] = Object.entries(one)[0];
    if (kind === "bars") {
      for (const [begin, end, tone, text] of body) {
        if (!seen(begin, end)) continue;
        const [fill, edge, letters] = paint(tone);
        const [left, right] = [x(begin), x(end)];
        ink.fillStyle = fill;
        ink.strokeStyle = edge;
        ink.fillRect(left, top + 2, Math.max(1, right - left), tall - 4);
        ink.strokeRect(left + 0.5, top + 2.5, Math.max(1, right - left - 1), tall - 5);
        ink.fillStyle = letters;
        const words = fitted(ink, text, right - left - 6);
        if (words) ink.fillText(words, left + 4, top + tall / 2);
      }
    } else if (kind === "wave") {
      ink.strokeStyle = "#111";
      ink.beginPath();
      ink.moveTo(x(from), bottom - 3);
      for (const [begin, end] of body) {
        if (!seen(begin, end)) continue;
        ink.lineTo(x(begin), bottom - 3);
        ink.lineTo(x(begin), top + 4);
        ink.lineTo(x(end), top + 4);
        ink.lineTo(x(end), bottom - 3);
      }
      ink.lineTo(x(to), bottom - 3);
      ink.stroke();
    } else if (kind === "letters") {
      const [begin, text] = body;
      ink.fillStyle = "#111";
      for (let at = Math.max(begin, from); at < Math.min(to, begin + text.length); at += 1)
        ink.fillText(text[at - begin], x(at) + 1, top + tall / 2);
    } else if (kind === "signs") {
      ink.fillStyle = "#111";
      for (const [at, sign] of body) if (at >= from && at <= to) ink.fillText(sign, x(at) - 5, top + tall / 2);
    } else if (lane.scale) {
      const y = (value) => bottom - 3 - ((value - lane.scale[0]) / (lane.scale[1] - lane.scale[0])) * (tall - 7);
      const steps = kind === "band" ? body[1] : body.points;
      const [, edge] = paint(kind === "band" ? body[0] : body.tone);
      ink.strokeStyle = edge;
      ink.setLineDash(kind === "line" && body.tone === "limit" ? [7, 3] : []);
      ink.beginPath();
      steps.forEach(([at, value], place) => {
        const end = place + 1 < steps.length ? steps[place + 1][0] : to;
        if (value === null || !seen(at, end)) return;
        if (kind === "band") {
          ink.fillStyle = paint(body[0])[0];
          ink.fillRect(x(at), y(value[1]), Math.max(1, x(end) - x(at)), Math.max(1, y(value[0]) - y(value[1])));
        } else {
          ink.moveTo(x(Math.max(at, from)), y(value));
          ink.lineTo(x(Math.min(end, to)), y(value));
          const next = steps[place + 1];
          if (next && next[1] !== null) ink.lineTo(x(Math.min(end, to)), y(next[1]));
        }
      });
      ink.stroke();
      ink.setLineDash([]);
    }
  };

  // The frame at each place of a canvas, for clicks.
  const places = new WeakMap();

  const lanes = (canvas, reel, frame, count) => {
    const list = reel.film.lanes;
    const scale = (size) => size / 14;
    const { ink, wide, tall, size } = sheet(canvas, (size) => list.reduce((sum, lane) => sum + lane.height, 30) * scale(size));
    const labels = Math.min(wide * 0.22, Math.max(90, ...list.map((lane) => ink.measureText(lane.label).width + 10)));
    const [from, to] = shown(reel, frame, count);
    const x = (at) => labels + ((Math.max(from, Math.min(to, at)) - from) / (to - from)) * (wide - labels - 8);
    places.set(canvas, (px) => from + ((px - labels) / (wide - labels - 8)) * (to - from));
    let top = 0;
    for (const lane of list) {
      const high = lane.height * scale(size);
      ink.lineWidth = 1;
      ink.strokeStyle = lane.first ? "#999" : "#eee";
      ink.beginPath();
      ink.moveTo(0, top + 0.5);
      ink.lineTo(wide, top + 0.5);
      ink.stroke();
      ink.fillStyle = "#111";
      ink.fillText(fitted(ink, lane.label, labels - 6), 0, top + high / 2);
      for (const one of lane.marks) mark({ ink, x, from, to, top, tall: high }, lane, one);
      if (lane.scale) {
        ink.fillStyle = "#555";
        ink.textAlign = "right";
        ink.fillText(String(Number(lane.scale[1].toPrecision(4))), labels - 2, top + size * 0.55);
        if (high > 3 * size) ink.fillText(String(Number(lane.scale[0].toPrecision(4))), labels - 2, top + high - size * 0.55);
        ink.textAlign = "left";
      }
      top += high;
    }
    // The axis: steps of the clock.
    const clock = reel.film.clock;
    const step = round((to - from) * clock.per_frame, Math.max(3, (wide - labels) / (9 * size)));
    ink.fillStyle = "#555";
    ink.strokeStyle = "#555";
    for (let at = Math.ceil((from * clock.per_frame) / step) * step; at <= to * clock.per_frame; at += step) {
      const px = x(at / clock.per_frame);
      ink.fillRect(px, top, 1, 5);
      const text = clock.unit === "ms" && step >= 1000 ? `${at / 1000} s` : `${at} ${clock.unit}`;
      if (px + ink.measureText(text).width < wide) ink.fillText(text, px + 3, top + size * 0.9);
    }
    // The step that is shown: what was read in it is left of the line, what was answered right of it.
    ink.fillStyle = "rgba(230,159,0,.28)";
    ink.fillRect(x(frame), 0, Math.max(2, x(frame + 1) - x(frame)), top);
    ink.fillStyle = "#111";
    ink.fillRect(x(frame + 1) - 1, 0, 2, tall - 12);
  };

  const distance = (canvas, reel, frame) => {
    const line = reel.film.distance;
    const { ink, wide, tall, size } = sheet(canvas, (size) => 26 * size);
    const left = Math.max(60, ...line.places.map((place) => ink.measureText(place.name).width + 12));
    const [top, low] = [size * 1.6, tall - 2.4 * size];
    const x = (at) => left + (at / Math.max(1, reel.frames - 1)) * (wide - left - 10);
    const y = (metres) => low - (metres / Math.max(1, line.length_m)) * (low - top);
    places.set(canvas, (px) => ((px - left) / (wide - left - 10)) * (reel.frames - 1));
    const words = reel.film.words;
    ink.fillStyle = "rgba(213,94,0,.16)";
    for (const { circuit, from_m, to_m } of line.circuits) {
      const channel = reel.channels.get(Logic.key("circuit", circuit, "reported"));
      if (!channel) continue;
      channel.at.forEach((at, place) => {
        if (words[channel.is[place]] === "") return;
        const end = place + 1 < channel.at.length ? channel.at[place + 1] : reel.frames - 1;
        ink.fillRect(x(at), y(to_m), Math.max(1, x(end) - x(at)), y(from_m) - y(to_m));
      });
    }
    ink.fillStyle = "#555";
    ink.strokeStyle = "#999";
    ink.lineWidth = 1;
    for (const place of line.places) {
      ink.fillText(place.name, 0, y(place.at_m));
      ink.beginPath();
      ink.moveTo(left, y(place.at_m));
      ink.lineTo(wide - 10, y(place.at_m));
      ink.stroke();
    }
    const step = round(line.length_m, 8);
    for (let at = 0; at <= line.length_m; at += step) {
      ink.fillRect(left - 5, y(at), 5, 1);
      const text = `${at} m`;
      const free = line.places.every((place) => Math.abs(y(place.at_m) - y(at)) > size);
      if (free) ink.fillText(text, left - 8 - ink.measureText(text).width, y(at));
    }
    const clock = reel.film.clock;
    const seconds = round(((reel.frames - 1) * clock.per_frame) / 1000, Math.max(3, (wide - left) / (7 * size)));
    for (let at = 0; at * 1000 <= (reel.frames - 1) * clock.per_frame; at += seconds) {
      const px = x((at * 1000) / clock.per_frame);
      ink.fillRect(px, low, 1, 5);
      if (px + 50 < wide) ink.fillText(`${at} s`, px + 3, low + size);
    }
    reel.film.trains.forEach((train, place) => {
      const front = reel.curves.get(Logic.key("train", train, "front_m"));
      const tail = reel.curves.get(Logic.key("train", train, "tail_m"));
      if (!front || !tail) return;
      ink.strokeStyle = colour(place);
      ink.lineWidth = 2;
      ink.beginPath();
      front.numbers.forEach((metres, at) => {
        const py = y(metres / front.per);
        if (at === 0) ink.moveTo(x(at), py);
        else ink.lineTo(x(at), py);
      });
      ink.stroke();
      const [one, other] = [front.numbers[frame] / front.per, tail.numbers[frame] / tail.per];
      ink.lineWidth = 7;
      ink.beginPath();
      ink.moveTo(x(frame), y(one));
      ink.lineTo(x(frame), y(other));
      ink.stroke();
      ink.fillStyle = colour(place);
      ink.fillText(train, x(frame) + 7, y((one + other) / 2));
    });
    for (const event of reel.film.events.filter((event) => event.class === "harm")) {
      ink.fillStyle = "#a01b10";
      ink.fillText("✖", x(event.at) - 6, top - size * 0.6);
    }
    ink.fillStyle = "#111";
    ink.fillRect(x(frame) - 1, top - 4, 2, low - top + 8);
  };

  // A tick for each event, harm in red and higher.
  const ticks = (canvas, reel, frame) => {
    const { ink, wide, tall } = sheet(canvas, (size) => size * 0.7);
    const x = (at) => 8 + (at / Math.max(1, Logic.last(reel))) * (wide - 16);
    places.set(canvas, (px) => ((px - 8) / (wide - 16)) * Logic.last(reel));
    ink.fillStyle = "#0072b2";
    for (const at of reel.live ? reel.live.stops : reel.stops) ink.fillRect(x(at), tall * 0.35, 1, tall * 0.65);
    ink.fillStyle = "#a01b10";
    for (const event of reel.film.events) if (event.class === "harm") ink.fillRect(x(event.at) - 1, 0, 3, tall);
    ink.fillStyle = "#111";
    ink.fillRect(x(frame) - 1, 0, 2, tall);
  };

  const frameAt = (canvas, event) => {
    const place = places.get(canvas);
    return place ? place(event.clientX - canvas.getBoundingClientRect().left) : 0;
  };

  return { lanes, distance, ticks, frameAt, paint, colour };
})();
