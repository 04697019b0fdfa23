"""The command line of campaigns."""

import signal
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from campaigns.campaign import Campaign
from campaigns.cluster import Resources, connect, share_cores
from campaigns.devices import visible
from campaigns.directory import CampaignDirectory
from campaigns.expansion import expand
from campaigns.job_state import TrackedJob, decide, states
from campaigns.progress import count_by_state, display, show_once
from campaigns.runner import CampaignRun
from campaigns.study import Study, find_study, read_study
from engine.device.options import Arch
from engine.errors import ExitCode, JobError, SceneError, in_words
from engine.job.directory import JobState

app = typer.Typer(
    help="Run studies of collisions: a study in, a directory of finished jobs out.",
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    add_completion=False,
    no_args_is_help=True,
)

StudyName = Annotated[str, typer.Argument(metavar="STUDY", help="A shipped study or a path to a study file.")]
Runs = Annotated[Path, typer.Option(help="Directory of the results of all studies.")]
Workers = Annotated[int | None, typer.Option(min=1, help="Jobs at the same time [default: cores / threads per job].")]
Threads = Annotated[
    int | None, typer.Option(min=1, help="CPU threads of one job [default: 1, more if jobs are fewer than cores].")
]
Scheduler = Annotated[str | None, typer.Option(help="Address of a running dask scheduler that sees the same files.")]
Slurm = Annotated[bool, typer.Option("--slurm", help="Run jobs through SLURM, as set up for dask-jobqueue.")]
Device = Annotated[Arch, typer.Option(help="Where the engine computes.")]
JobsPerGpu = Annotated[int | None, typer.Option(min=1, help="Jobs at the same time on one GPU [default: 1].")]
RetryFailed = Annotated[bool, typer.Option("--retry-failed", help="Run failed jobs once more.")]

DEFAULT_RUNS = Path("runs")


def main() -> None:
    """Run the command line; what goes wrong is one line, and exit code 2 when the input is to blame."""
    try:
        app()
    except SceneError as error:
        sys.exit(_complain(str(error), ExitCode.BAD_INPUT))
    except JobError as error:
        sys.exit(_complain(str(error), ExitCode.FAILED))
    except OSError as error:
        sys.exit(_complain(f"{in_words(error)}; what is finished is kept, run again to go on", ExitCode.FAILED))


@app.command("run", help="Run every unfinished job of a study.")
@app.command("resume", help="Go on with a study that was run before.")
def run(
    context: typer.Context,
    study: StudyName,
    runs: Runs = DEFAULT_RUNS,
    workers: Workers = None,
    threads_per_job: Threads = None,
    scheduler: Scheduler = None,
    slurm: Slurm = False,
    arch: Device = Arch.CPU,
    jobs_per_gpu: JobsPerGpu = None,
    retry_failed: RetryFailed = False,
) -> None:
    """Run every unfinished job of a study."""
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        directory, campaign = _prepare(study, runs)
        if context.info_name == "resume":
            directory.read()
        waiting = sum(decide(job.status, retry_failed).runs for job in states(directory, campaign))
        gpus, jobs_on_gpu = _gpus(arch, jobs_per_gpu)
        here = 0 if scheduler or slurm else gpus * jobs_on_gpu
        slots, threads = share_cores(waiting, workers or here or None, threads_per_job)
        resources = Resources(slots, threads, gpus, jobs_on_gpu, scheduler, slurm)
        with connect(resources) as client, display(Console()) as show:
            directory.write(campaign)
            run = CampaignRun(directory, campaign, client, threads, arch, resources.gpu_share, retry_failed)
            jobs = run.watch(show)
        _finish(directory, jobs, _arguments(study, runs))
    except KeyboardInterrupt:
        raise typer.Exit(
            _complain(f"stopped; go on with: make resume {_arguments(study, runs)}", ExitCode.INTERRUPTED)
        ) from None


def _gpus(arch: Arch, jobs_per_gpu: int | None) -> tuple[int, int]:
    """GPUs of this machine for jobs of a campaign, 0 on the CPU, and jobs on each."""
    if arch != Arch.CPU:
        return len(visible(arch)[1]), jobs_per_gpu or 1
    if jobs_per_gpu:
        raise SceneError("--jobs-per-gpu: jobs run on the CPU; add --arch gpu, or use --workers")
    return 0, 1


@app.command()
def plan(study: StudyName, runs: Runs = DEFAULT_RUNS, retry_failed: RetryFailed = False) -> None:
    """Show what a run would do with every job, and why; nothing is written."""
    directory, campaign = _prepare(study, runs)
    decisions = [(job.id, decide(job.status, retry_failed)) for job in states(directory, campaign)]
    for name, decision in decisions:
        print(f"{'run ' if decision.runs else 'skip'}  {name}  {decision.reason}")
    print(f"{sum(decision.runs for _, decision in decisions)} of {len(decisions)} jobs would run in {directory.path}")


@app.command()
def status(study: StudyName, runs: Runs = DEFAULT_RUNS) -> None:
    """Show how every job stands."""
    directory = _directory(study, runs)
    show_once(Console(), states(directory, directory.read()))


@app.command()
def where(study: StudyName, runs: Runs = DEFAULT_RUNS) -> None:
    """Print the directory of the results of a study."""
    print(_directory(study, runs).path)


def _directory(study: str, runs: Path) -> CampaignDirectory:
    return _directory_of(read_study(find_study(study)), runs)


def _directory_of(study: Study, runs: Path) -> CampaignDirectory:
    return CampaignDirectory(runs.resolve() / study.name)


def _prepare(study: str, runs: Path) -> tuple[CampaignDirectory, Campaign]:
    """The campaign of a study, checked from end to end before anything is written."""
    path = find_study(study)
    content = read_study(path)
    directory = _directory_of(content, runs)
    return directory, directory.admit(expand(content, str(path)))


def _finish(directory: CampaignDirectory, jobs: Sequence[TrackedJob], arguments: str) -> None:
    """Report how each job ended, and exit with code 1 unless every job is done."""
    for job in jobs:
        if job.status.state != JobState.DONE:
            print(f"{job.id}  {job.status.state}: {decide(job.status, False).reason}")
    print(count_by_state([job.status for job in jobs]))
    print(f"jobs in {directory.path}; results and figures with: make plots {arguments}")
    if any(job.status.state != JobState.DONE for job in jobs):
        raise typer.Exit(ExitCode.FAILED)


def _arguments(study: str, runs: Path) -> str:
    """The variables that lead make to the same campaign."""
    return f"STUDY={study}" + (f" RUNS={runs}" if runs != DEFAULT_RUNS else "")


def _complain(message: str, code: int) -> int:
    print(message, file=sys.stderr)
    return code
