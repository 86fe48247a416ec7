# SPDX-License-Identifier: Apache-2.0
"""A slice through a mesh's signed distance: python3 distance.py cube.obj 0.01 distance.png"""
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import fdcg

graph = fdcg.compile(fdcg.read(sys.argv[1]), metres_per_unit=float(sys.argv[2]))
low, high = graph.bounds_m
size = (high - low).max()
x, y = np.meshgrid(np.linspace(low[0] - size / 2, high[0] + size / 2, 200), np.linspace(low[1] - size / 2, high[1] + size / 2, 200))
points = np.stack([x, y, np.full_like(x, (low[2] + high[2]) / 2)], axis=-1).reshape(-1, 3)
distance_m = graph.signed_distance(points).reshape(x.shape)
plt.contourf(x, y, distance_m * 1000, 20)
plt.colorbar(label="distance, mm")
plt.contour(x, y, distance_m, [0], colors="black")
plt.axis("equal")
plt.savefig(sys.argv[3])
print(f"deepest {-distance_m.min() * 1000:.2f} mm")
