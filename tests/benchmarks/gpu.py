"""Steps, repeatability, a whole case, verification and cases per hour: `make bench-gpu OPTIONS="--arch cuda"`."""

import json
import shutil
import subprocess
import sys
import time
from pathlib import Path
from typing import Annotated, Any

import typer

from engine.device.options import Arch, Precision
from engine.job.storage import read_dataset
from engine.scene.collision import Collision
from tests.benchmarks.child import ROOT, ask
from tests.benchmarks.host import commit, host

SIZES = (1_000, 5_000, 20_000, 100_000, 500_000, 1_000_000)
"""Particles per body."""
STEPS = 20
CASE = {"velocity": 200.0, "angle": 15.0, "end_time": 10_300.0, "parameter_set": "talk", "numerics": {"cfl": 0.9}}
"""The talk's collision."""

Results = dict[str, Any]


def main(
    arch: Annotated[Arch, typer.Option(help="Where the engine computes.")] = Arch.GPU,
    largest: Annotated[int, typer.Option(help="Most particles of a body that steps are timed with.")] = SIZES[-1],
    particles: Annotated[int, typer.Option(help="Particles of a body in the case that is run to its end.")] = 20_000,
    study: Annotated[str, typer.Option(help="Study whose cases per hour are counted.")] = "quick",
    out: Annotated[Path, typer.Option(help="New directory for jobs and figures.")] = Path("runs/bench-gpu"),
) -> None:
    """Time steps, repeat a short run, run a case, verify, and count cases per hour."""
    if out.exists():
        raise typer.BadParameter(f"{out} is there already; give another directory by --out, or remove it")
    out.mkdir(parents=True)
    results = {"arch": arch.value, "commit": commit(), "host": host(), "device": _device()}
    for name, measure in {
        "copy": lambda: ask("machine", "f64", threads=1, arch=arch.value),
        "steps": lambda: [_steps(arch, n, p, results["copy"]) for p in ("f64", "f32") for n in SIZES if n <= largest],
        "repeatable": lambda: _repeatable(arch, out),
        "case": lambda: _run(arch, out / "case", {**CASE, "particles": particles}),
        "verify": lambda: _seconds("engine", "verify", "--arch", arch),
        "cases": lambda: [_campaign(arch, study, jobs, out) for jobs in (1, 2, 4)],
    }.items():
        results[name] = measure()
        typer.echo(f"{name}: {json.dumps(results[name])}")
        (out / "gpu.json").write_text(json.dumps(results, indent=1) + "\n", encoding="utf-8")


def _steps(arch: Arch, particles: int, precision: Precision, copy: Results) -> Results:
    """Time of a step and its stages, of sorting and of gravity; or why there is none, as on a card that is full.

    The share of the bandwidth is that of the least traffic of a step in what the device copies at most.
    """
    # bodies have just met: the way to 100 s would take longer than what is timed
    given = {"particles": particles, "threads": 1, "contact": 0.0, "steps": STEPS, "arch": arch.value}
    try:
        found = ask("steps", precision, **given)
    except subprocess.CalledProcessError as error:
        return {"particles": 2 * particles, "precision": precision, "failed": f"exit code {error.returncode}"}
    rate = found["particles"] / (1e-3 * found["step"]["least_ms"])
    share = rate * found["bytes"]["traffic"] / copy["bytes_per_second"]
    return {**found, "particle_steps_per_second": rate, "share_of_bandwidth": share}


def _repeatable(arch: Arch, out: Path) -> bool:
    """Whether two runs of a short collision have the same bits."""
    short = {**CASE, "particles": 1_000, "start_separation": 1.05, "end_time": 100.0}
    for name in ("one", "other"):
        _run(arch, out / name, short)
    one, other = (read_dataset(out / name / "final.nc") for name in ("one", "other"))
    return all(one[name].equals(other[name]) for name in one.variables)


def _run(arch: Arch, directory: Path, settings: Results) -> Results:
    """Seconds of a job from start to end."""
    directory.mkdir()
    scene = Collision.model_validate(settings).scene().canonical()
    (directory / "scene.json").write_text(scene, encoding="utf-8")
    return _seconds("engine", "run", directory, "--arch", arch)


def _campaign(arch: Arch, study: str, jobs: int, out: Path) -> Results:
    """Seconds of a study with some jobs at the same time on every GPU."""
    on_gpu = () if arch == Arch.CPU else ("--jobs-per-gpu", str(jobs))
    found = _seconds("campaigns", "run", study, "--runs", out / f"jobs{jobs}", "--arch", arch, *on_gpu)
    cases = len(list((out / f"jobs{jobs}").glob("*/jobs/*/final.nc")))
    return {**found, "jobs_per_gpu": jobs, "cases_per_hour": 3600.0 * cases / found["seconds"]}


def _seconds(*command: str | Path) -> Results:
    start = time.perf_counter()
    code = subprocess.run([sys.executable, "-m", *map(str, command)], cwd=ROOT, check=False).returncode
    return {"exit_code": code, "seconds": time.perf_counter() - start}


def _device() -> str:
    """What the drivers say is there."""
    for command in (("nvidia-smi", "-L"), ("vulkaninfo", "--summary")):
        if shutil.which(command[0]):
            return subprocess.run(command, capture_output=True, text=True, check=False).stdout
    return "unknown"


if __name__ == "__main__":
    typer.run(main)
