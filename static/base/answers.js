/**
 * What the server answers and is sent, as gtm_hit/api/workbench makes and reads it. Types only: no browser loads this.
 *
 * @typedef {import("../truth/annotation.js").AnnotationValues} AnnotationValues
 * @typedef {import("../truth/annotation.js").Annotation} Annotation
 * @typedef {import("../geometry/camera.js").CameraJSON} CameraJSON
 * @typedef {import("../geometry/grid.js").GridJSON} GridJSON
 * @typedef {import("../geometry/rectangle.js").Cylinder} Cylinder
 * @typedef {import("../geometry/rectangle.js").FootRule} FootRule
 *
 * @typedef {"assignment"|"layer"|"tutorial"} Mode
 * @typedef {{camera: number, light: string, full: string}} ImageRef addresses: `light` fills a pane, `full` has every pixel
 * @typedef {{number: number, images: ImageRef[], revision: number, done: boolean, nobody: boolean}} SceneFrame
 * @typedef {{slug: string, name: string, seconds_per_frame: number, frame_step: number}} DatasetPart
 * @typedef {{id: number, name: string, key?: string, created_at?: string, first?: number|null}} LayerPart `key`: no
 *   other layer has it, on no server; `first`: number of a part's first frame; the tutorial's has no key
 * @typedef {{state: string, expires_at: string|null, batch: string}} AssignmentPart
 * @typedef {{height: number[], radius: number[]}} Sizes the least and the most metres a person may have
 * @typedef {{number: number, annotations: AnnotationValues[]}} NeighbourFrame
 * @typedef {{before: NeighbourFrame[], after: NeighbourFrame[]}} NeighbourFrames accepted work beside the batch, nearest first
 *
 * @typedef {object} SceneAnswer
 * @property {Mode} mode
 * @property {DatasetPart} dataset
 * @property {GridJSON} grid
 * @property {Cylinder} cylinder the usual person
 * @property {Sizes} sizes
 * @property {FootRule} foot_rule
 * @property {CameraJSON[]} cameras
 * @property {SceneFrame[]} frames
 * @property {LayerPart} layer
 * @property {boolean} editable
 * @property {string} read_only_reason
 * @property {AssignmentPart|null} assignment
 * @property {number} next_person no save of the layer has used it
 * @property {boolean} [proposed] whether programs propose people here
 * @property {NeighbourFrames} [neighbours] the tutorial has none
 *
 * @typedef {object} FrameAnswer a frame as it is, or as it was after a save
 * @property {number} number
 * @property {number} revision
 * @property {AnnotationValues[]} annotations
 * @property {boolean} done
 * @property {boolean} nobody
 * @property {string|null} saved_at
 * @property {string} author
 * @typedef {{frames: FrameAnswer[]}} FramesAnswer
 *
 * @typedef {object} SaveBody
 * @property {string} save_id chosen by the sender; the same again changes nothing
 * @property {number} revision the one this edit started from
 * @property {Annotation[]} annotations
 * @property {boolean} done
 * @property {boolean} nobody
 * @property {number} seconds active ones since the save before
 *
 * @typedef {{revision: number, created_at: string, author: string, people: number, done: boolean,
 *            calibration: number|null}} Revision
 * @typedef {{revisions: Revision[]}} HistoryAnswer
 *
 * @typedef {{position: number, height: number|null, radius: number|null}} Sized metres; null: the usual person's
 * @typedef {(number[]|null)[]} BoxesByCamera xmin, ymin, xmax, ymax; null where not visible
 * @typedef {{rectangles: BoxesByCamera[]}} RectanglesAnswer by person
 *
 * @typedef {{camera: string, box: number[]|null, seen: number|null, hidden: boolean}} Evidence what one view says
 * @typedef {object} Proposed somebody whom a program proposes
 * @property {number} id
 * @property {number} position
 * @property {number|null} height
 * @property {number|null} radius
 * @property {number} score 0 to 1
 * @property {number} doubt 0 to 1
 * @property {number} track who is who among the proposals
 * @property {number|null} person the number the track has in the layer
 * @property {boolean} seated
 * @property {boolean} filled
 * @property {Evidence[]} evidence
 * @typedef {{number: number, people: Proposed[], refused: number[]}} ProposedFrame
 * @typedef {{run: number|null, threshold: number, frames: ProposedFrame[]}} ProposalsAnswer
 * @typedef {{position: number, metres: number, gain: number,
 *            refused: ""|"unseen"|"nothing"|"small"|"near", background: boolean}} SnapAnswer
 *
 * @typedef {{batch: string, frames: {number: number, people: number}[], annotations: number, minutes: number,
 *            submitted_at: string|null}} Summary
 * @typedef {{code: string, summary: Summary}} SubmitAnswer
 *
 * @typedef {{step: string, frame: number, annotations: Annotation[]}} CheckBody
 * @typedef {{ok: boolean, message: string, mistake: Mistake|null, person: number|null, feet: number|null}} Verdict
 *   `person`: whom it is about, if they have a box; `feet`: the position at which they should stand
 * @typedef {"frame"|"nothing"|"body"|"other"|"head"|"off"|"gone"|"empty"|"yellow"} Mistake
 * @typedef {{done_at: string}} TutorialDoneAnswer
 *
 * @typedef {{place: string, reason: string}} Problem with what was sent
 * @typedef {object} Details of a refusal, by its code
 * @property {string} [reason] read_only
 * @property {FrameAnswer} [current] stale: the frame as it is now
 * @property {number[]} [frames] unfinished
 * @property {string[]} [steps] unfinished tutorial
 */
export {};
