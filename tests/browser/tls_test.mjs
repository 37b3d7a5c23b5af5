// SPDX-License-Identifier: Apache-2.0
// The page over TLS as tools/deploy/stunnel.conf sets it up: https and wss.
//
//     node tests/browser/tls_test.mjs BUILD_DIR   (tactd, tact-view, page/; stunnel and openssl)
//
// CHROMIUM names another browser. Prints "N passed, M failed"; exit status 0 or 1.
import { spawn, spawnSync } from "node:child_process";
import { readFileSync, writeFileSync } from "node:fs";
import { createServer } from "node:net";
import { join } from "node:path";

import { check, folder, play, root, size, start_browser, start_tactd, start_view, stop, waits } from "./stage.mjs";

const socket = join(folder, "tls.sock");

/** A port without a listener. */
function free_port() {
  return new Promise((done) => {
    const server = createServer().listen(0, () => {
      const { port } = server.address();
      server.close(() => done(port));
    });
  });
}

/** stunnel with the recipe, between `outer` and `inner`. */
function start_stunnel(outer, inner) {
  spawnSync(
    "openssl",
    [
      "req",
      "-x509",
      "-newkey",
      "rsa:2048",
      "-nodes",
      "-days",
      "1",
      "-subj",
      "/CN=localhost",
      "-keyout",
      join(folder, "tact.key"),
      "-out",
      join(folder, "tact.pem"),
    ],
    { stdio: "ignore" },
  );
  const recipe = readFileSync(join(root, "tools/deploy/stunnel.conf"), "utf8");
  writeFileSync(
    join(folder, "stunnel.conf"),
    recipe.replace("accept = 8443", `accept = ${outer}`).replace("127.0.0.1:8321", `127.0.0.1:${inner}`),
  );
  return spawn("stunnel", ["stunnel.conf"], { cwd: folder, stdio: "ignore" });
}

await play(async () => {
  const outer = await free_port();
  const { viewer, url } = await start_view(["--socket", socket, "--url", `https://localhost:${outer}`]);
  const inner = viewer.ready.port;
  const stunnel = start_stunnel(outer, inner);
  const tactd = start_tactd("liver", socket);
  const browser = await start_browser();
  const page = await browser.newPage({ viewport: size, ignoreHTTPSErrors: true }); // it signed itself
  check("the printed link is that of the proxy", url.startsWith(`https://localhost:${outer}/#token=`));
  for (
    let i = 0;
    i < 50 &&
    !(await page.goto(url).then(
      () => true,
      () => false,
    ));
    ++i
  )
    await page.waitForTimeout(100);
  check(
    "the page is live through TLS",
    await waits(page, () => location.protocol === "https:" && window.tact.link === "live" && window.tact.vertex_count > 0),
  );
  check("it has no cookie", (await page.context().cookies()).length === 0);
  const { status } = await fetch(`http://127.0.0.1:${inner}/scene.json`);
  check("beside TLS nothing is shown either", status === 401, status);
  await browser.close();
  stunnel.kill();
  check("tactd ends", (await stop(tactd)) !== null);
  check("tact-view ends cleanly", (await stop(viewer)) === 0);
});
