# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""completion_test.py THALWEG: bash, zsh and fish complete what thalweg takes, and all of it."""
import os
import pathlib
import pty
import select
import subprocess
import tempfile
import time

import spoken

scripts = {shell: spoken.say("completion", shell) for shell in ("bash", "zsh", "fish")}
place = tempfile.TemporaryDirectory()
folder = pathlib.Path(place.name)
for shell, text in scripts.items():
    (folder / f"script.{shell}").write_text(text)
    subprocess.run([shell, "-n", folder / f"script.{shell}"], check=True)
work = folder / "work"
(work / "out").mkdir(parents=True)
for name in ("mine.toml", "my rivers.toml", "dem.tif", "net.gpkg"):
    (work / name).write_text("")

# Every command, option and key of the parser is in every script.
for shell, text in scripts.items():
    for key in spoken.keys():
        assert key in text, (shell, key)
    for command in (None, *spoken.commands()):
        assert command is None or command in text, (shell, command)


def bash(*words, joined="=:"):
    """What bash offers for the last word; words as the function sees them."""
    quoted = " ".join("'" + word.replace("'", "'\\''") + "'" for word in words)
    program = (f"source '{folder}/script.bash'; COMP_WORDBREAKS=$' \\t\\n{joined}'; COMP_WORDS=({quoted})\n"
               f"COMP_CWORD={len(words) - 1}; _thalweg; printf '%s\\n' \"${{COMPREPLY[@]}}\"")
    done = subprocess.run(["bash", "--norc", "-c", program], cwd=work, check=True, capture_output=True, text=True)
    assert done.stderr == "", done.stderr
    return set(done.stdout.split("\n")) - {""}


def fish(line):
    done = subprocess.run(["fish", "--no-config", "-c", f"source '{folder}/script.fish'; complete -C \"{line}\""], cwd=work,
                          check=True, capture_output=True, text=True, env=dict(os.environ, HOME=str(folder)))
    assert done.stderr == "", done.stderr
    return {answer.split("\t")[0] for answer in done.stdout.splitlines()}


for answers in (bash("thalweg", ""), fish("thalweg ")):
    assert answers >= set(spoken.commands()), answers
for answers in (bash("thalweg", "ma"), fish("thalweg ma")):
    assert answers == {"make", "man"}, answers
for command in ([], *([c] for c in spoken.commands())):
    wanted = set(spoken.options(*command))
    assert bash("thalweg", *command, "-") == wanted, (command, bash("thalweg", *command, "-"), wanted)
    # fish offers short options for "-" and long ones for "--".
    answers = fish(" ".join(["thalweg", *command, "-"])) | fish(" ".join(["thalweg", *command, "--"]))
    assert {a.rstrip("=") for a in answers} >= wanted, (command, answers, wanted)

assert bash("thalweg", "completion", "") == {"bash", "zsh", "fish"} == fish("thalweg completion ")
assert bash("thalweg", "help", "rec") == {"recipe"} == fish("thalweg help rec")
assert bash("thalweg", "make", "") == {"dem.tif", "mine.toml", "my rivers.toml", "net.gpkg", "out"}, "recipes and data"
assert bash("thalweg", "make", "-q", "my") == {"my rivers.toml"}
assert bash("thalweg", "make", "-o", "mine.toml", "mi") == {"mine.toml"}, "the value of -o is no recipe"
assert bash("thalweg", "make", "mine.toml", "") >= {"--set"}, "a second recipe is not offered"
assert {"mine.toml", "out/"} <= fish("thalweg make ") and fish("thalweg make mi") == {"mine.toml"}
assert bash("thalweg", "check", "") == {"net.gpkg", "out"}
assert bash("thalweg", "stats", "de") == {"dem.tif"} == fish("thalweg stats de")
assert bash("thalweg", "make", "-o", "") == {"out"} == bash("thalweg", "make", "--output", "=", "o")
assert fish("thalweg make -o ") == {"out/"} and fish("thalweg make --output=o") == {"--output=out/"}
assert bash("thalweg", "make", "--seed", "") == set()

assert bash("thalweg", "make", "--set", "") == {f"{key}=" for key in spoken.keys()} == fish("thalweg make --set ")
assert bash("thalweg", "make", "--set", "network.dla.b") == {"network.dla.branch="} == fish(
    "thalweg make --set network.dla.b")
