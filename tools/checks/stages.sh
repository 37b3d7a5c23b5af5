# SPDX-License-Identifier: Apache-2.0
# stages.sh - sourced by check: runs its stages, reports each in a line, and counts.
#
# A stage is a shell function of that name; what it prints goes to $logs/NAME.log. The caller has $logs, a folder.

# skipped_in LOG: names of the tests that ctest or a test program has skipped, one a line
skipped_in() {
  sed -nE -e 's/^[[:space:]]+[0-9]+ - (.*) \(Skipped\)$/\1/p' \
    -e 's/^\[  SKIPPED \] ([[:alnum:]_/]+\.[[:alnum:]_/]+)$/\1/p' "$1"
}

# once_more NAME COMMAND...: a test that waits for a real clock has failed. Does it pass while no other stage runs? Then
# it is flaky. Not with --long.
once_more() {
  local name=$1
  shift
  [ "${long:-no}" = no ] || return 1
  echo "---- again, alone: $name"
  alone "$@" 2>&1 | sed 's/ tests failed out of / failed of /'  # is counted once
  [ "${PIPESTATUS[0]}" -eq 0 ] && echo "flaky: $name"
}

# ctest_twice DIR OPTIONS...: each test has one try; those that wait for a real clock (labelled +clock) have a second
# one, alone, if nothing else has failed.
ctest_twice() {
  local failed clocks name
  rm -f "$1/Testing/Temporary/LastTestsFailed.log"
  ctest --test-dir "$1" --output-on-failure --no-tests=error "${@:2}" && return
  [ -e "$1/Testing/Temporary/LastTestsFailed.log" ] || return 1  # no test has run
  mapfile -t failed < <(sed 's/^[0-9]*://' "$1/Testing/Temporary/LastTestsFailed.log")
  clocks=$(ctest --test-dir "$1" -N -L '[+]clock' | sed -nE 's/^ +Test +#[0-9]+: (.*)/\1/p')
  for name in "${failed[@]}"; do
    grep -qxF -- "$name" <<<"$clocks" || return 1
  done
  for name in "${failed[@]}"; do
    once_more "$name" ctest --test-dir "$1" --output-on-failure --no-tests=error --timeout 300 \
      -R "^$(tr -c '[:alnum:]\n' . <<<"$name")\$" || return 1
  done
}

# ctest_beside_load DIR OPTIONS...: one try, and four processes take the cores meanwhile
ctest_beside_load() {
  local status
  stress-ng --cpu 4 --quiet --timeout 8h &
  ctest --test-dir "$1" --output-on-failure --no-tests=error -j 4 "${@:2}" && status=0 || status=$?
  kill %% 2>/dev/null
  return $status
}

# report_stage NAME STATUS SECONDS: one line a stage; ctest stages count their tests, others count as one.
report_stage() {
  local name=$1 status=$2 seconds=$3 log="$logs/$1.log" good bad skipped flaky
  # "100% tests passed, 0 tests failed out of 123"
  read -r bad good < <(sed -n 's/.* \([0-9]*\) tests failed out of \([0-9]*\).*/\1 \2/p' "$log" |
    awk '{print $1, $2 - $1}')
  skipped=$(skipped_in "$log" | sort -u)
  flaky=$(sed -n 's/^flaky: //p' "$log")
  if [ -z "${good:-}" ]; then good=1 bad=0; elif [ -n "$skipped" ]; then good=$((good - $(wc -l <<<"$skipped"))); fi
  if [ "$status" -ne 0 ] && [ "$bad" -eq 0 ]; then bad=1 good=$((good - 1)); fi
  if [ "$status" -eq 0 ]; then good=$((good + bad)) bad=0; fi  # the flaky ones
  echo "$name $good $bad" >>"$counts"
  printf '%-10s %4d passed, %d failed  (%d s, %d s of CPU)%s\n' "$name" "$good" "$bad" "$seconds" \
    "$(cpu_seconds "$logs/$name.times")" "${skipped:+  ($(wc -l <<<"$skipped") skipped)}"
  # shellcheck disable=SC2086  # a list of names
  [ -n "$skipped" ] && printf '           skipped: %s\n' $skipped
  # One a line, without the value of a parameter behind it.
  if [ -n "$flaky" ]; then
    sed 's/ *#.*//; s/^/flaky: /' <<<"$flaky" | tee -a "$counts.flaky" | sed 's/^/           /'
    grep -vE '^ok ' "$log" | grep -A4 -E 'Failure$|^FAILED |^(FAIL|ERROR): |Error: ' | head -n 12 | sed 's/^/           first try: /'
  fi
  [ "$status" -eq 0 ] && return
  echo "---- the end of build/logs/$name.log"
  grep -A3 -E 'FAILED|error:|warning:|\*\*\*Failed|Failure$' "$log" | head -n 40  # and why
  tail -n 25 "$log"
  echo "----"
}

