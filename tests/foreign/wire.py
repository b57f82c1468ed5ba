"""Protocol 1 of oracle/README.md, for the Python implementations beside it. Standard library only."""

import json
import sys
from decimal import Decimal

# The fault that is seeded on purpose, `--fault 3`; 0 is none.
FAULT = int(sys.argv[sys.argv.index("--fault") + 1]) if "--fault" in sys.argv else 0


WRITER = json.JSONEncoder(separators=(",", ":"))
READER = json.JSONDecoder(object_pairs_hook=lambda pairs: once(pairs), parse_float=Decimal, parse_constant=lambda word: constant(word))


class Malformed(Exception):
    """What is asked for is not a request of this machine."""


class Rejected(Exception):
    """A start breaks a rule of the specification."""


def fields(value, required, optional=()):
    """The object `value`, if it has the required fields and no others but the optional ones."""
    if not isinstance(value, dict):
        raise Malformed("an object is expected")
    for name in required:
        if name not in value:
            raise Malformed(f"the field {name} is missing")
    for name in value:
        if name not in required and name not in optional:
            raise Malformed(f"there is no field {name}")
    return value


def whole(value, least, most, scale=1):
    """`value` times `scale`, if that is a whole number from `least` to `most`. 10.0 is whole."""
    if isinstance(value, bool) or not isinstance(value, (int, Decimal)):
        raise Malformed("a number is expected")
    if isinstance(value, Decimal) and not -100 < value.adjusted() < 100:
        value = Decimal(0) if value == 0 else Decimal("0.00001")
    scaled = value * scale
    if scaled != int(scaled) or not least <= scaled <= most:
        raise Malformed(f"a number from {least} to {most} is expected, in steps of 1/{scale}")
    return int(scaled)


def number(value, scale):
    """A whole number of 1/`scale` as JSON: whole where it is whole."""
    return value // scale if value % scale == 0 else value / scale


def once(pairs):
    """An object whose fields come once each."""
    names = [name for name, _ in pairs]
    if len(set(names)) != len(names):
        raise Malformed("a field comes twice")
    return dict(pairs)


def constant(word):
    """NaN and the like, which Python reads and JSON does not have."""
    raise Malformed(f"{word} is no JSON")


def read(line):
    """The one value of a line."""
    try:
        return READER.decode(line.decode())
    except (ValueError, RecursionError) as error:
        raise Malformed("the line is no JSON") from error


def serve(name, start):
    """Answers each line of standard input. `start(config)` gives a machine with `config`, `cycles` and `step(input)`."""
    machine, steps = None, 0
    for line in sys.stdin.buffer:
        try:
            body = read(line)
            if not isinstance(body, dict) or len(body) != 1:
                raise Malformed("a line is one object with one field: start, step or stop")
            if "start" in body:
                if machine is not None:
                    raise Malformed("a case is open: stop it first")
                asked = fields(body["start"], ("protocol", "machine"), ("config",))
                protocol = whole(asked["protocol"], 0, 2**32 - 1)
                if not isinstance(asked["machine"], str):
                    raise Malformed("a machine has a name")
                if protocol != 1 or asked["machine"] != name:
                    raise Rejected("this is protocol 1 and " + name)
                machine, steps = start(asked.get("config", {})), 0
                reply = {"started": {"protocol": 1, "machine": name, "config": machine.config}}
            elif "step" in body:
                if machine is None:
                    raise Malformed("no case is open: start one first")
                reply = {"output": machine.step(body["step"])}
                steps += 1
            elif "stop" in body:
                fields(body["stop"], ())
                if machine is None:
                    raise Malformed("no case is open: start one first")
                machine = None
                reply = {"stopped": {"steps": steps}}
            else:
                raise Malformed("a line is a start, a step or a stop")
        except Malformed as error:
            reply = {"malformed": {"reason": str(error)}}
        except Rejected as error:
            reply = {"rejected": {"reason": str(error)}}
        sys.stdout.write(WRITER.encode(reply) + "\n")
        sys.stdout.flush()
