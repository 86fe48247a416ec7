# SPDX-License-Identifier: Apache-2.0
"""Judges a grasp as fdcg grasp does, by other means: CVXOPT's second-order cone programmes. Written from the definitions."""
import math

import numpy
from cvxopt import matrix, solvers

TOLERANCES = (1e-10, 1e-9, 1e-8, 1e-7)  # the first that its arithmetic stands
STEP_TOLERANCES = (1e-8, 1e-7)  # of a step of a descent, whose value is computed from where it ends


def frame(normal):
    """Two unit vectors at right angles to a unit normal."""
    axis = numpy.eye(3)[numpy.argmin(numpy.abs(normal))]
    first = numpy.cross(normal, axis)
    first /= numpy.linalg.norm(first)
    return first, numpy.cross(normal, first)


def wrench_maps(report):
    """Of each contact the matrix from (press, two tangentials over mu, with soft fingers moment over torsion) to the wrench;
    torques over the torque scale."""
    centre = numpy.array(report["object"]["centre_m"])
    scale = report["object"]["torque_scale_m"]
    maps = []
    for contact in report["contacts"]:
        arm = numpy.array(contact["point_m"]) - centre
        normal = numpy.array(contact["inward"])
        first, second = frame(normal)
        push = lambda force: numpy.concatenate((force, numpy.cross(arm, force) / scale))
        columns = [push(normal), contact["mu"] * push(first), contact["mu"] * push(second)]
        if contact["torsion_m"] > 0:
            columns.append(numpy.concatenate((numpy.zeros(3), contact["torsion_m"] / scale * normal)))
        maps.append(numpy.column_stack(columns))
    return maps


def solve(cost, cones, rows=None, equals=None, tolerances=TOLERANCES):
    """Minimises cost.x with |(M x)[1:] + d[1:]| <= (M x)[0] + d[0] for each (M, d) of cones and rows x = equals."""
    arguments = {"Gq": [matrix(-m) for m, _ in cones], "hq": [matrix(numpy.asarray(d, float)) for _, d in cones]}
    if rows is not None:
        arguments.update(A=matrix(rows), b=matrix(numpy.asarray(equals, float)))
    for tolerance in tolerances:
        solvers.options.update(show_progress=False, abstol=tolerance, reltol=tolerance, feastol=tolerance)
        try:
            done = solvers.socp(matrix(numpy.asarray(cost, float)), **arguments)
        except (ValueError, ArithmeticError):
            continue
        if done["status"] == "optimal":
            return numpy.array(done["x"]).ravel()
    return None


def contact_variables(maps):
    """Where each contact's variables start, and their number."""
    ends = numpy.cumsum([m.shape[1] for m in maps])
    return [0, *ends[:-1]], ends[-1]


def cone_of(start, width, variables):
    inside = numpy.zeros((width, variables))
    inside[:, start:start + width] = numpy.eye(width)
    return inside


def support(maps, direction):
    """The most of a contact pressing with 1 N along a direction."""
    return max((m.T @ direction)[0] + numpy.linalg.norm((m.T @ direction)[1:]) for m in maps)


def closure_depth(maps):
    """The largest s such that presses of 1 N together balance with each at least s inside its cone; and the least singular value
    of all that the contacts can give. Closure: both above zero."""
    starts, count = contact_variables(maps)
    cones = []
    rows = numpy.zeros((7, count + 1))
    for start, m in zip(starts, maps):
        inside = cone_of(start, m.shape[1], count + 1)
        inside[0, -1] = -1
        cones.append((inside, numpy.zeros(m.shape[1])))
        rows[:6, start:start + m.shape[1]] = m
        rows[6, start] = 1
    span = numpy.linalg.svd(numpy.hstack(maps), compute_uv=False)
    keep = numpy.linalg.matrix_rank(rows[:6, :-1], tol=1e-9)
    if keep < 6:
        return None, 0.0
    cost = numpy.zeros(count + 1)
    cost[-1] = -1
    x = solve(cost, cones, rows, numpy.eye(7)[6])
    return (None if x is None else x[-1]), span[-1]


def descend(maps, direction, steps=200):
    """Down to a local minimum of the support over unit directions: the point of {u: support <= 1} farthest along the last one."""
    value = support(maps, direction)
    for _ in range(steps):
        x = solve(-direction, [(numpy.vstack((-m[:, 0], m[:, 1:].T)), numpy.eye(m.shape[1])[0]) for m in maps],
                  tolerances=STEP_TOLERANCES)
        if x is None:
            break
        following = x / numpy.linalg.norm(x)
        lower = support(maps, following)
        if lower > value - 1e-9:
            break
        direction, value = following, lower
    return value, direction


def load_factor(maps, load, caps, total):
    """The largest multiple of a load (6 numbers, torque over the scale) that presses within caps and total balance."""
    starts, count = contact_variables(maps)
    cones = []
    rows = numpy.zeros((6, count + 1))
    for start, m, cap in zip(starts, maps, caps):
        cones.append((cone_of(start, m.shape[1], count + 1), numpy.zeros(m.shape[1])))
        rows[:, start:start + m.shape[1]] = m
        if math.isfinite(cap):
            cones.append((-numpy.eye(1, count + 1, start), [cap]))
    if math.isfinite(total):
        together = numpy.zeros((1, count + 1))
        together[0, starts] = -1
        cones.append((together, [total]))
    rows[:, -1] = load
    cost = numpy.zeros(count + 1)
    cost[-1] = -1
    return solve(cost, cones, rows, numpy.zeros(6))[-1]
