// Every machine of the protocol in WebAssembly, for Node.js and for browsers: see README.md.

/** The version of the protocol. */
export const PROTOCOL = 1;

const place = new URL("./atc.wasm", import.meta.url);

async function bytes() {
  if (place.protocol === "file:") {
    const { readFile } = await import("node:fs/promises");
    return readFile(place);
  }
  const answer = await fetch(place);
  if (!answer.ok) throw new Error(`${place}: ${answer.status} ${answer.statusText}`);
  return answer.arrayBuffer();
}

const kernel = (await WebAssembly.instantiate(await bytes(), {})).instance.exports;
const encoder = new TextEncoder();
const decoder = new TextDecoder();

// The memory may move when it grows: it is looked at anew each time.
const said = (length) => decoder.decode(new Uint8Array(kernel.memory.buffer, kernel.reply(), length));

/** A configuration or a step that is refused; nothing has changed. The message says what would be right. */
export class Refused extends Error {
  name = "Refused";
}

/** The names of the machines. */
export const machines = () => said(kernel.machines()).split("\n");

/** The JSON Schema of the protocol. */
export const schema = () => JSON.parse(said(kernel.schema()));

const forgotten = new FinalizationRegistry((session) => kernel.close(session));

/** A conversation with the oracle, in the words of protocol 1. */
export class Conversation {
  #session = kernel.open();

  constructor() {
    forgotten.register(this, this.#session, this);
  }

  /** The reply to one line. A line that is not understood has a reply, too, and changes nothing. */
  answer(line) {
    if (this.#session === undefined) throw new Error("this conversation is closed");
    const request = encoder.encode(line);
    const at = kernel.room(request.length);
    new Uint8Array(kernel.memory.buffer, at, request.length).set(request);
    return said(kernel.answer(this.#session));
  }

  /** Gives back its memory. Without it the garbage collector does so, some time. */
  close() {
    if (this.#session === undefined) return;
    forgotten.unregister(this);
    kernel.close(this.#session);
    this.#session = undefined;
  }
}

function ask(conversation, request, right) {
  const reply = JSON.parse(conversation.answer(JSON.stringify(request)));
  if (right in reply) return reply[right];
  throw new Refused(Object.values(reply)[0].reason);
}

/** One machine with its state. Throws `Refused` if there is no such machine, or if the configuration breaks a rule. */
export class Machine {
  #start;
  #conversation;

  constructor(name, config) {
    this.#start = { protocol: PROTOCOL, machine: name, ...(config === undefined ? {} : { config }) };
    this.restart();
  }

  /** Back to the initial state, with the same configuration. */
  restart() {
    const conversation = new Conversation();
    /** The reply to the start: the whole configuration with its defaults, and its times in cycles. */
    this.started = ask(conversation, { start: this.#start }, "started");
    this.#conversation?.close();
    this.#conversation = conversation;
  }

  /** One logic cycle. Throws `Refused` if the step has no meaning; the state is as before. */
  step(step) {
    return ask(this.#conversation, { step }, "output");
  }

  /** A logic cycle for each. A step that is refused ends it: those before have been done. */
  steps(steps) {
    return Array.from(steps, (step) => this.step(step));
  }

  /** Gives back its memory. */
  close() {
    this.#conversation.close();
  }
}
