# SPDX-License-Identifier: GPL-3.0-or-later
"""eyeslam-track on bad input: status 1 or 2, one line that names it, nothing written. Called as eyeslam_track_test.py."""
import json
import os
import resource
import subprocess
import unittest

import cv2
import numpy as np

from track_case import PROGRAM, TrackCase
from track_inputs import cut, damage, image_folder, retina_frame, retina_video


class BadVideo(TrackCase):
    def refuse(self, name, content):
        with open(self.path(name), "wb") as file:
            file.write(content)
        self.assert_refused(self.run_track(self.path(name)), 1, name)

    def test_missing_file(self):
        self.assert_refused(self.run_track(self.path("gone.mp4")), 1, "gone.mp4")

    def test_empty_file(self):
        self.refuse("empty.mp4", b"")

    def test_text_file(self):
        self.refuse("notes.mp4", b"these are notes\n" * 200)

    def test_random_bytes(self):
        self.refuse("random.mp4", np.random.default_rng(1).bytes(50000))

    def test_mp4_with_its_end_cut_off(self):
        self.assert_refused(self.run_track(cut(retina_video(self.path("cut.mp4")), 0.7)), 1, "cut.mp4")

    def test_video_without_a_frame(self):
        subprocess.run(["ffmpeg", "-v", "quiet", "-i", retina_video(self.path("a.mp4")), "-frames:v", "0", "-c", "copy",
                        "-y", self.path("none.mp4")], check=False)
        self.assert_refused(self.run_track(self.path("none.mp4")), 1, "none.mp4")

    def test_first_frame_after_the_end(self):
        self.assert_refused(self.run_track(retina_video(self.path("a.mp4")), "--from", "30"), 1, "a.mp4", "30")

    def test_damage_in_the_middle_names_the_last_good_frame_that_to_then_accepts(self):
        video = damage(retina_video(self.path("hurt.mp4"), 60), 0.5, 0.6)
        process = self.run_track(video)
        self.assert_refused(process, 1, "hurt.mp4", "--to ")
        last = process.stderr.split("--to ")[1].split()[0]
        self.assertIn(f"the last good one is {last}", process.stderr)
        self.assert_done(self.run_track(video, "--to", last))
        self.assertEqual(int(self.rows()[-1]["frame"]), int(last))

    def test_mkv_cut_in_half_is_a_warning_only(self):
        video = cut(retina_video(self.path("half.mkv"), 60, code="FFV1"), 0.5)
        process = self.run_track(video)
        self.assert_done(process)
        self.assertIn("half.mkv", process.stderr)
        self.assertLess(len(self.rows()), 60)

    def test_absent_camera(self):
        self.assert_refused(self.run_track("camera:97"), 1, "camera:97")

    def test_camera_without_a_number(self):
        self.assert_refused(self.run_track("camera:front"), 1, "camera:front")

    def test_shared_memory_is_refused_by_name(self):
        self.assert_refused(self.run_track("shm:eye"), 1, "shm:eye")


class BadImages(TrackCase):
    def refuse_with(self, spoil, *named, ending=".png"):
        folder = image_folder(self.path("im"), ending=ending)
        spoil(os.path.join(folder, "im4" + ending))
        self.assert_refused(self.run_track(folder), 1, "im4", *named)

    def test_corrupt_png(self):
        self.refuse_with(lambda path: damage(path, 0.4, 0.45))

    def test_cut_png(self):
        self.refuse_with(lambda path: cut(path, 0.6))

    def test_cut_jpeg(self):
        self.refuse_with(lambda path: cut(path, 0.6), "cut off", ending=".jpg")

    def test_cut_tiff(self):
        self.refuse_with(lambda path: cut(path, 0.6), ending=".tif")

    def test_text_in_an_image(self):
        def write_text(path):
            with open(path, "w") as file:
                file.write("no image")
        self.refuse_with(write_text)

    def test_empty_image(self):
        self.refuse_with(lambda path: cut(path, 0))

    def test_image_of_another_size(self):
        self.refuse_with(lambda path: cv2.imwrite(path, retina_frame(0)[:200]), "320 x 200", "320 x 240")

    def test_image_of_another_type(self):
        self.refuse_with(lambda path: cv2.imwrite(path, retina_frame(0)[:, :, 1]), "1 channel")

    def test_images_of_floating_point(self):
        folder = image_folder(self.path("im"), ending=".tiff", convert=lambda image: image.astype(np.float32))
        self.assert_refused(self.run_track(folder), 1, "im0.tiff", "8 or 16 bit")

    def test_folder_without_images(self):
        os.mkdir(self.path("bare"))
        self.assert_refused(self.run_track(self.path("bare")), 1, "bare")

    def test_glob_without_images(self):
        self.assert_refused(self.run_track(self.path("im*.png")), 1, "im*.png")

    def test_spoilt_image_after_the_last_one_wanted_does_no_harm(self):
        folder = image_folder(self.path("im"))
        cut(os.path.join(folder, "im4.png"), 0.5)
        self.assert_done(self.run_track(folder, "--to", "3"))


