# SPDX-License-Identifier: GPL-3.0-or-later
"""eyeslam-track on input as it should be: eyeslam_track_test.py PROGRAM [unittest arguments]."""
import json
import os
import shutil
import signal
import subprocess
import time
import unittest

import cv2
import numpy as np

from track_case import PROGRAM, TrackCase
from track_inputs import SIZE, image_folder, retina_frame, retina_video, write_video

TIMING_COLUMNS = ("cpu_ms", "map_cpu_ms")  # measured, so they differ from run to run


class GoodInput(TrackCase):
    def test_writes_every_file_of_the_contract(self):
        process = self.run_track(retina_video(self.path("a.mp4")), "--snapshots", "10,20")
        self.assert_done(process)
        self.assertEqual(process.stderr, "")
        names = {os.path.relpath(os.path.join(root, name), self.out) for root, _, names in os.walk(self.out) for name in names}
        maps = {f"map/{kind}_{frame:06}.{ending}" for frame in (10, 20, 29)
                for kind, ending in (("map", "png"), ("map", "json"), ("seen", "png"))}
        self.assertLessEqual(maps | {"trajectory.csv", "vessels.csv", "mosaic.png", "mosaic.json", "overlay.mp4",
                                 "run.json"}, names)

    def test_writes_a_row_a_frame_with_no_empty_field_but_the_reason(self):
        self.assert_done(self.run_track(retina_video(self.path("a.mp4"))))
        rows = self.rows()
        self.assertEqual([int(row["frame"]) for row in rows], list(range(30)))
        self.assertEqual(",".join(rows[0]), "frame,t_s,tracked,x_px,y_px,theta_deg,scale,sigma_x_px,sigma_y_px,"
                         "sigma_theta_deg,points,score,reason,cpu_ms,map_cpu_ms")
        for i, row in enumerate(rows):
            self.assertAlmostEqual(float(row["t_s"]), i / 30, delta=0.002)
            self.assertTrue(all(value for name, value in row.items() if name != "reason"), row)
            self.assertEqual(row["tracked"] == "1", row["reason"] == "")

    def test_numbers_frames_as_the_video_does(self):
        self.assert_done(self.run_track(retina_video(self.path("a.mp4")), "--from", "5", "--to", "14"))
        self.assertEqual([int(row["frame"]) for row in self.rows()], list(range(5, 15)))
        self.assertAlmostEqual(float(self.rows()[0]["t_s"]), 5 / 30, delta=0.002)
        self.assertTrue(os.path.exists(os.path.join(self.out, "map/map_000014.png")))

    def test_names_a_snapshot_that_no_frame_gave(self):
        process = self.run_track(retina_video(self.path("a.mp4"), 3), "--snapshots", "1,99")
        self.assert_done(process)
        self.assertIn("--snapshots 99", process.stderr)

    def test_takes_one_frame_as_a_normal_run(self):
        self.assert_done(self.run_track(image_folder(self.path("one"), 1)))
        self.assertEqual(len(self.rows()), 1)

    def test_takes_images_in_the_order_of_their_numbers(self):
        self.assert_done(self.run_track(image_folder(self.path("im"), 12), "--fps", "10"))
        self.assertEqual(len(self.rows()), 12)
        self.assertAlmostEqual(float(self.rows()[-1]["t_s"]), 1.1, places=5)

    def test_takes_a_glob(self):
        image_folder(self.path("im"), 12)
        self.assert_done(self.run_track(self.path("im/im1*.png")))
        self.assertEqual(len(self.rows()), 3)

    def test_takes_16_bit_images(self):
        folder = image_folder(self.path("im"), convert=lambda image: image.astype(np.uint16) * 257)
        self.assert_done(self.run_track(folder))

    def test_takes_grey_images(self):
        folder = image_folder(self.path("im"), convert=lambda image: cv2.cvtColor(image, cv2.COLOR_BGR2GRAY))
        self.assert_done(self.run_track(folder))

    def test_takes_odd_sizes(self):
        folder = image_folder(self.path("im"), convert=lambda image: image[:201, :273].copy())
        self.assert_done(self.run_track(folder))

    def test_says_once_that_alpha_is_left_out(self):
        folder = image_folder(self.path("im"), convert=lambda image: cv2.cvtColor(image, cv2.COLOR_BGR2BGRA))
        process = self.run_track(folder)
        self.assert_done(process)
        self.assertEqual(len(process.stderr.splitlines()), 1)
        self.assertIn("alpha", process.stderr)

    def test_says_that_a_colourless_video_is_taken_as_grey(self):
        frames = [cv2.cvtColor(cv2.cvtColor(retina_frame(t), cv2.COLOR_BGR2GRAY), cv2.COLOR_GRAY2BGR) for t in range(8)]
        process = self.run_track(write_video(self.path("a.mp4"), frames))
        self.assert_done(process)
        self.assertIn("grey", process.stderr)

    def test_records_each_processed_frame_without_loss(self):
        folder = image_folder(self.path("im"))
        self.assert_done(self.run_track(folder, "--from", "2", "--record", self.path("kept.mkv")))
        capture = cv2.VideoCapture(self.path("kept.mkv"))
        for t in range(2, 6):
            self.assertTrue(np.array_equal(capture.read()[1], retina_frame(t)))
        self.assertFalse(capture.read()[0])

    def test_takes_the_pixel_size_of_meta_json_and_overrides_it(self):
        video = retina_video(self.path("a.mp4"), 3)
        self.assert_done(self.run_track(video))
        self.assertIsNone(self.record()["um_per_px"])
        with open(self.path("meta.json"), "w") as file:
            json.dump({"um_per_px": 4.5}, file)
        self.assert_done(self.run_track(video))
        self.assertEqual((self.record()["um_per_px"], self.record()["um_per_px_source"]), (4.5, self.path("meta.json")))
        self.assert_done(self.run_track(video, "--um-per-px", "6"))
        self.assertEqual((self.record()["um_per_px"], self.record()["um_per_px_source"]), (6, "--um-per-px"))
        with open(os.path.join(self.out, "map/map_000002.json")) as file:
            self.assertEqual(json.load(file)["um_per_px"], 6)

    def test_gives_identical_files_for_the_same_input_but_for_timing(self):
        video = retina_video(self.path("a.mp4"))
        contents = []
        for _ in range(2):
            self.assert_done(self.run_track(video, "--snapshots", "10"))
            contents.append(self.contents_without_timing())
        self.assertEqual(contents[0].keys(), contents[1].keys())
        for name, content in contents[0].items():
            self.assertEqual(content, contents[1][name], f"{name} differs")

    def contents_without_timing(self):
        contents = {}
        for root, _, names in os.walk(self.out):
            for name in names:
                path = os.path.join(root, name)
                with open(path, "rb") as file:
                    contents[os.path.relpath(path, self.out)] = file.read()
        record = self.record()
        del record["timing"]
        contents["run.json"] = record
        contents["trajectory.csv"] = [[v for k, v in row.items() if k not in TIMING_COLUMNS] for row in self.rows()]
        return contents

    def test_replaces_its_own_results_and_keeps_other_files(self):
        video = retina_video(self.path("a.mp4"))
        self.assert_done(self.run_track(video, "--snapshots", "10"))
        with open(os.path.join(self.out, "notes.txt"), "w") as file:
            file.write("mine")
        self.assert_done(self.run_track(video, "--to", "4", "--no-overlay"))
        self.assertEqual(len(self.rows()), 5)
        self.assertEqual(sorted(os.listdir(os.path.join(self.out, "map"))),
                         ["map_000004.json", "map_000004.png", "seen_000004.png"])
        self.assertIn("notes.txt", os.listdir(self.out))
        self.assertNotIn("overlay.mp4", os.listdir(self.out))
        self.assertFalse([name for name in os.listdir(self.out) if "partial" in name])

    def test_prints_nothing_when_quiet(self):
        process = self.run_track(retina_video(self.path("a.mp4"), 5), "--quiet")
        self.assert_done(process)
        self.assertEqual(process.stdout + process.stderr, "")

    def test_reads_back_the_configuration_it_dumps(self):
        dump = subprocess.run([PROGRAM, "--dump-config", "--set", "frame.scale=0.4"], capture_output=True, text=True)
        self.assertEqual(dump.returncode, 0, dump.stderr)
        with open(self.path("my.yaml"), "w") as file:
            file.write(dump.stdout)
        again = subprocess.run([PROGRAM, "--dump-config", "--config", self.path("my.yaml")], capture_output=True, text=True)
        self.assertEqual(dump.stdout, again.stdout)
        self.assertIn("scale: 0.4", again.stdout)


    def test_says_the_options_as_the_documentation_has_them(self):
        page = os.path.join(os.path.dirname(__file__), "../../docs/configuration.md")
        printed = subprocess.run([PROGRAM, "--dump-config=markdown"], capture_output=True, text=True)
        with open(page) as file:
            self.assertEqual(printed.stdout, file.read(), "eyeslam-track --dump-config=markdown > docs/configuration.md")

    @unittest.skipUnless(shutil.which("xvfb-run"), "xvfb-run is not installed")
    def test_shows_frames_in_a_window(self):
        video = retina_video(self.path("a.mp4"), 5)
        process = subprocess.run(["xvfb-run", "-a", PROGRAM, video, "--out", self.out, "--display"], capture_output=True,
                                 text=True, timeout=120)
        self.assert_done(process)

    def test_asks_for_a_screen_only_where_one_is_needed(self):
        environment = {name: value for name, value in os.environ.items() if name != "DISPLAY"}
        video = retina_video(self.path("a.mp4"), 3)
        self.assert_done(self.run_track(video, env=environment))
        shutil.rmtree(self.out)
        self.assert_refused(self.run_track(video, "--display", env=environment), 2, "--display")

    def test_draws_the_truth_beside_the_estimate(self):
        sequence = os.path.join(os.environ.get("EYESLAM_SHARED", ""), "sequences", "human")
        if not os.path.isdir(sequence):
            self.skipTest("no sequence with truth: EYESLAM_SHARED/sequences/human")
        self.assert_done(self.run_track(os.path.join(sequence, "video.mp4"), "--truth", sequence, "--to", "40"))
        for name in ("truth_pose.png", "truth_map.png"):
            self.assertIsNotNone(cv2.imread(os.path.join(self.out, name)), name)

    def test_overlay_has_a_picture_a_frame(self):
        self.assert_done(self.run_track(retina_video(self.path("a.mp4"), 7)))
        capture = cv2.VideoCapture(os.path.join(self.out, "overlay.mp4"))
        self.assertEqual(sum(1 for _ in iter(lambda: capture.grab(), False)), 7)


