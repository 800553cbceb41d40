import { backProject, Camera, project } from "../geometry/camera.js";
import { Grid } from "../geometry/grid.js";
import { rectangle, rectangleIn } from "../geometry/rectangle.js";
import { byPerson } from "./annotation.js";

/**
 * What does not change while annotating: cameras, grid, cylinder, frames; and the geometry between them.
 * @typedef {import("../base/answers.js").SceneAnswer} Answer
 * @typedef {import("../geometry/camera.js").AnyCamera} AnyCamera
 * @typedef {import("../geometry/rectangle.js").Rectangle} Rectangle
 * @typedef {{x: number, y: number}} XY
 * @typedef {Readonly<{position: number, height: number|null, radius: number|null}>} Placed as annotations are
 * @typedef {{height?: number|null, radius?: number|null}} Sizing metres; what is not said is as usual
 * @typedef {{number: number, people: import("./annotation.js").People}} Neighbour an accepted frame beside the batch
 * @typedef {{before: Neighbour[], after: Neighbour[]}} Neighbours
 * @typedef {object} AskedBoxes what answers for tables: see tables/own_sizes.js
 * @property {(index: number, placed: Placed) => Rectangle|null} rectangle
 * @property {(name: "change", listener: () => void) => unknown} on
 */
export class Scene {
  /**
   * @param {Answer} json
   * @param {Map<number, {camera: AnyCamera, boxes: Int16Array}>} [byTable] cameras of unknown models, with their boxes
   */
  constructor(json, byTable = new Map()) {
    this.mode = json.mode;
    this.dataset = json.dataset;
    this.layer = json.layer;
    this.assignment = json.assignment;
    this.editable = json.editable;
    this.readOnlyReason = json.read_only_reason;
    this.nextPerson = json.next_person;
    this.proposed = json.proposed ?? false; // whether there is anything to fetch
    this.frames = json.frames;
    /** @type {AnyCamera[]} */
    this.cameras = json.cameras.map((camera) => byTable.get(camera.index)?.camera ?? new Camera(camera));
    this._views = json.cameras;
    /** @type {(Int16Array|null)[]} */
    this._tables = json.cameras.map(({ index }) => byTable.get(index)?.boxes ?? null);
    this.grid = new Grid(json.grid);
    this.cylinder = json.cylinder;
    this.sizes = json.sizes; // {height, radius}: [least, most] metres a person may have
    this.footRule = json.foot_rule;
    this.neighbours = readNeighbours(json.neighbours);
    /** @type {WeakMap<Placed, (Rectangle|null)[]>} */
    this._rectangles = new WeakMap();
    /** @type {AskedBoxes|null} */
    this.ownSizes = null;
  }

  /**
   * Rectangles of one annotation in all views, `null` where not visible; computed once per annotation.
   * @param {Placed} annotation @returns {(Rectangle|null)[]}
   */
  rectangles(annotation) {
    let rectangles = this._rectangles.get(annotation);
    if (!rectangles) {
      rectangles = this.cameras.map((_, index) => this._rectangle(index, annotation));
      this._rectangles.set(annotation, rectangles);
    }
    return rectangles;
  }

  /**
   * The usual person is looked up, once the table is here; others are computed by the same rule.
   * @param {number} index of the camera @param {Placed} annotation
   */
  _rectangle(index, annotation) {
    const [camera, boxes] = [this.cameras[index], this._tables[index]];
    const usual = (annotation.height ?? annotation.radius ?? null) === null;
    if (boxes && usual) return rectangleIn(boxes, annotation.position);
    if (camera.byTable) return this.ownSizes?.rectangle(index, annotation) ?? null;
    return rectangle(camera, this.grid, this.cylinderOf(annotation), this.footRule, annotation.position);
  }

  /** @param {AskedBoxes} ownSizes what the tables do not hold */
  askFor(ownSizes) {
    this.ownSizes = ownSizes;
    ownSizes.on("change", () => (this._rectangles = new WeakMap()));
  }

  /** Cameras whose table is not here, as the server describes them. */
  wantedTables() {
    return this._views.filter(({ index }) => !this._tables[index]);
  }

  /** @param {number} index of the camera @param {Int16Array} boxes */
  useTable(index, boxes) {
    this._tables[index] = boxes;
  }

  /** @param {Sizing} annotation @returns {import("../geometry/rectangle.js").Cylinder} */
  cylinderOf(annotation) {
    return {
      radius: annotation.radius ?? this.cylinder.radius,
      height: annotation.height ?? this.cylinder.height,
    };
  }

  /**
   * Number of views in which the person is visible.
   * @param {Placed} annotation
   */
  seenBy(annotation) {
    return this.rectangles(annotation).filter((one) => one !== null).length;
  }

  /**
   * When a frame was taken, seconds from number 0.
   * @param {number} number
   */
  seconds(number) {
    return (number / this.dataset.frame_step) * this.dataset.seconds_per_frame;
  }

  /** @param {number} position */
  metres(position) {
    return this.grid.metres(position);
  }

  /**
   * Ground point → image pixel, or null when it is not in front of the camera.
   * @param {number} index of the camera @param {XY} ground metres @param {number} [z]
   */
  toImage(index, ground, z = 0) {
    return project(this.cameras[index], ground.x, ground.y, z);
  }

  /**
   * Image pixel → the point in metres it shows at height `z`, or null above the horizon.
   * @param {number} index of the camera @param {XY} pixel @param {number} [z]
   */
  toGround(index, pixel, z = 0) {
    return backProject(this.cameras[index], pixel.x, pixel.y, z);
  }

  /**
   * The position nearest to a ground point, or null outside the grid.
   * @param {XY} ground metres
   */
  positionAt(ground) {
    const position = this.grid.position(ground.x, ground.y);
    return position < 0 ? null : position;
  }

  /**
   * The position some columns and rows further, or null outside the grid.
   * @param {number} position @param {number} columns @param {number} rows
   */
  stepped(position, columns, rows) {
    const { columns: width, rows: height } = this.grid;
    const column = (position % width) + columns;
    const row = Math.floor(position / width) + rows;
    return column < 0 || row < 0 || column >= width || row >= height ? null : row * width + column;
  }
}

/**
 * Accepted frames beside the batch, nearest first; the tutorial has none.
 * @param {Answer["neighbours"]} [neighbours] @returns {Neighbours}
 */
function readNeighbours({ before, after } = { before: [], after: [] }) {
  /** @type {(frame: import("../base/answers.js").NeighbourFrame) => Neighbour} */
  const read = ({ number, annotations }) => ({ number, people: byPerson(annotations) });
  return { before: before.map(read), after: after.map(read) };
}
