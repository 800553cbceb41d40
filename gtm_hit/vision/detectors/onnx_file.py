"""Writes ONNX files: the few messages of its protocol buffers that a plain network needs.

An ONNX file is nested messages of numbered fields. Writing those by hand takes a page; the package that does
it would be one more thing to install for a step that runs once.
"""

from __future__ import annotations

import struct
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

OPSET = 13
IR_VERSION = 7
FLOAT, INT64 = 1, 7  # TensorProto.DataType
VARINT, BYTES, FIXED32 = 0, 2, 5  # wire types

Attribute = int | float | str | Sequence[int]


@dataclass(frozen=True)
class Node:
    kind: str  # of the operator
    inputs: Sequence[str]
    outputs: Sequence[str]
    attributes: dict[str, Attribute] = field(default_factory=dict)


@dataclass(frozen=True)
class Graph:
    nodes: Sequence[Node]  # each after those it reads from
    constants: dict[str, NDArray]
    inputs: Mapping[str, Sequence[int]]  # shapes
    outputs: Mapping[str, Sequence[int]]


def model_bytes(graph: Graph, producer: str) -> bytes:
    """The file of a graph of floats."""
    opset = _number(2, OPSET)
    return b"".join(
        (_number(1, IR_VERSION), _text(2, producer), _message(7, _graph(graph)), _message(8, opset))
    )


def _graph(graph: Graph) -> bytes:
    parts = [_message(1, _node(node)) for node in graph.nodes]
    parts.append(_text(2, "graph"))
    parts += [_message(5, _tensor(name, values)) for name, values in graph.constants.items()]
    parts += [_message(11, _shape(name, shape)) for name, shape in graph.inputs.items()]
    parts += [_message(12, _shape(name, shape)) for name, shape in graph.outputs.items()]
    return b"".join(parts)


def _node(node: Node) -> bytes:
    parts = [_text(1, name) for name in node.inputs]
    parts += [_text(2, name) for name in node.outputs]
    parts += [_text(3, node.outputs[0]), _text(4, node.kind)]
    parts += [_message(5, _attribute(name, value)) for name, value in node.attributes.items()]
    return b"".join(parts)


def _attribute(name: str, value: Attribute) -> bytes:
    if isinstance(value, float):
        said, kind = _tag(2, FIXED32) + struct.pack("<f", value), 1
    elif isinstance(value, int):
        said, kind = _number(3, value), 2
    elif isinstance(value, str):
        said, kind = _text(4, value), 3
    else:
        said, kind = b"".join(_number(8, each) for each in value), 7
    return _text(1, name) + said + _number(20, kind)


def _tensor(name: str, values: NDArray) -> bytes:
    whole = values.dtype.kind == "i"
    data = np.ascontiguousarray(values, dtype="<i8" if whole else "<f4").tobytes()
    dims = b"".join(_number(1, size) for size in values.shape)
    return dims + _number(2, INT64 if whole else FLOAT) + _text(8, name) + _message(9, data)


def _shape(name: str, shape: Iterable[int]) -> bytes:
    dims = b"".join(_message(1, _number(1, size)) for size in shape)
    tensor = _number(1, FLOAT) + _message(2, dims)
    return _text(1, name) + _message(2, _message(1, tensor))


def _text(number: int, text: str) -> bytes:
    return _message(number, text.encode())


def _message(number: int, content: bytes) -> bytes:
    return _tag(number, BYTES) + _varint(len(content)) + content


def _number(number: int, value: int) -> bytes:
    return _tag(number, VARINT) + _varint(value)


def _tag(number: int, wire: int) -> bytes:
    return _varint(number << 3 | wire)


def _varint(value: int) -> bytes:
    value &= (1 << 64) - 1  # negative numbers are written as two's complement
    said = bytearray()
    while value > 127:
        said.append(value & 127 | 128)
        value >>= 7
    said.append(value)
    return bytes(said)
