# SPDX-License-Identifier: Apache-2.0
"""The devices of the bench. One entry names what the scene says, what the guest starts before
tactd, which programs it needs, and the system calls of every FIFO thread, at most, per tick."""
import dataclasses
import json
import pathlib
import tomllib

from bench.case import BackEnd

# 100 N/m along the surface are more than a delta on CAN can show: its samples are a period old.
SLIDE = 'contact.sliding_stiffness_N_per_m=70'

# The watch above the loop wakes every fifth period.
SLEEP = {("tact-loop", "sys_clock_nanosleep"): 1, ("tact-watch", "sys_clock_nanosleep"): 0.2}
CAN_CALLS = SLEEP | {("tact-loop", "sys_recvmmsg"): 1, ("tact-loop", "sys_sendmmsg"): 1}

SIM_DELTA = BackEnd("sim-delta", settings=('device.kind="sim-delta"',), system_calls=SLEEP)


def law(scene, *settings):
    """Another law on the simulated delta, by the scene that ships it or by a setting."""
    name = ", ".join((scene, *(setting.replace('"', "") for setting in settings)))
    return BackEnd(name, settings=('device.kind="sim-delta"', *settings), system_calls=SLEEP,
                   scene=f"model/scenes/{scene}.toml")


# The 300 masses of gum take 0.64 million instructions a tick, more than half a period: 150 of them.
LAWS = (law("heart"), law("skin"), law("liver", 'law="compliance"'), law("gum", "spring_patch.nodes=150"))

# The forceps are a lever of 93 mm: 20 mN m, of which the gate lets a quarter through.
TORQUE_LIMIT_NM = 0.005
TWIST = law("liver_twist", f"limits.torque_Nm={TORQUE_LIMIT_NM}")

# No device: the gate alone.
GATE = BackEnd("gate", programs=("tact-rig-gate",))

# e-stop A and B, dead-man in; enable and heartbeat out
LINES = ('device.lines.chip="tact-lines"', "device.lines.estop_a=0", "device.lines.estop_b=1",
         "device.lines.dead_man=2", "device.lines.enable=3", "device.lines.heartbeat=4")
LINES_UP = "gpio_sim up tact-lines 8\nfor i in 0 1 2; do line[$i]=$(gpio_sim path $i); pull $i up; done"
SIM_DELTA_LINES = BackEnd("sim-delta with lines", settings=('device.kind="sim-delta"', *LINES), setup=LINES_UP,
                          programs=("tact-rig-lines",), system_calls=SLEEP | {("tact-loop", "sys_ioctl"): 2})


# A foot switch and a clutch besides, which close when their line is pulled up
SWITCHES = ('device.lines.grip=5', 'device.lines.clutch=6')
GRIP, CLUTCH = 5, 6
SWITCHES_UP = "for i in 5 6; do line[$i]=$(gpio_sim path $i); done"


# A scope line that is wired back to an input. Gum's tick lasts some ten looks of the wire while it is
# pressed, which is soon and for long.
SCOPE, BACK = 5, 6
LOOP_BACK = BackEnd("scope line wired back", scene="model/scenes/gum.toml",
                    settings=('device.kind="sim-delta"', 'device.lines.chip="tact-lines"',
                              f"device.lines.scope={SCOPE}", "spring_patch.nodes=100",
                              "hand.stroke.0.duration_s=0.2", "hand.stroke.1.duration_s=0.2",
                              "hand.stroke.2.duration_s=3"),
                    setup="gpio_sim up tact-lines 8\nstart_emulator tact-rig-lines copy "
                          f"$(gpio_sim path {SCOPE})/value $(gpio_sim path {BACK})/pull",
                    programs=("tact-rig-lines", "tact-jitter"))


def with_lines(back_end):
    """The same device beside safety lines."""
    return dataclasses.replace(back_end, name=f"{back_end.name} with lines",
                               settings=(*back_end.settings, *LINES), setup=f"{LINES_UP}\n{back_end.setup}",
                               programs=(*back_end.programs, "tact-rig-lines"))


