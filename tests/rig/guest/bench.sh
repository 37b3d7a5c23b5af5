# SPDX-License-Identifier: Apache-2.0
# bench.sh - what the script of a case may call; sourced by it in the guest.
#
#   add_sections <<<TEXT                the scene with further sections of its file, beside what it names
#   control SECONDS [tactd option...]   starts tactd on $SCENE, back when its loop ticks; pid $tactd
#   inject COMMAND...                   notes the time, then does the harm (builtins cost no fork)
#   stand PERIODS                       stops tactd for so many periods of its grid: injected when it goes on
#   prove WORDS COMMAND...              that the harm was done, for checks.proved
#   ask arm|reset                       by tactctl, done or refused
#   pull LINE up|down                   a switch on a line of the simulated chip, without a fork
#   refused                             runs a tactd that must not start
#   finish                              waits for tactd; its report, what the tick log says of the fault
#   start_emulator PROGRAM [option...]  in the background, back when it says "ready"; pid $emulator
#   measure_peer SECONDS [PRIORITY]     cyclictest: a bare 1 kHz FIFO loop, its wake-up times in ns
#   noise SEED                          repeatable bursts of other work, SCHED_OTHER and FIFO 60
#   measure_jitter [tact-jitter option...]  with a line wired back, and what the emulator then says
#
# $SCENE, DEVICE=(tactd options) and $SEED are set by the case; results are files in $RESULTS.
SOCKET=/tmp/telemetry.sock
background=() injected=0
exec {silence}<> <(:)

# First of all: another seed, another phase of emulators and other work against the kernel's clocks and
# the loop, whose deadlines are a fixed grid of them.
shift_phase() { sleep "$(printf '.000%03d' $((SEED * 137 % 1000)))"; }
# And another part of the 100 ms between two heartbeats of a drive: with one seed of 50 the first tick reads them.
shift_heartbeats() {
  local delay
  printf -v delay '0.%03d' $(((SEED - 1) * 17 % 100))
  read -rt "$delay" -u $silence || return 0
}

add_sections() {
  local text
  text=$(cat)
  [ -n "$text" ] || return 0
  mkdir /tmp/scenes
  ln -s "${SCENE%/*}"/* /tmp/scenes/
  rm "/tmp/scenes/${SCENE##*/}"
  printf '%s\n' "$(<"$SCENE")" "$text" >"/tmp/scenes/${SCENE##*/}"
  SCENE=/tmp/scenes/${SCENE##*/}
}

control() {
  clock_offset_ns=$(tact-rig-ticks --clock-offset)
  tactd "$SCENE" "${DEVICE[@]}" --seconds "$1" --strict --arm --json $RESULTS/report.json \
    --record /tmp/ticks --socket $SOCKET "${@:2}" >$RESULTS/tactd.log 2>&1 &
  tactd=$!
  until has_loop; do
    kill -0 $tactd 2>/dev/null || return 1
    wait_10_ms
  done
}

