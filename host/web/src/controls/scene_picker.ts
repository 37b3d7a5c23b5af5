// SPDX-License-Identifier: Apache-2.0
// scene_picker.ts - another scene, other numbers of its law. It asks; who has started the simulation
// starts tactd again, or sets the numbers while it runs, or says why not. What is good is decided there,
// not here.

import { by_id } from "../document/dom";
import type { OfferedScene, Parameter, Picker, SceneRequest } from "../link/protocol";
import { number_in, range_words, share_of, value_at, why_no_number } from "./parameter_scale";

function element<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  set: Partial<HTMLElementTagNameMap[K]>,
): HTMLElementTagNameMap[K] {
  return Object.assign(document.createElement(tag), set);
}

/** The same text for the same request. */
const text_of = ({ scene, set }: SceneRequest): string => JSON.stringify([scene, Object.entries(set).sort()]);

/** A slider and a field for one number. */
class Row {
  readonly box = element("div", { className: "parameter" });
  // No type=number: some browsers take "1,5" for 15 there.
  private readonly field = element("input", { type: "text", inputMode: "decimal", autocomplete: "off", spellcheck: false });
  private readonly slider = element("input", { type: "range", min: "0", max: "1", step: "0.002" });

  /** `runs`: the value that it has in the simulation, if this scene runs. */
  constructor(
    readonly of: Parameter,
    value: number,
    public runs: number,
  ) {
    const { name } = this;
    const small = element("small", {
      className: "soft",
      id: `about_${of.key}`,
      textContent: `${of.meaning}; ${range_words(of)}`,
    });
    this.field.id = `set_${of.key}`;
    this.slider.id = `slide_${of.key}`;
    for (const input of [this.field, this.slider]) input.setAttribute("aria-describedby", small.id);
    this.slider.setAttribute("aria-label", `${name}, slider`);
    this.field.addEventListener("input", () => this.follow());
    this.slider.addEventListener("input", () => this.put(value_at(of, Number(this.slider.value))));
    const label = element("label", { htmlFor: this.field.id });
    label.append(...name.split(/(?<=_)/).flatMap((part) => [part, element("wbr", {})])); // a narrow one breaks there
    this.box.append(label, this.field, this.slider, small);
    this.put(value);
  }

  private get name(): string {
    return this.of.key.slice(this.of.key.indexOf(".") + 1);
  }

  /** NaN: no number is written there. */
  get value(): number {
    return number_in(this.field.value);
  }

  /** Where no number is written: why, after the focus went there. */
  correct(): string {
    this.field.focus();
    return why_no_number(this.name, this.field.value);
  }

  put(value: number): void {
    this.field.value = String(value);
    this.follow();
  }

  private follow(): void {
    this.slider.value = String(share_of(this.of, this.value));
    this.slider.setAttribute("aria-valuetext", `${this.field.value} ${this.of.unit}`.trim());
    this.field.setAttribute("aria-invalid", String(!(this.value >= this.of.low && this.value <= this.of.high)));
  }
}

export class ScenePicker {
  /** Something is offered. */
  there = false;
  private scenes: OfferedScene[] = [];
  private now: Picker | null = null;
  private shown = ""; // what runs, as it was put into the form
  private requested = ""; // what this page asked for last
  private heard = ""; // the answer that is known already
  private refusal = ""; // why the last request came to nothing, until something is edited
  private elsewhere = false; // another page chose what runs
  private waits = false; // an edit, for the answer to the request before it
  private rows: Row[] = [];
  private readonly select = by_id<HTMLSelectElement>("requested_scene");

  constructor(
    private readonly ask: (request: SceneRequest) => void,
    private readonly offered: () => Promise<OfferedScene[]>,
  ) {
    this.select.addEventListener("change", () => {
      this.show(this.select.value === this.now?.scene ? this.now.set : {});
      this.edited();
    });
    by_id("parameters").addEventListener("input", () => this.edited());
    // A slider that was let go, or a field that was left.
    by_id("parameters").addEventListener("change", () => {
      if (this.is_live()) this.apply();
    });
    by_id("request").addEventListener("submit", (event) => {
      event.preventDefault();
      this.apply();
    });
    by_id("as_shipped").addEventListener("click", () => {
      this.show({});
      this.apply();
    });
  }

