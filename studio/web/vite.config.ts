import react from "@vitejs/plugin-react";
import { resolve } from "node:path";
import type { Plugin } from "vite";
import { defineConfig } from "vitest/config";
import { writeDocuments } from "./scripts/documents.mjs";

/** The documents of docs/ as HTML, beside the page: it works without a network. */
function documents(): Plugin {
  let folder = "";
  return {
    name: "documents",
    apply: "build",
    configResolved: ({ root, build }) => void (folder = resolve(root, build.outDir)),
    closeBundle: () => writeDocuments(resolve(folder, "docs")),
  };
}

// `npm run dev` serves the page itself and forwards its requests to a running `tessera studio`.
export default defineConfig({
  plugins: [react(), documents()],
  base: "./",
  worker: { format: "es" },
  build: { target: "es2022", chunkSizeWarningLimit: 1800, rollupOptions: { input: ["index.html", "operate.html"] } },
  // The forms are made from the schema in share/.
  server: {
    host: "127.0.0.1",
    fs: { allow: ["../.."] },
    proxy: { "/api": process.env.TESSERA_STUDIO ?? "http://127.0.0.1:8787" },
  },
  test: {
    include: ["tests/{model,live,panels}/**/*.test.ts"],
    // ELK takes seconds while many builds run at once.
    testTimeout: 60_000,
    // Loading the modules for each file again would take longer than the tests. A file that replaces a global or
    // a clock puts it back.
    pool: "threads",
    isolate: false,
  },
});
