/**
 * What several parts of the page share: notices, jobs, and the campaign that is open.
 *
 * A view asks `openCampaign(id)` for its campaign and reads `view` and `results`, which
 * are reloaded whenever the files change on disk.
 */

import { Failed, admission, api, follow, watch } from "../api/calls";
import type { About, CampaignView, JobView, JobGiven, StoredResults } from "../api/types";

interface Notice {
  key: number;
  kind: "error" | "done" | "note";
  text: string;
}

/** Message of a failure for the user, or null if there is nothing to say. */
export function wordsOf(error: unknown): string | null {
  if (error instanceof Failed) {
    if (error.problem.status === 401) return "windfall needs its new token, as told above.";
    return error.problem.detail;
  }
  if (error instanceof DOMException && error.name === "AbortError") return null;
  return error instanceof Error ? error.message : String(error);
}

class Notices {
  list = $state<Notice[]>([]);
  #next = 0;

  /** Shows a failure until it is closed; its key, if there is something to say. */
  error(error: unknown): number | null {
    const text = wordsOf(error);
    return text === null ? null : this.#add("error", text);
  }

  done(text: string): void {
    const key = this.#add("done", text);
    setTimeout(() => this.drop(key), 6000);
  }

  /** Tells something that is no failure, until it is closed. */
  note(text: string): void {
    this.#add("note", text);
  }

  drop(key: number): void {
    this.list = this.list.filter((notice) => notice.key !== key);
  }

  #add(kind: Notice["kind"], text: string): number {
    // Each text once: an unreachable server would fill the page with it.
    const same = this.list.find((notice) => notice.kind === kind && notice.text === text);
    if (same) return same.key;
    const key = this.#next++;
    this.list = [...this.list, { key, kind, text }];
    return key;
  }
}

export const notices = new Notices();

/** Runs `work`; a failure is shown to the user, and the answer is then null. */
export async function attempt<T>(work: () => Promise<T>): Promise<T | null> {
  try {
    return await work();
  } catch (error) {
    notices.error(error);
    return null;
  }
}

class Jobs {
  /** Those that run, and those that ended while the page was open. */
  list = $state<JobView[]>([]);
  running = $derived(this.list.filter((job) => job.state === "running"));

  /** Starts a job and follows it; answers it once it has ended, however it ended. */
  async run(campaign: string, request: JobGiven): Promise<JobView> {
    const job = await api.start(campaign, request);
    return this.#follow(job);
  }

  async cancel(job: string): Promise<void> {
    const ended = await attempt(() => api.cancel(job));
    if (ended) this.#put(ended);
  }

  /** Adopts jobs started by another window or before a reload. */
  async adopt(): Promise<void> {
    for (const job of await api.jobs()) {
      if (job.state === "running" && !this.list.some((known) => known.job === job.job)) {
        void this.#follow(job).catch((error: unknown) => notices.error(error));
      }
    }
  }

  async #follow(job: JobView): Promise<JobView> {
    this.#put(job);
    try {
      const ended = await follow(job.job, (progress) => this.#put(progress));
      this.#put(ended);
      if (ended.state === "failed") notices.error(new Error(ended.problem ?? "the work failed"));
      if (ended.state === "cancelled") notices.done("Cancelled; nothing half-done was kept.");
      return ended;
    } catch (error) {
      this.list = this.list.filter((known) => known.job !== job.job);
      throw error;
    }
  }

  #put(job: JobView): void {
    const index = this.list.findIndex((known) => known.job === job.job);
    // A cancelled job may still report earlier progress.
    if (index >= 0 && this.list[index]!.state !== "running" && job.state === "running") return;
    this.list = index < 0 ? [...this.list, job] : this.list.with(index, job);
  }
}

export const jobs = new Jobs();

/** One campaign as last read from the server. */
export class OpenCampaign {
  view = $state.raw<CampaignView | null>(null);
  results = $state.raw<StoredResults | null>(null);
  /** Why it could not be read. */
  problem = $state<string | null>(null);
  /** Counts changes of files or results, for what views load themselves. */
  changes = $state(0);
  /** Whether the server is unreachable; the browser keeps trying. */
  lost = $state(false);
  /** What is told of its files as long as they cannot be read. */
  #told: number | null = null;
  /** Counts loads and changes as they begin; the newest that was taken. */
  #begun = 0;
  #taken = 0;
  readonly #end: () => void;

  constructor(readonly id: string) {
    void this.load();
    this.#end = watch(
      id,
      () => void this.load(),
      (there) => {
        // Changes while disconnected are read on reconnecting.
        if (there && this.lost) void this.load();
        this.lost = !there;
      },
    );
  }

  async load(): Promise<void> {
    const own = ++this.#begun;
    try {
      const [view, results] = await Promise.all([api.campaign(this.id), api.results(this.id)]);
      // Loads overlap: one that began earlier and ends later knows less.
      if (own < this.#taken) return;
      this.#taken = own;
      this.view = view;
      this.results = results;
      this.problem = null;
      this.changes += 1;
      this.#settle();
    } catch (error) {
      if (own < this.#taken) return;
      // Keep what is shown: a file may be half written at this moment.
      if (this.view === null) this.problem = wordsOf(error);
      else {
        this.#settle();
        this.#told = notices.error(error);
      }
    }
  }

  #settle(): void {
    if (this.#told !== null) notices.drop(this.#told);
    this.#told = null;
  }

  /** Takes the answer to a change made through the page. */
  changed(view: CampaignView): void {
    this.#taken = ++this.#begun;
    this.view = view;
    void this.load();
  }

  close(): void {
    this.#settle();
    this.#end();
  }
}

let open: OpenCampaign | null = null;

/** The campaign of this address; one is open at a time. */
export function openCampaign(id: string): OpenCampaign {
  if (open?.id !== id) {
    open?.close();
    open = new OpenCampaign(id);
  }
  return open;
}

class Program {
  about = $state.raw<About | null>(null);
  problem = $state<string | null>(null);
  /** Whether it refuses this window, because it has another token now. */
  refused = $state(false);

  async load(): Promise<void> {
    try {
      this.about = await api.about();
      this.problem = null;
      await jobs.adopt();
    } catch (error) {
      this.problem = wordsOf(error);
    }
  }
}

/** The program that answers: version, limits, kinds, laws. */
export const program = new Program();
admission.told = (refused) => {
  program.refused = refused;
};
