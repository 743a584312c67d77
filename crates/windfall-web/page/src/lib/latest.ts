/** Asks that follow each other faster than answers come: the newest wins. */

interface Latest<T> {
  /** Asks, after what runs now; asks in between are left out. */
  ask: (work: (signal: AbortSignal) => Promise<T>) => void;
  /** Forgets what was asked. */
  stop: () => void;
}

/** * `answered`: is told the answer, or the failure, of the newest that was asked
 *  * `cancel`: whether what runs is broken off for a newer one; otherwise its answer is
 *    shown too, so that something moves while a slider does */
export function latest<T>(
  answered: (answer: T) => void,
  failed: (error: unknown) => void,
  cancel: boolean,
): Latest<T> {
  let running: AbortController | null = null;
  let waiting: ((signal: AbortSignal) => Promise<T>) | null = null;

  async function run(work: (signal: AbortSignal) => Promise<T>): Promise<void> {
    const own = new AbortController();
    running = own;
    try {
      const answer = await work(own.signal);
      if (!own.signal.aborted) answered(answer);
    } catch (error) {
      if (!own.signal.aborted) failed(error);
    }
    if (running !== own) return;
    running = null;
    const next = waiting;
    waiting = null;
    if (next) void run(next);
  }

  return {
    ask(work) {
      if (!running) void run(work);
      else if (cancel) {
        running.abort();
        void run(work);
      } else waiting = work;
    },
    stop() {
      running?.abort();
      running = null;
      waiting = null;
    },
  };
}
