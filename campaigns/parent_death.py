"""`python -m campaigns.parent_death PARENT COMMAND...`: run COMMAND, which is stopped when the process PARENT ends.

This is so for any end of PARENT, also by SIGKILL. Only Linux offers it; elsewhere COMMAND outlives PARENT, and the
next run finds it still running. The signal is sent when the thread that started this process ends, so that thread
must wait for it.
"""

import ctypes
import os
import signal
import sys

PR_SET_PDEATHSIG = 1
"""prctl option: the signal this process gets when its parent ends (linux/prctl.h)."""


def tethered(command: list[str]) -> list[str]:
    """The command line that runs `command` until it or this process ends."""
    return [sys.executable, "-m", "campaigns.parent_death", str(os.getpid()), *command]


def become(parent: int, command: list[str]) -> None:
    """Replace this process by `command`, which gets SIGTERM when the process `parent` ends."""
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGTERM)
    if os.getppid() != parent:
        sys.exit(f"the process {parent} that started this job has ended")
    os.execvp(command[0], command)


if __name__ == "__main__":
    become(int(sys.argv[1]), sys.argv[2:])
