import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.laws.flaws import Flaws, draw_flaws, join
from engine.scene.material import FractureRules, named
from engine.scene.scene import Scene, Sphere
from engine.simulation.initial_conditions import all_flaws
from tests.helpers.parameter_sets import rules_of

COVERED, LISTED = rules_of("sugiura2018"), rules_of("talk")
RULES = pytest.mark.parametrize("rule", [COVERED, LISTED], ids=["covered", "2NlnN"])


def draw(particles: int, rule: FractureRules, seed: int = 1, **material: float) -> Flaws:
    body = Sphere(radius=50e3, particles=particles, material=named("basalt", **material))
    return draw_flaws(body, rule, np.random.default_rng(seed))


def expected_strains(count: int, k: float = 4e35, m: float = 9.0, radius: float = 50e3) -> np.ndarray:
    """Activation strains eps_j = [j / (k V)]^(1/m)."""
    return np.array((np.arange(1, count + 1) / (k * 4.0 / 3.0 * np.pi * radius**3)) ** (1.0 / m))


@RULES
@given(particles=st.integers(1, 300), seed=st.integers(0, 2**32))
def test_every_flaw_has_one_owner_and_strains_rise_within_it(rule, particles, seed):
    flaws = draw(particles, rule, seed)
    assert flaws.first[0] == 0 and flaws.first[-1] == len(flaws.strain) and len(flaws.first) == particles + 1
    assert (np.diff(flaws.first) >= 0).all()
    for begin, end in zip(flaws.first[:-1], flaws.first[1:], strict=True):
        assert (np.diff(flaws.strain[begin:end]) > 0.0).all()
    np.testing.assert_allclose(np.sort(flaws.strain), expected_strains(len(flaws.strain)), rtol=1e-14)


@given(particles=st.integers(1, 300), seed=st.integers(0, 2**32))
def test_covered_stops_with_the_flaw_that_covers_the_last_particle(particles, seed):
    flaws = draw(particles, COVERED, seed)
    counts = np.diff(flaws.first)
    assert counts.min() >= 1
    strongest = int(np.argmax(flaws.strain))
    assert counts[np.searchsorted(flaws.first, strongest, side="right") - 1] == 1


@pytest.mark.parametrize(("particles", "count"), [(1, 0), (2, 3), (100, 921), (20000, 396140)])
def test_the_listed_rule_draws_2_n_ln_n_flaws(particles, count):
    assert len(draw(particles, LISTED).strain) == count


def test_covered_needs_about_n_times_ln_n_plus_the_euler_constant():
    counts = [len(draw(2000, COVERED, seed).strain) for seed in range(60)]
    # the coupon collector: mean N (ln N + 0.5772), standard deviation pi/sqrt(6) N = 1.28 N
    expected = 2000 * (np.log(2000) + 0.5772)
    assert abs(np.mean(counts) - expected) < 4 * 1.28 * 2000 / np.sqrt(60)


def test_one_particle_holds_exactly_one_flaw_if_covered():
    assert np.array_equal(draw(1, COVERED).first, [0, 1])


def test_strains_of_the_published_case_span_the_published_range():
    flaws = draw(20000, COVERED)
    assert flaws.strain.min() == pytest.approx(2.56e-6, rel=5e-3)
    assert flaws.strain.max() == pytest.approx(1.0e-5, rel=3e-2)


@pytest.mark.parametrize("m", [3.0, 8.5, 9.0])
def test_number_of_flaws_grows_as_the_weibull_power_of_strain(m):
    strain = np.sort(draw(3000, COVERED, weibull_m=m).strain)
    slope, _ = np.polyfit(np.log(strain), np.log(np.arange(1, len(strain) + 1)), 1)
    assert slope == pytest.approx(m, rel=1e-9)


@RULES
def test_flaws_fall_on_particles_at_random(rule):
    flaws = draw(5000, rule)
    counts = np.diff(flaws.first)
    mean = len(flaws.strain) / 5000
    # independent draws: the variance of the count equals its mean, within sqrt(2/5000) = 2% a standard deviation
    assert counts.var() == pytest.approx(mean, rel=0.1)
    weakest = np.repeat(np.arange(5000), counts)[np.argsort(flaws.strain)[:5000]]
    assert weakest.mean() == pytest.approx(2500, abs=4 * 5000 / np.sqrt(12 * 5000))


@RULES
def test_same_seed_same_flaws_other_seed_other_owners(rule):
    one, same, other = draw(200, rule, 1), draw(200, rule, 1), draw(200, rule, 2)
    assert np.array_equal(one.first, same.first) and np.array_equal(one.strain, same.strain)
    assert not np.array_equal(one.first, other.first)


def test_joined_flaws_keep_each_bodys_particles_apart():
    parts = [draw(n, COVERED, seed=n) for n in (1, 5, 30)]
    joined = join(parts)
    particle = 0
    for part in parts:
        for begin, end in zip(part.first[:-1], part.first[1:], strict=True):
            found = joined.strain[joined.first[particle] : joined.first[particle + 1]]
            assert np.array_equal(found, part.strain[begin:end])
            particle += 1
    assert particle == len(joined.first) - 1 == 36
    assert joined.first.dtype == np.int32


def test_bodies_of_one_scene_draw_different_flaws():
    body = Sphere(radius=1e3, particles=50)
    flaws = all_flaws(Scene(bodies=(body, body), end_time=1.0))
    counts = np.diff(flaws.first)
    assert not np.array_equal(counts[:50], counts[50:])
