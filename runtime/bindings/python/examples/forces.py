# SPDX-License-Identifier: Apache-2.0
"""From a mesh file to a plot of forces: python3 forces.py cube.obj 0.01 forces.png"""
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import fdcg

graph = fdcg.compile(fdcg.read(sys.argv[1]), metres_per_unit=float(sys.argv[2]))
low, high = graph.bounds_m
t = np.arange(0, 1, 0.001)
path_m = (low + high) / 2 + (high - low) * np.stack([0.3 * np.cos(6 * t), 0.3 * np.sin(6 * t), 0.52 - 0.1 * np.sin(3 * t)], axis=1)
log = fdcg.replay(graph, path_m)
plt.plot(t, log.force_n, label=["x", "y", "z"])
plt.xlabel("time, s"), plt.ylabel("force on the hand, N"), plt.legend()
plt.savefig(sys.argv[3])
print(f"{np.count_nonzero(log.state)} of {len(log)} ticks in contact, at most {np.linalg.norm(log.force_n, axis=1).max():.2f} N")
