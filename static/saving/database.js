/** The browser's own database, as promises. Private windows may refuse it: then `open` throws. */
const NAME = "ground-truth-marker";
const VERSION = 3;

export const FRAMES = "frames"; // edits not yet acknowledged, one record per tab, layer and frame
export const HISTORIES = "histories"; // undo and redo, one record per tab and layer
export const DISMISSED = "dismissed"; // warnings the annotator has looked at, one record per layer

export async function openDatabase() {
  const request = indexedDB.open(NAME, VERSION);
  request.onupgradeneeded = ({ oldVersion }) => upgrade(request.result, oldVersion);
  return new Database(await answer(request));
}

class Database {
  constructor(connection) {
    this._connection = connection;
    this.isOpen = true;
    // Another tab with a newer program wants to upgrade: let it, instead of blocking it for ever.
    connection.onversionchange = () => {
      connection.close();
      this.isOpen = false;
    };
    connection.onclose = () => (this.isOpen = false); // the browser threw it away: storage cleared, disk full
  }

  put(store, value) {
    return this._run(store, "readwrite", (objects) => objects.put(value));
  }

  /** Write one value (unless null) and delete others: both or nothing. */
  replace(store, value, keys) {
    return this._run(store, "readwrite", (objects) => {
      const requests = keys.map((key) => objects.delete(key));
      return value ? objects.put(value) : requests.at(-1);
    });
  }

  delete(store, key) {
    return this._run(store, "readwrite", (objects) => objects.delete(key));
  }

  get(store, key) {
    return this._run(store, "readonly", (objects) => objects.get(key));
  }

  ofLayer(store, layer) {
    return this._run(store, "readonly", (objects) => objects.index("layer").getAll(layer));
  }

  _run(store, mode, work) {
    const transaction = this._connection.transaction(store, mode, { durability: "relaxed" });
    const request = work(transaction.objectStore(store));
    if (mode === "readwrite") transaction.commit(); // or it is lost when the page goes away now
    return new Promise((resolve, reject) => {
      transaction.oncomplete = () => resolve(request.result);
      transaction.onabort = transaction.onerror = () => reject(transaction.error);
    });
  }
}

/** Edits nobody has yet are carried through every version; undo steps and dismissed warnings are not worth that. */
function upgrade(database, from) {
  const make = (name, keyPath) => database.createObjectStore(name, { keyPath });
  if (from < 1) make(FRAMES, ["layer", "tab", "frame"]).createIndex("layer", "layer");
  for (const name of [HISTORIES, DISMISSED])
    if (database.objectStoreNames.contains(name)) database.deleteObjectStore(name);
  make(HISTORIES, ["layer", "tab"]).createIndex("layer", "layer");
  make(DISMISSED, "layer");
}

function answer(request) {
  return new Promise((resolve, reject) => {
    request.onsuccess = () => resolve(request.result);
    request.onerror = request.onblocked = () => reject(request.error ?? new Error("database blocked"));
  });
}
