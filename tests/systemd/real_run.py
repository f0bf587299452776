#!/usr/bin/env python3
"""The daemon as a service of a real systemd, with its sandbox, on a simulated rig.

real_run.py --build DIR --source DIR --programs DIR

A systemd is booted as process 1 of namespaces of its own (unshare), with nothing but the units under test; /etc,
/var/lib and the programs are copies. The sandbox of the service hides /tmp and every home directory, and a build may
stand below one of them: the copies of the programs in /run are seen from everywhere. Needs root. Exit code 77: not
possible on this machine, and why.
"""
import argparse
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time

SKIPPED = 77
SYSTEMD = "/usr/lib/systemd/systemd"
PROGRAMS = "/run/programs"  # in the namespaces of the test
BOOT = r"""
set -e
mount --make-rprivate /
mount -t proc proc /proc
mount -t tmpfs tmpfs /run
install -D -m 755 -t {inside} "{programs}/mgtd" "{programs}/mgt" "{programs}/mgt-rig"
cp -a /etc /run/etc && mount --bind /run/etc /etc
mount -t tmpfs tmpfs /var/lib
ip link set lo up
mkdir -p /run/systemd /etc/mgtd
systemd-sysusers "{source}/systemd/mgtd.sysusers.conf"
{inside}/mgt-rig run --dir /run/rig --rig table6 > /run/rig.log 2>&1 &
for i in $(seq 200); do [ -s /run/rig/ready ] && break; sleep 0.1; done
chgrp dialout /run/rig/* -L 2>/dev/null || true
for port in /run/rig/*; do
  [ -c "$port" ] && chgrp dialout "$(readlink -f "$port")" && chmod 660 "$(readlink -f "$port")"
done
{inside}/mgt-rig config --dir /run/rig --rig table6 --state /var/lib/mgtd --tcp 127.0.0.1:7450 |
  sed 's|unix = "/var/lib/mgtd/|unix = "/run/mgtd/|' > /etc/mgtd/mgtd.toml
chmod 644 /etc/mgtd/mgtd.toml
export container=test SYSTEMD_UNIT_PATH={units}
exec {systemd} --system --unit=under-test.target --show-status=no --log-target=console
"""
# Under AddressSanitizer the leak check at the end needs ptrace, which the unit forbids.
DROP_IN = """
[Service]
Environment=ASAN_OPTIONS=detect_leaks=0
WatchdogSec=4
TimeoutAbortSec=2
StandardOutput=append:/run/mgtd.log
StandardError=append:/run/mgtd.log
"""


class Failure(Exception):
    pass


def skip(why):
    print(f"skipped: {why}")
    sys.exit(SKIPPED)


class Machine:
    """The booted systemd, and words with it."""

    def __init__(self, options, scratch):
        self.options = options
        self.units = scratch / "units"
        self.units.mkdir()
        for target in ("sysinit", "basic", "shutdown", "sockets", "multi-user"):
            self.unit(f"{target}.target", f"[Unit]\nDescription={target}\nDefaultDependencies=no\n")
        self.unit("under-test.target", "[Unit]\nDefaultDependencies=no\nWants=mgtd.socket mgtd.service\n")
        text = (options.build / "systemd/mgtd.service").read_text()
        text = re.sub(r"^ExecStart=\S+ --config \S+", f"ExecStart={PROGRAMS}/mgtd --config /etc/mgtd/mgtd.toml",
                      text, flags=re.M)
        text = re.sub(r"^(Wants|After)=modprobe.*\n", "", text, flags=re.M)  # nothing to load for ptys
        self.unit("mgtd.service", text)
        shutil.copy(options.source / "systemd/mgtd.socket", self.units)
        self.unit("mgtd.service.d/test.conf", DROP_IN)
        boot = scratch / "boot.sh"
        boot.write_text(BOOT.format(source=options.source, programs=options.programs, inside=PROGRAMS, units=self.units,
                                    systemd=SYSTEMD))
        self.log = scratch / "console.log"
        self.process = subprocess.Popen(
            ["unshare", "--fork", "--kill-child", "--pid", "--mount", "--uts", "--ipc", "--cgroup", "--net", "bash", str(boot)],
            stdout=self.log.open("w"), stderr=subprocess.STDOUT)
        self.pid = None

    def unit(self, name, text):
        path = self.units / name
        path.parent.mkdir(exist_ok=True)
        path.write_text(text)

    def inside(self, *command):
        return subprocess.run(["nsenter", "-t", str(self.pid), "-m", "-p", *[str(c) for c in command]], text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT)

    def wait_for_boot(self):
        def booted():
            if self.process.poll() is not None:
                raise Failure("process 1 ended:\n" + self.log.read_text()[-2000:])
            children = subprocess.run(["pgrep", "-P", str(self.process.pid)], text=True, stdout=subprocess.PIPE)
            if not children.stdout.strip():
                return False
            self.pid = int(children.stdout.split()[0])
            return self.inside("systemctl", "show", "mgtd.service").returncode == 0
        wait(booted, "systemd does not answer")

    def show(self, key, unit="mgtd.service"):
        return self.inside("systemctl", "show", "--value", "-p", key, unit).stdout.strip()

    def active(self):
        return self.show("ActiveState") == "active"

    def mgt(self, *words):
        return self.inside(f"{PROGRAMS}/mgt", "--socket", "/run/mgtd/control.sock", *words)

    def daemon_log(self):
        return self.inside("cat", "/run/mgtd.log").stdout + self.log.read_text()[-1500:]

    def end(self):
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGKILL)
            self.process.wait()


