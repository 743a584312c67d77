/** What the guide says of findings: asked for when the first of them is opened. */

import { api } from "../api/calls";
import type { Explanation } from "../api/types";
import { wordsOf } from "./state.svelte";

class Explanations {
  loaded = $state(false);
  problem = $state<string | null>(null);
  #all = $state.raw<Explanation[]>([]);
  #asked = false;

  load(): void {
    if (this.#asked) return;
    this.#asked = true;
    api.findings().then(
      (all) => {
        this.#all = all;
        this.loaded = true;
        this.problem = null;
      },
      (error: unknown) => {
        this.problem = wordsOf(error);
        // The next one that is opened asks again.
        this.#asked = false;
      },
    );
  }

  of(code: string): Explanation[] {
    return this.#all.filter((each) => each.code === code);
  }
}

export const explanations = new Explanations();
