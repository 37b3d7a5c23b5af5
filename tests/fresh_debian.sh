#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The commands of the README on a machine that has only the base system of a release of Debian: a
# chroot from debootstrap, a clone of this tree's last commit, tools/run, the ladders of CONTRIBUTING.md and
# tools/check twice each; first tools/run --tools.
#
#   tests/fresh_debian.sh [12|13] [FOLDER]    the oldest of tools/releases by default; needs root,
#                                             debootstrap and 6 GB; FOLDER is kept for a next time
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
. "$root/tools/packages.sh"
number=${1-$(sed -n 's/^\([0-9]*\) .*/\1/p' "$root/tools/releases" | head -n 1)}
name=$(release_name "$number")
[ -n "$name" ] || {
  echo "usage: tests/fresh_debian.sh [RELEASE] [FOLDER]: \"$number\" is none of tools/releases:" >&2
  grep -v '^#' "$root/tools/releases" >&2
  exit 2
}
keep=${2:+yes}
base=${2:-$(mktemp -d)}
mirror=http://deb.debian.org

[ "$(id -u)" -eq 0 ] || { echo "fresh_debian.sh: needs root, for chroot; start it with sudo" >&2; exit 2; }
command -v debootstrap >/dev/null || apt-get install -y debootstrap

if [ ! -e "$base/etc/debian_version" ]; then
  echo "fresh Debian $number base system in $base"
  debootstrap --variant=minbase "$name" "$base" $mirror/debian >/dev/null
fi
cat >"$base/etc/apt/sources.list" <<EOT
deb $mirror/debian $name main
deb $mirror/debian $name-updates main
deb $mirror/debian-security $name-security main
EOT
cp /etc/resolv.conf "$base/etc/resolv.conf"
# A network with a certificate authority of its own: the chroot trusts what this machine trusts.
mkdir -p "$base/etc/ssl/certs"
[ -e "$base/etc/ssl/certs/host.crt" ] || cp /etc/ssl/certs/ca-certificates.crt "$base/etc/ssl/certs/host.crt" || true

rm -rf "$base/root/tact"
chmod 711 "$base/root"  # tests become other users, who run what is built here
git clone -q --no-hardlinks "$root" "$base/root/tact"
for kind in proc sys dev; do
  mountpoint -q "$base/$kind" && continue
  mount --rbind "/$kind" "$base/$kind"
  mount --make-rslave "$base/$kind"  # what is unmounted there stays mounted here
done
leave() {
  for kind in dev sys proc; do umount -R -l "$base/$kind" 2>/dev/null || true; done
  [ "$keep" = yes ] || rm -rf --one-file-system "$base"
}
trap leave EXIT

inside() {
  chroot "$base" env -i HOME=/root TERM=dumb LANG=C.UTF-8 \
    PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin \
    NODE_EXTRA_CA_CERTS=/etc/ssl/certs/host.crt bash -c "cd /root/tact && $*"
}
for round in first second; do
  for command in './tools/run --tools' './tools/run --headless --seconds 10' \
    'apt-get install -qq -y git python3 >/dev/null && python3 tests/house/ladder_test.py --build' \
    './tools/check'; do
    echo "== $round time: $command"
    start=$SECONDS
    inside "$command"
    echo "== took $((SECONDS - start)) s"
  done
done
