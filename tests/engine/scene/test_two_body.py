import signal
from collections.abc import Iterator

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from engine.scene.two_body import Approach, apocentre, approach_state, orbit
from tests.helpers.device import Array

G_N, R = 6.6743e-11, 50e3
MU = G_N * 2.0 * 2700.0 * 4.0 / 3.0 * np.pi * R**3
CONTACT = 2.0 * R
ESCAPE = np.sqrt(2.0 * MU / CONTACT)


def contact(v: float, degrees: float) -> tuple[Array, Array]:
    angle = np.deg2rad(degrees)
    return CONTACT * np.array([np.cos(angle), np.sin(angle), 0.0]), np.array([-v, 0.0, 0.0])


def pair(v: float, degrees: float, start: float = 2.0, mu: float = MU) -> Approach:
    return approach_state(*contact(v, degrees), mu / G_N, start * CONTACT)


def energy(x: Array, v: Array) -> float:
    return float(0.5 * v @ v - MU / np.linalg.norm(x))


def in_orbit(found: Approach, v: float, degrees: float) -> None:
    """Energy, angular momentum and the direction of the apsides are those at contact."""
    x0, v0 = contact(v, degrees)
    assert abs(energy(found.position, found.velocity) - energy(x0, v0)) < 1e-9 * (0.5 * v**2 + MU / CONTACT)
    momentum, momentum0 = np.cross(found.position, found.velocity), np.cross(x0, v0)
    assert np.abs(momentum - momentum0).max() < 1e-9 * CONTACT * v
    laplace, laplace0 = (
        np.cross(u, np.cross(x, u)) / MU - x / np.linalg.norm(x)
        for x, u in ((found.position, found.velocity), (x0, v0))
    )
    assert np.abs(laplace - laplace0).max() < 1e-8 * (1.0 + v**2 * CONTACT / MU)


def test_the_published_impact_starts_with_195_m_s_at_four_radii():
    for angle in (0.0, 5.0, 15.0, 45.0, 80.0):
        found = pair(200.0, angle)
        assert np.linalg.norm(found.position) == pytest.approx(4.0 * R, rel=1e-12)
        assert np.linalg.norm(found.velocity) == pytest.approx(195.2, abs=0.05)
        assert found.start == "separation"


def test_escape_speed_is_that_of_the_published_pair():
    assert pytest.approx(61.4, abs=0.05) == ESCAPE


@given(v=st.floats(62.0, 5000.0), degrees=st.floats(0.0, 89.9), start=st.floats(1.01, 20.0))
def test_unbound_pairs_start_at_the_separation_on_the_same_orbit(v, degrees, start):
    found = pair(v, degrees, start)
    assert found.start == "separation"
    assert np.linalg.norm(found.position) == pytest.approx(start * CONTACT, rel=1e-9)
    assert found.position @ found.velocity < 0.0
    assert found.duration > 0.0
    in_orbit(found, v, degrees)


@given(v=st.floats(1.0, 61.0), degrees=st.floats(0.0, 89.9), start=st.floats(1.15, 5.0))
def test_bound_pairs_start_no_farther_than_they_ever_were(v, degrees, start):
    assume(abs(far_point(v, degrees) / start - 1.0) > 1e-2)
    found = pair(v, degrees, start)
    distance = np.linalg.norm(found.position) / CONTACT
    if found.start == "nearest":
        assert distance == pytest.approx(1.1)
        return
    assert 1.1 - 1e-9 < distance <= start * (1.0 + 1e-9)
    in_orbit(found, v, degrees)
    if found.start == "apocentre":
        turning = found.position @ found.velocity / (np.linalg.norm(found.position) * v)
        assert abs(turning) < 1e-6
    else:
        assert distance == pytest.approx(start, rel=1e-9)


def far_point(v: float, degrees: float) -> float:
    """Apocentre in contact distances, from the quadratic for the apsides E r^2 + mu r - l^2/2 = 0."""
    E, momentum = 0.5 * v**2 - MU / CONTACT, CONTACT * v * np.sin(np.deg2rad(degrees))
    return float((-MU - np.sqrt(max(MU**2 + 2.0 * E * momentum**2, 0.0))) / (2.0 * E) / CONTACT)


@given(v=st.floats(1.0, 61.0), degrees=st.floats(0.0, 90.0))
def test_apocentre_is_the_far_end_of_the_ellipse(v, degrees):
    # near a circle the two ends of the orbit are known to the root of round-off only
    assert apocentre(*contact(v, degrees), MU) / CONTACT == pytest.approx(far_point(v, degrees), rel=1e-7)


