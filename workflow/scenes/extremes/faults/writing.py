"""Faults while a run is solved and written: killed, interrupted, without room, without a folder, two at once."""

import os
import resource
import shutil
import signal
import sys
import time
import traceback
from collections.abc import Callable, Iterator
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import Any

from fracparticles.command_line.cli import main
from fracparticles.command_line.program import app
from fracparticles.files import replacing
from fracparticles.run.case import Case
from fracparticles.run.dataset import to_dataset, write
from fracparticles.run.solver import compute
from fracstudy.probe import HELD, Kind, Probe
from scenes.extremes.faults.processes import begun, counted, ended, forked, moments

FIELDS = {"scheme": "KPSE", "order": 4, "beta": 0.5, "half_width": 10.0, "spacing": 0.25}
FLAGS = ["solve", *(w for k, v in FIELDS.items() for w in (f"--{k.replace('_', '-')}", str(v)))]
FLAGS += ["--dt", "0.05", "-o"]
_OLD = b"what was there before"


class Setup:
    """A case, its file from an undisturbed run, and a folder to spoil."""

    def __init__(self, folder: Path) -> None:
        self.case = Case(**FIELDS, dt=0.05)
        self.folder, self.path = folder / "runs", folder / "runs/run.nc"
        self.run()  # the first one loads what is compiled
        start = time.perf_counter()
        self.run()
        self.took = time.perf_counter() - start
        self.right = self.path.read_bytes()
        app.parse_args([*FLAGS, "x"])  # the command line has imported all it needs, too

    def run(self) -> int:
        """Solve and write."""
        write(to_dataset(compute(self.case)), self.path)
        return 0

    def afresh(self) -> None:
        """Empty the folder but for an old file."""
        shutil.rmtree(self.folder, ignore_errors=True)
        self.folder.mkdir(parents=True)
        self.path.write_bytes(_OLD)

    @property
    def whole(self) -> bool:
        """Whether the file is the old one or that of an undisturbed run."""
        return self.path.read_bytes() in (_OLD, self.right)

    @property
    def mended(self) -> bool:
        """Whether the next call gives the file of an undisturbed run, and nothing else."""
        again, left = forked(self.run), os.listdir(self.folder)
        mended = again == (0, "") and left == ["run.nc"] and self.path.read_bytes() == self.right
        if not mended:  # for the log
            print(f"The next call: {again}, in the folder {left}")
        return mended


def one_line(text: str) -> bool:
    """Whether this is one line that says what is wrong."""
    return text.count("\n") == 1 and text.startswith("error: ")


def probes(setup: Setup, kills: int, interrupts: int, parts: int, seed: int) -> Iterator[Probe]:
    """Each fault some times; afterwards the next call, in the same folder."""
    killed, stopped = list(moments(kills, seed)), list(moments(interrupts, seed + 1))
    sizes = [round(len(setup.right) * share / parts) for share in range(parts)]
    moment, disk = f"at {interrupts} moments, command line", "a disk full after 0, 1, .. of"
    again = "the old file or the new one; then as undisturbed"
    line = "status 130 and a line, or done; then as undisturbed"
    refused = "a line, the old file kept; then as undisturbed"
    a_line, anew = "a line; then as undisturbed", "made again; as undisturbed"
    once = [None]
    faults: tuple[tuple[str, str, str, Callable[..., bool], list[Any]], ...] = (
        ("killed", again, f"SIGKILL at {kills} moments of a run", _killed, killed),
        (
            "killed",
            again,
            "SIGTERM at as many as interrupts",
            partial(_killed, by=signal.SIGTERM),
            stopped,
        ),
        ("interrupted", line, f"SIGINT {moment}", _interrupted, stopped),
        ("no room", refused, f"{disk} {parts} parts of the file", _no_room, sizes),
        ("no room", refused, "the same, command line", _no_room_for_the_command, sizes[::4]),
        ("no room", refused, "standard output on a full disk", _full_output, once),
        ("folder", refused, "read-only", _read_only, once),
        ("folder", anew, "gone while the case is solved", _folder_gone, once),
        ("folder", a_line, "gone while the file is written", _gone_meanwhile, once),
        ("folder", a_line, "the working directory is gone", _nowhere, once),
        ("two at once", again, f"the same file, {parts} times", _two_at_once, once * parts),
    )
    for kind, expected, case, fault, over in faults:
        mended = Kind(kind, expected, must=HELD)
        yield mended(case, lambda: counted(_mended_after(setup, fault, one) for one in over))