class BadConfiguration(TrackCase):
    def refuse_yaml(self, text, *named):
        with open(self.path("my.yaml"), "w") as file:
            file.write(text)
        self.assert_refused(self.run_track(self.video(), "--config", self.path("my.yaml")), 2, "my.yaml", *named)

    def video(self):
        return retina_video(self.path("a.mp4"), 2)

    def test_unknown_key(self):
        self.refuse_yaml("frame:\n  scall: 0.5\n", "frame.scall", "frame.scale")

    def test_doubled_key(self):
        self.refuse_yaml("frame:\n  scale: 0.5\n  scale: 0.4\n", "frame.scale", "twice")

    def test_doubled_group(self):
        self.refuse_yaml("frame:\n  scale: 0.5\nframe:\n  scale: 0.4\n", "frame", "twice")

    def test_wrong_type(self):
        self.refuse_yaml("frame:\n  scale: half\n", "frame.scale", "a number in [0.1, 1]")

    def test_list_instead_of_a_value(self):
        self.refuse_yaml("frame:\n  scale: [0.5]\n", "frame.scale")

    def test_nan(self):
        self.refuse_yaml("frame:\n  scale: .nan\n", "frame.scale")
        self.refuse_yaml("frame:\n  scale: nan\n", "frame.scale")

    def test_out_of_range(self):
        self.refuse_yaml("frame:\n  scale: 1.5\n", "frame.scale", "[0.1, 1]")

    def test_unknown_choice(self):
        self.refuse_yaml("detector: magic\n", "detector", "ridge")

    def test_no_yaml(self):
        self.refuse_yaml("frame: {scale: 0.5\n")

    def test_missing_file(self):
        self.assert_refused(self.run_track(self.video(), "--config", self.path("gone.yaml")), 2, "gone.yaml")

    def test_settings(self):
        video = self.video()
        for setting, named in (("frame.scall=1", "frame.scall"), ("frame.scale=nan", "frame.scale"),
                               ("frame.scale=7", "frame.scale"), ("frame.scale", "frame.scale"),
                               ("frame.background_radius_cells=1e3", "frame.background_radius_cells")):
            self.assert_refused(self.run_track(video, "--set", setting), 2, "--set", named)
        self.assert_refused(self.run_track(video, "--scale", "0"), 2, "--scale", "[0.1, 1]")
        self.assert_refused(self.run_track(video, "--seed", "x"), 2, "--seed")


