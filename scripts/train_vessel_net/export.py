#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes a trained net as src/tracking/vessel_net_weights.cpp: 8 bit a weight, a step for each output.

export.py NET.npz src/tracking/vessel_net_weights.cpp
"""
import base64
import sys

import numpy as np

from net import JOINS, LAYERS

COLUMNS = 240


def quantised(weights):
    flat = weights.reshape(len(weights), -1)
    steps = np.maximum(np.abs(flat).max(1), 1e-12) / 127
    return steps.astype(np.float32), np.clip(np.round(flat / steps[:, None]), -127, 127).astype(np.int8)


def literal(value):
    text = f"{value:.6g}"
    return text + ("F" if "." in text or "e" in text else ".0F")


def layer_lines(name, weights, bias):
    steps, values = quantised(weights)
    text = base64.b64encode(values.tobytes() + b"\0").decode()
    yield f"const float k{name}Steps[] = {{{', '.join(map(literal, steps))}}};"
    yield f"const float k{name}Bias[] = {{{', '.join(map(literal, bias))}}};"
    yield f"const char k{name}Weights[] ="
    pieces = [f'    "{text[i:i + COLUMNS]}"' for i in range(0, len(text), COLUMNS)]
    yield from pieces[:-1]
    yield pieces[-1] + ";"


def table(net):
    yield "// SPDX-License-Identifier: GPL-3.0-or-later"
    yield "// Made by scripts/train_vessel_net/export.py, not to be edited. Long lines keep the table short."
    yield "// clang-format off"
    yield '#include "eyeslam/tracking/vessel_net_weights.h"\n\nnamespace eyeslam::tracking {\n\nnamespace {\n'
    rows = []
    for key, inputs, outputs in LAYERS + JOINS:
        name, weights = key.capitalize(), net[key + ".w"]
        yield from layer_lines(name, weights, net[key + ".b"])
        rows.append(f"    {{{inputs}, {outputs}, {9 if weights.ndim == 4 else 1}, k{name}Steps, k{name}Bias, k{name}Weights}},")
    yield f"\n}}  // namespace\n\nconst std::array<StoredLayer, {len(rows)}> kVesselNetLayers = {{{{"
    yield from rows
    yield "}};\n\n}  // namespace eyeslam::tracking"


if __name__ == "__main__":
    if len(sys.argv) != 3: sys.exit(__doc__)
    with open(sys.argv[2], "w") as out: out.write("\n".join(table(np.load(sys.argv[1]))) + "\n")