def _mended_after(setup: Setup, fault: Callable[..., bool], one: Any) -> bool:
    """Whether a fault does what it may in a fresh folder, and the next call ends as if it had not been."""
    setup.afresh()
    return fault(setup, one) and setup.mended


def _killed(setup: Setup, moment: float, by: int = signal.SIGKILL) -> bool:
    ended(begun(setup.run), moment * setup.took, by)
    return setup.whole


def _interrupted(setup: Setup, moment: float) -> bool:
    status, text = ended(begun(lambda: _command(setup)), moment * setup.took, signal.SIGINT)
    said = (status, text) in [(0, f"{setup.path}\n"), (130, "error: interrupted\n")]
    late = status == 130 and text == f"{setup.path}\nerror: interrupted\n"
    if not (said or late):  # for the log: it is rare
        print(f"SIGINT at {moment:.6f} of a run: status {status}, {text!r}")
    return (said or late) and setup.whole


def _command(setup: Setup) -> int:
    try:
        signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})
        status = main([*FLAGS, str(setup.path)])
        sys.stdout.flush()
        signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    except KeyboardInterrupt as error:
        # In the instant before it began, or after it ended: it was not at work.
        if "_run" in {frame.name for frame in traceback.extract_tb(error.__traceback__)}:
            raise
        print("error: interrupted", file=sys.stderr)
        return 130
    return status


def _limited(size: int | None) -> None:
    most = resource.getrlimit(resource.RLIMIT_FSIZE)[1]
    resource.setrlimit(resource.RLIMIT_FSIZE, (most if size is None else size, most))


def _no_room(setup: Setup, size: int) -> bool:
    def work() -> int:
        _limited(size)
        with suppress(OSError):
            setup.run()
            return 1
        if os.listdir(setup.folder) != ["run.nc"] or setup.path.read_bytes() != _OLD:
            return 2
        _limited(None)
        return setup.run()  # in the same process

    return forked(work)[0] == 0


def _refused(setup: Setup, prepare: Callable[[], object], *status: int) -> bool:
    """Whether the command line ends with an error in one line, and the old file is as it was."""

    def work() -> int:
        prepare()
        return main([*FLAGS, str(setup.path)])

    found, text = forked(work)
    kept = not setup.path.exists() or setup.path.read_bytes() in (_OLD, setup.right)
    return found in status and one_line(text) and kept


def _no_room_for_the_command(setup: Setup, size: int) -> bool:
    return _refused(setup, lambda: _limited(size), 1)


def _full_output(setup: Setup, _: None) -> bool:
    return _refused(setup, lambda: os.dup2(os.open("/dev/full", os.O_WRONLY), 1), 1)


def _read_only(setup: Setup, _: None) -> bool:
    def dropped() -> None:
        if os.geteuid() == 0:  # whom permissions do not stop
            os.seteuid(65534)

    setup.folder.parent.chmod(0o755)
    setup.folder.chmod(0o555)
    refused = _refused(setup, dropped, 1, 2) and setup.path.read_bytes() == _OLD
    setup.folder.chmod(0o755)
    return refused


def _folder_gone(setup: Setup, _: None) -> bool:
    def work() -> int:
        run = to_dataset(compute(setup.case))
        shutil.rmtree(setup.folder)
        write(run, setup.path)
        return 0

    return forked(work) == (0, "") and setup.path.read_bytes() == setup.right


def _gone_meanwhile(setup: Setup, _: None) -> bool:
    def work() -> int:
        with replacing(setup.path) as temporary:
            temporary.write_bytes(setup.right)
            shutil.rmtree(setup.folder)
        return 0

    status, text = forked(work)
    return status == 99 and text.startswith("FileNotFoundError")


def _nowhere(setup: Setup, _: None) -> bool:
    def work() -> int:
        place = setup.folder / "gone"
        place.mkdir()
        os.chdir(place)
        place.rmdir()
        return main([*FLAGS, "run.nc"])

    status, text = forked(work)
    return status in (1, 2) and one_line(text)


def _two_at_once(setup: Setup, _: None) -> bool:
    first, second = begun(setup.run), begun(setup.run)
    both = ended(first) == ended(second) == (0, "")
    return both and setup.path.read_bytes() == setup.right
