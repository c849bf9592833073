"""What a busy machine must not hold up in a test, because on a robot nothing would: the scanner, and who takes messages off the
wire. Where the priority is not granted they are held up like any program."""
import contextlib
import os

ABOVE_THE_FIRMWARE = 90
NICE_ABOVE_ALL_PROGRAMS = -15


def as_hardware():
    """For this process or thread from now on."""
    with contextlib.suppress(PermissionError):
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(ABOVE_THE_FIRMWARE))


def as_own_processor():
    """For the process of an emulated machine: its processors, of which programs of this one take little."""
    with contextlib.suppress(PermissionError):
        os.setpriority(os.PRIO_PROCESS, 0, NICE_ABOVE_ALL_PROGRAMS)


@contextlib.contextmanager
def threads_as_hardware():
    """For the threads that are begun in it."""
    as_hardware()
    try:
        yield
    finally:
        os.sched_setscheduler(0, os.SCHED_OTHER, os.sched_param(0))
