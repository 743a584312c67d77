/**
 * Addresses within the page: `#/`, `#/c/CAMPAIGN/PART` or `#/c/CAMPAIGN/PART/ITEM`,
 * where the item is a row of impacts.csv or a file, and `#/s/SCENE`. Behind a "?" stands
 * what the view shows of it (`?laws=hertz&t=0.01..0.02`): each view says what that is by
 * `hold`. Going to another place makes an entry of the browser's history; what changes
 * within a view replaces the entry.
 */

import { untrack } from "svelte";

const PARTS = [
  "overview",
  "recordings",
  "import",
  "impact",
  "item",
  "table",
  "laws",
  "regress",
  "surface",
  "calibrate",
  "report",
] as const;
export type Part = (typeof PARTS)[number];

interface Route {
  campaign: string | null;
  scene: string | null;
  part: Part;
  item: string | null;
}

/** State of a view as words, by key; `null` where it is as usual. */
export type Held = Record<string, string | null>;

/** The address without its "#/", before and behind the first "?". */
function partsOf(hash: string): [string, string] {
  const text = hash.replace(/^#\/?/, "");
  const end = text.indexOf("?");
  return end < 0 ? [text, ""] : [text.slice(0, end), text.slice(end + 1)];
}

function routeOf(hash: string): Route {
  let words: string[];
  try {
    words = partsOf(hash)[0].split("/").map(decodeURIComponent);
  } catch {
    words = []; // not an address that this page wrote
  }
  const [start, campaign, part, item] = words;
  const none: Route = { campaign: null, scene: null, part: "overview", item: null };
  if (start === "s" && campaign) return { ...none, scene: campaign };
  if (start !== "c" || !campaign) return none;
  const known = PARTS.find((each) => each === part) ?? "overview";
  return { campaign, scene: null, part: known, item: item ? item : null };
}

function queryOf(hash: string): Record<string, string> {
  const pairs = partsOf(hash)[1].split("&").map((pair) => {
    const [key = "", ...value] = pair.split("=");
    try {
      return [decodeURIComponent(key), decodeURIComponent(value.join("="))];
    } catch {
      return ["", ""]; // not an address that this page wrote
    }
  });
  return Object.fromEntries(pairs.filter(([key]) => key !== ""));
}

/** As it stands in an address: what may stand there stays readable. */
const written = (text: string) =>
  encodeURIComponent(text).replace(/%(2C|3A|3B|2F|3D|40|24)/g, (of) => decodeURIComponent(of));

/** Least time between two changes of the address; ms. Browsers refuse hundreds at once. */
const PAUSE = 200;

class Router {
  route = $state.raw<Route>(routeOf(location.hash));
  /** Counts addresses that were gone to. */
  visits = $state(0);
  #query = queryOf(location.hash);
  #path = partsOf(location.hash)[0];
  #due: ReturnType<typeof setTimeout> | undefined;

  constructor() {
    window.addEventListener("hashchange", () => {
      const held = this.hash() === location.hash;
      clearTimeout(this.#due);
      this.#due = undefined;
      this.#query = queryOf(location.hash);
      this.#path = partsOf(location.hash)[0];
      if (held) return;
      this.route = routeOf(location.hash);
      this.visits += 1;
    });
    // Links and reloading leave the address behind: it then says all.
    for (const event of ["click", "pagehide"]) window.addEventListener(event, () => this.flush(), true);
  }

  /** What the address holds of the view. */
  get query(): Readonly<Record<string, string>> {
    return this.#query;
  }

  /** Holds some keys in the address, in the place of what it held under them. */
  put(held: Held): void {
    const next = { ...this.#query };
    for (const [key, text] of Object.entries(held)) {
      if (text === null) delete next[key];
      else next[key] = text;
    }
    if (JSON.stringify(next) === JSON.stringify(this.#query)) return;
    this.#query = next;
    this.#due ??= setTimeout(() => this.flush(), PAUSE);
  }

  /** The address with all that it holds. */
  hash(): string {
    const pairs = Object.entries(this.#query).map(([key, text]) => `${written(key)}=${written(text)}`);
    return `#/${this.#path}${pairs.length === 0 ? "" : `?${pairs.join("&")}`}`;
  }

  /** Writes it into the browser's address now, unless that has gone elsewhere. */
  flush(): void {
    if (this.#due === undefined) return;
    clearTimeout(this.#due);
    this.#due = undefined;
    if (partsOf(location.hash)[0] === this.#path) history.replaceState(history.state, "", this.hash());
  }
}

export const router = new Router();

const placeOf = ({ campaign, scene, part }: Route) => JSON.stringify([campaign, scene, part]);

/**
 * Keeps the state of a view in the address, and takes it from there: when the view begins,
 * and when one goes back or to another address of the same view. For use while a component
 * is set up.
 *
 * * `get`: the state; `null` while it is not known yet, which leaves the address as it is
 * * `set`: takes the state of an address; `again`: whether the view was there before
 */
export function hold(
  get: () => Held | null,
  set: (held: Readonly<Record<string, string>>, again: boolean) => void,
): void {
  const place = untrack(() => placeOf(router.route));
  let visit = untrack(() => router.visits);
  untrack(() => set(router.query, false));
  $effect(() => {
    const now = router.visits;
    const held = get();
    untrack(() => {
      // A view that is being left has no part in the next address.
      if (placeOf(router.route) !== place) return;
      if (now === visit) {
        if (held) router.put(held);
        return;
      }
      visit = now;
      set(router.query, true);
      const taken = get();
      if (taken) router.put(taken);
    });
  });
}

/** Address of a part of a campaign. */
export function address(campaign: string, part: Part = "overview", item?: string): string {
  const words = ["c", campaign, part, ...(item === undefined ? [] : [item])];
  return "#/" + words.map(encodeURIComponent).join("/");
}

/** Address of a scene. */
export const sceneAddress = (id: string) => `#/s/${encodeURIComponent(id)}`;

export function go(to: string): void {
  router.flush();
  location.hash = to;
}
