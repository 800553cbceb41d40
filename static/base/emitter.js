/** Named events with plain values. Removing a listener while firing is safe: firing walks a copy. */
export class Emitter {
  constructor() {
    this._listeners = new Map();
  }

  /** @returns {() => void} removes the listener */
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

  emit(name, value) {
    for (const listener of this._listeners.get(name) ?? []) listener(value);
  }
}
