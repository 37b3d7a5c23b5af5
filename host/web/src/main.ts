// SPDX-License-Identifier: Apache-2.0
// main.ts - puts the parts together: connection -> stage, panels, plots; mouse and keys -> hand.

import "./style/index.css";
import { Connection } from "./link/connection";
import { HandControl } from "./controls/hand_control";
import type { Headset } from "./operator/headset";
import { by_id } from "./document/dom";
import { Hud } from "./panels/hud";
import { move_by_key } from "./controls/key_moves";
import { bind_keys } from "./controls/keys";
import { take_token } from "./link/link";
import { News } from "./link/news";
import { Operator } from "./operator/operator";
import { count_boundary_edges } from "./organ/boundary";
import { Pairs } from "./operator/pairs";
import { OrganView } from "./organ/organ_view";
import { Outside } from "./scene/outside";
import { Plots } from "./panels/plots";
import { time_s_of, type FigureFrame, type Frame, type Mesh, type Scene, type Status, type Vec } from "./link/protocol";
import { close_panel, toggle_panel } from "./controls/open_panel";
import { Recorder } from "./controls/recorder";
import { save_picture } from "./controls/save_picture";
import { ScenePicker } from "./controls/scene_picker";
import { Stage } from "./scene/stage";
import { TaskList } from "./panels/tasks";
import { Timeline } from "./controls/timeline";
import { ToolView } from "./scene/tool_view";
import { Troubles } from "./panels/troubles";

const troubles = new Troubles(
  (text) => connection.report(text),
  (failing) => hud.fails(failing),
);
troubles.listen();
const token = take_token();
const canvas = by_id<HTMLCanvasElement>("view");
const hud = new Hud();
const plots = new Plots(by_id, (path) => connection.fetch(path));
const recorder = new Recorder((path) => connection.fetch(path));
const news = new News();
const pairs = new Pairs();
const tasks = new TaskList();

let scene: Scene | null = null;
let organ: OrganView | null = null;
let tool: ToolView | null = null;
let shown: Frame | null = null;
let status: Status | null = null;
let paused = false;
let wireframe = false;
let most_ever_m = 0;
let silence_s = 0;
let first_drawn_ms: number | null = null; // the first picture of tissue, since 1970
let headset: Headset | null = null;

// First: the network has its turn while the picture is set up.
const connection = new Connection(token, {
  status: (now) => {
    status = now;
    void troubles.flush();
    hud.link(now);
    operator.status(now);
    timeline.status(now.replay ?? null);
    plots.zero_s = now.replay?.start_s ?? 0;
    plots.replay_Hz = now.replay ? (scene?.rate_Hz ?? 0) : 0;
    report_hand();
    void picker.status(now.picker ?? null);
    if (now.replay) paused = false;
    if (now.link === "lost") {
      hud.tracking(null);
      recorder.stop();
    }
  },
  scene: take_scene,
  frame: take_frame,
  figure: take_figure,
  server_gone: (why) => {
    status = null;
    timeline.status(null);
    void picker.status(null);
    report_hand();
    hud.link(null, why);
    hud.tracking(null); // what a chip said last is not known any more
    recorder.stop();
  },
});
const stage = new Stage(canvas, {
  draw: (now_ms) => void troubles.guard("page", () => draw(now_ms)),
  drawn: () => hud.drawn(),
  missing: (words, remedy) => (words ? troubles.report("picture", words, remedy) : troubles.over("picture")),
});
const operator = new Operator(stage, hud);
const outside = new Outside(canvas, stage.camera);
const timeline = new Timeline((request) => connection.steer(request));
const picker = new ScenePicker(
  (request) => connection.choose(request),
  () => connection.offered(),
);
const hand = new HandControl(canvas, stage, may_move_hand, (position_m, rotation_rad, grip_ratio) =>
  connection.move_hand(position_m, rotation_rad, grip_ratio),
);
window.addEventListener("hashchange", () => {
  const next = take_token();
  if (next !== null) connection.use(next);
});

