// SPDX-License-Identifier: Apache-2.0
// requests.pml - the request handler (firmware/console/request_handler.cc) as Spin sees it, beside a loop.
//
// A person asks at any moment, and what was asked waits until the handler takes it. The loop changes
// its state at any moment, so what the handler was shown may be over. A request is `news` when it was
// made after the words "ready, force is off" of this time of being ready.
//
// Properties, each an assertion by its number:
//   1 an edge of arm rises only for a request from after the words
//   2 there are no more edges of arm than requests
//   3 an edge of reset rises only when a stop is what was shown last
//
// Wrong handlers: UNREAD does a request that came with the words (breaks 1), KEEPS does not forget
// what waits while the words are shown (1), LEVEL asks the loop again and again (2), BLIND resets
// in any state (3).

#define OFF 0
#define READY 1
#define ARMED 2
#define STOPPED 3

byte loop_state = OFF;   // the truth
byte shown = OFF;        // what the handler was shown last
bool ready_shown = false;  // the words are shown
bit asks_arm = 0;        // a request that waits
bit arm_is_news = 0;     // made after the words
bit asks_reset = 0;
byte arms = 0, asked = 0;  // edges and requests, as far as 3
bool armed_once = false;

inline check(number, holds) {
  if
  :: holds
  :: else -> assert(number == 0)
  fi
}

active proctype Person() {
  do
  :: atomic { asked < 3 && !asks_arm ->
       asks_arm = 1; arm_is_news = ready_shown; asked++ }
  :: atomic { !asks_reset -> asks_reset = 1 }
  od
}

active proctype Loop() {
  do
  :: loop_state == OFF -> loop_state = READY
  :: loop_state == READY -> loop_state = STOPPED
  :: loop_state == ARMED -> loop_state = STOPPED
  :: loop_state == STOPPED -> loop_state = OFF
  od
}

inline edge_of_arm(is_news) {
  check(1, is_news);
  arms++;
  check(2, arms <= asked);
  if
  :: loop_state == READY -> loop_state = ARMED; armed_once = true
  :: else
  fi
}

active proctype Handler() {
  bit takes_arm, takes_reset, takes_news, just_shown;
  do
  :: atomic {  // wait() and next(): what is there is taken
       takes_arm = asks_arm; takes_news = arm_is_news; takes_reset = asks_reset;
       asks_arm = 0; asks_reset = 0
     };
     just_shown = 0;
     atomic {  // show(): the newest frame, which may be any moment's
       shown = loop_state;
       if
       :: shown != READY -> ready_shown = false
       :: shown == READY && !ready_shown -> ready_shown = true; just_shown = 1
       :: else
       fi
     };
#ifndef KEEPS
     atomic {
       if
       :: just_shown && asks_arm && !arm_is_news -> asks_arm = 0
       :: else
       fi
     };
#endif
     atomic {
       if
#ifdef BLIND
       :: takes_reset ->
#else
       :: takes_reset && shown == STOPPED ->
#endif
          check(3, shown == STOPPED);
          if
          :: loop_state == STOPPED -> loop_state = READY
          :: else
          fi
       :: else
       fi
     };
     atomic {
       if
#ifdef UNREAD
       :: takes_arm && ready_shown && shown == READY ->
#else
       :: takes_arm && ready_shown && shown == READY && !just_shown ->
#endif
          edge_of_arm(takes_news)
#ifdef LEVEL
          ; edge_of_arm(takes_news)
#endif
       :: else  // refused, and forgotten
       fi;
#ifdef WITNESS
       assert(!armed_once)
#else
       skip
#endif
     }
  od
}
