"""The plants of `cargo bench -p simgap-simulate --bench peer` in numba and in SciPy.

Asked line by line on standard input, so that both sides take turns in one run:

    <method> <plant> <sets>        linear, friction or axis; 1 or 8 sets

The answer is one line: ns per sample and set, then the last output of each set. Every method is called once before it is timed.
Needs `pip install numba scipy`.
"""

import sys
from math import copysign, cos, pi, sin, sqrt
from time import perf_counter_ns

import numpy as np
from numba import njit
from scipy.integrate import solve_ivp
from scipy.linalg import expm
from scipy.signal import StateSpace, lsim

SAMPLES = 60_000
STEP = 1e-3
#: Samples that are enough to time SciPy's steps.
FEW = 2_000

TIME = STEP * np.arange(SAMPLES)


def size(k, sets):
    """Factor on the values of a set."""
    return 1 + 0.05 * k / sets


def hold(mass, damping, stiffness):
    """Phi, Gamma 0 and Gamma 1 of a step under a force that is linear over it."""
    n = len(mass)
    inverse = np.linalg.inv(mass)
    big = np.zeros((4 * n, 4 * n))
    big[:n, n : 2 * n] = np.eye(n)
    big[n : 2 * n, :n] = -inverse @ stiffness
    big[n : 2 * n, n : 2 * n] = -inverse @ damping
    big[n : 2 * n, 2 * n : 3 * n] = inverse
    big *= STEP
    big[2 * n : 3 * n, 3 * n :] = np.eye(n)
    found = expm(big)
    end = found[: 2 * n, 3 * n :]
    return found[: 2 * n, : 2 * n], found[: 2 * n, 2 * n : 3 * n] - end, end


# Two masses, linear, a force on the first.


def two_masses(factor):
    return (
        np.diag([1.0, 0.5]),
        np.array([[2.0, -0.6], [-0.6, 0.6]]) * factor,
        np.array([[1800.0, -900.0], [-900.0, 900.0]]) * factor,
    )


FORCE = 12 * np.sin(25 * TIME) + 9 * np.cos(33 * TIME) + 3 * np.sin(9 * TIME)


@njit(cache=True)
def march_linear(phi, gamma0, gamma1, force, out):
    a, b, c, d = phi[0], phi[1], phi[2], phi[3]
    a0, a1, a2, a3 = a
    b0, b1, b2, b3 = b
    c0, c1, c2, c3 = c
    d0, d1, d2, d3 = d
    p0, p1, p2, p3 = gamma0
    q0, q1, q2, q3 = gamma1
    w = x = y = z = 0.0
    out[0] = x
    before = force[0]
    for k in range(1, force.size):
        after = force[k]
        nw = p0 * before + q0 * after + (a0 * w + a1 * x) + (a2 * y + a3 * z)
        nx = p1 * before + q1 * after + (b0 * w + b1 * x) + (b2 * y + b3 * z)
        ny = p2 * before + q2 * after + (c0 * w + c1 * x) + (c2 * y + c3 * z)
        nz = p3 * before + q3 * after + (d0 * w + d1 * x) + (d2 * y + d3 * z)
        w, x, y, z = nw, nx, ny, nz
        before = after
        out[k] = x


@njit(cache=True, fastmath=True)
def march_linear_sets(phi, gamma0, gamma1, force, out):
    """Eight sets side by side: the last axis holds the sets."""
    state = np.zeros((4, 8))
    after = np.zeros((4, 8))
    for k in range(1, force.size):
        f0, f1 = force[k - 1], force[k]
        for i in range(4):
            for s in range(8):
                after[i, s] = (
                    gamma0[i, s] * f0
                    + gamma1[i, s] * f1
                    + phi[i, 0, s] * state[0, s]
                    + phi[i, 1, s] * state[1, s]
                    + phi[i, 2, s] * state[2, s]
                    + phi[i, 3, s] * state[3, s]
                )
        for i in range(4):
            for s in range(8):
                state[i, s] = after[i, s]
        for s in range(8):
            out[k, s] = state[1, s]


def linear_matrices(sets):
    held = [hold(*two_masses(size(k, sets))) for k in range(sets)]
    phi = np.array([h[0] for h in held])
    gamma0 = np.array([h[1][:, 0] for h in held])
    gamma1 = np.array([h[2][:, 0] for h in held])
    return phi, gamma0, gamma1


def numba_linear(sets):
    phi, gamma0, gamma1 = linear_matrices(sets)
    out = np.zeros((sets, SAMPLES))
    rows = [
        (tuple(map(tuple, phi[s])), tuple(gamma0[s]), tuple(gamma1[s]))
        for s in range(sets)
    ]

    def call():
        for s in range(sets):
            march_linear(*rows[s], FORCE, out[s])
        return out[:, -1]

    return call, SAMPLES


