import { Failed } from "../api/calls";
import type { CampaignView } from "../api/types";
import { notices, type OpenCampaign } from "./state.svelte";

/**
 * Saves a part of a campaign's files. If they changed since they were read, they are
 * read again and the user is told; what the user entered stays where it is.
 * Answers whether it was saved.
 */
export async function save(
  campaign: OpenCampaign,
  work: (version: string) => Promise<CampaignView>,
  done: string,
): Promise<boolean> {
  const version = campaign.view?.version;
  if (version === undefined) return false;
  try {
    campaign.changed(await work(version));
    notices.done(done);
    return true;
  } catch (error) {
    if (error instanceof Failed && error.problem.status === 412) {
      await campaign.load();
      notices.error(
        new Error(
          "the campaign's files have changed, so nothing was saved. They have been read again and your entries are still here: check them and save again.",
        ),
      );
    } else {
      notices.error(error);
    }
    return false;
  }
}
