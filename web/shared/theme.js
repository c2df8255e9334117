/** Okabe and Ito's palette, which the colour-blind tell apart; on white its light colours are darkened so that each
 * has a contrast of 3 to 1 at least. */
export const palettes = {
  light: ['#0072b2', '#d55e00', '#00855f', '#b0568a', '#8a6d00', '#2f7fb0', '#000000', '#7a4a2a'],
  dark: ['#56b4e9', '#e69f00', '#2fc49a', '#f0a3d0', '#f0e442', '#7fa8ff', '#ffffff', '#ff8a5c'],
};

/** Solid, dashed, ...: what tells curves apart where colours do not. */
export const dashes = [[], [6, 4], [2, 3], [10, 3, 2, 3]];

const asked = window.matchMedia('(prefers-color-scheme: dark)');

/** 'light' or 'dark': what was chosen here, else what the system asks for; on paper light. */
export function theme() {
  return document.documentElement.dataset.theme ?? (asked.matches ? 'dark' : 'light');
}

/** Calls back when the theme changes, also for printing. */
export function onThemeChange(callback) {
  asked.addEventListener('change', callback);
  const observer = new MutationObserver(callback);
  observer.observe(document.documentElement, { attributeFilter: ['data-theme'] });
}

/** A button that goes through system, light, dark. */
export function themeButton(button) {
  const root = document.documentElement;
  const say = () => {
    const chosen = root.dataset.theme;
    button.textContent = `Theme: ${chosen ?? 'as the system'}`;
  };
  button.addEventListener('click', () => {
    const next = { undefined: 'light', light: 'dark', dark: undefined }[root.dataset.theme];
    if (next) root.dataset.theme = next;
    else delete root.dataset.theme;
    say();
  });
  say();
}

/** A colour of the style sheet. */
export function cssColour(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}
