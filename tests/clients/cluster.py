#!/usr/bin/python3
# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""cluster.py start|stop|words STATE: a PostgreSQL of one's own with PostGIS and pgRouting, for as long as tests run.

It listens on a socket in a new folder and on no port, so that nothing on the machine can clash with it, and runs as the user
or, for root, as the user postgres of Debian's package. STATE remembers the folder; `words` prints how libpq finds it
("host=... user=... dbname=..."). A cluster that an interrupted run left under STATE is stopped before a new one starts."""
import json
import os
import pathlib
import pwd
import shutil
import sys
import tempfile

from report import command

# Nothing here needs to outlive a crash of the machine.
SETTINGS = {"listen_addresses": "''", "fsync": "off", "synchronous_commit": "off", "full_page_writes": "off", "jit": "off",
            "autovacuum": "off", "max_connections": "40"}


def binaries():
    versions = sorted(pathlib.Path("/usr/lib/postgresql").glob("*/bin/initdb"), key=lambda path: int(path.parts[-3]))
    if not versions:
        raise RuntimeError("no PostgreSQL in /usr/lib/postgresql (scripts/packages clients)")
    return versions[-1].parent


def run(*words):
    """As who may run a server: PostgreSQL refuses root."""
    user = ["runuser", "-u", "postgres", "--"] if os.geteuid() == 0 else []
    return command(*user, *words, cwd="/").stdout


def connection(state):
    kept = json.loads(pathlib.Path(state).read_text())
    return {key: kept[key] for key in ("host", "user", "dbname")}


def words(state):
    return " ".join(f"{key}={value}" for key, value in connection(state).items())


def start(state):
    stop(state)
    # A socket's path may have 107 characters, and a folder of one user may be closed to postgres: hence not beside STATE.
    folder = pathlib.Path(tempfile.mkdtemp(prefix="thalweg-pg-", dir="/var/tmp"))
    user = "postgres" if os.geteuid() == 0 else pwd.getpwuid(os.geteuid()).pw_name
    state.parent.mkdir(parents=True, exist_ok=True)
    state.write_text(json.dumps({"host": str(folder), "user": user, "dbname": "thalweg"}))
    if os.geteuid() == 0:
        shutil.chown(folder, "postgres", "postgres")
    data = folder / "data"
    run(binaries() / "initdb", "-D", data, "-U", user, "-A", "trust", "-E", "UTF8", "--no-locale", "--no-sync")
    settings = " ".join(f"-c {key}={value}" for key, value in SETTINGS.items())
    run(binaries() / "pg_ctl", "-D", data, "-l", folder / "log", "-w", "-t", "60", "-o", f"-k {folder} {settings}", "start")
    run(binaries() / "createdb", "-h", folder, "-U", user, "thalweg")
    extensions = [f"-c create extension {name}" for name in ("postgis", "postgis_topology", "pgrouting")]
    run(binaries() / "psql", "-X", "-q", "-v", "ON_ERROR_STOP=1", "-h", folder, "-U", user, "-d", "thalweg", *extensions)


def is_running(data):
    """A server that was killed leaves its postmaster.pid."""
    try:
        run(binaries() / "pg_ctl", "-D", data, "status")
    except RuntimeError:
        return False
    return True


def stop(state):
    if not state.exists():
        return
    folder = pathlib.Path(connection(state)["host"])
    if is_running(folder / "data"):
        run(binaries() / "pg_ctl", "-D", folder / "data", "-m", "immediate", "-w", "stop")
    shutil.rmtree(folder, ignore_errors=True)
    state.unlink()


def main(verb, state):
    state = pathlib.Path(state)
    if verb == "words":
        print(words(state))
    else:
        {"start": start, "stop": stop}[verb](state)
    return 0


if __name__ == "__main__":
    if len(sys.argv) != 3 or sys.argv[1] not in ("start", "stop", "words"):
        sys.exit(__doc__)
    try:
        sys.exit(main(*sys.argv[1:]))
    except (OSError, RuntimeError) as error:
        print(f"cluster.py: {error}", file=sys.stderr)
        sys.exit(1)
