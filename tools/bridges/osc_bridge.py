#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Sends the snapshots of a run (fdcg-servo run --listen PORT) on by Open Sound Control, to Pure Data, SuperCollider or a show
controller: for each device /fdcg/NAME/tip x y z, /fdcg/NAME/force x y z, /fdcg/NAME/contact state slipping. Needs
python3-websockets.

usage: osc_bridge.py PORT [OSC_HOST [OSC_PORT]]"""
import asyncio
import json
import socket
import struct
import sys

import websockets


def padded(data):
    return data + b"\0" * (-len(data) % 4)


def osc_message(address, *values):
    """OSC 1.0: an address, the types' tags, then big-endian values, each padded to four bytes."""
    tags, body = ",", b""
    for value in values:
        if isinstance(value, str):
            tags, body = tags + "s", body + padded(value.encode() + b"\0")
        elif isinstance(value, int):
            tags, body = tags + "i", body + struct.pack(">i", value)
        else:
            tags, body = tags + "f", body + struct.pack(">f", value)
    return padded(address.encode() + b"\0") + padded(tags.encode() + b"\0") + body


def messages_of(snapshot):
    for device in snapshot["devices"]:
        place = "/fdcg/" + "".join(c if c.isalnum() else "_" for c in device["name"])
        yield osc_message(place + "/tip", *map(float, device["tip_m"]))
        yield osc_message(place + "/force", *map(float, device["force_n"]))
        for contact in device["contacts"]:
            yield osc_message(place + "/contact", contact["state"], int(contact["slipping"]))


async def bridge(port, to):
    out = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    async with websockets.connect(f"ws://127.0.0.1:{port}/") as run:
        async for text in run:
            told = json.loads(text)
            if told["event"] == "snapshot":
                for message in messages_of(told):
                    out.sendto(message, to)


if __name__ == "__main__":
    if not 2 <= len(sys.argv) <= 4 or not sys.argv[1].isdigit():
        sys.exit(__doc__)
    host = sys.argv[2] if len(sys.argv) > 2 else "127.0.0.1"
    try:
        asyncio.run(bridge(int(sys.argv[1]), (host, int(sys.argv[3]) if len(sys.argv) > 3 else 9000)))
    except (OSError, websockets.WebSocketException) as problem:
        sys.exit(f"osc_bridge.py: port {sys.argv[1]}: {problem}; is fdcg-servo run --listen there?")
    except KeyboardInterrupt:
        pass
