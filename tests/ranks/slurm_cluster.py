# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A Slurm of one's own on this machine, for as long as tests run: munged, slurmctld and slurmd with five processors that the
machine need not have. As root, without systemd and cgroups."""
import contextlib
import os
import pathlib
import shutil
import signal
import socket
import subprocess
import tempfile
import time

SETTINGS = """\
ClusterName=thalweg
SlurmctldHost={host}
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
CryptoType=crypto/munge
SlurmctldPort={port}
SlurmdPort={node_port}
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ProctrackType=proctrack/pgid
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerType=sched/backfill
SchedulerParameters=sched_interval=1,bf_interval=1
SwitchType=switch/none
MpiDefault=none
ReturnToService=2
SlurmdParameters=config_overrides
SlurmdTimeout=10
MinJobAge=300
KillWait=2
InactiveLimit=0
NodeName={host} CPUs=5 State=UNKNOWN
PartitionName=all Nodes={host} Default=YES MaxTime=INFINITE State=UP
"""


def free_port():
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


class Cluster:
    """Slurm in a folder; environment has what its commands need."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        self.environment = {**os.environ, "SLURM_CONF": str(self.folder / "slurm.conf")}
        self.host = socket.gethostname().split(".")[0]

    def start(self):
        for name in ("state", "spool", "munge"):
            (self.folder / name).mkdir()
        (self.folder / "slurm.conf").write_text(SETTINGS.format(folder=self.folder, host=self.host, port=free_port(), node_port=free_port()))
        key = self.folder / "munge" / "key"
        key.write_bytes(os.urandom(128))
        key.chmod(0o400)
        (self.folder / "munge").chmod(0o700)
        self.munged = subprocess.Popen(
            ["munged", "--foreground", "--force", f"--socket={self.folder}/munge.socket", f"--key-file={key}",
             f"--log-file={self.folder}/munge/log", f"--pid-file={self.folder}/munge/pid", f"--seed-file={self.folder}/munge/seed"],
            stderr=subprocess.DEVNULL)
        self.wait_for(lambda: (self.folder / "munge.socket").exists(), "munged")
        self.controller = subprocess.Popen(["slurmctld", "-D", "-i"], env=self.environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.start_node()

    def start_node(self):
        self.node = subprocess.Popen(["slurmd", "-D", "-N", self.host], env=self.environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.wait_for(lambda: "idle" in self.said("sinfo", "-h", "-o", "%t") or "mix" in self.said("sinfo", "-h", "-o", "%t"), "slurmd")

    def lose_node(self):
        """Kills the node with all that runs on it, as a power cut would."""
        self.node.kill()
        self.node.wait()
        for process in pathlib.Path("/proc").glob("[0-9]*"):
            with contextlib.suppress(OSError, ProcessLookupError):
                words = (process / "environ").read_bytes() + (process / "cmdline").read_bytes()
                is_of_job = str(self.folder).encode() in words and (b"SLURM_JOB_ID=" in words or b"slurmstepd" in words)
                if is_of_job and int(process.name) != os.getpid():
                    os.kill(int(process.name), signal.SIGKILL)

    def stop(self):
        for process in (self.node, self.controller, self.munged):
            process.terminate()
        for process in (self.node, self.controller, self.munged):
            try:
                process.wait(20)
            except subprocess.TimeoutExpired:
                process.kill()

    def said(self, *words):
        return subprocess.run(words, env=self.environment, capture_output=True, text=True, check=False).stdout

    def wait_for(self, is_true, what, seconds=60):
        end = time.monotonic() + seconds
        while not is_true():
            if time.monotonic() > end:
                logs = "\n".join(log.read_text()[-3000:] for log in self.folder.glob("*.log"))
                raise RuntimeError(f"{what} did not come in {seconds} s\n{self.said('sinfo')}{self.said('squeue')}{logs}")
            time.sleep(0.1)


@contextlib.contextmanager
def cluster():
    folder = tempfile.mkdtemp(prefix="thalweg-slurm-", dir="/var/tmp")
    one = Cluster(folder)
    try:
        one.start()
        yield one
    finally:
        one.stop()
        shutil.rmtree(folder, ignore_errors=True)
