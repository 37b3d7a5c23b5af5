// faults.ts - the words of model/fault.cc by number, and those of the states. A test of the
// repository demands that they agree.

export interface Fault {
  name: string;
  cause: string;
  cure: string;
}

export const kFaults: Readonly<Record<number, Fault>> = {
  0: { name: "none", cause: "nothing limits the force", cure: "nothing to do" },
  1: {
    name: "sample held",
    cause: "the device gave no new sample this tick",
    cure: "harmless when rare; if it repeats, check cable, hub and bus load",
  },
  2: {
    name: "sample stale",
    cause: "two or more samples in a row are missing; the force fades to zero",
    cure: "check cable, hub and bus load",
  },
  3: {
    name: "not armed",
    cause: "the controller is not armed, the force is zero",
    cure:
      "a simulated device arms by itself once its samples are good; hold a real one, then pkill -USR2 tactd",
  },
  4: {
    name: "outside workspace",
    cause: "the tool left the permitted workspace, the force fades to zero",
    cure: "bring the tool back, or widen limits.workspace_* in the scene",
  },
  5: {
    name: "force limited",
    cause: "the wanted force is above limits.force_N",
    cure: "press less, or soften the law in the scene",
  },
  6: {
    name: "torque limited",
    cause: "the wanted torque is above limits.torque_Nm",
    cure: "shorten the tool's lever arm",
  },
  7: {
    name: "slew limited",
    cause: "the force changes faster than limits.slew_N_per_s",
    cure: "harmless at a tear or a release; if it stays, soften the law",
  },
  8: {
    name: "ramping up",
    cause: "the force is being faded in after arming",
    cure: "wait for limits.ramp_s",
  },
  9: {
    name: "law saturated",
    cause: "the tissue is pressed or pulled beyond the law's working range",
    cure: "press less, or give the law more range in the scene",
  },
  10: {
    name: "too fast",
    cause: "the tool is faster than limits.speed_mps or turn_radps, the force fades to zero",
    cure: "move slower, or raise the limit in the scene",
  },
  11: {
    name: "energy limited",
    cause: "the device has given its energy budget to the hand; the force is damped",
    cure: "soften the law, raise rate_Hz or take a device with more damping; a larger limits.energy_J lets it shake more",
  },
  12: {
    name: "continuous limited",
    cause: "the RMS of the force nears limits.continuous_force_N",
    cure: "press less or rest; the motors bear their peak for a while only",
  },
  13: {
    name: "power limited",
    cause: "force times speed of the tool nears limits.power_W",
    cure: "let the tool go back slower, or soften the law",
  },
  100: {
    name: "internal",
    cause: "a value that cannot occur occurred",
    cure: "report it with the recording; do not use the device until it is explained",
  },
  101: {
    name: "force not finite",
    cause: "the model produced NaN or infinity",
    cure: "report it with the recording; check the scene's parameters",
  },
  102: {
    name: "sample not finite",
    cause: "the device reported NaN or infinity",
    cure: "restart the device; if it repeats, its encoders or driver are broken",
  },
  103: {
    name: "device lost",
    cause: "20 samples in a row are missing",
    cure: "check power and cable, then start tactd again",
  },
  104: {
    name: "device failed",
    cause: "the device reported an error",
    cure: "check power, cable and driver of the device, then start tactd again",
  },
  105: {
    name: "loop late",
    cause:
      "the loop missed its deadlines: 20 periods at once or 20 ticks in a row, 100 in a row without hard real time",
    cure: "choose a smaller law (tact-plan names one) or a lower rate_Hz, and free the loop's core of other work, then start tactd again",
  },
  106: {
    name: "law broke",
    cause: "the tissue's law blew up and gives no force that can be trusted",
    cure: "make its step shorter or its springs softer (spring_patch.substeps, integrator), then start tactd again",
  },
  107: {
    name: "emergency stop",
    cause: "a channel of the e-stop is open",
    cure: "make sure that nobody is in danger, release the e-stop, then reset and arm",
  },
  108: {
    name: "lines differ",
    cause: "the two channels of the e-stop disagreed for more than 50 ms",
    cure: "a wire, contact or input is broken: mend it before anybody holds the device",
  },
  109: {
    name: "lines lost",
    cause: "the GPIO chip of the safety lines does not answer",
    cure: "check the chip and its driver (gpiodetect), then start tactd again",
  },
  110: {
    name: "dead man released",
    cause: "the dead-man switch is open",
    cure: "hold it, then reset and arm",
  },
  111: {
    name: "bus down",
    cause: "the CAN interface went down or takes no frames",
    cure: "bring it up (ip link set can0 up type can bitrate 1000000), check cable and termination, then start tactd again",
  },
  112: {
    name: "bus off",
    cause: "the CAN controller is error passive, or has left the bus",
    cure: "check bit rate, termination and cable; ip link set can0 down, then up; then start tactd again",
  },
  113: {
    name: "drive fault",
    cause: "a drive reported an error",
    cure: "the sentence beside it says which and why; mend the cause, then start tactd again",
  },
  114: {
    name: "drive silent",
    cause: "a drive's heartbeat is missing",
    cure: "check its supply and its cable, then start tactd again",
  },
  115: {
    name: "device unplugged",
    cause: "the USB device is gone",
    cure: "plug it in again, then start tactd again",
  },
  116: {
    name: "device garbled",
    cause: "what the device sends cannot be understood, or repeats old samples",
    cure: "check cable and hub and keep other traffic off its bus, then start tactd again",
  },
  117: {
    name: "homing lost",
    cause: "the device no longer knows where it is",
    cure: "start tactd again and home it",
  },
  118: {
    name: "force off",
    cause: "the device itself switched its forces off",
    cure: "the sentence beside it says why; mend the cause, then start tactd again",
  },
  119: {
    name: "power lost",
    cause:
      "the motors lost their power while armed: the enable line fell, as after a pause of the heartbeat, or the device switched them off",
    cure: "find out why (late ticks, enable line, supply), then reset and arm",
  },
  120: {
    name: "loop stalled",
    cause: "no tick for 20 periods, 250 ms without hard real time: the loop hangs, or has lost its core",
    cure: "free the loop's core of other work, then start tactd again; if it repeats, report it with the black box",
  },
  121: {
    name: "device stalled",
    cause: "a call to the device did not come back for 20 periods, 250 ms without hard real time",
    cure: "check power, cable and driver of the device (dmesg), then start tactd again",
  },
  122: {
    name: "loop ran away",
    cause: "a real-time thread kept its core for 50 ms without sleeping",
    cure: "report it with the black box, then start tactd again",
  },
  123: {
    name: "forbidden call",
    cause: "the loop made a system call that its device does not list",
    cure: "report it with the black box; --no-seccomp runs without this check",
  },
  130: {
    name: "energy overdrawn",
    cause:
      "the device gave more energy to the hand than limits.energy_J: the tool jumped, or the loop paused, under force",
    cure: "check for lost samples and late ticks, then reset and arm",
  },
  131: {
    name: "power exceeded",
    cause: "the tool sped up so fast under force that its power passed limits.power_W",
    cure: "hold the tool firmly, then reset and arm; raise limits.power_W if hands move so fast",
  },
};

/** Words for a number; one that this page does not know says so. */
export function describe(number: number): Fault {
  return (
    kFaults[number] ?? {
      name: `fault ${number}`,
      cause: "this page does not know this number",
      cure: "run tactd --faults, and use tactd and tact-view of one build",
    }
  );
}

export const kStates: readonly { name: string; words: string }[] = [
  { name: "off", words: "no force" },
  { name: "ready", words: "no force until armed" },
  { name: "armed", words: "force is on" },
  { name: "stopped", words: "force is off after a fault" },
];
