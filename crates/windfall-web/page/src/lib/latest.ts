/** Requests that are made faster than they are answered: the newest wins. */

interface Latest<T> {
  /** Makes a request once the running one is done; only the newest waits. */
  ask: (work: (signal: AbortSignal) => Promise<T>) => void;
  /** Drops the running and the waiting request. */
  stop: () => void;
}

/** * `answered`, `failed`: called with the outcome of the newest request
 *  * `cancel`: whether the running request is aborted for a newer one; otherwise its
 *    answer is shown too, so that the picture follows a slider */
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
