# SPDX-License-Identifier: GPL-3.0-or-later
"""The net of src/tracking/vessel_net with its gradients. Source of the kernels: convolutions.cpp, built on first use."""
import ctypes
import os
import subprocess
import tempfile

import numpy as np

# Name, inputs, outputs of the 3x3 layers, in the order in which the tracker stores them; then the joins (1x1).
FINE, MIDDLE, COARSE = 16, 24, 32
LAYERS = (("a1", 8, FINE), ("a2", FINE, FINE), ("b1", FINE, MIDDLE), ("b2", MIDDLE, MIDDLE), ("c1", MIDDLE, COARSE),
          ("c2", COARSE, COARSE), ("c3", COARSE, COARSE), ("b3", MIDDLE, MIDDLE), ("b4", MIDDLE, MIDDLE), ("a3", FINE, FINE),
          ("a4", FINE, FINE), ("out", FINE, 8))
JOINS = (("u1", COARSE, MIDDLE), ("u2", MIDDLE, FINE))
INPUT_UNIT, INPUT_LIMIT = 256.0, 8.0  # contrast units that count as 1; where the input is cut off
CALIBRE_UNIT = 8.0                    # full px
MARGIN = 48                           # floats to spare at the end of a row: the kernels work in runs of 32


def kernels():
    folder = os.path.dirname(os.path.abspath(__file__))
    library = os.path.join(tempfile.mkdtemp(), "convolutions.so")
    subprocess.run(["g++", "-O3", "-march=native", "-fassociative-math", "-fno-signed-zeros", "-fno-trapping-math", "-shared",
                    "-fPIC", os.path.join(folder, "convolutions.cpp"), "-o", library], check=True)
    return ctypes.CDLL(library)


KERNELS = kernels()


def address(array):
    return array.ctypes.data_as(ctypes.c_void_p)


class Planes:
    def __init__(self, channels, height, width):
        self.channels, self.height, self.width = channels, height, width
        self.stride = (width + 15) // 16 * 16 + MARGIN
        self.memory = np.zeros(channels * (height + 2) * self.stride + 64, np.float32)
        self.rows = self.memory[:-64].reshape(channels, height + 2, self.stride)
        self.inner = self.rows[:, 1:-1, 1:width + 1]

    def clean(self):
        """What a kernel wrote beyond the width is margin again."""
        self.rows[:, 1:-1, self.width + 1:] = 0


def pairs(picture):
    """The four phases of 2x2 px."""
    return [picture[p::2, q::2] for p in (0, 1) for q in (0, 1)]


def halved(values):
    return 0.25 * (values[:, ::2, ::2] + values[:, 1::2, ::2] + values[:, ::2, 1::2] + values[:, 1::2, 1::2])


def doubled(values):
    return np.repeat(np.repeat(values, 2, 1), 2, 2)


