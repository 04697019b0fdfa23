"""Two point masses before contact: where they came from, and where they go (engine/physics.md, section 8)."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from engine.constants import G_NEWTON

NEAREST_START = 1.1
"""A bound pair whose apocentre is nearer than this many contact distances starts at this distance instead."""

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Approach:
    """Relative state of the projectile at the start.

    Attributes:
        position: relative position [m], shape [3].
        velocity: relative velocity [m/s], shape [3].
        duration: time from here to point-mass contact [s].
        start: `separation`, or `apocentre` or `nearest` when the pair never was as far out as asked.
    """

    position: Array
    velocity: Array
    duration: float
    start: str


def approach_state(position: Array, velocity: Array, total_mass: float, separation: float) -> Approach:
    """Relative state at `separation`, found by integrating the two-body problem backward from contact.

    Args:
        position: relative position at contact [m], shape [3].
        velocity: relative velocity at contact [m/s], shape [3].
        total_mass: mass of both bodies [kg]; 0 for bodies without gravity.
        separation: distance of the centres at the start [m].
    """
    gm = G_NEWTON * total_mass
    farthest = apocentre(position, velocity, gm)
    if farthest <= NEAREST_START * float(np.linalg.norm(position)):
        return _straight_back(position, velocity, gm)
    state, duration, arrived = _backward(np.concatenate([position, velocity]), gm, separation)
    return Approach(state[:3], state[3:], duration, "separation" if arrived else "apocentre")


def orbit(position: Array, velocity: Array, total_mass: float, duration: float) -> tuple[Array, Array]:
    """Relative position [m] and velocity [m/s] after some time.

    Args:
        position: relative position [m], shape [3].
        velocity: relative velocity [m/s], shape [3].
        total_mass: mass of both bodies [kg]; 0 for bodies without gravity.
        duration: time from then on [s].
    """
    state = np.concatenate([position, velocity])
    path = solve_ivp(_rate(G_NEWTON * total_mass), (0.0, duration), state, method="DOP853", rtol=1e-12, atol=1e-9)
    return path.y[:3, -1], path.y[3:, -1]


def apocentre(position: Array, velocity: Array, gm: float) -> float:
    """Largest distance [m] of a two-body orbit; infinite when unbound."""
    energy = 0.5 * float(velocity @ velocity) - gm / float(np.linalg.norm(position))
    if energy >= 0.0:
        return float("inf")
    momentum = float(np.linalg.norm(np.cross(position, velocity)))
    eccentricity = float(np.sqrt(max(0.0, 1.0 + 2.0 * energy * (momentum / gm) ** 2)))
    return -gm / (2.0 * energy) * (1.0 + eccentricity)


def _rate(gm: float) -> Callable[[float, Array], Array]:
    def rate(time: float, state: Array) -> Array:
        return np.concatenate([state[3:], -gm * state[:3] / np.linalg.norm(state[:3]) ** 3])

    return rate


def _straight_back(position: Array, velocity: Array, gm: float) -> Approach:
    """Bodies drawn apart along their line of centres, with the radial velocity and the angular momentum of contact.

    They fall back, and so meet faster.
    """
    contact, distance = float(np.linalg.norm(position)), _distance(float(np.linalg.norm(position)))
    distance.terminal = True  # type: ignore[attr-defined]
    radial = float(velocity @ position) / contact**2 * position
    start = np.concatenate([position * NEAREST_START, radial + (velocity - radial) / NEAREST_START])
    longest = 10.0 * (contact**3 / gm) ** 0.5
    path = solve_ivp(_rate(gm), (0.0, longest), start, method="DOP853", events=distance, rtol=1e-12, atol=1e-9)
    return Approach(start[:3], start[3:], float(path.t[-1]), "nearest")


def _turning_point(time: float, state: Array) -> float:
    return float(np.dot(state[:3], state[3:]))


def _distance(separation: float) -> Callable[[float, Array], float]:
    def beyond(time: float, state: Array) -> float:
        return float(np.linalg.norm(state[:3]) - separation)

    return beyond


def _backward(contact: Array, gm: float, separation: float) -> tuple[Array, float, bool]:
    """State where the pair was at `separation` or else at its apocentre, the time from there, and whether it was."""

    events = [_distance(separation), _turning_point]
    for event in events:
        event.terminal, event.direction = True, 1.0  # type: ignore[attr-defined]
    distance = float(np.linalg.norm(contact[:3]))
    longest = -1e6 * distance / float(np.linalg.norm(contact[3:]))
    bound = np.isfinite(apocentre(contact[:3], contact[3:], gm))
    step = 0.01 * (distance**3 / gm) ** 0.5 if bound else np.inf  # so that none passes the separation twice unseen
    path = solve_ivp(
        _rate(gm), (0.0, longest), contact, method="DOP853", events=events, rtol=1e-12, atol=1e-9, max_step=step
    )
    states, times = np.concatenate([e for e in path.y_events if len(e)]), np.concatenate(path.t_events)
    return states[0], -float(times[0]), len(path.t_events[0]) > 0