function may_move_hand(): boolean {
  return scene?.simulated === true && status?.link === "live";
}

/** What cannot be done is not offered. */
function report_hand(): void {
  document.body.classList.toggle("can_move", may_move_hand());
}

function take_scene(next: Scene, organ_mesh: Mesh, tool_mesh: Mesh): void {
  if (organ && tool) {
    stage.scene.remove(organ.object, tool.object);
    organ.dispose();
    tool.dispose();
  }
  pairs.clear();
  freeze(false); // what was frozen is gone
  scene = next;
  organ = new OrganView(organ_mesh, next);
  organ.wireframe = wireframe;
  tool = new ToolView(tool_mesh, next, stage.steel);
  stage.scene.add(organ.object, tool.object);
  stage.set_home(organ.bounds, organ.floor_m - 0.004);
  hud.scene(next, count_boundary_edges(organ_mesh.triangle));
  tasks.scene(next);
  plots.spheres = next.spheres.length;
  if (status?.replay) plots.replay_Hz = next.rate_Hz;
  recorder.scene = next.scene_name;
  report_hand();
}

function take_frame(frame: Frame): void {
  recorder.frame(frame);
  news.frame(performance.now());
  timeline.frame(time_s_of(frame));
  tasks.frame(frame);
  if (paused) return;
  pairs.frame(frame, operator.there);
  plots.add(frame);
}

function take_figure(next: FigureFrame): void {
  if (paused) return;
  operator.take(next);
  pairs.figure(next.tick);
}

function draw(now_ms: number): void {
  const next = organ && tool ? pairs.take() : null;
  if (organ && next) {
    if (first_drawn_ms === null) void look_for_headset();
    first_drawn_ms ??= performance.timeOrigin + performance.now();
    shown = next;
    hand.frame(shown, now_ms);
    hud.frame(shown, now_ms);
    troubles.guard("picture", () => show(next));
    most_ever_m = Math.max(most_ever_m, organ.deformed.most_m);
  }
  hud.draw(now_ms, stage.fps);
  if (!paused) tasks.draw();
  const silent_s = news.silence_s(performance.now(), scene?.frame_rate_Hz ?? 60);
  silence_s = status?.link === "replay" ? 0 : silent_s; // a recording may have gaps
  hud.silence(silence_s);
  if (silence_s > 0) tool?.hide_force();
  operator.draw(status !== null && status.link !== "lost");
  timeline.draw();
  tool?.show_hand_target(hand.target ? (hand.target.toArray() as Vec) : null);
  if (!paused) plots.draw(now_ms);
  const drawn = organ && tool && shown && !stage.wearer;
  outside.draw(now_ms, drawn ? organ!.target : null, drawn ? tool!.target : null);
  headset?.report(now_ms, () => hud.said(paused));
}

function show(frame: Frame): void {
  organ?.show(frame);
  tool?.show(frame);
  stage.keep_in_view(frame.tool_position_m);
}

/** After the first picture, so that it waits for nothing. */
async function look_for_headset(): Promise<void> {
  if (!navigator.xr || !stage.renderer) return;
  const { Headset } = await import("./operator/headset");
  headset = new Headset(stage, stage.renderer, draw, () => operator.eyes_m);
  await headset.offer();
}

function freeze(on: boolean): void {
  paused = on;
  hud.pressed("pause", on);
}

const kTwist_rad = (5 * Math.PI) / 180; // for a press of a key

