# SPDX-License-Identifier: Apache-2.0
# packages.sh - sourced by run and check: installs Debian packages that are missing, after saying so.
#
#   need_packages "what for" package [package=command] [optional:package] ...
#
# A package counts as present when dpkg has it or, with =command, when the command exists. An
# optional one is left out, with a sentence, where the release of Debian does not have it.

# release_name NUMBER: of a release in tools/releases; nothing if it is none of them
release_name() { sed -n "s/^$1 //p" "$root/tools/releases"; }

is_present() {
  local package=${1%%=*} command=${1#*=}
  if [ "$command" != "$1" ] && command -v "$command" >/dev/null 2>&1; then return 0; fi
  [ "$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null)" = installed ]
}

as_root() {
  if [ "$(id -u)" -eq 0 ]; then "$@"
  elif command -v sudo >/dev/null 2>&1; then sudo "$@"
  else return 127; fi
}

# release_lacks PACKAGE: by the lists of apt, which are fetched where there are none
release_lacks() {
  apt-cache show dpkg 2>/dev/null | grep -q '^Filename' || as_root apt-get update >/dev/null 2>&1
  # Of a name that others only refer to, apt-cache prints nothing, and says that all is well.
  [ -z "$(apt-cache show "$1" 2>/dev/null)" ]
}

need_packages() {
  local what=$1 missing=() package name
  shift
  for package in $(printf '%s\n' "$@" | sort -u); do
    is_present "${package#optional:}" && continue
    name=${package#optional:} name=${name%%=*}
    if [[ $package == optional:* ]] && release_lacks "$name"; then
      echo "tact: this release of Debian has no $name: what needs it is left out, and says so"
      continue
    fi
    missing+=("$name")
  done
  [ ${#missing[@]} -eq 0 ] && return 0
  echo "tact: missing for $what, installing these Debian packages now:"
  echo "      ${missing[*]}"
  if [ "$(id -u)" -ne 0 ] && ! command -v sudo >/dev/null 2>&1; then
    echo "tact: neither root nor sudo here; run this as root, then start again:" >&2
    echo "      apt-get update && apt-get install -y ${missing[*]}" >&2
    return 2
  fi
  local log
  log=$(mktemp)
  if as_root env DEBIAN_FRONTEND=noninteractive apt-get update >"$log" 2>&1 &&
    as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends \
      "${missing[@]}" >>"$log" 2>&1; then
    rm -f "$log"
    return 0
  fi
  tail -n 15 "$log" >&2
  echo "tact: apt-get failed (whole log: $log); repair the package sources, then start again" >&2
  return 2
}

# What it takes to build the programs, and the page of the viewer.
BUILD_PACKAGES=(g++ cmake ninja-build ca-certificates libfmt-dev libcli11-dev
  nlohmann-json3-dev libtomlplusplus-dev libboost-dev libssl-dev libusb-1.0-0-dev libgpiod-dev libseccomp-dev
  libeigen3-dev libopencv-core-dev libopencv-calib3d-dev libgtest-dev)
# What the measuring tools call or link besides: those that judge a PC and a device, and all of them.
LIGHT_TOOL_PACKAGES=(gnuplot-nox rt-tests=cyclictest stress-ng=stress-ng)
TOOL_PACKAGES=("${LIGHT_TOOL_PACKAGES[@]}" gmsh optional:calculix-ccx libopenblas0 libbenchmark-dev
  python3-matplotlib python3-vtk9 python3-numpy python3-scipy)
# What tact-ros needs; without them it is left out.
ROS_PACKAGES=(cyclonedds-dev cyclonedds-tools)
# What the tests link or call besides.
TEST_PACKAGES=(libopenigtlink-dev python3-jsonschema python3-numpy python3-matplotlib python3-prometheus-client
  python3-scipy strace valgrind "${ROS_PACKAGES[@]}"
  pybind11-dev python3-dev systemd=systemd-analyze)
# What the virtual bench needs on this side (tests/rig).
RIG_PACKAGES=(qemu-system-x86=qemu-system-x86_64 cpio kmod zstd xz-utils mmdebstrap make g++
  linux-headers-rt-amd64 linux-source)
# The programs of others that tact works with, as its tests ask them (stage ecosystem): some 0.9 GB.
ECOSYSTEM_PACKAGES=(prometheus python3-prometheus-client octave octave-psychtoolbox-3 snakemake
  slurmctld slurmd slurm-client munge parallel iproute2=ip libfastrtps-dev fastddsgen)
PAGE_PACKAGES=(nodejs=node npm=npm)
# What makes and judges Debian packages (tools/package).
DEB_PACKAGES=(cmark-gfm debhelper dpkg-dev fakeroot help2man lintian git=git python3=python3)
# What makes a disk image (tools/image), and what boots it (tests/image).
IMAGE_PACKAGES=(mmdebstrap fdisk=sfdisk e2fsprogs dosfstools=mkfs.fat mtools=mcopy)
IMAGE_TEST_PACKAGES=(qemu-system-x86=qemu-system-x86_64 ovmf)

# has_option BUILD_DIR OPTION ON|OFF : is no more asked for than is configured?
has_option() { [ "$3" = OFF ] || grep -q "^$2:[A-Z]*=ON" "$1/CMakeCache.txt"; }

# build_programs BUILD_DIR TARGET... : configure when needed, then build quietly; the log on failure.
build_programs() {
  local build=$1 log tools=OFF lab=OFF target
  shift
  log=$(mktemp)
  local launcher=()
  command -v ccache >/dev/null 2>&1 && launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
  for target in "$@"; do  # the measuring tools need more packages than the controller
    case $target in
      tact_controller | tactd | tactctl | tact-guardian | tact-view | tact-mesh | tact-rig-*) ;;
      tact-doctor | tact-jitter | tact-limits | tact-verify | tact-calibrate) tools=ON ;;
      *) tools=ON lab=ON ;;
    esac
  done
  local options=("-DTACT_TOOLS=$tools" "-DTACT_LAB=$lab")
  # Tests are declared, so that every target of CONTRIBUTING.md builds in this folder, too; none is built here.
  options+=(-DBUILD_TESTING=ON)
  if [ -f "$build/build.ninja" ] && has_option "$build" BUILD_TESTING ON &&
    has_option "$build" TACT_TOOLS $tools && has_option "$build" TACT_LAB $lab; then
    options=()  # what an earlier command has asked for stays
  fi
  if [ ${#options[@]} -gt 0 ]; then
    CXX=g++ cmake -S "$root" -B "$build" -G Ninja "${launcher[@]}" "${options[@]}" \
      >"$log" 2>&1 || { cat "$log" >&2; return 2; }
  fi
  if ninja -C "$build" -n "$@" 2>/dev/null | grep -q 'no work to do'; then
    :
  elif [ -t 1 ]; then  # a person watches: show how far it is
    ninja -C "$build" "$@" || return 2
  else
    ninja -C "$build" "$@" >"$log" 2>&1 || { tail -n 40 "$log" >&2; return 2; }
  fi
  rm -f "$log"
}

# build_page BUILD_DIR : the bundled page in BUILD_DIR/page with the fault words of BUILD_DIR/tactd,
# which must be built, and npm packages by lock file; all only when changed. It appears whole: a test may serve it now.
build_page() {
  local page="$1/page" web="$root/host/web" log stamp faults="$1/faults.json"
  "$1/tactd" --faults --json "$faults" >/dev/null || return 2
  cmp -s "$faults" "$web/src/panels/faults.json" || cp "$faults" "$web/src/panels/faults.json" || return 2
  stamp=$(find "$web" -path "$web/node_modules" -prune -o -type f -print0 | sort -z | xargs -0 cat | sha256sum)
  [ -f "$page/index.html" ] && [ "$(cat "$page/.stamp" 2>/dev/null)" = "$stamp" ] && return 0
  log=$(mktemp)
  if [ "$(sha256sum <"$web/package-lock.json")" != "$(cat "$web/node_modules/.stamp" 2>/dev/null)" ]
  then
    echo "tact: installing the page's npm packages (three, uplot, vite, typescript) in host/web"
    (cd "$web" && npm ci --no-fund --no-audit) >"$log" 2>&1 || { tail -n 20 "$log" >&2; return 2; }
    sha256sum <"$web/package-lock.json" >"$web/node_modules/.stamp"
  fi
  (cd "$web" && npm run build -- --outDir "$page.new" --emptyOutDir) >"$log" 2>&1 ||
    { tail -n 20 "$log" >&2; return 2; }
  echo "$stamp" >"$page.new/.stamp"
  rm -rf "$page" && mv "$page.new" "$page" || return 2
  rm -f "$log"
}

# packages_of STAGE: what a stage of tools/check needs, without the lab where $lab is OFF
packages_of() {
  local clang=(clang-22 libclang-rt-22-dev) tests=("${LIGHT_TOOL_PACKAGES[@]}" "${TEST_PACKAGES[@]}")
  [ "$lab" = OFF ] || tests+=("${TOOL_PACKAGES[@]}")
  case $1 in
    format) echo clang-format-22=clang-format-22 ;;
    layering) echo python3=python3 git=git shellcheck=shellcheck pyflakes3=pyflakes3 pycodestyle=pycodestyle optional:similarity-tester=sim_c++ ;;
    spin) echo spin python3=python3 gcc=gcc ;;
    page) echo "${BUILD_PACKAGES[@]}" "${PAGE_PACKAGES[@]}" ;;
    build | tests | vectors | failing) echo "${BUILD_PACKAGES[@]}" "${tests[@]}" python3=python3 ;;
    browser) echo "${BUILD_PACKAGES[@]}" "${PAGE_PACKAGES[@]}" "${tests[@]}" chromium stunnel4=stunnel openssl=openssl python3-numpy ;;
    run) echo "${BUILD_PACKAGES[@]}" ;;
    size) echo "${BUILD_PACKAGES[@]}" "${clang[@]}" llvm-22 python3=python3 ;;
    ladder) echo "${BUILD_PACKAGES[@]}" python3=python3 git=git ;;
    canaries) echo "${clang[@]}" ;;
    proof) echo clang-22 g++ gappa mmdebstrap python3=python3 ;;
    asan | bits | tsan | rtsan | fuzz | soak) echo "${BUILD_PACKAGES[@]}" "${tests[@]}" "${clang[@]}" xz-utils=xz ;;
    coverage) echo "${BUILD_PACKAGES[@]}" "${tests[@]}" "${clang[@]}" llvm-22 python3=python3 ;;
    tidy) echo "${BUILD_PACKAGES[@]}" "${tests[@]}" "${clang[@]}" clang-tidy-22 ;;
    mutations) echo "${BUILD_PACKAGES[@]}" "${tests[@]}" git=git python3=python3 ;;
    rig) echo "${BUILD_PACKAGES[@]}" "${RIG_PACKAGES[@]}" python3=python3 ;;
    truth) echo "${BUILD_PACKAGES[@]}" "${TOOL_PACKAGES[@]}" calculix-ccx ;;
    packages) echo "${BUILD_PACKAGES[@]}" "${TOOL_PACKAGES[@]}" "${PAGE_PACKAGES[@]}" "${DEB_PACKAGES[@]}" ;;
    installed) packages_of packages; echo mmdebstrap ;;
    ecosystem) echo "${BUILD_PACKAGES[@]}" "${tests[@]}" "${ECOSYSTEM_PACKAGES[@]}" python3=python3 ;;
    image) packages_of packages; echo "${IMAGE_PACKAGES[@]}" "${IMAGE_TEST_PACKAGES[@]}" python3=python3 ;;
    fresh) echo debootstrap ;;
  esac
}
