"use strict";
// The track plans: what each element shows in a frame, and the trains on it.
const Stage = (() => {
  const SVG = "http://www.w3.org/2000/svg";
  const element = (name, attributes, text) => {
    const made = document.createElementNS(SVG, name);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    if (text !== undefined) made.textContent = text;
    return made;
  };
  const corners = (line) => line.getAttribute("points").trim().split(/\s+/).map((pair) => pair.split(",").map(Number));
  const points = (list) => list.map(([x, y]) => `${x.toFixed(1)},${y.toFixed(1)}`).join(" ");
  const middle = (list) => Logic.part(list, 0.5, 0.5)[0] || list[0];

  // A plan in the page, with what it is made of.
  const raise = (plan, home) => {
    const part = document.createElement("div");
    part.className = "plan-part";
    part.innerHTML = plan.svg;
    const svg = part.querySelector("svg");
    const natural = Number(svg.getAttribute("width"));
    svg.style.setProperty("--natural", `${Math.min(natural * 0.72, 4000)}px`);
    svg.style.setProperty("--most", `${Math.max(natural * 1.25, Math.min(natural * 2, window.screen.width * 0.7))}px`);
    svg.removeAttribute("width");
    svg.removeAttribute("height");
    home.append(part);
    const name = (kind, local) => plan.names[`${kind} ${local}`] || local;
    const tracks = [...svg.querySelectorAll("polyline[data-circuit]")].map((line) => ({
      line, circuit: name("circuit", line.dataset.circuit), corners: corners(line),
      piece: line.dataset.piece === undefined ? -1 : plan.pieces[Number(line.dataset.piece)] ?? Number(line.dataset.piece),
      point: line.dataset.point && name("point", line.dataset.point), leg: line.dataset.leg || "",
    }));
    const under = element("g", { "aria-hidden": "true" });
    const over = element("g", { "aria-hidden": "true" });
    const first = svg.querySelector("polyline");
    if (first) svg.insertBefore(under, first);
    svg.append(over);
    const labels = (kind) =>
      [...svg.querySelectorAll(`text[data-${kind}]`)].map((text) => ({ text, name: name(kind, text.dataset[kind]), plain: text.textContent }));
    return {
      part, svg, natural, under, over, tracks, name, circuits: labels("circuit"), points: labels("point"), segments: labels("segment"),
      signals: [...svg.querySelectorAll("g[data-signal]")].map((group) => ({ group, name: name("signal", group.dataset.signal) })),
    };
  };

  // A point's reverse leg is drawn from its blade on: the way over it begins at its toe.
  const way = (plan, piece, reverse) => {
    const of = plan.tracks.filter((track) => track.piece === piece);
    if (!reverse) return of.find((track) => track.leg !== "reverse")?.corners;
    const [main, leg] = [of.find((track) => track.leg !== "reverse"), of.find((track) => track.leg === "reverse")];
    return leg && (main ? [main.corners[0], ...leg.corners] : leg.corners);
  };

  const body = (plan, scale, lines, head, back, name) => {
    for (const line of lines) {
      plan.over.append(element("polyline", { class: "train-body", points: points(line) }));
      plan.over.append(element("polyline", { class: "train-core", points: points(line) }));
    }
    if (!head) return;
    const angle = (Math.atan2(head[1] - back[1], head[0] - back[0]) * 180) / Math.PI;
    const [x, y] = head;
    plan.over.append(element("path", { class: "train-head", d: "M9 0L-5 -8V8Z", transform: `translate(${x} ${y}) rotate(${angle})` }));
    const wide = (12 + 7 * name.length) / scale;
    const [left, top] = [(x + back[0]) / 2, y - 32];
    plan.over.append(element("rect", { class: "train-tag", x: left - wide / 2, y: top - 9, width: wide, height: 17, rx: 4 }));
    plan.over.append(element("text", { class: "train-name", x: left, y: top + 4 }, name));
  };

  const trains = (plan, scale, reel, frame) => {
    for (const train of reel.film.trains) {
      const of = (what) => Logic.word(reel, "train", train, what, frame);
      const on = of("on");
      if (on) {
        const [front, tail] = [Logic.number(reel, "train", train, "front_share", frame), Logic.number(reel, "train", train, "rear_share", frame)];
        const list = Logic.covered(on, front, tail);
        const lines = [];
        let [head, back] = [null, null];
        list.forEach((one, place) => {
          const line = way(plan, one.piece, one.reverse);
          if (!line) return;
          const under = Logic.part(line, one.from, one.to);
          if (under.length < 2) return;
          lines.push(under);
          if (place === list.length - 1) {
            head = one.forward ? under[under.length - 1] : under[0];
            back = one.forward ? under[0] : under[under.length - 1];
          }
        });
        if (lines.length) body(plan, scale, lines, head, back, train);
      } else if (of("front")) {
        const [front, rear] = [of("front"), of("rear")];
        const whole = (circuit) => plan.tracks.find((track) => track.circuit === circuit && track.leg !== "reverse")?.corners;
        const [ahead, behind] = [whole(front), whole(rear)];
        if (!ahead) continue;
        const lines = (front === rear || !behind ? [ahead] : [behind, ahead]).map((line) => Logic.part(line, 0.15, 0.85));
        const right = of("heading") !== "down" && of("heading") !== "left";
        const [a, b] = [lines[lines.length - 1][0], lines[lines.length - 1].at(-1)];
        const swap = (a[0] > b[0]) === right;
        body(plan, scale, lines, swap ? a : b, swap ? b : a, train);
      }
    }
  };

  const show = (plan, reel, frame) => {
    const scale = Math.min(1, plan.svg.clientWidth / plan.natural) || 1;
    plan.svg.style.setProperty("--letters", `${12 / scale}px`);
    const known = new Map();
    const circuit = (name) => {
      if (!known.has(name)) known.set(name, Logic.circuit(reel, name, frame));
      return known.get(name);
    };
    const under = [];
    const crosses = [];
    for (const track of plan.tracks) {
      const { track: is, held, blocked } = circuit(track.circuit);
      const list = track.line.classList;
      list.toggle("is-occupied", is === "occupied");
      list.toggle("is-waiting", is === "waiting");
      if (track.point) {
        const detected = Logic.word(reel, "point", track.point, "detected", frame);
        list.toggle("is-moving", detected === "none");
        list.toggle("is-off", detected !== "" && detected !== "none" && track.leg !== "" && detected !== track.leg);
      }
      const away = list.contains("is-off");
      if (held && !away) under.push(element("polyline", { class: `under ${held}`, points: track.line.getAttribute("points") }));
      if (blocked === "blocked" || blocked === "confirmed") {
        const [x, y] = middle(track.corners);
        crosses.push(element("path", { class: "blocked-mark", d: `M${x - 6} ${y - 7}l12 14m0 -14l-12 14` }));
      }
    }
    plan.under.replaceChildren(...under);
    plan.over.replaceChildren(...crosses);
    for (const { text, name } of plan.circuits) {
      const { told } = circuit(name);
      if (told === "") continue;
      const [x, y, wide] = [Number(text.getAttribute("x")), Number(text.getAttribute("y")) - 46, (12 + told.length * 6.6) / scale];
      plan.over.append(element("rect", { class: "told-tag", x: x - wide / 2, y: y - 12, width: wide, height: 17, rx: 8 }));
      plan.over.append(element("text", { class: "told", x, y: y + 1 }, told));
    }
    for (const { text, name, plain } of plan.points) {
      const driven = Logic.word(reel, "point", name, "driven", frame);
      text.textContent = driven ? `${plain} ⇒ ${driven}` : plain;
    }
    for (const { text, name, plain } of plan.segments) {
      const direction = Logic.word(reel, "segment", name, "direction", frame);
      text.textContent = direction ? `${plain}: ${direction}` : plain;
    }
    for (const { group, name } of plan.signals)
      group.classList.toggle("is-go", Logic.word(reel, "signal", name, "shows", frame) === "proceed");
    trains(plan, scale, reel, frame);
  };

  return { raise, show };
})();
