"""Command line: `python -m engine COMMAND`.

A command imports device modules after it has chosen the precision (engine/device/options.py); bad options and missing
directories are therefore reported at once.
"""

import logging
import sys
from collections.abc import Collection, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated, NoReturn

import typer
from rich.console import Console, RenderableType

from engine.device.options import Arch, choose, usable_cores
from engine.errors import (
    MEMORY_IS_FULL,
    ExitCode,
    JobBusyError,
    JobError,
    RunFault,
    SceneError,
    UnavailableError,
    in_words,
    is_out_of_memory,
)
from engine.job.directory import JobDirectory, JobState, Status
from engine.scene.input_errors import did_you_mean
from engine.scene.scene import Scene, scene_at, scene_in

application = typer.Typer(
    add_completion=False,
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    help="One simulation: a scene in, a job directory out.",
)

TABLE_WIDTH = 130
"""Least width of a printed table [characters], also where the output is not a terminal."""

CORES = usable_cores()

Threads = Annotated[int, typer.Option(min=1, help="CPU threads.")]
Device = Annotated[Arch, typer.Option(help="Device.")]


@application.command()
def run(
    directory: Annotated[Path, typer.Argument(help="Job directory that contains scene.json or scene.toml.")],
    threads: Threads = CORES,
    arch: Device = Arch.CPU,
    checkpoint_interval: Annotated[float, typer.Option(min=0.0, help="Computing time between checkpoints [s].")] = 30.0,
) -> None:
    """Run the scene in DIRECTORY to its end, from its checkpoint if it has one.

    Exit code 0: done; 1: the run failed; 2: bad input; 3: another process runs it; 130: interrupted, run to resume.
    """
    with _errors_as_exit_codes(directory):
        try:
            status = _run(directory, scene_in(directory), threads, arch, checkpoint_interval)
        except OSError as error:
            _exit(f"{in_words(error, directory)}; the last checkpoint is intact, run again to resume", ExitCode.FAILED)
    if status.state != JobState.DONE:
        code = ExitCode.FAILED if status.state == JobState.FAILED else ExitCode.INTERRUPTED
        _exit(f"{directory}: {status.state}: {status.reason}", code)
    typer.echo(f"{directory}: done after {status.step} steps")


@application.command()
def explain(
    scene: Annotated[Path, typer.Argument(help="Scene file, TOML or JSON, or job directory.")],
    steps: Annotated[int, typer.Option(min=1, help="Steps to measure.")] = 50,
    threads: Threads = CORES,
    arch: Device = Arch.CPU,
) -> None:
    """Show the parts of SCENE, their memory and time, and what it leaves out; a job is read, never written to.

    Exit code 0: shown; 1: the steps failed; 2: bad input.
    """
    with _errors_as_exit_codes(scene):
        choose(scene_at(scene).numerics.precision)
        from engine.profile.cost import measure
        from engine.profile.report import report

        with Console(stderr=True).status(f"measuring {steps} steps"):
            result = measure(scene, steps, arch.value, threads)
    _print_table(report(result))


@application.command()
def verify(
    names: Annotated[list[str] | None, typer.Argument(help="Problems to run; all if none is named.")] = None,
    full: Annotated[bool, typer.Option("--full", help="Fine resolutions: minutes instead of seconds each.")] = False,
    csv: Annotated[Path | None, typer.Option(help="File for all digits; rows of other problems in it stay.")] = None,
    figures: Annotated[Path | None, typer.Option(help="Directory for figures of the problems that have one.")] = None,
    threads: Threads = CORES,
    arch: Device = Arch.CPU,
) -> None:
    """Run scenes with known answers and print measured beside expected values.

    Exit code 0: all errors are allowed; 1: one is not; 2: bad input.
    """
    choose("f64")
    from engine.verification.catalogue import FULL, SHORT
    from engine.verification.figures import draw
    from engine.verification.results import run_all, table, write_table

    known = FULL if full else SHORT
    _require_known(names, known, "problem")
    chosen = [known[name] for name in names or known]
    with Console(stderr=True).status("running") as spinner:
        results = []
        for result in run_all(chosen, arch.value, threads):
            results.append(result)
            spinner.update(f"{len(results)} of {len(chosen)} done, {result.name} last")
            if csv:
                write_table(csv, results, list(FULL))
        if figures:
            draw(chosen, figures)
    _print_table(table(results))
    raise typer.Exit(ExitCode.DONE if all(result.passed for result in results) else ExitCode.FAILED)


