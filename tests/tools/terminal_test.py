# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""terminal_test.py THALWEG: what a person sees, on a pseudo-terminal: the bar, its width, colours, and a clean end."""
import fcntl
import os
import pathlib
import pty
import re
import select
import signal
import struct
import subprocess
import sys
import tempfile
import termios
import time

thalweg = os.path.abspath(sys.argv[1])
# Grows for many seconds; interrupted long before.
long_work = ["make", "--set", "grid.width=4000", "--set", "grid.height=4000", "--set", "network.dla.particles=5000000"]
short_work = ["make", "--set", "grid.width=64", "--set", "grid.height=48", "--set", "network.dla.particles=400", "--set",
              "network.prune=4"]


def handles_interrupts(pid):
    caught = re.search(r"^SigCgt:\t(\w+)", pathlib.Path(f"/proc/{pid}/status").read_text(), re.M)
    return int(caught[1], 16) >> (signal.SIGINT - 1) & 1


def on_terminal(words, columns=100, interrupt_after=None, **variables):
    """Exit status and all that came to a terminal. interrupt_after: text that must come three times first, or "ready": as soon as
    interrupts are handled."""
    environment = {k: v for k, v in os.environ.items() if k not in ("NO_COLOR", "TERM")}
    environment.update({"TERM": "xterm", **variables})
    ours, theirs = pty.openpty()
    fcntl.ioctl(ours, termios.TIOCSWINSZ, struct.pack("HHHH", 24, columns, 0, 0))
    with tempfile.TemporaryDirectory() as place:
        child = subprocess.Popen([thalweg, *words], cwd=place, env=environment, stdin=theirs, stdout=theirs,
                                 stderr=theirs, start_new_session=True)
        os.close(theirs)
        seen, begin, sent = b"", time.monotonic(), False
        while time.monotonic() - begin < 600:
            if select.select([ours], [], [], 0.05)[0]:
                try:
                    seen += os.read(ours, 65536)
                except OSError:  # nobody writes any more
                    break
            due = interrupt_after is not None and (
                seen.count(interrupt_after) >= 3 if isinstance(interrupt_after, bytes) else handles_interrupts(child.pid))
            if due and not sent:
                child.send_signal(signal.SIGINT)
                sent = True
        os.close(ours)
        status = child.wait(600)
        assert os.listdir(place) == ([] if sent else ["valley"]), "an interrupted run leaves nothing"
    return status, seen.decode()


def screen(text):
    """What stays on the screen."""
    lines, column = [""], 0
    for token in re.findall(r"\033\[[0-9;]*[A-Za-z]|.", text, re.S):
        if token == "\r":
            column = 0
        elif token == "\n":
            lines.append("")
        elif token == "\033[K":
            lines[-1] = lines[-1][:column]
        elif not token.startswith("\033"):
            lines[-1] = lines[-1][:column] + token + lines[-1][column + 1:]
            column += 1
    return lines


def bars(text):
    plain = re.sub(r"\033\[[0-9;]*m", "", text)
    return [line for line in re.split(r"\r\033\[K|\n", plain) if line.startswith("grow") and " % " in line + " "]


for columns in (100, 50, 20):
    status, seen = on_terminal(long_work, columns, interrupt_after=b" %")
    assert status == 130, status
    assert len(bars(seen)) >= 3, seen
    assert all(len(bar) < columns for bar in bars(seen)), seen
    assert screen(seen) == ["error: interrupted; nothing was written", ""], screen(seen)
    assert "\033[1;31merror:" in seen
    if columns == 100:
        assert re.search(r"\[#*\.+\]  +\d+ %  .* particles/s", bars(seen)[-1]), bars(seen)[-1]

status, seen = on_terminal(long_work, interrupt_after=b" %", NO_COLOR="1")
assert status == 130 and len(bars(seen)) >= 3, seen
assert set(re.findall(r"\033\[[^A-Za-z]*[A-Za-z]", seen)) == {"\033[K"}, "NO_COLOR leaves the bar, without colour"

status, seen = on_terminal(long_work, interrupt_after="ready", TERM="dumb")
assert status == 130 and "\033" not in seen, seen
assert screen(seen) == ["error: interrupted; nothing was written", ""], screen(seen)

status, seen = on_terminal([*long_work, "-q"], interrupt_after="ready")
assert status == 130 and not bars(seen), seen

status, seen = on_terminal(short_work)
assert status == 0, seen
assert "\033[32mok\033[0m" in seen, seen
assert "\033" not in on_terminal(short_work, TERM="dumb")[1]
assert not re.search(r"\033\[[^A-Za-z]*m", on_terminal(short_work, NO_COLOR="1")[1])

with tempfile.TemporaryDirectory() as place:
    done = subprocess.Popen([thalweg, *long_work], cwd=place, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                            env=dict(os.environ, TERM="xterm"))
    while not handles_interrupts(done.pid):
        time.sleep(0.01)
    done.send_signal(signal.SIGINT)
    out, err = done.communicate(timeout=600)
    assert done.returncode == 130 and b"\033" not in out + err and b"\r" not in out + err, err
print("the terminal is kept clean")
