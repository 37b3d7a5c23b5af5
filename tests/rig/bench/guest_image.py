# SPDX-License-Identifier: Apache-2.0
"""The guest: Debian's PREEMPT_RT kernel, gpio-sim built from Debian's source, a small Debian root.

Debian packages only. Each step is kept under a name that holds a hash of what it is made from, so
an unchanged tree builds nothing and a changed one builds the step that changed.
"""
import hashlib
import inspect
import os
import pathlib
import platform
import shutil
import subprocess
import tempfile

from bench import cpio

ROOT = pathlib.Path(__file__).resolve().parents[3]
GUEST = ROOT / "tests" / "rig" / "guest"
HEADERS = "linux-headers-rt-amd64"  # depends on the headers of the release's newest kernel
GUEST_PACKAGES = "kmod udev iproute2 procps can-utils gpiod usbutils rt-tests stress-ng strace libstdc++6".split()
LINKED = "libusb-1.0-0-dev libgpiod-dev libfmt-dev libssl-dev libtomlplusplus-dev libseccomp-dev".split()
MODULES = ("configfs vcan vxcan can_raw can_bcm can_gw sch_netem vhci_hcd usbmon "
           "ftdi_sio libcomposite usb_f_fs dummy_hcd gpio-sim softdog")
PRUNED = ("usr/share/doc", "usr/share/man", "usr/share/locale", "usr/share/info", "usr/share/perl*",
          "usr/share/zoneinfo", "usr/share/lintian", "usr/share/bash-completion", "usr/share/misc",
          "var/cache", "var/lib/apt", "var/lib/dpkg", "var/log", "usr/lib/udev/hwdb.d",
          "usr/lib/udev/hwdb.bin", "etc/udev/hwdb.bin", "usr/lib/debug", "usr/libexec",
          "usr/lib/python3*", "usr/lib/*/perl*", "usr/lib/*/gconv", "usr/bin/perl*",
          "usr/bin/python3*", "usr/lib/apt", "usr/lib/*/libapt*", "usr/bin/apt*", "usr/bin/dpkg*",
          "usr/lib/*/libpython*", "usr/lib/*/*.a", "usr/lib/*/libicu*", "usr/bin/stress-ng-*",
          "usr/lib/*/libLLVM*", "usr/lib/*/libgallium*", "usr/lib/*/libz3.so*")


class RigError(Exception):
    """One sentence: what, where, the remedy."""


def command(arguments, failure, **options):
    """Runs a program silently; raises RigError(failure) with the end of what it said."""
    done = subprocess.run(arguments, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          errors="replace", check=False, **options)
    if done.returncode != 0:
        tail = "\n".join(done.stdout.splitlines()[-8:])
        raise RigError(f"{failure}\n{tail}")
    return done.stdout


def digest(*parts):
    """Twelve hexadecimal digits over strings, bytes and the content of files."""
    total = hashlib.sha256()
    for part in parts:
        data = (part.read_bytes() if isinstance(part, pathlib.Path) else
                part if isinstance(part, bytes) else str(part).encode())
        total.update(hashlib.sha256(data).digest())
    return total.hexdigest()[:12]


def install_host_packages():
    script = f'. "{ROOT}/tools/packages.sh"; need_packages "the virtual bench" "${{RIG_PACKAGES[@]}}"'
    if subprocess.run(["bash", "-c", script], check=False).returncode != 0:
        raise RigError("the packages of the virtual bench are missing and could not be installed")


def kernel_release():
    """Of the headers that are installed, e.g. 6.1.0-56-rt-amd64: image and modules must match."""
    depends = command(["dpkg-query", "-W", "-f=${Depends}", HEADERS],
                      f"{HEADERS} is not installed; apt-get install {HEADERS}")
    return depends.split()[0].removeprefix("linux-headers-").rstrip(",")


def kernel_source(release):
    """Debian's package of the source of 6.1.0-56-rt-amd64 is linux-source-6.1."""
    return "linux-source-" + ".".join(release.split(".")[:2])


def guest_packages():
    """With the libraries that tactd is linked to, by the names that this release gives them."""
    depends = command(["dpkg-query", "-W", "-f=${Depends}\n", *LINKED],
                      f"the libraries of tactd are not installed; apt-get install {' '.join(LINKED)}")
    return GUEST_PACKAGES + [line.split()[0].rstrip(",") for line in depends.splitlines()]


def build_in(target, make):
    """Calls make(folder) for a folder that becomes `target` only when all of it is there."""
    if target.exists():
        return target
    target.parent.mkdir(parents=True, exist_ok=True)
    fresh = pathlib.Path(tempfile.mkdtemp(prefix="fresh-", dir=target.parent))
    try:
        make(fresh)
        fresh.chmod(0o755)
        try:
            fresh.rename(target)
        except OSError:
            if not target.exists():  # else another run was faster: its result is as good
                raise
    finally:
        shutil.rmtree(fresh, ignore_errors=True)
    return target


