"""What each variable of results.nc is: the one list of names, units and meanings (CF attributes)."""

from typing import NamedTuple

from analysis.remnant.ellipsoid import THIN
from analysis.remnant.fragments import LINKING_LENGTH
from analysis.remnant.settling import TOLERANCE, WINDOW
from engine.scene.collision import Collision
from engine.scene.keys import meaning_of, unit_of

DAMAGED = 0.5
"""A particle with more damage than this counts as damaged."""


class Variable(NamedTuple):
    """CF attributes of one variable."""

    long_name: str
    units: str
    comment: str = ""

    def attributes(self) -> dict[str, str]:
        """As netCDF attributes, leaving out what is empty."""
        return {key: text for key, text in self._asdict().items() if text}


_FLAG = "1 yes, 0 no, NaN unknown"
_DRIFT = "at the end of the run, relative to "

OUTCOMES = {
    "mass_ratio": Variable(
        "mass of the largest remnant over the mass of the target",
        "1",
        f"largest friends-of-friends clump, linking length {LINKING_LENGTH} particle spacings, no velocity condition; "
        "target mass 4/3 pi rho0 R^3, so that a perfect merger of equals is 2",
    ),
    "second_mass_ratio": Variable("mass of the second largest clump over the mass of the target", "1"),
    "bound_mass_ratio": Variable(
        "mass bound to the largest remnant, itself included, over the mass of the target",
        "1",
        "clumps of negative two-body energy join until none is left",
    ),
    "clumps": Variable("number of clumps, single particles included", "1"),
    "b_over_a": Variable(
        "intermediate over longest axis of the largest remnant",
        "1",
        "uniform ellipsoid with the inertia tensor of the particles taken as points",
    ),
    "c_over_a": Variable("shortest over longest axis of the largest remnant", "1", "as b_over_a"),
    "c_over_a_extended": Variable(
        "shortest over longest axis of the largest remnant, particles of finite size",
        "1",
        "as c_over_a with m h^2/12 added per particle and axis; points understate a thin axis",
    ),
    "axis_a": Variable("longest full axis of the largest remnant", "m", "as b_over_a"),
    "axis_b": Variable("intermediate full axis of the largest remnant", "m", "as b_over_a"),
    "axis_c": Variable("shortest full axis of the largest remnant", "m", "as b_over_a"),
    "largest_thin": Variable("largest remnant is thin", "1", f"axis_c below {THIN:g} particle spacings; {_FLAG}"),
    "hull_b_over_a": Variable(
        "intermediate over longest axis of the largest remnant's convex hull", "1", "inertia tensor of the solid hull"
    ),
    "hull_c_over_a": Variable(
        "shortest over longest axis of the largest remnant's convex hull", "1", "inertia tensor of the solid hull"
    ),
    "hull_volume": Variable("volume of the largest remnant's convex hull", "m3"),
    "extent_a": Variable("size of the largest remnant along the longest axis of its hull", "m", "particles as points"),
    "extent_b": Variable("size of the largest remnant along the intermediate axis of its hull", "m", "as extent_a"),
    "extent_c": Variable("size of the largest remnant along the shortest axis of its hull", "m", "as extent_a"),
    "bulk_density": Variable(
        "bulk density of the largest remnant", "kg m-3", "mass over pi/6 axis_a axis_b axis_c: too high when thin"
    ),
    "spin_period": Variable(
        "rotation period of the largest remnant", "s", "inverse inertia tensor times angular momentum; NaN if undefined"
    ),
    "J_p05": Variable("5th percentile of rho0/rho over the particles of the largest remnant", "1"),
    "J_p50": Variable("median of rho0/rho over the particles of the largest remnant", "1"),
    "J_p95": Variable("95th percentile of rho0/rho over the particles of the largest remnant", "1"),
    "damaged_fraction": Variable("mass share of the largest remnant with damage above 0.5", "1"),
    "time_after_contact": Variable("time of the outcome after point-mass contact", "s"),
    "shape_change": Variable(
        "largest relative change of b_over_a and c_over_a lately",
        "1",
        f"against the snapshots of the last {WINDOW:.0%} of the time after contact, or more when they are sparse",
    ),
    "settled": Variable("shape of the largest remnant is settled", "1", f"shape_change below {TOLERANCE:g}; {_FLAG}"),
    "drift_mass": Variable("change of the total mass", "1", f"{_DRIFT}the mass at the start"),
    "drift_momentum": Variable("change of the total momentum", "1", f"{_DRIFT}sum m |v| at the start"),
    "drift_angular_momentum": Variable(
        "change of the total angular momentum", "1", f"{_DRIFT}its magnitude at the start; NaN for a head-on impact"
    ),
    "drift_energy": Variable("change of the total energy", "1", f"{_DRIFT}the kinetic energy at the start"),
    "steps": Variable("time steps", "1"),
    "wall_time": Variable("computing time", "s"),
    "cpu_time": Variable("processor time of all threads", "s"),
}
"""Numbers of one job, in the order of results.nc."""

WITHOUT_ERROR = ("largest_thin", "settled", "time_after_contact")
"""Outcomes that are no measured numbers."""

COSTS = ("steps", "wall_time", "cpu_time")
"""Outcomes that add up over the runs of a cell."""

TEXTS = {
    "state": Variable(
        "state of the job", "", "done, running, pending, interrupted, failed, corrupt, or missing without a job"
    ),
    "reason": Variable("why the job has no outcome", ""),
    "job": Variable("identifier of the job", ""),
}
"""Texts of one job."""

PARAMETERS = {"case": Variable("name of the case", "")}
"""Coordinates of results.nc that are no keys of a collision; others keep their own name and no unit."""


def parameter(key: str) -> Variable:
    """Return what a coordinate or attribute of results.nc is: the meaning and unit of the dotted key of a collision."""
    meaning = meaning_of(Collision, key)
    if meaning is None:
        return PARAMETERS.get(key, Variable(key.replace("_", " "), ""))
    return Variable(meaning, unit_of(Collision, key) or "")
