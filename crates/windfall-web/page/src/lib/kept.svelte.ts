/** Results of long work that stay while the page is open, so that going to another
 *  part and back does not ask for them again. */

import type { JobView, Work } from "../api/types";

// Results are large and never change: they need no watching within.
let kept = $state.raw<Record<string, JobView>>({});

export const keep = (job: JobView): void => {
  kept = { ...kept, [`${job.campaign}/${job.work}`]: job };
};

export const keptJob = <W extends Work>(campaign: string, work: W) =>
  (kept[`${campaign}/${work}`] ?? null) as Extract<JobView, { work: W }> | null;
