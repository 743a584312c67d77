import { api } from "../api/calls";
import type { Refit, LiveOutcome } from "../api/types";
import { wordsOf } from "./state.svelte";

/**
 * Fits of one impact as the user changes what is fitted. One request is under way at a
 * time; of those asked for meanwhile the newest is sent next, so that what is drawn is
 * never older than one fit.
 */
export class Refitter {
  view = $state.raw<LiveOutcome | null>(null);
  /** Why the newest request failed. */
  problem = $state<string | null>(null);
  busy = $state(false);
  /** Whether measured series and residuals belong to the fit that is shown. */
  complete = $state(false);
  #waiting: { id: string; request: Refit; laws: string[]; at: number | null } | null = null;

  /** `laws`: the expressions that are fitted, also where the request leaves them to the
   *  campaign; `at`: time stamp of the event, to measure how long the answer takes to
   *  appear. */
  ask(id: string, request: Refit, laws: string[], at: number | null = null): void {
    this.#waiting = { id, request, laws, at };
    if (!this.busy) void this.#work();
  }

  async #work(): Promise<void> {
    this.busy = true;
    while (this.#waiting) {
      const { id, request, laws, at } = this.#waiting;
      this.#waiting = null;
      try {
        const answer = await api.refit(id, request);
        this.#show(answer, laws, request.series ?? false);
        if (at !== null) afterPaint(() => performance.measure("refit", { start: at }));
      } catch (error) {
        this.problem = wordsOf(error);
      }
    }
    this.busy = false;
  }

  #show(fitted: LiveOutcome, laws: string[], series: boolean): void {
    const before = this.view;
    // With its given values, as requested.
    const named = fitted.laws.map((law, index) => ({ ...law, law: laws[index] ?? law.law }));
    const answer = { ...fitted, laws: named };
    this.problem = null;
    this.complete = series;
    if (series || before?.impact !== answer.impact) {
      this.view = answer;
      return;
    }
    // The measured series do not depend on the window; residuals stay until those of
    // the last fit arrive.
    this.view = {
      ...answer,
      measured: before.measured,
      laws: answer.laws.map((law, index) => ({
        ...law,
        residuals: before.laws[index]?.law === law.law ? before.laws[index].residuals : {},
      })),
    };
  }
}

/** Calls back once the current frame has been painted. */
function afterPaint(work: () => void): void {
  requestAnimationFrame(() => {
    const channel = new MessageChannel();
    channel.port1.onmessage = () => {
      channel.port1.close();
      work();
    };
    channel.port2.postMessage(null);
  });
}
