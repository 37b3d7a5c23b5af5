// SPDX-License-Identifier: Apache-2.0
// connection.ts - the WebSocket to tact-view: comes back by itself, answers every frame with a count
// so that the server never sends more than this page can draw.

import {
  split_meshes,
  type FigureFrame,
  type Frame,
  type Mesh,
  type OfferedScene,
  type ReplayRequest,
  type Scene,
  type SceneRequest,
  type Status,
  type Vec,
} from "./protocol";

export interface ConnectionEvents {
  status(status: Status): void;
  scene(scene: Scene, organ: Mesh, tool: Mesh): void;
  frame(frame: Frame): void;
  figure(figure: FigureFrame): void;
  /** `why`: it is there, and refuses this page; empty: it is not there. */
  server_gone(why: string): void;
}

const kRetry_ms = 1000;
const kToken = "tact-token"; // in this tab's own storage, which is of one port
const kNoToken = "this page has no token, or an old one: open the whole link that tact-view printed";
const kNoSocket =
  "tact-view is there, but its WebSocket is refused; a proxy between must pass Upgrade and Connection on. The terminal of " +
  "tact-view has the reason";

export class Connection {
  frames = 0;
  bytes = 0;
  largest_frame_bytes = 0;
  largest_figure_bytes = 0;
  private socket: WebSocket | null = null;
  private scene_number = 0;
  private seen = 0; // frames of this socket

  constructor(
    private token: string | null,
    private readonly events: ConnectionEvents,
  ) {
    this.token ??= sessionStorage.getItem(kToken);
    void this.open();
  }

  /** A new link was opened in this page: it counts from the next try on. */
  use(token: string): void {
    this.token = token;
  }

  /** A file of the server, with the token of this page. */
  fetch(path: string, headers: Record<string, string> = {}): Promise<Response> {
    return fetch(path, { headers: this.token ? { Authorization: `Bearer ${this.token}`, ...headers } : headers });
  }

  /** One line of ASCII for the terminal of tact-view. */
  async report(trouble: string): Promise<boolean> {
    return (await this.fetch("session", { "Tact-Trouble": trouble })).ok;
  }

  /** Where a simulated hand shall go. Dropped when no device listens. */
  move_hand(position_m: Vec, rotation_rad: Vec, grip_ratio: number): void {
    const [x_m, y_m, z_m] = position_m;
    const [turn_x_rad, turn_y_rad, turn_z_rad] = rotation_rad;
    this.send({ hand: { x_m, y_m, z_m, turn_x_rad, turn_y_rad, turn_z_rad, grip_ratio } });
  }

  /** To a tact-view that replays; another one hears nothing of it. */
  steer(replay: ReplayRequest): void {
    this.send({ replay });
  }

  /** To who has started the simulation; a tact-view that offers no scenes hears nothing of it. */
  choose(request: SceneRequest): void {
    this.send({ request });
  }

  /** What may be chosen. */
  async offered(): Promise<OfferedScene[]> {
    const answer = await this.fetch("scenes.json");
    return answer.ok ? ((await answer.json()) as OfferedScene[]) : [];
  }

  /** Digits, for a tact-view with --keys; another one hears nothing of them. */
  readonly digits: Record<string, () => void> = Object.fromEntries(
    [..."0123456789"].map((key) => [key, () => this.send({ key })]),
  );

  private async open(): Promise<void> {
    const why = await this.enter();
    if (why !== null) return this.retry(why);
    const scheme = location.protocol === "https:" ? "wss" : "ws";
    this.socket = new WebSocket(`${scheme}://${location.host}/live`, ["tact", `token.${this.token}`]);
    this.seen = 0;
    let opened = false;
    this.socket.onopen = () => (opened = true);
    this.socket.onmessage = (message) => this.take(String(message.data));
    this.socket.onclose = () => this.retry(opened ? "" : kNoSocket);
  }

  private retry(why: string): void {
    this.events.server_gone(why);
    setTimeout(() => void this.open(), kRetry_ms);
  }

  /** Null: it lets this page in; else why not; empty: no answer. */
  private async enter(): Promise<string | null> {
    const token = this.token;
    try {
      // A browser sends no Origin here, and says nothing of a refused WebSocket.
      const answer = await this.fetch("session", { "Tact-Origin": location.origin });
      if (answer.ok && token) sessionStorage.setItem(kToken, token);
      if (answer.ok) return null;
      if (answer.status === 401) return kNoToken;
      const reason = /^\d{3}: (.*)/.exec(await answer.text()); // that of a proxy before a tact-view that is gone is HTML
      return reason ? `tact-view refuses this page: ${reason[1]}` : "";
    } catch {
      return "";
    }
  }

  private send(message: object): void {
    if (this.socket?.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(message));
  }

  private take(text: string): void {
    const message = JSON.parse(text) as Frame | FigureFrame | Status;
    if (message.kind === "frame") {
      ++this.frames;
      this.bytes += text.length; // the text is ASCII
      this.largest_frame_bytes = Math.max(this.largest_frame_bytes, text.length);
      this.send({ seen: ++this.seen });
      this.events.frame(message);
    } else if (message.kind === "figure") {
      this.largest_figure_bytes = Math.max(this.largest_figure_bytes, text.length);
      this.events.figure(message);
    } else {
      this.events.status(message);
      if (message.scene_number > 0 && message.scene_number !== this.scene_number) {
        this.scene_number = message.scene_number;
        this.load_scene(message.scene_number).catch(() => {
          this.scene_number = 0; // the connection broke meanwhile: the next status tries again
        });
      }
    }
  }

  private async load_scene(number: number): Promise<void> {
    const [scene_answer, mesh_answer] = await Promise.all([this.fetch("scene.json"), this.fetch("mesh.bin")]);
    if (!scene_answer.ok || !mesh_answer.ok) throw new Error("no scene yet");
    const scene = (await scene_answer.json()) as Scene;
    const { organ, tool } = split_meshes(scene, await mesh_answer.arrayBuffer());
    if (number === this.scene_number) this.events.scene(scene, organ, tool);
  }
}
