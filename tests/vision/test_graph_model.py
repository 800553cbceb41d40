"""A small graph model is converted and gives what its layers must give."""

from __future__ import annotations

import json
from typing import Any

import cv2
import numpy as np
import pytest

from gtm_hit.vision.detectors import DetectorError
from gtm_hit.vision.detectors.graph_model import convert

LAST, FIRST = [0, 2, 3, 1], [0, 3, 1, 2]
PLAIN = {"padding": {"s": "VkFMSUQ="}, "dilations": {"list": {"i": ["1"] * 4}}}


def node(name: str, op: str, inputs: list[str] = (), **attr: Any) -> dict[str, Any]:
    return {"name": name, "op": op, "input": list(inputs), "attr": attr}


def small_model(kernel: np.ndarray, bias: np.ndarray, last: str = "LeakyRelu") -> tuple[bytes, bytes]:
    """Padding, a convolution with a bias and a leaky step, as a graph model between transpositions."""
    constants = {
        "pads": np.array([[0, 0], [0, 0], [1, 1], [1, 1]], np.int32),
        "to_last": np.array(LAST, np.int32),
        "to_first": np.array(FIRST, np.int32),
        "kernel": kernel.astype(np.float32),
        "bias": bias.astype(np.float32),
    }
    sizes = [{"size": str(size)} for size in (1, 3, 8, 8)]
    nodes = [
        node("input", "Placeholder", shape={"shape": {"dim": sizes}}),
        node("padded", "Pad", ["input", "pads"]),
        node("last", "Transpose", ["padded", "to_last"]),
        node(
            "convolved", "Conv2D", ["last", "kernel"], strides={"list": {"i": ["1", "2", "2", "1"]}}, **PLAIN
        ),
        node("biased", "Add", ["convolved", "bias"]),
        node("first", "Transpose", ["biased", "to_first"]),
        node("result", last, ["first"], alpha={"f": 0.1}),
        *(node(name, "Const") for name in constants),
    ]
    weights = [
        {"name": name, "shape": list(each.shape), "dtype": str(each.dtype)}
        for name, each in constants.items()
    ]
    model = {
        "modelTopology": {"node": nodes},
        "weightsManifest": [{"weights": weights}],
        "signature": {"outputs": {"result:0": {}}},
    }
    return json.dumps(model).encode(), b"".join(each.tobytes() for each in constants.values())


def test_a_converted_network_computes_what_the_model_says() -> None:
    rng = np.random.default_rng(1)
    kernel, bias, image = rng.normal(size=(3, 3, 3, 4)), rng.normal(size=4), rng.normal(size=(1, 3, 8, 8))
    network = cv2.dnn.readNetFromONNX(np.frombuffer(convert(*small_model(kernel, bias)), np.uint8))
    network.setInput(image.astype(np.float32))
    padded = np.pad(image[0], ((0, 0), (1, 1), (1, 1)))
    expected = np.array(
        [
            [
                [
                    (padded[:, y : y + 3, x : x + 3] * kernel[..., c].transpose(2, 0, 1)).sum() + bias[c]
                    for x in (0, 2, 4, 6)
                ]
                for y in (0, 2, 4, 6)
            ]
            for c in range(4)
        ]
    )
    expected = np.where(expected > 0, expected, 0.1 * expected)
    assert np.allclose(network.forward()[0], expected, atol=1e-4)


def test_an_operator_nobody_knows_is_refused_by_name() -> None:
    with pytest.raises(DetectorError, match="operator Mystery is not known"):
        convert(*small_model(np.zeros((3, 3, 3, 4)), np.zeros(4), "Mystery"))


def test_weights_that_are_cut_off_are_refused() -> None:
    model, weights = small_model(np.zeros((3, 3, 3, 4)), np.zeros(4))
    with pytest.raises(DetectorError, match="can be converted"):
        convert(model, weights[:-4])
