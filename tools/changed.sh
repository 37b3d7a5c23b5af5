# SPDX-License-Identifier: Apache-2.0
# changed.sh - sourced by check: what a stage need not try again, as nothing has changed since it passed here.
#
# A stage that passes leaves $build/passed.STAGE, of the time at which it began. A file that is newer has changed.
# The caller has $root, $build and a function `tracked`: git in $root.

# begin_stage STAGE; then pass_stage STAGE, where it has passed
begin_stage() { touch "$build/began.$1"; }
pass_stage() { mv "$build/began.$1" "$build/passed.$1"; }

# any_newer STAGE FILE...: files or folders; yes, too, where the stage has not passed yet
any_newer() {
  local passed="$build/passed.$1"
  [ -e "$passed" ] || return 0
  [ -n "$(find "${@:2}" -newer "$passed" -type f -print -quit 2>/dev/null)" ]
}

# What this build links, as ninja calls it; a program of other options that lies about is none of it.
built_programs() {
  ninja -C "$build" -t targets all | sed -nE 's/: CXX_(EXECUTABLE|MODULE_LIBRARY|SHARED_LIBRARY)_LINKER__.*//p' |
    grep -v '\.cmake$'
}

# objects_of PROGRAM...: what they are linked from, but for the revision, which is another after each commit
objects_of() {
  ninja -C "$build" -t inputs "$@" | grep '\.o$' | grep -v '/revision\.cc\.o$' | sed "s|^|$build/|"
}

# program_newer STAGE PROGRAM...: yes, too, where nobody knows
program_newer() {
  local objects
  mapfile -t objects < <(objects_of "${@:2}")
  [ ${#objects[@]} -eq 0 ] || any_newer "$1" "${objects[@]}"
}

# changed_tests: what ctest -L takes for the rooms whose test program has changed, or a program that it runs;
# and, if any program has changed, for the tests that are scripts. "." for all, nothing for none.
changed_tests() {
  local data=() runs=() others=() changed_rooms=() labels=() program
  # Any test may read any file but these: sources, as their programs are newer then; what other stages try;
  # and texts that no test reads (tests/house/changed_test.py looks).
  mapfile -d '' -t data < <(tracked ls-files -z -co --exclude-standard |
    grep -zvE '\.(cc|h)$|(^|/)(README|CHANGELOG|CONTRIBUTING|decisions)\.md$|^host/web/|^tests/(rig|browser|mutations|house)/' |
    sed -z "s|^|$root/|")
  any_newer tests "${data[@]}" && { echo .; return; }
  for program in $(built_programs); do
    case $program in
      tests/*_test)
        read -ra runs <"$build/$program.programs"
        program_newer tests "$program" "${runs[@]}" && changed_rooms+=("$(basename "${program%_test}")") ;;
      *) others+=("$program") ;;
    esac
  done
  # ctest takes few parentheses.
  [ ${#changed_rooms[@]} -eq 0 ] || labels+=("^($(IFS='|'; echo "${changed_rooms[*]}"))([+]|\$)")
  program_newer tests "${others[@]}" && labels+=('[+]programs')
  (IFS='|'; echo "${labels[*]}")
}