const actions: Record<string, () => unknown> = {
  p: () => {
    if (status?.link === "replay") return timeline.toggle();
    freeze(!paused);
  },
  m: () => {
    hand.mode = !hand.mode && may_move_hand();
    hud.pressed("hand", hand.mode);
    canvas.classList.toggle("moves_hand", hand.mode);
  },
  r: () => (recorder.on ? recorder.stop() : recorder.start()),
  c: () => recorder.save_table(),
  w: () => {
    wireframe = !wireframe;
    if (organ) organ.wireframe = wireframe;
    hud.pressed("wire", wireframe);
  },
  v: () => {
    operator.view_chosen = true;
    operator.see_with_eyes(false);
    stage.go_home();
  },
  f: () => operator.there && operator.show(!operator.on),
  e: () => {
    operator.view_chosen = true;
    operator.see_with_eyes(!operator.eyes_on);
  },
  x: () => headset?.toggle(),
  g: () => hand.toggle_grip(),
  a: () => hand.twist(-kTwist_rad),
  d: () => hand.twist(kTwist_rad),
  grip: () => hand.grip(1),
  "let go": () => hand.grip(0),
  s: () => shown && scene && void save_picture(stage, scene, status, shown, plots.zero_s),
  l: () => picker.there && toggle_panel("picker"),
  h: () => toggle_panel("keys"),
  Escape: close_panel,
};

function move_by_keys(key: string, shift: boolean): boolean {
  const moved = move_by_key(key, shift, stage, hand);
  if (moved) operator.view_chosen = true;
  return moved;
}

bind_keys((key, shift) => timeline.key(key, shift), move_by_keys, { ...actions, ...connection.digits });

stage.start();
stage.controls.addEventListener("start", () => (operator.view_chosen = true));

/** Read-only numbers for tests and for curious people in the console: a table, one a line. */
// prettier-ignore
const numbers = {
  get fps() { return stage.fps; },
  get link() { return status?.link ?? "gone"; },
  get scene_name() { return scene?.scene_name ?? ""; },
  get vertex_count() { return organ?.vertex_count ?? 0; },
  get frames() { return connection.frames; },
  get bytes() { return connection.bytes; },
  get largest_frame_bytes() { return connection.largest_frame_bytes; },
  get drawn_ratios() { return organ && shown ? organ.drawn_ratios(shown) : []; },
  get moved_vertices() { return organ?.deformed.moved ?? 0; },
  get cut_triangles() { return organ?.cut_triangles ?? 0; },
  get cut_gap_m() { return organ?.cut_gap_m ?? 0; },
  get most_m() { return organ?.deformed.most_m ?? 0; },
  get most_ever_m() { return most_ever_m; },
  get tool_m() { return shown ? [...shown.tool_position_m] : null; },
  get turn() { return shown ? [...shown.tool_orientation] : null; },
  get arc_share() { return tool?.arc_share ?? 0; },
  get force_N() { return shown ? [...shown.force_N] : null; },
  get tick() { return shown?.tick ?? 0; },
  get state() { return shown?.state ?? 0; },
  get paused() { return paused; },
  get plotted() { return plots.drawn; },
  get first_drawn_ms() { return first_drawn_ms; },
  get time_s() { return shown ? time_s_of(shown) : 0; },
  get silence_s() { return silence_s; },
  get wireframe() { return wireframe; },
  get figure_on() { return operator.there && operator.on; },
  get eyes_on() { return operator.eyes_on; },
  get figure_m() { return operator.joints_m; },
  get drawn_figure_m() { return operator.drawn_m; },
  /** Where a place in the tool's own axes is drawn. */
  drawn_tool_m(place_m: Vec) { return tool?.drawn_m(place_m) ?? null; },
  get grip_error_m() { return operator.grip_error_m; },
  get tracking_words() { return operator.shown?.words ?? ""; },
  get largest_figure_bytes() { return connection.largest_figure_bytes; },
  get camera_m() { return stage.camera.position.toArray(); },
  get camera() { stage.camera.updateMatrixWorld(); return { projection: stage.camera.projectionMatrix.toArray(), view: stage.camera.matrixWorldInverse.toArray() }; },
  get organ_m() { return organ?.drawn_m ?? null; },
  get headset() { return headset?.numbers ?? null; },
};
export type TactNumbers = Readonly<typeof numbers>;
declare global {
  interface Window {
    readonly tact: TactNumbers;
  }
}
Object.defineProperty(window, "tact", { value: Object.freeze(numbers) });
