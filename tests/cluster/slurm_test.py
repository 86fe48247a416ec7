# SPDX-License-Identifier: Apache-2.0
"""Shards of fdcg batch on a real Slurm of one node (munged, slurmctld, slurmd), one of whose tasks loses its node half-way: merged,
they have the bytes of one run."""
import os
import pathlib
import shutil
import signal
import socket
import subprocess
import sys
import time
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "contract"))
from batch_test import BatchCase, tree  # noqa: E402
from support import FDCG, ROOT  # noqa: E402

CONF = """
ClusterName=fdcgtest
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={control_port}
SlurmdPort={node_port}
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket,cred_expire=6
CredType=cred/munge
SlurmUser=root
SlurmdUser=root
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
SlurmdParameters=config_overrides
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerParameters=batch_sched_delay=0,sched_interval=2,bf_interval=2
ReturnToService=2
SlurmdTimeout=10
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
NodeName={host} NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN
PartitionName=all Nodes={host} Default=YES MaxTime=INFINITE State=UP
"""


def free_port():
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


class SlurmCase(BatchCase):
    def setUp(self):
        super().setUp()
        for program in ("munged", "slurmctld", "slurmd", "sbatch"):
            if shutil.which(program) is None:
                self.skipTest(f"there is no {program}")
        if os.geteuid() != 0:
            self.skipTest("Slurm's daemons need root")
        self.cluster = self.folder / "cluster"
        for name in ("state", "spool"):
            (self.cluster / name).mkdir(parents=True)
        self.cluster.chmod(0o755)
        host = socket.gethostname().split(".")[0]
        (self.cluster / "slurm.conf").write_text(
            CONF.format(host=host, folder=self.cluster, control_port=free_port(), node_port=free_port()))
        self.environment |= {"SLURM_CONF": str(self.cluster / "slurm.conf"), "PATH": f"{pathlib.Path(FDCG).parent}:{os.environ['PATH']}"}
        self.daemons = {}
        self.addCleanup(self.stop)
        key = self.cluster / "munge.key"
        key.write_bytes(os.urandom(128))
        key.chmod(0o400)
        files = [f"--{name}={self.cluster}/munge.{end}" for name, end in
                 (("key-file", "key"), ("socket", "socket"), ("pid-file", "pid"), ("log-file", "log"), ("seed-file", "seed"))]
        self.start("munged", "--foreground", "--force", *files)
        self.wait_for(lambda: (self.cluster / "munge.socket").exists(), 30, "munged")
        self.start("slurmctld", "-D")
        self.start("slurmd", "-D", "-N", host)
        self.wait_for(lambda: "idle" in self.slurm("sinfo", "-h", "-o", "%T"), 90, "an idle node")

    def start(self, program, *arguments):
        log = open(self.cluster / f"{program}.out", "ab")
        self.addCleanup(log.close)
        self.daemons[program] = subprocess.Popen((program, *arguments), env=self.environment, stdin=subprocess.DEVNULL, stdout=log, stderr=log)

    def slurm(self, *command):
        return subprocess.run(command, env=self.environment, capture_output=True, text=True, check=False, timeout=60).stdout

    def wait_for(self, condition, seconds, what):
        end = time.monotonic() + seconds
        while not condition():
            if time.monotonic() > end:
                logs = "".join(f"==> {path.name}\n{path.read_text(errors='replace')[-3000:]}\n" for path in self.cluster.glob("*.log"))
                logs += "".join(f"==> {path.name}\n{path.read_text()[-1000:]}\n" for path in self.folder.glob("slurm-*.out"))
                self.fail(f"no {what} in {seconds} s\n{self.slurm('squeue', '-a')}{self.slurm('sinfo')}{logs}")
            time.sleep(0.1)

    def processes_of_tasks(self):
        """slurmstepd and what it started: all that knows this cluster, but for its daemons."""
        ours, daemons = [], {process.pid for process in self.daemons.values()} | {os.getpid()}
        for entry in pathlib.Path("/proc").glob("[0-9]*"):
            try:
                knows = f"SLURM_CONF={self.cluster}".encode() in (entry / "environ").read_bytes()
                name = (entry / "comm").read_text().strip()
            except OSError:
                continue
            if knows and int(entry.name) not in daemons and name in ("slurmstepd", "fdcg", "sh", "slurm_script"):
                ours.append((int(entry.name), name))
        return ours

    def kill(self, process):
        try:
            os.kill(process, signal.SIGKILL)
        except ProcessLookupError:
            pass

    def stop(self):
        self.slurm("scancel", "--full", "-u", "root")
        for name in ("slurmd", "slurmctld", "munged"):
            if name in self.daemons:
                self.daemons[name].kill()
                self.daemons[name].wait()
        for process, _ in self.processes_of_tasks():
            self.kill(process)

    def lose_node(self):
        """As if its power failed: everything on it ends at once. Then it is back."""
        self.daemons["slurmd"].kill()
        self.daemons["slurmd"].wait()
        for process, _ in sorted(self.processes_of_tasks(), key=lambda one: one[1] != "slurmstepd"):
            self.kill(process)
        self.wait_for(lambda: "down" in self.slurm("sinfo", "-h", "-o", "%T"), 90, "notice that the node is lost")
        self.start("slurmd", "-D", "-N", socket.gethostname().split(".")[0])


