"""A TensorFlow.js graph model of a convolutional network becomes an ONNX file that OpenCV reads.

Such models work on channels-last tensors between transpositions there and back. Here every tensor keeps its
channels first, so that transpositions fall away, and padding and biases go into their convolutions. Only what
NanoDet consists of is known; anything else is refused.
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gtm_hit.vision.detectors.errors import DetectorError
from gtm_hit.vision.detectors.onnx_file import Graph, Node, model_bytes

PRODUCER = "Ground Truth Marker"
STORED = {"float16": "<f2", "float32": "<f4", "int32": "<i4"}

Step = dict[str, Any]  # a node of the model's graph


def convert(model: bytes, weights: bytes) -> bytes:
    """ONNX of `model` (the JSON file) with its `weights` (the binary file)."""
    try:
        description = json.loads(model)
        return _Conversion(description, weights).onnx()
    except (ValueError, KeyError, IndexError, TypeError) as error:
        raise DetectorError(f"not a graph model that can be converted: {error}") from error


class _Conversion:
    def __init__(self, description: dict[str, Any], weights: bytes) -> None:
        steps = description["modelTopology"]["node"]
        self.steps: dict[str, Step] = {step["name"]: step for step in steps}
        self.values = _weights(description["weightsManifest"][0]["weights"], weights)
        self.results = [name.split(":")[0] for name in description["signature"]["outputs"]]
        self.names: dict[str, str] = {}  # of a tensor in the model → in the file
        self.shapes: dict[str, tuple[int, ...]] = {}
        self.inputs: dict[str, tuple[int, ...]] = {}
        self.nodes: list[Node] = []
        self.constants: dict[str, NDArray] = {}

    def onnx(self) -> bytes:
        self.readers = self._count_readers()
        for result in self.results:
            self._make(result)
        outputs = {self.names[name]: self.shapes[self.names[name]] for name in self.results}
        return model_bytes(Graph(self.nodes, self.constants, self.inputs, outputs), PRODUCER)

    def _count_readers(self) -> dict[str, int]:
        counts: dict[str, int] = {}
        for step in self.steps.values():
            for name in step.get("input", ()):
                counts[name] = counts.get(name, 0) + 1
        return counts

    def _make(self, name: str) -> str:
        """The file's tensor of a step; makes what it reads first."""
        if name not in self.names:
            step = self.steps[name.split(":")[0]]
            makers: dict[str, Callable[[Step], None]] = {
                "Placeholder": self._placeholder,
                "Identity": self._alias,
                "Transpose": self._transpose,
                "Conv2D": lambda step: self._convolution(step, None),
                "Add": self._add,
                "LeakyRelu": self._leaky,
                "MaxPool": self._pool,
                "ConcatV2": self._concatenate,
                "ResizeBilinear": self._resize,
                "SplitV": self._split,
                "Sigmoid": lambda step: self._same("Sigmoid", step, self._read(step, 0)),
                "Reshape": self._reshape,
            }
            if step["op"] not in makers:
                raise DetectorError(f"operator {step['op']} is not known")
            makers[step["op"]](step)
        return self.names[name]

    def _read(self, step: Step, place: int) -> str:
        return self._make(step["input"][place])

    def _constant(self, step: Step, place: int) -> NDArray:
        return self.values[step["input"][place]]

    def _emit(
        self, name: str, kind: str, inputs: list[str], shape: tuple[int, ...], **attributes: Any
    ) -> None:
        made = name.replace("/", "_").replace(":", "_")
        self.nodes.append(Node(kind, inputs, [made], attributes))
        self.names[name], self.shapes[made] = made, shape

    def _same(self, kind: str, step: Step, *inputs: str, **attributes: Any) -> None:
        self._emit(step["name"], kind, list(inputs), self.shapes[inputs[0]], **attributes)

    def _placeholder(self, step: Step) -> None:
        sizes = tuple(int(each["size"]) for each in step["attr"]["shape"]["shape"]["dim"])
        self.names[step["name"]] = step["name"]
        self.inputs[step["name"]] = self.shapes[step["name"]] = sizes

    def _alias(self, step: Step) -> None:
        self.names[step["name"]] = self._read(step, 0)

    def _transpose(self, step: Step) -> None:
        order = self._constant(step, 1).tolist()
        if len(order) == 4:  # between channels first and last: here they always come first
            self._alias(step)
            return
        source = self._read(step, 0)
        shape = tuple(self.shapes[source][axis] for axis in order)
        self._emit(step["name"], "Transpose", [source], shape, perm=order)

    def _unpadded(self, step: Step) -> tuple[str, list[int]]:
        """What a step reads, without the padding before it, and that padding: top left bottom right."""
        source = self.steps[step["input"][0].split(":")[0]]
        while source["op"] == "Transpose":
            source = self.steps[source["input"][0].split(":")[0]]
        if source["op"] not in ("Pad", "PadV2"):
            return self._read(step, 0), [0, 0, 0, 0]
        _, _, rows, columns = self.values[source["input"][1]].tolist()
        filled = float(self.values[source["input"][2]]) if source["op"] == "PadV2" else 0.0
        if filled != (-math.inf if step["op"] == "MaxPool" else 0.0):
            raise DetectorError(f"padding with {filled} before {step['op']} is not known")
        return self._read(source, 0), [rows[0], columns[0], rows[1], columns[1]]

    def _window(self, source: str, kernel: list[int], strides: list[int], pads: list[int]) -> tuple[int, int]:
        """Rows and columns that come out of a window moved over the source."""
        rows, columns = self.shapes[source][2:]
        return (
            (rows + pads[0] + pads[2] - kernel[0]) // strides[0] + 1,
            (columns + pads[1] + pads[3] - kernel[1]) // strides[1] + 1,
        )

    def _convolution(self, step: Step, bias: NDArray | None, name: str | None = None) -> None:
        _check_convolution(step)
        source, pads = self._unpadded(step)
        kernel = self._constant(step, 1).transpose(3, 2, 0, 1)
        strides = [int(each) for each in step["attr"]["strides"]["list"]["i"][1:3]]
        shape = (1, kernel.shape[0], *self._window(source, list(kernel.shape[2:]), strides, pads))
        name = name or step["name"]
        inputs = [source, self._keep(f"{name}/kernel", kernel)]
        if bias is not None:
            inputs.append(self._keep(f"{name}/bias", bias))
        window = {"kernel_shape": list(kernel.shape[2:]), "strides": strides, "pads": pads}
        self._emit(name, "Conv", inputs, shape, **window)

    def _add(self, step: Step) -> None:
        bias = self.values.get(step["input"][1])
        if bias is None:
            self._same("Add", step, self._read(step, 0), self._read(step, 1))
            return
        before = self.steps[step["input"][0]]
        if before["op"] != "Conv2D" or self.readers[before["name"]] != 1:
            raise DetectorError("a constant is added to something that is no convolution")
        self._convolution(before, bias, step["name"])

    def _leaky(self, step: Step) -> None:
        self._same("LeakyRelu", step, self._read(step, 0), alpha=float(step["attr"]["alpha"]["f"]))

    def _pool(self, step: Step) -> None:
        source, pads = self._unpadded(step)
        kernel, strides = (
            [int(each) for each in step["attr"][name]["list"]["i"][1:3]] for name in ("ksize", "strides")
        )
        shape = (*self.shapes[source][:2], *self._window(source, kernel, strides, pads))
        window = {"kernel_shape": kernel, "strides": strides, "pads": pads}
        self._emit(step["name"], "MaxPool", [source], shape, **window)

    def _concatenate(self, step: Step) -> None:
        sources = [self._make(name) for name in step["input"][:-1]]
        axis = int(self._constant(step, len(sources)))
        shape = list(self.shapes[sources[0]])
        shape[axis] = sum(self.shapes[source][axis] for source in sources)
        self._emit(step["name"], "Concat", sources, tuple(shape), axis=axis)

    def _resize(self, step: Step) -> None:
        source = self._read(step, 0)
        shape = (*self.shapes[source][:2], *self._constant(step, 1).tolist())
        # As factors, not sizes: so that the network takes pictures of other sizes, too.
        factors = np.array(shape, np.float32) / np.array(self.shapes[source], np.float32)
        rule = {"mode": "linear", "coordinate_transformation_mode": "half_pixel"}
        kept = self._keep(f"{step['name']}/factors", factors)
        self._emit(step["name"], "Resize", [source, "", kept], shape, **rule)

    def _split(self, step: Step) -> None:
        source, parts = self._read(step, 0), self._constant(step, 1)
        axis = int(self._constant(step, 2))
        names = [step["name"], *(f"{step['name']}:{place}" for place in range(1, len(parts)))]
        made = [name.replace("/", "_").replace(":", "_") for name in names]
        inputs = [source, self._keep(f"{step['name']}/parts", parts.astype(np.int64))]
        self.nodes.append(Node("Split", inputs, made, {"axis": axis}))
        for name, output, size in zip(names, made, parts.tolist(), strict=True):
            shape = list(self.shapes[source])
            shape[axis] = size
            self.names[name], self.shapes[output] = output, tuple(shape)

    def _reshape(self, step: Step) -> None:
        """Rows and columns become one: the only reshaping that detectors of this kind do."""
        source = self._read(step, 0)
        batch, channels, rows, columns = self.shapes[source]
        shape = (batch, channels, rows * columns)
        sizes = self._keep(f"{step['name']}/sizes", np.array((batch, channels, -1), np.int64))
        self._emit(step["name"], "Reshape", [source, sizes], shape)

    def _keep(self, name: str, values: NDArray) -> str:
        kept = name.replace("/", "_")
        self.constants[kept] = values if values.dtype.kind == "i" else values.astype(np.float32)
        return kept


def _check_convolution(step: Step) -> None:
    attributes = step["attr"]
    if attributes["padding"]["s"] != "VkFMSUQ=" or set(attributes["dilations"]["list"]["i"]) != {"1"}:
        raise DetectorError("only plain convolutions without implied padding are known")


def _weights(entries: list[dict[str, Any]], data: bytes) -> dict[str, NDArray]:
    """Values by name; the file holds them one after the other."""
    values, start = {}, 0
    for entry in entries:
        dtype = np.dtype(STORED[entry.get("quantization", entry)["dtype"]])
        count = math.prod(entry["shape"])
        part = np.frombuffer(data, dtype, count, start)
        start += count * dtype.itemsize
        values[entry["name"]] = part.reshape(entry["shape"])
    if start != len(data):
        raise DetectorError(f"{len(data)} bytes of weights where {start} belong")
    return values
