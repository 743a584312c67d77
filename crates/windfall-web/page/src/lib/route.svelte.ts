/**
 * Addresses within the page: `#/` and `#/c/CAMPAIGN/PART` or `#/c/CAMPAIGN/PART/ITEM`,
 * where the item is an impact or a file.
 */

export const PARTS = [
  "overview",
  "recordings",
  "import",
  "impact",
  "table",
  "laws",
  "regress",
  "surface",
  "calibrate",
  "report",
] as const;
export type Part = (typeof PARTS)[number];

export interface Route {
  campaign: string | null;
  part: Part;
  item: string | null;
}

function routeOf(hash: string): Route {
  let words: string[];
  try {
    words = hash.replace(/^#\/?/, "").split("/").map(decodeURIComponent);
  } catch {
    words = []; // not an address that this page wrote
  }
  const [start, campaign, part, item] = words;
  if (start !== "c" || !campaign) return { campaign: null, part: "overview", item: null };
  const known = PARTS.find((each) => each === part) ?? "overview";
  return { campaign, part: known, item: item ? item : null };
}

class Router {
  route = $state<Route>(routeOf(location.hash));
  /** Asked before the address changes; unsaved work may refuse. */
  #guards = new Set<() => string | null>();
  #left = location.hash;

  constructor() {
    window.addEventListener("hashchange", () => {
      if (location.hash === this.#left) return;
      const loss = [...this.#guards].map((guard) => guard()).find((words) => words !== null);
      if (loss && !window.confirm(loss)) {
        history.replaceState(null, "", this.#left || "#/");
        return;
      }
      this.#left = location.hash;
      this.route = routeOf(location.hash);
    });
    window.addEventListener("beforeunload", (event) => {
      if ([...this.#guards].some((guard) => guard() !== null)) event.preventDefault();
    });
  }

  /** `guard` tells what would be lost by leaving, or null; the result ends it. */
  guard(guard: () => string | null): () => void {
    this.#guards.add(guard);
    return () => this.#guards.delete(guard);
  }
}

export const router = new Router();

/** Address of a part of a campaign. */
export function address(campaign: string, part: Part = "overview", item?: string): string {
  const words = ["c", campaign, part, ...(item === undefined ? [] : [item])];
  return "#/" + words.map(encodeURIComponent).join("/");
}

export function go(to: string): void {
  location.hash = to;
}
