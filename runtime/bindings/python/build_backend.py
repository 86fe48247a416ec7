# SPDX-License-Identifier: Apache-2.0
"""A build backend (PEP 517): CMake builds the module, and a wheel is a zip of it. FDCG_BUILD_FOLDER keeps the build; without it
each one begins anew. CMAKE_ARGS: more arguments for cmake, as a shell would read them."""
import base64
import csv
import hashlib
import io
import os
import pathlib
import re
import shlex
import subprocess
import sys
import sysconfig
import tempfile
import zipfile

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[2]
VERSION = re.search(r'^version = "(.*)"', (HERE / "pyproject.toml").read_text(), re.M).group(1)
INFO = f"fdcg-{VERSION}.dist-info"
EPOCH = (1980, 1, 1, 0, 0, 0)  # the same bytes from every build


def _tag():
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    platform = sysconfig.get_platform().replace("-", "_").replace(".", "_")
    return f"{python}-{python}-{platform}"


def _build(folder):
    subprocess.run(["cmake", "-S", str(ROOT), "-B", folder, "-DCMAKE_BUILD_TYPE=Release", "-DFDCG_BUILD_TESTS=OFF",
                    "-DFDCG_BUILD_PYTHON=ON", "-DCMAKE_UNITY_BUILD=ON", f"-DPYTHON_EXECUTABLE={sys.executable}", f"-DPython_EXECUTABLE={sys.executable}",
                    *shlex.split(os.environ.get("CMAKE_ARGS", ""))], check=True)
    subprocess.run(["cmake", "--build", folder, "--parallel", str(os.cpu_count()), "--target", "fdcg_python"], check=True)
    return pathlib.Path(folder, "python", "fdcg")


def _metadata():
    return (f"Metadata-Version: 2.1\nName: fdcg\nVersion: {VERSION}\nSummary: Feel 3D models: contact with friction on polygon meshes\n"
            "License: Apache-2.0\nRequires-Python: >=3.9\nRequires-Dist: numpy\n")


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    with tempfile.TemporaryDirectory() as scratch:
        package = _build(os.environ.get("FDCG_BUILD_FOLDER", scratch))
        files = {f"fdcg/{path.name}": path.read_bytes() for path in sorted(package.iterdir()) if path.is_file()}
    files[f"{INFO}/METADATA"] = _metadata().encode()
    files[f"{INFO}/WHEEL"] = f"Wheel-Version: 1.0\nGenerator: fdcg\nRoot-Is-Purelib: false\nTag: {_tag()}\n".encode()
    record = io.StringIO()
    rows = csv.writer(record, lineterminator="\n")
    for name, data in files.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
        rows.writerow([name, f"sha256={digest}", len(data)])
    rows.writerow([f"{INFO}/RECORD", "", ""])
    files[f"{INFO}/RECORD"] = record.getvalue().encode()
    name = f"fdcg-{VERSION}-{_tag()}.whl"
    with zipfile.ZipFile(os.path.join(wheel_directory, name), "w", zipfile.ZIP_DEFLATED) as wheel:
        for path, data in files.items():
            info = zipfile.ZipInfo(path, EPOCH)
            info.external_attr = 0o644 << 16
            info.compress_type = zipfile.ZIP_DEFLATED
            wheel.writestr(info, data)
    return name


def build_sdist(sdist_directory, config_settings=None):
    raise RuntimeError("fdcg: a source archive is that of the whole project (tools/release); install from its folder")