def numba_sets_linear(sets):
    phi, gamma0, gamma1 = linear_matrices(sets)
    parts = [
        np.ascontiguousarray(np.moveaxis(m, 0, -1)) for m in (phi, gamma0, gamma1)
    ]
    out = np.zeros((SAMPLES, sets))

    def call():
        march_linear_sets(*parts, FORCE, out)
        return out[-1]

    return call, SAMPLES


def scipy_linear(sets):
    systems = []
    for k in range(sets):
        mass, damping, stiffness = two_masses(size(k, sets))
        inverse = np.linalg.inv(mass)
        a = np.block(
            [[np.zeros((2, 2)), np.eye(2)], [-inverse @ stiffness, -inverse @ damping]]
        )
        b = np.concatenate([np.zeros(2), inverse[:, 0]])[:, None]
        systems.append(StateSpace(a, b, np.eye(4)[1:2], np.zeros((1, 1))))

    def call():
        return np.array([lsim(system, FORCE, TIME)[1][-1] for system in systems])

    return call, SAMPLES


# One mass with dry friction that sticks and a cubic spring.

FRICTION = 1.5
CUBIC = 2e6
TOLERANCE = 1e-8


@njit(cache=True)
def march_friction(phi, gamma0, gamma1, level, cubic, force, out):
    """The steps of Moreau for the friction, Newton's method for the spring."""
    a, b, c, d = phi[0, 0], phi[0, 1], phi[1, 0], phi[1, 1]
    p, q = gamma0[0], gamma0[1]
    g, h = gamma1[0], gamma1[1]
    held_x, held_v = p + g, q + h
    x = v = spring = 0.0
    out[0] = x
    for k in range(1, force.size):
        before, after = force[k - 1] - spring, force[k]
        free_x = p * before + g * after + a * x + b * v
        free_v = q * before + h * after + c * x + d * v
        start = v
        if abs(start) <= 1e-9 * abs(free_v):
            start = 0.0
        dry = 0.0
        for _ in range(8):
            without = free_v - h * spring
            # Dry friction: slides on, sticks or turns.
            way = copysign(1.0, without if start == 0.0 else start)
            slid = way * level
            ahead = without - held_v * slid
            if start == 0.0:
                dry = slid if abs(without) > held_v * level else without / held_v
            elif ahead * way >= 0.0:
                dry = slid
            elif abs(without - start) <= held_v * level:
                dry = without / held_v
            else:
                share = start / (start - ahead)
                dry = (2.0 * share - 1.0) * slid
            at = free_x - held_x * dry - g * spring
            residual = cubic * at * at * at - spring
            change = residual / (1.0 + 3.0 * cubic * at * at * g)
            spring += change
            if abs(change) <= TOLERANCE * abs(spring):
                break
        x = free_x - held_x * dry - g * spring
        v = free_v - held_v * dry - h * spring
        out[k] = x


def numba_friction(sets):
    held = [
        hold(
            np.array([[1.0]]),
            np.array([[2.0 * size(k, sets)]]),
            np.array([[900.0 * size(k, sets)]]),
        )
        for k in range(sets)
    ]
    parts = [
        (h[0].copy(), h[1][:, 0].copy(), h[2][:, 0].copy(), FRICTION * size(k, sets), CUBIC * size(k, sets))
        for k, h in enumerate(held)
    ]
    out = np.zeros((sets, SAMPLES))

    def call():
        for s in range(sets):
            march_friction(*parts[s], FORCE, out[s])
        return out[:, -1]

    return call, SAMPLES


def scipy_friction(sets):
    """Friction smoothed by a hyperbolic tangent: solvers of smooth equations know no sticking."""

    def call():
        last = []
        for s in range(sets):
            f = size(s, sets)

            def rate(t, z, f=f):
                x, v = z
                force = 12 * sin(25 * t) + 9 * cos(33 * t) + 3 * sin(9 * t)
                own = 900 * f * x + 2 * f * v + CUBIC * f * x * x * x
                return v, force - own - FRICTION * f * np.tanh(v / 1e-4)

            at = TIME[:FEW]
            found = solve_ivp(rate, (0, at[-1]), (0.0, 0.0), "LSODA", at, rtol=1e-6, atol=1e-9)
            last.append(found.y[0, -1])
        return np.array(last)

    return call, FEW


# The servo axis of ten states.

AREAS = (2e-3, 1.5e-3)
LEAKAGE = 5e-12
SUPPLY, TANK = 21e6, 0.0
GAIN = 6.6667e-4 / sqrt(3.5e6)
SPOOL = 2 * pi * 25.0
LAMINAR = 5e4

SET_POINT = 0.002 * (np.sin(2 * pi * 1.3 * TIME) + 0.5 * np.sin(2 * pi * 4.1 * TIME))


