import { ask } from "../../base/dialogs.js";
import { element, setText } from "../../base/dom.js";
import { gettext, ngettext } from "../../base/messages.js";
import { everybody, framesWith, LARGEST, plan } from "../../truth/identity.js";
import { beforeAndAfter, changeList } from "./identity_preview.js";

const SCOPES = [
  ["here", () => gettext("in this frame only")],
  ["onwards", () => gettext("from here on")],
  ["everywhere", () => gettext("everywhere")],
];

/**
 * Asks what is missing and shows what will change, before anything does.
 * @param {import("../../truth/identity.js").Choice} choice to start with
 * @returns {Promise<object|null>} the patch the annotator agreed to
 */
export async function chooseIdentity({ scene, store, history, mapColours }, start) {
  const choice = { other: null, scope: "everywhere", keep: "present", ...start };
  const clash = element("div", { className: "identity-clash" });
  const said = element("p", { className: "identity-problem", role: "status" });
  const preview = element("div", { className: "identity-preview" });
  let found = null;
  const update = () => {
    found = plan(store, choice);
    const patch = found.patch && history.preview(found.patch);
    clash.hidden = !found.both.length;
    if (found.both.length) askWhoStays(clash, found.both, choice, change);
    setText(said, found.problem ?? "");
    preview.replaceChildren(
      ...(patch
        ? [changeList(store, patch), beforeAndAfter(scene, store, mapColours, patch, [choice.person, choice.other])]
        : []),
    );
    const apply = preview.closest("dialog")?.querySelector('[data-answer="apply"]');
    if (apply) apply.disabled = !found.patch;
  };
  const change = (values) => {
    Object.assign(choice, values);
    update();
  };
  const controls = fields(scene, store, choice, change);
  update();
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
  dialog.classList.add("identity");
  dialog.addEventListener("keydown", (event) => enterApplies(event, dialog));
  dialog.querySelector("input, select:not(.keep)")?.focus();
  return (await answer) === "apply" ? found.patch : null;
}

/** Enter in a field would close the form unanswered. */
function enterApplies(event, dialog) {
  if (event.key !== "Enter" || !event.target.matches("input, select")) return;
  event.preventDefault();
  dialog.querySelector('[data-answer="apply"]').click();
}

function fields(scene, store, choice, change) {
  const { kind } = choice;
  return [
    kind === "rename" && labelled(gettext("New number"), numberField(choice, change)),
    (kind === "join" || kind === "swap") &&
      labelled(gettext("The other person"), personMenu(scene, store, choice, change)),
    (kind === "rename" || kind === "remove") && labelled(gettext("Where"), scopeMenu(choice, change)),
  ].filter(Boolean);
}

function labelled(text, control) {
  return element("label", { className: "identity-field" }, element("span", {}, text), control);
}

function numberField(choice, change) {
  return element("input", {
    type: "number",
    min: 0,
    max: LARGEST,
    value: choice.other ?? "",
    oninput: ({ target }) => change({ other: target.value === "" ? null : target.valueAsNumber }),
  });
}

function scopeMenu(choice, change) {
  const options = SCOPES.map(([scope, label]) =>
    element("option", { value: scope, selected: scope === choice.scope }, label()),
  );
  return element("select", { onchange: ({ target }) => change({ scope: target.value }) }, options);
}

/** For a swap whoever is in this frame, for a join everybody; the nearest first. */
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
      { value: person, selected: person === choice.other },
      gettext("{person} – at {metres} m, {frames}", {
        person,
        metres: away.toFixed(1),
        frames: frameCount(store, person),
      }),
    ),
  );
  return element("select", { onchange: ({ target }) => change({ other: Number(target.value) }) }, options);
}

function frameCount(store, person) {
  const { length } = framesWith(store, person);
  return ngettext("in {n} frame", "in {n} frames", length);
}

/** How near the two are: here if both are here, else where they are nearest in time, at the ends of their paths. */
function metresApart(scene, store, person, other) {
  const between = (here, there) => {
    const [from, to] = [
      scene.metres(store.person(person, here).position),
      scene.metres(store.person(other, there).position),
    ];
    return Math.hypot(from.x - to.x, from.y - to.y);
  };
  if (store.person(person) && store.person(other)) return between(store.current, store.current);
  const [ours, theirs] = [framesWith(store, person), framesWith(store, other)];
  const pairs = [
    ...[ours[0], ours.at(-1)].map((number) => [number, closest(theirs, number)]),
    ...[theirs[0], theirs.at(-1)].map((number) => [closest(ours, number), number]),
  ];
  return Math.min(...pairs.map(([here, there]) => between(here, there)));
}

function closest(numbers, wanted) {
  return numbers.reduce((best, one) => (Math.abs(one - wanted) < Math.abs(best - wanted) ? one : best));
}

/** Said again only when it is about other people or frames: a menu in use is left alone. */
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
  const options = [
    ["present", gettext("they are the same: keep where {person} stands", { person: present })],
    ["moved", gettext("they are the same: keep where {person} stands", { person: moved })],
    ...(kind === "rename" ? [["both", gettext("they are two people: swap their numbers")]] : []),
  ].map(([value, label]) => element("option", { value, selected: value === keep }, label));
  const menu = element(
    "select",
    { className: "keep", "aria-label": gettext("Who stays"), onchange: ({ target }) => change({ keep: target.value }) },
    options,
  );
  clash.replaceChildren(element("span", {}, words), menu);
}

function titleOf({ kind, person }) {
  return {
    rename: () => gettext("Another number for person {person}", { person }),
    split: () => gettext("Person {person} is somebody else from here on", { person }),
    join: () => gettext("Person {person} is the same as another", { person }),
    swap: () => gettext("Swap person {person} with another from here on", { person }),
    remove: () => gettext("Remove person {person}", { person }),
  }[kind]();
}

function buttonOf({ kind }) {
  return {
    rename: gettext("Rename"),
    split: gettext("Split"),
    join: gettext("Join"),
    swap: gettext("Swap"),
    remove: gettext("Remove"),
  }[kind];
}
