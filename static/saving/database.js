/**
 * The browser's own database, as promises. Private windows may refuse it: then `open` throws.
 * @typedef {string|(string|number)[]} Key of a record
 * @typedef {object} Stored what the object stores hold
 * @property {import("./journal.js").FrameRecord} frames
 * @property {import("./journal.js").HistoryRecord} histories
 * @property {{layer: string, keys: string[]}} dismissed
 * @typedef {keyof Stored} StoreName
 */
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

export class Database {
  /** @param {IDBDatabase} connection */
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

  /** @param {StoreName} store @param {unknown} value */
  put(store, value) {
    return this._run(store, "readwrite", (objects) => objects.put(value));
  }

  /**
   * Write one value (unless null) and delete others: both or nothing.
   * @param {StoreName} store @param {unknown} value @param {Key[]} keys
   */
  replace(store, value, keys) {
    return this._run(store, "readwrite", (objects) => {
      /** @type {IDBRequest<undefined|IDBValidKey>[]} */
      const requests = [];
      for (const key of keys) requests.push(/** @type {IDBRequest<undefined|IDBValidKey>} */ (objects.delete(key)));
      if (value) requests.push(/** @type {IDBRequest<undefined|IDBValidKey>} */ (objects.put(value)));
      return requests[requests.length - 1];
    });
  }

  /** @param {StoreName} store @param {Key} key */
  delete(store, key) {
    return this._run(store, "readwrite", (objects) => objects.delete(key));
  }

  /** @template {StoreName} Name @param {Name} store @param {Key} key @returns {Promise<Stored[Name]|undefined>} */
  get(store, key) {
    return this._run(store, "readonly", (objects) => objects.get(key));
  }

  /** @template {StoreName} Name @param {Name} store @param {string} layer @returns {Promise<Stored[Name][]>} */
  ofLayer(store, layer) {
    return this._run(store, "readonly", (objects) => objects.index("layer").getAll(layer));
  }

  /**
   * @template Result
   * @param {StoreName} store @param {"readonly"|"readwrite"} mode @param {(objects: IDBObjectStore) => IDBRequest<Result>} work
   * @returns {Promise<Result>}
   */
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

/**
 * Edits nobody has yet are carried through every version; undo steps and dismissed warnings are not worth that.
 * @param {IDBDatabase} database @param {number} from
 */
function upgrade(database, from) {
  /** @param {StoreName} name @param {string|string[]} keyPath */
  const make = (name, keyPath) => database.createObjectStore(name, { keyPath });
  if (from < 1) make(FRAMES, ["layer", "tab", "frame"]).createIndex("layer", "layer");
  for (const name of [HISTORIES, DISMISSED])
    if (database.objectStoreNames.contains(name)) database.deleteObjectStore(name);
  make(HISTORIES, ["layer", "tab"]).createIndex("layer", "layer");
  make(DISMISSED, "layer");
}

/** @param {IDBOpenDBRequest} request @returns {Promise<IDBDatabase>} */
function answer(request) {
  return new Promise((resolve, reject) => {
    request.onsuccess = () => resolve(request.result);
    request.onerror = request.onblocked = () => reject(request.error ?? new Error("database blocked"));
  });
}
