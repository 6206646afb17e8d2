// Colours come from the style sheet, so that light, dark and print need no second table here.

export function colour(name: string): string {
  return getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
}

// Contact force from 0 to the largest of the step: yellow, orange, red, plum. Lightness falls steadily.
const stops: [number, number, number][] = [
  [246, 200, 78],
  [240, 140, 56],
  [214, 69, 60],
  [163, 34, 104],
];

export function forceColour(fraction: number): string {
  const at = Math.min(Math.max(Number.isFinite(fraction) ? fraction : 0, 0), 1) * (stops.length - 1);
  const i = Math.min(Math.floor(at), stops.length - 2);
  const mix = stops[i].map((a, k) => Math.round(a + (stops[i + 1][k] - a) * (at - i)));
  return `rgb(${mix.join(',')})`;
}

export const forceGradient = `linear-gradient(90deg, ${[0, 1 / 3, 2 / 3, 1].map(forceColour).join(', ')})`;

/** Light, dark, or as the system says. */
export function nextTheme(): string {
  const root = document.documentElement;
  const dark = root.dataset.theme ? root.dataset.theme === 'dark' : matchMedia('(prefers-color-scheme: dark)').matches;
  root.dataset.theme = dark ? 'light' : 'dark';
  return root.dataset.theme;
}
