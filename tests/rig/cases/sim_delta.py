# SPDX-License-Identifier: Apache-2.0
"""The simulated delta: tactd itself on a PREEMPT_RT kernel, without a bus."""
from bench import checks, gate_paths, wake_up
from bench.back_ends import GATE, LAWS, SIM_DELTA, TWIST
from bench.case import Case

SOUND = (checks.hard_real_time, checks.no_fault, checks.no_late_tick, checks.whole_run, checks.touched)

CASES = [
    Case("liver", "tactd keeps hard real time, wakes like cyclictest, and two runs are the same bits",
         SIM_DELTA, "control $SECONDS_OF_RUN\nfinish\nmeasure_peer 10",
         (*SOUND, checks.same_forces), seeds=(1, 1), timed=True),
    Case("liver-load", "with bursts of other work on its core, too, tactd wakes like cyclictest",
         SIM_DELTA, "noise $SEED\ncontrol $SECONDS_OF_RUN\nfinish\nnoise $SEED\nmeasure_peer 6",
         (*SOUND, checks.same_forces, wake_up.like_peer_too), seeds=(1, 2), seconds=6),
    Case("liver-sweep", "no interleaving with other work changes a force or makes a tick late",
         SIM_DELTA, "noise $SEED\ncontrol $SECONDS_OF_RUN\nfinish",
         (*SOUND, checks.same_forces), sweep=True, seconds=6),
    *(Case(f"law-{back_end.name.partition(', spring')[0].replace(', law=', '-')}",
           "every law keeps hard real time, and its longest path is known",
           back_end, "control $SECONDS_OF_RUN\nfinish\nmeasure_peer 3", (*SOUND, checks.same_forces), timed=True)
      for back_end in LAWS),
    Case("liver-threads", "the loop asks the kernel for nothing but sleep",
         SIM_DELTA,
         "control $SECONDS_OF_RUN\ntrace_threads $tactd 1.5 >$RESULTS/threads.txt\nfinish",
         (*SOUND, checks.threads_as_listed), seconds=5),
    Case("liver-twist", "a torque that the tissue drives to its limit stays there",
         TWIST, "control $SECONDS_OF_RUN\nfinish", (*SOUND, checks.torque_at_its_limit, checks.same_forces), seconds=6),
    Case("gate-stages", "the path of the gate is known for each of its stages", GATE,
         "chrt -f 80 tact-rig-gate >$RESULTS/gate.json", (gate_paths.every_stage_acts,)),
]
