# SPDX-License-Identifier: GPL-3.0-or-later
"""Small inputs for the process tests, made on the spot: nothing binary lies in the tree."""
import os
import random

import cv2
import numpy as np

SIZE = (320, 240)


def retina_frame(t, size=SIZE):
    """A reddish field with a branching dark vessel tree that drifts with t; BGR, 8 bit."""
    w, h = size
    rng = np.random.default_rng(7)
    image = np.empty((h, w, 3), np.float32)
    image[:] = (30, 90, 180)
    for _ in range(14):
        x, y, angle = rng.uniform(0, w), rng.uniform(0, h), rng.uniform(0, 2 * np.pi)
        points = []
        for _ in range(60):
            angle += rng.normal(0, 0.15)
            x, y = x + 5 * np.cos(angle), y + 5 * np.sin(angle)
            points.append((x + 0.7 * t, y + 0.3 * t))
        line = np.round(16 * np.array(points)).astype(np.int32).reshape(-1, 1, 2)
        cv2.polylines(image, [line], False, (20, 50, 140), int(rng.integers(3, 8)), cv2.LINE_AA, 4)
    return np.clip(cv2.GaussianBlur(image, (5, 5), 0), 0, 255).astype(np.uint8)


def write_video(path, frames, code="avc1", fps=30):
    height, width = frames[0].shape[:2]
    writer = cv2.VideoWriter(path, cv2.CAP_FFMPEG, cv2.VideoWriter_fourcc(*code), fps, (width, height))
    assert writer.isOpened(), path
    for frame in frames:
        writer.write(frame)
    writer.release()
    return path


def retina_video(path, count=30, **options):
    return write_video(path, [retina_frame(t) for t in range(count)], **options)


def image_folder(path, count=6, ending=".png", convert=lambda image: image):
    os.makedirs(path)
    for i in range(count):
        cv2.imwrite(os.path.join(path, f"im{i}{ending}"), convert(retina_frame(i)))
    return path


def cut(path, share):
    """Leaves only the first part of a file."""
    with open(path, "r+b") as file:
        file.truncate(int(os.path.getsize(path) * share))
    return path


def damage(path, first_share, last_share):
    """Overwrites a part of a file with random bytes."""
    size = os.path.getsize(path)
    first, last = int(size * first_share), int(size * last_share)
    with open(path, "r+b") as file:
        file.seek(first)
        file.write(random.Random(1).randbytes(last - first))
    return path
