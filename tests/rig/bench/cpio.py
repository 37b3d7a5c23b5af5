# SPDX-License-Identifier: Apache-2.0
"""A Debian root as tar becomes the guest's initramfs: newc archive, sorted, no times, pruned.

Format: kernel documentation, driver-api/early-userspace/buffer-format: a 110-byte ASCII header
per file, name and content padded to 4 bytes, "TRAILER!!!" last. Same input, same bytes.
"""
import fnmatch
import stat
import tarfile

KIND = {tarfile.REGTYPE: stat.S_IFREG, tarfile.DIRTYPE: stat.S_IFDIR, tarfile.SYMTYPE: stat.S_IFLNK,
        tarfile.CHRTYPE: stat.S_IFCHR, tarfile.BLKTYPE: stat.S_IFBLK, tarfile.FIFOTYPE: stat.S_IFIFO}


class CpioWriter:
    """Writes entries in the order of the calls; inode numbers count up from 1."""

    def __init__(self, out):
        self.out = out
        self.inode = 0

    def add(self, name, mode, content=b"", device=(0, 0)):
        self.inode += 1
        encoded = name.encode() + b"\0"
        fields = (self.inode, mode, 0, 0, 1, 0, len(content), 0, 0, *device, len(encoded), 0)
        self._padded(b"070701" + b"".join(b"%08X" % field for field in fields) + encoded)
        self._padded(content)

    def close(self):
        self.inode = -1
        self.add("TRAILER!!!", 0)

    def _padded(self, data):
        self.out.write(data)
        self.out.write(b"\0" * (-len(data) % 4))


def is_pruned(name, patterns):
    """True for a path that matches a pattern or lies below one."""
    parts = name.split("/")
    return any(fnmatch.fnmatch("/".join(parts[:i]), pattern)
               for pattern in patterns for i in range(1, len(parts) + 1))


def write_initramfs(path, root_tar, pruned, folders):
    """Writes `path` from the tar `root_tar` without `pruned`, then every file of `folders`:
    a list of (host folder, guest folder)."""
    with open(path, "wb") as out, tarfile.open(root_tar) as tar:
        cpio = CpioWriter(out)
        for member in sorted(tar.getmembers(), key=lambda m: m.name):
            name = member.name.removeprefix("./").rstrip("/")
            if name in ("", ".") or is_pruned(name, pruned):
                continue
            source = tar._find_link_target(member) if member.islnk() else member
            if source.type not in KIND:
                raise ValueError(f"{root_tar}: {name} is of a kind that has no place in cpio")
            content = source.linkname.encode() if source.issym() else (
                tar.extractfile(source).read() if source.isreg() else b"")
            device = (source.devmajor, source.devminor) if source.isdev() else (0, 0)
            cpio.add(name, KIND[source.type] | source.mode, content, device)
        for host_folder, guest_folder in folders:
            add_folder(cpio, host_folder, guest_folder)
        cpio.close()


def add_folder(cpio, host_folder, guest_folder):
    """Adds a folder tree with its parents; executable bits stay."""
    parents = [p for p in guest_folder.split("/") if p]
    for depth in range(1, len(parents) + 1):
        cpio.add("/".join(parents[:depth]), stat.S_IFDIR | 0o755)
    for path in sorted(host_folder.rglob("*")):
        name = "/".join([*parents, *path.relative_to(host_folder).parts])
        if path.is_dir():
            cpio.add(name, stat.S_IFDIR | 0o755)
        else:
            mode = 0o755 if path.stat().st_mode & 0o100 else 0o644
            cpio.add(name, stat.S_IFREG | mode, path.read_bytes())
