// Not a module: it runs before the first paint, so that no page flashes in the other colours.
(() => {
  const KEY = "gtm-theme";
  const THEMES = ["dark", "light", "system"];
  const DARK = THEMES[0];
  const root = document.documentElement;

  const read = () => {
    try {
      const stored = localStorage.getItem(KEY) ?? DARK;
      return THEMES.includes(stored) ? stored : DARK;
    } catch {
      return DARK; // storage may be forbidden
    }
  };

  const shown = () => root.dataset.theme ?? DARK;

  /** @param {string} theme */
  const write = (theme) => {
    root.dataset.theme = theme;
    try {
      localStorage.setItem(KEY, theme);
    } catch {
      // the choice then lasts for this page only
    }
  };

  root.dataset.theme = read();

  document.addEventListener("DOMContentLoaded", () => {
    /** @type {HTMLButtonElement|null} */
    const button = document.querySelector("[data-theme-button]");
    if (!button) return;
    const show = () => {
      button.textContent = button.dataset[shown()] ?? "";
    };
    button.hidden = false;
    show();
    button.addEventListener("click", () => {
      const now = THEMES.indexOf(shown());
      write(THEMES[(now + 1) % THEMES.length]);
      show();
    });
  });
})();
