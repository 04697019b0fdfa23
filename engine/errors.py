"""What the engine tells its user when it cannot go on."""


class SceneError(ValueError):
    """The input cannot be used: says which file and key, what was given, and what is allowed."""


class JobError(RuntimeError):
    """The job directory cannot be run: of another physics version, or damaged."""


class JobBusyError(JobError):
    """Another process runs the job."""


class RunFault(RuntimeError):
    """A running simulation left the range in which its equations hold: says which quantity, particle and time."""
