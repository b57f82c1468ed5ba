// What the types let pass, and what they do not. It is checked, and never run.
import { Conversation, Machine, type Name, Refused, machines, schema } from "atc-oracle";

const names: Name[] = machines();
const machine = new Machine(names[0] ?? "wayside", { cycle_ms: 50, aspects_km_h: [25, 45] });
const cycles: number | undefined = machine.started.cycles?.interruption;
const shown = machine.steps([{ detected_km_h: [45] }]).map((output) => output.display_km_h);
const text: string = new Conversation().answer('{"stop":{}}');
const refused: Error = new Refused("why");
schema().$defs;
machine.close();

// @ts-expect-error: no such machine
new Machine("block");
// @ts-expect-error: a step is an object
machine.step(45);
// @ts-expect-error: functions are no JSON
machine.step({ detected_km_h: () => 45 });
// @ts-expect-error: it is not for writing
machine.started = machine.started;

export { cycles, refused, shown, text };
