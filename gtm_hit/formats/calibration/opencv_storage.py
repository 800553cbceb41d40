"""Named numbers out of the files OpenCV's FileStorage writes, and of hand-made ones that look like them.

OpenCV's own reader is not used: it returns nothing for numbers written as bare text, which is how WILDTRACK's
extrinsic files are published, and these files come from strangers.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, field

from defusedxml.common import DefusedXmlException  # type: ignore[import-untyped]
from defusedxml.ElementTree import fromstring  # type: ignore[import-untyped]

from gtm_hit.formats.problems import FormatError, Problem, ProblemList, shown

# No pattern here backtracks more than once over its input: these files come from strangers.
_NUMBER = re.compile(r"[+-]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][+-]?[0-9]+)?")
_NOT_FINITE = re.compile(r"[+-]?\.?(?:nan|inf|infinity|ind|1\.#.*)", re.IGNORECASE)
_ELEMENT_TYPE = re.compile(r'"?([0-9]*)[a-zA-Z]"?')
_COUNT = re.compile(r"[0-9]{1,6}")
_YAML_ITEM = re.compile(r" *((?:- *)*)(.*)")
_YAML_NAME = re.compile(r'[A-Za-z_][\w. -]*|"[^"]*"')
_YAML_COMMENT = re.compile(r"(?:^|\s)#.*")
_YAML_TAG = re.compile(r"!\S*\s*")
_MATRIX_FIELDS = {"rows", "cols", "dt", "data"}


@dataclass
class StoredNode:
    """One named value as it stands in the file; numbers are made of it only when somebody asks."""

    name: str
    place: str
    depth: int
    text: list[str] = field(default_factory=list)
    rows: str | None = None
    cols: str | None = None
    dt: str | None = None

    def numbers(self, problems: ProblemList) -> list[float]:
        words = re.sub(r"[\[\],]", " ", " ".join(self.text)).split()
        values = []
        for index, word in enumerate(words):
            value = float(word) if _NUMBER.fullmatch(word) else math.nan
            if not math.isfinite(value):
                kind = (
                    "not finite" if _NUMBER.fullmatch(word) or _NOT_FINITE.fullmatch(word) else "not a number"
                )
                problems.add(self.place, f"value {index + 1} is {kind}: {shown(word)}")
            values.append(value)
        self._check_size(len(values), problems)
        return values

    def shape(self) -> tuple[int, int] | None:
        """Rows and columns as the file states them, None when it does not or not as numbers."""
        if self.rows is None or self.cols is None:
            return None
        if not (_COUNT.fullmatch(self.rows) and _COUNT.fullmatch(self.cols)):
            return None
        return int(self.rows), int(self.cols)

    def _check_size(self, count: int, problems: ProblemList) -> None:
        shape = self.shape()
        if shape is None:
            if self.rows is not None or self.cols is not None:
                problems.add(
                    self.place, f"rows and cols are not counts: {shown(self.rows)}, {shown(self.cols)}"
                )
            return
        expected = shape[0] * shape[1] * self._channels()
        if count != expected:
            problems.add(self.place, f"{count} numbers where {shape[0]} x {shape[1]} asks for {expected}")

    def _channels(self) -> int:
        match = _ELEMENT_TYPE.fullmatch((self.dt or "").strip())
        return min(int(match[1] or 1), 1000) if match and len(match[1]) < 9 else 1


def parse_storage(data: bytes, path: str) -> list[StoredNode]:
    """The named values of an XML or YAML file, in file order.

    Raises FormatError when the bytes are neither. XML with a DTD, entities or external references is refused.
    """
    if path.lower().endswith((".yml", ".yaml")) or data.lstrip().startswith(b"%YAML"):
        return _parse_yaml(data, path)
    return _parse_xml(data, path)


def _parse_xml(data: bytes, path: str) -> list[StoredNode]:
    # Wrong bytes outside the numbers, say in a comment in an old encoding, do no harm.
    text = data.decode("utf-8-sig", "replace")
    if "xmlns" in text:
        # A long namespace is repeated in memory for every name that uses it.
        raise FormatError([Problem(path, "", "XML with namespaces is not a calibration file")])
    try:
        root = fromstring(text, forbid_dtd=True)
    except DefusedXmlException as error:
        raise FormatError(
            [Problem(path, "", "not XML that can be read: it has a DTD or entities")]
        ) from error
    except (SyntaxError, ValueError, LookupError) as error:
        raise FormatError([Problem(path, "", f"not XML that can be read: {shown(str(error))}")]) from error
    nodes = []
    # A stack instead of recursion: files nested a hundred thousand deep must not end the process.
    pending = [(root, root.tag[:60], 0)]
    while pending:
        element, place, depth = pending.pop()
        children = list(element)
        fields = {child.tag: child.text or "" for child in children if child.tag in _MATRIX_FIELDS}
        if "data" in fields:
            rows, cols, dt = (_stripped(fields.get(key)) for key in ("rows", "cols", "dt"))
            nodes.append(StoredNode(element.tag, place, depth, [fields["data"]], rows, cols, dt))
        elif all(child.tag == "_" for child in children):
            words = [element.text or "", *(child.text or "" for child in children)]
            nodes.append(StoredNode(element.tag, place, depth, words))
        else:
            pending.extend((child, child.tag[:60], depth + 1) for child in reversed(children))
    return nodes


def _stripped(text: str | None) -> str | None:
    return None if text is None else text.strip()


def _parse_yaml(data: bytes, path: str) -> list[StoredNode]:
    problems = ProblemList(path)
    nodes: list[StoredNode] = []
    opened: list[tuple[int, StoredNode]] = []
    for number, line in _yaml_lines(data.decode("utf-8-sig", "replace"), problems):
        indent = len(line) - len(line.lstrip(" "))
        key, value, is_item = _yaml_parts(line)
        # "- 1" may stand at the same indent as the name it belongs to, "name: 1" may not.
        while opened and (opened[-1][0] > indent or (opened[-1][0] == indent and not is_item)):
            opened.pop()
        if key is None and not (is_item and opened):
            problems.add(
                f"line {number}", f"not 'name: value' and not an item of a list: {shown(line.strip())}"
            )
        elif key is None:
            opened[-1][1].text.append(value)
        elif opened and key in _MATRIX_FIELDS:
            _fill(opened[-1][1], key, value)
        else:
            nodes.append(
                StoredNode(key, f"line {number}, {key[:60]}", len(opened), [_YAML_TAG.sub("", value, 1)])
            )
            opened.append((indent, nodes[-1]))
    problems.raise_if_any()
    return nodes


def _yaml_parts(line: str) -> tuple[str | None, str, bool]:
    """Name (None where there is none), value, and whether the line is an item of a list."""
    match = _YAML_ITEM.fullmatch(line)
    dashes, rest = match.groups() if match else ("", line)
    # A minus sign is not a dash: "- -1.5" is one item.
    if dashes.endswith("-") and rest:
        dashes, rest = dashes[:-1], f"-{rest}"
    name, colon, value = rest.partition(":")
    if colon and _YAML_NAME.fullmatch(name):
        return name.strip('" '), value.strip(), bool(dashes)
    return None, rest, bool(dashes)


def _fill(node: StoredNode, key: str, value: str) -> None:
    if key == "data":
        node.text.append(value)
    else:
        setattr(node, key, value.strip('"'))


def _yaml_lines(text: str, problems: ProblemList) -> list[tuple[int, str]]:
    """Lines without comments and markers, a bracketed list over several lines made into one."""
    lines: list[tuple[int, list[str]]] = []
    unclosed = 0
    for number, raw in enumerate(text.splitlines(), start=1):
        line = _YAML_COMMENT.sub("", raw.replace("\t", " ")).rstrip()
        if not line or line.startswith(("%YAML", "---", "...")):
            continue
        if unclosed:
            lines[-1][1].append(line.strip())
        else:
            lines.append((number, [line]))
        unclosed += line.count("[") - line.count("]")
        if unclosed < 0:
            problems.add(f"line {number}", "']' without '['")
            unclosed = 0
    if unclosed:
        problems.add(f"line {lines[-1][0]}", "'[' without ']'")
    return [(number, " ".join(parts)) for number, parts in lines]
