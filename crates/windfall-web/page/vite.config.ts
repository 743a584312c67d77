import { svelte } from "@sveltejs/vite-plugin-svelte";
import { defineConfig } from "vite";

// `windfall serve` while the page is worked on.
const server = "http://127.0.0.1:8417";

export default defineConfig({
  plugins: [svelte()],
  base: "./",
  build: {
    outDir: "../assets",
    emptyOutDir: true,
    // Names stay, so that a change of the page is a change of three files; the server
    // tells browsers by ETag what they may keep.
    rollupOptions: {
      output: {
        entryFileNames: "page.js",
        chunkFileNames: "page-[name].js",
        assetFileNames: "page[extname]",
      },
    },
    // Data addresses would be needless exceptions in the content security policy.
    assetsInlineLimit: 0,
    modulePreload: false,
    // What the page is made of asks to be named wherever it is shipped.
    license: { fileName: "licences.md" },
  },
  server: {
    host: "127.0.0.1",
    proxy: { "/api": { target: server, changeOrigin: true, headers: { origin: server } } },
  },
});