def test_an_unbound_pair_has_no_apocentre():
    assert apocentre(*contact(ESCAPE * 1.000001, 30.0), MU) == np.inf


@pytest.fixture
def impatient() -> Iterator[None]:
    """Ends a search for a start that would go on for ever."""

    def give_up(number: int, frame: object) -> None:
        raise TimeoutError("no start found in three seconds")

    before = signal.signal(signal.SIGALRM, give_up)
    signal.alarm(3)
    yield
    signal.alarm(0)
    signal.signal(signal.SIGALRM, before)


@pytest.mark.usefixtures("impatient")
@pytest.mark.parametrize("degrees", [0.0, 15.0, 80.0])
@pytest.mark.parametrize("excess", [-1e-6, 0.0, 1e-6, 1e-4, 1e-3])
def test_a_pair_that_turns_round_close_to_the_separation_starts_there(degrees, excess):
    far = 2.0 * (1.0 + excess)
    across = np.sin(np.deg2rad(degrees)) / far
    v = np.sqrt(2.0 * MU / CONTACT * (1.0 - 1.0 / far) / (1.0 - across**2))
    found = pair(v, degrees)
    assert np.linalg.norm(found.position) / CONTACT == pytest.approx(min(far, 2.0), rel=1e-5)
    in_orbit(found, v, degrees)
    axis = -MU / (2.0 * energy(*contact(v, degrees)))
    assert found.duration < np.pi * np.sqrt(axis**3 / MU), "within the last half of the orbit before contact"


def test_starts_of_slow_pairs():
    assert pair(62.0, 15.0).start == "separation"
    assert pair(50.0, 15.0).start == "separation"
    assert pair(43.0, 0.0).start == "apocentre"
    assert pair(30.0, 15.0).start == "apocentre"
    assert pair(15.0, 15.0).start == "nearest"


def test_time_of_free_fall_from_rest_at_the_apocentre():
    v = 40.0
    found = pair(v, 0.0)
    far = np.linalg.norm(found.position)
    x = CONTACT / far
    expected = np.sqrt(far**3 / (2.0 * MU)) * (np.sqrt(x * (1.0 - x)) + np.arccos(np.sqrt(x)))
    assert found.start == "apocentre"
    assert found.duration == pytest.approx(expected, rel=1e-6)


@given(v=st.floats(0.01, 5000.0), degrees=st.floats(0.0, 90.0), start=st.floats(1.01, 20.0))
def test_without_gravity_the_path_is_straight(v, degrees, start):
    found = pair(v, degrees, start, mu=0.0)
    x0, v0 = contact(v, degrees)
    np.testing.assert_allclose(found.position + found.duration * found.velocity, x0, atol=1e-6 * CONTACT)
    np.testing.assert_allclose(found.velocity, v0, rtol=1e-12)
    assert np.linalg.norm(found.position) == pytest.approx(start * CONTACT, rel=1e-9)


def test_a_grazing_impact_starts_on_its_orbit():
    in_orbit(pair(200.0, 90.0), 200.0, 90.0)


@given(v=st.floats(0.1, 20.0), degrees=st.floats(0.0, 80.0))
def test_the_nearest_start_lies_on_the_line_of_centres(v, degrees):
    assume(far_point(v, degrees) < 1.099)
    found = pair(v, degrees)
    x0, v0 = contact(v, degrees)
    assert found.start == "nearest"
    np.testing.assert_allclose(found.position, 1.1 * x0)
    np.testing.assert_allclose(np.cross(found.position, found.velocity), np.cross(x0, v0), atol=1e-9 * CONTACT * v)
    np.testing.assert_allclose(found.velocity @ x0, v0 @ x0, rtol=1e-9, atol=1e-9 * CONTACT * v)
    there, _ = orbit(found.position, found.velocity, MU / G_N, found.duration)
    assert np.linalg.norm(there) == pytest.approx(CONTACT, rel=1e-9)


@given(v=st.floats(1.0, 500.0), degrees=st.floats(0.0, 90.0), share=st.floats(0.0, 1.0))
def test_the_orbit_leads_from_the_start_to_contact(v, degrees, share):
    found = pair(v, degrees)
    assume(found.start != "nearest")
    x0, v0 = contact(v, degrees)
    there = orbit(found.position, found.velocity, MU / G_N, share * found.duration)
    here = orbit(*there, MU / G_N, (1.0 - share) * found.duration)
    np.testing.assert_allclose(here[0], x0, atol=1e-6 * CONTACT)
    np.testing.assert_allclose(here[1], v0, atol=1e-6 * v)
