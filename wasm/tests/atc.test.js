// The package, as its users have it: installed, and asked. node --test
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";

import { Conversation, Machine, PROTOCOL, Refused, machines, schema } from "atc-oracle";

const line = { cycle_ms: 50, aspects_km_h: [25, 45, 65, 90] };
const block = { sections: 3, max_trains: 3, tail_hold_sections: 1, cycle_ms: 1000, pass_ms: 10000 };

test("every machine is there, and in the types", () => {
  const types = readFileSync(new URL(import.meta.resolve("atc-oracle").replace(/\.js$/, ".d.ts")), "utf8");
  const named = types.match(/export type Name =([^;]*);/)[1].match(/"[^"]+"/g).map((name) => JSON.parse(name));
  assert.deepEqual(named, machines());
  assert.equal(PROTOCOL, 1);
  assert.ok("$defs" in schema());
});

test("a restart is the beginning", () => {
  const machine = new Machine("aspect-acceptance", line);
  const steps = Array(12).fill({ detected_km_h: [45] });
  const first = machine.steps(steps);
  assert.notDeepEqual(machine.steps(steps), first);
  machine.restart();
  assert.deepEqual(machine.steps(steps), first);
});

test("what is refused changes nothing", () => {
  const machine = new Machine("block-count", block);
  const other = new Machine("block-count", block);
  const step = { check_in: true, check_out: false, present: [], reset: 0 };
  assert.deepEqual(machine.step(step), other.step(step));
  for (const wrong of [{ present: [7] }, {}, { ...step, reset: NaN, present: [-1] }, "a\nb", null, undefined]) {
    assert.throws(() => machine.step(wrong), (error) => error instanceof Refused && error.message.length > 20);
  }
  assert.deepEqual(machine.step(step), other.step(step));
});

test("configurations that break a rule", () => {
  for (const [name, config, says] of [
    ["aspect-acceptance", { ...line, operate_ms: 0 }, /operate_ms/],
    ["aspect-acceptance", { aspects: [25] }, /unknown field `aspects`/],
    ["block", undefined, /there is no machine/],
  ]) {
    assert.throws(() => new Machine(name, config), says);
  }
});

test("a restart that is refused leaves the machine as it is", () => {
  const config = { ...line };
  const machine = new Machine("aspect-acceptance", config);
  config.cycle_ms = 0;
  const step = { detected_km_h: [45] };
  const before = machine.steps(Array(12).fill(step)).at(-1);
  assert.throws(() => machine.restart(), Refused);
  assert.deepEqual(machine.step(step), before);
});

test("many conversations do not know of each other, and closed ones give back their place", () => {
  const all = Array.from({ length: 200 }, () => new Machine("aspect-acceptance", line));
  const step = { detected_km_h: [45] };
  const shown = all.map((machine, number) => machine.steps(Array(number % 12).fill(step)).at(-1)?.display_km_h ?? null);
  const alone = new Machine("aspect-acceptance", line).steps(Array(12).fill(step));
  shown.forEach((speed, number) => assert.equal(speed, number % 12 ? alone[(number % 12) - 1].display_km_h : null));
  all.forEach((machine) => machine.close());
  assert.throws(() => all[0].step(step), /closed/);
  const conversation = new Conversation();
  assert.match(conversation.answer("é\u0000 {"), /malformed/);
  assert.match(conversation.answer("x".repeat(3 << 20)), /longer than/);
  conversation.close();
  conversation.close();
});
