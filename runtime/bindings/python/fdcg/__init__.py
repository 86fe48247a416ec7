# SPDX-License-Identifier: Apache-2.0
"""Feel a 3D model: contact forces with friction on polygon meshes, as fdcg's runtime computes them, bit for bit.

    import fdcg
    graph = fdcg.compile(fdcg.read("cube.obj"), metres_per_unit=0.01)
    log = fdcg.replay(graph, path_m)        # (n, 3) metres in the object's frame, one row a tick
    log.force_n                             # (n, 3) newtons on the hand

Lengths are metres, forces newtons, times seconds; frames are right-handed. Meshes are in the units of their files until compile
gives them metres_per_unit. Errors of the library are fdcg.Error, a ValueError.
"""
import numpy as np

from ._core import (Contact, ContactInfo, Effect, Error, FingerId, Graph, Hits, Issue, Mesh, ObjectId, Params, Pose, Relief, Report,
                    Result, Scene, Surface, __version__, box, compile, cylinder, grasp, plane, read, repair, result_dtype, sphere, validate)

__all__ = ["Contact", "ContactInfo", "Effect", "Error", "FingerId", "Graph", "Hits", "Issue", "Mesh", "ObjectId", "Params", "Pose",
           "Relief", "Report", "Result", "Scene", "Surface", "__version__", "box", "compile", "cylinder", "grasp", "plane", "read", "repair", "replay",
           "result_dtype", "sphere", "states", "validate"]

#: names of the numbers in a log's `state`
states = ("free", "face", "edge", "vertex")


def replay(graph, hips_m, params=None, out=None, relief=None, effects=()):
    """Steps a new contact along a path, a tick for each row of hips_m (n, 3).

    Returns a record array with an entry a tick: force_n and god_object_m (n, 3), state, feature, slipping, transitions, flags. Its
    fields are views of one block of memory, `out` if that is given. `relief` and `effects` as Contact has them; god_object_m is
    that of the flat surface.
    """
    return Contact(graph, params, relief, list(effects)).path(hips_m, out).view(np.recarray)
