"""Running the whole matrix, each case in a process of its own: even one that dies is an outcome."""

import logging
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from functools import partial
from multiprocessing import get_context
from pathlib import Path
from typing import ParamSpec, TypeVar

from engine import backend
from engine.jobdir import JobDirectory
from engine.precision import Precision, choose
from engine.verification.stability.cases import all_cases
from engine.verification.stability.outcome import Outcome, failure, run_case
from engine.verification.stability.von_neumann import BLOCKS, Block, Limit

Given = ParamSpec("Given")
Result = TypeVar("Result")


def in_own_process(
    precision: Precision, function: Callable[Given, Result], *arguments: Given.args, **named: Given.kwargs
) -> Result:
    """What a function returns in a new process that computes in a precision.

    Raises:
        BrokenProcessPool: the process died.
    """
    # the initializer runs before the function, and so any device module, is imported
    spawn = get_context("spawn")
    with ProcessPoolExecutor(1, mp_context=spawn, initializer=choose, initargs=(precision,)) as pool:
        return pool.submit(function, *arguments, **named).result()


def run_all(jobs: Path, workers: int) -> Iterator[Outcome]:
    """Run every case.

    Args:
        jobs: directory in which each case gets its job directory.
        workers: cases at the same time, one thread each.
    """
    with ThreadPoolExecutor(workers) as threads:
        yield from threads.map(partial(run_apart, jobs), range(len(all_cases())))


def run_apart(jobs: Path, number: int) -> Outcome:
    """Run one case, by its place in the matrix, in a process of its own and of its precision."""
    case = all_cases()[number]
    try:
        return in_own_process(case.scene.numerics.precision, _run_numbered, number, jobs / f"{number:03d}")
    except BrokenProcessPool:
        return failure(case, "its process died")


def _run_numbered(number: int, directory: Path) -> Outcome:
    """Cases hold functions, which another process cannot be given; their place in the matrix it can."""
    directory.mkdir(parents=True)
    logging.basicConfig(filename=JobDirectory(directory).log, level=logging.INFO, format="%(asctime)s %(message)s")
    return run_case(all_cases()[number], directory)


def find_limits() -> Iterator[Limit]:
    """The largest stable time step of every block, by theory and in the engine."""
    for block in BLOCKS:
        yield in_own_process("f64", _limit, block)


def _limit(block: Block) -> Limit:
    backend.start(threads=1)
    return block.limit()
