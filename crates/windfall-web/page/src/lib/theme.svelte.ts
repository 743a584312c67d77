/** Light or dark: as the system says, unless the user chose. */

export type Choice = "system" | "light" | "dark";

const KEY = "windfall-theme";
const dark = window.matchMedia("(prefers-color-scheme: dark)");

function stored(): Choice {
  // Storage is refused in some private windows; the theme then follows the system.
  try {
    const word = localStorage.getItem(KEY);
    return word === "light" || word === "dark" ? word : "system";
  } catch {
    return "system";
  }
}

class Theme {
  choice = $state<Choice>(stored());
  #system = $state(dark.matches);
  /** The theme shown now; plots redraw when it changes. */
  shown = $derived(this.choice === "system" ? (this.#system ? "dark" : "light") : this.choice);

  constructor() {
    dark.addEventListener("change", (event) => {
      this.#system = event.matches;
      this.#apply();
    });
    this.#apply();
  }

  choose(choice: Choice): void {
    this.choice = choice;
    try {
      if (choice === "system") localStorage.removeItem(KEY);
      else localStorage.setItem(KEY, choice);
    } catch {
      // as above
    }
    this.#apply();
  }

  #apply(): void {
    document.documentElement.dataset["theme"] = this.shown;
  }
}

export const theme = new Theme();

/** Colours by theme and variable: looking them up is slow, and plots that follow the
 *  pointer do it often. */
const colours = new Map<string, string>();

/** Colour of a variable of app.css, for a canvas. Depends on the theme when asked
 *  for within an effect. */
export function colour(variable: string): string {
  const key = `${theme.shown} ${variable}`;
  let known = colours.get(key);
  if (known === undefined) {
    known = getComputedStyle(document.documentElement).getPropertyValue(variable).trim();
    colours.set(key, known);
  }
  return known;
}

/** Colour of a series; they repeat after seven. */
export function seriesColour(index: number): string {
  return colour(`--series-${(index % 7) + 1}`);
}