class Net:
    def __init__(self, random):
        self.weights, self.planes, self.size = {}, {}, None
        for name, inputs, outputs in LAYERS:
            spread = np.sqrt((0.5 if name == "out" else 2) / (9 * inputs))
            self.weights[name + ".w"] = (random.standard_normal((outputs, inputs, 3, 3)) * spread).astype(np.float32)
            self.weights[name + ".b"] = np.zeros(outputs, np.float32)
        self.weights["out.b"][:4], self.weights["out.b"][4:] = -2, 1
        for name, inputs, outputs in JOINS:
            self.weights[name + ".w"] = (random.standard_normal((outputs, inputs)) / np.sqrt(inputs)).astype(np.float32)
            self.weights[name + ".b"] = np.zeros(outputs, np.float32)

    def allocate(self, height, width):
        if self.size == (height, width): return
        self.size = (height, width)
        level = {"a": (height // 2, width // 2), "b": (height // 4, width // 4), "c": (height // 8, width // 8)}
        make = lambda key, channels, where: self.planes.__setitem__(key, Planes(channels, *level[where]))
        for name, inputs, outputs in LAYERS:
            where = "a" if name == "out" else name[0]
            make(name, outputs, where), make("d" + name, outputs, where), make("g" + name, inputs, where)
        make("in", 8, "a"), make("sum_a", FINE, "a"), make("sum_b", MIDDLE, "b"), make("in_b", FINE, "b"), make("in_c", MIDDLE, "c")

    def convolve(self, name, source):
        x, y = self.planes[source], self.planes[name]
        KERNELS.forward(address(x.memory), x.channels, address(y.memory), y.channels, address(self.weights[name + ".w"]),
                        address(self.weights[name + ".b"]), y.width, y.height, y.stride)
        y.clean()
        if name != "out": np.maximum(y.inner, 0, out=y.inner)

    def join(self, name, coarse, fine, result):
        x = self.planes[coarse].inner
        mixed = self.weights[name + ".w"] @ x.reshape(len(x), -1) + self.weights[name + ".b"][:, None]
        total = self.planes[fine].inner + doubled(mixed.reshape(-1, *x.shape[1:]))
        self.planes[result].inner[:] = np.maximum(total, 0)

    def run(self, contrast, known):
        """Log odds and calibre (CALIBRE_UNIT) of a picture, sides multiples of 128; contrast in INPUT_UNIT."""
        self.allocate(*contrast.shape)
        for channel, phase in enumerate(pairs(contrast) + pairs(known)): self.planes["in"].inner[channel] = phase
        self.convolve("a1", "in"), self.convolve("a2", "a1")
        self.planes["in_b"].inner[:] = halved(self.planes["a2"].inner)
        self.convolve("b1", "in_b"), self.convolve("b2", "b1")
        self.planes["in_c"].inner[:] = halved(self.planes["b2"].inner)
        self.convolve("c1", "in_c"), self.convolve("c2", "c1"), self.convolve("c3", "c2")
        self.join("u1", "c3", "b2", "sum_b")
        self.convolve("b3", "sum_b"), self.convolve("b4", "b3")
        self.join("u2", "b4", "a2", "sum_a")
        self.convolve("a3", "sum_a"), self.convolve("a4", "a3"), self.convolve("out", "a4")
        odds, calibre = np.empty((2, *contrast.shape), np.float32)
        for channel, (o, c) in enumerate(zip(pairs(odds), pairs(calibre))):
            o[:], c[:] = self.planes["out"].inner[channel], self.planes["out"].inner[4 + channel]
        return odds, calibre

    def convolve_back(self, name, source, gradient):
        """From the gradient at the layer's result (planes "d" + name) to its weights' and its input's."""
        x, y, d, back = (self.planes[key] for key in (source, name, "d" + name, "g" + name))
        if name != "out": d.inner[:] *= y.inner > 0
        gradient[name + ".b"] += d.inner.sum((1, 2))
        KERNELS.weightGradient(address(x.memory), x.channels, address(d.memory), d.channels, address(gradient[name + ".w"]),
                               y.width, y.height, y.stride)
        turned = np.ascontiguousarray(self.weights[name + ".w"].transpose(1, 0, 2, 3)[:, :, ::-1, ::-1])
        KERNELS.forward(address(d.memory), d.channels, address(back.memory), back.channels, address(turned),
                        address(np.zeros(back.channels, np.float32)), y.width, y.height, y.stride)
        back.clean()
        return back.inner

    def join_back(self, name, coarse, result, d, gradient):
        """@return the gradients at the coarser and at the finer input"""
        d = d * (self.planes[result].inner > 0)
        x = self.planes[coarse].inner
        mixed = (4 * halved(d)).reshape(len(d), -1)
        gradient[name + ".w"] += mixed @ x.reshape(len(x), -1).T
        gradient[name + ".b"] += mixed.sum(1)
        return (self.weights[name + ".w"].T @ mixed).reshape(x.shape), d

    def back(self, d_odds, d_calibre, gradient):
        """Adds to `gradient` what the last `run` gives for these gradients at its results."""
        p = self.planes
        for channel, phase in enumerate(pairs(d_odds) + pairs(d_calibre)): p["dout"].inner[channel] = phase
        p["da4"].inner[:] = self.convolve_back("out", "a4", gradient)
        p["da3"].inner[:] = self.convolve_back("a4", "a3", gradient)
        p["db4"].inner[:], skip_a = self.join_back("u2", "b4", "sum_a", self.convolve_back("a3", "sum_a", gradient), gradient)
        p["db3"].inner[:] = self.convolve_back("b4", "b3", gradient)
        p["dc3"].inner[:], skip_b = self.join_back("u1", "c3", "sum_b", self.convolve_back("b3", "sum_b", gradient), gradient)
        p["dc2"].inner[:] = self.convolve_back("c3", "c2", gradient)
        p["dc1"].inner[:] = self.convolve_back("c2", "c1", gradient)
        p["db2"].inner[:] = skip_b + 0.25 * doubled(self.convolve_back("c1", "in_c", gradient))
        p["db1"].inner[:] = self.convolve_back("b2", "b1", gradient)
        p["da2"].inner[:] = skip_a + 0.25 * doubled(self.convolve_back("b1", "in_b", gradient))
        p["da1"].inner[:] = self.convolve_back("a2", "a1", gradient)
        self.convolve_back("a1", "in", gradient)


def load(path):
    net = Net(np.random.default_rng(0))
    net.weights = dict(np.load(path).items())
    return net
