import { mount } from "svelte";
import App from "./App.svelte";
import { copySelected } from "./lib/copy";
import { notices } from "./lib/state.svelte";
import "uplot/dist/uPlot.min.css";
import "./app.css";

// What fails outside of a view, in an answer to an event or a request, is told as well.
window.addEventListener("error", (event) => {
  // Without an error it is a remark of the browser on the layout.
  if (event.error != null) notices.error(event.error);
});
window.addEventListener("unhandledrejection", (event) => notices.error(event.reason));

document.addEventListener("copy", copySelected);

const target = document.getElementById("page");
if (target === null) throw new Error("index.html has no element #page");
mount(App, { target });