  /** Null: nothing is offered. */
  async status(picker: Picker | null): Promise<void> {
    const is_new = picker !== null && this.now === null; // of another tact-view, maybe with others
    this.now = picker;
    if (is_new) {
      this.heard = picker.answer; // to another page, before this one opened
      this.refusal = "";
      this.scenes = await this.offered().catch(() => []);
      this.select.replaceChildren(...this.scenes.map((one) => new Option(one.scene)));
      this.shown = "";
    }
    this.report();
  }

  private report(): void {
    const picker = this.now;
    this.there = picker !== null && this.scenes.length > 0;
    document.body.classList.toggle("can_pick", this.there);
    if (!picker || !this.there) return;
    const runs = text_of(picker);
    if (runs !== this.shown) {
      this.elsewhere = this.shown !== "" && runs !== this.requested;
      this.shown = runs;
      // What this page asked for is there already, and perhaps the next edit.
      if (runs === this.requested && this.select.value === picker.scene)
        for (const row of this.rows) row.runs = picker.set[row.of.key] ?? row.of.value;
      else {
        this.select.value = picker.scene;
        this.show(picker.set);
      }
    }
    if (picker.answer !== this.heard) this.refusal = this.heard = picker.answer;
    if (picker.asked) this.say(`asked for ${picker.asked} …`);
    else if (this.refusal) this.say(this.refusal, "bad");
    else this.say(this.words(picker));
    if (!picker.asked && this.waits) {
      this.waits = false;
      this.apply();
    }
  }

  /** Only numbers that may change while the scene runs differ from those that it has. */
  private is_live(): boolean {
    const changed = this.rows.filter((row) => row.value !== row.runs);
    return this.select.value === this.now?.scene && changed.length > 0 && changed.every((row) => row.of.live);
  }

  /** What runs, or what is not asked for yet. */
  private words(picker: Picker): string {
    if (this.select.value !== picker.scene) return `${this.select.value} is not applied yet`;
    const edits = this.rows.filter((row) => row.value !== row.runs).length;
    if (edits > 0) return `${edits} ${edits === 1 ? "change" : "changes"} not applied yet`;
    const changed = Object.keys(picker.set).length;
    if (picker.note && !this.elsewhere) return picker.note;
    const runs = `${picker.scene} runs, ${changed === 0 ? "as shipped" : `${changed} changed`}`;
    return this.elsewhere ? `the scene was chosen elsewhere: ${runs}` : runs;
  }

  private edited(): void {
    this.refusal = "";
    this.elsewhere = false;
    this.report();
  }

  /** The numbers of the chosen scene, as shipped but for these. */
  private show(set: Record<string, number>): void {
    const scene = this.scenes.find((one) => one.scene === this.select.value);
    const running = this.now?.scene === scene?.scene ? this.now?.set : {};
    this.rows = (scene?.parameters ?? []).map((of) => new Row(of, set[of.key] ?? of.value, running?.[of.key] ?? of.value));
    by_id("parameters").replaceChildren(...this.rows.map((row) => row.box));
    by_id("requested_law").textContent = scene ? `law ${scene.law}` : "";
  }

  private apply(): void {
    this.refusal = this.rows.find((row) => Number.isNaN(row.value))?.correct() ?? "";
    if (this.refusal) return this.report();
    if (this.now?.asked) {
      this.waits = true;
      return;
    }
    const changed = this.rows.filter((row) => row.value !== row.of.value);
    const request = { scene: this.select.value, set: Object.fromEntries(changed.map((row) => [row.of.key, row.value])) };
    this.requested = text_of(request);
    this.heard = ""; // the same answer again is another
    this.ask(request);
  }

  private say(words: string, tone = "plain"): void {
    const line = by_id("picker_words");
    if (line.textContent !== words) line.textContent = words; // else it is read aloud again
    line.dataset.tone = tone;
  }
}
