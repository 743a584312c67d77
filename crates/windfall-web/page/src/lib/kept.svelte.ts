/** Results of jobs: kept while the page is open, and the newest of each kind in the
 *  campaign's store, from where they are opened again. */

import { api } from "../api/calls";
import type { JobView, Work } from "../api/types";
import { attempt } from "./state.svelte";

interface Kept {
  job: JobView;
  /** When it was calculated, where the store says so; UTC. */
  time: string | null;
  /** Whether the campaign has changed since. */
  stale: boolean;
}

// Results are large and never change: no deep reactivity.
let kept = $state.raw<Record<string, Kept>>({});

const keyOf = (job: JobView) => `${job.campaign}/${job.work}`;

export const keep = (job: JobView): void => {
  kept = { ...kept, [keyOf(job)]: { job, time: null, stale: false } };
};

/** Opens what the store of a campaign holds. */
export async function reopen(campaign: string): Promise<void> {
  const found = await attempt(() => api.kept(campaign));
  if (found === null) return;
  // A campaign keeps its results when its directory gets another name.
  const named = found.map((own) => ({ ...own, job: { ...own.job, campaign } }));
  kept = { ...kept, ...Object.fromEntries(named.map((own) => [keyOf(own.job), own])) };
}

export const keptJob = <W extends Work>(campaign: string, work: W) =>
  (kept[`${campaign}/${work}`]?.job ?? null) as Extract<JobView, { work: W }> | null;

/** When a result was calculated, and whether it is outdated. */
export const keptState = (campaign: string, work: Work): Omit<Kept, "job"> | null =>
  kept[`${campaign}/${work}`] ?? null;
