"use strict";
// The player: what is shown, and what keys, clicks and time do.
const Player = (() => {
  const at = (id) => document.getElementById(id);
  const reel = Logic.open(JSON.parse(at("film").textContent));
  const { film } = reel;
  const EVENTS = 120;
  let frame = 0;
  let place = 0;
  let playing = false;
  let before = 0;
  let asked = false;
  let plans = [];

  const speed = () => Number(at("speed").value);
  const count = () => Number(at("window").value || 0);

  const cell = (kind, one) => {
    const td = document.createElement("td");
    td.textContent = one.text;
    if (one.changed) td.classList.add("changed");
    if (one.isNumber) td.classList.add("number");
    if (/^(refused|failed|emergency|collision|derailment|differs)/.test(one.text)) td.classList.add("bad");
    if (/^(proceed|accepted)/.test(one.text)) td.classList.add("good");
    return td;
  };

  // Speeds are also drawn: the bar is the speed, the mark what is permitted.
  const gauge = (name, now) => {
    const [is, may, most] = [Logic.number(reel, "train", name, "speed", now), Logic.number(reel, "train", name, "permitted", now), 120];
    if (Number.isNaN(is)) return null;
    const td = document.createElement("td");
    const bar = Object.assign(document.createElement("span"), { className: "bar", title: "speed; the mark: permitted" });
    const fill = document.createElement("b");
    fill.style.width = `${Math.min(100, (is / most) * 100)}%`;
    bar.append(fill);
    const limit = document.createElement("i");
    limit.style.left = `${Math.min(99, ((may || 0) / most) * 100)}%`;
    bar.append(limit);
    td.append(bar);
    return td;
  };

  const tables = (now) => {
    const parts = film.tables.map((table) => {
      const part = document.createElement("div");
      part.className = table.columns.length > 4 ? "values wide" : "values";
      const title = document.createElement("h2");
      title.textContent = table.title;
      part.append(title);
      const list = Logic.rows(reel, table, now);
      if (list.length === 0) {
        part.append(Object.assign(document.createElement("p"), { className: "none", textContent: "none" }));
        return part;
      }
      const grid = document.createElement("table");
      const drawn = reel.curves.has(Logic.key(table.kind, list[0].name, "speed"));
      const head = grid.createTHead().insertRow();
      for (const text of ["", ...table.columns.map(([, above]) => above), ...(drawn ? ["km/h, 0 to 120"] : [])])
        head.append(Object.assign(document.createElement("th"), { textContent: text }));
      const rest = grid.createTBody();
      for (const { name, cells } of list) {
        const row = rest.insertRow();
        const label = document.createElement("th");
        label.textContent = name;
        if (table.kind === "train" && reel.film.distance) label.style.color = Rows.colour(film.trains.indexOf(name));
        row.append(label, ...cells.map((one) => cell(table.kind, one)));
        const bar = drawn && gauge(name, now);
        if (bar) row.append(bar);
      }
      part.append(grid);
      return part;
    });
    at("tables").replaceChildren(...parts);
  };

  const textOf = (event) => (typeof event.text === "string" ? event.text : film.words[event.text]);

  const events = (now) => {
    const list = reel.live ? reel.live.events : film.events;
    const { from, shown } = Logic.around(list, now, EVENTS);
    const item = (text, name) => Object.assign(document.createElement("li"), { textContent: text, className: name });
    const made = shown.map((event) => {
      const li = item("", `${event.class} ${event.at === now ? "here" : event.at < now ? "past" : ""}`);
      li.append(Object.assign(document.createElement("time"), { textContent: Logic.timeText(reel, event.at) }));
      li.append(textOf(event));
      li.dataset.frame = event.at;
      return li;
    });
    if (from > 0) made.unshift(item(`… ${from} before`, "more"));
    const after = list.length - from - shown.length;
    if (after > 0) made.push(item(`… ${after} after`, "more"));
    if (list.length === 0) made.push(item("none", "more"));
    const home = at("events");
    home.replaceChildren(...made);
    const here = home.querySelector(".here") || [...home.querySelectorAll(".past")].pop();
    if (here) home.scrollTop = here.offsetTop - home.offsetTop - home.clientHeight / 3;
  };

  const draw = () => {
    asked = false;
    const slider = at("slider");
    slider.max = Logic.last(reel);
    slider.value = frame;
    slider.setAttribute("aria-valuetext", `step ${frame}, ${Logic.timeText(reel, frame)}`);
    at("now").textContent = `step ${frame} of ${Logic.last(reel)} · ${Logic.timeText(reel, frame)}${reel.live ? " · live" : ""}`;
    const harm = (reel.live ? reel.live.events : film.events).filter((event) => event.at === frame && event.class === "harm");
    at("alarm").textContent = harm.map(textOf).join("; ");
    at("play").textContent = playing ? "⏸ pause" : "▶ play";
    at("play").setAttribute("aria-pressed", playing);
    for (const plan of plans) Stage.show(plan, reel, frame);
    tables(frame);
    events(frame);
    Rows.ticks(at("ticks"), reel, frame);
    if (film.distance && !reel.live) Rows.distance(at("distance"), reel, frame);
    if (film.lanes.length && !reel.live) Rows.lanes(at("lanes"), reel, frame, count());
  };
  const ask = () => {
    if (!asked) requestAnimationFrame(draw);
    asked = true;
  };

  const go = (to) => {
    frame = Logic.clamp(reel, to);
    place = frame;
    ask();
  };
  const stop = () => {
    playing = false;
    ask();
  };
  const tick = (now) => {
    if (!playing) return;
    const next = Logic.advance(reel, place, before ? now - before : 0, speed());
    before = now;
    place = next.place;
    if (Math.floor(place) !== frame) {
      frame = Math.floor(place);
      ask();
    }
    if (next.ended) stop();
    else requestAnimationFrame(tick);
  };
  const play = () => {
    if (playing) return stop();
    if (frame >= Logic.last(reel)) go(0);
    playing = true;
    before = 0;
    requestAnimationFrame(tick);
    ask();
  };
  const jump = (to) => {
    stop();
    go(to);
  };

  const act = {
    play,
    first: () => jump(0),
    last: () => jump(Logic.last(reel)),
    back: () => jump(frame - 1),
    on: () => jump(frame + 1),
    "event-back": () => jump(Logic.eventBefore(reel, frame)),
    "event-on": () => jump(Logic.nextEvent(reel, frame)),
  };

  const legend = (home, list) => {
    for (const [style, text] of list) {
      const swatch = document.createElement("i");
      swatch.style.background = style;
      home.append(swatch, text);
    }
  };

  const begin = () => {
    at("title").textContent = film.title;
    for (const note of film.notes) at("notes").append(Object.assign(document.createElement("li"), { textContent: note }));
    if (film.notes.length === 0) at("notes").remove();
    for (const name of Object.keys(act)) at(name).addEventListener("click", act[name]);
    at("slider").addEventListener("input", () => jump(Number(at("slider").value)));
    document.addEventListener("keydown", (event) => {
      if (event.ctrlKey || event.altKey || event.metaKey || /^(SELECT|TEXTAREA)$/.test(event.target.tagName)) return;
      const name = Logic.ofKey(event.key);
      // A button that has the focus is pressed by the space bar itself.
      if (!name || (event.key === " " && event.target.tagName === "BUTTON")) return;
      event.preventDefault();
      act[name]();
    });
    at("events").addEventListener("click", (event) => {
      const item = event.target.closest("[data-frame]");
      if (item) jump(Number(item.dataset.frame));
    });
    for (const id of ["ticks", "lanes", "distance"]) {
      const canvas = at(id);
      const seek = (event) => jump(Rows.frameAt(canvas, event) - (id === "lanes" ? 0.5 : 0));
      canvas.addEventListener("pointerdown", (event) => {
        canvas.setPointerCapture(event.pointerId);
        seek(event);
      });
      canvas.addEventListener("pointermove", (event) => event.buttons && seek(event));
    }
    if (film.plans.length) {
      plans = film.plans.map((plan) => Stage.raise(plan, at("plans")));
      at("plans").style.setProperty("--plan-width", `${Math.max(...plans.map((plan) => Math.min(plan.natural * 0.8, 2200)))}px`);
      at("plans").classList.toggle("several", plans.length > 1);
      at("key").append("On the plan:");
      legend(at("key"), [
        ["var(--occupied)", "reported occupied"], ["repeating-linear-gradient(90deg,var(--waiting) 0 5px,#fff 5px 8px)", "still counted as occupied"],
        ["#f0e442", "route provisional"], ["#8cbdda", "set"], ["#9ad3f0", "in use"], ["#f3cf80", "releasing"], ["#cc8f8a", "failed"],
      ]);
      at("key").append(" ✕ blocked; a pale leg of a point does not lie; black with an arrow: a train. Beside a circuit: what its train is told.");
    } else for (const id of ["plans", "key"]) at(id).remove();
    if (film.lanes.length) {
      at("lanes-part").hidden = false;
      const choices = [50, 100, 300, 1000, 3000].filter((choice) => choice <= film.frames);
      for (const choice of [...choices, 0])
        at("window").append(Object.assign(document.createElement("option"), { value: choice, textContent: choice || "all" }));
      at("window").value = film.frames <= 400 ? 0 : 300;
      at("window").addEventListener("change", ask);
      legend(at("legend"), film.legend.map(({ tone, text }) => [Rows.paint(tone)[0], text]));
      at("legend").append(" The line stands at the end of the step: what was read is left of it, what was answered right of it.");
    }
    if (film.distance) at("distance-part").hidden = false;
    addEventListener("resize", ask);
    addEventListener("beforeprint", draw);
    const wanted = /^#(\d+)$/.exec(location.hash);
    go(wanted ? Number(wanted[1]) : 0);
    Inside.offer(reel, Player);
  };

  addEventListener("DOMContentLoaded", begin);
  return { go: jump, refresh: ask, act, reel, frame: () => frame, isPlaying: () => playing };
})();
