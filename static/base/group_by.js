/**
 * What Map.groupBy does, which browsers of 2023 lack.
 * @template Item, Key
 * @param {Iterable<Item>} items @param {(item: Item) => Key} keyOf
 */
export function groupBy(items, keyOf) {
  /** @type {Map<Key, Item[]>} */
  const groups = new Map();
  for (const item of items) {
    const key = keyOf(item);
    const group = groups.get(key);
    if (group) group.push(item);
    else groups.set(key, [item]);
  }
  return groups;
}
