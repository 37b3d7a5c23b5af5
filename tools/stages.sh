# SPDX-License-Identifier: Apache-2.0
# stages.sh - sourced by check: runs its stages, tells of each in a line, and counts.
#
# A stage is a shell function of that name; what it prints goes to $logs/NAME.log. The caller has $logs, a folder.

# skipped_in LOG: names of the tests that ctest or a test program has skipped, one a line
skipped_in() {
  sed -nE -e 's/^[[:space:]]+[0-9]+ - (.*) \(Skipped\)$/\1/p' \
    -e 's/^\[  SKIPPED \] ([[:alnum:]_/]+\.[[:alnum:]_/]+)$/\1/p' "$1"
}

# tell_stage NAME STATUS SECONDS: one line a stage; ctest stages count their tests, others count as one.
tell_stage() {
  local name=$1 status=$2 seconds=$3 log="$logs/$1.log" good bad skipped
  # "100% tests passed, 0 tests failed out of 123"
  read -r bad good < <(sed -n 's/.* \([0-9]*\) tests failed out of \([0-9]*\).*/\1 \2/p' "$log" |
    awk '{print $1, $2 - $1}')
  skipped=$(skipped_in "$log" | sort -u)
  if [ -z "${good:-}" ]; then good=1 bad=0; elif [ -n "$skipped" ]; then good=$((good - $(wc -l <<<"$skipped"))); fi
  if [ "$status" -ne 0 ] && [ "$bad" -eq 0 ]; then bad=1 good=$((good - 1)); fi
  echo "$name $good $bad" >>"$counts"
  printf '%-10s %4d passed, %d failed  (%d s)%s\n' "$name" "$good" "$bad" "$seconds" \
    "${skipped:+  ($(wc -l <<<"$skipped") skipped)}"
  # shellcheck disable=SC2086  # a list of names
  [ -n "$skipped" ] && printf '           skipped: %s\n' $skipped
  [ "$status" -eq 0 ] && return
  echo "---- the end of build/logs/$name.log"
  grep -A3 -E 'FAILED|error:|warning:|\*\*\*Failed|Failure$' "$log" | head -n 40  # and why
  tail -n 25 "$log"
  echo "----"
}

# run_stage NAME: its function, its output to its log; then one line
run_stage() {
  local start=$SECONDS status told
  [ -t 1 ] && [ -z "${is_beside:-}" ] && printf '%s ...\r' "$1"
  (set -e; "$1") >"$logs/$1.log" 2>&1 &
  wait $!  # ends when the trap is called, too
  status=$?
  told=$(tell_stage "$1" $status $((SECONDS - start)))
  [ -t 1 ] && printf '\033[K'
  printf '%s\n' "$told"  # in one piece: a stage beside it may print now
}

# run_beside NAME...: these stages one after the other, with the CPU time that others leave. Returns at once; the
# caller must wait.
run_beside() {
  local name is_beside=yes
  {
    trap 'kill $(jobs -p) 2>/dev/null; exit 143' TERM
    chrt --idle --pid 0 "$BASHPID"
    for name in "$@"; do run_stage "$name"; done
  } &
}

begin_counts() { counts=$(mktemp) && trap 'rm -f "$counts"' EXIT; }
# tell_counts NAME...: the sum; fails if a test failed, or if one of these stages told nothing
tell_counts() {
  local name
  for name in "$@"; do
    grep -q "^$name " "$counts" || { echo "$name did not end: it counts as failed"; echo "$name 0 1" >>"$counts"; }
  done
  awk '{good += $2; bad += $3} END {print good + 0 " passed, " bad + 0 " failed"; exit bad > 0}' "$counts"
}
