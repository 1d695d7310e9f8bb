# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds the program thalweg and runs it."""
from __future__ import annotations

import json
import os
import queue
import re
import shlex
import shutil
import signal
import subprocess
import threading
import time
from dataclasses import dataclass
from typing import Any

from qgis.core import QgsProcessingException, QgsProcessingFeedback, QgsSettings

from .advice import in_qgis

SETTING = "THALWEG_PROGRAM"
CHECK_FAILED = 3  # exit status
ASKED_WITHIN = 5  # [s] that the program has to say what it can do
ENDS_WITHIN = 5  # [s] from SIGINT to SIGKILL
WHERE = "Settings > Options > Processing > Providers > thalweg"
NO_WINDOW = getattr(subprocess, "CREATE_NO_WINDOW", 0)  # of Windows, which opens a console for each program

# The part of a whole run [%] that a stage takes, in their order; others leave the bar where it is. Runs that make a terrain say
# themselves what their stages take.
STAGES: dict[str, dict[str, tuple[int, int]]] = {
    "make": {},
    "rebuild": {},
    "check": {"adopt": (0, 30), "check": (30, 80), "read": (80, 90), "write": (90, 100)},
    "convert": {"read": (0, 60), "write": (60, 100)},
    "measure": {"read": (0, 40), "outline": (60, 90)},
    "tin": {"read": (0, 20), "tin": (20, 95)},
    "blend": {"read": (0, 10), "warp": (10, 30), "blend": (30, 40), "solve": (40, 90), "write": (90, 100)},
    "draw": {"read": (0, 10), "adopt": (10, 15), "check": (15, 30), "map": (30, 50), "contours": (50, 55), "profile": (55, 65),
             "wireframe": (65, 90)},
}


class ProgramError(Exception):
    """Why the program cannot be run, and what to do about it, in words."""


@dataclass(frozen=True)
class Program:
    """A program that can be run."""

    path: str
    version: str
    keys: tuple[dict[str, Any], ...]  # of `thalweg recipe --json`, in the order of a recipe


@dataclass(frozen=True)
class Finished:
    """What a run of the program gave."""

    report: dict[str, Any]  # what it prints with --json
    passed: bool  # False: a check failed
    heard: tuple[str, ...] = ()  # what it wrote to the log


def configured() -> str:
    """Return the program that the user set, or nothing."""
    return str(QgsSettings().value(f"Processing/Configuration/{SETTING}", "") or "").strip()


def _located() -> str:
    wanted = configured()
    if not wanted:
        found = shutil.which("thalweg")
        if found is None:
            raise ProgramError("the program thalweg is not in PATH. Install it (Debian: the package thalweg), or name it in "
                               f"{WHERE}.")
        return os.path.abspath(found)
    path = os.path.abspath(os.path.expanduser(wanted))
    if os.path.isdir(path):
        raise ProgramError(f"{path} is a folder. Name the program thalweg itself in {WHERE}.")
    if not os.path.exists(path):
        raise ProgramError(f"there is no program {path}. Correct its name in {WHERE}, or leave it empty to take thalweg from "
                           "PATH.")
    if not os.access(path, os.X_OK):
        raise ProgramError(f"{path} is not executable. Make it so, or name another program in {WHERE}.")
    return path


def _said(path: str, *arguments: str) -> str:
    """What the program prints to such a question."""
    try:
        done = subprocess.run([path, *arguments], stdin=subprocess.DEVNULL, capture_output=True, timeout=ASKED_WITHIN,
                              creationflags=NO_WINDOW)
    except subprocess.TimeoutExpired:
        words = f"{path} does not answer within {ASKED_WITHIN} s. Is it thalweg? {WHERE} names the program."
        raise ProgramError(words) from None
    except OSError as why:
        raise ProgramError(f"{path} does not start: {why.strerror}. {WHERE} names the program.") from why
    if done.returncode != 0:
        words = done.stderr.decode("utf-8", "replace").strip()
        raise ProgramError(f"{path} {' '.join(arguments)}: {_ended(done.returncode)}. {words[:400]}\n"
                           f"Is it thalweg? {WHERE} names the program.")
    return done.stdout.decode("utf-8", "replace")