class NothingToSee(TrackCase):
    """Frames without a retina end normally: none tracked, each with its reason, an empty map."""

    def assert_nothing_found(self, frames):
        self.assert_done(self.run_track(write_video(self.path("a.avi"), frames, code="MJPG")))
        for row in self.rows():
            self.assertEqual(row["tracked"], "0", row)
            self.assertNotEqual(row["reason"], "", row)
        cells = cv2.imread(os.path.join(self.out, "map/map_000011.png"), cv2.IMREAD_UNCHANGED)
        self.assertIsNotNone(cells)
        self.assertLess(int(cells.max()), 128)
        with open(os.path.join(self.out, "vessels.csv")) as file:
            self.assertEqual(len(file.readlines()), 1)

    def test_black_video(self):
        self.assert_nothing_found([np.zeros((SIZE[1], SIZE[0], 3), np.uint8)] * 12)

    def test_white_video(self):
        self.assert_nothing_found([np.full((SIZE[1], SIZE[0], 3), 255, np.uint8)] * 12)

    def test_noise_video(self):
        rng = np.random.default_rng(3)
        self.assert_nothing_found([rng.integers(0, 256, (SIZE[1], SIZE[0], 3), np.uint8) for _ in range(12)])

    def test_noise_in_the_colour_of_a_retina_in_and_out_of_focus(self):
        rng = np.random.default_rng(4)
        for blur in (0.0, 1.5, 3.0):
            frames = []
            for _ in range(12):
                grain = rng.normal(0.0, 1.0, (SIZE[1], SIZE[0], 3)).astype(np.float32)
                grain = cv2.GaussianBlur(grain, (0, 0), blur) if blur else grain
                frames.append(np.clip((30, 70, 170) + 20.0 * grain / grain.std(), 0, 255).astype(np.uint8))
            with self.subTest(blur=blur):
                self.assert_nothing_found(frames)
                self.assertIn("noise", {row["reason"] for row in self.rows()})


