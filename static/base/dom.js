/**
 * @typedef {Node|string|null|undefined} Child
 * @typedef {{[name: `data-${string}`|`aria-${string}`]: string|number|boolean|null|undefined, for?: string}} Attributes
 */
/**
 * @template {Element} Made
 * @typedef {{[Name in keyof Made]?: Made[Name]|null} & Attributes} Properties
 */

/**
 * Make an element: properties are set as such, `data-…`, `aria-…`, `role` and `for` as attributes, `on…` as
 * listeners; `undefined` and `null` children are left out.
 * @template {keyof HTMLElementTagNameMap} Tag
 * @param {Tag} tag @param {Properties<HTMLElementTagNameMap[Tag]>} [properties] @param {(Child|Child[])[]} children
 */
export function element(tag, properties = {}, ...children) {
  const node = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) setProperty(node, name, value);
  node.append(...children.flat().filter((child) => child !== undefined && child !== null));
  return node;
}

/** @param {HTMLElement} node @param {string} name @param {unknown} value */
function setProperty(node, name, value) {
  if (value === undefined || value === null) return;
  if (name.startsWith("on")) node.addEventListener(name.slice(2), /** @type {EventListener} */ (value));
  else if (/^(data-|aria-|role$|for$)/.test(name)) node.setAttribute(name, String(value));
  else Object.assign(node, { [name]: value });
}

/**
 * Change a text only when it differs: screen readers repeat a live region that is merely written again.
 * @param {Node} node @param {string} text
 */
export function setText(node, text) {
  if (node.textContent !== text) node.textContent = text;
}

/**
 * What a page is known to have; TypeError where it is missing.
 * @template {Element} Kind
 * @param {ParentNode} root @param {string} selector @param {new () => Kind} kind its class, as HTMLInputElement
 */
export function required(root, selector, kind) {
  const node = root.querySelector(selector);
  if (!(node instanceof kind)) throw new TypeError(`there is no ${selector}`);
  return node;
}

/**
 * What the server wrote into the page under this id.
 * @param {string} id
 */
export function pageJson(id) {
  return JSON.parse(required(document, `#${id}`, HTMLScriptElement).text);
}
