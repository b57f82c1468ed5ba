// A short loss of the signal does not drop the display; a long one does.
import { Machine, Refused } from "atc-oracle";

const line = { cycle_ms: 50, aspects_km_h: [25, 45, 65, 90] };
const machine = new Machine("aspect-acceptance", line);
console.log("in cycles:", JSON.stringify(machine.started.cycles));

const heard = [...Array(8).fill([45]), ...Array(6).fill([]), ...Array(4).fill([45]), ...Array(20).fill([])];
let before;
heard.forEach((now, cycle) => {
  const { display_km_h: speed } = machine.step({ detected_km_h: now });
  if (cycle === 0 || speed !== before) {
    console.log(`${String(cycle * 50).padStart(5)} ms  heard [${now}]  displayed ${speed}`);
  }
  before = speed;
});

try {
  machine.step({ detected_km_h: [50] });
} catch (error) {
  if (!(error instanceof Refused)) throw error;
  console.log("refused:", error.message);
}
