/**
 * Named events with plain values. Removing a listener while firing is safe: firing walks a copy.
 * @template {object} Events what each event carries, by its name
 */
export class Emitter {
  constructor() {
    /** @type {Map<keyof Events, ((value: any) => void)[]>} */
    this._listeners = new Map();
  }

  /**
   * @template {keyof Events} Name
   * @param {Name} name @param {(value: Events[Name]) => void} listener
   * @returns {() => void} removes the listener
   */
  on(name, listener) {
    const listeners = this._listeners.get(name) ?? [];
    this._listeners.set(name, [...listeners, listener]);
    return () => {
      this._listeners.set(
        name,
        (this._listeners.get(name) ?? []).filter((other) => other !== listener),
      );
    };
  }

  /**
   * @template {keyof Events} Name
   * @param {Name} name @param {Events[Name]} [value]
   */
  emit(name, value) {
    for (const listener of this._listeners.get(name) ?? []) listener(value);
  }
}
