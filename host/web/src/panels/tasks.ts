// SPDX-License-Identifier: Apache-2.0
// tasks.ts - the exercise of a scene: which task is due, and which are done, by the frames alone.
//
// A task ends when a contact point lies within radius_m of its place while force or grip is in its range, for hold_s
// in every frame. One at a time, in their order. Another run, or a recording sought back, begins again; a pause of the
// frames begins the hold again.

import { by_id } from "../document/dom";
import { is_jump, kContactInside, length_of, time_s_of, type Frame, type Scene } from "../link/protocol";

export type Task = Scene["tasks"][number];

/** How many tasks are done. */
export class Exercise {
  done = 0;
  private time_s = -Infinity;
  private since_s: number | null = null; // in the range of the current one

  constructor(private readonly tasks: readonly Task[]) {}

  frame(frame: Frame): void {
    const now_s = time_s_of(frame);
    if (now_s < this.time_s) this.done = 0; // another run, or sought back
    if (Number.isFinite(this.time_s) && is_jump(this.time_s, now_s)) this.since_s = null;
    this.time_s = now_s;
    const task = this.tasks[this.done];
    if (!task || !is_in_range(frame, task)) {
      this.since_s = null;
      return;
    }
    this.since_s ??= now_s;
    if (now_s - this.since_s < task.hold_s) return;
    ++this.done;
    this.since_s = null;
  }
}

function is_in_range(frame: Frame, task: Task): boolean {
  const [value, min, max] = task.by_grip
    ? [frame.grip_ratio, task.grip_min_ratio, task.grip_max_ratio]
    : [length_of(frame.force_N), task.force_min_N, task.force_max_N];
  if (!(value >= min && value <= max)) return false;
  return frame.contacts.some(
    ({ state, surface_point_m }) =>
      state !== kContactInside && Math.hypot(...surface_point_m.map((x, i) => x - task.place_m[i])) <= task.radius_m,
  );
}

/** The list on the page. */
export class TaskList {
  private exercise = new Exercise([]);
  private tasks: readonly Task[] = [];
  private written = -1;

  scene({ tasks = [] }: Partial<Pick<Scene, "tasks">>): void {
    this.tasks = tasks;
    this.exercise = new Exercise(tasks);
    this.written = -1;
    by_id("tasks").hidden = tasks.length === 0;
    by_id("task_list").replaceChildren(
      ...tasks.map(({ text }) => {
        const item = document.createElement("li");
        item.textContent = text;
        return item;
      }),
    );
    this.draw();
  }

  frame(frame: Frame): void {
    this.exercise.frame(frame);
  }

  draw(): void {
    const { done } = this.exercise;
    if (done === this.written) return;
    this.written = done;
    const { children } = by_id("task_list");
    for (let i = 0; i < children.length; ++i) {
      children[i].className = i < done ? "done" : i === done ? "due" : "";
      if (i === done) children[i].setAttribute("aria-current", "step");
      else children[i].removeAttribute("aria-current");
    }
    const task = this.tasks[done];
    by_id("task_text").textContent = task ? `task ${done + 1} of ${this.tasks.length}: ${task.text}` : "all tasks are done";
  }
}
