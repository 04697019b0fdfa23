"""The clock alone, stepped as a transfer does."""

import pytest
import taichi as ti

from engine.state.clock import FAULT_INVERTED, Clock

pytestmark = pytest.mark.usefixtures("taichi")


@ti.kernel
def take_step(clock: ti.template(), rate: ti.f64) -> ti.i32:
    clock.begin_step()
    if clock.running[None] == 1:
        clock.report_rate(rate)
        clock.report_rate(0.5 * rate)
    return clock.running[None]


@ti.kernel
def report_fault(clock: ti.template(), p: ti.i32):
    clock.report_fault(FAULT_INVERTED, p)


@ti.kernel
def report_moved_out(clock: ti.template()):
    clock.report_moved_out()


def clock_until(pause: float, end: float = 10.0) -> Clock:
    clock = Clock(start=0.0, end=end, longest_step=4.0)
    clock.pause_time[None] = pause
    return clock


def test_the_next_step_follows_from_the_highest_rate_reported_up_to_the_longest():
    clock = clock_until(10.0)
    take_step(clock, 2.0)
    assert clock.dt[None] == 4.0
    take_step(clock, 0.01)
    assert clock.dt[None] == 0.5


def test_steps_grow_by_a_quarter_at_most_and_shrink_at_once():
    clock, lengths = clock_until(10.0), []
    clock.rate[None] = 2.0
    for rate in (0.01, 0.01, 0.01, 4.0, 0.01):
        take_step(clock, rate)
        lengths.append(clock.dt[None])
    assert lengths == [0.5, 0.625, 0.78125, 0.9765625, 0.25]
    assert (clock.time[None], clock.step[None]) == (sum(lengths), 5)


def test_forces_act_between_the_middles_of_steps():
    """First from the start to the middle of the first step, and never for longer than one and a half steps."""
    clock, kicks, rates = clock_until(10.0), [], (1.0, 2.0, 8.0)
    for rate in rates:
        clock.rate[None] = rate
        take_step(clock, rate)
        kicks.append(clock.kick[None])
    assert kicks == [0.5, 0.5 * (1.0 + 0.5), 0.5 * (2.0 * 0.125 + 0.125)]


def test_the_last_step_ends_on_the_end_exactly():
    clock = clock_until(0.3, end=0.3)
    clock.rate[None] = 1.0 / 0.1
    assert [take_step(clock, 1.0 / 0.1) for _ in range(5)] == [1, 1, 1, 0, 0]
    assert clock.time[None] == 0.3
    assert clock.dt[None] == pytest.approx(0.1) and clock.dt[None] != 0.1


def test_a_last_step_that_the_end_cuts_short_keeps_the_kick_and_the_next_step_whole():
    clock = clock_until(1.125, end=1.125)
    clock.rate[None] = 1.0
    assert [take_step(clock, 0.25) for _ in range(2)] == [1, 1]
    assert (clock.dt[None], clock.kick[None]) == (0.125, 0.5 * (1.0 + 0.125))
    assert clock.rate[None] == 1.0 / (1.25 * 1.25)


def test_steps_past_the_pause_do_nothing():
    clock = clock_until(5.0)
    assert [take_step(clock, 0.0) for _ in range(4)] == [1, 1, 0, 0]
    assert (clock.time[None], clock.step[None]) == (8.0, 2)


def test_a_particle_out_of_its_block_pauses_and_a_fault_stops():
    clock = clock_until(10.0)
    report_moved_out(clock)
    assert not take_step(clock, 0.0)
    clock.moved_out[None] = 0
    assert take_step(clock, 0.0)
    for p in (7, 3, 5):
        report_fault(clock, p)
    assert not take_step(clock, 0.0)
    assert (clock.fault[None], clock.fault_particle[None]) == (FAULT_INVERTED, 3)


def test_a_clock_that_is_read_and_written_goes_on_as_the_other():
    clock, other = clock_until(10.0), clock_until(10.0)
    take_step(clock, 3.0)
    other.write(clock.read())
    assert other.read() == clock.read() != clock_until(10.0).read()
    for each in (clock, other):
        take_step(each, 0.7)
    assert other.read() == clock.read()
