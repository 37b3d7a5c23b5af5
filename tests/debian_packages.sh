#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The packages of tools/package on a machine that has only this release's base system: installed as the page "From bare
# PC to first force" says, run, installed again over an edited scene, removed and purged, after which nothing of them is
# left.
#
#   tests/debian_packages.sh [FOLDER]    needs root and mmdebstrap; FOLDER keeps the base system
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
packages="$root/build/packages"
base=$(mktemp -d)
name=$(. /etc/os-release && echo "$VERSION_CODENAME")  # where the packages were built
cache=${1:+$1/$name.tar}
trap 'rm -rf --one-file-system "$base"' EXIT
[ "$(id -u)" -eq 0 ] || { echo "debian_packages.sh: needs root, for chroot; start it with sudo" >&2; exit 2; }
ls "$packages"/tact_*.deb >/dev/null || { echo "debian_packages.sh: run tools/package first" >&2; exit 2; }

if [ -n "$cache" ] && [ -e "$cache" ]; then
  tar xf "$cache" -C "$base"
else
  mmdebstrap --quiet --variant=apt --include=systemd,udev,man-db,bash-completion,adduser "$name" "$base" \
    "deb http://deb.debian.org/debian $name main" \
    "deb http://deb.debian.org/debian-security $name-security main"
  if [ -n "$cache" ]; then mkdir -p "$1" && tar cf "$cache" --one-file-system -C "$base" .; fi
fi
cp "$packages"/*.deb "$base/root/"
cp /etc/resolv.conf "$base/etc/resolv.conf"

inside() {  # a mount of proc that ends with the command
  unshare --mount bash -c 'mount -t proc proc "$0/proc" && exec chroot "$@"' "$base" "$base" env -i \
    HOME=/root TERM=dumb LANG=C.UTF-8 DEBIAN_FRONTEND=noninteractive \
    PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin bash -euc "$1"
}
step() { echo "== $*"; }
# What is of tact outside of what apt and this test keep.
left_over() {
  find "$base" -xdev \( -iname '*tact*' -o -iname '*haptic*' \) \
    -not -path "$base/root/*" -not -path "$base/var/lib/apt/*" -not -path "$base/var/cache/*" \
    -not -path "$base/var/log/*" -not -path "$base/usr/share/*contact*" -not -path "$base/proc/*" \
    -not -path "$base/usr/include/*" -not -path "$base/usr/lib/*.h"
  grep -HE '(^|[:,])(tact|tact-view|haptics)(:|,|$)' "$base"/etc/{passwd,shadow,group,gshadow} || true
}

before=$(left_over)
# GRUB as a file with the kernel's command line: the chroot has no disk to boot from.
mkdir -p "$base/boot/grub" "$base/etc/default" && touch "$base/boot/grub/grub.cfg"
cat >"$base/usr/sbin/update-grub" <<'END'
#!/bin/sh -e
GRUB_CMDLINE_LINUX=quiet TACT_ONLINE=0-3
for file in /etc/default/grub.d/*.cfg; do [ ! -e "$file" ] || . "$file"; done
echo "$GRUB_CMDLINE_LINUX" >/boot/grub/grub.cfg
END
chmod 755 "$base/usr/sbin/update-grub"
step "tact-tools, with all that it needs, takes 60 MB at most, and no OpenCV, gnuplot or X11"
inside 'apt-get -qq update
apt-get -s -qq --no-install-recommends install /root/tact_*.deb /root/tact-tools_*.deb | sed -n "s/^Inst \([^ ]*\) .*/\1/p" >/root/wanted
! grep -E "opencv|gnuplot|libx11" /root/wanted || exit 1
{ apt-cache show --no-all-versions $(grep -v ^tact /root/wanted); dpkg-deb -f /root/tact_*.deb; dpkg-deb -f /root/tact-tools_*.deb; } |
  awk "/^Installed-Size:/ {kB += \$2} END {print kB, \"kB\"; exit kB > 60000}"'