@njit(cache=True)
def flow(drop):
    return drop / sqrt(sqrt(drop * drop + LAMINAR * LAMINAR))


@njit(cache=True)
def axis_rate(z, reference, stiff1, stiff2):
    y, v, p1, p2, x, w, f1, f2, c1, c2 = z
    # Controller (8 s + 4)/(0.005 s^2 + s), filter 1/(1e-5 s^2 + 5e-3 s + 1).
    command = (8.0 * c2 + 4.0 * c1) / 0.005
    opening = GAIN * min(max(x, -1.0), 1.0)
    if x > 0.0:
        q1, q2 = opening * flow(SUPPLY - p1), -opening * flow(p2 - TANK)
    else:
        q1, q2 = opening * flow(p1 - TANK), -opening * flow(SUPPLY - p2)
    past = LEAKAGE * (p1 - p2)
    return (
        v,
        (AREAS[0] * p1 - AREAS[1] * p2 - 20000.0 * v) / 1000.0,
        stiff1 * (q1 - AREAS[0] * v - past),
        stiff2 * (q2 + AREAS[1] * v + past),
        w,
        SPOOL * SPOOL * (command - x) - 1.4 * SPOOL * w,
        f2,
        (y - f1 - 5e-3 * f2) / 1e-5,
        c2,
        reference - f1 - c2 / 0.005,
    )


@njit(cache=True)
def along(z, rate, step):
    return (
        z[0] + step * rate[0],
        z[1] + step * rate[1],
        z[2] + step * rate[2],
        z[3] + step * rate[3],
        z[4] + step * rate[4],
        z[5] + step * rate[5],
        z[6] + step * rate[6],
        z[7] + step * rate[7],
        z[8] + step * rate[8],
        z[9] + step * rate[9],
    )


@njit(cache=True)
def march_axis(stiff1, stiff2, reference, out):
    """Runge and Kutta's method of order four, one step a sample."""
    z = (0.0, 0.0, 9e6, 12e6, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    out[0] = 0.0
    for k in range(1, reference.size):
        r0, r1 = reference[k - 1], reference[k]
        half = 0.5 * (r0 + r1)
        a = axis_rate(z, r0, stiff1, stiff2)
        b = axis_rate(along(z, a, 0.5 * STEP), half, stiff1, stiff2)
        c = axis_rate(along(z, b, 0.5 * STEP), half, stiff1, stiff2)
        d = axis_rate(along(z, c, STEP), r1, stiff1, stiff2)
        z = along(z, a, STEP / 6)
        z = along(z, b, STEP / 3)
        z = along(z, c, STEP / 3)
        z = along(z, d, STEP / 6)
        out[k] = z[0]


def stiffnesses(factor):
    """Bulk modulus over the volumes of the chambers at half the stroke."""
    beta = 1.4e9 * 0.9 * factor
    return beta / (1e-4 + AREAS[0] * 0.1), beta / (1e-4 + AREAS[1] * 0.1)


def numba_axis(sets):
    out = np.zeros((sets, SAMPLES))

    def call():
        for s in range(sets):
            march_axis(*stiffnesses(size(s, sets)), SET_POINT, out[s])
        return out[:, -1]

    return call, SAMPLES


def scipy_axis(sets):
    def call():
        last = []
        for s in range(sets):
            stiff = stiffnesses(size(s, sets))

            def rate(t, z, stiff=stiff):
                at = 0.002 * (sin(2 * pi * 1.3 * t) + 0.5 * sin(2 * pi * 4.1 * t))
                return axis_rate.py_func(z, at, *stiff)

            at = TIME[:FEW]
            start = (0.0, 0.0, 9e6, 12e6) + 6 * (0.0,)
            found = solve_ivp(rate, (0, at[-1]), start, "LSODA", at, rtol=1e-6, atol=1e-9)
            last.append(found.y[0, -1])
        return np.array(last)

    return call, FEW


METHODS = {
    "numba": {"linear": numba_linear, "friction": numba_friction, "axis": numba_axis},
    "numba_sets": {"linear": numba_sets_linear},
    "scipy": {"linear": scipy_linear, "friction": scipy_friction, "axis": scipy_axis},
}


def main():
    ready = {}
    for line in sys.stdin:
        method, plant, sets = line.split()
        key = (method, plant, int(sets))
        if plant not in METHODS[method]:
            print(flush=True)
            continue
        if key not in ready:
            ready[key] = METHODS[method][plant](key[2])
            ready[key][0]()
        call, samples = ready[key]
        begun = perf_counter_ns()
        last = call()
        spent = perf_counter_ns() - begun
        print(spent / (samples * key[2]), *last, flush=True)


if __name__ == "__main__":
    main()