class BadCall(TrackCase):
    def refuse(self, *arguments, named):
        process = subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, timeout=60)
        self.assert_refused(process, 2, named)

    def test_no_output_folder(self):
        self.refuse("a.mp4", named="--out")

    def test_no_input(self):
        self.refuse("--out", self.out, named="INPUT")

    def test_unknown_option(self):
        self.refuse("a.mp4", "--out", self.out, "--fast", named="--fast")

    def test_unknown_method(self):
        self.refuse("a.mp4", "--out", self.out, "--method", "magic", named="magic")

    def test_frames_in_the_wrong_order(self):
        self.refuse("a.mp4", "--out", self.out, "--from", "9", "--to", "3", named="--to 3")

    def test_numbers_that_are_none(self):
        for option, value in (("--from", "-1"), ("--to", "x"), ("--to", "9" * 20), ("--snapshots", "3,x"),
                              ("--fps", "0"), ("--fps", "nan"), ("--um-per-px", "-2"), ("--um-per-px", "nan")):
            self.refuse("a.mp4", "--out", self.out, option, value, named=option)

    def test_results_among_the_frames(self):
        frames = image_folder(self.path("frames"), 3)
        self.refuse(frames, "--out", frames + "/.", named="INPUT")
        self.assertEqual(len(os.listdir(frames)), 3)

    def test_results_in_place_of_the_input(self):
        os.mkdir(self.path("earlier"))
        video = retina_video(self.path("earlier/overlay.mp4"), 2)
        self.refuse(video, "--out", self.path("earlier"), named="overlay.mp4")
        self.assertEqual(os.listdir(self.path("earlier")), ["overlay.mp4"])

    def test_unknown_form_of_the_dump(self):
        self.refuse("--dump-config=xml", named="xml")

    def test_truth_without_frame_0(self):
        self.refuse("a.mp4", "--out", self.out, "--truth", self.folder, "--from", "3", named="--from 3")

    def test_truth_that_is_not_there(self):
        video = retina_video(self.path("a.mp4"), 2)
        self.assert_refused(self.run_track(video, "--truth", self.path("gone")), 1, "gone")

    def test_record_that_is_no_mkv(self):
        self.refuse("a.mp4", "--out", self.out, "--record", "a.mp4", named="a.mp4")

    def test_pixel_size_in_meta_json_that_is_none(self):
        video = retina_video(self.path("a.mp4"), 2)
        for text in ('{"um_per_px": "big"}', '{"um_per_px": -1}', "{"):
            with open(self.path("meta.json"), "w") as file:
                file.write(text)
            self.assert_refused(self.run_track(video), 1, "meta.json")


class BadOutput(TrackCase):
    def test_output_folder_that_is_a_file(self):
        with open(self.path("taken"), "w") as file:
            file.write("mine")
        self.assert_refused(self.run_track(retina_video(self.path("a.mp4"), 2), out=self.path("taken")), 1, "taken")

    def test_output_folder_below_a_file(self):
        with open(self.path("taken"), "w") as file:
            file.write("mine")
        self.assert_refused(self.run_track(retina_video(self.path("a.mp4"), 2), out=self.path("taken/out")), 1, "taken/out")

    def test_output_folder_that_cannot_be_written(self):
        # root may write anywhere but into /proc
        self.assert_refused(self.run_track(retina_video(self.path("a.mp4"), 2), out="/proc/eyeslam"), 1, "/proc/eyeslam")

    def test_record_into_a_folder_that_is_not_there(self):
        process = self.run_track(retina_video(self.path("a.mp4"), 2), "--record", self.path("gone/a.mkv"))
        self.assert_refused(process, 1, "gone/a.mkv")

    def test_record_of_frames_that_it_would_have_to_crop(self):
        folder = image_folder(self.path("im"), convert=lambda image: image[:201, :273].copy())
        process = self.run_track(folder, "--record", self.path("a.mkv"))
        self.assert_refused(process, 1, "a.mkv", "273 x 201")
        self.assertNotIn("a.mkv", os.listdir(self.folder))

    def test_full_disk(self):
        disk = self.path("disk")
        os.mkdir(disk)
        mount = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=32k", "none", disk], capture_output=True, text=True)
        if mount.returncode != 0:
            self.skipTest("no tmpfs can be mounted here: " + mount.stderr.strip())
        self.addCleanup(subprocess.run, ["umount", disk])
        process = self.run_track(retina_video(self.path("a.mp4"), 60), out=os.path.join(disk, "out"))
        self.assert_refused(process, 1, "disk/out")
        self.assertEqual(os.listdir(disk), [])

    def test_files_larger_than_allowed(self):
        video = retina_video(self.path("a.mp4"), 60)
        process = self.run_track(video, preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096)))
        self.assert_refused(process, 1, "results/out")


if __name__ == "__main__":
    unittest.main()
