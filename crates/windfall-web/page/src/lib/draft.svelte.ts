import { untrack } from "svelte";
import { api } from "../api/calls";
import type { CampaignView } from "../api/types";
import { changesOf, draftOf, type Draft } from "./options";
import { save } from "./save";
import type { OpenCampaign } from "./state.svelte";

/** Laws and options in a form. Entries that are not saved stay, whatever happens to the
 *  file; without any, the form follows the file. Made while a component starts. */
export class OptionsDraft {
  draft = $state() as Draft;
  #base = $state.raw() as Draft;
  altered = $derived(JSON.stringify(this.draft) !== JSON.stringify(this.#base));
  readonly #campaign: () => OpenCampaign;

  constructor(campaign: () => OpenCampaign) {
    this.#campaign = campaign;
    this.undo();
    $effect(() => {
      const present = draftOf(this.#view);
      untrack(() => {
        if (!this.altered && JSON.stringify(present) !== JSON.stringify(this.#base)) this.undo();
        else this.#base = present;
      });
    });
  }

  get #view(): CampaignView {
    return this.#campaign().view!;
  }

  /** Differences between the form and the campaign. */
  get changes() {
    return changesOf($state.snapshot(this.draft), this.#view);
  }

  undo(): void {
    untrack(() => {
      this.draft = draftOf(this.#view);
      this.#base = draftOf(this.#view);
    });
  }

  save(): Promise<boolean> {
    const campaign = this.#campaign();
    return save(
      campaign,
      (version) => api.saveOptions(campaign.id, version, this.changes),
      "The options were saved into campaign.toml.",
    );
  }
}
