# SPDX-License-Identifier: Apache-2.0
"""The virtual machine: QEMU in software emulation, so that it runs wherever the tests do."""
import dataclasses
import resource
import subprocess
import time

from image import kernel_image, need

EXIT_PORT = 0xF4  # of isa-debug-exit, which guest_init.sh writes to: value v ends QEMU with 2 v + 1
# `-icount shift=1`: an instruction takes 2 ns, and the guest's clock counts instructions, so that what else this machine does
# changes no figure; `sleep=off`: an idle guest skips to its next timer.
TIMED = ["-accel", "tcg,thread=single", "-icount", "shift=1,sleep=off", "-smp", "1", "-seed", "1",
         "-rtc", "base=2026-01-01,clock=vm"]
# an instruction takes 1 ns
TIMED_FASTER = [word.replace("shift=1", "shift=0") for word in TIMED]
# two processors that really run at once, in real time: for races, where time says nothing
RACING = ["-accel", "tcg,thread=multi", "-smp", "2"]
# its clock of suspended time is this machine's; q35 suspends once only, since what puts it to sleep is not set up again
SUSPENDING = [*TIMED[:-1], "base=2026-01-01,clock=host", "-M", "pc"]
MACHINE = ["-M", "q35", "-cpu", "qemu64,+ssse3,+sse4.1,+sse4.2", "-m", "512", "-nodefaults", "-no-reboot", "-display", "none",
           "-serial", "stdio", "-device", f"isa-debug-exit,iobase={EXIT_PORT:#x},iosize=4"]
# no_timer_check: the kernel's trial of its timer fails where this machine is busy
KERNEL_OPTIONS = ("console=ttyS0 loglevel=2 panic=-1 mitigations=off rcupdate.rcu_expedited=1 tsc=reliable no_timer_check "
                  "nokaslr norandmaps random.trust_cpu=off")


@dataclasses.dataclass
class Outcome:
    console: str
    code: int  # of the guest's rig; -1: the guest did not get so far
    wall_s: float
    cpu_s: float


def boot(unpacked, initramfs, arguments, limit_s, mode=TIMED, monitor_options=()):
    """Boots, runs the rig with the arguments, returns what it printed. Ends by itself, or by force after limit_s."""
    command = [need("qemu-system-x86_64"), *MACHINE, *mode, *monitor_options, "-kernel", str(kernel_image(unpacked)), "-initrd", str(initramfs),
               "-append", f"{KERNEL_OPTIONS} -- rig {' '.join(arguments)}"]
    began, cpu_before = time.monotonic(), resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    try:
        done = subprocess.run(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              timeout=limit_s)
        console, code = done.stdout, done.returncode // 2 if done.returncode % 2 else -1
    except subprocess.TimeoutExpired as error:
        console, code = (error.stdout or b"") + f"\nQEMU ended after {limit_s} s\n".encode(), -1
    cpu_s = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - cpu_before
    return Outcome(console.decode(errors="replace").replace("\r\n", "\n"), code, time.monotonic() - began, cpu_s)
