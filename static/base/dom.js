/**
 * Make an element: properties are set as such, `data-…`, `aria-…`, `role` and `for` as attributes, `on…` as
 * listeners; `undefined` and `null` children are left out.
 */
export function element(tag, properties = {}, ...children) {
  const node = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) setProperty(node, name, value);
  node.append(...children.flat().filter((child) => child !== undefined && child !== null));
  return node;
}

function setProperty(node, name, value) {
  if (value === undefined || value === null) return;
  if (name.startsWith("on")) node.addEventListener(name.slice(2), value);
  else if (/^(data-|aria-|role$|for$)/.test(name)) node.setAttribute(name, value);
  else node[name] = value;
}

/** Change a text only when it differs: screen readers repeat a live region that is merely written again. */
export function setText(node, text) {
  if (node.textContent !== text) node.textContent = text;
}