def wait(condition, complaint, limit_s=90):
    """Polls; the limit only ends a test that would hang."""
    end = time.monotonic() + limit_s
    while not condition():
        if time.monotonic() > end:
            raise Failure(complaint() if callable(complaint) else complaint)
        time.sleep(0.1)


def demand(condition, what):
    if not condition:
        raise Failure(what)
    print("ok  " + what)


def demand_live(machine, what):
    live = machine.mgt("status", "--wait", "60")
    demand(live.returncode == 0, what if live.returncode == 0 else live.stdout + machine.daemon_log())


def streams(machine):
    line = machine.mgt("watch", "--raw", "--count", "1").stdout
    return '"class":"TENSOR"' in line


def check_sandbox(machine):
    status = machine.inside("cat", f"/proc/{inner_pid(machine)}/status").stdout
    fields = dict(line.split(":", 1) for line in status.splitlines() if ":" in line)
    uid = machine.inside("id", "-u", "mgtd").stdout.strip()
    demand(fields["Uid"].split() == [uid] * 4 and uid != "0", "it runs as the user mgtd, never as root")
    demand(int(fields["CapEff"], 16) == 0 and int(fields["CapBnd"], 16) == 0, "it has no capability and can get none")
    demand(fields["NoNewPrivs"].strip() == "1" and fields["Seccomp"].strip() == "2", "its system calls are filtered")


def inner_pid(machine):
    return int(machine.show("MainPID"))


def inode(machine, path):
    return machine.inside("stat", "-c", "%i", path).stdout.strip()


def the_life_of_a_service(machine):
    wait(machine.active, lambda: "mgtd did not become active:\n" + machine.daemon_log())
    demand(machine.show("SubState") == "running", "started by systemd; ready when its sockets listen")
    demand_live(machine, "every instrument is live on its pty")
    demand(streams(machine), "it streams")
    demand("epochs" in machine.show("StatusText"), "systemctl status says what it does: " + machine.show("StatusText"))
    check_sandbox(machine)
    sockets = [inode(machine, f"/run/mgtd/{name}.sock") for name in ("control", "stream")]
    machine.inside("systemctl", "restart", "mgtd.service")
    wait(machine.active, lambda: machine.daemon_log())
    demand([inode(machine, f"/run/mgtd/{name}.sock") for name in ("control", "stream")] == sockets,
           "the sockets outlive a restart")
    demand_live(machine, "all live again after the restart")
    for what, number, verdict in (("killed", signal.SIGKILL, "signal"), ("hung (SIGSTOP)", signal.SIGSTOP, "watchdog")):
        before, pid, results = int(machine.show("NRestarts")), inner_pid(machine), set()
        machine.inside("kill", f"-{number.value}", str(pid))

        def started_again():
            results.add(machine.show("Result"))
            return int(machine.show("NRestarts")) > before and machine.active() and inner_pid(machine) != pid
        wait(started_again, lambda: f"{what}: not started again\n" + machine.daemon_log())
        demand(verdict in results, f"{what}: systemd noticed, by its {verdict}")
        demand_live(machine, f"{what}: started again, all live, by itself")
    machine.inside("systemctl", "stop", "mgtd.service")
    demand(machine.show("ActiveState") == "inactive" and machine.show("Result") == "success", "stopped in order")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for option in ("--build", "--source", "--programs"):
        parser.add_argument(option, type=pathlib.Path, required=True)
    options = parser.parse_args()
    if os.geteuid() != 0:
        skip("namespaces for a second systemd need root")
    for tool in (SYSTEMD, "unshare", "nsenter", "ip", "systemctl", "systemd-sysusers"):
        if shutil.which(tool) is None:
            skip(f"{tool} is not on this machine")
    if subprocess.run(["unshare", "--pid", "--mount", "--fork", "true"], check=False).returncode != 0:
        skip("this machine does not allow namespaces of one's own")
    with tempfile.TemporaryDirectory(prefix="mgtd-systemd-") as scratch:
        os.chmod(scratch, 0o755)
        machine = Machine(options, pathlib.Path(scratch))
        try:
            machine.wait_for_boot()
            the_life_of_a_service(machine)
        except Failure as failure:
            print(f"FAILED: {failure}")
            return 1
        finally:
            machine.end()
    return 0


if __name__ == "__main__":
    sys.exit(main())
