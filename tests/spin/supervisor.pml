/* SPDX-License-Identifier: Apache-2.0 */
/* The supervisor and the gate's part in it, tick by tick, with every input free in every tick.
 *
 * The transitions are those of RULES (supervisor_rules.inc). The gate is what gate.cc makes of an
 * armed controller: a share of the force that missed samples fade in FADE ticks, from the second
 * on, and a latched fault after LOST. What the law wants is free, so `force` says that a force may
 * be written, not that there is one.
 *
 * Spin visits every state. The properties are in check().
 * With WITNESS defined it must instead find a run that does what the number says.
 */
/* As gate.cc has them: tests/firmware/loop/supervisor_test.cc holds the gate against both. */
#define FADE 10 /* ticks: 10 ms at 1 kHz */
#define LOST 20

mtype = { OFF, READY, ARMED, STOPPED };
mtype = { KEEP, FIRST, POWER_LOST, CLEAR };

mtype state = OFF;
mtype before;            /* the state of the tick before */
bool latched;            /* a fault is kept */
bool arm, stop, reset, disarm, sample_good, ready, fault_found, gate_fault;
bool arm_before, arm_edge, reset_before, reset_edge, disarm_before, disarm_edge;
byte missed, level = FADE;
bool force;
bool released = true;    /* arm was let go since the last stop, or nothing was stopped yet */
byte history;            /* for the witnesses: 1 armed, 2 then a fault, 3 then reset, 4 then armed */

#define ANY state

#define RULE(from, to, latch, when) \
  if \
  :: !done && state == (from) && (when) -> \
     next = to; effect = latch; done = true \
  :: else \
  fi;

inline draw(input) {
  if
  :: input = false
  :: input = true
  fi
}

inline supervise() {
  d_step {
    arm_edge = arm && !arm_before;
    arm_before = arm;
    reset_edge = reset && !reset_before;
    reset_before = reset;
    disarm_edge = disarm && !disarm_before;
    disarm_before = disarm;
    done = false;
    next = state;
    effect = KEEP;
#include RULES
    state = next;
    if
    :: effect == FIRST || effect == POWER_LOST -> latched = true
    :: effect == CLEAR -> latched = false
    :: else
    fi
  }
}

/* A missed sample is held, the second begins the fade; not armed, the device may take its time. */
inline limit() {
  d_step {
    if
    :: sample_good || state != ARMED -> missed = 0
    :: else -> missed++
    fi;
#ifdef HOLDS_FOR_EVER
    if
    :: true
#else
    if
    :: missed >= 2 && level > 0 -> level--
    :: missed < 2 && level < FADE -> level++
#endif
    :: else
    fi;
    force = state == ARMED && level > 0;
    if
#ifdef NEVER_LOSES_ITS_DEVICE
    :: state == ARMED && gate_fault ->
#else
#ifdef IS_DEAF_TO_THE_GATE
    :: state == ARMED && missed >= LOST ->
#else
    :: state == ARMED && (gate_fault || missed >= LOST) ->
#endif
#endif
       latched = true;
       state = STOPPED;
#ifndef FORCE_OUTLIVES_ITS_FAULT
       force = false
#endif
    :: else
    fi
  }
}

/* The number is in the text of Spin's error, so `run` can report which property broke. */
#define MUST(number, property) assert((property) || number == 0)

inline check() {
  /* 1: no force unless armed */
  MUST(1, !force || state == ARMED);
  /* 2: any fault reaches zero force: one that latches in its own tick, missed samples with the
     eleventh, which is 10 ms after the second; twenty stop */
  MUST(2, !(force && (latched || fault_found || gate_fault)));
  MUST(2, !(force && missed > FADE));
  MUST(2, missed < LOST || state == STOPPED);
  /* 3: a stop request, a fault and lost power stop in their own tick */
  MUST(3, !(stop || fault_found) || state == STOPPED);
  MUST(3, !(before == ARMED && !ready && state == ARMED));
  /* 4: faults latch: a kept fault is a stop, with any input */
  MUST(4, !latched || state == STOPPED);
  /* 5: only a reset edge with all inputs good leaves a stop */
  MUST(5, !(before == STOPPED && state != STOPPED) ||
          (reset_edge && sample_good && !arm && !stop && !fault_found));
  /* 6: reset never arms: neither at once nor through a request that is still set */
  MUST(6, !(before == STOPPED && state == ARMED));
  MUST(6, !(before != ARMED && state == ARMED) || (arm && released && sample_good && ready));
  /* 7: a request arms in its own tick, of a state that was ready, or never */
  MUST(7, !(before != ARMED && state == ARMED) || (arm_edge && before == READY));
  /* 8: a request to disarm takes the force in its own tick, and nothing arms while it is set */
  MUST(8, !(before == ARMED && disarm_edge && state == ARMED));
  MUST(8, !(before != ARMED && state == ARMED && disarm))
}

inline remember() {
  d_step {
    if
    :: state == STOPPED -> released = !arm
    :: else -> released = released || !arm
    fi;
    if
    :: history == 0 && force -> history = 1
    :: history == 1 && latched -> history = 2
    :: history == 2 && state == READY -> history = 3
    :: history == 3 && force -> history = 4
    :: else
    fi
  }
}

active proctype tick() {
  bool done;
  mtype next, effect;
  do
  :: atomic {
       draw(arm); draw(stop); draw(reset); draw(disarm); draw(sample_good); draw(ready);
       draw(fault_found); draw(gate_fault);
       before = state;
       supervise();
       limit();
#ifdef WITNESS
       remember();
       assert(history < WITNESS)
#else
       check();
       remember();
       history = 0
#endif
     }
  od
}
