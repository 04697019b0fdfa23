"""Command line: `python -m engine run JOBDIR`, `python -m engine explain SCENE` and `python -m engine verify`."""

import logging
import os
import sys
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from engine.device.options import Arch, choose
from engine.errors import ExitCode, JobBusyError, JobError, RunFault, SceneError, in_words
from engine.job.directory import JobDirectory, Status
from engine.scene.input_errors import suggestion

application = typer.Typer(
    add_completion=False,
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    help="One simulation: a scene in, a job directory out.",
)

TABLE_WIDTH = 130
"""Characters that a table of results needs, also where its output is not a terminal."""


@application.command()
def run(
    directory: Annotated[Path, typer.Argument(help="Job directory that holds scene.json or scene.toml.")],
    threads: Annotated[int, typer.Option(min=1, help="CPU threads.")] = os.cpu_count() or 1,
    arch: Annotated[Arch, typer.Option(help="Device.")] = Arch.CPU,
    checkpoint_interval: Annotated[float, typer.Option(min=0.0, help="Computing time between checkpoints [s].")] = 30.0,
) -> None:
    """Run the scene in DIRECTORY to its end, from its checkpoint if it has one.

    Exit code 0: done; 1: the run failed; 2: bad input; 3: another process runs it; 130: interrupted, run to resume.
    """
    try:
        status = _run(directory, threads, arch, checkpoint_interval)
    except JobBusyError as error:
        _exit(str(error), ExitCode.BUSY)
    except (SceneError, JobError) as error:
        _exit(str(error), ExitCode.BAD_INPUT)
    except OSError as error:
        _exit(f"{in_words(error, directory)}; the last checkpoint is intact, run again to resume", ExitCode.FAILED)
    if status.state != "done":
        _exit(
            f"{directory}: {status.state}: {status.reason}",
            ExitCode.FAILED if status.state == "failed" else ExitCode.INTERRUPTED,
        )
    typer.echo(f"{directory}: done after {status.step} steps")


@application.command()
def explain(
    scene: Annotated[Path, typer.Argument(help="Scene file, TOML or JSON, or job directory.")],
    steps: Annotated[int, typer.Option(min=1, help="Steps to measure.")] = 50,
    threads: Annotated[int, typer.Option(min=1, help="CPU threads.")] = os.cpu_count() or 1,
    arch: Annotated[Arch, typer.Option(help="Device.")] = Arch.CPU,
) -> None:
    """Show the parts of SCENE, their memory and time, and what it leaves out; a job is read, never written to.

    Exit code 0: shown; 1: the steps failed; 2: bad input.
    """
    from engine.scene.scene import scene_at

    try:
        choose(scene_at(scene).numerics.precision)
        from engine.profile.cost import measure
        from engine.profile.report import report

        with Console(stderr=True).status(f"measuring {steps} steps"):
            result = measure(scene, steps, arch.value, threads)
    except (SceneError, JobError) as error:
        _exit(str(error), ExitCode.BAD_INPUT)
    except RunFault as fault:
        _exit(f"{scene}: {fault}", ExitCode.FAILED)
    Console(width=max(Console().width, TABLE_WIDTH)).print(report(result))