metrics = {"cityblock", "euclid"}
assert bash("thalweg", "make", "--set", "surface.metric", "=") == metrics, "as bash takes it apart"
assert bash("thalweg", "make", "--set", "surface.metric", "=", "eu") == {"euclid"}
assert bash("thalweg", "make", "--set", "=", "surface.metric", "=", "eu") == {"euclid"}
assert bash("thalweg", "make", "--set", "surface.metric=eu", joined="") == {"surface.metric=euclid"}
assert fish("thalweg make --set surface.metric=") == {f"surface.metric={m}" for m in metrics}
assert fish("thalweg make --set=surface.metric=e") == {"--set=surface.metric=euclid"}
assert bash("thalweg", "make", "--set", "grid.clip", "=", "") == {"true", "false"}
assert bash("thalweg", "make", "--set", "network.lines.path", "=", "net") == {"net.gpkg"}
assert fish("thalweg make --set network.lines.path=net") == {"network.lines.path=net.gpkg"}


class Interactive:
    """A shell at a prompt of a pseudo-terminal; ^T writes the line being edited to a file."""

    def __init__(self, shell, setup):
        self.pid, self.fd = pty.fork()
        if self.pid == 0:
            os.chdir(work)
            os.environ.update(TERM="dumb", HOME=str(folder), ZDOTDIR=str(folder), INPUTRC="/dev/null")
            os.execvp(shell[0], shell)
        self.file = folder / "line"
        self.type(setup + f"; touch {self.file}\r")
        self.wait()

    def type(self, text):
        os.write(self.fd, text.encode())

    def wait(self):
        begin, seen = time.monotonic(), b""
        while not self.file.exists():
            if select.select([self.fd], [], [], 0.05)[0]:
                seen += os.read(self.fd, 65536)
            assert time.monotonic() - begin < 20, seen.decode(errors="replace")
        time.sleep(0.05)
        text = self.file.read_text()
        self.file.unlink()
        return text

    def completed(self, line):
        self.type(f"\x15{line}\t\x14")
        return self.wait()

    def end(self):
        os.close(self.fd)
        os.waitpid(self.pid, 0)


zsh = Interactive(["zsh", "-f", "-i"],
                  "autoload -U compinit; compinit -u -D; source ../script.zsh; unsetopt auto_menu; bindkey -e; "
                  f"show() {{ print -r -- $BUFFER > {folder}/new; mv {folder}/new {folder}/line }}; "
                  "zle -N show; bindkey '^T' show")
for typed, wanted in {
    "thalweg comp": "thalweg completion ",
    "thalweg completion f": "thalweg completion fish ",
    "thalweg make --over": "thalweg make --overwrite ",
    "thalweg make mi": "thalweg make mine.toml ",
    "thalweg stats de": "thalweg stats dem.tif ",
    "thalweg check n": "thalweg check net.gpkg ",
    "thalweg make -o o": "thalweg make -o out/",
    "thalweg make --set network.dla.b": "thalweg make --set network.dla.branch=",
    "thalweg make --set surface.metric=e": "thalweg make --set surface.metric=euclid ",
    "thalweg make --set=surface.metric=e": "thalweg make --set=surface.metric=euclid ",
    "thalweg help rec": "thalweg help recipe ",
}.items():
    got = zsh.completed(typed).rstrip("\n")
    assert got.rstrip() == wanted.rstrip(), (typed, got, wanted)
zsh.end()

# The same at a real prompt of bash: it takes words apart itself.
shell = Interactive(["bash", "--norc", "-i"],
                    f"source ../script.bash; show() {{ printf '%s\\n' \"$READLINE_LINE\" > {folder}/new; "
                    f"mv {folder}/new {folder}/line; }}; bind -x '\"\\C-t\": show'")
for typed, wanted in {
    "thalweg comp": "thalweg completion ",
    "thalweg make --set surface.metric=e": "thalweg make --set surface.metric=euclid ",
    "thalweg make --set=surface.metric=c": "thalweg make --set=surface.metric=cityblock ",
    "thalweg make --set surface.rel": "thalweg make --set surface.relief=",
    "thalweg make --set surface.mask= --over": "thalweg make --set surface.mask= --overwrite ",
    "thalweg make my": "thalweg make my\\ rivers.toml ",
    "thalweg make --output=o": "thalweg make --output=out/",
}.items():
    got = shell.completed(typed).rstrip("\n")
    assert got.rstrip() == wanted.rstrip(), (typed, got, wanted)
shell.end()

# Every option stands in the other scripts with its name.
zsh_text, fish_text = scripts["zsh"], scripts["fish"]
for command in spoken.commands():
    body = zsh_text.split(f"\n_thalweg_{command}() {{", 1)[1].split("\n}\n", 1)[0]
    lines = [line for line in fish_text.splitlines() if f"'__thalweg_command {command}'" in line]
    for option in spoken.options(command):
        assert f"){option}" in body or f"*{option}" in body, ("zsh", command, option)
        switch = f" -l {option[2:]}" if option.startswith("--") else f" -s {option[1:]}"
        assert any(switch + " " in line for line in lines), ("fish", command, option)
print("bash, zsh and fish complete")
