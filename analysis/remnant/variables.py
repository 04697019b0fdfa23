"""The outcomes of a job: names, units and meanings (CF attributes)."""

from analysis.remnant.ellipsoid import THIN
from analysis.remnant.filled import CLOSING, SURFACE
from analysis.remnant.fragments import LINKING_LENGTH, OTHER_LENGTHS
from analysis.remnant.lobes import NECK, SMOOTHING
from analysis.remnant.settling import TOLERANCE, WINDOW
from engine.quantities import CONSERVED, HEATS, HISTORY, Quantity

DAMAGED = 0.5
"""A particle with more damage than this counts as damaged."""


_FLAG = "1 yes, 0 no, NaN unknown"
_SCALES = {
    "mass": "the mass at the start",
    "momentum": "sum m |v| at the start",
    "angular_momentum": "its magnitude at the start; NaN without any",
    "total_energy": "the kinetic energy at the start",
}
"""What the change of each conserved quantity is divided by."""

DRIFTS = {f"drift_{name.removeprefix('total_')}": name for name in CONSERVED}
"""Outcomes that would be 0 without error, and the conserved quantity that changed."""


def _drift_of(name: str) -> Quantity:
    total = f"total {name.removeprefix('total_').replace('_', ' ')}"
    return Quantity(f"change of the {total}", "1", f"at the end of the run, relative to {_SCALES[name]}")


def _flow(prefix: str, of: str) -> dict[str, Quantity]:
    """Outcomes of the linear flow v = v0 + L (x - x0) that fits some particles best."""
    return {
        f"{prefix}_spin_rate": Quantity(
            f"spin rate of the linear flow that fits {of}",
            "rad s-1",
            "half the vorticity of v0 + L (x - x0), fitted by least squares weighted by mass; NaN in one plane",
        ),
        f"{prefix}_strain_rate": Quantity(
            f"largest principal strain rate of the linear flow that fits {of}",
            "s-1",
            f"of sym L, as {prefix}_spin_rate: how fast it stretches, 0 of a rigid body",
        ),
        f"{prefix}_residual": Quantity(
            f"speed in {of} that its linear flow leaves over",
            "1",
            "root mean square of v - v0 - L (x - x0) over that of v - v0: 0 of a linear flow; NaN without motion",
        ),
    }


def _heat(name: str) -> Quantity:
    return Quantity(HISTORY[name].long_name, "1", "at the end of the run, relative to the kinetic energy at the start")


