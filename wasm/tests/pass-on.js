// Passes the lines of a file on to a conversation, and prints the replies.
import { readFileSync } from "node:fs";

import { Conversation } from "atc-oracle";

const conversation = new Conversation();
const lines = readFileSync(process.argv[2], "utf8").replace(/\n$/, "").split("\n");
process.stdout.write(lines.map((line) => `${conversation.answer(line)}\n`).join(""));
