#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# The first process of the guest: mounts, modules, the rig with the arguments that stand behind "rig" on the kernel's command
# line, and its exit code to the host through QEMU's isa-debug-exit.
mount -t proc proc /proc
mount -t sysfs sys /sys
mount -t devtmpfs dev /dev
mount -t tmpfs -o size=64m tmp /tmp
for module in $(cat /modules/order); do insmod "$module"; done
echo -1 >/proc/sys/kernel/sched_rt_runtime_us
echo "guest: kernel $(cat /proc/sys/kernel/osrelease)"
while [ "${1-rig}" != rig ]; do shift; done # options that the kernel did not know
shift
vm_rig "$@"
code=$?
echo "guest: exit $code"
printf "\\$(printf %03o $code)" | dd of=/dev/port bs=1 seek=244 2>/dev/null
poweroff -f
