# SPDX-License-Identifier: Apache-2.0
"""A repository of meshes on a bare Debian 12, made by debootstrap: what docs/ci.md and the action run installs fdcg there, finds
what is wound wrongly, writes its reports, and ends with the exit code of the check."""
import functools
import http.server
import os
import pathlib
import re
import shutil
import subprocess
import textwrap
import threading
import unittest

from support import FDCG, ROOT, Case

MIRROR = "http://deb.debian.org/debian"
BUILD = pathlib.Path(os.environ["FDCG_BUILD"])
BARE = BUILD / "tests/bare-debian-12"  # kept for the next time
PAGE = (ROOT / "docs/ci.md").read_text()
CUBE = (ROOT / "tests/docs/cube.off").read_text()

# Run as root in a namespace of mounts: a copy of the bare system, of which nothing is kept, with the repository in it.
IN_A_COPY = """
set -eu
mount -t tmpfs none "$1/copy"
mkdir "$1/copy/written" "$1/copy/work" "$1/copy/root"
mount -t overlay -o lowerdir="$2",upperdir="$1/copy/written",workdir="$1/copy/work" none "$1/copy/root"
mount -t proc none "$1/copy/root/proc"
mount --bind /dev "$1/copy/root/dev"
cp /etc/resolv.conf "$1/copy/root/etc/"
cp -r "$1/repository" "$1/copy/root/repository"
exec env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root chroot "$1/copy/root" /bin/bash /repository/script
"""

# What a job runs, on meshes that are good, and again with a face that is wound wrongly.
TWICE = """
cd /repository
! command -v fdcg curl wget python3 || exit 9
job() {{
{script}
}}
(set -e; job) >log 2>&1 || {{ cat log; exit 9; }}
echo "good: exit code 0, $(grep -c winding-inconsistent {findings})"
sed -i 's/^4 3 0 4 7$/4 7 4 0 3/' meshes/part.off
(set -e; job) >log 2>&1
echo "wrong: exit code $?, $(grep -c winding-inconsistent {findings})"
[ ! -f "{report}" ] || echo "$(grep -c '"startLine"' {report}) lines"
"""


def quoted(text):
    return "'" + text.replace("'", "'\\''") + "'"


def section(heading):
    return re.split(r"^## ", PAGE.split(f"## {heading}\n")[1], flags=re.M)[0]


