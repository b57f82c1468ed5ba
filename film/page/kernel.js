"use strict";
// The kernel in the page, where it was put in: a reader goes on from a step with other inputs, and the kernel itself
// answers.
const Inside = (() => {
  const bytes = (text) => Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  const words = (text) => new BigUint64Array(bytes(text).buffer);
  const bit = (word, number) => ((word >> BigInt(number)) & 1n) === 1n;
  const with_ = (word, number, on) => (on ? word | (1n << BigInt(number)) : word & ~(1n << BigInt(number)));
  const HALF = 32;

  // The words of an input: see `input_words`.
  const [OCCUPIED, DETECTED, REQUEST, BLOCK, UNBLOCK, RESTRICT, LIFT, CONSENT] = [0, 1, 2, 3, 4, 5, 6, 7];

  // The module with its plan, just started.
  const begin = async (kernel) => {
    const { instance } = await WebAssembly.instantiate(bytes(kernel.module), {});
    const it = instance.exports;
    // The memory may grow in any call, and is another one then: it is looked at after the call.
    const buffer = () => {
      const [at, room] = [it.buffer(), it.room()];
      return new BigUint64Array(it.memory.buffer, at, room);
    };
    buffer().set(words(kernel.plan));
    if (it.start() !== 1) throw new Error("the kernel does not take the plan");
    const step = (input) => {
      buffer().set(input);
      const count = it.step();
      return buffer().slice(0, count);
    };
    return { step, restart: () => it.restart() };
  };

  // What a step is asked, in words.
  const asked = (kernel, request) => {
    const [kind, number, which] = [Number(request & 255n), Number((request >> 8n) & 255n), Number((request >> 16n) & 255n)];
    const { route, point, segment } = kernel.names;
    const ask = ["", `set ${route[number]}`, `withdraw ${route[number]}`, `drive ${point[number]} ${which ? "reverse" : "normal"}`];
    return kind === 4 ? `turn ${segment[number]} ${which ? "away" : "toward"}` : ask[kind];
  };

  // A frame as a film has it, from the words of an input and of what the kernel put out. `because` of a refusal is not
  // in them.
  const frame = (kernel, input, out) => {
    const said = new Map();
    const say = (kind, name, what, text) => text && said.set(Logic.key(kind, name, what), text);
    const { places, names } = kernel;
    const phase = (route) => names.phase[Number(out[places.phases + route])];
    names.circuit.forEach((name, at) => {
      say("circuit", name, "reported", bit(input[OCCUPIED], at) && "occupied");
      say("circuit", name, "counted", bit(out[places.occupied], at) && "occupied");
      say("circuit", name, "block", bit(out[places.confirmed], at) ? "confirmed" : bit(out[places.blocked], at) && "blocked");
      const path = names.route.findIndex((_, route) => bit(out[places.paths + route], at));
      const overlap = names.route.findLastIndex((_, route) => bit(out[places.overlaps + route], at));
      if (path >= 0) {
        say("circuit", name, "held", `${names.route[path]}, ${phase(path)}`);
        say("circuit", name, "phase", phase(path));
      } else if (overlap >= 0) {
        say("circuit", name, "held", `overlap of ${names.route[overlap]}`);
        say("circuit", name, "phase", "overlap");
      }
      const telegram = Number(out[places.telegrams + at]);
      const stop = names.circuit[(telegram >> 8) & 255];
      if (telegram & 1) say("circuit", name, "told", `${telegram & 2 ? "▶" : "◀"} to ${stop} at ${kernel.speeds_kmh[(telegram >> 16) & 255]}`);
    });
    const shown = new Set();
    names.route.forEach((name, at) => {
      const proceed = bit(out[places.proceed], at);
      if (phase(at) !== "idle") say("route", name, "phase", phase(at));
      if (proceed) {
        say("route", name, "signal", `proceed at ${names.signal[at]}`);
        shown.add(names.signal[at]);
      }
    });
    for (const signal of new Set(names.signal)) say("signal", signal, "shows", shown.has(signal) ? "proceed" : "stop");
    const side = (word, at) => (bit(word, at) ? "normal" : bit(word, at + HALF) ? "reverse" : "");
    names.point.forEach((name, at) => {
      const both = bit(input[DETECTED], at) && bit(input[DETECTED], at + HALF);
      say("point", name, "detected", (!both && side(input[DETECTED], at)) || "none");
      say("point", name, "driven", side(out[places.drives], at));
      const locks = names.route.flatMap((route, number) => {
        const word = out[places.locks + number];
        return [bit(word, at) && `normal for ${route}`, bit(word, at + HALF) && `reverse for ${route}`].filter(Boolean);
      });
      say("point", name, "locked", locks.join(", "));
    });
    names.segment.forEach((name, at) => {
      const of = out[places.segments];
      say("segment", name, "direction", bit(of, at + 8) ? "toward" : bit(of, at + 16) ? "away" : "none");
      say("segment", name, "permit", bit(of, at) && "yes");
      say("segment", name, "consent", bit(input[CONSENT], at) && "yes");
    });
    const answer = Number(out[places.answer]);
    say("request", "request", "asked", asked(kernel, input[REQUEST]));
    say("request", "request", "answer", answer === 0 ? "" : answer === 1 ? "accepted" : `refused: ${names.refusal[answer - 2]}`);
    return said;
  };

  // Runs the steps of the film up to one, and tells the first thing in which a frame is not what the film says.
  const replay = (kernel, machine, reel, count) => {
    let differs = null;
    machine.restart();
    const kinds = new Set(["circuit", "route", "signal", "point", "segment"]);
    const checked = reel.film.channels.filter((one) => kinds.has(one.kind));
    for (let at = 0; at < count; at += 1) {
      const input = words(kernel.inputs[kernel.steps[at]]);
      const out = machine.step(input);
      if (differs) continue;
      const said = frame(kernel, input, out);
      for (const one of checked) {
        const [film, here] = [Logic.word(reel, one.kind, one.name, one.what, at), said.get(Logic.key(one.kind, one.name, one.what)) || ""];
        if (film !== here) differs = `step ${at}: ${one.kind} ${one.name} ${one.what} is ${film || "nothing"} in the film, ${here || "nothing"} here`;
      }
    }
    return differs;
  };

  // What has happened between two frames.
  const news = (before, after) => {
    const found = [];
    for (const key of new Set([...before.keys(), ...after.keys()])) {
      const [kind, name, what] = key.split("\n");
      const [was, is] = [before.get(key) || "", after.get(key) || ""];
      if (was === is) continue;
      if (kind === "route" && what === "phase") found.push(`route ${name}: ${is || "idle"}`);
      else if (kind === "signal") found.push(`signal ${name}: ${is}`);
      else if (kind === "circuit" && what === "told") found.push(`a train in ${name} is told: ${is || "stop"}`);
      else if (kind === "request" && what === "answer" && is) found.push(`${after.get(Logic.key("request", "request", "asked"))}: ${is}`);
      else if (kind === "point" && what === "driven") found.push(is ? `${name} driven to ${is}` : `${name} is not driven any more`);
    }
    return found;
  };

  const STROKE = 3;

  const offer = async (reel, player) => {
    const { kernel } = reel.film;
    if (!kernel) return;
    const home = document.getElementById("live");
    home.hidden = false;
    let machine = null;
    try {
      machine = await begin(kernel);
    } catch (error) {
      home.textContent = `The kernel in this page does not run here: ${error.message}. The film plays without it.`;
      return;
    }
    const make = (name, properties, ...inside) => {
      const made = Object.assign(document.createElement(name), properties);
      made.append(...inside);
      return made;
    };
    const { names } = kernel;
    // The next input, and the points that are on their way: how many steps they still take, and whereto.
    let input = null;
    let strokes = new Map();

    const say = (text, wrong) => {
      const line = home.querySelector("#live-says");
      line.textContent = text;
      line.className = wrong ? "bad" : "";
    };
    const leave = () => {
      const from = reel.live ? reel.live.from : 0;
      reel.live = null;
      input = null;
      draw();
      player.go(from);
    };
    const enter = () => {
      const from = player.frame();
      const differs = replay(kernel, machine, reel, from + 1);
      input = words(kernel.inputs[kernel.steps[from]]);
      input[REQUEST] = input[BLOCK] = input[UNBLOCK] = input[LIFT] = input[RESTRICT] = 0n;
      strokes = new Map();
      // The step itself stands; what follows is the reader's.
      const first = new Map();
      for (const one of reel.film.channels) {
        const said = Logic.word(reel, one.kind, one.name, one.what, from);
        if (said) first.set(Logic.key(one.kind, one.name, one.what), said);
      }
      const begun = { at: from, class: "output", text: "from here on the kernel answers to you" };
      reel.live = { from, frames: [first], events: [begun], stops: [from] };
      draw();
      if (differs) say(`The kernel in this page does not say what the film says. ${differs}`, true);
      else say(`The kernel has run steps 0 to ${from} again and says what the film says.`);
      player.go(from);
    };

    // Points follow their drives: gone from where they stood at once, there after a few steps.
    const move = (out) => {
      const drives = out[kernel.places.drives];
      names.point.forEach((_, at) => {
        for (const [to, other] of [[at, at + HALF], [at + HALF, at]]) {
          if (bit(drives, to) && !bit(input[DETECTED], to) && !strokes.has(at)) {
            input[DETECTED] = with_(with_(input[DETECTED], to, false), other, false);
            strokes.set(at, { to, left: STROKE });
          }
        }
        const stroke = strokes.get(at);
        if (stroke && (stroke.left -= 1) < 0) {
          input[DETECTED] = with_(input[DETECTED], stroke.to, true);
          strokes.delete(at);
        }
      });
    };
    const on = (count) => {
      for (let step = 0; step < count; step += 1) {
        const out = machine.step(input);
        const said = frame(kernel, input, out);
        const live = reel.live;
        const at = live.from + live.frames.length;
        const happened = news(live.frames.at(-1), said);
        live.frames.push(said);
        for (const text of happened) live.events.push({ at, class: "output", text });
        if (happened.length) live.stops.push(at);
        input[REQUEST] = 0n;
        move(out);
      }
      draw();
      player.go(Logic.last(reel));
    };
    const toggle = (circuit) => {
      const at = names.circuit.indexOf(circuit);
      if (!input || at < 0) return;
      input[OCCUPIED] = with_(input[OCCUPIED], at, !bit(input[OCCUPIED], at));
      draw();
    };

    const requests = () => {
      const list = [["", 0n]];
      const ask = (kind, number, which) => BigInt(kind) | (BigInt(number) << 8n) | (BigInt(which) << 16n);
      names.route.forEach((name, at) => list.push([`set ${name}`, ask(1, at, 0)]));
      names.route.forEach((name, at) => list.push([`withdraw ${name}`, ask(2, at, 0)]));
      names.point.forEach((name, at) => ["normal", "reverse"].forEach((to, which) => list.push([`drive ${name} ${to}`, ask(3, at, which)])));
      names.segment.forEach((name, at) => ["toward", "away"].forEach((to, which) => list.push([`turn ${name} ${to}`, ask(4, at, which)])));
      return list;
    };

    const draw = () => {
      const row = make("div", { className: "row" });
      if (!reel.live) {
        row.append(make("button", { id: "live-enter", onclick: enter }, "change inputs and go on from this step"));
        row.append(make("span", { id: "live-says" }, "The kernel itself is in this page."));
        home.replaceChildren(row);
        document.body.classList.remove("is-live");
        return;
      }
      row.append(make("button", { id: "live-step", onclick: () => on(1) }, "next step"));
      row.append(make("button", { id: "live-ten", onclick: () => on(10) }, "10 steps"));
      const list = requests();
      const select = make("select", { id: "live-request" }, ...list.map(([text], at) => make("option", { value: at }, text || "no request")));
      select.value = list.findIndex(([, word]) => word === input[REQUEST]);
      select.onchange = () => (input[REQUEST] = list[Number(select.value)][1]);
      row.append(make("label", {}, "ask ", select));
      names.segment.forEach((name, at) => {
        const box = make("input", { type: "checkbox", checked: bit(input[CONSENT], at) });
        box.onchange = () => (input[CONSENT] = with_(input[CONSENT], at, box.checked));
        row.append(make("label", {}, box, ` consent for ${name}`));
      });
      row.append(make("button", { id: "live-leave", onclick: leave }, "back to the film"));
      const circuits = make("div", { className: "row" }, "reported occupied in the next step: ");
      names.circuit.forEach((name, at) => {
        const is = bit(input[OCCUPIED], at);
        const button = make("button", { onclick: () => toggle(name) }, name);
        button.dataset.toggle = name;
        button.setAttribute("aria-pressed", is);
        circuits.append(button);
      });
      const text = home.querySelector("#live-says");
      home.replaceChildren(row, circuits, text || make("span", { id: "live-says" }));
      document.body.classList.add("is-live");
    };

    document.getElementById("plans").addEventListener("click", (event) => {
      const mark = event.target.closest("[data-circuit]");
      if (mark && reel.live) toggle(mark.dataset.circuit);
    });
    draw();
    window.Live = { replay: () => replay(kernel, machine, reel, reel.frames), on, toggle, input: () => input };
  };

  return { offer };
})();
