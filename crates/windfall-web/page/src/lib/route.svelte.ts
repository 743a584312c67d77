/**
 * Addresses within the page: `#/`, `#/c/CAMPAIGN/PART` or `#/c/CAMPAIGN/PART/ITEM`,
 * where the item is a row of impacts.csv or a file, and `#/s/SCENE`.
 */

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

function routeOf(hash: string): Route {
  let words: string[];
  try {
    words = hash.replace(/^#\/?/, "").split("/").map(decodeURIComponent);
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

/** Address of a scene. */
export const sceneAddress = (id: string) => `#/s/${encodeURIComponent(id)}`;

export function go(to: string): void {
  location.hash = to;
}