@application.command()
def accuracy(
    directory: Annotated[Path, typer.Argument(help="Where scenes.nc and scenes.png are written.")],
    names: Annotated[list[str] | None, typer.Argument(help="Verification scenes; all if none is named.")] = None,
    workers: Annotated[int, typer.Option(min=1, help="Runs at the same time, one thread each.")] = CORES,
) -> None:
    """Vary every setting of the verification scenes; measure error and CPU time. Runs found in DIRECTORY are kept."""
    choose("f64")
    from engine.verification.accuracy.figure import draw
    from engine.verification.accuracy.settings import TRADEOFFS
    from engine.verification.accuracy.sweep import orders, read, sweep

    _require_known(names, TRADEOFFS, "scene")
    directory.mkdir(parents=True, exist_ok=True)
    for run in sweep(names or TRADEOFFS, directory / "scenes.nc", workers):
        typer.echo(f"{run.scene:12} {run.setting:28} {run.value:>8}  error {run.error:9.3g}  {run.cpu_time:8.2f} s")
    runs = read(directory / "scenes.nc")
    draw(runs).savefig(directory / "scenes.png", dpi=80)
    typer.echo(orders(runs).to_string(index=False, float_format="%.2f"))


@application.command()
def stability(
    directory: Annotated[Path, typer.Argument(help="Where stability.nc, .csv, .png and the jobs are written.")],
    workers: Annotated[int, typer.Option(min=1, help="Cases at the same time, one thread each.")] = CORES,
) -> None:
    """Run stiff and extreme cases: each must be stable, or be stopped by a guard that names itself.

    Exit code 0: none failed and no physical one was stopped; 1: one did; 2: bad input.
    """
    choose("f64")
    if directory.exists():
        _exit(f"{directory}: exists already; name a new directory", ExitCode.BAD_INPUT)
    from engine.verification.stability.matrix import find_limits, run_all
    from engine.verification.stability.results import dataset, summary, write

    outcomes = []
    for outcome in run_all(directory / "jobs", workers):
        outcomes.append(outcome)
        typer.echo(str(outcome))
    results = dataset(outcomes, list(find_limits()))
    write(directory, results)
    typer.echo(summary(results).to_string(float_format="%.2g"))
    typer.echo(results[["limit", "limit_theory"]].to_dataframe().to_string(float_format="%.3f"))
    raise typer.Exit(ExitCode.DONE if all(outcome.acceptable for outcome in outcomes) else ExitCode.FAILED)


def _run(directory: Path, scene: Scene, threads: int, arch: Arch, checkpoint_interval: float) -> Status:
    choose(scene.numerics.precision)
    from engine.job.session import Options, run_job

    logging.basicConfig(
        filename=JobDirectory(directory).log, level=logging.INFO, format="%(asctime)s %(levelname)s %(message)s"
    )
    logging.raiseExceptions = False  # a full disk is reported once
    with Console(stderr=True).status("starting") as spinner:
        options = Options(
            arch.value, threads, checkpoint_interval, lambda status: spinner.update(progress_line(status))
        )
        return run_job(directory, options)


def progress_line(status: Status) -> str:
    """Return simulated time, rate and time left in one line."""
    return (
        f"t = {status.time:.0f} of {status.end_time:.0f} s ({100.0 * status.progress:.0f} %), step {status.step}, "
        f"{status.steps_per_second:.0f} steps/s, {status.time_left:.0f} s left"
    )


@contextmanager
def _errors_as_exit_codes(source: Path) -> Iterator[None]:
    """End the process with the exit code and the message of an error that a user can act on."""
    try:
        yield
    except JobBusyError as error:
        _exit(str(error), ExitCode.BUSY)
    except UnavailableError as error:
        _exit(str(error), ExitCode.FAILED)
    except (SceneError, JobError) as error:
        _exit(str(error), ExitCode.BAD_INPUT)
    except RunFault as fault:
        _exit(f"{source}: {fault}", ExitCode.FAILED)
    except RuntimeError as error:
        if not is_out_of_memory(error):
            raise
        _exit(f"{source}: {MEMORY_IS_FULL}", ExitCode.FAILED)


def _require_known(names: Sequence[str] | None, known: Collection[str], what: str) -> None:
    for name in set(names or ()) - set(known):
        _exit(f"unknown {what} '{name}'{did_you_mean(name, list(known), f'{what}s')}", ExitCode.BAD_INPUT)


def _print_table(table: RenderableType) -> None:
    Console(width=max(Console().width, TABLE_WIDTH)).print(table)


def _exit(message: str, code: ExitCode) -> NoReturn:
    print(message, file=sys.stderr)
    raise typer.Exit(code)
