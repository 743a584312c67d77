import { svelte } from "@sveltejs/vite-plugin-svelte";
import { defineConfig } from "vite";

// `windfall serve --no-token` while the page is worked on.
const server = "http://127.0.0.1:8417";

export default defineConfig({
  plugins: [svelte()],
  base: "./",
  build: {
    outDir: "../assets",
    emptyOutDir: true,
    // Names change with their content: the server lets browsers keep these files for good.
    rollupOptions: {
      output: {
        entryFileNames: "page-[hash].js",
        chunkFileNames: "page-[hash].js",
        assetFileNames: "page-[hash][extname]",
      },
    },
    // Data addresses would be needless exceptions in the content security policy.
    assetsInlineLimit: 0,
    modulePreload: false,
    // three.js, which is loaded where a scene is played.
    chunkSizeWarningLimit: 700,
    // What the page is made of asks to be named wherever it is shipped.
    license: { fileName: "licences.md" },
  },
  server: {
    host: "127.0.0.1",
    proxy: { "/api": { target: server, changeOrigin: true, headers: { origin: server } } },
  },
});
