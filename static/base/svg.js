const NAMESPACE = "http://www.w3.org/2000/svg";

/**
 * @param {string} tag @param {{[name: string]: string|number}} [attributes] @param {(Node|string)[]} children
 * @returns {SVGElement}
 */
export function svg(tag, attributes = {}, ...children) {
  const node = document.createElementNS(NAMESPACE, tag);
  for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, String(value));
  node.append(...children);
  return node;
}
