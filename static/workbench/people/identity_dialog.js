import { ask } from "../../base/dialogs.js";
import { element, setText } from "../../base/dom.js";
import { gettext, ngettext } from "../../base/messages.js";
import { everybody, framesWith, LARGEST, plan } from "../../truth/identity.js";
import { beforeAndAfter, changeList } from "./identity_preview.js";

/**
 * @typedef {import("../../truth/commands.js").Patch} Patch
 * @typedef {import("../../truth/identity.js").Choice} Choice
 * @typedef {import("../../truth/scene.js").Scene} Scene
 * @typedef {import("../../truth/store.js").Store} Store
 * @typedef {(values: Partial<Choice>) => void} Change
 */

/** @type {[Choice["scope"], () => string][]} */
const SCOPES = [
  ["here", () => gettext("in this frame only")],
  ["onwards", () => gettext("from here on")],
  ["everywhere", () => gettext("everywhere")],
];

/**
 * Asks what is missing and shows what will change, before anything does.
 * @param {object} parts
 * @param {Scene} parts.scene
 * @param {Store} parts.store
 * @param {import("../../truth/history.js").History} parts.history
 * @param {import("./identity_preview.js").MapColours} parts.mapColours
 * @param {Partial<Choice> & Pick<Choice, "kind"|"person">} start
 * @returns {Promise<Patch|null>} the patch the annotator agreed to
 */
export async function chooseIdentity({ scene, store, history, mapColours }, start) {
  /** @type {Choice} */
  const choice = { other: null, scope: "everywhere", keep: "present", ...start };
  const clash = element("div", { className: "identity-clash" });
  const said = element("p", { className: "identity-problem", role: "status" });
  const preview = element("div", { className: "identity-preview" });
  const update = () => {
    const found = plan(store, choice);
    const patch = found.patch && history.preview(found.patch);
    clash.hidden = !found.both.length;
    if (found.both.length) askWhoStays(clash, found.both, choice, change);
    setText(said, found.problem ?? "");
    preview.replaceChildren(
      ...(patch
        ? [changeList(store, patch), beforeAndAfter(scene, store, mapColours, patch, [choice.person, choice.other])]
        : []),
    );
    const apply = applyIn(preview);
    if (apply) apply.disabled = !found.patch;
    return found;
  };
  /** @type {Change} */
  const change = (values) => {
    Object.assign(choice, values);
    found = update();
  };
  const controls = fields(scene, store, choice, change);
  let found = update();
  const answer = ask({
    title: titleOf(choice),
    wide: true,
    body: [...controls, clash, said, preview],
    buttons: [
      { id: "apply", label: buttonOf(choice), main: true, disabled: !found.patch },
      { id: "cancel", label: gettext("Change nothing") },
    ],
  });
  const dialog = preview.closest("dialog");
  dialog?.classList.add("identity");
  dialog?.addEventListener("keydown", enterApplies);
  /** @type {HTMLElement|null|undefined} */
  const first = dialog?.querySelector("input, select:not(.keep)");
  first?.focus();
  return (await answer) === "apply" ? found.patch : null;
}

/** @param {Element} inside the dialog @returns {HTMLButtonElement|null|undefined} */
function applyIn(inside) {
  return inside.closest("dialog")?.querySelector('[data-answer="apply"]');
}

/**
 * Enter in a field would close the form unanswered.
 * @param {KeyboardEvent} event
 */
function enterApplies(event) {
  const { key, target } = event;
  if (key !== "Enter" || !(target instanceof Element) || !target.matches("input, select")) return;
  event.preventDefault();
  applyIn(target)?.click();
}

/** @param {Scene} scene @param {Store} store @param {Choice} choice @param {Change} change */
function fields(scene, store, choice, change) {
  const { kind } = choice;
  const made = [];
  if (kind === "rename") made.push(labelled(gettext("New number"), numberField(choice, change)));
  if (kind === "join" || kind === "swap")
    made.push(labelled(gettext("The other person"), personMenu(scene, store, choice, change)));
  if (kind === "rename" || kind === "remove") made.push(labelled(gettext("Where"), scopeMenu(choice, change)));
  return made;
}

/** @param {string} text @param {HTMLElement} control */
function labelled(text, control) {
  return element("label", { className: "identity-field" }, element("span", {}, text), control);
}

/** @param {Choice} choice @param {Change} change */
function numberField(choice, change) {
  /** @type {HTMLInputElement} */
  const field = element("input", {
    type: "number",
    min: "0",
    max: String(LARGEST),
    value: String(choice.other ?? ""),
    oninput: () => change({ other: field.value === "" ? null : field.valueAsNumber }),
  });
  return field;
}

