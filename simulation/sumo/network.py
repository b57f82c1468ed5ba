"""SUMO's network of the line: every piece of track is two edges, one for each direction, over each other."""

import subprocess
from pathlib import Path
from xml.etree import ElementTree

import sumo

from line import WEST, Line

PROGRAMS = Path(sumo.SUMO_HOME) / "bin"
TRACKS_APART_M = 10

# Where SUMO's own signals stand. A signal of SUMO is for both directions of its node, but for connections that are
# "uncontrolled": here signals stand as ours do, at the exits of the tracks, at the entries of the stations, and
# between the blocks.
BOTH_ENDS, ONE_END, NOWHERE = "both ends", "one end", "nowhere"


def build(line: Line, folder: Path, signals: str) -> Path:
    """Writes the network as plain XML, and has netconvert make the network of it."""
    nodes, edges, connections = (folder / f"line.{kind}.xml" for kind in ("nod", "edg", "con"))
    write(nodes, "nodes", nodes_of(line, signals))
    write(edges, "edges", edges_of(line))
    write(connections, "connections", uncontrolled(line))
    network = folder / "line.net.xml"
    files = ["-n", nodes, "-e", edges, "-x", connections, "-o", network]
    command = [str(part) for part in (PROGRAMS / "netconvert", *files)]
    done = subprocess.run(command, check=False, capture_output=True, text=True)
    if done.returncode != 0:
        raise RuntimeError(f"netconvert: {done.stderr.strip()}")
    return network


def write(path: Path, root: str, children: list[tuple[str, dict[str, str]]]) -> None:
    tree = ElementTree.Element(root)
    for tag, attributes in children:
        ElementTree.SubElement(tree, tag, attributes)
    ElementTree.ElementTree(tree).write(path, encoding="utf-8")


def nodes_of(line: Line, signals: str) -> list[tuple[str, dict[str, str]]]:
    """Every joint is a node. Its shape is tiny: nothing of a train is on it, as joints have no length."""
    kept = signal_joints(line, signals)
    nodes = []
    for name, (x, y) in places(line).items():
        corners = [(-0.05, -2), (0.05, -2), (0.05, 2), (-0.05, 2)]
        shape = " ".join(f"{x + right:.2f},{y + up:.2f}" for right, up in corners)
        kind = "rail_signal" if name in kept else "priority"
        nodes.append(("node", {"id": name, "x": str(x), "y": str(y), "type": kind, "shape": shape}))
    return nodes


def places(line: Line) -> dict[str, tuple[float, float]]:
    """Where the joints are: metres from the western end of the line, and tracks beside each other."""
    first = line.pieces[line.blocks[0]].west
    places = {first: (0.0, 0.0)}
    while True:
        known = [piece for piece in line.pieces.values() if (piece.west in places) != (piece.east in places)]
        if not known:
            return places
        for piece in known:
            forwards = piece.west in places
            x, y = places[piece.west if forwards else piece.east]
            aside = TRACKS_APART_M if piece.position == "reverse" else 0
            places[piece.east if forwards else piece.west] = (x + piece.length_m * (1 if forwards else -1), y - aside)


def signal_joints(line: Line, signals: str) -> set[str]:
    """The joints with a signal of SUMO."""
    if signals == NOWHERE:
        return set()
    exits = {station: exit_joints(line, station) for station in line.layouts}
    if signals == ONE_END:
        return exits[WEST]
    along = {line.pieces[name].west for name in line.blocks} | {line.pieces[name].east for name in line.blocks}
    return along.union(*exits.values())


def exit_joints(line: Line, station: str) -> set[str]:
    legs = [line.pieces[one.leg] for one in line.platforms.values() if one.station == station]
    return {leg.west if station == WEST else leg.east for leg in legs}


def edges_of(line: Line) -> list[tuple[str, dict[str, str]]]:
    edges = []
    for piece in line.pieces.values():
        common = {"numLanes": "1", "allow": "rail", "spreadType": "center", "length": str(piece.length_m)}
        common["speed"] = f"{piece.limit_km_h / 3.6:.4f}"
        edges.append(("edge", {"id": piece.name, "from": piece.west, "to": piece.east, **common}))
        edges.append(("edge", {"id": "-" + piece.name, "from": piece.east, "to": piece.west, **common}))
    return edges


def uncontrolled(line: Line) -> list[tuple[str, dict[str, str]]]:
    """No signal stands at the toe of a point for trains that leave, nor at the end of a track for trains that come."""
    connections = []
    for platform in line.platforms.values():
        outwards = platform.station == WEST
        sign, back = ("", "-") if outwards else ("-", "")
        block, track = (line.blocks[0], platform.pieces[-1]) if outwards else (line.blocks[-1], platform.pieces[0])
        connections += [(sign + platform.leg, sign + block), (back + platform.leg, back + track)]
    lanes = {"fromLane": "0", "toLane": "0", "uncontrolled": "true"}
    return [("connection", {"from": origin, "to": target, **lanes}) for origin, target in connections]
