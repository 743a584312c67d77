/** Results of long work that stay while the page is open, so that going to another
 *  part and back does not ask for them again. */

import type { Job, Work } from "../api";

// Results are large and never change: they need no watching within.
let kept = $state.raw<Record<string, Job>>({});

export const keep = (job: Job): void => {
  kept = { ...kept, [`${job.campaign}/${job.work}`]: job };
};

export const keptJob = (campaign: string, work: Work): Job | null => kept[`${campaign}/${work}`] ?? null;
