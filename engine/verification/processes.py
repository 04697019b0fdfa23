"""Work in processes of their own: a process holds one Taichi program, of one precision."""

from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from typing import ParamSpec, TypeVar

from engine.device.options import Precision, choose

Given = ParamSpec("Given")
Result = TypeVar("Result")


def in_own_process(
    precision: Precision, function: Callable[Given, Result], *arguments: Given.args, **named: Given.kwargs
) -> Result:
    """Run a function in a new process of a precision; return what it returns.

    Raises:
        BrokenProcessPool: the process died.
    """
    # the initializer runs before the function, and so any device module, is imported
    spawn = get_context("spawn")
    with ProcessPoolExecutor(1, mp_context=spawn, initializer=choose, initargs=(precision,)) as pool:
        return pool.submit(function, *arguments, **named).result()