class Interruption(TrackCase):
    def test_ctrl_c_ends_the_check_of_a_large_folder_which_tells_how_far_it_is(self):
        os.mkdir(self.path("images"))
        picture = np.random.default_rng(1).integers(0, 256, (1200, 1600, 3), np.uint8)
        cv2.imwrite(self.path("images/0.png"), picture)
        for number in range(1, 2000):  # some minutes of decoding
            os.link(self.path("images/0.png"), self.path(f"images/{number}.png"))
        process = subprocess.Popen([PROGRAM, self.path("images"), "--out", self.out], stderr=subprocess.PIPE, text=True)
        progress = process.stderr.readline()  # after five seconds
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=60)
        self.assertRegex(progress, r"checking .*images .*\d+/2000")
        self.assertEqual(process.returncode, 1, errors)
        self.assertIn("nothing written", errors.splitlines()[-1])
        self.assertEqual(os.listdir(self.path("results")), [])

    def interrupt(self, number):
        video = retina_video(self.path("a.avi"), 400, code="MJPG")
        process = subprocess.Popen([PROGRAM, video, "--out", self.out, "--set", "frame.scale=1"], stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, text=True)
        deadline = time.monotonic() + 60
        # The first results are written once frames are tracked.
        while time.monotonic() < deadline and not os.listdir(self.path("results")):
            time.sleep(0.005)
        time.sleep(0.1)
        process.send_signal(number)
        _, errors = process.communicate(timeout=120)
        return process.returncode, errors

    def assert_kept(self, number):
        status, errors = self.interrupt(number)
        self.assertEqual(status, 0, errors)
        self.assertIn("interrupted after frame", errors)
        rows = self.rows()
        self.assertLess(len(rows), 400)
        self.assertGreater(len(rows), 0)
        self.assertTrue(self.record()["interrupted"])
        self.assertTrue(os.path.exists(os.path.join(self.out, f"map/map_{len(rows) - 1:06}.png")))
        self.assertEqual(os.listdir(self.path("results")), ["out"])

    def test_ctrl_c_keeps_what_was_done(self):
        self.assert_kept(signal.SIGINT)

    def test_termination_keeps_what_was_done(self):
        self.assert_kept(signal.SIGTERM)

    def test_a_killed_run_is_swept_up_by_the_next(self):
        self.interrupt(signal.SIGKILL)
        self.assertNotIn("out", os.listdir(self.path("results")))
        self.assert_done(self.run_track(self.path("a.avi"), "--to", "3"))


if __name__ == "__main__":
    unittest.main()