has_loop() {
  local comm name
  for comm in /proc/$tactd/task/*/comm; do
    { read -r name <"$comm"; } 2>/dev/null && [ "$name" = tact-loop ] && return 0
  done
  return 1
}

# No process writes there, so a read waits, without a fork.
wait_10_ms() { read -rt .01 -u $silence || return 0; }

inject() {
  injected=$((${EPOCHREALTIME/./} * 1000 + clock_offset_ns))
  "$@"
}

# stand PERIODS: so many skipped periods and the late tick before them. Stopped and continued in the
# same part of a period, behind its tick; nothing is forked in between. The thread of tactd that is
# sent the signal stops the others, so it gets the CPU.
stand() {
  local grid_us=$((($(tact-rig-ticks /tmp/ticks --grid) - clock_offset_ns) / 1000)) end_us
  until ((((${EPOCHREALTIME/./} - grid_us) % 1000) / 50 == 7)); do :; done
  end_us=$((${EPOCHREALTIME/./} + 1000 * ($1 + 1)))
  kill -STOP $tactd
  read -rt .002 -u $silence
  while ((${EPOCHREALTIME/./} < end_us)); do :; done
  inject kill -CONT $tactd
}

# prove WORDS COMMAND...: the words, if the command succeeds; checks.proved asks for them.
prove() { "${@:2}" && echo "$1" >>$RESULTS/proofs.txt; }

# tactd must not even start: its sentence and its exit status are the result.
refused() {
  timeout 60 tactd "$SCENE" "${DEVICE[@]}" --seconds 1 --strict --socket $SOCKET \
    >$RESULTS/tactd.log 2>&1
  echo $? >$RESULTS/tactd.status
  [ ${#background[@]} -eq 0 ] || kill "${background[@]}" 2>/dev/null
}

ask() { tactctl "$SCENE" --pid $tactd "$1" >>$RESULTS/asked.txt 2>&1 || :; }

pull() { echo "pull-$2" >"${line[$1]}/pull"; }

finish() {
  wait $tactd
  echo $? >$RESULTS/tactd.status
  [ ${#background[@]} -eq 0 ] || kill "${background[@]}" 2>/dev/null
  wait
  [ $injected != 0 ] || injection_of_emulator
  tact-rig-ticks /tmp/ticks --at $injected >$RESULTS/ticks.json
  sha256sum /tmp/ticks >$RESULTS/ticks.sha256
}

# The time of a fault that the emulator committed by itself.
injection_of_emulator() {
  local report=$(<$RESULTS/emulator.json)
  [[ $report =~ \"injected_ns\":([0-9]+) ]] && injected=${BASH_REMATCH[1]}
  return 0
}

start_emulator() {
  "$@" >$RESULTS/emulator.json 2>$RESULTS/emulator.log &
  emulator=$!
  background+=($emulator)
  until is_ready; do
    kill -0 $emulator 2>/dev/null || return 1
    wait_10_ms
  done
  shift_heartbeats
}

is_ready() {
  local said=
  { read -rd '' said <$RESULTS/emulator.log; } 2>/dev/null
  [[ $said == *ready* ]]
}

measure_jitter() {
  tact-jitter "$SCENE" "${DEVICE[@]}" --duration "$SECONDS_OF_RUN" --json $RESULTS/jitter.json "$@" \
    >$RESULTS/jitter.log 2>&1 &
  local measuring=$! edges
  # The thread of the line's interrupt: below the loop of the only core, two edges of a tick were one.
  until edges=$(pgrep 'irq/.*tact-jit'); do kill -0 $measuring || break; sleep .01; done
  [ -z "$edges" ] || chrt -f -p 95 $edges
  wait $measuring
  echo $? >$RESULTS/jitter.status
  [ ${#background[@]} -eq 0 ] || kill "${background[@]}" 2>/dev/null
  wait
}

noise() {
  burst_of_work "$1" 300 80 &
  background+=($!)
  burst_of_work $(($1 + 1000)) 60 80 &
  background+=($!)
  chrt -f -p 60 $!
}

# burst_of_work SEED TURNS PAUSE_MS: forever, a burst of up to TURNS, a pause of up to PAUSE_MS.
burst_of_work() {
  local turns
  RANDOM=$1
  while :; do
    turns=$((RANDOM % $2))
    while ((turns-- > 0)); do :; done
    sleep .0$((RANDOM % $3 + 10))
  done
}

# measure_peer SECONDS [PRIORITY]: wake-up times of a bare 1 kHz FIFO loop, ns: what tactd is held
# against, and what shows whether it disturbs others.
measure_peer() {
  cyclictest -m -q -N -p "${2:-80}" -i 1000 -D "$1" -h 20000 >/tmp/peer
  grep -E '^(# [MTH]|[0-9]+ 0*[1-9])' /tmp/peer >$RESULTS/peer.txt
}
