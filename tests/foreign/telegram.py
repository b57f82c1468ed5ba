"""The telegram codec, written from spec/telegram.md alone, without the kernel: `python3 telegram.py [--fault 1…12]`."""

import wire
from wire import FAULT, Malformed, fields, whole

SYNC = "0111111111111110"
FRAME = 106


def one_byte(rest):
    for _ in range(8):
        rest = (rest << 1 ^ 0x1021) & 0xFFFF if rest & 0x8000 else rest << 1
    return rest


REMAINDERS = [one_byte(byte << 8) for byte in range(256)]


def check(data):
    """TEL-3: the remainder by x^16 + x^12 + x^5 + 1, from sixteen ones."""
    rest = 0xFFFF if FAULT != 1 else 0
    for byte in data:
        rest = (rest << 8 & 0xFFFF) ^ REMAINDERS[rest >> 8 ^ byte]
    return rest


def read_main(value):
    value = fields(value, ("section", "counter", "beyond_exit_m", "speed_rank"))
    beyond = value["beyond_exit_m"]
    return {
        "section": whole(value["section"], 0, 65535),
        "counter": whole(value["counter"], 0, 255),
        "beyond_exit_m": None if beyond is None else whole(beyond, 0, 65535),
        "speed_rank": whole(value["speed_rank"], 0, 15),
    }


def read_sub(value):
    value = fields(value, ("section", "counter", "length_m", "gradient_permille", "curve_rank", "restriction_rank"))
    return {
        "section": whole(value["section"], 0, 65535),
        "counter": whole(value["counter"], 0, 255),
        "length_m": whole(value["length_m"], 1, 65535),
        "gradient_permille": whole(value["gradient_permille"], -128, 127),
        "curve_rank": whole(value["curve_rank"], 0, 15),
        "restriction_rank": whole(value["restriction_rank"], 0, 15),
    }


def information(telegram):
    """The first eight bytes."""
    if "main" in telegram:
        main = telegram["main"]
        open_ = main["beyond_exit_m"] is not None
        distance = main["beyond_exit_m"] if open_ else 0
        tail = [0xF0 if open_ else 0x0F, main["speed_rank"]]
        kind, words = 0x4D, (main["counter"], main["section"], distance)
    else:
        sub = telegram["sub"]
        ranks = (sub["curve_rank"], sub["restriction_rank"])
        if FAULT == 2:
            ranks = ranks[::-1]
        tail = [sub["gradient_permille"] & 0xFF, ranks[0] << 4 | ranks[1]]
        kind, words = 0x53, (sub["counter"], sub["section"], sub["length_m"])
    order = "little" if FAULT == 3 else "big"
    return bytes([kind, words[0]]) + words[1].to_bytes(2, order) + words[2].to_bytes(2, order) + bytes(tail)


def encode(telegram):
    data = information(telegram)
    data += check(data).to_bytes(2, "little" if FAULT == 4 else "big")
    guard = "1" if FAULT == 5 else "0"
    return SYNC + "".join(f"{byte:08b}" + guard for byte in data)


def decode(bits):
    """The telegram of 106 bits, or the word for why there is none."""
    if bits[:16] != SYNC:
        return "synchronisation"
    body = bits[16:]
    if "1" in body[8::9] and FAULT != 6:
        return "guard"
    data = bytes(int(body[at : at + 8], 2) for at in range(0, 90, 9))
    if check(data[:8]) != int.from_bytes(data[8:], "big"):
        return "check" if FAULT != 7 else "content"
    section, middle = int.from_bytes(data[2:4], "big"), int.from_bytes(data[4:6], "big")
    if data[0] == 0x4D:
        if data[7] > 15 or not (data[6] == 0xF0 or (data[6] == 0x0F and (middle == 0 or FAULT == 8))):
            return "content"
        beyond = middle if data[6] == 0xF0 else None
        return {"main": {"section": section, "counter": data[1], "beyond_exit_m": beyond, "speed_rank": data[7]}}
    if data[0] == 0x53 and (middle != 0 or FAULT == 9):
        return {
            "sub": {
                "section": section,
                "counter": data[1],
                "length_m": middle,
                "gradient_permille": data[6] - 256 if data[6] > 127 and FAULT != 10 else data[6],
                "curve_rank": data[7] >> 4,
                "restriction_rank": data[7] & 15,
            }
        }
    return "content"


class Codec:
    """The bits that were received are kept from step to step."""

    def __init__(self, config):
        fields(config, ())
        self.config = {}
        self.times = 0
        self.heard = ""

    def step(self, value):
        value = fields(value, (), ("encode", "decode", "bits"))
        if len(value) != 1:
            raise Malformed("one of encode, decode and bits is asked for")
        if "encode" in value:
            asked = fields(value["encode"], (), ("main", "sub"))
            if len(asked) != 1:
                raise Malformed("a telegram is a main or a sub telegram")
            telegram = {"main": read_main(asked["main"])} if "main" in asked else {"sub": read_sub(asked["sub"])}
            return {"frame": encode(telegram)}
        (bits,) = value.values()
        if not isinstance(bits, str) or set(bits) - set("01" if "decode" in value else "01."):
            raise Malformed("bits are 0 and 1")
        if "decode" in value:
            if len(bits) != FRAME:
                raise Malformed("a frame has 106 bits")
            found = decode(bits)
            return {"error": found} if isinstance(found, str) else {"telegram": found}
        found = []
        for number, part in enumerate(bits.split(".")):
            if number > 0:  # a bit time without a bit
                self.heard = "" if FAULT != 11 else self.heard
                self.times += 1 if FAULT != 12 else 0
            text = self.heard + part
            at = text.find(SYNC)
            while 0 <= at <= len(text) - FRAME:
                telegram = decode(text[at : at + FRAME])
                if not isinstance(telegram, str):
                    found.append({"last_bit": self.times + at + FRAME - 1 - len(self.heard), "telegram": telegram})
                at = text.find(SYNC, at + 1)
            self.times += len(part)
            self.heard = text[1 - FRAME :]
        return {"telegrams": found}


if __name__ == "__main__":
    wire.serve("telegram-codec", Codec)
