# SPDX-License-Identifier: Apache-2.0
# system.sh - sourced by tools/image: the files of the PC's root, by mmdebstrap and the packages.
# shellcheck shell=bash disable=SC2154  # uuid, device are of tools/image

# No recommended packages: linux-image-rt-amd64 of tact-rt is named here.
IMAGE_DEBIAN=(systemd systemd-sysv udev dbus linux-image-rt-amd64 initramfs-tools zstd e2fsprogs
  grub-pc-bin grub-efi-amd64-bin grub-efi-amd64-signed shim-signed grub2-common
  systemd-resolved systemd-timesyncd sudo passwd login man-db nano less iproute2 kmod rt-tests)

# make_system SUITE FOLDER PACKAGE...
make_system() {
  local suite=$1 pc=$2
  shift 2
  # A package of its own from Debian 13 on: the root takes the whole disk.
  [ "$suite" = bookworm ] || IMAGE_DEBIAN+=(systemd-repart)
  local included
  included=$(IFS=,; echo "${IMAGE_DEBIAN[*]}")
  mmdebstrap --variant=apt --include="$included" \
    --dpkgopt='path-exclude=/usr/share/locale/*' --dpkgopt='path-exclude=/usr/share/doc/*' \
    --dpkgopt='path-include=/usr/share/doc/*/copyright' \
    --essential-hook="mkdir -p \"\$1/etc\"; echo 'UUID=$uuid / ext4 errors=remount-ro,x-systemd.growfs 0 1' >\"\$1/etc/fstab\"" \
    "$suite" "$pc" "deb http://deb.debian.org/debian $suite main" \
    "deb http://deb.debian.org/debian $suite-updates main" \
    "deb http://deb.debian.org/debian-security $suite-security main"
  put /etc/default/grub <<'EOT'
# Screen and first serial port. Drop-ins add to it; then update-grub.
GRUB_DEFAULT=0
GRUB_TIMEOUT=1
GRUB_DISTRIBUTOR=tact
GRUB_CMDLINE_LINUX_DEFAULT="quiet"
GRUB_CMDLINE_LINUX="console=ttyS0,115200 console=tty0"
GRUB_DISABLE_OS_PROBER=true
EOT
  put /etc/default/grub.d/image.cfg <<'EOT'
# The image does not know its PC, so it keeps core 1 for the loop: every PC with two cores has it.
# Remove this file, update-grub and boot: then it is the last core.
TACT_ONLINE=0-1
EOT
  mkdir "$pc/root/tact"
  cp "$@" "$pc/root/tact/"
  cp /etc/resolv.conf "$work/resolv.conf"
  inside 'apt-get update && apt-get install -y --no-install-recommends /root/tact/*.deb && apt-get clean' "$work/resolv.conf"
  rm -r "$pc/root/tact" "$pc"/var/lib/apt/lists/*
  settle "$pc"
}

# inside COMMAND [RESOLV_CONF]: in the chroot, with proc and a resolver that end with the command
inside() {
  unshare --mount bash -euc 'mount -t proc proc "$0/proc"
    if [ -n "$2" ]; then mount -t tmpfs none "$0/run"
      mkdir -p "$0/run/systemd/resolve"; cp "$2" "$0/run/systemd/resolve/stub-resolv.conf"; fi
    exec chroot "$0" env -i HOME=/root TERM=dumb LANG=C.UTF-8 DEBIAN_FRONTEND=noninteractive \
      PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin sh -euc "$1"' "$pc" "$1" "${2:-}"
}

# put PATH: what comes on standard input, a file of the PC
put() { install -D -m 644 /dev/stdin "$pc$1"; }

# settle FOLDER: what the packages leave to the PC's owner
settle() {
  local pc=$1
  echo haptics-pc >"$pc/etc/hostname"
  printf '127.0.0.1 localhost\n127.0.1.1 haptics-pc\n' >"$pc/etc/hosts"
  : >"$pc/etc/machine-id"  # the first boot makes one
  put /etc/systemd/network/80-wired.network <<'EOT'
# Any wired port that gets an address is taken; nothing waits for it.
[Match]
Type=ether

[Network]
DHCP=yes

[Link]
RequiredForOnline=no
EOT
  put /etc/systemd/journald.conf.d/tact.conf <<'EOT'
# What tactd has said outlives a power cut.
[Journal]
Storage=persistent
SystemMaxUse=500M
SyncIntervalSec=10s
EOT
  put /etc/systemd/resolved.conf.d/tact.conf <<'EOT'
# No port is open: names come from the DNS server alone.
[Resolve]
LLMNR=no
MulticastDNS=no
EOT
  put /etc/repart.d/50-root.conf <<'EOT'
# The root partition takes the whole disk at the first boot (systemd-repart).
[Partition]
Type=root-x86-64
EOT
  (umask 077; echo "$password" >"$pc/etc/first-password")
  inside 'useradd --create-home --shell /bin/bash --groups sudo,haptics lab
    read -r password </etc/first-password && echo "lab:$password" | chpasswd && rm /etc/first-password
    passwd --quiet --expire lab
    systemctl enable systemd-networkd tactd@liver'
  [ "$device" = sim-delta ] || choose_device "$pc/etc/tact/liver.toml"
}

# choose_device SCENE: its [device] sections become those of the example with that kind
choose_device() {
  local wanted
  case $device in
    can-*) wanted='delta|can|lines' ;;
    *) wanted="${device//-/_}|lines" ;;
  esac
  awk -v kind="$device" -v wanted="^\\[device(\\.($wanted))?\\]" '
    FNR == 1 { of = of + 1 }
    of == 1 && /^\[/ { take = $0 ~ wanted }
    of == 1 && take { example = example (/^kind = / ? "kind = \"" kind "\"" : $0) "\n" }
    of == 2 && /^\[/ { was = skip; skip = /^\[device/; if (skip && !was) printf "%s", example }
    of == 2 && !skip' "$root/tools/deploy/devices.toml" "$1" >"$work/scene"
  cat "$work/scene" >"$1"
}
