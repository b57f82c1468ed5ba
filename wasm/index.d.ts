/** The version of the protocol. */
export const PROTOCOL: 1;

/** A value of JSON. */
export type Json = null | boolean | number | string | Json[] | { [name: string]: Json };

/** An object of JSON: a configuration, a step or an output. The schema of the protocol has their fields. */
export type Body = { [name: string]: Json };

/** The name of a machine. */
export type Name =
  | "aspect-acceptance"
  | "speed-supervision"
  | "block-count"
  | "telegram-codec"
  | "braking-pattern"
  | "permitted-speed"
  | "train-position"
  | "interlocking"
  | "train"
  | "wayside";

/** A configuration or a step that is refused; nothing has changed. The message says what would be right. */
export class Refused extends Error {}

/** The names of the machines. */
export function machines(): Name[];

/** The JSON Schema of the protocol. */
export function schema(): Body;

/** The reply to a start. */
export interface Started {
  protocol: 1;
  machine: Name;
  /** The whole configuration, with its defaults. */
  config: Body;
  /** Times in cycles; not there if the machine counts no time. */
  cycles?: { [name: string]: number };
}

/** A conversation with the oracle, in the words of protocol 1. */
export class Conversation {
  /** The reply to one line. A line that is not understood has a reply, too, and changes nothing. */
  answer(line: string): string;
  /** Gives back its memory. Without it the garbage collector does so, some time. */
  close(): void;
}

/** One machine with its state. */
export class Machine {
  /** Throws `Refused` if there is no such machine, or if the configuration breaks a rule. */
  constructor(name: Name, config?: Body);
  /** The reply to the start. */
  readonly started: Started;
  /** Back to the initial state, with the same configuration. */
  restart(): void;
  /** One logic cycle. Throws `Refused` if the step has no meaning; the state is as before. */
  step(step: Body): Body;
  /** A logic cycle for each. A step that is refused ends it: those before have been done. */
  steps(steps: Iterable<Body>): Body[];
  /** Gives back its memory. */
  close(): void;
}
