#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""An array of Slurm over two nodes; one dies in the middle, its task is queued again; the merge has the bytes of one run.

    python3 tests/tools/lab/slurm_test.py BUILD_DIR          as root

munged, slurmctld and two slurmd of Debian run in a network namespace that has loopback alone; each node is a PID namespace,
so that its death is that of all its processes. Also: the same by GNU parallel, and the Snakefile, twice.
Needs munge, slurmctld, slurmd, slurm-client, parallel, snakemake. Exit status 0 or 1.
"""
import os
import pathlib
import re
import secrets
import shutil
import signal
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests/tools"))
sys.dont_write_bytecode = True
from processes import until  # noqa: E402

SHARD, SNAKEFILE = ROOT / "tools/lab/tact-shard", ROOT / "tools/lab/Snakefile"
BUILD = pathlib.Path(sys.argv.pop(1)).resolve()
TASKS = 4
UNITS = "3000,3500,4000,4500,5000,5500"
CONFIG = """
ClusterName=test
SlurmctldHost=ctl(127.0.0.1)
SlurmUser=root
SlurmctldPort=6817
AuthType=auth/munge
CredType=cred/munge
AuthInfo=socket={folder}/munge/socket
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool.%n
SlurmctldPidFile={folder}/ctl.pid
SlurmdPidFile={folder}/%n.pid
SlurmctldLogFile={folder}/ctl.log
SlurmdLogFile={folder}/%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SlurmdTimeout=10
InactiveLimit=0
KillWait=5
ReturnToService=2
JobRequeue=1
SchedulerParameters=sched_interval=2
NodeName=n1 NodeAddr=127.0.0.1 Port=7001 CPUs=1 State=UNKNOWN
NodeName=n2 NodeAddr=127.0.0.1 Port=7002 CPUs=1 State=UNKNOWN
PartitionName=all Nodes=n1,n2 Default=YES MaxTime=INFINITE State=UP
"""
# The first task of a node waits until the test has seen both; a task that comes again finds the file.
TASK = """#!/bin/bash
hostname >{folder}/began.$SLURM_ARRAY_TASK_ID.$SLURM_RESTART_COUNT
until [ -e {folder}/go ]; do sleep 0.1; done
exec {command} --shard $SLURM_ARRAY_TASK_ID/{tasks} --out {folder}/part$SLURM_ARRAY_TASK_ID -- {unit}
"""


def run(*words, **options):
    done = subprocess.run([*map(str, words)], capture_output=True, text=True, **options)
    if done.returncode:
        raise AssertionError(f"{words}: {done.stdout}{done.stderr}")
    return done.stdout


class Cluster(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)
        self.script = self.folder / "unit.sh"
        self.script.write_text(f"{BUILD}/tactd {ROOT}/model/scenes/liver.toml --set elastic.youngs_modulus_Pa=$1 --free-run "
                               "--ticks 3000 --no-telemetry --no-black-box --json - 2>/dev/null | grep force_hash\n")
        self.unit = ["bash", str(self.script), "{}", f"{BUILD}/tactd"]
        self.shard = [str(SHARD), "--units", UNITS]

    def one_run(self):
        run(*self.shard, "--out", self.folder / "whole", "--", *self.unit)
        run(*self.shard, "--merge", self.folder / "whole", "--out", self.folder / "whole.txt", "--", *self.unit)
        data = (self.folder / "whole.txt").read_bytes()
        self.assertEqual(len(set(data.split(b"\n"))), 7, "six hashes, each another")
        return data

    def merged(self):
        parts = [self.folder / f"part{i}" for i in range(1, TASKS + 1)]
        run(*self.shard, "--merge", *parts, "--out", self.folder / "merged.txt", "--", *self.unit)
        return (self.folder / "merged.txt").read_bytes()

    def start(self, host, *words):
        """A daemon in a PID namespace of its own: its end is that of all it has started."""
        process = subprocess.Popen(["unshare", "--uts", "--pid", "--fork", "--kill-child", "--mount-proc", "bash", "-c",
                                    f'hostname {host} && exec "$@"', "-", *map(str, words)], stdout=subprocess.DEVNULL,
                                   stderr=subprocess.DEVNULL, env=self.environment())
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def environment(self):
        return os.environ | {"SLURM_CONF": str(self.folder / "slurm.conf")}

    def slurm(self):
        """The two nodes."""
        os.chmod(self.folder, 0o755)
        munge = self.folder / "munge"
        munge.mkdir(mode=0o755)
        (munge / "key").write_bytes(secrets.token_bytes(128))
        os.chmod(munge / "key", 0o400)
        self.start("ctl", "munged", "--foreground", "--force", f"--socket={munge}/socket", f"--key-file={munge}/key",
                   f"--pid-file={munge}/pid", f"--seed-file={munge}/seed", f"--log-file={munge}/log")
        until((munge / "socket").exists, "the socket of munged")
        (self.folder / "slurm.conf").write_text(CONFIG.format(folder=self.folder))
        (self.folder / "state").mkdir()
        self.start("ctl", "slurmctld", "-D", "-f", self.folder / "slurm.conf")
        nodes = [self.start(name, "slurmd", "-D", "-f", self.folder / "slurm.conf") for name in ("n1", "n2")]
        until(lambda: self.ask("sinfo", "-h", "-o", "%T %D") == "idle 2", "two idle nodes")
        return nodes

    def ask(self, *words):
        done = subprocess.run(words, capture_output=True, text=True, env=self.environment())
        return done.stdout.strip() if done.returncode == 0 else ""

    def began(self):
        """By the node, which a task writes first, the number of the task."""
        return {path.read_text().strip(): path.name.split(".")[1] for path in self.folder.glob("began.*")}

    def test_a_node_that_dies_changes_no_byte(self):
        whole, nodes = self.one_run(), self.slurm()
        task = self.folder / "task.sh"
        task.write_text(TASK.format(folder=self.folder, tasks=TASKS, command=" ".join(self.shard), unit=" ".join(self.unit)))
        job = self.ask("sbatch", "--parsable", "--requeue", f"--array=1-{TASKS}", f"--output={self.folder}/%a.log",
                       f"--chdir={self.folder}", str(task))
        self.assertTrue(job, "sbatch")
        where = until(lambda: (found := self.began()).keys() == {"n1", "n2"} and found, "a task on each node")
        nodes[1].send_signal(signal.SIGKILL)
        until(lambda: "down" in self.ask("sinfo", "-h", "-n", "n2", "-o", "%T"), "the node is seen to be dead")
        (self.folder / "go").touch()
        until(lambda: self.ask("squeue", "-h") == "" and len(list(self.folder.glob("part*/*.made.json"))) == 6, "its end")
        again = [path.name for path in self.folder.glob("began.*.1")]
        self.assertEqual(again, [f"began.{where['n2']}.1"], "the task of the dead node came again, no other")
        self.assertEqual((self.folder / again[0]).read_text().strip(), "n1")
        self.assertEqual(self.merged(), whole)

    def test_gnu_parallel_gives_the_same_bytes(self):
        whole = self.one_run()
        run("parallel", "-j2", "-I", "@", *self.shard, "--shard", f"@/{TASKS}", "--out", f"{self.folder}/part@", "--",
            *self.unit, ":::", *range(1, TASKS + 1), env=os.environ | {"HOME": str(self.folder)})
        self.assertEqual(self.merged(), whole)

    def snakemake(self, *more):
        return subprocess.run(["snakemake", "-s", SNAKEFILE, "--cores", "2", *more], capture_output=True, text=True,
                              cwd=self.folder, env=os.environ | {"HOME": str(self.folder)})

    def test_the_snakefile_knows_its_order(self):
        plan = self.snakemake("-n", "--config", f"build={BUILD}")
        self.assertEqual(plan.returncode, 0, plan.stderr)
        counts = dict(re.findall(r"^(\w+) +(\d+) ", plan.stdout + plan.stderr, re.M))
        self.assertEqual({name: counts[name] for name in ("mesh", "shard", "merge", "condense", "chart", "plan")},
                         {"mesh": "1", "shard": "10", "merge": "5", "condense": "1", "chart": "1", "plan": "1"})

    def test_the_snakefile_makes_each_file_once(self):
        chosen = ("--config", f"build={BUILD}", "targets=soak.json,stability.json", "seeds=1..2", "ticks=50000", "quick=1")
        first = self.snakemake(*chosen)
        self.assertEqual(first.returncode, 0, first.stderr)
        made = {name: (self.folder / "lab/liver" / name).read_bytes() for name in ("soak.json", "stability.json")}
        again = self.snakemake(*chosen)
        self.assertIn("Nothing to be done", again.stdout + again.stderr)
        shutil.rmtree(self.folder / "lab")
        self.assertEqual(self.snakemake(*chosen, "shards=1").returncode, 0)
        self.assertEqual(made, {name: (self.folder / "lab/liver" / name).read_bytes() for name in made})


if __name__ == "__main__":
    if os.environ.get("TACT_ALONE") != "yes":
        os.environ["TACT_ALONE"] = "yes"  # Slurm asks for an address that is not of loopback, on any device
        up = 'ip link set lo up && ip address add 192.0.2.1/32 dev lo && exec "$@"'
        os.execvp("unshare", ["unshare", "--net", "--pid", "--fork", "--kill-child", "--mount-proc", "bash", "-c", up, "-",
                              sys.executable, sys.argv[0], str(BUILD), *sys.argv[1:]])
    unittest.main()
