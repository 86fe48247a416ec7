# SPDX-License-Identifier: Apache-2.0
"""A stock Debian kernel, and the small root file system that it boots into: busybox, the programs under test with their
libraries, and the modules of HID and USB. Nothing here needs root."""
import lzma
import os
import pathlib
import platform
import re
import shutil
import stat
import subprocess

MODULES = ["uhid", "hid-generic", "usbhid", "vhci-hcd"]
# opened at run time, so that ldd does not name them
LATE_LIBRARIES = ["libhidapi-hidraw.so.0", "libhidapi-libusb.so.0"]
APPLETS = "sh mount insmod cat dd printf poweroff".split()
SEARCH_PATH = os.environ.get("PATH", "") + ":/usr/sbin:/sbin"


class Missing(Exception):
    """Something that this machine does not have: the word says what, and where it comes from."""


def need(program):
    found = shutil.which(program, path=SEARCH_PATH)
    if found is None:
        raise Missing(f"{program} is missing; tools/check installs it (group test of tools/packages)")
    return found


def run(*command, **options):
    words = [str(word) for word in command]
    return subprocess.run(words, check=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE, **options).stdout


def own_lists(folder):
    """Options for apt with package lists of our own, newly fetched: for machines that keep none, or old ones."""
    lists, cache = folder / "apt" / "lists", folder / "apt" / "cache"
    (lists / "partial").mkdir(parents=True, exist_ok=True)
    (cache / "archives" / "partial").mkdir(parents=True, exist_ok=True)
    options = ["-o", f"Dir::State::Lists={lists}", "-o", f"Dir::Cache={cache}"]
    run(need("apt-get"), *options, "-o", "APT::Sandbox::User=", "update")
    return options


def download_kernel(unpacked, flavour, options):
    """False: apt knows no such package."""
    shown = run(need("apt-cache"), *options, "depends", f"linux-image-{flavour}").decode()
    names = re.findall(r"Depends: (linux-image-\d\S+)", shown)
    if not names:
        return False
    shutil.rmtree(unpacked, ignore_errors=True)
    unpacked.mkdir()
    run(need("apt-get"), *options, "-o", "APT::Sandbox::User=", "download", names[0], cwd=unpacked)
    package = next(unpacked.glob("*.deb"))
    run(need("dpkg"), "-x", package, unpacked)
    package.unlink()
    run(need("depmod"), "-b", unpacked, kernel_version(unpacked))
    return True


def fetch_kernel(folder, flavour):
    """The folder of an unpacked package: that of the kernel which linux-image-FLAVOUR names when it is first asked for."""
    if platform.machine() != "x86_64":
        raise Missing(f"no kernel: the virtual machine is an amd64, this machine's programs are for {platform.machine()}")
    unpacked = folder / flavour
    if (unpacked / "complete").exists():
        return unpacked
    folder.mkdir(parents=True, exist_ok=True)
    why = f"apt knows no package that linux-image-{flavour} depends on; is Debian's main in its sources?"
    for options in (lambda: [], lambda: own_lists(folder)):
        try:
            if download_kernel(unpacked, flavour, options()):
                (unpacked / "complete").touch()
                return unpacked
        except subprocess.CalledProcessError as error:
            why = f"`{' '.join(error.cmd)}` says {error.stderr.decode(errors='replace').strip()[-300:]}"
    raise Missing(f"no kernel: {why}")


def kernel_version(unpacked):
    return next((unpacked / "lib" / "modules").iterdir()).name


def kernel_image(unpacked):
    return next((unpacked / "boot").glob("vmlinuz-*"))


def modules_in_order(unpacked):
    """Module files, each after those that it needs."""
    files = []
    for name in MODULES:
        shown = run(need("modprobe"), "-d", unpacked, "-S", kernel_version(unpacked), "--show-depends", name).decode()
        files += [line.split()[1] for line in shown.splitlines() if line.startswith("insmod ")]
    return [pathlib.Path(file) for file in dict.fromkeys(files)]


def libraries_of(programs):
    """What the dynamic linker loads for them, by its own word."""
    found = set()
    for program in programs:
        try:
            found |= set(re.findall(rb"(/\S+\.so[.\d]*) \(0x", run("ldd", program)))
        except subprocess.CalledProcessError:
            pass  # statically linked
    return sorted(pathlib.Path(os.fsdecode(path)) for path in found)


def late_libraries():
    shown = run(need("ldconfig"), "-p").decode()
    found = []
    for name in LATE_LIBRARIES:
        match = re.search(rf"^\s*{re.escape(name)} .*=> (\S+)$", shown, re.MULTILINE)
        if match is None:
            raise Missing(f"{name} is missing; tools/check installs it (group test of tools/packages)")
        found.append(pathlib.Path(match[1]))
    return found


class Archive:
    """A cpio archive in the "newc" form that the kernel unpacks: the same content gives the same bytes."""

    def __init__(self):
        self.entries = {}

    def add(self, path, data=b"", mode=stat.S_IFREG | 0o755):
        for parent in reversed(pathlib.PurePosixPath(path).parents):
            if str(parent) != ".":
                self.entries.setdefault(str(parent), (stat.S_IFDIR | 0o755, b""))
        self.entries[str(path)] = (mode, data)

    def folder(self, path):
        self.add(path, mode=stat.S_IFDIR | 0o755)

    def link(self, path, target):
        self.add(path, target.encode(), stat.S_IFLNK | 0o777)

    def write(self, file):
        with open(file, "wb") as out:
            for number, path in enumerate(sorted(self.entries), 1):
                self.put(out, number, path, *self.entries[path])
            self.put(out, 0, "TRAILER!!!", 0, b"")

    @staticmethod
    def put(out, number, path, mode, data):
        name = path.encode() + b"\0"
        fields = [number, mode, 0, 0, 1, 0, len(data), 0, 0, 0, 0, len(name), 0]
        head = b"070701" + b"".join(b"%08X" % field for field in fields) + name
        out.write(head + b"\0" * (-len(head) % 4) + data + b"\0" * (-len(data) % 4))


def build_initramfs(unpacked, programs, files, init, out):
    """programs: found in /bin; files: {path in the guest: file here}; init: what the kernel starts."""
    archive = Archive()
    for name in ("dev", "proc", "sys", "run", "tmp", "full"):
        archive.folder(name)
    busybox = pathlib.Path(need("busybox"))
    archive.add("bin/busybox", busybox.read_bytes())
    for applet in APPLETS:
        archive.link(f"bin/{applet}", "busybox")
    for program in programs:
        archive.add(f"bin/{pathlib.Path(program).name}", pathlib.Path(program).read_bytes())
    late = late_libraries()
    for library in libraries_of([*programs, *late]):
        archive.add(str(library).lstrip("/"), library.read_bytes())
    for library in late:
        archive.add(f"usr/lib/{library.name}", library.read_bytes())
    order = []
    for module in modules_in_order(unpacked):
        data = module.read_bytes()
        archive.add(f"modules/{module.name.removesuffix('.xz')}", lzma.decompress(data) if module.suffix == ".xz" else data)
        order.append(f"/modules/{module.name.removesuffix('.xz')}")
    archive.add("modules/order", "\n".join(order).encode() + b"\n")
    for path, file in files.items():
        archive.add(path, pathlib.Path(file).read_bytes())
    archive.add("init", pathlib.Path(init).read_bytes())
    archive.write(out)
