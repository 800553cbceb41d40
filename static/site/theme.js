// Not a module: it runs before the first paint, so that no page flashes in the other colours.
(() => {
  const KEY = "gtm-theme";
  const THEMES = ["dark", "light", "system"];

  const read = () => {
    try {
      const stored = localStorage.getItem(KEY);
      return THEMES.includes(stored) ? stored : "dark";
    } catch {
      return "dark"; // storage may be forbidden
    }
  };

  const write = (theme) => {
    document.documentElement.dataset.theme = theme;
    try {
      localStorage.setItem(KEY, theme);
    } catch {
      // the choice then lasts for this page only
    }
  };

  document.documentElement.dataset.theme = read();

  document.addEventListener("DOMContentLoaded", () => {
    const button = document.querySelector("[data-theme-button]");
    if (!button) return;
    const show = () => {
      button.textContent = button.dataset[document.documentElement.dataset.theme];
    };
    button.hidden = false;
    show();
    button.addEventListener("click", () => {
      const now = THEMES.indexOf(document.documentElement.dataset.theme);
      write(THEMES[(now + 1) % THEMES.length]);
      show();
    });
  });
})();