def _asked(path: str) -> Program:
    if not re.search(r"(?m)^ +rebuild ", _said(path, "--help")):
        raise ProgramError(f"{path} is older than this plugin needs: it has no command rebuild. Install a newer thalweg, or "
                           f"name another program in {WHERE}.")
    try:
        keys = tuple(json.loads(_said(path, "recipe", "--json"))["keys"])
    except (ValueError, KeyError, TypeError):
        raise ProgramError(f"{path} recipe --json prints no table of keys. Is it thalweg? {WHERE} names the program.") from None
    version = _said(path, "--version").split("\n", 1)[0].removeprefix("thalweg").partition("(")[0].strip()
    return Program(path, version, keys)


_answers: dict[str, tuple[int, Program | ProgramError]] = {}


def find() -> Program:
    """Return the program of the setting, or that in PATH. Each one is asked once, until its file changes.

    Raises
    ------
    ProgramError
        When it is missing, not executable, not thalweg or too old.
    """
    path = _located()
    changed = os.stat(path).st_mtime_ns
    known = _answers.get(path)
    if known is None or known[0] != changed:
        try:
            known = changed, _asked(path)
        except ProgramError as why:
            known = changed, why
        _answers[path] = known
    if isinstance(known[1], ProgramError):
        raise ProgramError(str(known[1]))
    return known[1]


def _ended(code: int) -> str:
    """How a program ended, in words."""
    if code >= 0:
        return f"it ended with exit status {code}"
    try:
        return f"it was ended by {signal.Signals(-code).name}"
    except ValueError:
        return f"it was ended by signal {-code}"


def _read_lines(stream: Any, lines: queue.SimpleQueue[bytes | None]) -> None:
    for line in stream:
        lines.put(line)
    lines.put(None)


def _read_all(stream: Any, printed: list[bytes]) -> None:
    printed.append(stream.read())


def without_columns(line: str) -> str:
    """Return a line of the log, such as "read       60 lines of a.gpkg       0.1 s", for QGIS, whose log has no columns."""
    named = re.sub(r"^([a-z]+(?:_[a-z]+)+) (?=\S)", lambda kind: f"{kind[1].replace('_', ' ')}: ", line)
    return re.sub(r" {2,}([\d.]+ s|ok)$", r", \1", re.sub(r"^(\w+) {2,}", r"\1: ", named))


class _Listener:
    """Passes on what the program writes to stderr."""

    def __init__(self, command: str, folder: str, feedback: QgsProcessingFeedback, keys: frozenset[str]) -> None:
        self.folder = os.path.join(folder, "")  # a layer that was written to it is named without it
        self.feedback = feedback
        self.parts: dict[str, tuple[float, float]] = dict(STAGES.get(command, {}))
        self.shown = 0.0
        self.keys = keys
        self.error: list[str] = []
        self.heard: list[str] = []

    def hear(self, line: str) -> None:
        line = line.replace(self.folder, "")
        if line.startswith("{"):
            try:
                state = json.loads(line)
                if "finding" in state:
                    self.tell(state["finding"])
                elif "stages" in state:
                    self.plan(state["stages"])
                else:
                    self.move(str(state["stage"]), float(state["share"]))
                return
            except (ValueError, KeyError, TypeError):
                pass
        if line.startswith("error:") or self.error:
            self.error.append(line.removeprefix("error:").strip() if not self.error else line)
        elif line.strip():
            self.heard.append(line)
            self.feedback.pushInfo(in_qgis(without_columns(line), self.keys))

    def tell(self, finding: dict[str, Any]) -> None:
        if any(finding["text"] in line for line in self.heard):
            return
        self.heard.append(finding["text"])
        words = ". ".join(filter(None, (finding["text"], finding.get("remedy", "") if finding["severity"] == "warning" else "")))
        if finding["severity"] == "warning":
            self.feedback.pushWarning(in_qgis(words, self.keys))
        elif finding["severity"] == "note":
            self.feedback.pushInfo(f"{finding['kind'].replace('_', ' ')}: {in_qgis(words, self.keys)}")

    def plan(self, stages: list[dict[str, Any]]) -> None:
        """Take the part of each stage from the seconds that it is expected to take; of stages of one name, of them all."""
        whole = sum(float(stage["seconds"]) for stage in stages) or 1.0
        begin = 0.0
        for stage in stages:
            end = min(begin + 100.0 * float(stage["seconds"]) / whole, 100.0)
            self.parts[stage["stage"]] = (self.parts.get(stage["stage"], (begin, end))[0], end)
            begin = end

    def move(self, stage: str, share: float) -> None:
        begin, end = self.parts.get(stage, (0, 0))
        now = begin + (end - begin) * min(max(share, 0.0), 1.0)
        if now > self.shown:
            self.shown = now
            self.feedback.setProgress(now)


