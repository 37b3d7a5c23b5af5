# SPDX-License-Identifier: Apache-2.0
# changed.sh - sourced by check: what a stage need not try again, as nothing has changed since it passed here.
#
# A stage that passes leaves $build/passed.STAGE, of the time at which it began: a file that is newer has changed. It
# may hold the digest of each program: one of another digest has changed, regardless of the dates of its objects.
# The caller has $root, $build, $again (yes where something may be left out) and a function `tracked`: git in $root.

# shellcheck disable=SC2034  # for check
unchanged="nothing has changed since it passed"

# begin_stage STAGE [DIGESTS]; then pass_stage STAGE, where it has passed. What changes meanwhile is newer.
begin_stage() { printf '%s\n' "${2:-}" >"$build/began.$1"; }
pass_stage() { mv "$build/began.$1" "$build/passed.$1"; }

# any_newer STAGE FILE...: files or folders; yes, too, where the stage has not passed yet
any_newer() {
  local passed="$build/passed.$1"
  [ -e "$passed" ] || return 0
  [ -n "$(find "${@:2}" -newer "$passed" -type f -print -quit 2>/dev/null)" ]
}

# newer_of STAGE FILE...: those of these files that a stage must try, one a line: all, where nothing may be left out
newer_of() {
  local passed="$build/passed.$1"
  [ $# -gt 1 ] || return 0
  if [ "$again" = yes ] && [ -e "$passed" ]; then
    find "${@:2}" -newer "$passed" -type f
  else
    printf '%s\n' "${@:2}"
  fi
}

# What this build links, as ninja calls it; a program of other options that lies about is none of it.
built_programs() {
  [ -e "$build/build.ninja" ] || return 0
  ninja -C "$build" -t targets all | sed -nE 's/: CXX_(EXECUTABLE|MODULE_LIBRARY|SHARED_LIBRARY)_LINKER__.*//p' |
    grep -v '\.cmake$'
}

# program_digests: "digest name" a line
program_digests() { built_programs | xargs -r python3 "$root/tools/checks/program_digests.py" "$build"; }

# changed_programs STAGE: names of the programs that are not as they were when it began and then passed
changed_programs() { program_digests | grep -vxFf "$build/passed.$1" | sed 's/^[^ ]* //'; }

# program_changed STAGE PROGRAM...: yes, too, where it is unknown
program_changed() {
  [ -e "$build/passed.$1" ] || return 0
  changed_programs "$1" | grep -qxF "$(printf '%s\n' "${@:2}")"
}

# changed_tests: what ctest -L takes for the rooms whose test program has changed, or a program that it runs;
# and, if any program has changed, for the tests that are scripts. "." for all, nothing for none.
changed_tests() {
  local data=() runs=() others=no changed_rooms=() labels=() changed program
  # Any test may read any file but these: sources, as their programs are others then; what other stages try;
  # and texts that no test reads (tests/house/changed_test.py looks).
  mapfile -d '' -t data < <(tracked ls-files -z -co --exclude-standard |
    grep -zvE '\.(cc|h)$|(^|/)(README|CHANGELOG|CONTRIBUTING|decisions)\.md$|^host/web/|^tests/(rig|browser|mutations|house)/' |
    sed -z "s|^|$root/|")
  data+=("$root/host/web/src/link/records.ts")
  any_newer tests "${data[@]}" && { echo .; return; }
  changed=$(changed_programs tests)
  for program in $(built_programs); do
    case $program in
      tests/*_test)
        read -ra runs <"$build/$program.programs"
        printf '%s\n' "$program" "${runs[@]}" | grep -qxFf <(echo "$changed") &&
          changed_rooms+=("$(basename "${program%_test}")") ;;
      *) grep -qxF -- "$program" <<<"$changed" && others=yes ;;
    esac
  done
  # ctest takes few parentheses.
  [ ${#changed_rooms[@]} -eq 0 ] || labels+=("^($(IFS='|'; echo "${changed_rooms[*]}"))([+]|\$)")
  [ $others = no ] || labels+=('[+]programs')
  (IFS='|'; echo "${labels[*]}")
}
