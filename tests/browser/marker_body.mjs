// SPDX-License-Identifier: Apache-2.0
// marker_body.mjs - one marker body before one camera, as a tracker sends it by UDP: for the tests
// and measurements that move one part of the operator alone.
import { createSocket } from "node:dgram";

const kMarkers_m = [
  [0.06, 0.03, 0.02],
  [-0.05, 0.04, 0.03],
  [0.02, -0.06, 0.04],
  [-0.03, -0.05, -0.04],
  [0.05, 0.05, -0.03],
  [-0.06, 0.01, -0.02],
  [0.01, 0.02, 0.07],
  [0.03, -0.02, -0.06],
];
const kCamera_m = [-1.6, 0, -0.2]; // behind the device; it looks along +x at the operator
const kFocus_px = 1200;
const kNoise_px = 0.02; // without any, the tracker would be taken for a frozen one

export async function free_udp_port() {
  const socket = createSocket("udp4");
  await new Promise((done) => socket.bind(0, "127.0.0.1", done));
  const { port } = socket.address();
  await new Promise((done) => socket.close(done));
  return port;
}

/** The tracking description of this camera and one body. */
export function description(role, port) {
  const markers = kMarkers_m.map((at_m, id) => `[${[id, ...at_m].join(", ")}]`).join(", ");
  return (
    `[input]\nudp_port = ${port}\n[[camera]]\nname = "front"\nfx_px = ${kFocus_px}.0\nfy_px = ${kFocus_px}.0\n` +
    "cx_px = 960.0\ncy_px = 540.0\nposition_m = [0.0, 0.0, 0.0]\nrotation_wxyz = [1.0, 0.0, 0.0, 0.0]\n" +
    `[[body]]\nname = "b"\nrole = "${role}"\nmarkers_m = [${markers}]\n` +
    `[registration]\nposition_m = [${kCamera_m.map((m) => m.toFixed(1)).join(", ")}]\n` +
    "rotation_wxyz = [0.70710678118654752, 0.0, 0.70710678118654752, 0.0]\n"
  );
}

/** Sends the pose of the body, `rate_Hz` times a second, and at once when it goes elsewhere. */
export class MarkerBody {
  constructor(port, at_m, rate_Hz = 100) {
    this.port = port;
    this.at_m = at_m;
    this.sequence = 0;
    this.socket = createSocket("udp4");
    this.timer = setInterval(() => this.send(), 1000 / rate_Hz);
  }

  /** When the observation left, ms since the epoch. */
  send() {
    const points = kMarkers_m.map((marker_m, id) => {
      const [x, y, z] = marker_m.map((m, i) => m + this.at_m[i] - kCamera_m[i]);
      const noise_px = () => 2 * kNoise_px * (Math.random() - 0.5);
      // The camera's axes in W: right is -z, down is +y.
      return [id, (kFocus_px * -z) / x + 960 + noise_px(), (kFocus_px * y) / x + 540 + noise_px()];
    });
    const now_ms = performance.timeOrigin + performance.now();
    this.socket.send(
      JSON.stringify({
        time_s: performance.now() / 1000,
        sequence: ++this.sequence,
        camera: "front",
        body: "b",
        points,
      }),
      this.port,
      "127.0.0.1",
    );
    return now_ms;
  }

  go(at_m) {
    this.at_m = at_m;
    return this.send();
  }

  stop() {
    clearInterval(this.timer);
    this.socket.close();
  }
}