def _stop(process: subprocess.Popen[bytes]) -> None:
    """Asks the program to end; it then takes away what it has begun to write."""
    if os.name == "posix":
        process.send_signal(signal.SIGINT)
    else:
        process.terminate()
    try:
        process.wait(ENDS_WITHIN)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()


def run(program: Program, arguments: list[str], folder: str, feedback: QgsProcessingFeedback) -> Finished | None:
    """Run a command of the program until it ends or the user cancels it.

    Parameters
    ----------
    program : Program
        The program.
    arguments : list of str
        The command and its options.
    folder : str
        Working folder.
    feedback : QgsProcessingFeedback
        Hears the log lines, warnings and progress, and is asked whether the user cancelled.

    Returns
    -------
    Finished or None
        What the program printed; None when the user cancelled.

    Raises
    ------
    QgsProcessingException
        When the program fails, with its own words.
    """
    command = [program.path, *arguments]
    feedback.pushCommandInfo(shlex.join(command))
    try:
        process = subprocess.Popen(command, cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, creationflags=NO_WINDOW)
    except OSError as why:
        raise QgsProcessingException(f"{program.path} does not start: {why.strerror}. {WHERE} names the program.") from why
    out, err = process.stdout, process.stderr
    assert out is not None and err is not None
    lines: queue.SimpleQueue[bytes | None] = queue.SimpleQueue()
    printed: list[bytes] = []
    readers = [threading.Thread(target=_read_lines, args=(err, lines), daemon=True),
               threading.Thread(target=_read_all, args=(out, printed), daemon=True)]
    for reader in readers:
        reader.start()
    keys = frozenset(key["key"] for key in program.keys)
    listener = _Listener(arguments[0], folder, feedback, keys)
    try:
        while True:
            if feedback.isCanceled():
                feedback.pushInfo("Cancelled: stopping thalweg")
                return None
            try:
                line = lines.get(timeout=0.1)
            except queue.Empty:
                continue
            if line is None:
                break
            listener.hear(line.decode("utf-8", "replace").rstrip("\r\n"))
        while process.poll() is None and not feedback.isCanceled():
            time.sleep(0.02)
        if feedback.isCanceled() and process.returncode not in (0, CHECK_FAILED):
            return None
    finally:
        if process.poll() is None:
            _stop(process)
        for reader in readers:
            reader.join(ENDS_WITHIN)
        out.close()
        err.close()
    return _finished(process.returncode, b"".join(printed), listener, keys)


class _Silent(QgsProcessingFeedback):
    """Is cancelled with another one, and says nothing."""

    def __init__(self, other: QgsProcessingFeedback) -> None:
        super().__init__(False)
        self.other = other

    def isCanceled(self) -> bool:
        return self.other.isCanceled()

    def pushInfo(self, info: str) -> None:
        pass

    pushWarning = pushCommandInfo = pushInfo

    def setProgress(self, progress: float) -> None:
        pass


def answer(program: Program, arguments: list[str], folder: str, feedback: QgsProcessingFeedback) -> dict[str, Any]:
    """Return what a command prints with --json, {} when the user cancelled, without a word in the log; raises as run()."""
    finished = run(program, [*arguments, "--json"], folder, _Silent(feedback))
    return {} if finished is None else finished.report


def _finished(code: int, printed: bytes, listener: _Listener, keys: frozenset[str]) -> Finished:
    words = in_qgis("\n".join(listener.error).strip(), keys)
    if code not in (0, CHECK_FAILED):
        raise QgsProcessingException(words if code > 0 and words else f"thalweg failed: {_ended(code)}. {words}".strip())
    try:
        report = json.loads(printed)
    except ValueError:
        raise QgsProcessingException(f"thalweg failed: {_ended(code)} and printed no JSON. {words}".strip()) from None
    return Finished(report, code == 0, tuple(listener.heard))
