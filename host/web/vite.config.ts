// SPDX-License-Identifier: Apache-2.0
import { defineConfig } from "vite";

// `npm run build` writes the page to build/page, where tact-view finds it beside itself; another
// place: `npm run build -- --outDir DIR`.
// `npm run dev` serves the sources and takes the data from a tact-view that runs on its usual port:
// open its address with the fragment (#token=...) of the link that tact-view printed.
const viewer = "http://127.0.0.1:8321";

export default defineConfig({
  base: "./",
  build: {
    outDir: process.env.TACT_PAGE_DIR ?? "../../build/page",
    emptyOutDir: true,
    target: "es2022",
    assetsInlineLimit: 0,
    modulePreload: { polyfill: false },
    chunkSizeWarningLimit: 900,
  },
  server: {
    proxy: {
      "/session": viewer,
      "/scene.json": viewer,
      "/mesh.bin": viewer,
      "/recording.csv": viewer,
      "/recording.tactview": viewer,
      "/live": { target: viewer, ws: true, changeOrigin: true, rewriteWsOrigin: true },
    },
  },
});
