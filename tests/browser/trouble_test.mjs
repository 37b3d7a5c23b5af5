// SPDX-License-Identifier: Apache-2.0
// The page in Chromium when it cannot show what is: no WebGL, a lost context, an error in the page, a refused
// WebSocket. Each is said over the page and in one line of the terminal of tact-view, and nothing is called live.
//
//     node tests/browser/trouble_test.mjs BUILD_DIR   (tactd, tact-view, page/)
//
// CHROMIUM names another browser. Pictures: BUILD_DIR/page_no_webgl.png. Prints "N passed, M failed"; exit status 0 or 1.
import { createServer, request } from "node:http";
import { join } from "node:path";

import { build, check, folder, play, size, start_browser, start_tactd, start_view, stop, waits } from "./stage.mjs";

const socket = join(folder, "trouble.sock");

/** What a person reads over the page, where the picture is, and of the link. */
const seen = (page) =>
  page.evaluate(() => ({
    trouble: document.getElementById("trouble").hidden ? "" : document.getElementById("trouble").textContent,
    notice: document.getElementById("notice").textContent,
    link: document.getElementById("link").textContent,
    force: document.getElementById("force").textContent,
    plot: document.querySelector("#plot_force b").textContent,
  }));
const is_live = (page) => waits(page, () => document.getElementById("link").textContent === "live");

/** The lines of the terminal with these words; waits for the first one. */
async function lines_with(page, terminal, words) {
  const lines = () =>
    terminal
      .join("")
      .split("\n")
      .filter((line) => words.test(line));
  for (let i = 0; i < 100 && lines().length === 0; ++i) await page.waitForTimeout(50);
  return lines();
}

async function check_trouble(page, terminal, name, words) {
  const shown = await waits(page, () => !document.getElementById("trouble").hidden);
  const { trouble, link } = await seen(page);
  check(`${name} is said over the page`, shown && words.test(trouble), trouble);
  check("... nothing is called live", link !== "live", link);
  const lines = await lines_with(page, terminal, words);
  check("... and in one line of the terminal", lines.length === 1, lines.join(" | "));
}

/** The force changes, and its plot with it. */
async function check_numbers(page) {
  const before = await seen(page);
  check(
    "... numbers and plots go on",
    await waits(
      page,
      (old) =>
        document.getElementById("force").textContent !== old.force &&
        document.querySelector("#plot_force b").textContent !== old.plot &&
        document.getElementById("state").textContent === "armed",
      before,
    ),
    JSON.stringify(await seen(page)),
  );
}

/** As on a remote desktop, or with an old graphics card. */
async function check_no_webgl(url, terminal) {
  const browser = await start_browser(["--disable-3d-apis"]);
  const page = await browser.newPage({ viewport: size });
  const thrown = [];
  page.on("pageerror", (error) => thrown.push(String(error)));
  await page.goto(url);
  await check_trouble(page, terminal, "a browser without WebGL", /no 3D picture: this browser has no WebGL 2/);
  await waits(page, () => window.tact.tick > 0);
  await check_numbers(page);
  await page.keyboard.press("w");
  await page.keyboard.press("v");
  check("... keys do no harm", thrown.length === 0 && (await page.evaluate(() => window.tact.wireframe)), thrown[0]);
  await page.screenshot({ path: join(build, "page_no_webgl.png") });
  await browser.close();
}

async function check_lost(page, terminal) {
  await page.evaluate(() => {
    window.lost = document.getElementById("view").getContext("webgl2").getExtension("WEBGL_lose_context");
    window.lost.loseContext();
  });
  await check_trouble(page, terminal, "a lost context", /the browser took the graphics away/);
  await check_numbers(page);
  await page.evaluate(() => window.lost.restoreContext());
  check("a picture that comes back is live again", await is_live(page));
  check("... and nothing is said", (await seen(page)).trouble === "");
}

/** One of a drawing, and one that is not caught. */
async function check_errors(page, terminal) {
  await page.evaluate(() => {
    window.was = window.Float32Array.prototype.fill;
    window.Float32Array.prototype.fill = () => {
      throw new RangeError("no room");
    };
  });
  await check_trouble(page, terminal, "an error of the picture", /error in the picture: RangeError: no room/);
  await check_numbers(page);
  await page.evaluate(() => {
    window.Float32Array.prototype.fill = window.was;
    setTimeout(() => {
      throw new TypeError("not caught");
    });
  });
  await waits(page, () => document.getElementById("trouble").textContent.includes("error in the page"));
  await check_trouble(page, terminal, "an error of the page", /error in the page: TypeError: not caught/);
}

/** Like nginx as most guides write it: another Host, or no Upgrade. */
function start_proxy(port, keeps_upgrade) {
  const server = createServer((from, to) => {
    const onward = request(
      {
        port,
        path: from.url,
        method: from.method,
        headers: { ...from.headers, host: keeps_upgrade ? `127.0.0.1:${port}` : from.headers.host },
      },
      (answer) => {
        to.writeHead(answer.statusCode, answer.headers);
        answer.pipe(to);
      },
    );
    from.pipe(onward);
  });
  server.on("upgrade", (from, wire) => {
    const headers = { ...from.headers, connection: "close" };
    delete headers.upgrade;
    request({ port, path: from.url, headers }, (answer) => {
      wire.end(`HTTP/1.1 ${answer.statusCode} ${answer.statusMessage}\r\nConnection: close\r\n\r\n`);
    }).end();
  });
  return new Promise((done) => server.listen(0, "127.0.0.1", () => done(server)));
}

async function check_proxies(browser, viewer, terminal) {
  for (const [keeps_upgrade, words, line] of [
    [true, /must pass the Host header on/, /with Host 127\.0\.0\.1:\d+ and Origin/],
    [false, /its WebSocket is refused; a proxy between must pass Upgrade/, /without its Upgrade header/],
  ]) {
    const proxy = await start_proxy(viewer.ready.port, keeps_upgrade);
    const page = await browser.newPage({ viewport: size });
    await page.goto(`http://127.0.0.1:${proxy.address().port}/#token=${viewer.ready.token}`);
    await waits(page, () => document.getElementById("link").textContent === "not allowed");
    const { notice } = await seen(page);
    check(`a proxy without ${keeps_upgrade ? "Host" : "Upgrade"} is said over the page`, words.test(notice), notice);
    await page.waitForTimeout(2500); // it tries again each second
    const lines = await lines_with(page, terminal, line);
    check("... and in one line of the terminal", lines.length === 1, lines.join(" | "));
    await page.close();
    proxy.closeAllConnections();
    proxy.close();
  }
}

await play(async () => {
  const { viewer, url } = await start_view(["--socket", socket], "pipe");
  const terminal = [];
  viewer.stderr.on("data", (data) => terminal.push(String(data)));
  const tactd = start_tactd("liver", socket);
  await check_no_webgl(url, terminal);
  const browser = await start_browser();
  const page = await browser.newPage({ viewport: size });
  await page.goto(url);
  check("a drawn frame is live", await is_live(page));
  await check_lost(page, terminal);
  await check_errors(page, terminal);
  await page.close();
  await check_proxies(browser, viewer, terminal);
  await browser.close();
  await stop(tactd);
  await stop(viewer);
});
