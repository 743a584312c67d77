/** Results of jobs, kept while the page is open so that views need not ask again. */

import type { JobView, Work } from "../api/types";

// Results are large and never change: no deep reactivity.
let kept = $state.raw<Record<string, JobView>>({});

export const keep = (job: JobView): void => {
  kept = { ...kept, [`${job.campaign}/${job.work}`]: job };
};

export const keptJob = <W extends Work>(campaign: string, work: W) =>
  (kept[`${campaign}/${work}`] ?? null) as Extract<JobView, { work: W }> | null;
