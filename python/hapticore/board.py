# SPDX-License-Identifier: MIT OR Apache-2.0
"""A board, real or virtual."""

from __future__ import annotations

import os
import weakref
from collections.abc import Callable, Iterable, Mapping
from types import TracebackType
from typing import Any

from hapticore import _core, _values
from hapticore.frames import Frames

_Path = str | os.PathLike[str]


def _ask(what: str) -> None:
    input(f"{what}, then press Enter ")


class Board:
    """A board from `connect`; as a context manager it is closed with its block.

    A thread of its own reads the line and keeps what comes until `read` takes it. The drive is off
    until `arm`, and off again after `disarm`, `close`, an exception in the ``with`` block, garbage
    collection and the end of the interpreter; then the board is disabled, too. Of a process that is
    killed, the board misses the signs of life, and takes its drives to 0 V by itself.

    **A program that hangs loses the drive.** After 1 s without a call of `read`, `alive`, `arm`,
    `disarm`, `target`, `wall` or `lead` the drive is disarmed (`notes` says so), until `arm` is called
    again. A `read` that waits is a sign of life all the time.

    Notes
    -----
    Threads may share a board. The interpreter's lock is released while a call waits. Ctrl-C ends
    one within 0.2 s; frames that came are kept for the next `read`.

    Examples
    --------
    >>> import hapticore as hc
    >>> with hc.connect("virtual:minimal-sheet") as board:
    ...     frames = board.read(frames=20)
    >>> frames.slots
    20
    """

    def __init__(self, link: _core.Link, port: str) -> None:
        self._link = link
        self._port = port
        # Also when this object is collected, and before the interpreter ends.
        self._close = weakref.finalize(self, link.close)

    def __repr__(self) -> str:
        return f"Board at {self._port}, {self.phase}"

    @property
    def phase(self) -> str:
        """Where it is: ``"disconnected"``, ``"silent"``, ``"identifying"``, ``"starting up"``,
        ``"testing lines"``, ``"measuring"``, ``"armed"``, ``"refused"``, ``"checking"`` or
        ``"closed"``."""
        return self._link.phase

    @property
    def identity(self) -> str | None:
        """What the board has said that it is: protocol, digest of its profile, drive output."""
        return self._link.identity

    @property
    def title(self) -> str:
        """What is connected: ``"virtual board: …"``, ``"board at …"``."""
        return self._link.title

    @property
    def notes(self) -> list[str]:
        """What a user should read, the oldest first: what happened, what to do. The last 1000."""
        return self._link.notes

    @property
    def statistics(self) -> dict[str, int]:
        """Counts since the line was opened first.

        ===================  =====================================================================
        ``frames``           frames that have come whole
        ``heartbeats``       packets of a board that is disabled or starts up
        ``lost``             frames that were sent and have not come
        ``dropped``          frames that the board has dropped, since its line was busy
        ``damaged``          packets that were damaged on the way
        ``refused``          packets that report a command that the board has refused
        ``late``             packets that report that the ADC was late
        ``bytes``            bytes that have come
        ``connections``      how often the line was opened
        ``overflowed``       bytes that were left out, since this process did not keep up
        ``unread``           frames that wait for `read`
        ``unread_dropped``   frames beyond 131,072 waiting ones: the oldest were dropped
        ===================  =====================================================================
        """
        return dict(self._link.statistics)

    @property
    def slot_s(self) -> float:
        """Length of a slot, s."""
        return self._link.slot_s

    @property
    def pads(self) -> list[str]:
        """Names of the pads."""
        return self._link.pads

    @property
    def parts_mm(self) -> list[tuple[float, float]]:
        """Centres of a pad's parts relative to its own, mm, as of `Display`."""
        return self._link.parts_mm

    @property
    def sheet_mm(self) -> tuple[float, float]:
        """Width and height of the sheet, mm; of a real board at least those of its calibration."""
        return self._link.sheet_mm

    def read(
        self,
        frames: int | None = None,
        seconds: float | None = None,
        *,
        timeout_s: float = 10.0,
    ) -> Frames:
        """Take frames, from the oldest that was not read yet.

        Parameters
        ----------
        frames : int, optional
            How many, 0 to 131,072; waits until so many are there.
        seconds : float, optional
            Wait this long, s, then take all that are there.
        timeout_s : float
            With ``frames``: the longest wait for the next frame, s.

        Returns
        -------
        Frames
            Shape (slots,), as of `Display.step` without truth; with a drive also ``target_n``,
            ``drive_v_rms``, ``drive_limited``, ``drive_fault``. Without ``frames`` and ``seconds``
            those that are there already. ``time_s`` is counted from the board's first frame.

        Raises
        ------
        BoardError
            The line is not open, the board was refused or closed, no frame came in time.
        Error
            Both ``frames`` and ``seconds``, a number out of its range.
        """
        if frames is not None and seconds is not None:
            from hapticore.errors import Error

            raise Error("read: expected either frames or seconds, got both")
        rows = self._link.read(
            None if frames is None else _values.count("frames", frames),
            None if seconds is None else float(seconds),
            float(timeout_s),
        )
        return Frames(rows, {"port": self._port, "board": self.identity})

    def alive(self) -> None:
        """Show that the program is alive: an armed drive is disarmed after 1 s without a call.

        Raises
        ------
        BoardError
            The board was closed.
        """
        self._link.alive()

    def arm(self) -> None:
        """Let the drives follow their targets, which are 0 N at first.

        Raises
        ------
        BoardError
            A board without a drive or without a tuning, or one that does not measure.
        """
        self._link.arm()

    def disarm(self) -> None:
        """Take all drives to 0 V; the board goes on measuring.

        Raises
        ------
        BoardError
            The board was closed.
        """
        self._link.disarm()

    def target(self, pad: int, newtons: float) -> None:
        """Set the force of a pad of an armed drive.

        Parameters
        ----------
        pad : int
            Number of the pad.
        newtons : float
            The force, N, from 0 to the tuning's cap.

        Raises
        ------
        BoardError
            No such pad, a force out of its range, a drive that is off.
        """
        self._link.target(_values.count("pad", pad), newtons)

    def wall(self, x_mm: float | None = None, y_mm: float | None = None, *, off: bool = False) -> None:
        """Move the wall along x, or take it away.

        Parameters
        ----------
        x_mm : float, optional
            Where the wall begins, mm from the centre of the sheet.
        y_mm : float, optional
            Refused: the wall along y keeps the place that the board has.
        off : bool
            There is no wall until it gets a place again.

        Raises
        ------
        BoardError
            A board whose profile has no walls, a wall along y.
        Error
            Neither or both of place and off.
        """
        self._link.wall(x_mm, y_mm, off)

    def lead(self, pad: int, x_mm: float, y_mm: float, within_s: float = 0.012) -> None:
        """Lead a pad of a virtual board, or the finger on it, on a line to a place.

        Parameters
        ----------
        pad : int
            Number of the pad.
        x_mm, y_mm : float
            The place, mm from the centre of the sheet.
        within_s : float
            After how long it is there, s.

        Raises
        ------
        BoardError
            A real board; no such pad, a place beyond the sheet.
        """
        self._link.lead(_values.count("pad", pad), x_mm, y_mm, within_s)

    def check(self, ask: Callable[[str], object] = _ask) -> list[str]:
        """Check the wiring, the drive off: data lines, wires, channels, pads.

        The board is disconnected meanwhile, and brought up again afterwards. Pads of a virtual
        board are led to their places, and stay at the last one: with the scene's mean load, and
        without its haptic voltage.

        Parameters
        ----------
        ask : callable
            Called with what a person must do, ``"put pad 0 at x = -180 mm, y = 100 mm"``; the check
            goes on once it returns. By default it prints that and waits for Enter.

        Returns
        -------
        list of str
            What is wrong and what to do; empty where everything is as the calibration expects.

        Raises
        ------
        BoardError
            A board that does not start up for another reason, a calibration without shares of the
            currents.
        """
        return self._link.check(ask)

    def close(self) -> None:
        """Take drives to 0 V, disable the board, close its line; later calls do nothing."""
        self._close()

    def __enter__(self) -> Board:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()


