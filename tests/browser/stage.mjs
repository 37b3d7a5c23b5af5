// SPDX-License-Identifier: Apache-2.0
// stage.mjs - what the browser tests share: real programs, a real Chromium, sentences that hold or not.
import { spawn } from "node:child_process";
import { existsSync, mkdtempSync, rmSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { fileURLToPath } from "node:url";

export const root = fileURLToPath(new URL("../../", import.meta.url));
const { chromium } = createRequire(join(root, "host/web/package.json"))("playwright-core");

/** Where the programs and page/ are: the first argument of the test. */
export const build = resolve(process.argv[2] ?? join(root, "build"));
/** For sockets and files; gone at the end. */
export const folder = mkdtempSync(join(tmpdir(), "tact-browser-"));
export const size = { width: 1280, height: 800 };

const children = new Set();
let passed = 0;
let failed = 0;

export function check(message, holds, seen = "") {
  holds ? ++passed : ++failed;
  console.log(`${holds ? "ok    " : "FAILED"} ${message}${seen === "" ? "" : ` (${seen})`}`);
}

/** A program of BUILD_DIR; its standard output is first_line's, or unread. `errors`: "pipe" for a test that reads them. */
export const start = (program, args, errors = "inherit") => start_at(join(build, program), args, process.env, errors);

/** One from elsewhere. */
export function start_at(path, args, env = process.env, errors = "inherit") {
  const child = spawn(path, args, { stdio: ["ignore", "pipe", errors], env });
  children.add(child);
  child.ended = new Promise((done) =>
    child.on("exit", (status) => {
      children.delete(child);
      done(status);
    }),
  );
  return child;
}

/** tactd with a scene of model/scenes; its telemetry goes to `socket`. */
export function start_tactd(scene, socket, args = []) {
  const child = start("tactd", [join(root, `model/scenes/${scene}.toml`), "--socket", socket, ...args]);
  child.stdout.resume();
  return child;
}

export async function stop(child) {
  child.kill("SIGINT");
  return child.ended;
}

/** The first line of a program's output, or the first that begins so. */
export function first_line(child, beginning = "") {
  return new Promise((done, fail) => {
    let text = "";
    child.stdout.on("data", (data) => {
      text += data;
      const line = text
        .split("\n")
        .slice(0, -1)
        .find((one) => one.startsWith(beginning));
      if (line !== undefined) done(line);
    });
    child.ended.then((status) => fail(new Error(`${child.spawnfile} left with status ${status}`)));
  });
}

/** tact-view on a free port, and the link that it prints. */
export async function start_view(args, errors = "inherit") {
  const viewer = start("tact-view", [...args, "--port", "0", "--json"], errors);
  viewer.ready = JSON.parse(await first_line(viewer));
  return { viewer, url: viewer.ready.url };
}

/** The same link in full quality, at any cost. */
export const sharp = (url) => `${url}&sharp`;

/** Its pages have 2 minutes to load: on a busy machine the first one compiles its shaders for half a minute. */
export async function start_browser(flags = []) {
  const browser = await chromium.launch({
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    args: [
      "--no-sandbox",
      "--disable-gpu",
      ...(flags.includes("--disable-3d-apis") ? [] : ["--enable-unsafe-swiftshader"]),
      "--disable-quic",
      "--no-first-run",
      "--disable-background-networking",
      "--disable-component-update",
      "--disable-sync",
      ...flags,
    ],
  });
  const open = browser.newContext.bind(browser);
  browser.newContext = async (options) => {
    const context = await open(options);
    context.setDefaultNavigationTimeout(120_000);
    return context;
  };
  return browser;
}

/** A page that waits for tactd on this socket, and its viewer. */
export async function open_waiting(browser, socket) {
  const { viewer, url } = await start_view(["--socket", socket]);
  const page = await browser.newPage({ viewport: size });
  await page.goto(url);
  await waits(page, () => document.getElementById("notice").textContent.includes("waiting for tactd"));
  return { viewer, page };
}

/** What the page reports of itself. */
export const numbers = (page) => page.evaluate(() => ({ ...window.tact }));
/** True when the condition holds in time. */
/** `condition(value)` in the page. */
export const waits = (page, condition, value = null, timeout = 60000) =>
  page.waitForFunction(condition, value, { timeout, polling: 50 }).then(
    () => true,
    () => false,
  );
export const distance = (a, b) => Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);

export async function measure_fps(page, seconds) {
  return page.evaluate(async (duration_ms) => {
    const begin = performance.now();
    let count = 0;
    while (performance.now() - begin < duration_ms) {
      await new Promise((done) => requestAnimationFrame(done));
      ++count;
    }
    return (count * 1000) / (performance.now() - begin);
  }, seconds * 1000);
}

/** Runs a test to its end, tidies up, prints "N passed, M failed" and leaves. */
export async function play(run) {
  try {
    for (const part of ["tactd", "tact-view", "page/index.html"]) {
      if (!existsSync(join(build, part))) throw new Error(`${join(build, part)} is missing; build it first`);
    }
    await run();
  } catch (error) {
    check(`runs to its end: ${error.message.split("\n")[0]}`, false);
  } finally {
    for (const child of children) child.kill("SIGKILL");
    rmSync(folder, { recursive: true, force: true });
  }
  console.log(`${passed} passed, ${failed} failed`);
  process.exit(failed === 0 ? 0 : 1);
}