class Slurm(SlurmCase):
    def test_four_shards_of_which_one_loses_its_node_are_one_run(self):
        self.library(parts=40, rows=45)
        whole_code = self.batch("-q", out="whole").returncode
        whole = tree(self.folder / "whole")
        arguments = ("--manifest", "list.txt", "--manifest", "rules.json", "-o", "out")
        waiting = subprocess.Popen((ROOT / "tools/batch/slurm", "4", "--", *arguments), cwd=self.folder, env=self.environment | {"FDCG_WAIT": "1"},
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.addCleanup(waiting.kill)
        files = self.folder / "out/files"
        self.wait_for(lambda: (self.folder / "out/unfinished").is_dir() and len(list(files.rglob("*.fdcg"))) > 2, 60, "running task")
        self.assertTrue(any(name == "fdcg" for _, name in self.processes_of_tasks()))
        self.lose_node()
        self.assertFalse((self.folder / "out/results.jsonl").exists())
        self.wait_for(lambda: waiting.poll() is not None, 400, "end of the merging")
        self.assertEqual(whole_code, waiting.returncode, waiting.stderr.read())
        self.assertEqual(whole, tree(self.folder / "out", "shards/"))
        self.assertEqual(4, len(list((self.folder / "out/shards").iterdir())))
        restarts = "".join(path.read_text() for path in [self.cluster / "slurmctld.log"])
        self.assertRegex(restarts, r"(?i)requeue")

    def test_the_script_refuses_what_it_gives_itself(self):
        for arguments, words in ((("x",), b"no number"), (("2",), b"say --"), (("2", "--", "-o", "out", "--shard", "1/2"), b"--shard is given"),
                                 (("2", "--", "--manifest", "list.txt"), b"needs -o")):
            done = self.run_program(ROOT / "tools/batch/slurm", *arguments, code=2, env=self.environment)
            self.assertIn(words, done.stderr)
            self.assertEqual(1, done.stderr.count(b"\n"))


class Snakemake(SlurmCase):
    def test_its_profile_for_slurm_gives_the_bytes_of_one_run(self):
        if shutil.which("snakemake") is None:
            self.skipTest("there is no snakemake")
        self.library(parts=8)
        self.batch("-q", out="whole")
        self.write("meshes.json", (self.folder / "rules.json").read_text())
        place = ROOT / "tools/batch/snakemake"
        command = ("snakemake", "-s", place / "Snakefile", "--profile", place / "slurm", "--latency-wait", "5", "--config",
                   "manifest=list.txt,meshes.json", "output=out", "shards=3")
        environment = self.environment | {"XDG_CACHE_HOME": str(self.folder), "HOME": str(self.folder)}
        done = subprocess.run(command, cwd=self.folder, env=environment, stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False,
                              timeout=300)
        said = "".join(path.read_text() for path in self.folder.glob("slurm-*.out"))
        self.assertEqual(0, done.returncode, done.stderr[-3000:] + said[-3000:])
        self.assertEqual(tree(self.folder / "whole"), tree(self.folder / "out", "shards/"))


if __name__ == "__main__":
    unittest.main()