def connect(
    port: _Path,
    *,
    calibration: _Path | None = None,
    profile: _Path | None = None,
    baud: int | None = None,
    control: str | None = None,
    dac: str | None = None,
    wave: str | None = None,
    full_scale_v: int | None = None,
    tuning: _Path | None = None,
    set: Mapping[str, Any] | None = None,
    faults: Iterable[str] = (),
    timeout_s: float = 30.0,
) -> Board:
    """Connect to a board and bring it up, as ``hapticore host`` does (docs/first-light.md).

    Parameters
    ----------
    port : str or path
        A serial port, ``"tcp:ADDRESS:PORT"``, ``"virtual"`` or ``"virtual:SCENE"``: a simulated
        board in real time in this process.
    calibration : str or path, optional
        The device's calibration file; a virtual board has its device's.
    profile : str or path, optional
        The profile that the board was printed for; by default ``"standard"``, or the scene's.
    baud : int, optional
        Bits a second of the line, 1200 to 12,000,000; by default 1,000,000, of a virtual board
        whose frames need more 3,000,000.
    control : str, optional
        The law of the controller that a board with a drive was printed with: ``"open"``,
        ``"proportional"``, ``"integral"``, ``"inverse"``.
    dac, wave : str, optional
        The converter and the wave that it was printed for; the wave is ``"square"`` by default.
    full_scale_v : int, optional
        The voltage of a drive word of full scale, 1 to 65,535 V; by default 500.
    tuning : str or path, optional
        The tuning of its controller, as ``hapticore simulate`` writes it; without one the drive
        cannot be armed. A virtual board has its scene's.
    set : dict, optional
        Keys of a virtual board's scene and their values, as for `simulate`.
    faults : iterable of str, optional
        What is wrong with a virtual board, by the names of docs/first-light.md: ``["open=3"]``.
    timeout_s : float
        How long the board may take until it measures, s. 0 returns immediately: for `Board.check` of
        a board that does not start up.

    Returns
    -------
    Board
        It measures; its drive is off.

    Raises
    ------
    BoardError
        A line that cannot be opened, a board that refuses its start-up or is silent.
    SceneError, ProfileError, Error, OSError
        As `simulate`; a calibration or tuning that cannot be used, keywords that do not fit.

    Examples
    --------
    >>> import hapticore as hc
    >>> with hc.connect("virtual:fig9") as board:
    ...     print(board.phase, "drive_v_rms" in board.read())
    measuring True
    """
    name = _values.name(port)
    link = _core.Link(
        name,
        set=_values.settings(set),
        faults=[str(fault) for fault in faults],
        calibration=None if calibration is None else _values.name(calibration),
        profile=None if profile is None else _values.name(profile),
        baud=None if baud is None else min(_values.count("baud", baud), (1 << 32) - 1),
        control=control,
        dac=dac,
        wave=wave,
        full_scale_v=None if full_scale_v is None else _full_scale(full_scale_v),
        tuning=None if tuning is None else _values.name(tuning),
        timeout_s=float(timeout_s),
    )
    return Board(link, name)


def _full_scale(volts: int) -> int:
    number = _values.count("full_scale_v", volts, 1)
    if number > 65535:
        from hapticore.errors import Error

        raise Error(f"full_scale_v: expected 1 to 65535, got {number}")
    return number