OUTCOMES = {
    "mass_ratio": Quantity(
        "mass of the largest remnant over the mass of the target",
        "1",
        f"largest friends-of-friends clump, linking length {LINKING_LENGTH} particle spacings, no velocity condition; "
        "target mass 4/3 pi rho0 R^3, so that a perfect merger of equals is 2",
    ),
    "second_mass_ratio": Quantity("mass of the second largest clump over the mass of the target", "1"),
    "bound_mass_ratio": Quantity(
        "mass bound to the largest remnant, itself included, over the mass of the target",
        "1",
        "clumps of negative two-body energy join until none is left",
    ),
    **{
        name: Quantity(
            f"mass of the largest remnant at a linking length of {length:g} particle spacings, over the target's",
            "1",
            "as mass_ratio: where they differ, what counts as one remnant is a matter of the linking length",
        )
        for name, length in OTHER_LENGTHS.items()
    },
    "contact_time": Quantity(
        "time at which the bodies touched, after point-mass contact", "s", "NaN if they did not, or contact is left out"
    ),
    "contact_offset": Quantity(
        "distance of the centres when the bodies touched, over the sum of their radii, less 1",
        "1",
        "of point masses with gravity that left the start; NaN as contact_time",
    ),
    "contact_angle": Quantity("impact angle when the bodies touched", "degree", "as contact_offset"),
    "clumps": Quantity("number of clumps, single particles included", "1"),
    "b_over_a": Quantity(
        "intermediate over longest axis of the largest remnant",
        "1",
        "uniform ellipsoid with the inertia tensor of the particles taken as points",
    ),
    "c_over_a": Quantity("shortest over longest axis of the largest remnant", "1", "as b_over_a"),
    "c_over_a_extended": Quantity(
        "shortest over longest axis of the largest remnant, particles of finite size",
        "1",
        "as c_over_a with m h^2/12 added per particle and axis; points understate a thin axis",
    ),
    "axis_a": Quantity("longest full axis of the largest remnant", "m", "as b_over_a"),
    "axis_b": Quantity("intermediate full axis of the largest remnant", "m", "as b_over_a"),
    "axis_c": Quantity("shortest full axis of the largest remnant", "m", "as b_over_a"),
    "c_unresolved": Quantity(
        "shortest axis of the largest remnant is not resolved", "1", f"axis_c below {THIN:g} particle spacings; {_FLAG}"
    ),
    "hull_b_over_a": Quantity(
        "intermediate over longest axis of the largest remnant's convex hull", "1", "inertia tensor of the solid hull"
    ),
    "hull_c_over_a": Quantity(
        "shortest over longest axis of the largest remnant's convex hull", "1", "inertia tensor of the solid hull"
    ),
    "hull_volume": Quantity("volume of the largest remnant's convex hull", "m3"),
    "extent_a": Quantity("size of the largest remnant along the longest axis of its hull", "m", "particles as points"),
    "extent_b": Quantity("size of the largest remnant along the intermediate axis of its hull", "m", "as extent_a"),
    "extent_c": Quantity("size of the largest remnant along the shortest axis of its hull", "m", "as extent_a"),
    "kurtosis_a": Quantity(
        "kurtosis of the particles' positions along the longest axis of the largest remnant",
        "1",
        "<x^4>/<x^2>^2: 15/7 of a uniform ellipsoid, less of two lobes, 1 of two points, more of a core with tails",
    ),
    "bulk_density": Quantity(
        "bulk density of the largest remnant in its inertia ellipsoid",
        "kg m-3",
        "mass over pi/6 axis_a axis_b axis_c, not over the volume that is filled: two touching spheres fill 0.82 of "
        "it, a stretched dumbbell 0.3; too high when thin",
    ),
    "particle_density": Quantity(
        "density of the largest remnant from the volumes of its particles",
        "kg m-3",
        "mass over the sum of m/rho = J m/rho0; gaps between particles do not count",
    ),
    "filled_volume": Quantity(
        "volume that the largest remnant fills, pores between particles included",
        "m3",
        f"within {CLOSING:g} particle spacings of a particle, and the surface moved inward to {SURFACE:g} beyond the "
        "outermost particles; some per cent too small, more when thin",
    ),
    "filled_density": Quantity(
        "density of the largest remnant in the volume that it fills", "kg m-3", "mass over filled_volume"
    ),
    "lobes": Quantity(
        "number of lobes of the largest remnant",
        "1",
        f"maxima of the mass per length along its longest axis, smoothed over {SMOOTHING:g} particle spacings, "
        f"with necks at least {NECK:.0%} lower than the maxima beside them",
    ),
    "largest_lobe_fraction": Quantity("mass of the largest lobe over that of the largest remnant", "1", "as lobes"),
    "second_lobe_fraction": Quantity(
        "mass of the second largest lobe over that of the largest remnant", "1", "as lobes"
    ),
    "spin_period": Quantity(
        "rotation period of the largest remnant", "s", "inverse inertia tensor times angular momentum; NaN if undefined"
    ),
    "J_p05": Quantity("5th percentile of rho0/rho over the particles of the largest remnant", "1"),
    "J_p50": Quantity("median of rho0/rho over the particles of the largest remnant", "1"),
    "J_p95": Quantity("95th percentile of rho0/rho over the particles of the largest remnant", "1"),
    "damaged_fraction": Quantity(f"mass fraction of the largest remnant with damage above {DAMAGED:g}", "1"),
    "compressed_fraction": Quantity(
        "mass fraction of the bound mass under pressure",
        "1",
        "J = rho0/rho below 1, or below that of its packing; the rest bears none, or tension",
    ),
    **_flow("flow", "the largest remnant"),
    **_flow("bound_flow", "the bound mass"),
    "time_after_contact": Quantity("time of the outcome after point-mass contact", "s"),
    "shape_change": Quantity(
        "largest relative change of b_over_a and c_over_a lately",
        "1",
        f"against the snapshots of the last {WINDOW:.0%} of the time after contact, or more when they are sparse",
    ),
    "mass_change": Quantity(
        "largest relative change of the mass of the largest remnant lately", "1", "as shape_change"
    ),
    "settled": Quantity(
        "shape and mass of the largest remnant are settled",
        "1",
        f"shape_change and mass_change below {TOLERANCE:g}; {_FLAG}",
    ),
    **{drift: _drift_of(name) for drift, name in DRIFTS.items()},
    **{name: _heat(name) for name in HEATS},
    "steps": Quantity("time steps", "1"),
    "wall_time": Quantity("computing time", "s"),
    "cpu_time": Quantity("processor time of all threads", "s"),
}
"""Numbers of one job, in the order of results.nc."""


class UndescribedError(LookupError):
    """What is measured and what `OUTCOMES` describes differ: an error of this program, not of a job."""


def described(numbers: dict[str, float]) -> dict[str, float]:
    """Return the numbers of one job in the order of `OUTCOMES`.

    Raises:
        UndescribedError: a number is not described, or one that is described was not measured.
    """
    if odd := sorted(numbers.keys() ^ OUTCOMES.keys()):
        raise UndescribedError(f"measured or described in OUTCOMES, not both: {', '.join(odd)}")
    return {name: numbers[name] for name in OUTCOMES}


WITHOUT_ERROR = ("c_unresolved", "settled", "time_after_contact")
"""Outcomes that are flags or given, not measured: they have no error."""

COSTS = ("steps", "wall_time", "cpu_time")
"""Outcomes that add up over the members of a point."""
