"""The command line: `python -m analysis plots CAMPAIGN`, and `collect`, `accuracy`, `comparison`; and `remnant JOB`."""

import sys
from pathlib import Path

import typer
import xarray as xr

from analysis.accuracy.report import write_accuracy
from analysis.comparison.report import write_comparison
from analysis.remnant.fragments import clumps_of
from analysis.remnant.outcome import latest, measure
from analysis.remnant.variables import OUTCOMES
from analysis.report.products import plots as draw
from analysis.results.collect import collect as collect_results
from analysis.results.tables import printed, reasons, shape_table, unresolved
from engine.errors import ExitCode, JobError, RunFault, SceneError, in_words
from engine.job.directory import JobDirectory, JobState

app = typer.Typer(help=__doc__, add_completion=False, no_args_is_help=True)


@app.command()
def plots(campaign: Path) -> None:
    """Collect a campaign, print its table of shapes, and draw its figures."""
    results, written = draw(campaign)
    typer.echo(printed(shape_table(results)))
    for line in [*unresolved(results), *reasons(results)]:
        typer.echo(line)
    if not (results["state"] == JobState.DONE).any():
        typer.echo("no job of this campaign is done yet: table and figures show states only")
    typer.echo("written: " + ", ".join(str(path) for path in written))
    _fail_on_damage(results)


@app.command()
def collect(campaign: Path) -> None:
    """Measure every finished job of a campaign and gather the outcomes in results.nc."""
    results = collect_results(campaign)
    for line in reasons(results):
        typer.echo(line)
    typer.echo(f"written: {campaign / 'results.nc'}")
    _fail_on_damage(results)


@app.command()
def accuracy(campaign: Path) -> None:
    """Compare the cases of a campaign that varies one setting at a time: what each costs and changes."""
    _tell(*write_accuracy(campaign))


@app.command()
def comparison(campaign: Path) -> None:
    """Show the cases of a campaign beside what other methods find in the same collisions."""
    _tell(*write_comparison(campaign))


@app.command()
def remnant(job: Path) -> None:
    """Print the outcome of one job, from its last snapshot when it is not done."""
    directory = JobDirectory(job)
    particles = latest(directory)
    if not directory.final.is_file():
        typer.echo(f"not done: last snapshot, {particles.time:g} s after contact")
    for name, value in measure(directory, particles, clumps_of(particles)).items():
        typer.echo(f"{name:24} {value:<14.6g} {OUTCOMES[name].units:7} {OUTCOMES[name].long_name}")


def _tell(results: xr.Dataset, text: str, written: list[Path]) -> None:
    """Print the tables of a campaign, what its results lack and which files were written."""
    typer.echo(text)
    for line in reasons(results):
        typer.echo(line)
    typer.echo("written: " + ", ".join(str(path) for path in written))
    _fail_on_damage(results)


def _fail_on_damage(results: xr.Dataset) -> None:
    """Exit with code 1 when a job is damaged or cannot be read, also one that says it is done."""
    if results["state"].isin([JobState.CORRUPT, JobState.UNREADABLE]).any():
        raise typer.Exit(ExitCode.FAILED)


def main() -> None:
    """Run the command line; whatever the user can mend is one line on stderr and exit code 2."""
    try:
        app()
    except (SceneError, JobError, RunFault) as error:
        typer.echo(str(error), err=True)
        sys.exit(ExitCode.BAD_INPUT)
    except OSError as error:
        typer.echo(f"{in_words(error)}; results of jobs are kept, run again", err=True)
        sys.exit(ExitCode.BAD_INPUT)
