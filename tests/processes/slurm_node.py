# SPDX-License-Identifier: GPL-3.0-or-later
"""A Slurm cluster of this computer alone, with its own munge, in a folder of its own."""
import getpass
import os
import pathlib
import shutil
import socket
import subprocess
import time

CONFIGURATION = """ClusterName=eyeslam
SlurmctldHost={host}(127.0.0.1)
SlurmUser={user}
SlurmdUser={user}
SlurmctldPort={port}
SlurmdPort={next_port}
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
CredType=cred/munge
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
MpiDefault=none
ReturnToService=2
NodeName={host} NodeAddr=127.0.0.1 CPUs={cores} State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""


class SlurmCannotStart(Exception):
    pass


def free_port():
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        return taken.getsockname()[1]


class SlurmNode:
    def __init__(self, folder, seconds=30):
        self.folder = pathlib.Path(folder)
        for name in ("state", "spool"):
            (self.folder / name).mkdir(parents=True)
        self.folder.chmod(0o755)
        self.processes = []
        self.environment = dict(os.environ, SLURM_CONF=str(self.folder / "slurm.conf"))
        (self.folder / "slurm.conf").write_text(CONFIGURATION.format(
            folder=self.folder, host=socket.gethostname().split(".")[0], user=getpass.getuser(), port=free_port(),
            next_port=free_port(), cores=os.cpu_count()))
        try:
            self.begin(seconds)
        except SlurmCannotStart:
            self.stop()
            raise

    def begin(self, seconds):
        key = self.folder / "munge.key"
        key.write_bytes(os.urandom(64))
        key.chmod(0o600)
        self.spawn("munged", "--foreground", "--force", f"--key-file={key}", f"--socket={self.folder}/munge.socket",
                   f"--pid-file={self.folder}/munged.pid", f"--log-file={self.folder}/munged.log",
                   f"--seed-file={self.folder}/munged.seed")
        self.wait_for(lambda: (self.folder / "munge.socket").exists(), seconds, "munged")
        self.spawn("slurmctld", "-D")
        self.spawn("slurmd", "-D")
        self.wait_for(lambda: "idle" in self.call("sinfo", "-h", "-o", "%T").stdout, seconds, "slurmd")

    def spawn(self, name, *arguments):
        with open(self.folder / f"{name}.out", "w") as out:
            path = shutil.which(name, path=os.environ["PATH"] + ":/usr/sbin:/sbin")
            self.processes.append(subprocess.Popen([path, *arguments], stdout=out, stderr=out, env=self.environment))

    def wait_for(self, is_there, seconds, name):
        end = time.monotonic() + seconds
        while not is_there():
            ended = [process.args[0] for process in self.processes if process.poll() is not None]
            if ended or time.monotonic() > end:
                said = (self.folder / f"{name}.out").read_text() if (self.folder / f"{name}.out").exists() else ""
                raise SlurmCannotStart(f"{name}: {(said.strip().splitlines() or ['silent'])[-1]}")
            time.sleep(0.2)

    def call(self, name, *arguments, seconds=30):
        return subprocess.run([name, *map(str, arguments)], env=self.environment, cwd=self.folder, capture_output=True, text=True,
                              timeout=seconds)

    def run_array(self, script, count):
        """Tasks 1 to `count` of a script, to their end."""
        done = self.call("sbatch", "--wait", f"--array=1-{count}", "--ntasks=1", script, seconds=600)
        if done.returncode != 0:
            outputs = "\n".join(path.read_text() for path in self.folder.glob("slurm-*.out"))
            raise AssertionError(f"{done.stdout}{done.stderr}{outputs}")

    def stop(self):
        for process in reversed(self.processes):
            process.terminate()
        for process in self.processes:
            process.wait(20)