class BareDebian(Case):
    def setUp(self):
        super().setUp()
        for program, group in (("debootstrap", "bare"), ("dpkg-buildpackage", "package"), ("lintian", "package")):
            if shutil.which(program) is None:
                self.skipTest(f"{program} is missing: group {group} of tools/packages")
        if os.geteuid() != 0 or subprocess.run(("unshare", "--mount", "true"), check=False, capture_output=True).returncode != 0:
            self.skipTest("a bare Debian needs root and mounts")
        self.make_bare_system()
        self.repository = self.folder / "repository"
        for folder in ("repository/meshes", "repository/ci", "repository/tools/ci", "copy"):
            (self.folder / folder).mkdir(parents=True)
        shutil.copy(ROOT / "CMakeLists.txt", self.repository)
        for script in ("ci/install", "tools/ci/install"):
            shutil.copy(ROOT / "tools/ci/install", self.repository / script)
        (self.repository / "meshes/part.off").write_text(CUBE)
        self.run_long(ROOT / "tools/package", "deb", "--built", BUILD, "--output", self.repository / "packages")
        self.package, = (self.repository / "packages").glob("fdcg_*.deb")

    def make_bare_system(self):
        if BARE.is_dir():
            return
        part = BARE.with_suffix(f".{os.getpid()}")
        self.addCleanup(shutil.rmtree, part, ignore_errors=True)
        done = subprocess.run(("debootstrap", "--variant=minbase", "bookworm", part, MIRROR), capture_output=True, text=True, check=False)
        if "Couldn't download" in done.stdout + done.stderr:
            self.skipTest(f"{MIRROR} cannot be reached")
        self.assertEqual(0, done.returncode, done.stdout[-2000:] + done.stderr)
        part.rename(BARE)

    def run_long(self, *command):
        done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=500, check=False)
        self.assertEqual(0, done.returncode, done.stdout[-3000:] + done.stderr[-3000:])
        return done.stdout

    def twice(self, script, findings, report):
        text = TWICE.format(script=textwrap.indent(script, "  "), findings=findings, report=report)
        (self.repository / "script").write_text(text)
        command = ("unshare", "--mount", "--propagation", "private", "bash", "-c", IN_A_COPY, "copy", self.folder, BARE)
        return self.run_long(*command).splitlines()

    def address_of_packages(self):
        handler = functools.partial(http.server.SimpleHTTPRequestHandler, directory=self.repository / "packages")
        handler.func.log_message = lambda *_: None
        server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler)
        threading.Thread(target=server.serve_forever, daemon=True).start()
        self.addCleanup(server.server_close)
        self.addCleanup(server.shutdown)
        return f"http://127.0.0.1:{server.server_address[1]}"

    def test_what_the_recipes_run(self):
        address = self.address_of_packages()
        has_viewer = b"no viewer" not in subprocess.run((FDCG, "view", "absent.off"), check=False, capture_output=True).stderr
        with self.subTest("one line of shell, the package from a file"):
            line = re.search(r"^sh ci/install packages/.*$", section("Install"), re.M)[0]
            line = re.sub(r"fdcg_\S*\.deb", self.package.name, line)
            self.judge(self.twice(line, "report.sarif", "report.sarif"))
        with self.subTest("three lines of YAML, the package from its release"):
            self.judge(self.twice(self.action(address), "/tmp/fdcg.sarif", "/tmp/fdcg.sarif"))
        with self.subTest("GitLab"):
            script = "\n".join(re.findall(r"^    - (.*)$", section("GitLab"), flags=re.M))
            script = script if has_viewer else script.replace(" --format html=meshes.html", "")
            self.judge(self.twice(f"export FDCG_PACKAGE={address}/{self.package.name}\n{script}", "report.xml", ""))
        with self.subTest("Jenkins"):
            script = re.search(r"^ *sh '(.*)'$", section("Jenkins"), flags=re.M)[1]
            self.judge(self.twice(f"export FDCG_PACKAGE=/repository/packages/{self.package.name}\n{script}", "report.xml", "report.sarif"))

    def action(self, address):
        """The steps of the action as GitHub runs them, with what the shortest step of the page gives it."""
        text = (ROOT / "tools/ci/action.yml").read_text()
        steps = [textwrap.dedent(step) for step in re.findall(r"^      run: \|\n((?:        .*\n)+)", text, flags=re.M)]
        step = re.findall(r"^```yaml\n(.*?)^```$", section("GitHub"), flags=re.M | re.S)[1]
        self.assertEqual(3, len(step.splitlines()))
        settings = {"ACTION": "/repository/tools/ci", "PACKAGE": "", "SHA256": "", "RELEASE": address, "RUNNER_TEMP": "/tmp",
                    "GITHUB_OUTPUT": "/tmp/output", "MESHES": ".", "ARGUMENTS": re.search(r"arguments: (.*)$", step, re.M)[1]}
        script = "".join(f"export {name}={quoted(value)}\n" for name, value in settings.items())
        return script + "".join(f"bash --noprofile --norc -eo pipefail -c {quoted(step)}\n" for step in steps)

    def judge(self, printed):
        numbers = [[int(number) for number in re.findall(r"\d+", line)] for line in printed]
        self.assertEqual([0], [code for code, _ in numbers[:1]], printed)
        self.assertEqual([1], [code for code, _ in numbers[1:2]], printed)
        self.assertGreater(numbers[1][1], numbers[0][1], printed)  # the rules of SARIF name it too
        for line in numbers[2:]:
            self.assertGreater(line[0], 0, printed)


if __name__ == "__main__":
    unittest.main()