# cpu_seconds FILE: of what `times` has written there, for a shell and what it waited for
cpu_seconds() { tr ' ' '\n' <"$1" | awk -F '[ms]' '{sum += 60 * $1 + $2} END {printf "%d", sum}'; }

# run_stage NAME: its function, its output to its log; then one line. ${ended[NAME]} is its status.
declare -A ended
run_stage() {
  local start=$SECONDS status report
  [ -t 1 ] && [ -z "${is_beside:-}" ] && printf '%s ...\r' "$1"
  # shellcheck disable=SC2064  # that name, wherever the stage ends
  (set -e; trap "times >'$logs/$1.times'; flock --unlock 9" EXIT; one_of_many; "$1") >"$logs/$1.log" 2>&1 9>"$logs/alone.lock" &
  wait $!  # ends when the trap is called, too
  status=$?
  ended[$1]=$status
  report=$(report_stage "$1" $status $((SECONDS - start)))
  [ -t 1 ] && printf '\033[K'
  printf '%s\n' "$report"  # in one piece: a stage beside it may print now
}

# after_build COMMAND...: what a stage builds where the stage build has not run; where that has failed, it fails
after_build() {
  case ${ended[build]:-} in
    '') "$@" ;;
    0) ;;
    *) echo "the stage build has failed"; return 1 ;;
  esac
}

# Stages that run at the same time share a lock, but for those that take the CPU time that others leave. Who has it
# alone waits until the others have ended, or wait, too.
one_of_many() { [ "${is_beside:-}" = idle ] || flock --shared 9; }
alone() {
  local status=0
  flock --unlock 9 && flock --exclusive 9
  "$@" || status=$?
  one_of_many
  return $status
}

# run_beside [--idle] NAME...: these stages one after the other, --idle with the CPU time that others leave. Returns at
# once; the caller must wait for $!.
run_beside() {
  local name is_beside=yes
  [ "$1" != --idle ] || { is_beside=idle; shift; }
  {
    [ $is_beside = yes ] || chrt --idle --pid 0 "$BASHPID"
    for name in "$@"; do run_stage "$name"; done
  } &
}

# run_with STAGE NAME...: a stage, and at the same time these one after the other; ends when all have
run_with() {
  local others
  run_beside "${@:2}"
  others=$!
  run_stage "$1"
  wait $others
}

# descendants PID: the processes that it has started, and those that these have, one a line
descendants() {
  local child
  for child in $(cat /proc/"$1"/task/*/children 2>/dev/null); do
    echo "$child"
    descendants "$child"
  done
}

begin_counts() { counts=$(mktemp) && touch "$counts.flaky" && trap 'rm -f "$counts" "$counts.flaky"' EXIT; }
# report_counts NAME...: what was flaky, and the sum; fails if a test failed, or if one of these stages has no result
report_counts() {
  local name
  for name in "$@"; do
    grep -q "^$name " "$counts" || { echo "$name did not end: it counts as failed"; echo "$name 0 1" >>"$counts"; }
  done
  cat "$counts.flaky"
  awk '{good += $2; bad += $3} END {print good + 0 " passed, " bad + 0 " failed"; exit bad > 0}' "$counts"
}