def build_kernel(folder, release):
    """vmlinuz and lib/modules with what the bench needs, gpio-sim among them."""
    with tempfile.TemporaryDirectory() as scratch:
        work = pathlib.Path(scratch)
        work.chmod(0o755)
        command(["apt-get", "-o", "APT::Sandbox::User=root", "download", f"linux-image-{release}"],
                f"linux-image-{release} cannot be downloaded; without network this needs the cache "
                f"of an earlier run (TACT_RIG_CACHE); after an update of Debian's kernel: apt-get "
                f"update && apt-get install {HEADERS} linux-source", cwd=work)
        package = next(work.glob("*.deb"))
        command(["dpkg", "-x", str(package), str(work / "image")], f"{package} cannot be unpacked")
        shutil.copy(work / "image" / "boot" / f"vmlinuz-{release}", folder / "vmlinuz")
        if not (work / "image" / "lib").exists():  # from Debian 13 on all lies in /usr
            (work / "image" / "lib").symlink_to("usr/lib")
        modules = (work / "image" / "lib" / "modules" / release).resolve()
        build_gpio_sim(work / "gpio", release, modules / "updates")
        command(["depmod", "-b", str(work / "image"), release], "depmod failed")
        keep = folder / "root" / "lib" / "modules" / release
        for name in MODULES.split():
            needed = command(["modprobe", "-d", str(work / "image"), "-S", release,
                              "--show-depends", name], f"the kernel has no module {name}")
            for line in needed.splitlines():
                if line.startswith("insmod"):
                    source = pathlib.Path(line.split()[1]).resolve()
                    target = keep / source.relative_to(modules)
                    target.parent.mkdir(parents=True, exist_ok=True)
                    shutil.copy(source, target)
        for listing in ("modules.builtin", "modules.builtin.modinfo", "modules.order"):
            shutil.copy(modules / listing, keep)
        command(["depmod", "-b", str(folder / "root"), release], "depmod failed")


def build_gpio_sim(work, release, target):
    """Debian ships gpio-sim's source but not its module. irq_to_desc() is not exported to modules;
    irq_data_to_desc() is an inline function that gives the same."""
    work.mkdir()
    target.mkdir()
    source = kernel_source(release)
    command(["tar", "-xJf", f"/usr/src/{source}.tar.xz", "-C", str(work), "--strip-components=3",
             f"{source}/drivers/gpio/gpio-sim.c", f"{source}/drivers/gpio/gpiolib.h",
             f"{source}/kernel/irq/irq_sim.c"], f"/usr/src/{source}.tar.xz cannot be unpacked")
    simulator = work / "irq_sim.c"
    simulator.write_text(simulator.read_text().replace(
        "irq_to_desc(irqnum)", "irq_data_to_desc(irq_get_irq_data(irqnum))") +
        '\n#include <linux/module.h>\nMODULE_LICENSE("GPL");\n')
    (work / "Makefile").write_text("obj-m := irq_sim.o gpio-sim.o\n")
    command(["make", "-C", f"/usr/src/linux-headers-{release}", f"M={work}", "modules"],
            "gpio-sim does not compile against the kernel's headers")
    for module in work.glob("*.ko"):
        command(["strip", "-g", str(module)], f"{module} cannot be stripped")
        shutil.copy(module, target)


def build_guest_root(folder):
    """A Debian root as tar."""
    codename = platform.freedesktop_os_release()["VERSION_CODENAME"]
    sources = [p for p in ("/etc/apt/sources.list.d/debian.sources", "/etc/apt/sources.list")
               if os.path.exists(p) and codename in pathlib.Path(p).read_text()]
    command(["mmdebstrap", "--quiet", "--variant=minbase", f"--mode={'root' if os.getuid() == 0 else 'unshare'}",
             f"--include={','.join(guest_packages())}", codename, str(folder / "root.tar"),
             *sources[:1]],
            "the guest's Debian root cannot be made by mmdebstrap; it needs the network, and the "
            "right to make namespaces when not root")


def build(cache, say):
    """Builds what is missing in `cache`; returns the paths of vmlinuz, initramfs and what
    QEMU is to load besides."""
    install_host_packages()
    release = kernel_release()
    version = command(["dpkg-query", "-W", "-f=${Version}", f"linux-headers-{release}"], "no headers")
    recipe = [inspect.getsource(step) for step in (build_kernel, build_gpio_sim, build_guest_root)]
    kernel = cache / f"kernel-{release}-{digest(version, MODULES, *recipe[:2])}"
    root = cache / f"root-{digest(guest_packages(), recipe[2])}"
    early = [GUEST / "init", GUEST / "fw_cfg_read.cc", pathlib.Path(cpio.__file__),
             inspect.getsource(pack)]
    guest = cache / f"guest-{digest(kernel.name, root.name, PRUNED, *early)}"
    if not kernel.exists():
        say(f"building: Debian's kernel {release} and gpio-sim (once, 1/2 min)")
        build_in(kernel, lambda folder: build_kernel(folder, release))
    if not root.exists():
        say("building: the guest's Debian root (once, 1 to 2 min)")
        build_in(root, build_guest_root)
    if not guest.exists():
        say("building: initramfs")
        build_in(guest, lambda folder: pack(folder, kernel, root))
    poll = pathlib.Path(__file__).with_name("patient_poll.cc")
    shim = build_in(cache / f"qemu-{digest(poll)}", lambda folder: command(
        ["g++", "-std=c++20", "-O2", "-shared", "-fPIC", "-o", str(folder / "patient_poll.so"),
         str(poll)], "patient_poll does not compile"))
    return kernel / "vmlinuz", guest / "initramfs", shim / "patient_poll.so"


def pack(folder, kernel, root):
    with tempfile.TemporaryDirectory() as scratch:
        own = pathlib.Path(scratch)
        shutil.copy(GUEST / "init", own)
        (own / "init").chmod(0o755)
        (own / "usr" / "bin").mkdir(parents=True)
        command(["g++", "-std=c++20", "-O2", "-static", "-o", str(own / "usr" / "bin" / "fw_cfg_read"),
                 str(GUEST / "fw_cfg_read.cc")], "fw_cfg_read does not compile")
        cpio.write_initramfs(folder / "initramfs", root / "root.tar", PRUNED,
                             [(kernel / "root" / "lib", "usr/lib"), (own, "")])
