# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What a check says: figures as one JSON line on stdout, faults in words on stderr, exit 1 where there is one."""
import json
import pathlib
import subprocess
import sys
from collections import Counter, defaultdict

EXAMPLES = 5


class Report:
    def __init__(self):
        self.counts = Counter()
        self.examples = defaultdict(list)

    def fault(self, kind, where):
        self.counts[kind] += 1
        if len(self.examples[kind]) < EXAMPLES:
            self.examples[kind].append(where)

    def unless(self, holds, kind, where):
        if not holds:
            self.fault(kind, where)

    def equal(self, kind, found, wanted):
        self.unless(found == wanted, kind, f"{found}, not {wanted}")

    def at_least(self, kind, found, least):
        self.unless(found >= least, kind, f"{found}, less than {least}")

    def close(self, figures):
        for kind, count in self.counts.items():
            told = "; ".join(str(example) for example in self.examples[kind])
            print(f"{pathlib.Path(sys.argv[0]).name}: {kind} ({count}): {told}", file=sys.stderr)
        print(json.dumps({**figures, "violations": self.counts, "examples": self.examples}, default=str))
        return 1 if self.counts else 0


def command(*words, **options):
    """Runs another program; RuntimeError with the end of its messages where it fails."""
    done = subprocess.run(list(map(str, words)), capture_output=True, text=True, check=False, **options)
    if done.returncode != 0:
        raise RuntimeError(f"{' '.join(map(str, words))}: {(done.stdout + done.stderr).strip()[-500:]}")
    return done


def run(main, usage, *counts):
    """Calls main with the words of the command line and exits with what it returns: 2 where a file cannot be read.
    counts: how many words there may be; without it, one or more."""
    words = sys.argv[1:]
    if len(words) not in counts if counts else not words:
        sys.exit(usage)
    try:
        sys.exit(main(*words))
    except (OSError, RuntimeError) as error:
        print(f"{pathlib.Path(sys.argv[0]).name}: {error}", file=sys.stderr)
        sys.exit(2)
