"""`python -m campaigns.parent_death PARENT COMMAND...`: become COMMAND, stopped when PARENT ends, be it by kill -9.

Only Linux offers this; elsewhere the command outlives its parent, and the next run finds it still running.
The kernel watches the thread that started this process, so that thread must wait for it.
"""

import ctypes
import os
import signal
import sys

PR_SET_PDEATHSIG = 1
"""prctl option: the signal this process gets when its parent ends (linux/prctl.h)."""


def tethered(command: list[str]) -> list[str]:
    """The command, tied to the life of this process."""
    return [sys.executable, "-m", "campaigns.parent_death", str(os.getpid()), *command]


def become(parent: int, command: list[str]) -> None:
    """Turn this process into `command`, which gets SIGTERM when `parent` ends."""
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGTERM)
    if os.getppid() != parent:
        sys.exit(f"the process {parent} that started this job has ended")
    os.execvp(command[0], command)


if __name__ == "__main__":
    become(int(sys.argv[1]), sys.argv[2:])
