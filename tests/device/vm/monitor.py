# SPDX-License-Identifier: Apache-2.0
"""What is done to a guest from outside while it runs, over QEMU's monitor protocol (QMP)."""
import json
import random
import socket
import threading
import time


class Monitor(threading.Thread):
    """Ends with QEMU. wakes_after_s: a guest that has suspended itself to memory is woken after so long. stops: how often all of
    it is held for a moment (`stop`, `cont`)."""

    def __init__(self, path, wakes_after_s=None, stops=0):
        super().__init__(daemon=True)
        self.path, self.wakes_after_s, self.stops = path, wakes_after_s, stops
        self.woken = self.stopped = 0
        self.start()

    def options(self):
        return ["-qmp", f"unix:{self.path},server=on,wait=off"]

    def run(self):
        with socket.socket(socket.AF_UNIX) as line:
            while not self.is_connected(line):
                time.sleep(0.05)
            with line.makefile("rw") as stream:
                try:
                    self.serve(stream)
                except (BrokenPipeError, ConnectionResetError):
                    pass  # the guest has ended

    def is_connected(self, line):
        try:
            line.connect(str(self.path))
            return True
        except OSError:
            return False

    def serve(self, stream):
        stream.readline()  # who it is
        self.say(stream, "qmp_capabilities")
        if self.stops:
            threading.Thread(target=self.hold, args=(stream,), daemon=True).start()
        for line in stream:
            if json.loads(line).get("event") == "SUSPEND" and self.wakes_after_s is not None:
                time.sleep(self.wakes_after_s)
                self.say(stream, "system_wakeup")
                self.woken += 1

    def hold(self, stream):
        moments = random.Random(1)
        try:
            while self.stopped < self.stops:
                time.sleep(moments.uniform(0.05, 0.8))
                self.say(stream, "stop")
                time.sleep(moments.uniform(0.01, 0.3))
                self.say(stream, "cont")
                self.stopped += 1
        except (BrokenPipeError, ConnectionResetError, ValueError):
            pass

    @staticmethod
    def say(stream, command):
        stream.write(json.dumps({"execute": command}) + "\n")
        stream.flush()
