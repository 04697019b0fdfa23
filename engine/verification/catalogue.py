"""All verification problems, in a version of seconds and, where it differs, one of minutes."""

from engine.verification.check import Problem
from engine.verification.problems.bar import Bar
from engine.verification.problems.cliff import Cliff
from engine.verification.problems.collapse import Collapse
from engine.verification.problems.column import Column
from engine.verification.problems.ellipsoid import Ellipsoid
from engine.verification.problems.expansion import Expansion
from engine.verification.problems.fallback import Fallback
from engine.verification.problems.hugoniot import MURNAGHAN, Hugoniot
from engine.verification.problems.hydrostatic import Hydrostatic
from engine.verification.problems.infall import Infall
from engine.verification.problems.rotation import Rotation
from engine.verification.problems.rubble import Rubble
from engine.verification.problems.runout import Runout
from engine.verification.problems.shear_jump import ShearJump
from engine.verification.problems.slope import Slope
from engine.verification.problems.static_lens import StaticLens
from engine.verification.problems.stiffness import Stiffness

SHORT: dict[str, Problem] = {
    problem.name: problem
    for problem in (
        Hydrostatic(),
        Rotation(),
        Expansion(),
        Column(),
        Hugoniot(),
        Hugoniot(speeds=(500.0,), material=MURNAGHAN, name="hugoniot_murnaghan"),
        Bar(),
        Slope(),
        Slope(friction_angle=35.0, law="mohr-coulomb", name="slope_mohr_coulomb"),
        Slope(friction_angle=31.5, law="matsuoka-nakai", name="slope_matsuoka_nakai"),
        Collapse(),
        Infall(),
        Cliff(),
        Rubble(),
        Ellipsoid(),
        StaticLens(),
        ShearJump(),
        Fallback(),
    )
}

FULL: dict[str, Problem] = {
    **SHORT,
    "hydrostatic": Hydrostatic(particles=20000, end_time=3000.0, seeds=(1, 2, 3, 4, 5)),
    "column": Column(cells=(8, 16, 32, 64, 128)),
    "hugoniot": Hugoniot(speeds=(25.0, 50.0, 100.0, 200.0, 500.0, 1000.0), cells=320),
    "hugoniot_strong": Hugoniot(speeds=(2000.0,), cells=160, name="hugoniot_strong"),
    "collapse": Collapse(particles=(2000, 16000)),
    "cliff": Cliff(cells=15),
    "rubble": Rubble(particles=1500),
    "stiffness": Stiffness(),
    "runout": Runout(),
    "fallback": Fallback(particles=(1000, 4000)),
}
