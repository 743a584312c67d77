/** What a form asks of the rig of each kind of campaign. */

import { api } from "../api/calls";
import type { CampaignView, RigForm, RigKey } from "../api/types";
import { attempt } from "./state.svelte";

class Rigs {
  forms = $state.raw<RigForm[]>([]);
  #asked = false;

  load(): void {
    if (this.#asked) return;
    this.#asked = true;
    void attempt(() => api.rigs()).then((forms) => {
      this.forms = forms ?? [];
      this.#asked = forms !== null;
    });
  }

  of(kind: string): RigForm | null {
    return this.forms.find((form) => form.kind === kind) ?? null;
  }
}

export const rigs = new Rigs();

/** Kind of the rig of a campaign, as `windfall new` calls it. */
export const rigKind = (view: CampaignView) => view.rig.find(([key]) => key === "kind")?.[1] ?? view.kind;

/** A value in the parts that a form shows. */
export interface RigValue {
  number: string;
  /** Unit, or a word in place of number and unit. */
  unit: string;
}

export const isWord = (key: RigKey, value: RigValue) => key.words.includes(value.unit);

/** "0.5 kg" as number and unit; a unit that is not offered stays as it is. */
export function partsOf(key: RigKey, text: string): RigValue {
  if (key.words.includes(text)) return { number: "", unit: text };
  const [, number = "", unit = ""] = /^\s*([-+]?[\d.]+(?:[eE][-+]?\d+)?)?\s*(.*?)\s*$/.exec(text) ?? [];
  return { number, unit: unit === "" ? (key.units[0] ?? "") : unit };
}

/** The text of a value; empty where there is none. */
export function textOf(key: RigKey, { number, unit }: RigValue): string {
  if (key.words.includes(unit)) return unit;
  const typed = number.trim().replace(",", ".");
  return typed === "" ? "" : `${typed} ${unit}`.trim();
}

/** The unit that the example has, without its number: what a blank field begins with. */
export const blank = (key: RigKey): RigValue => ({
  number: "",
  unit: key.units.length > 0 ? partsOf(key, key.typical).unit : "",
});

/** What is wanting: keys without a value that are needed. */
export const wanting = (form: RigForm, values: Record<string, RigValue>) =>
  form.keys.filter((key) => key.needed && textOf(key, values[key.key] ?? blank(key)) === "");
