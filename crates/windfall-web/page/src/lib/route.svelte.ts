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
  route = $state.raw<Route>(routeOf(location.hash));

  constructor() {
    window.addEventListener("hashchange", () => {
      this.route = routeOf(location.hash);
    });
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