@application.command()
def verify(
    names: Annotated[list[str] | None, typer.Argument(help="Problems to run; all if none is named.")] = None,
    full: Annotated[bool, typer.Option("--full", help="Fine resolutions: minutes instead of seconds each.")] = False,
    csv: Annotated[Path | None, typer.Option(help="File for the table, all digits.")] = None,
    figures: Annotated[Path | None, typer.Option(help="Directory for figures of the problems that have one.")] = None,
    threads: Annotated[int, typer.Option(min=1, help="CPU threads.")] = os.cpu_count() or 1,
    arch: Annotated[Arch, typer.Option(help="Device.")] = Arch.CPU,
) -> None:
    """Run scenes with known answers and print measured beside expected values.

    Exit code 0: all errors are allowed; 1: one is not; 2: bad input.
    """
    choose("f64")
    from engine.verification.catalogue import FULL, SHORT
    from engine.verification.figures import draw
    from engine.verification.report import frame, run_all, table

    known = FULL if full else SHORT
    for name in set(names or ()) - set(known):
        _exit(f"unknown problem '{name}'{suggestion(name, list(known), 'problems')}", ExitCode.BAD_INPUT)
    chosen = [known[name] for name in names or known]
    with Console(stderr=True).status("running") as spinner:
        results = []
        for result in run_all(chosen, arch.value, threads):
            results.append(result)
            spinner.update(f"{len(results)} of {len(chosen)} done, {result.name} last")
            if csv:
                frame(results).to_csv(csv, index=False)
        if figures:
            draw(chosen, figures)
    Console(width=max(Console().width, TABLE_WIDTH)).print(table(results))
    raise typer.Exit(ExitCode.DONE if all(result.passed for result in results) else ExitCode.FAILED)


@application.command()
def accuracy(
    directory: Annotated[Path, typer.Argument(help="Where scenes.nc and scenes.png are written.")],
    names: Annotated[list[str] | None, typer.Argument(help="Verification scenes; all if none is named.")] = None,
    workers: Annotated[int, typer.Option(min=1, help="Runs at the same time, one thread each.")] = os.cpu_count() or 1,
) -> None:
    """Turn every knob of the verification scenes; measure error and CPU time. What DIRECTORY holds is not repeated."""
    choose("f64")
    from engine.verification.accuracy.figure import draw
    from engine.verification.accuracy.settings import TRADEOFFS
    from engine.verification.accuracy.sweep import orders, read, sweep

    for name in set(names or ()) - set(TRADEOFFS):
        _exit(f"unknown scene '{name}'{suggestion(name, list(TRADEOFFS), 'scenes')}", ExitCode.BAD_INPUT)
    directory.mkdir(parents=True, exist_ok=True)
    for run in sweep(names or TRADEOFFS, directory / "scenes.nc", workers):
        typer.echo(f"{run.scene:12} {run.knob:28} {run.value:>8}  error {run.error:9.3g}  {run.cpu_time:8.2f} s")
    runs = read(directory / "scenes.nc")
    draw(runs, directory / "scenes.png")
    typer.echo(orders(runs).to_string(index=False, float_format="%.2f"))


@application.command()
def stability(
    directory: Annotated[Path, typer.Argument(help="Where stability.nc, .csv, .png and the jobs are written.")],
    workers: Annotated[int, typer.Option(min=1, help="Cases at the same time, one thread each.")] = os.cpu_count() or 1,
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


def _run(directory: Path, threads: int, arch: Arch, checkpoint_interval: float) -> Status:
    """Import the engine only now: bad options and missing directories answer at once."""
    from engine.scene.scene import scene_in

    choose(scene_in(directory).numerics.precision)
    from engine.job.session import Options, run_job

    logging.basicConfig(
        filename=JobDirectory(directory).log, level=logging.INFO, format="%(asctime)s %(levelname)s %(message)s"
    )
    logging.raiseExceptions = False  # a full disk is told once
    console = Console(stderr=True)
    with console.status("starting") as spinner:
        options = Options(
            arch.value, threads, checkpoint_interval, lambda status: spinner.update(progress_line(status))
        )
        return run_job(directory, options)


def progress_line(status: Status) -> str:
    """Simulated time, rate and time left in one line."""
    return (
        f"t = {status.time:.0f} of {status.end_time:.0f} s ({100.0 * status.progress:.0f} %), step {status.step}, "
        f"{status.steps_per_second:.0f} steps/s, {status.time_left:.0f} s left"
    )


def _exit(message: str, code: int) -> None:
    print(message, file=sys.stderr)
    raise typer.Exit(code)


if __name__ == "__main__":
    application()