def with_switches(back_end):
    """The same device beside safety lines, a foot switch and a clutch."""
    lines = back_end if back_end is SIM_DELTA_LINES else with_lines(back_end)
    return dataclasses.replace(lines, name=f"{back_end.name} with switches", settings=(*lines.settings, *SWITCHES),
                               setup=f"{lines.setup}\n{SWITCHES_UP}")


def drives(protocol, options=""):
    """Sets up the bus and the drives of a delta; EMULATOR holds further options of a case."""
    return f"can up\nstart_emulator tact-rig-drives --protocol {protocol} {options} $EMULATOR"


# The delta of the simulation, as the example of a scene has it.
DEVICES = pathlib.Path(__file__).resolve().parents[3] / "tools/deploy/devices.toml"
DELTA = "[device.delta]\n" + "".join(
    f"{key} = {json.dumps(value)}\n" for key, value in tomllib.loads(DEVICES.read_text())["device"]["delta"].items())
# Absolute encoders that report zero where the arms do.
DRIVES = '[device.can]\nhoming = "absolute"\nzero_turns = [0.0, 0.0, 0.0]\ndirection = [1.0, 1.0, 1.0]\n'


def on_can(name, kind, setup):
    return BackEnd(name, settings=(f'device.kind="{kind}"', SLIDE), sections=DELTA + DRIVES, setup=setup,
                   programs=("tact-rig-drives",), system_calls=CAN_CALLS)


def odrive(protocol):
    return on_can(protocol, "can-odrive", drives(protocol))


ODRIVE06, ODRIVE05 = odrive("odrive06"), odrive("odrive05")
CIA402 = on_can("cia402", "can-cia402", drives("cia402"))
# Their watchdog lets go, as hal/moteus/README.md has it set.
MOTEUS = on_can("moteus", "can-moteus", drives("moteus", "--timeout-mode 0"))


def falcon(boot="--running", setup=""):
    """The loop submits, the bus's own thread reaps and submits again."""
    return BackEnd("falcon", settings=('device.kind="falcon"', SLIDE),
                   setup=f"{setup}usb up\nstart_emulator tact-rig-falcon {boot} $EMULATOR\nusb raise",
                   programs=("tact-rig-falcon",),
                   system_calls=SLEEP | {("tact-loop", "sys_ioctl"): 1, ("tact-usb", "sys_ioctl"): 3})


FALCON = falcon()
# In its boot ROM. It takes any image of this size; the digest is that of these bytes.
FALCON_COLD = falcon(boot="--image-bytes 8492", setup=(
    "head -c 8492 /dev/zero | tr '\\0' 'T' >/tmp/firmware.bin\n"
    "DEVICE+=(--set 'device.falcon.firmware=\"/tmp/firmware.bin\"' --set "
    "\"device.falcon.firmware_sha256='$(sha256sum </tmp/firmware.bin | cut -d' ' -f1)'\")\n"))
FORCE_DIMENSION = BackEnd(
    "force-dimension",
    settings=('device.kind="force-dimension"', SLIDE,
              'device.force_dimension.library="/tact/bin/libtact-stub-dhd.so"'),
    options=("--trust-library",),
    programs=("libtact-stub-dhd.so",),
    # The library's own rate, 4 kHz, and its lock, which may be taken when the status is read, every 50 ms: wait, wake.
    system_calls=SLEEP | {("tact-fd", "sys_clock_nanosleep"): 4, ("tact-fd", "sys_futex"): 0.04})
PHANTOM = BackEnd(
    "phantom",
    settings=('device.kind="phantom"', SLIDE, 'device.phantom.library="/tact/bin/libtact-stub-hd.so"'),
    options=("--trust-library",),
    programs=("libtact-stub-hd.so",),
    # The library's own thread, once a cycle. Its lock is not shared.
    system_calls=SLEEP | {("tact-phantom", "sys_clock_nanosleep"): 1})
