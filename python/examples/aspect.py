"""A short loss of the signal does not drop the display; a long one does."""

import atc

LINE = {"cycle_ms": 50, "aspects_km_h": [25, 45, 65, 90]}

machine = atc.Machine("aspect-acceptance", LINE)
print("in cycles:", machine.started["cycles"])

heard = [[45]] * 8 + [[]] * 6 + [[45]] * 4 + [[]] * 20
shown = [machine.step({"detected_km_h": now})["display_km_h"] for now in heard]
for cycle, (now, speed) in enumerate(zip(heard, shown)):
    if cycle == 0 or speed != shown[cycle - 1]:
        print(f"{cycle * 50:5} ms  heard {now}  displayed {speed}")

try:
    machine.step({"detected_km_h": [50]})
except atc.Refused as refused:
    print("refused:", refused)