step "the page From bare PC to first force does what it says"
python3 "$root/tests/tools/deploy/first_force.py" "$root/tools/deploy/FIRST_FORCE.md" "$base"
inside 'tact-mcap --version && tact-plot --version && tact-doctor --version
! tact-mcap a b 2>/root/said || exit 1
grep "apt install python3-numpy" /root/said
gpasswd -d root haptics >/dev/null && rm -rf /etc/tact/mine.toml /run/tact /tmp/tact-0'
step install
inside 'apt-get -qq install -y --no-install-recommends /root/*.deb' >"$base/root/log" 2>&1 ||
  { tail -n 30 "$base/root/log"; exit 1; }
step "every program prints its version and has a manual page"
inside 'for program in $(dpkg -L tact tact-view tact-ros tact-tools tact-lab | grep ^/usr/bin/); do
  $program --version && man -w ${program##*/} >/dev/null; done'
step "a manual page has examples, files and what to see also, which is there"
inside 'for page in $(dpkg -L tact tact-view tact-ros tact-tools tact-lab tact-doc | grep -o "/man./.*[.][157]"); do
  page=${page##*/}
  man ${page##*.} ${page%.*} >/root/page
  for part in EXAMPLES FILES "SEE ALSO"; do grep -qx "$part" /root/page || { echo "$page has no $part"; exit 1; }; done
  for other in $(sed -n "/^SEE ALSO/,\$p" /root/page | grep -oE "tact[a-z-]*[(][157][)]" | sed -E "s/(.*)[(](.)[)]/\2,\1/"); do
    man -w ${other%,*} ${other#*,} >/dev/null || { echo "$page names $other"; exit 1; }; done; done
grep -c youngs_modulus_Pa <(man 5 tact-scene)
cp /usr/share/tact/scenes/liver.toml /root/mine.toml && ln -s /usr/share/tact/scenes/meshes /root/meshes
tactd /root/mine.toml --set limits.force_N=1 --check >/dev/null && rm /root/mine.toml /root/meshes
grep -q "<h1" /usr/share/doc/tact-doc/html/tools/deploy/FIRST_FORCE.html && test -s /usr/share/doc/tact-doc/html/index.html'
step "a program of one's own finds tact-dev and renders a wall"
inside 'apt-get -qq install -y --no-install-recommends cmake g++ make >/dev/null 2>&1
cp -r /usr/share/doc/tact-dev/examples /root/own && cmake -S /root/own -B /root/own/build >/dev/null && cmake --build /root/own/build >/dev/null
/root/own/build/wall | tail -n 1 && /root/own/build/own_loop /usr/share/tact/scenes/liver.toml
rm -r /root/own && apt-get -qq purge -y --autoremove cmake g++ make >/dev/null 2>&1'
step "bash completes the options of every program"
inside 'for program in $(dpkg -L tact tact-view tact-ros tact-tools tact-lab | grep ^/usr/bin/); do
  name=${program##*/}
  [ $name != tact-guardian ] || continue
  bash -c "source /usr/share/bash-completion/bash_completion; source /usr/share/bash-completion/completions/$name
    COMP_LINE=\"$name --vers\" COMP_WORDS=($name --vers) COMP_CWORD=1; COMP_POINT=\${#COMP_LINE}
    _longopt $name --vers $name; [ \"\${COMPREPLY[*]}\" = --version ]" || exit 1; done'
step "the user tact runs a scene of /etc/tact and finds what belongs to it"
inside 'id tact | grep -q haptics
runuser -u tact -- tactd /etc/tact/liver.toml --check
for scene in /etc/tact/*.toml; do
  runuser -u tact -- tactd $scene --free-run --ticks 100 --no-telemetry --no-black-box >/dev/null; done
cd / && tact-verify | tail -n 1
tact-doctor >/dev/null || [ $? -eq 1 ]
test -s /usr/share/tact/page/index.html && test -x /usr/bin/tact-guardian'
step "the viewer's user looks, and cannot stop what it looks at"
inside 'export XDG_RUNTIME_DIR=/run
install -d -o tact -g haptics -m 0750 /run/tact
install -d -o tact-view -m 0755 /root/seen && chmod 711 /root
runuser -u tact -g haptics -- tactd /etc/tact/liver.toml --viewers haptics --no-black-box 2>/root/log & tactd=$!
for i in $(seq 100); do [ -S /run/tact/telemetry.sock ] && break; sleep .1; done
[ "$(stat -c "%U %G %a" /run/tact/telemetry.sock)" = "tact haptics 660" ]
timeout --preserve-status -s INT 3 runuser -u tact-view -g haptics -- tact-view --tactd-user tact --port 0 --record /root/seen/r >/dev/null
tact-view --open /root/seen/r --export /root/frames.csv | grep -v " 0 frames"
! runuser -u tact-view -g haptics -- tactctl /etc/tact/liver.toml stop --folder /run/tact || exit 1
! runuser -u tact-view -g haptics -- test -w "$(echo /run/tact/control-*)" || exit 1
tactctl /etc/tact/liver.toml status && tactctl /etc/tact/liver.toml stop && wait $tactd'
step "tact-rt keeps a core for the loop, and sets CPU speed and interrupts at every boot"
inside 'grep "^quiet isolcpus=domain,managed_irq,3 nohz_full=3 rcu_nocbs=3 irqaffinity=0-2$" /boot/grub/grub.cfg
systemctl is-enabled tact-rt
grep -q "^@haptics - rtprio 85$" /etc/security/limits.d/tact.conf'
step "for the core of a file that comes first, too"
inside 'echo TACT_CORE=1 >/etc/default/grub.d/50-core.cfg && update-grub && rm /etc/default/grub.d/50-core.cfg
grep "^quiet isolcpus=domain,managed_irq,1 nohz_full=1 rcu_nocbs=1 irqaffinity=0,2-3$" /boot/grub/grub.cfg'
step "a service follows its device, until it is disabled"
inside 'mkdir /etc/systemd/system/tactd@liver.service.d
sed "s/=sys-.*/=tact-falcon.device/" /usr/share/tact/pc/tactd-device.conf >/etc/systemd/system/tactd@liver.service.d/device.conf
systemctl enable tactd@liver
systemd-analyze verify --man=no tactd@liver.service 2>&1 | tee /root/verify && test ! -s /root/verify
test -L /etc/systemd/system/tact-falcon.device.wants/tactd@liver.service
systemctl disable tactd@liver && rm -r /etc/systemd/system/tactd@liver.service.d'
step "the units are sound"
inside 'systemd-analyze verify --man=no tactd@liver.service tact-awake@liver.service tact-view.service tact-rt.service 2>&1 | tee /root/verify
test ! -s /root/verify'
step "an edited scene outlives the same package"
inside 'echo "# mine" >>/etc/tact/liver.toml
apt-get -qq install -y --reinstall /root/tact_*.deb >/dev/null 2>&1
grep -q "# mine" /etc/tact/liver.toml'
step "the kernel's parameters go with tact-rt"
inside 'apt-get -qq remove -y tact-rt >/dev/null 2>&1
grep -x quiet /boot/grub/grub.cfg'
step "removed: scenes of /etc/tact stay; purged: nothing stays"
inside 'apt-get -qq remove -y tact tact-view tact-ros tact-tools tact-lab tact-dev tact-doc >/dev/null 2>&1
test ! -e /usr/bin/tactd && test -e /etc/tact/liver.toml
mkdir -p /var/lib/tact/black-box
dpkg --purge tact tact-view tact-ros tact-tools tact-lab tact-dev tact-doc tact-rt >/dev/null 2>&1'
after=$(left_over)
diff <(echo "$before") <(echo "$after") || { echo "debian_packages.sh: that is left"; exit 1; }
step "all kept"