/** @param {Choice} choice @param {Change} change */
function scopeMenu(choice, change) {
  const options = SCOPES.map(([scope, label]) =>
    element("option", { value: scope, selected: scope === choice.scope }, label()),
  );
  return menuOf({}, options, (index) => change({ scope: SCOPES[index][0] }));
}

/**
 * @param {import("../../base/dom.js").Properties<HTMLSelectElement>} properties @param {HTMLOptionElement[]} options
 * @param {(index: number) => void} choose the option at that place
 */
function menuOf(properties, options, choose) {
  /** @type {HTMLSelectElement} */
  const menu = element("select", { ...properties, onchange: () => choose(menu.selectedIndex) }, options);
  return menu;
}

/**
 * For a swap whoever is in this frame, for a join everybody; the nearest first.
 * @param {Scene} scene @param {Store} store @param {Choice} choice @param {Change} change
 */
function personMenu(scene, store, choice, change) {
  const persons = (choice.kind === "swap" ? [...store.people().keys()] : everybody(store)).filter(
    (one) => one !== choice.person,
  );
  const ordered = persons
    .map((person) => ({ person, away: metresApart(scene, store, choice.person, person) }))
    .sort((one, other) => one.away - other.away);
  choice.other ??= ordered[0]?.person ?? null;
  const options = ordered.map(({ person, away }) =>
    element(
      "option",
      { value: String(person), selected: person === choice.other },
      gettext("{person} – at {metres} m, {frames}", {
        person,
        metres: away.toFixed(1),
        frames: frameCount(store, person),
      }),
    ),
  );
  return menuOf({}, options, (index) => change({ other: ordered[index].person }));
}

/** @param {Store} store @param {number} person */
function frameCount(store, person) {
  const { length } = framesWith(store, person);
  return ngettext("in {n} frame", "in {n} frames", length);
}

/**
 * How near the two are: here if both are here, else where they are nearest in time, at the ends of their paths.
 * @param {Scene} scene @param {Store} store @param {number} person @param {number} other both marked somewhere
 */
function metresApart(scene, store, person, other) {
  /** @param {number} here @param {number} there frames */
  const between = (here, there) => {
    const [from, to] = [
      scene.metres(store.marked(person, here).position),
      scene.metres(store.marked(other, there).position),
    ];
    return Math.hypot(from.x - to.x, from.y - to.y);
  };
  if (store.person(person) && store.person(other)) return between(store.current, store.current);
  const [ours, theirs] = [framesWith(store, person), framesWith(store, other)];
  return Math.min(
    ...endsOf(ours).map((number) => between(number, closest(theirs, number))),
    ...endsOf(theirs).map((number) => between(closest(ours, number), number)),
  );
}

/** @param {number[]} numbers */
function endsOf(numbers) {
  return [numbers[0], numbers[numbers.length - 1]];
}

/** @param {number[]} numbers @param {number} wanted */
function closest(numbers, wanted) {
  return numbers.reduce((best, one) => (Math.abs(one - wanted) < Math.abs(best - wanted) ? one : best));
}

/**
 * Said again only when it is about other people or frames: a menu in use is left alone.
 * @param {HTMLElement} clash @param {number[]} both frames @param {Choice} choice @param {Change} change
 */
function askWhoStays(clash, both, choice, change) {
  const { person, other, kind, keep } = choice;
  const words = ngettext(
    "{person} and {other} are both marked in {n} frame:",
    "{person} and {other} are both marked in {n} frames:",
    both.length,
    { person, other },
  );
  if (clash.firstChild?.textContent === words) return;
  const [moved, present] = kind === "join" ? [other, person] : [person, other];
  /** @type {[Choice["keep"], string][]} */
  const answers = [
    ["present", gettext("they are the same: keep where {person} stands", { person: present })],
    ["moved", gettext("they are the same: keep where {person} stands", { person: moved })],
  ];
  if (kind === "rename") answers.push(["both", gettext("they are two people: swap their numbers")]);
  const options = answers.map(([value, label]) => element("option", { value, selected: value === keep }, label));
  const menu = menuOf({ className: "keep", "aria-label": gettext("Who stays") }, options, (index) =>
    change({ keep: answers[index][0] }),
  );
  clash.replaceChildren(element("span", {}, words), menu);
}

/** @param {Choice} choice */
function titleOf({ kind, person }) {
  return {
    rename: () => gettext("Another number for person {person}", { person }),
    split: () => gettext("Person {person} is somebody else from here on", { person }),
    join: () => gettext("Person {person} is the same as another", { person }),
    swap: () => gettext("Swap person {person} with another from here on", { person }),
    remove: () => gettext("Remove person {person}", { person }),
  }[kind]();
}

/** @param {Choice} choice */
function buttonOf({ kind }) {
  return {
    rename: gettext("Rename"),
    split: gettext("Split"),
    join: gettext("Join"),
    swap: gettext("Swap"),
    remove: gettext("Remove"),
  }[kind];
}
