"""Running the whole matrix, each case in a process of its own, so that one that dies is an outcome too."""

import logging
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from functools import partial
from pathlib import Path

from engine.device import backend
from engine.job.directory import JobDirectory
from engine.verification.processes import in_own_process
from engine.verification.stability.cases import all_cases
from engine.verification.stability.outcome import CaseResult, failure, run_case
from engine.verification.stability.von_neumann import BLOCKS, Block, Limit


def run_all(jobs: Path, workers: int) -> Iterator[CaseResult]:
    """Run every case; yield its outcome, in the order of the matrix.

    Args:
        jobs: directory in which each case gets its job directory.
        workers: cases at the same time, one thread each.
    """
    with ThreadPoolExecutor(workers) as threads:
        yield from threads.map(partial(run_apart, jobs), range(len(all_cases())))


def run_apart(jobs: Path, index: int) -> CaseResult:
    """Run one case, by its index in the matrix, in a process of its own and of its precision."""
    case = all_cases()[index]
    try:
        return in_own_process(case.scene.numerics.precision, _run_indexed, index, jobs / f"{index:03d}")
    except BrokenProcessPool:
        return failure(case, "its process died")


def _run_indexed(index: int, directory: Path) -> CaseResult:
    """Run a case known by its index: cases contain functions, which cannot be passed to another process."""
    directory.mkdir(parents=True)
    logging.basicConfig(filename=JobDirectory(directory).log, level=logging.INFO, format="%(asctime)s %(message)s")
    return run_case(all_cases()[index], directory)


def find_limits() -> Iterator[Limit]:
    """Yield the largest stable time step of every block, by theory and in the engine."""
    for block in BLOCKS:
        yield in_own_process("f64", _limit, block)


def _limit(block: Block) -> Limit:
    backend.start(threads=1)
    return block.limit()
