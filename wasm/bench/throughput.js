// Logic cycles per second of aspect acceptance through the package: one row beside those of python/bench/throughput.py.
import { Machine } from "atc-oracle";

const machine = new Machine("aspect-acceptance", { cycle_ms: 50, aspects_km_h: [25, 45, 65, 90] });
const steps = Array.from({ length: 200_000 }, (_, cycle) => ({ detected_km_h: cycle % 10 ? [45] : [] }));
let best = Infinity;
for (let run = 0; run < 5; run += 1) {
  const start = performance.now();
  for (const step of steps) machine.step(step);
  best = Math.min(best, performance.now() - start);
}
console.log(`${Math.round(steps.length / best)},000 cycles a second`);
