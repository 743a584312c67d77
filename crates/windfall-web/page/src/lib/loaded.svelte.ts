/** What a view asks of the server: asked anew when what it depends on changes. */

import { wordsOf } from "./state.svelte";

/** `ask` is called at once, and whenever a state that it reads before its first pause
 *  changes; only the newest answer counts. For use while a component is set up. */
export class Loaded<T> {
  value = $state.raw<T | null>(null);
  /** Why the newest request failed. */
  problem = $state<string | null>(null);
  #again = $state(0);

  constructor(ask: () => Promise<T> | null) {
    $effect(() => {
      void this.#again;
      const asked = ask();
      if (asked === null) return;
      let gone = false;
      asked.then(
        (answer) => {
          if (gone) return;
          this.value = answer;
          this.problem = null;
        },
        (error: unknown) => {
          if (!gone) this.problem = wordsOf(error);
        },
      );
      return () => {
        gone = true;
      };
    });
  }

  again(): void {
    this.#again += 1;
  }
}
