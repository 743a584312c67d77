import { untrack } from "svelte";
import { api } from "../api/calls";
import type { CampaignView } from "../api/types";
import { gone, listOf, listText } from "./held";
import { CHOICES, COST_QUANTITIES, changesOf, draftOf, lawName, type Draft } from "./options";
import { hold } from "./route.svelte";
import { save } from "./save";
import { notices, program, type OpenCampaign } from "./state.svelte";

/** Laws and options in a form. Entries that are not saved stay, whatever happens to the
 *  file; without any, the form follows the file. The address holds them. Made while a
 *  component starts. */
export class OptionsDraft {
  draft = $state() as Draft;
  #base = $state.raw() as Draft;
  altered = $derived(JSON.stringify(this.draft) !== JSON.stringify(this.#base));
  readonly #campaign: () => OpenCampaign;

  /** `taken`: called when entries come from an address that was gone to. */
  constructor(campaign: () => OpenCampaign, taken?: () => void) {
    this.#campaign = campaign;
    this.undo();
    hold(
      () => this.#held(),
      (held, again) => {
        if (this.#take(held) && again) taken?.();
      },
    );
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

  #held() {
    const { changes } = this;
    const words = (value: string | string[] | null | undefined) =>
      Array.isArray(value) ? (listText(value) ?? "none") : (value ?? null);
    return Object.fromEntries(
      (Object.keys(this.draft) as (keyof Draft)[]).map((key) => [key, words(changes[key])]),
    );
  }

  /** Takes entries from an address; what does not fit the campaign any more is told. Entries
   *  that it does not name stay. */
  #take(held: Readonly<Record<string, string>>): boolean {
    const lost: string[] = [];
    const next = $state.snapshot(this.draft);
    for (const key of Object.keys(next) as (keyof Draft)[]) {
      const words = held[key];
      if (words === undefined) continue;
      if (key === "laws" || key === "quantities" || key === "free") {
        const list = words === "none" ? [] : listOf(words);
        const fit = list.filter((each) => this.#fits(key, each));
        lost.push(...list.filter((each) => !fit.includes(each)));
        if (fit.length > 0 || key === "free") next[key] = fit;
      } else if (this.#fits(key, words)) next[key] = words;
      else lost.push(words);
    }
    if (lost.length > 0) notices.note(gone(lost));
    const taken = JSON.stringify(next) !== JSON.stringify(this.draft);
    this.draft = next;
    return taken;
  }

  #fits(key: keyof Draft, word: string): boolean {
    if (key === "laws") {
      const name = lawName(word);
      const known = program.about?.laws.some((law) => law.name === name);
      // The campaign's own laws are in its text.
      return known === true || this.#view.laws.some((law) => lawName(law) === name) || this.#view.text.includes(`${name}]`);
    }
    if (key === "quantities") return (COST_QUANTITIES as readonly string[]).includes(word);
    return key in CHOICES ? CHOICES[key as keyof typeof CHOICES].some(([known]) => known === word) : true;
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
